// SPDX-License-Identifier: Apache-2.0
// scene_io/text_lines.h: splits text files (OBJ, MTL, PLY) into lines, words and numbers, whatever
// their line ends.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace nacre {

// Removes the byte-order mark of UTF-8 that some editors write first. Throws Error (kBadInput),
// located in `file`, for text in UTF-16 or UTF-32, with or without a byte-order mark.
std::string_view WithoutByteOrderMark(std::string_view text, const std::string& file);

// Iterates over the statements of an OBJ or MTL file. A line ends with LF, CR LF or CR. If its last
// character is a backslash, it continues in the next line, except in a comment: a word that begins
// with # starts a comment up to the end of its line.
class TextLines {
 public:
  explicit TextLines(std::string_view text) : text_(text) {}

  // Sets *line to the next statement, which is valid until the next call. False at the end.
  bool Next(std::string_view* line);
  // The number of the file's line in which the statement began, counted from 1.
  size_t number() const { return number_; }
  // How many of the file's lines have been read.
  size_t lines() const { return lines_; }

 private:
  std::string_view NextInFile();

  std::string_view text_;
  size_t position_ = 0;
  size_t number_ = 0, lines_ = 0;
  std::string joined_;
};

// Removes the next word from the front of `line` and returns it; empty at the end.
std::string_view NextWord(std::string_view* line);

// The text without blanks at its ends, and then without quotation marks around it.
std::string_view Trimmed(std::string_view text);

// Whether the word is what programs write for NaN or infinity: nan, -nan(ind), inf, 1.#QNAN,
// -1.#IND00.
bool IsNoNumber(std::string_view word);

// The text with its ASCII letters in lower case.
std::string LowerCase(std::string_view text);

// Names may contain blanks and the sign #, and a comment may follow them. WithoutComment cuts the
// name at a # between blanks. WithoutHashWords cuts it at any word that begins with #, which may
// belong to the name (though never if a digit follows: "Material #25"); the shortened name is to be
// tried only if the whole name does not exist.
std::string_view WithoutComment(std::string_view name);
std::string_view WithoutHashWords(std::string_view name);

}  // namespace nacre
