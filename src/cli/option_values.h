// SPDX-License-Identifier: Apache-2.0
// cli/option_values.h: finds options without a value, for which CLI11 would take the next word.
#pragma once

#include <string>
#include <vector>

#include <CLI/App.hpp>

namespace nacre {

// `words` are a command's name and its arguments, in the order of the command line. Throws Error
// (kUsage) for an option whose value is missing ("--size=", "--layers --size"), and for a list with
// an empty element (",", "a,,b", "a,"): CLI11 drops empty elements, and if nothing is left, takes
// the next word as the value, whatever it is.
void CheckOptionValues(const CLI::App& app, const std::vector<std::string>& words);

}  // namespace nacre
