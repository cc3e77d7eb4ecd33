// SPDX-License-Identifier: Apache-2.0
// hit/batch.h: the batches that flow through the renderer, as structure-of-arrays: camera rays,
// their closest hits, shaded hits and shadow rays. Data only: made by render and visibility,
// read by shading, which never includes each other.
//
// All positions are doubles relative to the camera's position ("camera space without rotation"):
// world position minus camera position, rounded once. Arrays have room for kBatchCapacity entries
// and are padded to whole vectors; entries past `count` hold stale but finite values.
#pragma once

#include <cstddef>
#include <cstdint>

#include "base/aligned.h"
#include "scene/light_shapes.h"

namespace nacre {

// Rays a batch holds at most: all arrays of a batch together stay in L2.
inline constexpr size_t kBatchCapacity = 1024;
static_assert(kBatchCapacity % kBatchPadding == 0);

// Primitives are numbered spheres first, in scene order, then the triangles of all meshes.
inline constexpr uint32_t kNoPrimitive = 0xffffffffu;

// Three coordinate arrays.
template <typename T>
struct Soa3 {
  AlignedArray<T> x{kBatchCapacity}, y{kBatchCapacity}, z{kBatchCapacity};
};

// The film positions of a round of samples of a tile, in pixels from the top left corner of the
// full frame: sample by sample, each of all the tile's pixels row by row.
struct FilmBatch {
  size_t count = 0;
  AlignedArray<double> x{kBatchCapacity}, y{kBatchCapacity};
};

// Camera rays: points origin + t direction, t > 0. Directions are not normalised.
struct RayBatch {
  size_t count = 0;
  Soa3<double> origin;  // 0 for a perspective camera
  Soa3<double> direction;
};

// For each ray of a RayBatch, the closest hit.
struct ClosestHits {
  AlignedArray<uint32_t> primitive{kBatchCapacity};  // kNoPrimitive: the ray escapes
  AlignedArray<double> t{kBatchCapacity};            // in units of the ray's direction
};

// The unit directions of each hit, as shading reads them: rounded to float from double.
struct HitDirections {
  Soa3<float> normal;   // shading normal on the side that the ray came from
  Soa3<float> to_view;  // towards the ray's origin
};

// Hits to shade, compacted, in the order of their ray indices within each run of one material.
struct HitBatch {
  size_t count = 0;
  bool one_primitive = false;                        // all hits are known to be on the same one
  AlignedArray<uint32_t> ray{kBatchCapacity};        // index into the FilmBatch
  AlignedArray<uint32_t> primitive{kBatchCapacity};  // for excluding itself from its shadow rays
  Soa3<double> position;                             // on the surface
  // HitDirections in double, for the lobes that are too narrow for float; filled where asked for.
  Soa3<double> normal, to_view;
};

// Where hits are written to.
struct HitsTo {
  HitBatch* hits;
  HitDirections* directions;
  bool exact;  // HitBatch::normal and to_view, too
};

// Shadow rays origin + t direction, 0 < t < t_max.
inline constexpr uint32_t kAnyLight = 0xffffffffu;
struct ShadowRayBatch {
  size_t count = 0;
  // The light that all of them go to, as the intersector numbers those whose occluders it has
  // found (Intersector::FindOccluders); kAnyLight: not one of these.
  uint32_t light = kAnyLight;
  // They surely leave the spheres that they start on outward, because these were seen from outside
  // and face the light: such a sphere is then never in the way, whatever the last digit says.
  bool outward = false;
  // Primitives of the light itself, which are never in the way of rays to it.
  PrimitiveRange target;
  Soa3<double> origin;     // HitBatch::position
  Soa3<double> direction;  // towards the light, not normalised
  // 1: a light at origin + direction; or infinity. 0: nobody asks, and nothing is in the way.
  AlignedArray<double> t_max{kBatchCapacity};
  AlignedArray<uint32_t> primitive{kBatchCapacity};  // where the ray starts
  AlignedArray<uint8_t> occluded{kBatchCapacity};    // result: 1 if anything is in the way
};

}  // namespace nacre
