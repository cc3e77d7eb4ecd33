// SPDX-License-Identifier: Apache-2.0
// cli/manual.h: the command line as others read it, written from its own definitions.
#pragma once

#include <string>
#include <vector>

#include <CLI/App.hpp>

namespace nacre {

// What help shows: not what is in the nameless group.
std::vector<const CLI::App*> ShownCommands(const CLI::App& app);

// A manual page (man 7 man) of the program and all of its commands.
std::string ManPage(const CLI::App& app);

// A script for bash: completes commands, options, the choices of options, and files.
std::string BashCompletion(const CLI::App& app);

}  // namespace nacre
