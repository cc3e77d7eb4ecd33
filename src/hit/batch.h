// SPDX-License-Identifier: Apache-2.0
// hit/batch.h: the batches that flow through the renderer, as structure-of-arrays: camera rays,
// their closest hits, shaded hits and shadow rays. Data only: made by render and visibility,
// read by shading, which never includes each other.
//
// All positions are doubles relative to the camera's position ("camera space without rotation"):
// world position minus camera position, rounded once. Arrays have room for kBatchCapacity entries
// and are padded to whole vectors; entries past `count` hold stale but finite values.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <type_traits>

#include "base/aligned.h"
#include "hit/camera_frame.h"
#include "scene/light_shapes.h"

namespace nacre {

// Rays a batch holds at most: all arrays of a batch together stay in L2.
inline constexpr size_t kBatchCapacity = 2048;
static_assert(kBatchCapacity % kBatchPadding == 0);

// Primitives are numbered spheres first, in scene order, then the triangles of all meshes.
inline constexpr uint32_t kNoPrimitive = 0xffffffffu;

// How far the coordinates' arrays lie apart in a Soa3.
template <typename T>
inline constexpr size_t kSoaStride = AlignedArray<std::remove_const_t<T>>::Room(kBatchCapacity);

// Three coordinate arrays. They share one piece of memory, so that loops over several of them keep
// one address for each Soa3 in a register, not three.
template <typename T>
struct Soa3 {
  AlignedArray<T> all{3 * kSoaStride<T>};
  AlignedArray<T> x{&all, 0, kBatchCapacity};
  AlignedArray<T> y{&all, kSoaStride<T>, kBatchCapacity};
  AlignedArray<T> z{&all, 2 * kSoaStride<T>, kBatchCapacity};
};

template <typename T>
void CopySoa(const Soa3<T>& from, size_t count, Soa3<T>* to) {
  std::copy_n(from.x.data(), count, to->x.data());
  std::copy_n(from.y.data(), count, to->y.data());
  std::copy_n(from.z.data(), count, to->z.data());
}

// Those arrays, for loops to keep in registers: what a loop stores might be an address that a Soa3
// holds, for all that the compiler knows.
template <typename T>
struct Pointers3 {
  T* __restrict first;
  T* x() const { return first; }
  T* y() const { return first + kSoaStride<T>; }
  T* z() const { return first + 2 * kSoaStride<T>; }
};

template <typename T>
Pointers3<const T> PointersTo(const Soa3<T>& soa) {
  return {soa.all.data()};
}

template <typename T>
Pointers3<T> PointersTo(Soa3<T>* soa) {
  return {soa->all.data()};
}

// Film positions, in pixels from the top left corner of the full frame, and the numbers of the rays
// through them, which ascend. Of a round of samples of a tile rays are numbered sample by sample,
// each of all the tile's pixels row by row; otherwise in their order here.
struct FilmBatch {
  FilmBatch() { NumberInOrder(); }
  void NumberInOrder() { std::iota(ray.begin(), ray.end(), 0u); }

  size_t count = 0;  // of rays
  // Of a tile's pixels those alone have positions here, one behind the other, that a ray may hit
  // something in: its spans'. Otherwise ray i is the one through position i.
  bool only_spans = false;
  // The rays go through the centres of a tile's pixels, row by row: x and y are not filled in.
  bool centers = false;
  AlignedArray<double> x{kBatchCapacity}, y{kBatchCapacity};
  AlignedArray<uint32_t> ray{kBatchCapacity};
};

// Camera rays: points origin + t direction, t > 0. Directions are not normalised.
struct RayBatch {
  size_t count = 0;
  Soa3<double> origin;  // 0 for a perspective camera
  Soa3<double> direction;
  FilmView film;  // their frame's; of rays of no frame, the default
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
  AlignedArray<uint32_t> ray{kBatchCapacity};        // FilmBatch::ray
  AlignedArray<uint32_t> primitive{kBatchCapacity};  // for excluding itself from its shadow rays
  // These three are filled where asked for (HitsTo).
  Soa3<double> position;  // on the surface
  // HitDirections in double, for the lobes that are too narrow for float.
  Soa3<double> normal, to_view;
};

// Where hits are written to.
struct HitsTo {
  HitBatch* hits;
  HitDirections* directions;
  bool positions;  // HitBatch::position, too
  bool exact;      // HitBatch::normal and to_view, too
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
  // Bounds the camera's coordinates: what the light and the surfaces lost to rounding when they
  // were made relative to the camera. A surface that the rays end on within rounding, as a ceiling
  // that a lamp is flush with, is not in their way.
  double end_reach = 0;
  Soa3<double> origin;     // HitBatch::position
  Soa3<double> direction;  // towards the light, not normalised
  // 1: a light at origin + direction; or infinity. 0: nobody asks, and nothing is in the way.
  AlignedArray<double> t_max{kBatchCapacity};
  AlignedArray<uint32_t> primitive{kBatchCapacity};  // where the ray starts
  AlignedArray<uint8_t> occluded{kBatchCapacity};    // result: 1 if anything is in the way
};

}  // namespace nacre
