// SPDX-License-Identifier: Apache-2.0
// scene_io/gltf_lights.cc: the lights (KHR_lights_punctual) and cameras of a glTF file, which nodes
// place.
#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "base/excerpt.h"
#include "scene/limits.h"
#include "scene/validate.h"
#include "scene_io/gltf_readers.h"

namespace nacre {
namespace {

constexpr double kDegrees = 180 / std::numbers::pi;

// Transforms a direction of a node to the world by the node's matrix (row vectors). The result has
// unit length, or is zero where the matrix maps the direction to zero or is not finite.
Vec3d DirectionInWorld(const Imath::M44d& world_from_node, const Vec3d& direction) {
  Vec3d result;
  world_from_node.multDirMatrix(direction, result);
  const double size = SumOfAbs(result);
  if (!(size > 0) || !std::isfinite(size)) return Vec3d(0);
  // Scales by a power of two first, without rounding: squares of huge components would overflow.
  return (result * std::ldexp(1, -std::ilogb(size))).normalized();
}

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
  return {.cutoff_deg = cone.outerConeAngle * kDegrees,
          .inner_deg = cone.innerConeAngle * kDegrees,
          .edge = SpotEdge::kSquare};
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
  const Vec3d direction = DirectionInWorld(world_from_node, {0, 0, -1});
  if (source.type != "point" && direction == Vec3d(0)) {
    document->Warn("a light that its node leaves no direction, as a scale of 0 does, is left out");
    return;
  }
  Light result;
  result.name = names->Take(LayerName(source.name), " ", scene->lights.size());
  if (source.type == "directional") {
    result.kind = DirectionalLight{direction, intensity};
  } else if (source.type == "point") {
    result.kind = PointLight{.position = position, .intensity = intensity};
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

std::optional<Camera> MakeGltfCamera(int camera, size_t index, const Imath::M44d& world_from_node,
                                     GltfDocument* document) {
  const std::string place = fmt::format("/cameras/{}", camera);
  const gltf::Camera& source =
      document->At(document->model.cameras, camera, place, "there is no such camera");
  Camera result;
  if (source.type == "perspective") {
    result.fov_y_deg = source.perspective.yfov * kDegrees;
    if (!(result.fov_y_deg > 0 && result.fov_y_deg < 180)) {
      document->Refuse(place + "/perspective/yfov", fmt::format("{}", source.perspective.yfov),
                       "radians, greater than 0 and less than pi");
    }
  } else if (source.type == "orthographic") {
    result.projection = Projection::kOrthographic;
    result.height = 2 * std::abs(source.orthographic.ymag);
    if (!limits::kLength.Contains(result.height)) {
      document->Refuse(place + "/orthographic/ymag", fmt::format("{}", source.orthographic.ymag),
                       "half the height of the view, not 0");
    }
  } else {
    document->Refuse(place + "/type", fmt::format("unknown type \"{}\"", Excerpt(source.type)),
                     "perspective or orthographic");
  }
  result.position = world_from_node.translation();
  const Vec3d forward = DirectionInWorld(world_from_node, {0, 0, -1});
  result.up = DirectionInWorld(world_from_node, {0, 1, 0});
  if (forward == Vec3d(0) || result.up == Vec3d(0)) {
    document->Warn("a camera that its node leaves no direction, as a scale of 0 does, is left out");
    return std::nullopt;
  }
  // The point to look at is so far away that adding the position does not round off the direction.
  result.look_at = result.position + forward * std::max(result.position.length(), 1.0);
  const std::string node = fmt::format("/nodes/{}", index);
  document->Check(node, result.position, limits::kCoordinate);
  document->Check(node, result.look_at, limits::kCoordinate);
  return result;
}

}  // namespace nacre
