// SPDX-License-Identifier: Apache-2.0
#include "render/sphere_pictures.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace nacre {
namespace {

// More candidates than this are not looked through.
constexpr size_t kMostPictures = 8;

// How far a ray passes outside the outline, and by how much that may change along a step on the
// film, in any unit.
struct OutlineDistance {
  double outside, slack;

  bool IsOutside() const { return outside > slack; }
  bool IsInside() const { return outside < -slack; }
};

// The ray along d, from the camera to the film, passes a centre c at |c| sin(c, d) = |c x d| / |d|,
// and a step on the film turns it by an angle whose sine is the step over |d| at most. This is
// enough for most rays. The others take the angle (c, d) itself, and how it changes along the
// film's axes to the square's corners, with a bound of what the square of such a turn adds: an
// outline along an axis crosses no more squares than it does, and one that is seen under nearly
// 180 degrees, where the sine hardly changes, as the horizon of the ground, neither.
OutlineDistance DistanceFrom(const CameraFrame& frame, const SpherePicture& picture,
                             const Vec3d& own, double reach) {
  const Vec3d& center = picture.candidate->sphere.center;
  const double step = std::sqrt(2.0) * reach * frame.step_x.length();  // to a corner
  if (frame.projection == Projection::kOrthographic) {
    return {(center - own).cross(frame.forward).length() - picture.outline_radius, step};
  }
  const double length = own.length(), to_center = center.length();
  const double beside = center.cross(own).length(), along = center.dot(own);
  // Beyond a right angle, where the sine falls again, its mirror image goes on.
  const double distance = along > 0 ? beside : 2 * to_center * length - beside;
  const OutlineDistance by_sine{distance - picture.outline_radius * length, to_center * step};
  if (by_sine.IsOutside() || by_sine.IsInside()) return by_sine;
  const Vec3d change = (center - own * (along / (length * length))) / beside;  // per step
  const double straight =
      reach * (std::abs(change.dot(frame.step_x)) + std::abs(change.dot(frame.step_y)));
  const double turn = step / length;
  const double bent = turn * turn * (1 + std::abs(along) / beside);
  return {std::atan2(beside, along) - picture.half_angle,
          std::min(straight + bent, std::asin(std::min(turn, 1.0)))};
}

SpherePicture PictureOf(const CameraFrame& frame, const Projector& projector,
                        const TileCandidate& candidate) {
  const TraceSphere& sphere = candidate.sphere;
  const double distance = sphere.center.length(), radius2 = sphere.radius * sphere.radius;
  SpherePicture picture;
  picture.candidate = &candidate;
  picture.bounds = Project(projector, sphere);
  picture.axis = sphere.center / distance;
  picture.half_angle = std::asin(std::min(sphere.radius / distance, 1.0));
  picture.outline_radius = sphere.radius;
  if (frame.projection == Projection::kPerspective) {
    picture.has_outline = picture.whole = !candidate.around_camera;
    picture.outline_depth = std::sqrt(std::max(distance * distance - radius2, 0.0));
    return picture;
  }
  const double depth = sphere.center.dot(frame.forward);
  picture.has_outline = true;
  picture.whole = depth >= sphere.radius;
  picture.outline_depth = depth;
  if (depth < 0) picture.outline_radius = std::sqrt(std::max(radius2 - depth * depth, 0.0));
  return picture;
}

}  // namespace

std::optional<std::vector<SpherePicture>> PicturesOf(const CameraFrame& frame,
                                                     const TileCandidates& candidates) {
  std::vector<SpherePicture> pictures;
  const Projector projector = MakeProjector(frame);
  for (const auto& cell : candidates.cells) {
    if (pictures.size() + cell.size() > kMostPictures) return std::nullopt;
    for (const TileCandidate& candidate : cell) {
      pictures.push_back(PictureOf(frame, projector, candidate));
    }
  }
  return pictures;
}

SeenOutlines OutlinesAround(const CameraFrame& frame, const std::vector<SpherePicture>& pictures,
                            double x, double y, double reach) {
  const Vec3d own = frame.corner + frame.step_x * x + frame.step_y * y;
  double nearest = std::numeric_limits<double>::infinity(), covered = nearest;
  const SpherePicture* seen = nullptr;
  int count = 0;
  SeenOutlines outlines;
  for (const SpherePicture& picture : pictures) {
    if (!picture.has_outline) {
      ++count;
      outlines.background = false;
      continue;
    }
    const OutlineDistance distance = DistanceFrom(frame, picture, own, reach);
    if (distance.IsOutside()) continue;
    ++count;
    if (distance.IsInside()) {
      outlines.background = false;
      if (picture.whole) covered = std::min(covered, picture.outline_depth);
    } else if (picture.outline_depth < nearest) {
      nearest = picture.outline_depth;
      seen = &picture;
    }
  }
  outlines.any = nearest < covered;
  if (outlines.any && count == 1 && seen->whole) outlines.alone = &seen->candidate->sphere;
  return outlines;
}

}  // namespace nacre
