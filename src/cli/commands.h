// SPDX-License-Identifier: Apache-2.0
// cli/commands.h: the program's commands. Each function adds a command to the command line. The
// work is done in the subcommand's callback, which stores the exit code in *exit_code.
#pragma once

#include <CLI/App.hpp>

namespace nacre {

void AddRenderCommand(CLI::App* app, int* exit_code);
void AddGridCommand(CLI::App* app, int* exit_code);
void AddPairCommand(CLI::App* app, int* exit_code);
void AddConvertCommand(CLI::App* app, int* exit_code);
void AddCompareCommand(CLI::App* app, int* exit_code);
void AddValidateCommand(CLI::App* app, int* exit_code);
void AddTonemapCommand(CLI::App* app, int* exit_code);
void AddMergeCommand(CLI::App* app, int* exit_code);
void AddInfoCommand(CLI::App* app, int* exit_code);
void AddSchemaCommand(CLI::App* app, int* exit_code);
void AddReportCommand(CLI::App* app, int* exit_code);
void AddExplainCommand(CLI::App* app, int* exit_code);
void AddPlotCommand(CLI::App* app, int* exit_code);
void AddStudyCommand(CLI::App* app, int* exit_code);
void AddTableCommand(CLI::App* app, int* exit_code);
void AddViewCommand(CLI::App* app, int* exit_code);  // unless NACRE_VIEW is off
void AddDocsCommand(CLI::App* app, int* exit_code);

}  // namespace nacre
