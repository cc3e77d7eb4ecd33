// SPDX-License-Identifier: Apache-2.0
#include "base/numbers.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <system_error>

namespace nacre {
namespace {

// Whether a number that std::from_chars reports as out of range underflows rather than overflows.
// The sign of its exponent decides, as only a text with as many digits as the exponent says could
// compensate for it.
bool IsTooSmall(std::string_view word) {
  const size_t exponent = word.find_first_of("eE");
  if (exponent != std::string_view::npos) return word[exponent + 1] == '-';
  const size_t first = word.find_first_not_of("+-0");
  return first != std::string_view::npos && word[first] == '.';
}

}  // namespace

std::optional<double> ParseNumber(std::string_view word) {
  if (word.starts_with('+') && !word.starts_with("+-")) word.remove_prefix(1);
  double number = 0;
  const char* const word_end = word.data() + word.size();
  const auto [end, error] = std::from_chars(word.data(), word_end, number);
  if (end != word_end) return std::nullopt;
  if (error == std::errc::result_out_of_range && IsTooSmall(word)) return 0.0;
  if (error != std::errc() || !std::isfinite(number)) return std::nullopt;
  return number;
}

std::optional<std::vector<double>> ParseNumbers(std::string_view text) {
  constexpr std::string_view kBlanks = " \t";
  std::vector<double> numbers;
  while (true) {
    text.remove_prefix(std::min(text.find_first_not_of(kBlanks), text.size()));
    if (text.empty()) return numbers;
    const std::string_view word = text.substr(0, text.find_first_of(kBlanks));
    const std::optional<double> number = ParseNumber(word);
    if (!number) return std::nullopt;
    numbers.push_back(*number);
    text.remove_prefix(word.size());
  }
}

std::optional<std::vector<int>> ParseIntegers(std::string_view text, char separator, size_t count) {
  std::vector<int> numbers;
  while (true) {
    const size_t end = std::min(text.find(separator), text.size());
    int value = 0;
    const auto [rest, error] = std::from_chars(text.data(), text.data() + end, value);
    if (error != std::errc() || rest != text.data() + end) return std::nullopt;
    numbers.push_back(value);
    if (end == text.size()) break;
    text.remove_prefix(end + 1);
  }
  return numbers.size() == count ? std::optional(numbers) : std::nullopt;
}

}  // namespace nacre
