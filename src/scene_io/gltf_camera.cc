// SPDX-License-Identifier: Apache-2.0
// scene_io/gltf_camera.cc: the cameras of a glTF file.
#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "base/excerpt.h"
#include "scene/limits.h"
#include "scene_io/gltf_readers.h"

namespace nacre {

Vec3d GltfDirection(const Imath::M44d& world_from_node, const Vec3d& direction) {
  Vec3d result;
  world_from_node.multDirMatrix(direction, result);
  const double size = SumOfAbs(result);
  if (!(size > 0) || !std::isfinite(size)) return Vec3d(0);
  // Scales by a power of two first, without rounding: squares of huge components would overflow.
  return (result * std::ldexp(1, -std::ilogb(size))).normalized();
}

std::optional<Camera> MakeGltfCamera(int camera, size_t index, const Imath::M44d& world_from_node,
                                     GltfDocument* to) {
  const GltfDocument& document = *to;
  const std::string place = fmt::format("/cameras/{}", camera);
  const gltf::Camera& source =
      document.At(document.model.cameras, camera, place, "there is no such camera");
  Camera result;
  if (source.type == "perspective") {
    result.fov_y_deg = source.perspective.yfov * (180 / std::numbers::pi);
    if (!(result.fov_y_deg > 0 && result.fov_y_deg < 180)) {
      document.Refuse(place + "/perspective/yfov", fmt::format("{}", source.perspective.yfov),
                      "radians, greater than 0 and less than pi");
    }
  } else if (source.type == "orthographic") {
    result.projection = Projection::kOrthographic;
    result.height = 2 * std::abs(source.orthographic.ymag);
    if (!limits::kLength.Contains(result.height)) {
      document.Refuse(place + "/orthographic/ymag", fmt::format("{}", source.orthographic.ymag),
                      "half the height of the view, not 0");
    }
  } else {
    document.Refuse(place + "/type", fmt::format("unknown type \"{}\"", Excerpt(source.type)),
                    "perspective or orthographic");
  }
  result.position = world_from_node.translation();
  const Vec3d forward = GltfDirection(world_from_node, {0, 0, -1});
  result.up = GltfDirection(world_from_node, {0, 1, 0});
  if (forward == Vec3d(0) || result.up == Vec3d(0)) {
    to->Warn("a camera that its node leaves no direction, as a scale of 0 does, is left out");
    return std::nullopt;
  }
  // The point to look at is so far away that adding the position does not round off the direction.
  result.look_at = result.position + forward * std::max(result.position.length(), 1.0);
  const std::string node = fmt::format("/nodes/{}", index);
  document.Check(node, result.position, limits::kCoordinate);
  document.Check(node, result.look_at, limits::kCoordinate);
  return result;
}

}  // namespace nacre
