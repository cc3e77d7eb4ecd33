// SPDX-License-Identifier: Apache-2.0
// cli/main.cc: the program: its commands, and the only place where errors are printed.
#include <algorithm>
#include <array>
#include <initializer_list>
#include <iterator>
#include <memory>
#include <new>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <malloc.h>
#include <unistd.h>

#include "base/error.h"
#include "base/version.h"
#include "cli/commands.h"
#include "cli/help_text.h"
#include "cli/option_text.h"
#include "cli/print.h"
#include "cli/progress.h"
#include "cli/usage_error.h"

namespace {

// CLI11 reports an unknown command as a missing one; this names it and suggests the likely one.
void CheckCommandName(const CLI::App& app, const std::vector<std::string>& reversed) {
  if (reversed.empty()) {
    throw nacre::Error(nacre::ExitCode::kUsage, "", "the command is missing",
                       "nacre help tells what there is");
  }
  if (reversed.back().empty() || reversed.back()[0] == '-') return;
  const std::string& word = reversed.back();
  const auto known =
      app.get_subcommands([&](const CLI::App* command) { return command->get_name() == word; });
  if (!known.empty()) return;
  std::vector<std::string> names;
  for (const CLI::App* command : nacre::ShownCommands(app)) names.push_back(command->get_name());
  throw nacre::Error(
      nacre::ExitCode::kUsage, "", fmt::format("unknown command \"{}\"", word),
      nacre::NearestHint(word, names, fmt::format("the commands are {}", fmt::join(names, ", "))));
}

// Turns "nacre help" into "nacre --help" and "nacre help render" into "nacre render --help". The
// result is reversed, as CLI11 reads arguments from the last to the first.
std::vector<std::string> ReversedArguments(int argc, char** argv) {
  std::vector<std::string> words(argv + std::min(argc, 1), argv + argc);
  if (!words.empty() && words[0] == "help") {
    words.erase(words.begin());
    words.emplace_back("--help");
  }
  std::reverse(words.begin(), words.end());
  return words;
}

// Runs the command, or prints what --help or --version ask for.
void Parse(CLI::App* app, std::vector<std::string> reversed) {
  try {
    app->parse(reversed);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() != 0) throw;
    std::ostringstream text;
    app->exit(error, text, text);
    nacre::PrintOut(text.str());
  }
}

struct Command {
  std::string_view name;
  void (*add)(CLI::App* app, int* exit_code);
};

// The order is that of the help.
constexpr auto kCommands = std::to_array<Command>({
    {"render", nacre::AddRenderCommand},
#ifdef NACRE_VIEW
    {"view", nacre::AddViewCommand},
#endif
    {"grid", nacre::AddGridCommand},
    {"pair", nacre::AddPairCommand},
    {"convert", nacre::AddConvertCommand},
    {"compare", nacre::AddCompareCommand},
    {"validate", nacre::AddValidateCommand},
    {"merge", nacre::AddMergeCommand},
    {"tonemap", nacre::AddTonemapCommand},
    {"info", nacre::AddInfoCommand},
    {"schema", nacre::AddSchemaCommand},
    {"report", nacre::AddReportCommand},
    {"explain", nacre::AddExplainCommand},
    {"plot", nacre::AddPlotCommand},
    {"table", nacre::AddTableCommand},
    {"study", nacre::AddStudyCommand},
});

// `word` is the first word of the command line.
void AddCommands(CLI::App* app, std::string_view word, int* exit_code) {
  app->formatter(std::make_shared<nacre::HelpFormatter>());
  app->set_help_flag("-h,--help", "Print the options that are used most");
  app->set_help_all_flag("--help-all", "Print all options, in full");
  app->set_version_flag("--version", fmt::format("nacre {} ({})", nacre::kVersion, nacre::kCommit),
                        "Print version and commit");
  app->require_subcommand(1);
  app->footer(
      "Start with:  nacre render scenes/material_grid.json -o grid.png --labels\n"
      "Exit codes: 0 done, 1 images differ, 2 cannot compare, 64 usage, 65 bad input,\n"
      "            70 internal error, 74 cannot write, 130 and 143 stopped by a signal");
  // If a command is named, adds only that one: building the options of all would noticeably delay a
  // small picture. `nacre docs` needs all commands.
  const auto named = std::ranges::find(kCommands, word, &Command::name);
  if (named != kCommands.end()) {
    named->add(app, exit_code);
  } else {
    for (const Command& command : kCommands) command.add(app, exit_code);
    nacre::AddDocsCommand(app, exit_code);
  }
  app->get_formatter()->label("SUBCOMMAND", "COMMAND");
  for (CLI::App* command : app->get_subcommands({})) {
    if (!command->get_group().empty()) command->group("Commands");  // empty: hidden
  }
}

int Run(int argc, char** argv) {
  using nacre::ExitCode;
  CLI::App app(
      "nacre renders Phong, Blinn-Phong and physically based materials on spheres and "
      "meshes, so that reflection models can be seen, measured and compared.",
      "nacre");
  int exit_code = 0;
  try {
    const std::vector<std::string> reversed = ReversedArguments(argc, argv);
    AddCommands(&app, reversed.empty() ? "" : reversed.back(), &exit_code);
    nacre::OpenStandardStreams();
    nacre::CatchStopSignals();
    CheckCommandName(app, reversed);
    nacre::CheckOptionValues(app, {reversed.rbegin(), reversed.rend()});
    Parse(&app, reversed);
    nacre::FinishOutput();
    return exit_code;
  } catch (const CLI::ParseError& error) {
    const nacre::Error usage = nacre::UsageError(app, error);
    nacre::PrintError(std::string(usage.what()) + "\n");
    return static_cast<int>(usage.code());
  } catch (const nacre::Error& error) {
    nacre::PrintError(std::string(error.what()) + "\n");
    return static_cast<int>(error.code());
  } catch (const std::bad_alloc&) {
    nacre::PrintError("error: out of memory\n  hint: a smaller picture or scene needs less\n");
  } catch (const std::exception& error) {
    nacre::PrintError("error: internal: {}\n", error.what());
  }
  return static_cast<int>(ExitCode::kInternal);
}

// Keeps freed memory in the process, as the next strips will need it again. By default, glibc
// returns larger blocks to the kernel until it has adapted its thresholds: a thousand page faults
// per frame, 3 % of the time of a small one. These limits are the largest that it would adapt to.
void KeepFreedMemory() {
#ifdef M_MMAP_THRESHOLD
  mallopt(M_MMAP_THRESHOLD, 32 << 20);
  mallopt(M_TRIM_THRESHOLD, 64 << 20);
#endif
}

constexpr std::string_view kKnownVariables[] = {
    "PATH", "LD_LIBRARY_PATH", "HOME", "USER", "LOGNAME", "TMPDIR", "TERM", "COLUMNS", "LANG",
    "FONTCONFIG_FILE", "FONTCONFIG_PATH",
    // The desktop, for the browser:
    "DISPLAY", "WAYLAND_DISPLAY", "XAUTHORITY", "DBUS_SESSION_BUS_ADDRESS", "DESKTOP_SESSION",
    "KDE_FULL_SESSION", "KDE_SESSION_VERSION", "GNOME_DESKTOP_SESSION_ID", "BROWSER",
    "SSH_CONNECTION"};
constexpr std::string_view kKnownVariableBeginnings[] = {"LC_", "XDG_", "NACRE_"};

// For variables of the C library, some of whose values name files to read. Accepts only values that
// name the library's own files.
bool NamesNoFile(std::string_view name, std::string_view value) {
  if (name == "LANGUAGE") return value.find('/') == std::string_view::npos;
  // "Europe/Berlin" is a file of the time zone database, and so are values that begin like it;
  // TZDIR is not kept.
  return name == "TZ" && !value.starts_with('/') && !value.starts_with(":/") &&
         value.find("..") == std::string_view::npos;
}

bool IsKnown(std::string_view name, std::string_view value) {
  return NamesNoFile(name, value) ||
         std::ranges::find(kKnownVariables, name) != std::end(kKnownVariables) ||
         std::ranges::any_of(kKnownVariableBeginnings,
                             [&](std::string_view begin) { return name.starts_with(begin); });
}

// Removes all variables from an environment except those that the program, or programs that it
// starts (gnuplot, a browser), need: where programs, libraries, fonts and a display are, who the
// user is, and the language and time zone, if these name no user's files. The libraries in use read
// hundreds of other variables, and some of these name code to load: OIIO_LIBRARY_PATH,
// INTEL_LIBITTNOTIFY64 (oneTBB), GCONV_PATH (glibc), LIBHEIF_PLUGIN_PATH, OPENSSL_CONF, ... The
// array is changed in place without allocating, so that no library, not even the C library, must
// have been initialised.
void KeepKnownEnvironment(char** environment) {
  char** kept = environment;
  for (char** entry = environment; *entry != nullptr; ++entry) {
    const std::string_view text = *entry;
    const size_t end = std::min(text.find('='), text.size());
    if (IsKnown(text.substr(0, end), text.substr(std::min(end + 1, text.size())))) *kept++ = *entry;
  }
  *kept = nullptr;
}

// Runs before the constructors of libraries, in which oneTBB (since 2021.12) loads the code that an
// environment variable names.
void Start(int, char**, char** environment) { KeepKnownEnvironment(environment); }
[[gnu::section(".preinit_array"), gnu::used]] void (*const g_start)(int, char**, char**) = Start;

// Does not format or allocate, since that may be what failed.
int FailPlainly(std::initializer_list<std::string_view> message) {
  for (const std::string_view part : message) {
    [[maybe_unused]] const ssize_t written = write(STDERR_FILENO, part.data(), part.size());
  }
  return static_cast<int>(nacre::ExitCode::kInternal);
}

}  // namespace

// Handles what Run does not: exceptions before or during its own reports, and of unknown type.
int main(int argc, char** argv) {
  KeepKnownEnvironment(environ);  // again, for C libraries that do not call Start
  KeepFreedMemory();
  try {
    return Run(argc, argv);
  } catch (const std::bad_alloc&) {
    return FailPlainly(
        {"error: out of memory\n  hint: give the program more, not even a message had room\n"});
  } catch (const std::exception& error) {
    return FailPlainly({"error: internal: ", error.what(), "\n"});
  } catch (...) {
    return FailPlainly({"error: internal: an exception that is no std::exception\n"});
  }
}
