// SPDX-License-Identifier: Apache-2.0
// scene_io/gltf_lights.cc: the lights of a glTF file (KHR_lights_punctual).
#include <numbers>

#include <fmt/format.h>

#include "base/excerpt.h"
#include "scene/limits.h"
#include "scene/validate.h"
#include "scene_io/gltf_readers.h"

namespace nacre {
namespace {

constexpr double kDegrees = 180 / std::numbers::pi;

// Turns the name into a valid name of an EXR layer that leaves room for a number.
std::string LayerName(const std::string& wanted) {
  std::string name = wanted.empty() ? "light" : wanted.substr(0, 48);
  for (char& c : name) {
    if (!IsLayerName(std::string(1, c))) c = '_';
  }
  return name;
}

SpotLight MakeSpot(const gltf::Light::Spot& cone, const std::string& place,
                   const GltfDocument& document) {
  if (!(cone.innerConeAngle >= 0) || !(cone.outerConeAngle >= cone.innerConeAngle) ||
      !(cone.outerConeAngle > 0) || !(cone.outerConeAngle <= std::numbers::pi / 2 + 1e-6)) {
    document.Refuse(
        place + "/spot",
        fmt::format("its cone is from {} to {}", cone.innerConeAngle, cone.outerConeAngle),
        "angles in radians, 0 <= innerConeAngle < outerConeAngle <= pi / 2");
  }
  SpotLight spot;
  spot.cutoff_deg = cone.outerConeAngle * kDegrees;
  spot.inner_deg = cone.innerConeAngle * kDegrees;
  spot.edge = SpotEdge::kSquare;
  return spot;
}

}  // namespace

void AddGltfLight(int light, size_t index, const Imath::M44d& world_from_node,
                  GltfDocument* document, UniqueNames* names, Scene* scene) {
  const std::string place = fmt::format("/extensions/KHR_lights_punctual/lights/{}", light);
  const gltf::Light& source =
      document->At(document->model.lights, light, place, "there is no such light");
  const Rgb intensity = Rgb(source.color[0], source.color[1], source.color[2]) * source.intensity;
  if (source.range > 0) document->Warn("the ranges of lights are left out: they have no end");
  document->Check(place + "/intensity", intensity, limits::kRadiance);
  const Vec3d position = world_from_node.translation();
  if (source.type != "directional") {
    document->Check(fmt::format("/nodes/{}", index), position, limits::kCoordinate);
  }
  const Vec3d direction = GltfDirection(world_from_node, {0, 0, -1});
  if (source.type != "point" && direction == Vec3d(0)) {
    document->Warn("a light that its node leaves no direction, as a scale of 0 does, is left out");
    return;
  }
  Light result;
  result.name = names->Take(LayerName(source.name), " ", scene->lights.size());
  if (source.type == "directional") {
    result.kind = DirectionalLight{direction, intensity};
  } else if (source.type == "point") {
    PointLight point;
    point.position = position;
    point.intensity = intensity;
    result.kind = point;
  } else if (source.type == "spot") {
    SpotLight spot = MakeSpot(source.spot, place, *document);
    spot.position = position;
    spot.direction_of_travel = direction;
    spot.intensity = intensity;
    result.kind = spot;
  } else {
    document->Refuse(place + "/type", fmt::format("unknown type \"{}\"", Excerpt(source.type)),
                     "one of: directional, point, spot");
  }
  scene->lights.push_back(std::move(result));
}

}  // namespace nacre
