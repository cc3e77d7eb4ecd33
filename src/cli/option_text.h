// SPDX-License-Identifier: Apache-2.0
// cli/option_text.h: options in words, from their own definitions: for help, manual and shell.
#pragma once

#include <string>
#include <vector>

#include <CLI/App.hpp>

namespace nacre {

// "-o", "--output": as they are typed. None of what has a place instead.
std::vector<std::string> NamesOf(const CLI::Option& option);

bool TakesValue(const CLI::Option& option);

// The names that an option may be given. Empty: anything.
std::vector<std::string> ChoicesOf(const CLI::Option& option);

// What stands for the value: "FILE", "N", "half|float".
std::string ValueName(const CLI::Option& option);

// What it does, with its bounds and its value where none is given.
std::string OptionText(const CLI::Option& option);

}  // namespace nacre
