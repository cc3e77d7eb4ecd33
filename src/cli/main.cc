// SPDX-License-Identifier: Apache-2.0
// cli/main.cc: the program: commands, and the one place where errors are printed.
#include <algorithm>
#include <iostream>
#include <memory>
#include <new>
#include <string_view>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include "base/error.h"
#include "base/version.h"
#include "cli/commands.h"
#include "cli/help_text.h"
#include "cli/print.h"
#include "cli/progress.h"

namespace {

// CLI11 takes an unknown command for a missing one; this names it and the one likely meant.
void CheckCommandName(const CLI::App& app, int argc, char** argv) {
  if (argc < 2 || argv[1][0] == '-') return;
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands({})) names.push_back(command->get_name());
  if (std::find(names.begin(), names.end(), argv[1]) != names.end()) return;
  const std::string nearest = nacre::NearestName(argv[1], names);
  throw nacre::Error(nacre::ExitCode::kUsage, "", fmt::format("unknown command \"{}\"", argv[1]),
                     nearest.empty() ? fmt::format("the commands are {}", fmt::join(names, ", "))
                                     : fmt::format("did you mean \"{}\"?", nearest));
}

int Run(int argc, char** argv) {
  using nacre::ExitCode;
  CLI::App app(
      "nacre renders shading models on spheres and meshes: exact hits, SIMD shading, HDR output.",
      "nacre");
  app.formatter(std::make_shared<nacre::HelpFormatter>());
  app.set_version_flag("--version", fmt::format("nacre {} ({})", nacre::kVersion, nacre::kCommit));
  app.require_subcommand(1);
  app.footer(
      "Start with:  nacre render scenes/material_grid.json -o grid.png --labels\n"
      "Exit codes: 0 done, 1 images differ, 2 cannot compare, 64 usage, 65 bad input,\n"
      "            70 internal error, 74 cannot write, 130 and 143 stopped by a signal");
  int exit_code = 0;
  nacre::AddRenderCommand(&app, &exit_code);
  nacre::AddGridCommand(&app, &exit_code);
  nacre::AddPairCommand(&app, &exit_code);
  nacre::AddConvertCommand(&app, &exit_code);
  nacre::AddCompareCommand(&app, &exit_code);
  nacre::AddValidateCommand(&app, &exit_code);
  nacre::AddMergeCommand(&app, &exit_code);
  nacre::AddTonemapCommand(&app, &exit_code);
  nacre::AddInfoCommand(&app, &exit_code);
  nacre::AddSchemaCommand(&app, &exit_code);
  nacre::AddReportCommand(&app, &exit_code);
  nacre::AddExplainCommand(&app, &exit_code);
  nacre::AddPlotCommand(&app, &exit_code);
  nacre::AddStudyCommand(&app, &exit_code);
  nacre::AddDocsCommand(&app, &exit_code);
  try {
    nacre::OpenStandardStreams();
    nacre::CatchStopSignals();
    CheckCommandName(app, argc, argv);
    app.parse(argc, argv);
    nacre::FinishOutput();
    return exit_code;
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) {  // --help, --version
      app.exit(error);
      std::cout.flush();
      return static_cast<int>(std::cout ? ExitCode::kOk : ExitCode::kCannotWrite);
    }
    nacre::PrintError(
        fmt::format("error: {}\n  hint: see nacre --help, or nacre COMMAND --help", error.what()));
    return static_cast<int>(ExitCode::kUsage);
  } catch (const nacre::Error& error) {
    nacre::PrintError(std::string(error.what()) + "\n");
    return static_cast<int>(error.code());
  } catch (const std::bad_alloc&) {
    nacre::PrintError("error: out of memory\n  hint: a smaller picture or scene needs less\n");
  } catch (const std::exception& error) {
    nacre::PrintError(fmt::format("error: internal: {}\n", error.what()));
  }
  return static_cast<int>(ExitCode::kInternal);
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return Run(argc, argv);
  } catch (...) {  // not even the message of an error could be put together
    constexpr std::string_view kMessage =
        "error: out of memory\n  hint: give the program more, not even a message had room\n";
    [[maybe_unused]] const ssize_t written = write(STDERR_FILENO, kMessage.data(), kMessage.size());
    return static_cast<int>(nacre::ExitCode::kInternal);
  }
}
