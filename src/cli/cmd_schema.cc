// cli/cmd_schema.cc: nacre schema
#include <cstdio>

#include "cli/commands.h"
#include "scene_io/load_scene.h"

namespace nacre {

void AddSchemaCommand(CLI::App* app, int*) {
  CLI::App* command =
      app->add_subcommand("schema", "Print the JSON Schema of scene files, for editors and checks");
  command->callback([] {
    const std::string_view schema = SceneSchema();
    std::fwrite(schema.data(), 1, schema.size(), stdout);
  });
}

}  // namespace nacre
