// SPDX-License-Identifier: Apache-2.0
// cli/help_text.h: how --help looks: within 80 columns, what an option does beside or below it.
#pragma once

#include <string>

#include <CLI/CLI.hpp>

namespace nacre {

class HelpFormatter final : public CLI::Formatter {
 public:
  std::string make_option(const CLI::Option* option, bool is_positional) const override;
  std::string make_subcommand(const CLI::App* command) const override;
  std::string make_description(const CLI::App* app) const override;
};

}  // namespace nacre
