// SPDX-License-Identifier: Apache-2.0
// cli/help_text.h: the layout of --help and --help-all: within 80 columns, with an option's
// explanation beside or below it.
//
// --help fits a screen: it shows the first sentence of the most used options, and only the names of
// the others. --help-all shows everything.
#pragma once

#include <string>
#include <vector>

#include <CLI/CLI.hpp>

namespace nacre {

// In --help, only the names of these options of the command are shown.
void MoveBehindHelpAll(CLI::App* command, const std::vector<std::string>& names);

class HelpFormatter final : public CLI::Formatter {
 public:
  std::string make_help(const CLI::App* app, std::string name,
                        CLI::AppFormatMode mode) const override;
  std::string make_subcommand(const CLI::App* command) const override;
  std::string make_description(const CLI::App* app) const override;
};

}  // namespace nacre
