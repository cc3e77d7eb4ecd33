// SPDX-License-Identifier: Apache-2.0
#include "cli/usage_error.h"

#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "cli/option_text.h"

namespace nacre {
namespace {

// Names that other renderers, viewers and comparison tools have for options of nacre. A pair is
// ignored if the command does not have the option.
constexpr auto kOtherNames = std::to_array<std::pair<std::string_view, std::string_view>>({
    {"--samples", "--spp"},
    {"--sample-count", "--spp"},
    {"--samples-per-pixel", "--spp"},
    {"--quality", "--spp"},
    {"--passes", "--spp"},
    {"+A", "--spp"},
    {"--out", "-o"},
    {"--outfile", "-o"},
    {"--output-file", "-o"},
    {"--render-output", "-o"},
    {"+O", "-o"},
    {"--resolution", "--size"},
    {"--res", "--size"},
    {"--resize", "--size"},
    {"--scale", "--size"},
    {"--width", "--size"},
    {"--height", "--size"},
    {"-w", "--size"},
    {"-r", "--size"},
    {"+W", "--size"},
    {"+H", "--size"},
    {"--crop", "--region"},
    {"--cropwindow", "--region"},
    {"--pixelbounds", "--region"},
    {"--pixel", "--region"},
    {"--window", "--region"},
    {"--nthreads", "--threads"},
    {"--num-threads", "--threads"},
    {"--jobs", "--threads"},
    {"-j", "--threads"},
    {"-t", "--threads"},
    {"--env", "--environment"},
    {"--envmap", "--environment"},
    {"--hdri", "--environment"},
    {"--ibl", "--environment"},
    {"--aovs", "--layers"},
    {"--aov", "--layers"},
    {"--channels", "--layers"},
    {"--ch", "--layers"},
    {"--bit-depth", "--depth"},
    {"-d", "--depth"},
    {"--noise", "--max-error"},
    {"--silent", "--quiet"},
    {"-q", "--quiet"},
    {"--verbose", "--explain"},
    {"-v", "--explain"},
    {"--log-level", "--progress"},
    {"--device", "--target"},
    {"-D", "--set"},
    {"--define", "--set"},
    {"--override", "--set"},
    {"--ev", "--exposure"},
    {"--tone-map", "--tonemap"},
    {"--gamma", "--tonemap"},
    {"--view-transform", "--tonemap"},
    {"--mode", "--intersector"},
    {"-fail", "--max-abs"},
    {"--fail", "--max-abs"},
    {"--tolerance", "--max-abs"},
    {"--failpercent", "--fraction"},
    {"--threshold", "--max-rel"},
});

// Options of other programs for what nacre does differently, with an explanation.
constexpr auto kOtherWays = std::to_array<std::pair<std::string_view, std::string_view>>({
    {"--frame", "a scene is one picture: change it by --set, and call once for each frame"},
    {"--frames", "a scene is one picture: change it by --set, and call once for each frame"},
    {"--render-frame", "a scene is one picture: change it by --set, and call once for each frame"},
    {"-f", "a scene is one picture: change it by --set, and call once for each frame"},
    {"--format", "the name behind -o says the format: .png or .exr"},
    {"--render-format", "the name behind -o says the format: .png or .exr"},
    {"-F", "the name behind -o says the format: .png or .exr"},
    {"-i", "files that are read are named without an option"},
    {"--input", "files that are read are named without an option"},
    {"--scene", "files that are read are named without an option"},
    {"--gpu", "nacre renders on the processor: --target chooses its instructions"},
    {"--engine", "there is one renderer: --target chooses its instructions"},
    {"--integrator", "light goes from lights to surfaces to the camera, without further bounces"},
    {"--bounces", "light goes from lights to surfaces to the camera, without further bounces"},
    {"--max-depth", "light goes from lights to surfaces to the camera, without further bounces"},
    {"--denoise", "ask for fewer errors: more samples (--spp), or an error (--max-error)"},
    {"--background", "nacre opens no window; a scene's colour is --set /background=0"},
    {"-b", "nacre opens no window"},
    {"--camera", "change a scene's camera by --set, e.g. /camera/position=[0,1,6]"},
    {"--fast", "the fast mode is gone: leave it out, samples reach its error sooner"},
});

// The innermost command that was named.
const CLI::App* NamedCommand(const CLI::App& app) {
  const CLI::App* command = &app;
  while (!command->get_subcommands().empty()) command = command->get_subcommands().back();
  return command;
}

// The nearest name among the command's options and their other names, or "".
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

std::string HelpOf(const CLI::App& app, const CLI::App& command) {
  return command.get_name() == app.get_name()
             ? "nacre --help-all"
             : fmt::format("nacre {} --help-all", command.get_name());
}

bool LooksLikeOption(const std::string& word) {
  return word.size() > 1 &&
         (word[0] == '-' || (word[0] == '+' && word[1] >= 'A' && word[1] <= 'Z'));
}

// The error for the first argument that the command cannot use; nullopt if the parse failed for
// another reason.
std::optional<Error> UnknownArgument(const CLI::App& app, const CLI::ParseError& failure) {
  const auto code = static_cast<CLI::ExitCodes>(failure.get_exit_code());
  const CLI::App& command = *NamedCommand(app);
  std::vector<std::string> rest = app.remaining(/*recurse=*/true);
  const bool options_end = std::erase(rest, "--") > 0;
  // CLI11 also lists the values of unknown options, in an order of its own; options are reported
  // first.
  const auto option = std::find_if(rest.begin(), rest.end(), LooksLikeOption);
  const bool may_be = code == CLI::ExitCodes::ExtrasError ||
                      (code == CLI::ExitCodes::RequiredError && option != rest.end());
  if (!may_be) return std::nullopt;
  const std::string help = HelpOf(app, command);
  if (option == rest.end()) {
    const std::string word = rest.empty() ? std::string() : rest.front();
    return Error(ExitCode::kUsage, "", fmt::format("unexpected argument \"{}\"", word),
                 fmt::format("{} tells what it takes", help));
  }
  // In POV-Ray's options, the value follows a single letter directly.
  const std::string word = option->substr(0, (*option)[0] == '+' ? 2 : option->find('='));
  std::vector<std::string> names;
  for (const CLI::Option* known : command.get_options()) {
    for (std::string& name : NamesOf(*known)) names.push_back(std::move(name));
  }
  if (options_end && std::find(names.begin(), names.end(), word) != names.end()) {
    return Error(ExitCode::kUsage, word, "is behind --, which ends the options",
                 "write it before --");
  }
  const auto way = std::find_if(kOtherWays.begin(), kOtherWays.end(),
                                [&](const auto& pair) { return pair.first == word; });
  if (way != kOtherWays.end()) {
    return Error(ExitCode::kUsage, "", fmt::format("unknown option {}", word),
                 std::string(way->second));
  }
  const std::string meant = OptionMeant(word, names);
  return Error(ExitCode::kUsage, "", fmt::format("unknown option {}", word),
               meant.empty() ? fmt::format("{} tells every option", help)
                             : fmt::format("did you mean {}? {} tells every option", meant, help));
}

// The error for an option's invalid value; for a list, its first one.
Error ValueError(const CLI::Option& option, const std::string& where, const std::string& told,
                 const std::string& help) {
  const std::vector<std::string> choices = ChoicesOf(option);
  const std::vector<std::string> given = option.results();
  const auto wrong = std::find_if(given.begin(), given.end(), [&](const std::string& value) {
    return std::find(choices.begin(), choices.end(), value) == choices.end();
  });
  if (choices.empty() || wrong == given.end()) {
    return Error(ExitCode::kUsage, where, told, fmt::format("{} tells what it takes", help));
  }
  const std::string nearest = NearestName(*wrong, choices);
  return Error(ExitCode::kUsage, where, fmt::format("\"{}\" is none of its values", *wrong),
               nearest.empty() ? fmt::format("one of: {}", fmt::join(choices, ", "))
                               : fmt::format("did you mean \"{}\"?", nearest));
}

}  // namespace

Error UsageError(const CLI::App& app, const CLI::ParseError& failure) {
  if (std::optional<Error> unknown = UnknownArgument(app, failure)) return *std::move(unknown);
  const CLI::App& command = *NamedCommand(app);
  const std::string help = HelpOf(app, command), message = failure.what();
  // CLI11 names the option only in its message: "--spp: At Most 1 required ...", "--output is
  // required", "Could not convert: --seed = x".
  constexpr std::string_view kConversion = "Could not convert: ";
  const std::string text =
      message.starts_with(kConversion) ? message.substr(kConversion.size()) : message;
  const std::string name = text.substr(0, text.find_first_of(" :"));
  const CLI::Option* const option = command.get_option_no_throw(name);
  if (option == nullptr) return Error(ExitCode::kUsage, "", message, help + " tells every option");
  switch (static_cast<CLI::ExitCodes>(failure.get_exit_code())) {
    case CLI::ExitCodes::RequiredError:
      return Error(ExitCode::kUsage, name, "is required",
                   fmt::format("{} tells what there is", help));
    case CLI::ExitCodes::ArgumentMismatch:
      if (option->results().size() > 1) {
        return Error(ExitCode::kUsage, name,
                     fmt::format("is given {} times", option->results().size()), "give it once");
      }
      return Error(ExitCode::kUsage, name, "its value is missing",
                   fmt::format("{} tells what it takes", help));
    case CLI::ExitCodes::ConversionError: {
      const std::string value = option->results().empty() ? "" : option->results().front();
      if (!TakesValue(*option)) {
        return Error(ExitCode::kUsage, name, "takes no value", fmt::format("write {} alone", name));
      }
      return Error(ExitCode::kUsage, name, fmt::format("\"{}\" is not a number", value),
                   fmt::format("{} tells what it takes", help));
    }
    case CLI::ExitCodes::ValidationError:
      return ValueError(*option, name, text.substr(std::min(name.size() + 2, text.size())), help);
    default:
      return Error(ExitCode::kUsage, "", message, fmt::format("{} tells what it takes", help));
  }
}

}  // namespace nacre
