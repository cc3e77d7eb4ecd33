// SPDX-License-Identifier: Apache-2.0
#include "scene/texture_mapping.h"

#include <cmath>

namespace nacre {
namespace {

Mapped<double> Map(MappingKind kind, const Vec3d& p) {
  switch (kind) {
    case MappingKind::kCylindrical:
      return MapCylindrical(p);
    case MappingKind::kPlanar:
      return MapPlanar(p);
    case MappingKind::kCube:
      return MapCube(p);
    default:
      return MapSpherical(p);
  }
}

}  // namespace

MappingFrame FrameOf(const Texture& texture) {
  const Vec3d z = texture.axis.normalized();
  const Vec3d across = Vec3d(0, 1, 0).cross(z);
  // Below this sine the axis counts as vertical.
  constexpr double kUpright = 1e-9;
  const Vec3d x = across.length() > kUpright ? across.normalized() : Vec3d(0, 0, -1);
  const Vec3d y = z.cross(x).normalized();
  const double angle = texture.rotate_deg * M_PI / 180;
  const double c = std::cos(angle), s = std::sin(angle);
  return {x * c + y * s, y * c - x * s, z};
}

UvTransform TransformOf(const Texture& texture) {
  const double angle = texture.uv_rotate_deg * M_PI / 180;
  const double c = texture.uv_rotate_deg == 0 ? 1 : std::cos(angle);
  const double s = texture.uv_rotate_deg == 0 ? 0 : std::sin(angle);
  return {Vec2d(c * texture.scale.x, -s * texture.scale.y),
          Vec2d(s * texture.scale.x, c * texture.scale.y), texture.offset};
}

bool IsUpsideDown(MappingKind mapping) {
  return mapping == MappingKind::kSpherical || mapping == MappingKind::kCube ||
         mapping == MappingKind::kUv;
}

Vec2d MapToTexture(const Texture& texture, const Vec3d& point) {
  const MappingFrame frame = FrameOf(texture);
  const Vec3d local(point.dot(frame.x), point.dot(frame.y), point.dot(frame.z));
  const Mapped<double> mapped = Map(texture.mapping, local);
  const double v = IsUpsideDown(texture.mapping) ? 1 - mapped.v : mapped.v;
  return TransformOf(texture).Apply(Vec2d(mapped.u, v));
}

}  // namespace nacre
