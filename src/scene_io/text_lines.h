// SPDX-License-Identifier: Apache-2.0
// scene_io/text_lines.h: text files of lines, words and numbers (OBJ, MTL, PLY), however their
// lines end.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace nacre {

// The text without the byte-order mark of UTF-8 that editors put before it. Throws Error
// (kBadInput) with `file` for text in UTF-16 or UTF-32, with such a mark or without.
std::string_view WithoutByteOrderMark(std::string_view text, const std::string& file);

// Goes through the statements of an OBJ or MTL file. A line ends with LF, CR LF or CR, and goes on
// in the next one if its last character is a backslash, unless that is in a comment: words that
// begin with # are one up to the end of their line.
class TextLines {
 public:
  explicit TextLines(std::string_view text) : text_(text) {}

  // Sets *line to the next one, which is valid until the next call. False at the end.
  bool Next(std::string_view* line);
  // The number, from 1 on, of the file's line in which it began.
  size_t number() const { return number_; }
  // How many of the file's lines are read.
  size_t lines() const { return lines_; }

 private:
  std::string_view NextInFile();

  std::string_view text_;
  size_t position_ = 0;
  size_t number_ = 0, lines_ = 0;
  std::string joined_;
};

// Takes the next word off the front of `line`; empty at its end.
std::string_view NextWord(std::string_view* line);

// The text between blanks at both ends, and between quotation marks if it is in some.
std::string_view Trimmed(std::string_view text);

// Whether it is what a program writes for a number that is none or infinite: nan, -nan(ind), inf,
// 1.#QNAN, -1.#IND00.
bool IsNoNumber(std::string_view word);

// In lower case: its ASCII letters.
std::string LowerCase(std::string_view text);

// Names may hold blanks and the sign #, and a comment may follow them. A # between blanks begins
// one; where the sign and a word are one, that word may belong to the name ("Material #25"): what
// is before it is tried only where there is nothing of the whole name.
std::string_view WithoutComment(std::string_view name);
std::string_view WithoutHashWords(std::string_view name);

}  // namespace nacre
