// SPDX-License-Identifier: Apache-2.0
// cli/usage_error.h: errors of the command line: what CLI11 refuses, what it would misread, and
// what has no meaning for what a command does, so that no option is silently ignored.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include <CLI/App.hpp>

#include "base/error.h"

namespace nacre {

// Words the error as nacre does. The first argument that the command cannot use is named, with the
// option that was likely meant, judged by its spelling or by the name in other programs. A required
// option that is missing may have been misspelt.
Error UsageError(const CLI::App& app, const CLI::ParseError& failure);

// `words` are a command's name and its arguments, in the order of the command line. Throws Error
// (kUsage) for an option whose value is missing ("--size=", "--layers --size"), and for a list with
// an empty element (",", "a,,b", "a,"): CLI11 drops empty elements, and if nothing is left, takes
// the next word as the value, whatever it is.
void CheckOptionValues(const CLI::App& app, const std::vector<std::string>& words);

// Throws Error (kUsage) for the first option of `command` that the user gave and that does not
// apply: "NAME: cannot be used with WHAT", with `hint`.
void RefuseOptions(const CLI::App& command, const std::function<bool(const CLI::Option&)>& applies,
                   const std::string& what, const std::string& hint);

}  // namespace nacre
