// SPDX-License-Identifier: Apache-2.0
// bench/float_visibility.h: camera rays against spheres in float alone: what the renderer's exact
// hits are paid for. Of the same bins, cells and spans as the exact tiles, and of Embree's tree,
// come the nearest sphere and its depth, and nothing after them. Not for use in the renderer.
#pragma once

#include <cstdint>
#include <vector>

#include "embree/embree_api.h"
#include "hit/batch.h"
#include "scene/scene.h"
#include "visibility/tile_kernel.h"

namespace nacre {

// A sphere relative to the camera.
struct FloatSphere {
  float center[3];
  float radius2;
};

std::vector<FloatSphere> FloatSpheres(const Scene& scene);

// The nearest sphere of each pixel of a tile's spans, row by row; room for a vector more.
struct FloatHits {
  AlignedArray<float> t{kBatchCapacity + kBatchPadding};  // in lengths of the ray's direction
  AlignedArray<uint32_t> sphere{kBatchCapacity +
                                kBatchPadding};  // kNoPrimitive: none, and t is undefined
};

// The rays through the middles of a tile's pixels, of a perspective camera. `spheres`: all of the
// scene, in its order.
void TraceFloatTile(const CameraFrame& frame, const std::vector<FloatSphere>& spheres,
                    const TileCandidates& candidates, FloatHits* hits);

// Of a user geometry whose data is the array of spheres, for packets of 16 rays: the same test.
void IntersectFloatSphere(const RTCIntersectFunctionNArguments* args);

}  // namespace nacre
