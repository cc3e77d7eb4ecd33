// SPDX-License-Identifier: Apache-2.0
// visibility/occluder_lists.h: for each sphere of a small scene, the list of the spheres that can
// shadow it from a light. Its shadow rays then need no BVH, and none are traced if the list is
// empty.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "hit/batch.h"
#include "scene/light_shapes.h"
#include "visibility/geometry.h"
#include "visibility/shadow_light.h"

namespace nacre {

// All pairs of spheres are tested, so this is for small scenes: with more spheres, bins are faster
// (light_bins.h).
inline constexpr size_t kMaxListedSpheres = 256;
inline constexpr size_t kMaxListLength =
    8;  // rays to punctual lights test longer lists slower than bins
inline constexpr size_t kMaxSampledListLength = 64;  // area lights: beyond, a BVH is faster

// A listed sphere in float, relative to the centre of the sphere whose list it is in. A line misses
// it if its squared distance from `center` is above `outer2`, and hits it if that is below
// `inner2`, however the centres and the points on the list's sphere are rounded.
struct FloatOccluder {
  float center[3];
  float outer2, inner2;
};

struct OccluderLists {
  std::vector<uint32_t> end;          // where each sphere's list ends
  std::vector<uint32_t> spheres;      // possible occluders of each sphere, in ascending order
  std::vector<FloatOccluder> floats;  // the same spheres in float
  // Whether the lists hold only for rays that leave their sphere outward (kLeavesOutward), and from
  // points that face the light. Other rays are tested against all spheres.
  bool outward_only = false;
  size_t longest = 0;

  uint32_t Begin(size_t sphere) const { return sphere == 0 ? 0 : end[sphere - 1]; }
};

// Makes a list for each sphere, which holds every sphere that the exact test could find to occlude
// a shadow ray from any of its points that face the light. If `outward`, the lists are
// outward_only: each contains neither the sphere itself nor any that coincides with it. Triangles
// are ignored.
OccluderLists ListOccluders(const TraceGeometry& geometry, const ShadowLight& light, bool outward);

// Makes the lists for a light inside a ball, which is relative to the camera; without a ball, for
// light from all directions. `target` are the spheres that are the light itself.
OccluderLists ListOccludersOfBall(const TraceGeometry& geometry,
                                  const std::optional<LightBall>& ball,
                                  const PrimitiveRange& target, bool outward);

// Whether any sphere in the list of their sphere can shadow a batch of hits, which all lie on one
// sphere and have their positions, from the light that the lists were made for.
bool MayShadow(const TraceGeometry& geometry, const OccluderLists& lists, const ShadowLight& light,
               const HitBatch& hits);

// Whether any sphere in the list of sphere `start` can shadow those of its points that lie in
// `ball`, from the light that the lists were made for.
bool MayShadow(const TraceGeometry& geometry, const OccluderLists& lists, const ShadowLight& light,
               uint32_t start, const TraceSphere& ball);

// Implements Intersector::Occluded for rays that start on spheres and go to the light of the lists.
void OccludedByLists(const TraceGeometry& geometry, const OccluderLists& lists,
                     ShadowRayBatch* rays);

}  // namespace nacre
