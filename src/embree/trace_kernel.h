// SPDX-License-Identifier: Apache-2.0
// embree/trace_kernel.h: traces batches of rays with Embree, in packets or ray by ray.
#pragma once

#include "embree/embree_api.h"
#include "hit/batch.h"
#include "visibility/geometry.h"

namespace nacre {

// A committed scene made of the geometry through SphereCallbacks and TriangleCallbacks.
struct TraceScene {
  RTCScene scene = nullptr;
  int packet_width = 0;  // 4, 8 or 16: the widest that the device traverses natively
  const TraceGeometry* geometry = nullptr;
  bool is_large = false;  // incoherent rays are faster one by one
  Vec3d offset{0, 0, 0};  // from the scene's origin to the camera, which rays are relative to
};

// Implement BoxTrees::FindNearer and BoxTrees::FindOccluded.
void TraceNearer(const TraceScene& scene, const RayBatch& rays, ClosestHits* hits);
void TraceOccluded(const TraceScene& scene, ShadowRayBatch* rays);

}  // namespace nacre
