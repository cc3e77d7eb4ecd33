// SPDX-License-Identifier: Apache-2.0
// cli/given_options.h: options that cannot apply to what a command is about to do are errors: none
// is silently ignored.
#pragma once

#include <functional>
#include <string>

#include <CLI/App.hpp>

namespace nacre {

// Throws Error (usage) for the first option of `command` that the user gave and that does not
// apply: "NAME: cannot be used with WHAT", with this hint.
void RefuseOptions(const CLI::App& command, const std::function<bool(const CLI::Option&)>& applies,
                   const std::string& what, const std::string& hint);

}  // namespace nacre
