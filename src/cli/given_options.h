// SPDX-License-Identifier: Apache-2.0
// cli/given_options.h: makes options that cannot apply to what a command does errors, so that none
// is silently ignored.
#pragma once

#include <functional>
#include <string>

#include <CLI/App.hpp>

namespace nacre {

// Throws Error (kUsage) for the first option of `command` that the user gave and that does not
// apply: "NAME: cannot be used with WHAT", with `hint`.
void RefuseOptions(const CLI::App& command, const std::function<bool(const CLI::Option&)>& applies,
                   const std::string& what, const std::string& hint);

}  // namespace nacre
