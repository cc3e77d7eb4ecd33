// cli/sheet.h: scenes that the commands grid and pair build from their arguments: shapes before a
// plain background, framed to fit, under a key light and a weak sky.
#pragma once

#include <string>

#include <nlohmann/json.hpp>

namespace nacre {

// A scene file's text around `shapes` and `materials`, with a view of `width` x `height` world
// units around the origin, seen from far enough away that spheres look round.
std::string SheetScene(const nlohmann::json& shapes, const nlohmann::json& materials, double width,
                       double height);

// A material given on the command line: JSON, or the name of a model with its defaults. Throws
// Error (usage) if it is neither.
nlohmann::json ParseMaterialArgument(const std::string& option, const std::string& text);

}  // namespace nacre
