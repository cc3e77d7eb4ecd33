// SPDX-License-Identifier: Apache-2.0
#include "render/sphere_projections.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace nacre {
namespace {

// With more candidates, searching them for each pixel takes too long.
constexpr size_t kMaxProjections = 8;

// The signed distance by which a ray passes outside the outline, and how much that may change
// within the square, in any common unit.
struct OutlineDistance {
  double outside, change;

  bool IsOutside() const { return outside > change; }
  bool IsInside() const { return outside < -change; }
};

// The ray along d, from the eye to a point of the film, passes the centre c at the distance |c| sin
// a = |c x d| / |d|, where a is the angle between c and d. A step on the film turns the ray by an
// angle whose sine is at most the step divided by |d|. This bound decides for most rays. For the
// others, the angle a itself is compared with that of the outline, and its change towards the
// square's corners is bounded by its derivatives along the film's axes and a bound of the
// second-order term. This is tight for outlines that run along an axis, and for those whose cone is
// nearly a half-space, such as the horizon of a large ground sphere, where the sine hardly changes.
OutlineDistance DistanceFrom(const CameraFrame& frame, const SphereProjection& projection,
                             const Vec3d& direction, double half_side) {
  const Vec3d& center = projection.candidate->sphere.center;
  const double step = std::sqrt(2.0) * half_side * frame.step_x.length();  // to a corner
  if (frame.projection == Projection::kOrthographic) {
    return {(center - direction).cross(frame.forward).length() - projection.outline_radius, step};
  }
  const double length = direction.length(), to_center = center.length();
  const double beside = center.cross(direction).length(), along = center.dot(direction);
  // Beyond a right angle the sine falls again; 2 |c| - |c| sin a keeps the distance monotonic.
  const double distance = along > 0 ? beside : 2 * to_center * length - beside;
  const OutlineDistance by_sine{distance - projection.outline_radius * length, to_center * step};
  if (by_sine.IsOutside() || by_sine.IsInside()) return by_sine;
  const Vec3d change = (center - direction * (along / (length * length))) / beside;  // per step
  const double straight =
      half_side * (std::abs(change.dot(frame.step_x)) + std::abs(change.dot(frame.step_y)));
  const double turn = step / length;
  const double bent = turn * turn * (1 + std::abs(along) / beside);
  return {std::atan2(beside, along) - projection.half_angle,
          std::min(straight + bent, std::asin(std::min(turn, 1.0)))};
}

SphereProjection ProjectSphere(const CameraFrame& frame, const Projector& projector,
                               const TileCandidate& candidate) {
  const TraceSphere& sphere = candidate.sphere;
  const double distance = sphere.center.length(), radius2 = sphere.radius * sphere.radius;
  SphereProjection projection;
  projection.candidate = &candidate;
  projection.bounds = Project(projector, sphere);
  projection.axis = sphere.center / distance;
  projection.half_angle = std::asin(std::min(sphere.radius / distance, 1.0));
  projection.outline_radius = sphere.radius;
  if (frame.projection == Projection::kPerspective) {
    projection.has_outline = projection.whole = !candidate.around_camera;
    projection.outline_depth = std::sqrt(std::max(distance * distance - radius2, 0.0));
    return projection;
  }
  const double depth = sphere.center.dot(frame.forward);
  projection.has_outline = true;
  projection.whole = depth >= sphere.radius;
  projection.outline_depth = depth;
  if (depth < 0) projection.outline_radius = std::sqrt(std::max(radius2 - depth * depth, 0.0));
  return projection;
}

}  // namespace

std::optional<std::vector<SphereProjection>> ProjectSpheres(const CameraFrame& frame,
                                                            const TileCandidates& candidates) {
  std::vector<SphereProjection> projections;
  const Projector projector = MakeProjector(frame);
  for (const auto& cell : candidates.cells) {
    if (projections.size() + cell.size() > kMaxProjections) return std::nullopt;
    for (const TileCandidate& candidate : cell) {
      projections.push_back(ProjectSphere(frame, projector, candidate));
    }
  }
  return projections;
}

VisibleOutlines FindVisibleOutlines(const CameraFrame& frame,
                                    const std::vector<SphereProjection>& projections, double x,
                                    double y, double half_side) {
  const Vec3d direction = frame.corner + frame.step_x * x + frame.step_y * y;
  double nearest = std::numeric_limits<double>::infinity(), covered = nearest;
  const SphereProjection* seen = nullptr;
  int count = 0;
  VisibleOutlines outlines;
  for (const SphereProjection& projection : projections) {
    if (!projection.has_outline) {
      ++count;
      outlines.background = false;
      continue;
    }
    const OutlineDistance distance = DistanceFrom(frame, projection, direction, half_side);
    if (distance.IsOutside()) continue;
    ++count;
    if (distance.IsInside()) {
      outlines.background = false;
      if (projection.whole) covered = std::min(covered, projection.outline_depth);
    } else if (projection.outline_depth < nearest) {
      nearest = projection.outline_depth;
      seen = &projection;
    }
  }
  outlines.any = nearest < covered;
  if (outlines.any && count == 1 && seen->whole) outlines.only_sphere = &seen->candidate->sphere;
  return outlines;
}

}  // namespace nacre
