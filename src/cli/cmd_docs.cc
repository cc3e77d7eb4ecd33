// SPDX-License-Identifier: Apache-2.0
// cli/cmd_docs.cc: nacre docs man|bash: prints files to install beside the program. Hidden from the
// help.
#include <memory>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/version.h"
#include "cli/commands.h"
#include "cli/option_text.h"
#include "cli/print.h"

namespace nacre {
namespace {

std::vector<const CLI::Option*> Options(const CLI::App& app) {
  return app.get_options([](const CLI::Option* option) { return !option->get_group().empty(); });
}

// ---- Manual page --------------------------------------------------------------------------------

// Escapes text so that roff prints it literally.
std::string Roff(const std::string& text) {
  std::string out;
  for (const char c : text) {
    const bool begins_line = out.empty() || out.back() == '\n';
    if (begins_line && (c == '.' || c == '\'')) out += "\\&";
    if (c == '\\') {
      out += "\\e";
    } else if (c == '-') {
      out += "\\-";
    } else {
      out += c;
    }
  }
  return out;
}

std::string OptionEntry(const CLI::Option& option) {
  std::string head;
  for (const std::string& name : NamesOf(option)) {
    head += (head.empty() ? "\\fB" : ", \\fB") + Roff(name) + "\\fR";
  }
  if (head.empty()) {
    head = "\\fI" + Roff(option.get_name(true)) + "\\fR";
  } else if (TakesValue(option)) {
    head += " \\fI" + Roff(ValueName(option)) + "\\fR";
  }
  return ".TP\n" + head + "\n" + Roff(OptionText(option)) + "\n";
}

std::string CommandSection(const CLI::App& command) {
  std::string text =
      fmt::format(".SS nacre {}\n{}.\n", Roff(command.get_name()), Roff(command.get_description()));
  for (const bool positional : {true, false}) {
    for (const CLI::Option* option : Options(command)) {
      if (NamesOf(*option).empty() == positional) text += OptionEntry(*option);
    }
  }
  // A command without a footer of its own inherits the program's.
  if (command.get_footer() != command.get_parent()->get_footer()) {
    text += ".PP\n.nf\n" + Roff(command.get_footer()) + "\n.fi\n";
  }
  return text;
}

// ---- Bash ---------------------------------------------------------------------------------------

// Words that the shell takes literally: names, and choices of letters, digits and signs.
std::string Words(const std::vector<std::string>& words) {
  return fmt::format("'{}'", fmt::join(words, " "));
}

std::string CommandCases(const CLI::App& command) {
  std::vector<std::string> names;
  std::string choices, positional;
  for (const CLI::Option* option : Options(command)) {
    const std::vector<std::string> own = NamesOf(*option), values = ChoicesOf(*option);
    names.insert(names.end(), own.begin(), own.end());
    if (values.empty()) continue;
    if (own.empty()) {
      positional += fmt::format("      [[ $current == -* ]] || words={}\n", Words(values));
    } else if (TakesValue(*option)) {
      choices += fmt::format("        {}) words={} ;;\n", fmt::join(own, "|"), Words(values));
    }
  }
  return fmt::format(
      "    {})\n      [[ $current != -* ]] || words={}\n{}      case $previous in\n{}"
      "        *) ;;\n      esac\n      ;;\n",
      command.get_name(), Words(names), positional, choices);
}

// ---- The documents ------------------------------------------------------------------------------

// A manual page (man 7 man) of the program and all of its commands.
std::string ManPage(const CLI::App& app) {
  std::string text = fmt::format(
      ".TH NACRE 1 \"\" \"nacre {}\" \"User Commands\"\n.SH NAME\nnacre \\- {}\n"
      ".SH SYNOPSIS\n\\fBnacre\\fR \\fICOMMAND\\fR [\\fIARGUMENTS\\fR]\n",
      Roff(kVersion), "CPU ray tracer for studying reflection models");
  text += ".SH DESCRIPTION\n" + Roff(app.get_description()) + "\n.SH OPTIONS\n";
  for (const CLI::Option* option : Options(app)) text += OptionEntry(*option);
  text += ".SH COMMANDS\n";
  for (const CLI::App* command : ShownCommands(app)) text += CommandSection(*command);
  text += ".SH NOTES\n.nf\n" + Roff(app.get_footer()) + "\n.fi\n";
  return text;
}

// A script for bash: completes commands, options, the choices of options, and files.
std::string BashCompletion(const CLI::App& app) {
  std::vector<std::string> first;
  for (const CLI::App* command : ShownCommands(app)) first.push_back(command->get_name());
  for (const CLI::Option* option : Options(app)) {
    for (const std::string& name : NamesOf(*option)) first.push_back(name);
  }
  std::string cases;
  for (const CLI::App* command : ShownCommands(app)) cases += CommandCases(*command);
  return "# bash completion for nacre. Written by nacre itself: nacre docs bash.\n"
         "_nacre() {\n"
         "  local current=${COMP_WORDS[COMP_CWORD]} previous=${COMP_WORDS[COMP_CWORD - 1]} words=\n"
         "  COMPREPLY=()\n"
         "  if ((COMP_CWORD == 1)); then\n"
         "    mapfile -t COMPREPLY < <(compgen -W " +
         Words(first) +
         " -- \"$current\")\n"
         "    return\n"
         "  fi\n"
         "  case ${COMP_WORDS[1]} in\n" +
         cases +
         "    *) ;;\n"
         "  esac\n"
         "  # Nothing to choose from: a file, by -o default.\n"
         "  [[ -z $words ]] || mapfile -t COMPREPLY < <(compgen -W \"$words\" -- \"$current\")\n"
         "}\n"
         "complete -o default -F _nacre nacre\n";
}

}  // namespace

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
