// SPDX-License-Identifier: Apache-2.0
// base/excerpt.h: shortens text from files for messages.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace nacre {

// The first `longest` bytes of `text`, followed by "..." if it is longer. No UTF-8 character is
// cut.
inline std::string Shortened(std::string_view text, size_t longest) {
  size_t length = text.size();
  if (length > longest) {
    length = longest;
    while (length > 0 && (static_cast<unsigned char>(text[length]) & 0xc0) == 0x80) --length;
  }
  std::string excerpt(text.substr(0, length));
  if (length < text.size()) excerpt += "...";
  return excerpt;
}

// The beginning of the text's first line, shortened in the same way. Names, numbers and URIs in
// files may have megabytes, so everything that is quoted from a file goes through one of these
// functions.
inline std::string Excerpt(std::string_view text, size_t longest = 80) {
  const size_t line_end = text.find_first_of("\r\n");
  if (line_end >= longest) return Shortened(text, longest);  // npos, too
  return std::string(text.substr(0, line_end)) + "...";
}

}  // namespace nacre
