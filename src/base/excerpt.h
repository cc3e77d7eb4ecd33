// SPDX-License-Identifier: Apache-2.0
// base/excerpt.h: how much of a file's text a message shows.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace nacre {

// The beginning of `text`, up to its first line end and `longest` bytes, with "..." for what is
// left out. No UTF-8 character is cut. A file's names, numbers and URIs may have megabytes, so
// whatever is quoted from a file goes through this.
inline std::string Excerpt(std::string_view text, size_t longest = 80) {
  size_t length = text.find_first_of("\r\n");
  if (length > text.size()) length = text.size();
  if (length > longest) {
    length = longest;
    while (length > 0 && (static_cast<unsigned char>(text[length]) & 0xc0) == 0x80) --length;
  }
  std::string excerpt(text.substr(0, length));
  if (length < text.size()) excerpt += "...";
  return excerpt;
}

}  // namespace nacre
