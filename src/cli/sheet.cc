#include "cli/sheet.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"

namespace nacre {

using Json = nlohmann::json;

std::string SheetScene(const Json& shapes, const Json& materials, double width, double height) {
  constexpr double kFovYDeg = 20;
  constexpr double kAspect = 16.0 / 9;  // of the default image; wider images show more margin
  const double view = std::max(height, width / kAspect);
  const double distance = view / (2 * std::tan(kFovYDeg / 2 * M_PI / 180));
  // The key light keeps its direction and its irradiance at the centre whatever the size.
  const Json light_position = {0.71 * distance, 0.79 * distance, 0.97 * distance};
  const double light_distance_squared =
      (0.71 * 0.71 + 0.79 * 0.79 + 0.97 * 0.97) * distance * distance;
  constexpr double kKeyIrradiance = 2.9;
  const Json scene = {
      {"nacre", 1},
      {"camera", {{"position", {0, 0, distance}}, {"look_at", {0, 0, 0}}, {"fov_y_deg", kFovYDeg}}},
      {"lights",
       {{"key",
         {{"type", "point"},
          {"position", light_position},
          {"intensity", kKeyIrradiance * light_distance_squared}}},
        {"sky", {{"type", "ambient"}, {"radiance", 0.06}}}}},
      {"materials", materials},
      {"shapes", shapes},
      {"background", {0.05, 0.05, 0.08}},
  };
  return scene.dump();
}

Json ParseMaterialArgument(const std::string& option, const std::string& text) {
  if (text.find('{') == std::string::npos) return {{"model", text}};
  Json material = Json::parse(text, nullptr, /*allow_exceptions=*/false);
  if (!material.is_object()) {
    throw Error(ExitCode::kUsage, option, "\"" + text + "\" is not a material",
                "give a model's name or JSON, e.g. '{\"model\": \"phong\", \"shininess\": 64}'");
  }
  return material;
}

}  // namespace nacre
