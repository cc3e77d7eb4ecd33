// SPDX-License-Identifier: Apache-2.0
#include "cli/option_text.h"

#include <sstream>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace nacre {

std::vector<const CLI::App*> ShownCommands(const CLI::App& app) {
  return app.get_subcommands([](const CLI::App* command) { return !command->get_group().empty(); });
}

std::vector<std::string> NamesOf(const CLI::Option& option) {
  std::vector<std::string> names;
  for (const std::string& name : option.get_snames()) names.push_back("-" + name);
  for (const std::string& name : option.get_lnames()) names.push_back("--" + name);
  return names;
}

bool TakesValue(const CLI::Option& option) { return option.get_expected_max() > 0; }

// The choices, which a check lists in braces after the type.
std::vector<std::string> ChoicesOf(const CLI::Option& option) {
  const std::string type = option.get_type_name();
  const size_t open = type.rfind('{');
  const size_t close = type.rfind('}');
  if (open == std::string::npos || close == std::string::npos || close < open) return {};
  std::vector<std::string> choices;
  std::istringstream list(type.substr(open + 1, close - open - 1));
  for (std::string choice; std::getline(list, choice, ',');) choices.push_back(choice);
  return choices;
}

std::string ValueName(const CLI::Option& option) {
  const std::vector<std::string> choices = ChoicesOf(option);
  if (!choices.empty()) return fmt::format("{}", fmt::join(choices, "|"));
  const std::string type = option.get_type_name();
  const std::string name = type.substr(0, type.find(':'));  // "INT:INT in [1 - 64]"
  return name == "INT" || name == "UINT" || name == "FLOAT" ? "N" : name;
}

std::string OptionText(const CLI::Option& option) {
  std::string text = option.get_description();
  const std::string type = option.get_type_name();
  const size_t bounds = type.rfind(" in [");  // "INT in [1 - 64]"
  const size_t dash = type.rfind(" - ");
  if (bounds != std::string::npos && dash != std::string::npos) {
    text += fmt::format(" ({} to {})", type.substr(bounds + 5, dash - bounds - 5),
                        type.substr(dash + 3, type.rfind(']') - dash - 3));
  }
  // Flags and empty texts have no default worth showing. CLI11 writes lists in brackets, which are
  // not typed on the command line.
  std::string value = option.get_default_str();
  if (value.starts_with('[') && value.ends_with(']')) value = value.substr(1, value.size() - 2);
  if (TakesValue(option) && !value.empty()) text += " (default: " + value + ")";
  return text;
}

}  // namespace nacre
