// SPDX-License-Identifier: Apache-2.0
// cli/help_text.h: how --help and --help-all look: within 80 columns, what an option does beside or
// below it.
//
// --help fits a screen: the options that are used most, each by the first of its sentences, and the
// names of the others. --help-all has all of it.
#pragma once

#include <string>
#include <vector>

#include <CLI/CLI.hpp>

namespace nacre {

// --help gives these options of the command by their names alone.
void MoveBehindHelpAll(CLI::App* command, const std::vector<std::string>& names);

class HelpFormatter final : public CLI::Formatter {
 public:
  std::string make_help(const CLI::App* app, std::string name,
                        CLI::AppFormatMode mode) const override;
  std::string make_subcommand(const CLI::App* command) const override;
  std::string make_description(const CLI::App* app) const override;
};

}  // namespace nacre
