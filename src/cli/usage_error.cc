// SPDX-License-Identifier: Apache-2.0
#include "cli/usage_error.h"

#include <algorithm>
#include <iterator>
#include <optional>
#include <sstream>
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
struct OtherNames {
  std::string_view ours, others;  // others: separated by spaces
};
constexpr OtherNames kOtherNames[] = {
    {"--spp", "--samples --sample-count --samples-per-pixel --quality --passes +A"},
    {"-o", "--out --outfile --output-file --render-output +O"},
    {"--size", "--resolution --res --resize --scale --width --height -w -r +W +H"},
    {"--region", "--crop --cropwindow --pixelbounds --pixel --window"},
    {"--threads", "--nthreads --num-threads --jobs -j -t"},
    {"--environment", "--env --envmap --hdri --ibl"},
    {"--layers", "--aovs --aov --channels --ch"},
    {"--depth", "--bit-depth -d"},
    {"--max-error", "--noise"},
    {"--quiet", "--silent -q"},
    {"--explain", "--verbose -v"},
    {"--progress", "--log-level"},
    {"--target", "--device"},
    {"--set", "-D --define --override"},
    {"--exposure", "--ev"},
    {"--tonemap", "--tone-map --gamma --view-transform"},
    {"--intersector", "--mode"},
    {"--max-abs", "-fail --fail --tolerance"},
    {"--fraction", "--failpercent"},
    {"--max-rel", "--threshold"},
};

// Options of other programs for what nacre does differently, with an explanation.
struct OtherWay {
  std::string_view options, hint;
};
constexpr OtherWay kOtherWays[] = {
    {"--frame --frames --render-frame -f",
     "a scene is one picture: change it by --set, and call once for each frame"},
    {"--format --render-format -F", "the name behind -o says the format: .png or .exr"},
    {"-i --input --scene", "files that are read are named without an option"},
    {"--gpu", "nacre renders on the processor: --target chooses its instructions"},
    {"--engine", "there is one renderer: --target chooses its instructions"},
    {"--integrator --bounces --max-depth",
     "light goes from lights to surfaces to the camera, without further bounces"},
    {"--denoise", "ask for fewer errors: more samples (--spp), or an error (--max-error)"},
    {"--background", "nacre opens no window; a scene's colour is --set /background=0"},
    {"-b", "nacre opens no window"},
    {"--camera", "change a scene's camera by --set, e.g. /camera/position=[0,1,6]"},
    {"--fast", "the fast mode is gone: leave it out, samples reach its error sooner"},
};

std::vector<std::string> WordsOf(std::string_view text) {
  std::istringstream words{std::string(text)};
  return {std::istream_iterator<std::string>(words), {}};
}

bool Has(const std::vector<std::string>& names, std::string_view name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

// The innermost command that was named.
const CLI::App* NamedCommand(const CLI::App& app) {
  const CLI::App* command = &app;
  while (!command->get_subcommands().empty()) command = command->get_subcommands().back();
  return command;
}

// The nearest name among the command's options and their other names, or "".
std::string OptionMeant(const std::string& word, const std::vector<std::string>& names) {
  std::vector<std::string> candidates = names;
  for (const auto& [ours, others] : kOtherNames) {
    if (!Has(names, ours)) continue;
    for (const std::string& other : WordsOf(others)) candidates.push_back(other);
  }
  const std::string nearest = NearestName(word, candidates);
  if (Has(names, nearest)) return nearest;
  for (const auto& [ours, others] : kOtherNames) {
    if (Has(WordsOf(others), nearest)) return std::string(ours);
  }
  return nearest;
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
  if (options_end && Has(names, word)) {
    return Error(ExitCode::kUsage, word, "is behind --, which ends the options",
                 "write it before --");
  }
  for (const auto& [options, hint] : kOtherWays) {
    if (!Has(WordsOf(options), word)) continue;
    return Error(ExitCode::kUsage, "", fmt::format("unknown option {}", word), std::string(hint));
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
  const auto wrong =
      std::ranges::find_if(given, [&](const auto& value) { return !Has(choices, value); });
  if (choices.empty() || wrong == given.end()) {
    return Error(ExitCode::kUsage, where, told, fmt::format("{} tells what it takes", help));
  }
  return Error(ExitCode::kUsage, where, fmt::format("\"{}\" is none of its values", *wrong),
               NearestHint(*wrong, choices, fmt::format("one of: {}", fmt::join(choices, ", "))));
}

constexpr char kNoValue[] = "its value is missing";

// The option that a word names, without "=" and a value; null if it names none. A lone "-" is
// standard input or output, and for a word without a dash CLI11 would search the positional
// arguments.
const CLI::Option* OptionNamed(const CLI::App& command, const std::string& word) {
  if (word.size() < 2 || word[0] != '-') return nullptr;
  return command.get_option_no_throw(word);
}

void CheckList(const std::string& name, const std::string& list, char delimiter) {
  const std::string text = delimiter + list + delimiter;
  if (text.find(std::string(2, delimiter)) == std::string::npos) return;
  throw Error(
      ExitCode::kUsage, name,
      list.empty() ? "the list is empty" : fmt::format("\"{}\" has an element that is empty", list),
      fmt::format("separate elements by one \"{}\" and end with none", delimiter));
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
  const std::vector<std::string> given = option->results();
  const std::string takes = help + " tells what it takes";
  switch (static_cast<CLI::ExitCodes>(failure.get_exit_code())) {
    case CLI::ExitCodes::RequiredError:
      return Error(ExitCode::kUsage, name, "is required", help + " tells what there is");
    case CLI::ExitCodes::ArgumentMismatch:
      if (given.size() <= 1) return Error(ExitCode::kUsage, name, kNoValue, takes);
      return Error(ExitCode::kUsage, name, fmt::format("is given {} times", given.size()),
                   "give it once");
    case CLI::ExitCodes::ConversionError:
      if (!TakesValue(*option)) {
        return Error(ExitCode::kUsage, name, "takes no value", fmt::format("write {} alone", name));
      }
      return Error(ExitCode::kUsage, name,
                   fmt::format("\"{}\" is not a number", given.empty() ? "" : given.front()),
                   takes);
    case CLI::ExitCodes::ValidationError:
      return ValueError(*option, name, text.substr(std::min(name.size() + 2, text.size())), help);
    default:
      return Error(ExitCode::kUsage, "", message, takes);
  }
}

void CheckOptionValues(const CLI::App& app, const std::vector<std::string>& words) {
  if (words.empty()) return;
  const auto named =
      app.get_subcommands([&](const CLI::App* command) { return command->get_name() == words[0]; });
  if (named.empty()) return;
  const CLI::App& command = *named.front();
  for (size_t i = 1; i < words.size() && words[i] != "--"; ++i) {
    const bool is_long = words[i].starts_with("--");
    const size_t equals = is_long ? words[i].find('=') : std::string::npos;
    const std::string name = words[i].substr(0, equals);
    const CLI::Option* const option = OptionNamed(command, name);
    if (option == nullptr || !TakesValue(*option)) continue;
    std::string value;
    std::string hint = fmt::format("nacre {} --help-all tells what it takes", words[0]);
    if (equals != std::string::npos) {
      value = words[i].substr(equals + 1);
      if (value.empty()) throw Error(ExitCode::kUsage, name, kNoValue, hint);
    } else if (i + 1 == words.size()) {
      throw Error(ExitCode::kUsage, name, kNoValue, hint);
    } else {
      value = words[++i];
      if (OptionNamed(command, value.substr(0, value.find('='))) != nullptr) {
        if (is_long) hint += fmt::format("; if it is meant, write {}={}", name, value);
        throw Error(ExitCode::kUsage, name,
                    fmt::format("{}: the option {} follows", kNoValue, value), hint);
      }
    }
    if (option->get_delimiter() != '\0') CheckList(name, value, option->get_delimiter());
  }
}

void RefuseOptions(const CLI::App& command, const std::function<bool(const CLI::Option&)>& applies,
                   const std::string& what, const std::string& hint) {
  for (const CLI::Option* option : command.get_options()) {
    if (option->count() == 0 || applies(*option)) continue;
    throw Error(ExitCode::kUsage, option->get_name(), "cannot be used with " + what, hint);
  }
}

}  // namespace nacre
