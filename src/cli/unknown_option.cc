// SPDX-License-Identifier: Apache-2.0
#include "cli/unknown_option.h"

#include <algorithm>
#include <array>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "cli/option_text.h"

namespace nacre {
namespace {

// Names that other renderers, viewers and comparing tools have for options of ours. Where a command
// does not have the option, the pair is passed over.
constexpr std::array<std::pair<std::string_view, std::string_view>, 28> kOtherNames = {{
    {"--samples", "--spp"},
    {"--sample-count", "--spp"},
    {"--samples-per-pixel", "--spp"},
    {"--quality", "--spp"},
    {"--out", "-o"},
    {"--outfile", "-o"},
    {"--output-file", "-o"},
    {"--resolution", "--size"},
    {"--res", "--size"},
    {"--width", "--size"},
    {"--height", "--size"},
    {"-w", "--size"},
    {"--crop", "--region"},
    {"--cropwindow", "--region"},
    {"--window", "--region"},
    {"--nthreads", "--threads"},
    {"--jobs", "--threads"},
    {"-j", "--threads"},
    {"-t", "--threads"},
    {"--env", "--environment"},
    {"--envmap", "--environment"},
    {"--hdri", "--environment"},
    {"--ibl", "--environment"},
    {"--aovs", "--layers"},
    {"--noise", "--max-error"},
    {"--silent", "--quiet"},
    {"-D", "--set"},
    {"--tone-map", "--tonemap"},
}};

// The command that was being read: the innermost that was named.
const CLI::App* NamedCommand(const CLI::App& app) {
  const CLI::App* command = &app;
  while (!command->get_subcommands().empty()) command = command->get_subcommands().back();
  return command;
}

// The nearest of the command's names and of the other names for its options, or "".
std::string OptionMeant(const std::string& word, const std::vector<std::string>& names) {
  std::vector<std::string> candidates = names;
  for (const auto& [other, ours] : kOtherNames) {
    if (std::find(names.begin(), names.end(), ours) != names.end()) candidates.emplace_back(other);
  }
  const std::string nearest = NearestName(word, candidates);
  const auto other = std::find_if(kOtherNames.begin(), kOtherNames.end(),
                                  [&](const auto& pair) { return pair.first == nearest; });
  const bool is_ours = std::find(names.begin(), names.end(), nearest) != names.end();
  return is_ours || other == kOtherNames.end() ? nearest : std::string(other->second);
}

}  // namespace

std::optional<Error> UnknownArgument(const CLI::App& app, const CLI::ParseError& failure) {
  const auto code = static_cast<CLI::ExitCodes>(failure.get_exit_code());
  const CLI::App& command = *NamedCommand(app);
  const std::vector<std::string> rest = app.remaining(/*recurse=*/true);
  // CLI11 gives the values of unknown options as well, and in an order of its own: an option is
  // reported before a value.
  const auto option = std::find_if(rest.begin(), rest.end(), [](const std::string& word) {
    return word.size() > 1 && word[0] == '-';
  });
  const bool may_be = code == CLI::ExitCodes::ExtrasError ||
                      (code == CLI::ExitCodes::RequiredError && option != rest.end());
  if (!may_be) return std::nullopt;
  const std::string help = command.get_name() == app.get_name()
                               ? "nacre --help-all"
                               : fmt::format("nacre {} --help-all", command.get_name());
  if (option == rest.end()) {
    const std::string word = rest.empty() ? std::string() : rest.front();
    return Error(ExitCode::kUsage, "", fmt::format("unexpected argument \"{}\"", word),
                 fmt::format("{} tells what it takes", help));
  }
  const std::string word = option->substr(0, option->find('='));
  std::vector<std::string> names;
  for (const CLI::Option* known : command.get_options()) {
    for (std::string& name : NamesOf(*known)) names.push_back(std::move(name));
  }
  if (word == "--fast") {
    return Error(ExitCode::kUsage, "", "unknown option --fast: the fast mode is gone",
                 "leave it out: samples reach the fast mode's error sooner");
  }
  const std::string meant = OptionMeant(word, names);
  return Error(ExitCode::kUsage, "", fmt::format("unknown option {}", word),
               meant.empty() ? fmt::format("{} tells every option", help)
                             : fmt::format("did you mean {}? {} tells every option", meant, help));
}

}  // namespace nacre
