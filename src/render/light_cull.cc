// SPDX-License-Identifier: Apache-2.0
#include "render/light_cull.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <variant>

namespace nacre {
namespace {

// The kernels decide by the signs of n.l and of cos a - cos cutoff, computed in float with errors
// of less than 1e-6.
constexpr double kFloatMargin = 1e-5;

}  // namespace

BatchBounds BoundHits(const HitBatch& hits, const HitDirections& directions) {
  const Soa3<float>& normal = directions.normal;
  const double infinity = std::numeric_limits<double>::infinity();
  Vec3d low(infinity), high(-infinity), sum(0);
  for (size_t i = 0; i < hits.count; ++i) {
    const Vec3d p(hits.position.x[i], hits.position.y[i], hits.position.z[i]);
    low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
    sum += Vec3d(normal.x[i], normal.y[i], normal.z[i]);
  }
  BatchBounds bounds;
  if (hits.count == 0) return bounds;
  bounds.center = (low + high) / 2;
  bounds.radius = (high - low).length() / 2 * (1 + 1e-9);
  const double length = sum.length();
  if (length > 0) bounds.axis = sum / length;
  double least = 1;
  for (size_t i = 0; i < hits.count; ++i) {
    least = std::min(least,
                     Vec3d(normal.x[i], normal.y[i], normal.z[i]).dot(bounds.axis) - kFloatMargin);
  }
  bounds.spread_rad = std::acos(std::max(least, -1.0));
  return bounds;
}

LightGeometry GeometryOf(const Light& light, const Vec3d& camera_position) {
  LightGeometry geometry;
  if (const auto* sun = std::get_if<DirectionalLight>(&light.kind)) {
    geometry.position = -sun->direction_of_travel.normalized();
  } else if (const auto* point = std::get_if<PointLight>(&light.kind)) {
    geometry.positional = true;
    geometry.position = point->position - camera_position;
  } else if (const auto* spot = std::get_if<SpotLight>(&light.kind)) {
    geometry.positional = true;
    geometry.position = spot->position - camera_position;
    geometry.axis = spot->direction_of_travel.normalized();
    geometry.cos_cutoff = std::cos(spot->cutoff_deg * M_PI / 180);
  }
  return geometry;
}

bool MayIlluminate(const LightGeometry& light, const BatchBounds& bounds) {
  Vec3d to_light = light.position;
  double ball_rad = 0;  // half the angle that the positions fill as seen from the light
  if (light.positional) {
    to_light -= bounds.center;
    const double distance = to_light.length();
    if (!(distance > bounds.radius * (1 + 1e-9))) return true;  // the light is in the ball
    to_light /= distance;
    ball_rad = std::asin(bounds.radius / distance);
    if (light.cos_cutoff >= -1) {
      const double angle = std::acos(std::clamp(-to_light.dot(light.axis), -1.0, 1.0));
      const double nearest = std::cos(std::max(angle - ball_rad, 0.0));
      if (nearest < light.cos_cutoff - kFloatMargin) return false;
    }
  }
  // The least angle between any normal and any direction to the light is the angle between the axes
  // minus both spreads.
  const double between = std::acos(std::clamp(to_light.dot(bounds.axis), -1.0, 1.0));
  return between - bounds.spread_rad - ball_rad < M_PI / 2 + kFloatMargin;
}

}  // namespace nacre
