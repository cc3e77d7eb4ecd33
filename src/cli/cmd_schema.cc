// SPDX-License-Identifier: Apache-2.0
// cli/cmd_schema.cc: nacre schema: prints the JSON Schema of scene files.
#include "cli/commands.h"
#include "cli/print.h"
#include "scene_io/schema.h"

namespace nacre {

void AddSchemaCommand(CLI::App* app, int*) {
  CLI::App* command =
      app->add_subcommand("schema", "Print the JSON Schema of scene files, for editors and checks");
  command->footer(
      "Example:\n"
      "  nacre schema > nacre.schema.json");
  command->callback([] { PrintOut(SceneSchema()); });
}

}  // namespace nacre
