// SPDX-License-Identifier: Apache-2.0
// base/numbers.h: parses numbers in the text of files and options.
#pragma once

#include <cstddef>
#include <optional>
#include <string_view>
#include <vector>

namespace nacre {

// Parses all of `word` as a number, which may begin with a + and lack digits on one side of its
// point. Numbers too small for a double become 0. nullopt for anything else, including NaN and
// numbers that are not finite.
std::optional<double> ParseNumber(std::string_view word);

// Parses all words of the text, separated by blanks, as numbers. nullopt if any word is not one.
std::optional<std::vector<double>> ParseNumbers(std::string_view text);

// Parses `count` whole numbers separated by `separator`, with nothing around them; nullopt if the
// text is anything else.
std::optional<std::vector<int>> ParseIntegers(std::string_view text, char separator, size_t count);

}  // namespace nacre
