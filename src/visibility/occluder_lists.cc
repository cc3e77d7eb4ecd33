// SPDX-License-Identifier: Apache-2.0
#include "visibility/occluder_lists.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace nacre {
namespace {

// A surface counts as lit by float directions: where the true n.l is above this, in any case.
constexpr double kGrazing = -2e-6;

// A sphere as it is seen against the light. Radii are margins larger than they are.
struct Seen {
  double radius;
  double lit;  // how far lit points lie behind the centre (away from a directional light), or
               // from a light at a point, at most
  // Of a light at a point:
  bool around_light;    // the light may be in the sphere
  Vec3d direction;      // unit, from the light to the centre
  double distance;      // of the centre
  double sine, cosine;  // of the angle between the centre and the silhouette
};

Seen SeeAlong(const TraceSphere& sphere, bool outward) {
  const double margin = BoundMargin(sphere.radius, sphere.center.length());
  Seen seen{};
  seen.radius = sphere.radius + margin;
  seen.lit = margin + (outward ? -kGrazing * sphere.radius : sphere.radius);
  return seen;
}

Seen SeeFrom(const Vec3d& light, const TraceSphere& sphere, bool outward) {
  const Vec3d offset = sphere.center - light;
  const double margin = BoundMargin(sphere.radius, sphere.center.length() + light.length());
  Seen seen{};
  seen.radius = sphere.radius + margin;
  seen.distance = offset.length();
  seen.around_light = seen.distance <= seen.radius;
  // The tangents' length squared; with n.l = g < 0 still lit, points are 2 r |g| beyond it.
  const double tangent2 =
      (seen.distance - sphere.radius + 2 * margin) * (seen.distance + sphere.radius);
  seen.lit = outward ? std::sqrt(std::max(tangent2, 0.0)) - 2 * kGrazing * sphere.radius + margin
                     : seen.distance + seen.radius;
  if (seen.around_light) return seen;
  seen.direction = offset / seen.distance;
  seen.sine = seen.radius / seen.distance;
  seen.cosine = std::sqrt((1 - seen.sine) * (1 + seen.sine));
  return seen;
}

// Whether the blocker reaches over the lowest lit points within the cylinder about the sphere.
bool MayBlockAlong(const TraceSphere& blocker, const Seen& seen_blocker, const TraceSphere& sphere,
                   const Seen& seen, const Vec3d& to_light) {
  const Vec3d offset = blocker.center - sphere.center;
  const double along = offset.dot(to_light);
  if (along + seen_blocker.radius + seen.lit < 0) return false;
  const Vec3d across = offset - to_light * along;
  const double radii = seen_blocker.radius + seen.radius;
  return across.dot(across) <= radii * radii;
}

// Whether the blocker reaches nearer to the light than the furthest lit points within the cone
// about the sphere. Cosines err by a few 2^-53.
bool MayBlockFrom(const Seen& blocker, const Seen& sphere) {
  if (blocker.distance - blocker.radius > sphere.lit) return false;
  if (blocker.around_light || sphere.around_light) return true;
  return blocker.direction.dot(sphere.direction) >
         blocker.cosine * sphere.cosine - blocker.sine * sphere.sine - 1e-12;
}

// Whether the blocker reaches into the hull of the sphere and the ball: into the sphere about some
// point between their centres whose radius is in between theirs. Its distance from there, less the
// radii, is smallest where the slope of the distance is that of the radius.
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
  const double reach = sphere.center.length() + ball.center.length() + ball.radius;
  return least <= blocker.radius +
                      BoundMargin(blocker.radius + sphere.radius, reach + blocker.center.length());
}

// Whether the blocker reaches into what the ball sweeps on its way to a directional light.
bool MayBlockBallAlong(const TraceSphere& blocker, const TraceSphere& ball, const Vec3d& to_light) {
  const Vec3d offset = blocker.center - ball.center;
  const double along = offset.dot(to_light);
  const double radii = blocker.radius + ball.radius;
  const double reach = radii + BoundMargin(radii, blocker.center.length() + ball.center.length());
  return along + reach >= 0 && (offset - to_light * along).length() <= reach;
}

// Centre and point are rounded by 2^-24 of themselves a coordinate, and so is their difference,
// which is no longer than the two together: 4 2^-24 of that at most. Nothing is sure of spheres
// that coincide: rays start on them. Squares below 1e-34 and above 1e37 are too near to where
// floats end.
OccluderProposal Propose(const TraceSphere& sphere, const TraceSphere& from) {
  const Vec3d offset = sphere.center - from.center;
  const double reach = offset.length() + from.radius;
  const double error = 5 * kFloatUnit * reach;
  const double outer = sphere.radius + error;
  const double inner = std::max(sphere.radius - error, 0.0);
  const bool unsure = Coincide(sphere, from) || reach * reach > 1e37;
  constexpr double kMore = 1 + 1e-6, kLess = 1 - 1e-6, kLeast = 1e-34;
  OccluderProposal proposal;
  for (int c = 0; c < 3; ++c) proposal.center[c] = static_cast<float>(offset[c]);
  proposal.outer2 = unsure ? std::numeric_limits<float>::infinity()
                           : static_cast<float>(outer * outer * kMore + kLeast);
  proposal.inner2 = unsure ? 0 : static_cast<float>(inner * inner * kLess - kLeast);
  return proposal;
}

// The list of every sphere, of those spheres j for which may_block(i, j).
template <class MayBlock>
OccluderLists MakeLists(const HugeArray<TraceSphere>& spheres, const MayBlock& may_block) {
  const size_t count = spheres.size();
  OccluderLists lists;
  lists.end.reserve(count);
  for (size_t i = 0; i < count; ++i) {
    for (size_t j = 0; j < count; ++j) {
      if (!may_block(i, j)) continue;
      lists.spheres.push_back(static_cast<uint32_t>(j));
      lists.proposals.push_back(Propose(spheres[j], spheres[i]));
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
  return MakeLists(spheres, [&](size_t i, size_t j) {
    if (target.Contains(static_cast<uint32_t>(j))) return false;
    if (Coincide(spheres[i], spheres[j])) return !outward;
    return !ball || MayBlockBall(spheres[j], spheres[i], *ball);
  });
}

OccluderLists ListOccluders(const TraceGeometry& geometry, const ShadowLight& light, bool outward) {
  const HugeArray<TraceSphere>& spheres = geometry.spheres;
  std::vector<Seen> seen;
  seen.reserve(spheres.size());
  for (const TraceSphere& sphere : spheres) {
    seen.push_back(light.positional ? SeeFrom(light.place, sphere, outward)
                                    : SeeAlong(sphere, outward));
  }
  return MakeLists(spheres, [&](size_t i, size_t j) {
    const bool may = light.positional
                         ? MayBlockFrom(seen[j], seen[i])
                         : MayBlockAlong(spheres[j], seen[j], spheres[i], seen[i], light.place);
    return may && !(outward && Coincide(spheres[i], spheres[j]));
  });
}

bool MayShadow(const TraceGeometry& geometry, const OccluderLists& lists, const ShadowLight& light,
               uint32_t start, const TraceSphere& ball) {
  for (uint32_t i = lists.Begin(start); i < lists.end[start]; ++i) {
    const TraceSphere& blocker = geometry.spheres[lists.spheres[i]];
    const bool may = light.positional ? MayBlockBall(blocker, ball, {light.place, 0})
                                      : MayBlockBallAlong(blocker, ball, light.place);
    if (may) return true;
  }
  return false;
}

}  // namespace nacre
