// SPDX-License-Identifier: Apache-2.0
// hit/batch.h: the batches that flow through the renderer, as structure of arrays: rays, their
// closest hits, shaded hits and shadow rays. Data only: render and visibility write the batches;
// shading reads them, and replaces shading normals by normal-mapped ones.
//
// All positions are doubles relative to the camera's position ("camera space without rotation"):
// world position minus camera position, rounded once. Arrays have room for kBatchCapacity entries
// and are padded to whole vectors; entries past `count` hold stale but finite values.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <type_traits>

#include "base/aligned.h"
#include "hit/camera_frame.h"
#include "scene/primitive_range.h"

namespace nacre {

// The maximum number of rays in a batch, chosen so that all its arrays together fit into the L2
// cache.
inline constexpr size_t kBatchCapacity = 2048;
static_assert(kBatchCapacity % kBatchPadding == 0);

// Primitives are numbered spheres first, in scene order, then the triangles of all meshes.
inline constexpr uint32_t kNoPrimitive = 0xffffffffu;

// The distance between the coordinate arrays of a Soa3, in elements.
template <typename T>
inline constexpr size_t kSoaStride = AlignedArray<std::remove_const_t<T>>::Capacity(kBatchCapacity);

// Three coordinate arrays in one allocation, so that loops over several Soa3 need one address
// register for each, not three.
template <typename T>
struct Soa3 {
  AlignedArray<T> all{3 * kSoaStride<T>};
  AlignedArray<T> x{&all, 0, kBatchCapacity};
  AlignedArray<T> y{&all, kSoaStride<T>, kBatchCapacity};
  AlignedArray<T> z{&all, 2 * kSoaStride<T>, kBatchCapacity};
};

template <typename T>
AlignedArray<T>& ChannelOf(Soa3<T>& soa, int c) {
  return c == 0 ? soa.x : c == 1 ? soa.y : soa.z;
}
template <typename T>
const AlignedArray<T>& ChannelOf(const Soa3<T>& soa, int c) {
  return c == 0 ? soa.x : c == 1 ? soa.y : soa.z;
}

template <typename T>
Vec3d VectorAt(const Soa3<T>& soa, size_t i) {
  return {soa.x[i], soa.y[i], soa.z[i]};
}

// Rounds to T.
template <typename T>
void SetVector(const Vec3d& v, size_t i, Soa3<T>* soa) {
  soa->x[i] = static_cast<T>(v.x);
  soa->y[i] = static_cast<T>(v.y);
  soa->z[i] = static_cast<T>(v.z);
}

template <typename T>
void CopySoa(const Soa3<T>& from, size_t count, Soa3<T>* to) {
  std::copy_n(from.x.data(), count, to->x.data());
  std::copy_n(from.y.data(), count, to->y.data());
  std::copy_n(from.z.data(), count, to->z.data());
}

// Adds entries [begin, end).
inline void AddSoa(const Soa3<float>& from, size_t begin, size_t end, Soa3<float>* to) {
  const auto add = [&](const float* __restrict of, float* __restrict sum) {
    for (size_t i = begin; i < end; ++i) sum[i] += of[i];
  };
  add(from.x.data(), to->x.data());
  add(from.y.data(), to->y.data());
  add(from.z.data(), to->z.data());
}

// Pointers to the arrays of a Soa3, which loops can keep in registers: the compiler must assume
// that a store changes the pointers in the Soa3 itself.
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

// Film positions, in pixels from the top left corner of the full frame. The samples of a tile are
// ordered by sample index, and for each index by the tile's sampled pixels, row by row.
struct FilmBatch {
  size_t count = 0;
  // In a batch of a tile's samples, the number of sampled pixels, each of which has count / pixels
  // samples.
  size_t pixels = 0;
  AlignedArray<double> x{kBatchCapacity}, y{kBatchCapacity};
};

// A ray that leaves a sphere may meet it again, and those that coincide with it, at twice the
// distance to its closest approach to the centre, but only if this is more than `own_after` of the
// ray. One that leaves outward never does, and one that leaves inward always does, whatever the
// rounding; where the side is not known, the distance decides.
inline constexpr double kLeavesOutward = std::numeric_limits<double>::infinity();
inline constexpr double kLeavesInward = -kLeavesOutward;
inline constexpr double kLeavesToEitherSide = 0;

// Rays are the points origin + t direction, t > 0. Directions are not normalised.
struct RayBatch {
  size_t count = 0;
  Soa3<double> origin;  // 0 for a perspective camera
  Soa3<double> direction;
  ProjectedTestView view;  // the camera's for camera rays; the default for others
  // Whether rays are spawned on surfaces. If true, `start` is the primitive that each ray starts
  // on, or kNoPrimitive if it starts on none, and `own_after` one of the numbers above. A ray meets
  // the sphere that it starts on, or one that coincides with it, only on the far side, and no
  // triangle whose plane it starts on. Origins therefore need no offset. If false, as for camera
  // rays, neither is read.
  bool from_surfaces = false;
  AlignedArray<uint32_t> start{kBatchCapacity};
  AlignedArray<double> own_after{kBatchCapacity};
  bool holes_are_solid = false;  // whether rays also hit what an opacity has cut out
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
  AlignedArray<uint32_t> ray{kBatchCapacity};        // index in FilmBatch
  AlignedArray<uint32_t> primitive{kBatchCapacity};  // what was hit
  // Filled on request only (HitOutput).
  Soa3<double> position;  // on the surface
  // HitDirections in double, for lobes that are too sharp for float.
  Soa3<double> normal, to_view;
};

// The buffers that hits are written to, and which of their optional arrays are filled.
struct HitOutput {
  HitBatch* hits;
  HitDirections* directions;
  bool exact_directions;  // HitBatch::normal and to_view
  bool positions = true;  // HitBatch::position
};

// ShadowRayBatch::light where no occluders of the light have been searched for beforehand.
inline constexpr uint32_t kAnyLight = 0xffffffffu;

// Shadow rays are the points origin + t direction, 0 < t < t_max.
struct ShadowRayBatch {
  size_t count = 0;
  // The light that all rays go to: its index in Intersector::FindOccluders, or kAnyLight.
  uint32_t light = kAnyLight;
  // Primitives of the light itself, which never occlude rays to it.
  PrimitiveRange target;
  // An upper bound of the camera's coordinates. It bounds the rounding errors of the positions of
  // the light and of the surfaces, which were made relative to the camera. A surface on which the
  // rays end within the rounding error, such as a ceiling that a lamp is flush with, does not
  // occlude them.
  double camera_extent = 0;
  Soa3<double> origin;     // HitBatch::position, or moved off it (OffsetOrigin)
  Soa3<double> direction;  // towards the light, not normalised
  // 1 for a light at origin + direction, infinity for a light at infinity, 0 for an inactive ray,
  // which is never occluded.
  AlignedArray<double> t_max{kBatchCapacity};
  AlignedArray<uint32_t> primitive{kBatchCapacity};  // where the ray starts
  // One of the numbers above: kLeavesOutward for rays from spheres that were hit from outside and
  // face the light.
  AlignedArray<double> own_after{kBatchCapacity};
  AlignedArray<uint8_t> occluded{kBatchCapacity};  // the result: 1 if occluded
};

}  // namespace nacre
