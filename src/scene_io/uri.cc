// SPDX-License-Identifier: Apache-2.0
#include "scene_io/uri.h"

#include <charconv>
#include <cstdint>

#include "scene_io/text_lines.h"

namespace nacre {
namespace {

// The value of a base64 digit in either alphabet; negative for other characters.
int Base64Digit(char c) {
  if (c >= 'A' && c <= 'Z') return c - 'A';
  if (c >= 'a' && c <= 'z') return c - 'a' + 26;
  if (c >= '0' && c <= '9') return c - '0' + 52;
  if (c == '+' || c == '-') return 62;
  return c == '/' || c == '_' ? 63 : -1;
}

std::optional<std::string> DecodeBase64(std::string_view text) {
  while (text.ends_with('=')) text.remove_suffix(1);
  if (text.size() % 4 == 1) return std::nullopt;  // a single digit has only six bits
  std::string bytes;
  bytes.reserve(text.size() / 4 * 3 + 2);
  uint32_t bits = 0;
  int count = 0;
  for (const char c : text) {
    const int digit = Base64Digit(c);
    if (digit < 0) return std::nullopt;
    bits = bits << 6 | static_cast<uint32_t>(digit);
    count += 6;
    if (count < 8) continue;
    count -= 8;
    bytes += static_cast<char>(bits >> count);
  }
  return bytes;
}

}  // namespace

std::string PercentDecoded(std::string_view text) {
  std::string decoded;
  decoded.reserve(text.size());
  for (size_t i = 0; i < text.size(); ++i) {
    unsigned code = 0;
    const char* const digits = text.data() + i + 1;
    if (text[i] == '%' && i + 2 < text.size() &&
        std::from_chars(digits, digits + 2, code, 16).ptr == digits + 2) {
      decoded += static_cast<char>(code);
      i += 2;
    } else {
      decoded += text[i];
    }
  }
  return decoded;
}

bool IsDataUri(std::string_view uri) { return LowerCase(uri.substr(0, 5)) == "data:"; }

std::optional<std::string> DecodeDataUri(std::string_view uri) {
  const size_t comma = uri.find(',');
  if (!IsDataUri(uri) || comma == std::string_view::npos) return std::nullopt;
  const std::string_view parameters = uri.substr(0, comma), data = uri.substr(comma + 1);
  const size_t last = parameters.rfind(';');
  const bool is_base64 =
      last != std::string_view::npos && LowerCase(parameters.substr(last)) == ";base64";
  if (!is_base64) return PercentDecoded(data);
  // Some encoders write + and = percent-encoded.
  if (data.find('%') == std::string_view::npos) return DecodeBase64(data);
  return DecodeBase64(PercentDecoded(data));
}

}  // namespace nacre
