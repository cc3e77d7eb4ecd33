// SPDX-License-Identifier: Apache-2.0
// cli/manual.h: documents derived from the definitions of the command line.
#pragma once

#include <string>
#include <vector>

#include <CLI/App.hpp>

namespace nacre {

// The commands that the help shows: all except those in the nameless group.
std::vector<const CLI::App*> ShownCommands(const CLI::App& app);

// A manual page (man 7 man) of the program and all of its commands.
std::string ManPage(const CLI::App& app);

// A script for bash: completes commands, options, the choices of options, and files.
std::string BashCompletion(const CLI::App& app);

}  // namespace nacre
