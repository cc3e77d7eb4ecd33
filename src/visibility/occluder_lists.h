// SPDX-License-Identifier: Apache-2.0
// visibility/occluder_lists.h: for each sphere of a small scene those that can come between it and
// a light, so that its shadow rays need no tree, or need not be asked at all.
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

// Pairs of spheres are tested, so this is for few: beyond, bins are faster (light_bins.h).
inline constexpr size_t kMaxListedSpheres = 256;
inline constexpr size_t kMaxListed = 8;        // longer lists take rays longer than bins do
inline constexpr size_t kMaxSampledList = 64;  // and these, of rays all over, longer than a tree

// A listed sphere as floats tell of it, relative to the centre of the sphere whose list it is in: a
// line whose squared distance from its centre is above `outer2` misses it, and below `inner2` meets
// it, whatever the rounding of such centres and of points on that sphere.
struct OccluderProposal {
  float center[3];
  float outer2, inner2;
};

struct OccluderLists {
  std::vector<uint32_t> end;      // of each sphere's list
  std::vector<uint32_t> spheres;  // those that may hide the light from it, in ascending order
  std::vector<OccluderProposal> proposals;  // of these

  size_t longest = 0;

  uint32_t Begin(size_t sphere) const { return sphere == 0 ? 0 : end[sphere - 1]; }
};

// The list of a sphere holds every sphere that the exact test could find in the way of a shadow
// ray from any of its points that face the light. `outward`: such rays surely leave the sphere
// outward (ShadowRayBatch), and it is then not in its own list, nor are those that coincide with
// it. Triangles are not seen.
OccluderLists ListOccluders(const TraceGeometry& geometry, const ShadowLight& light, bool outward);

// The same for a light that lies anywhere in a ball, or without one for a sky. `target`: spheres
// that are the light itself. The ball is relative to the camera.
OccluderLists ListOccludersOfBall(const TraceGeometry& geometry,
                                  const std::optional<LightBall>& ball,
                                  const PrimitiveRange& target, bool outward);

// Whether any sphere of its list can come between a batch's hits, all on one sphere and with their
// positions, and the light that ListOccluders was asked about.
bool MayShadow(const TraceGeometry& geometry, const OccluderLists& lists, const ShadowLight& light,
               const HitBatch& hits);

// The same of points of sphere `start` that lie in `ball`.
bool MayShadow(const TraceGeometry& geometry, const OccluderLists& lists, const ShadowLight& light,
               uint32_t start, const TraceSphere& ball);

// Intersector::Occluded for rays to the lists' light from spheres.
void OccludedByLists(const TraceGeometry& geometry, const OccluderLists& lists,
                     ShadowRayBatch* rays);

}  // namespace nacre
