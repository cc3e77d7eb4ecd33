// SPDX-License-Identifier: Apache-2.0
#include "cli/help_text.h"

#include <sstream>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "cli/option_text.h"

namespace nacre {
namespace {

constexpr size_t kHelpColumns = 80;
constexpr size_t kLongestHead = 32;  // longer choices are told by the option's text

// Words in lines from column `indent` on; the first line is under way, at column `at`.
std::string WrapHelp(const std::string& text, size_t indent, size_t at) {
  std::string out;
  std::istringstream words(text);
  bool first_of_line = true;
  for (std::string word; words >> word;) {
    if (!first_of_line && at + 1 + word.size() > kHelpColumns) {
      out += "\n" + std::string(indent, ' ');
      at = indent;
      first_of_line = true;
    }
    if (!first_of_line) {
      out += ' ';
      ++at;
    }
    out += word;
    at += word.size();
    first_of_line = false;
  }
  return out;
}

// `head` at the left, `text` from column `indent` on, beside it where there is room.
std::string HelpEntry(const std::string& head, const std::string& text, size_t indent) {
  std::string out = "  " + head;
  if (out.size() + 2 > indent) {
    out += "\n" + std::string(indent, ' ');
  } else {
    out.resize(indent, ' ');
  }
  return out + WrapHelp(text, indent, indent) + "\n";
}

}  // namespace

std::string HelpFormatter::make_option(const CLI::Option* option, bool /*is_positional*/) const {
  std::string head = fmt::format("{}", fmt::join(NamesOf(*option), ","));
  std::string text = OptionText(*option);
  if (head.empty()) {
    head = option->get_name(true);
  } else if (TakesValue(*option)) {
    const std::string value = ValueName(*option);
    head += " " + (head.size() + value.size() < kLongestHead ? value : "NAME");
  }
  if (option->get_required()) text += " (required)";
  return HelpEntry(head, text, 24);
}

std::string HelpFormatter::make_subcommand(const CLI::App* command) const {
  return HelpEntry(command->get_name(), command->get_description(), 12);
}

std::string HelpFormatter::make_description(const CLI::App* app) const {
  return WrapHelp(app->get_description(), 0, 0) + "\n";
}

}  // namespace nacre
