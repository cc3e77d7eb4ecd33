// SPDX-License-Identifier: Apache-2.0
#include "visibility/occluder_lists.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace nacre {
namespace {

// Shading tests n.l > 0 in float. The test is false wherever the exact n.l is below this.
constexpr double kGrazing = -2e-6;

// The margin that conservative tests add to a sphere's radius, far above the rounding errors of
// rays, of the exact test and of the bound itself. All of these are a few 2^-53 of the radius or of
// one of the coordinates, whose upper bound is `extent`.
double BoundMargin(double radius, double extent) { return 1e-9 * radius + 1e-12 * extent; }

// A sphere in the coordinates of a light, with its radius enlarged by BoundMargin.
struct SphereFromLight {
  double radius;
  // An upper bound of the distance of lit points. For a directional light it is measured from the
  // centre, away from the light; for a positional light, from the light.
  double lit_extent;
  // Positional lights only:
  bool around_light;    // the light may be inside the sphere
  Vec3d direction;      // unit, from the light to the centre
  double distance;      // from the light to the centre
  double sine, cosine;  // of the angle between the centre and the silhouette
};

SphereFromLight FromDirectionalLight(const TraceSphere& sphere, bool outward) {
  const double margin = BoundMargin(sphere.radius, sphere.center.length());
  SphereFromLight seen{};
  seen.radius = sphere.radius + margin;
  seen.lit_extent = margin + (outward ? -kGrazing * sphere.radius : sphere.radius);
  return seen;
}

SphereFromLight FromPositionalLight(const Vec3d& light, const TraceSphere& sphere, bool outward) {
  const Vec3d offset = sphere.center - light;
  const double margin = BoundMargin(sphere.radius, sphere.center.length() + light.length());
  SphereFromLight seen{};
  seen.radius = sphere.radius + margin;
  seen.distance = offset.length();
  seen.around_light = seen.distance <= seen.radius;
  // The squared length of the tangents from the light. Points down to n.l = g < 0 count as lit, and
  // lie at most 2 r |g| farther away.
  const double tangent2 =
      (seen.distance - sphere.radius + 2 * margin) * (seen.distance + sphere.radius);
  seen.lit_extent = outward
                        ? std::sqrt(std::max(tangent2, 0.0)) - 2 * kGrazing * sphere.radius + margin
                        : seen.distance + seen.radius;
  if (seen.around_light) return seen;
  seen.direction = offset / seen.distance;
  seen.sine = seen.radius / seen.distance;
  seen.cosine = std::sqrt((1 - seen.sine) * (1 + seen.sine));
  return seen;
}

// Whether the blocker may shadow lit points of the sphere from a directional light: it overlaps the
// cylinder about the sphere and extends further towards the light than the farthest lit points.
bool MayBlockAlong(const TraceSphere& blocker, const SphereFromLight& seen_blocker,
                   const TraceSphere& sphere, const SphereFromLight& seen, const Vec3d& to_light) {
  const Vec3d offset = blocker.center - sphere.center;
  const double along = offset.dot(to_light);
  if (along + seen_blocker.radius + seen.lit_extent < 0) return false;
  const Vec3d across = offset - to_light * along;
  const double radii = seen_blocker.radius + seen.radius;
  return across.dot(across) <= radii * radii;
}

// Whether the blocker may shadow lit points of the sphere from a positional light: it overlaps the
// cone about the sphere and comes nearer to the light than the farthest lit points. Cosines err by
// a few 2^-53.
bool MayBlockFrom(const SphereFromLight& blocker, const SphereFromLight& sphere) {
  if (blocker.distance - blocker.radius > sphere.lit_extent) return false;
  if (blocker.around_light || sphere.around_light) return true;
  return blocker.direction.dot(sphere.direction) >
         blocker.cosine * sphere.cosine - blocker.sine * sphere.sine - 1e-12;
}

// Whether the blocker overlaps the convex hull of the sphere and the ball: the union of the spheres
// about the points between their centres, whose radii are interpolated. The gap between the
// blocker's centre and such a sphere is smallest where the slope of the distance equals that of the
// radius.
bool MayBlockBall(const TraceSphere& blocker, const TraceSphere& sphere, const LightBall& ball) {
  const Vec3d axis = ball.center - sphere.center;
  const Vec3d offset = blocker.center - sphere.center;
  const double length2 = axis.length2();
  const double widening = ball.radius - sphere.radius;
  const auto gap = [&](double t) {
    return (offset - axis * t).length() - (sphere.radius + t * widening);
  };
  double least = std::min(gap(0), gap(1));
  if (widening * widening < length2) {
    const double foot = offset.dot(axis) / length2;
    const double height = (offset - axis * foot).length();
    const double t =
        foot + height * widening / length2 / std::sqrt(1 - widening * widening / length2);
    if (t > 0 && t < 1) least = std::min(least, gap(t));
  }
  const double extent = sphere.center.length() + ball.center.length() + ball.radius;
  return least <= blocker.radius +
                      BoundMargin(blocker.radius + sphere.radius, extent + blocker.center.length());
}

// Whether the blocker overlaps the volume that the ball sweeps towards a directional light.
bool MayBlockBallAlong(const TraceSphere& blocker, const TraceSphere& ball, const Vec3d& to_light) {
  const Vec3d offset = blocker.center - ball.center;
  const double along = offset.dot(to_light);
  const double radii = blocker.radius + ball.radius;
  const double bound = radii + BoundMargin(radii, blocker.center.length() + ball.center.length());
  return along + bound >= 0 && (offset - to_light * along).length() <= bound;
}

// Each coordinate of the centre and of the point is rounded by 2^-24 of itself, and so is their
// difference, which is no longer than the two together: 4 2^-24 of that at most. Spheres that
// coincide are always left to the exact test, because rays start on them. Squares below 1e-34 and
// above 1e37 are too near to the limits of float.
FloatOccluder MakeFloatOccluder(const TraceSphere& sphere, const TraceSphere& from) {
  const Vec3d offset = sphere.center - from.center;
  const double extent = offset.length() + from.radius;
  const double error = 5 * kFloatUnit * extent;
  const double outer = sphere.radius + error;
  const double inner = std::max(sphere.radius - error, 0.0);
  const bool unsure = Coincide(sphere, from) || extent * extent > 1e37;
  constexpr double kMore = 1 + 1e-6, kLess = 1 - 1e-6, kLeast = 1e-34;
  FloatOccluder occluder;
  for (int c = 0; c < 3; ++c) occluder.center[c] = static_cast<float>(offset[c]);
  occluder.outer2 = unsure ? std::numeric_limits<float>::infinity()
                           : static_cast<float>(outer * outer * kMore + kLeast);
  occluder.inner2 = unsure ? 0 : static_cast<float>(inner * inner * kLess - kLeast);
  return occluder;
}

// Makes the list of every sphere i: those spheres j for which may_block(i, j).
template <class MayBlock>
OccluderLists MakeLists(const HugeArray<TraceSphere>& spheres, bool outward_only,
                        const MayBlock& may_block) {
  const size_t count = spheres.size();
  OccluderLists lists;
  lists.outward_only = outward_only;
  lists.end.reserve(count);
  for (size_t i = 0; i < count; ++i) {
    for (size_t j = 0; j < count; ++j) {
      if (!may_block(i, j)) continue;
      lists.spheres.push_back(static_cast<uint32_t>(j));
      lists.floats.push_back(MakeFloatOccluder(spheres[j], spheres[i]));
    }
    lists.end.push_back(static_cast<uint32_t>(lists.spheres.size()));
    lists.longest = std::max<size_t>(lists.longest, lists.end[i] - lists.Begin(i));
  }
  return lists;
}

}  // namespace

OccluderLists ListOccludersOfBall(const TraceGeometry& geometry,
                                  const std::optional<LightBall>& ball,
                                  const PrimitiveRange& target, bool outward) {
  const HugeArray<TraceSphere>& spheres = geometry.spheres;
  return MakeLists(spheres, outward, [&](size_t i, size_t j) {
    if (target.Contains(static_cast<uint32_t>(j))) return false;
    if (Coincide(spheres[i], spheres[j])) return !outward;
    return !ball || MayBlockBall(spheres[j], spheres[i], *ball);
  });
}

OccluderLists ListOccluders(const TraceGeometry& geometry, const ShadowLight& light, bool outward) {
  const HugeArray<TraceSphere>& spheres = geometry.spheres;
  std::vector<SphereFromLight> seen;
  seen.reserve(spheres.size());
  for (const TraceSphere& sphere : spheres) {
    seen.push_back(light.positional ? FromPositionalLight(light.position, sphere, outward)
                                    : FromDirectionalLight(sphere, outward));
  }
  return MakeLists(spheres, outward, [&](size_t i, size_t j) {
    const bool may = light.positional
                         ? MayBlockFrom(seen[j], seen[i])
                         : MayBlockAlong(spheres[j], seen[j], spheres[i], seen[i], light.to_light);
    return may && !(outward && Coincide(spheres[i], spheres[j]));
  });
}

bool MayShadow(const TraceGeometry& geometry, const OccluderLists& lists, const ShadowLight& light,
               uint32_t start, const TraceSphere& ball) {
  for (uint32_t i = lists.Begin(start); i < lists.end[start]; ++i) {
    const TraceSphere& blocker = geometry.spheres[lists.spheres[i]];
    const bool may = light.positional ? MayBlockBall(blocker, ball, {light.position, 0})
                                      : MayBlockBallAlong(blocker, ball, light.to_light);
    if (may) return true;
  }
  return false;
}

}  // namespace nacre
