// SPDX-License-Identifier: Apache-2.0
// cli/option_values.h: options without their values, which CLI11 gives the next word as a value.
#pragma once

#include <string>
#include <vector>

#include <CLI/App.hpp>

namespace nacre {

// `words`: a command's name and its arguments, in the order of the command line. Throws Error
// (usage) for an option whose value is missing ("--size=", "--layers --size") and for a list with
// an empty element (",", "a,,b", "a,"): CLI11 drops empty elements, and takes the next word,
// whatever it is, where nothing is left.
void CheckOptionValues(const CLI::App& app, const std::vector<std::string>& words);

}  // namespace nacre
