// SPDX-License-Identifier: Apache-2.0
// cli/cmd_docs.cc: nacre docs man|bash: prints files to install beside the program. Hidden from the
// help.
#include <memory>
#include <string>

#include <CLI/CLI.hpp>

#include "cli/commands.h"
#include "cli/manual.h"
#include "cli/print.h"

namespace nacre {

void AddDocsCommand(CLI::App* app, int*) {
  CLI::App* command = app->add_subcommand("docs", "Print the manual page or shell completion");
  command->group("");  // hidden
  const auto kind = std::make_shared<std::string>();
  command->add_option("KIND", *kind, "man or bash")
      ->required()
      ->check(CLI::IsMember({"man", "bash"}));
  command->footer(
      "Examples:\n"
      "  nacre docs man | man -l -\n"
      "  source <(nacre docs bash)");
  command->callback(
      [app, kind] { PrintOut(*kind == "man" ? ManPage(*app) : BashCompletion(*app)); });
}

}  // namespace nacre
