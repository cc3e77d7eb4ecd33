// SPDX-License-Identifier: Apache-2.0
#include "render/sphere_pictures.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace nacre {
namespace {

// More candidates than this are not looked through.
constexpr size_t kMostPictures = 8;

// How far a ray passes outside the outline, and by how much that may change along a unit of the
// film; both times the ray's length. Seen in perspective, the ray along d, from the camera to the
// film, passes a centre c at |c| sin(c, d) = |c x d| / |d|, and a step on the film turns it by an
// angle whose sine is the step over |d| at most.
struct OutlineDistance {
  double outside, slope;
};

OutlineDistance DistanceFrom(const CameraFrame& frame, const SpherePicture& picture,
                             const Vec3d& own) {
  const Vec3d& center = picture.candidate->sphere.center;
  if (frame.projection == Projection::kOrthographic) {
    return {(center - own).cross(frame.forward).length() - picture.outline_radius, 1};
  }
  if (center.dot(own) <= 0) return {std::numeric_limits<double>::infinity(), 1};
  return {center.cross(own).length() - picture.outline_radius * own.length(), center.length()};
}

SpherePicture PictureOf(const CameraFrame& frame, const Projector& projector,
                        const TileCandidate& candidate) {
  const TraceSphere& sphere = candidate.sphere;
  const double distance = sphere.center.length(), radius2 = sphere.radius * sphere.radius;
  SpherePicture picture;
  picture.candidate = &candidate;
  picture.bounds = projector.Project(sphere);
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
  picture.whole = depth >= 0;
  picture.outline_depth = depth;
  if (!picture.whole) picture.outline_radius = std::sqrt(std::max(radius2 - depth * depth, 0.0));
  return picture;
}

}  // namespace

std::optional<std::vector<SpherePicture>> PicturesOf(const CameraFrame& frame,
                                                     const TileCandidates& candidates) {
  std::vector<SpherePicture> pictures;
  const Projector projector(frame);
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
  const double step = std::sqrt(2.0) * reach * frame.step_x.length();
  double nearest = std::numeric_limits<double>::infinity(), covered = nearest;
  const SpherePicture* seen = nullptr;
  int count = 0;
  for (const SpherePicture& picture : pictures) {
    if (!picture.has_outline) {
      ++count;
      continue;
    }
    const OutlineDistance distance = DistanceFrom(frame, picture, own);
    const double slack = distance.slope * step;
    if (distance.outside > slack) continue;
    ++count;
    if (distance.outside < -slack) {
      covered = std::min(covered, picture.outline_depth);
    } else if (picture.outline_depth < nearest) {
      nearest = picture.outline_depth;
      seen = &picture;
    }
  }
  SeenOutlines outlines;
  outlines.any = nearest < covered;
  if (outlines.any && count == 1 && seen->whole) outlines.alone = &seen->candidate->sphere;
  return outlines;
}

}  // namespace nacre
