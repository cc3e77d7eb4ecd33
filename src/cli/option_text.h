// SPDX-License-Identifier: Apache-2.0
// cli/option_text.h: texts about commands and options, derived from their definitions: for help,
// manual and shell.
#pragma once

#include <string>
#include <vector>

#include <CLI/App.hpp>

namespace nacre {

// The commands that the help shows: all except those in the nameless group.
std::vector<const CLI::App*> ShownCommands(const CLI::App& app);

// The names as typed: "-o", "--output". Empty for positional arguments.
std::vector<std::string> NamesOf(const CLI::Option& option);

bool TakesValue(const CLI::Option& option);

// The values among which an option chooses. Empty: any value is allowed.
std::vector<std::string> ChoicesOf(const CLI::Option& option);

// The placeholder for the value: "FILE", "N", "half|float".
std::string ValueName(const CLI::Option& option);

// What the option does, with its bounds and its default.
std::string OptionText(const CLI::Option& option);

}  // namespace nacre
