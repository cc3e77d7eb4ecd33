// SPDX-License-Identifier: Apache-2.0
#include "cli/option_values.h"

#include <fmt/format.h>

#include "base/error.h"
#include "cli/option_text.h"

namespace nacre {
namespace {

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

}  // namespace nacre
