// SPDX-License-Identifier: Apache-2.0
// base/numbers.h: numbers in the text of files.
#pragma once

#include <optional>
#include <string_view>
#include <vector>

namespace nacre {

// The number that is all of `word`, which may begin with a + and have no digits on one side of its
// point. Numbers too small for a double are 0. Nothing for what is no number, NaN, and what is not
// finite.
std::optional<double> ParseNumber(std::string_view word);

// All the numbers of the text, with blanks between them. Nothing if any word of it is none.
std::optional<std::vector<double>> ParseNumbers(std::string_view text);

}  // namespace nacre
