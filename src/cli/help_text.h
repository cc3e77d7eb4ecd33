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

// Wraps words into lines that begin at column `indent`; the first line continues at column `at`.
std::string WrapWordsAt(const std::string& text, size_t indent, size_t at, size_t columns = 80);

// In --help, only the names of these options of the command are shown.
void MoveBehindHelpAll(CLI::App* command, const std::vector<std::string>& names);

// Options that are added to the command while this object exists belong to the group.
class InGroup {
 public:
  InGroup(CLI::App* command, const std::string& group)
      : defaults_(command->option_defaults()), before_(defaults_->get_group()) {
    defaults_->group(group);
  }
  ~InGroup() { defaults_->group(before_); }
  InGroup(const InGroup&) = delete;
  InGroup& operator=(const InGroup&) = delete;

 private:
  CLI::OptionDefaults* defaults_;
  std::string before_;
};

class HelpFormatter final : public CLI::Formatter {
 public:
  std::string make_help(const CLI::App* app, std::string name,
                        CLI::AppFormatMode mode) const override;
  std::string make_subcommand(const CLI::App* command) const override;
  std::string make_description(const CLI::App* app) const override;
};

}  // namespace nacre
