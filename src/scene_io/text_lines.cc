// SPDX-License-Identifier: Apache-2.0
#include "scene_io/text_lines.h"

#include <algorithm>

#include "base/error.h"

namespace nacre {
namespace {

constexpr std::string_view kLineBlanks = " \t\v\f\r\n";

// Words and lines are short: a loop over their characters is faster than the library's search.
bool IsLineBlank(char c) { return c == ' ' || (c >= '\t' && c <= '\r'); }

// The text, trimmed, before the first word that begins with # and for which is_comment(word) holds.
// All of the text if nothing would be left.
template <class IsComment>
std::string_view TextBefore(std::string_view name, const IsComment& is_comment) {
  std::string_view rest = name;
  for (std::string_view word = NextWord(&rest); !word.empty(); word = NextWord(&rest)) {
    if (!word.starts_with('#') || !is_comment(word)) continue;
    const std::string_view before =
        Trimmed(name.substr(0, static_cast<size_t>(word.data() - name.data())));
    return before.empty() ? name : before;
  }
  return name;
}

// Whether the line has a comment. A comment ends with its line, even if that ends with a backslash.
bool HasComment(std::string_view line) {
  for (size_t i = line.find('#'); i < line.size(); i = line.find('#', i + 1)) {
    if (i == 0 || kLineBlanks.find(line[i - 1]) != std::string_view::npos) return true;
  }
  return false;
}

bool GoesOn(std::string_view line) { return line.ends_with('\\') && !HasComment(line); }

}  // namespace

std::string_view WithoutByteOrderMark(std::string_view text, const std::string& file) {
  using namespace std::string_view_literals;
  if (text.starts_with("\xef\xbb\xbf"sv)) return text.substr(3);
  const bool has_mark = text.starts_with("\xff\xfe"sv) || text.starts_with("\xfe\xff"sv) ||
                        text.starts_with("\0\0\xfe\xff"sv);
  // UTF-16 or UTF-32 without a mark: the first character is ASCII, so its other bytes are 0.
  const bool is_utf16 = text.size() >= 2 && (text[0] == 0) != (text[1] == 0);
  const bool is_utf32 = text.size() >= 4 && text.starts_with("\0\0\0"sv) && text[3] != 0;
  if (!has_mark && !is_utf16 && !is_utf32) return text;
  throw Error(ExitCode::kBadInput, file, "is text in UTF-16 or UTF-32", "save it as UTF-8");
}

std::string_view TextLines::NextInFile() {
  size_t end = position_;
  while (end < text_.size() && text_[end] != '\n' && text_[end] != '\r') ++end;
  const std::string_view line = text_.substr(position_, end - position_);
  position_ = text_.substr(end).starts_with("\r\n") ? end + 2 : end + 1;
  ++lines_;
  return line;
}

bool TextLines::Next(std::string_view* line) {
  if (position_ >= text_.size()) return false;
  *line = NextInFile();
  number_ = lines_;
  if (!GoesOn(*line)) return true;
  joined_.clear();
  std::string_view part = *line;
  for (; GoesOn(part); part = position_ < text_.size() ? NextInFile() : std::string_view()) {
    joined_ += part.substr(0, part.size() - 1);
    joined_ += ' ';
  }
  joined_ += part;
  *line = joined_;
  return true;
}

std::string_view NextWord(std::string_view* line) {
  size_t begin = 0;
  while (begin < line->size() && IsLineBlank((*line)[begin])) ++begin;
  size_t end = begin;
  while (end < line->size() && !IsLineBlank((*line)[end])) ++end;
  const std::string_view word = line->substr(begin, end - begin);
  line->remove_prefix(end);
  return word;
}

std::string_view Trimmed(std::string_view text) {
  text.remove_prefix(std::min(text.find_first_not_of(kLineBlanks), text.size()));
  text.remove_suffix(text.size() - (text.find_last_not_of(kLineBlanks) + 1));  // npos + 1 is 0
  if (text.size() >= 2 && text.front() == '"' && text.back() == '"') {
    text.remove_prefix(1);
    text.remove_suffix(1);
  }
  return text;
}

bool IsNoNumber(std::string_view word) {
  if (word.starts_with('+') || word.starts_with('-')) word.remove_prefix(1);
  const std::string lower = LowerCase(word.substr(0, 8));
  return lower.starts_with("nan") || lower.starts_with("inf") || lower.starts_with("1.#");
}

std::string LowerCase(std::string_view text) {
  std::string lower(text);
  for (char& c : lower) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return lower;
}

std::string_view WithoutComment(std::string_view name) {
  return TextBefore(name, [](std::string_view word) { return word == "#"; });
}

std::string_view WithoutHashWords(std::string_view name) {
  // "Material #25" must never be shortened to "Material".
  return TextBefore(name, [](std::string_view word) {
    return word.size() == 1 || word[1] < '0' || word[1] > '9';
  });
}

}  // namespace nacre
