// SPDX-License-Identifier: Apache-2.0
#include "cli/help_text.h"

#include <algorithm>
#include <sstream>
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "cli/option_text.h"

namespace nacre {
namespace {

constexpr size_t kLongestHead = 32;  // longer lists of choices are in the option's text

// `head` at the left, and `text` from column `indent` on, on the same line if there is room.
std::string HelpEntry(const std::string& head, const std::string& text, size_t indent) {
  std::string out = "  " + head;
  if (out.size() + 2 > indent) {
    out += "\n" + std::string(indent, ' ');
  } else {
    out.resize(indent, ' ');
  }
  return out + WrapWordsAt(text, indent, indent) + "\n";
}

// The suffix of the groups whose options are shown only by --help-all.
constexpr std::string_view kBehind = " (--help-all)";

bool IsBehindHelpAll(const CLI::Option& option) { return option.get_group().ends_with(kBehind); }

// The text up to the first semicolon, or full stop before a capital or an option, outside of
// brackets.
std::string FirstSentence(const std::string& text) {
  int depth = 0;
  for (size_t i = 0; i + 2 < text.size(); ++i) {
    depth += text[i] == '(' || text[i] == '[';
    depth -= text[i] == ')' || text[i] == ']';
    const char next = text[i + 2];
    const bool ends =
        text[i] == ';' || (text[i] == '.' && (next == '-' || (next >= 'A' && next <= 'Z')));
    if (depth == 0 && ends && text[i + 1] == ' ') return text.substr(0, i);
  }
  return text;
}

std::string OptionEntry(const CLI::Option& option, bool whole) {
  std::string head = fmt::format("{}", fmt::join(NamesOf(option), ","));
  const std::string& about = option.get_description();
  std::string text = OptionText(option);  // the first sentence says what the option does
  if (!whole) text.replace(0, about.size(), FirstSentence(about));
  if (head.empty()) {
    head = option.get_name(true);
  } else if (TakesValue(option)) {
    const std::string value = ValueName(option);
    head += " " + (head.size() + value.size() < kLongestHead ? value : "NAME");
  }
  if (option.get_required()) text += " (required)";
  return HelpEntry(head, text, 24);
}

// The grouped options, by the title of their group.
using Groups = std::vector<std::pair<std::string, std::vector<const CLI::Option*>>>;
Groups GroupsOf(const CLI::App& app) {
  Groups groups = {{"Positionals", {}}};
  for (const std::string& group : app.get_groups()) {
    if (group.empty()) continue;
    const auto options =
        app.get_options([&](const CLI::Option* option) { return option->get_group() == group; });
    const std::string title = group.substr(0, group.find(kBehind));
    auto found = std::ranges::find(groups, title, &Groups::value_type::first);
    if (found == groups.end()) {
      groups.push_back({title, {}});
      found = groups.end() - 1;
    }
    for (const CLI::Option* option : options) {
      (option->nonpositional() ? *found : groups.front()).second.push_back(option);
    }
  }
  return groups;
}

std::string GroupsText(const CLI::App& app, bool whole) {
  std::string text;
  for (const auto& [title, options] : GroupsOf(app)) {
    std::string entries;
    for (const CLI::Option* option : options) {
      if (whole || !IsBehindHelpAll(*option)) entries += OptionEntry(*option, whole);
    }
    if (!entries.empty()) text += fmt::format("\n{}:\n{}", title, entries);
  }
  return text;
}

// A hint how to learn more about the command `name` than --help says, if there is more.
std::string MoreText(const CLI::App& app, const std::string& name) {
  std::vector<std::string> names;
  bool is_cut = false;
  for (const CLI::Option* option : app.get_options()) {
    const std::string about = option->get_description();
    is_cut = is_cut || FirstSentence(about) != about;
    if (IsBehindHelpAll(*option)) names.push_back(NamesOf(*option).back());
  }
  if (names.empty() && !is_cut) return {};
  std::string text = fmt::format("More: {} --help-all", name);
  if (!names.empty()) text += fmt::format(", which also has {}", fmt::join(names, ", "));
  return "\n" + WrapWordsAt(text, 0, 0) + "\n";
}

}  // namespace

std::string WrapWordsAt(const std::string& text, size_t indent, size_t at, size_t columns) {
  std::string out;
  std::istringstream words(text);
  bool first_of_line = true;
  for (std::string word; words >> word; first_of_line = false) {
    if (!first_of_line && at + 1 + word.size() > columns) {
      out += "\n" + std::string(indent, ' ');
      at = indent;
    } else if (!first_of_line) {
      out += ' ';
      ++at;
    }
    out += word;
    at += word.size();
  }
  return out;
}

void MoveBehindHelpAll(CLI::App* command, const std::vector<std::string>& names) {
  for (const std::string& name : names) {
    CLI::Option* const option = command->get_option(name);
    option->group(option->get_group() + std::string(kBehind));
  }
}

std::string HelpFormatter::make_help(const CLI::App* app, std::string name,
                                     CLI::AppFormatMode mode) const {
  if (mode == CLI::AppFormatMode::Sub) {  // all commands, one below the other
    return fmt::format("\nnacre {}: ", app->get_name()) + make_description(app) +
           GroupsText(*app, true);
  }
  const bool whole = mode == CLI::AppFormatMode::All;
  std::string text = make_description(app) + make_usage(app, name) + GroupsText(*app, whole);
  text += make_subcommands(app, mode);
  if (!whole) text += MoreText(*app, name);
  return text + "\n" + make_footer(app);
}

std::string HelpFormatter::make_subcommand(const CLI::App* command) const {
  return HelpEntry(command->get_name(), command->get_description(), 12);
}

std::string HelpFormatter::make_description(const CLI::App* app) const {
  return WrapWordsAt(app->get_description(), 0, 0) + "\n";
}

}  // namespace nacre
