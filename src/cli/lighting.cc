// SPDX-License-Identifier: Apache-2.0
#include "cli/lighting.h"

#include <cmath>
#include <filesystem>

#include "base/error.h"
#include "base/vec.h"
#include "cli/help_text.h"
#include "scene_io/sheet_axis.h"
#include "scene_io/text_file.h"

namespace nacre {
namespace {

// A light with the same irradiance on every sphere of a sheet.
Json Directional(const Json& direction_of_travel, double irradiance) {
  return {{"type", "directional"},
          {"direction_of_travel", direction_of_travel},
          {"irradiance", irradiance}};
}

// The key light is in front of the sheet at the upper right, so far away that shadows and
// highlights of all spheres look similar.
const Vec3d kKeyDirection(0.71, 0.79, 0.97);
constexpr double kKeyIrradiance = 2.9;
constexpr double kKeyDistance = 5.7;  // in multiples of `reach`, per component

Json KeyPosition(double reach) {
  const Vec3d position = kKeyDirection * kKeyDistance * reach;
  return {position.x, position.y, position.z};
}

double KeyDistanceSquared(double reach) {
  return kKeyDirection.length2() * kKeyDistance * kKeyDistance * reach * reach;
}

// `centred`: the light is straight above, so that the middle line of the picture divides the
// highlight.
Json PointLights(double reach, bool centred) {
  const double height = std::hypot(kKeyDirection[0], kKeyDirection[1]) * kKeyDistance * reach;
  Json position = KeyPosition(reach);
  if (centred) position = {0, height, position[2]};
  return {{"key",
           {{"type", "point"},
            {"position", position},
            {"intensity", kKeyIrradiance * KeyDistanceSquared(reach)}}},
          {"sky", {{"type", "ambient"}, {"radiance", 0.06}}}};
}

Json StudioLights() {
  return {{"key", Directional({-0.71, -0.79, -0.97}, 2.4)},
          {"fill", Directional({1.0, -0.15, -1.1}, 0.7)},
          {"rim", Directional({0.55, -0.6, 0.9}, 2.6)},
          {"sky", {{"type", "ambient"}, {"radiance", 0.04}}}};
}

Json SkyLights() {
  return {{"sky",
           {{"type", "environment"},
            {"gradient",
             {{"zenith", {0.35, 0.6, 1.2}},
              {"horizon", {1.1, 1.05, 1.0}},
              {"ground", {0.16, 0.13, 0.1}}}},
            {"background", false}}}};
}

// A soft box at the position of the key light, whose solid angle is the same for sheets of any
// size.
Json RectangleLights(double reach) {
  const double side = 4.6 * reach;
  const double radiance = kKeyIrradiance * KeyDistanceSquared(reach) / (side * side);
  return {{"box",
           {{"type", "rectangle"},
            {"center", KeyPosition(reach)},
            {"facing", {-0.71, -0.79, -0.97}},
            {"up", {0, 1, 0}},
            {"width", side},
            {"height", side},
            {"radiance", radiance},
            {"visible", false}}},
          {"sky", {{"type", "ambient"}, {"radiance", 0.06}}}};
}

Json FurnaceLights() {
  return {{"furnace", {{"type", "environment"}, {"radiance", 1}, {"background", false}}}};
}

// Whether --lights contains the lights themselves instead of a file's path.
bool IsJsonText(const std::string& text) { return text.find('{') != std::string::npos; }

Json ReadLightsText(const std::string& text) {
  constexpr uint64_t kMaxBytes = uint64_t{1} << 20;
  const bool is_json = IsJsonText(text);
  Json lights;
  if (is_json) {
    lights = TryParseJson(text).value_or(Json());
  } else {
    FaultList faults;
    lights = ParseJson(ReadTextFile(text, kMaxBytes), text, &faults);
    ThrowFaults(faults, text);
  }
  // A whole scene file may be given.
  if (lights.is_object() && lights.contains("lights")) lights = lights["lights"];
  if (lights.is_object()) return lights;
  throw Error(is_json ? ExitCode::kUsage : ExitCode::kBadInput, "--lights",
              is_json ? "this is not JSON of lights" : text + " holds no JSON of lights",
              R"(for example '{"sun": {"type": "directional", "direction_of_travel": [0,-1,-1], )"
              R"("irradiance": 3}}')");
}

// True except for lights that reach a point from one direction, or uniformly from everywhere.
bool HasExtent(const Json& light) {
  const auto type = light.find("type");
  if (type == light.end()) return false;
  return *type != "ambient" && *type != "directional" && *type != "point" && *type != "spot";
}

Json LightsOf(const std::string& set_up, double reach, bool centred) {
  if (set_up == "studio") return StudioLights();
  if (set_up == "sky") return SkyLights();
  if (set_up == "rectangle") return RectangleLights(reach);
  if (set_up == "furnace") return FurnaceLights();
  return PointLights(reach, centred);
}

}  // namespace

void AddLightingOptions(CLI::App* command, LightingOptions* options) {
  const InGroup group(command, "Light");
  command
      ->add_option("--light", options->light,
                   "point, studio, sky, rectangle or furnace. The point light is at the upper "
                   "right (in split pairs: above); the studio has key, fill and rim light; the sky "
                   "is a gradient from ground to zenith; the rectangle is a soft box; the furnace "
                   "is radiance 1 from everywhere, before which a surface that reflects all light "
                   "cannot be seen")
      ->check(CLI::IsMember({"point", "studio", "sky", "rectangle", "furnace"}))
      ->capture_default_str();
  command
      ->add_option("--lights", options->lights,
                   "Other lights instead: JSON as in scene files, or a scene whose lights to take")
      ->type_name("JSON|FILE");
  command
      ->add_option("--environment", options->environment,
                   "An image of the surroundings instead (latitude and longitude, EXR or HDR)")
      ->type_name("FILE");
  command
      ->add_option("--background", options->background,
                   "Background: #rrggbb, [r,g,b] or one number, linear")
      ->type_name("COLOR");
}

std::vector<std::string> InputFiles(const LightingOptions& options) {
  std::vector<std::string> files;
  if (!options.lights.empty() && !IsJsonText(options.lights)) files.push_back(options.lights);
  if (!options.environment.empty()) files.push_back(options.environment);
  return files;
}

Lighting MakeLighting(const LightingOptions& options, double reach, bool centred) {
  Lighting lighting;
  lighting.background = {0.05, 0.05, 0.08};
  if (options.light == "furnace") lighting.background = 1;
  if (!options.lights.empty()) {
    lighting.lights = ReadLightsText(options.lights);
    lighting.label = IsJsonText(options.lights)
                         ? std::string("lights given")
                         : std::filesystem::path(options.lights).filename().string();
  }
  if (!options.environment.empty()) {
    lighting.lights["environment"] = {
        {"type", "environment"}, {"image", options.environment}, {"background", false}};
    lighting.label = std::filesystem::path(options.environment).filename().string();
  }
  if (options.lights.empty() && options.environment.empty()) {
    lighting.lights = LightsOf(options.light, reach, centred);
    lighting.label = options.light;
  }
  if (!options.background.empty()) {
    lighting.background = ParseColorText("--background", options.background);
  }
  for (const Json& light : lighting.lights) {
    if (light.is_object() && HasExtent(light)) lighting.sampled = true;
  }
  return lighting;
}

}  // namespace nacre
