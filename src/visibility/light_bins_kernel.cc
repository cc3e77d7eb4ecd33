// SPDX-License-Identifier: Apache-2.0
// visibility/light_bins_kernel.cc: tests shadow rays against the spheres of their cells. A
// conservative float test of a vector of spheres proposes candidates, and the exact test in double
// decides.
#include <algorithm>
#include <cmath>

#include "visibility/light_bins.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "visibility/light_bins_kernel.cc"
#include "hwy/foreach_target.h"

#include "base/vec3-inl.h"
#include "visibility/occlusion-inl.h"
#include "visibility/packet-inl.h"

HWY_BEFORE_NAMESPACE();
namespace nacre::HWY_NAMESPACE {
namespace {
namespace hn = hwy::HWY_NAMESPACE;

constexpr uint32_t kNoCell = 0xffffffffu;

// A ray in float, in the coordinates of BinnedSphere, and its cell.
struct LightSpaceRay {
  // For a directional light, the origin, z rounded down; for a positional light, the unit direction
  // from the light.
  float x, y, z;
  float length;   // positional: the distance from the light to the origin
  uint32_t cell;  // kNoCell: beyond LightBins::max_distance
};

// The conservative test of one ray against a vector of spheres, whose radii cover the rounding
// errors here.
template <class D, class V = hn::Vec<D>>
HWY_INLINE uint32_t MayMeet(D d, const Vec3V<V>& center, V radius, const Vec3V<V>& ray, V length,
                            bool positional) {
  const V radius2 = hn::Mul(radius, radius);
  if (positional) {
    const V closest = FusedDot(center, ray);
    const Vec3V<V> across = Sub(center, Scale(ray, closest));
    const auto near = hn::Le(FusedDot(across, across), radius2);
    const auto ahead = hn::Gt(hn::Add(closest, radius), hn::Zero(d));
    const auto before = hn::Lt(hn::Sub(closest, radius), length);
    return BitsOfMask(d, hn::And(near, hn::And(ahead, before)));
  }
  const V across_x = hn::Sub(center.x, ray.x);
  const V across_y = hn::Sub(center.y, ray.y);
  const V distance2 = hn::MulAdd(across_x, across_x, hn::Mul(across_y, across_y));
  return BitsOfMask(d, hn::And(hn::Le(distance2, radius2), hn::Gt(center.z, ray.z)));
}

// Returns those of `lanes`, as bits, whose rays the sphere occludes; lane 0 is ray `first`.
template <class D>
HWY_INLINE uint32_t LanesOccludedBy(D d, const TraceGeometry& geometry, uint32_t number,
                                    const ShadowRayBatch& rays, size_t first, uint32_t lanes) {
  const TraceSphere& sphere = geometry.spheres[number];
  uint32_t own = 0;
  for (uint32_t left = lanes; left != 0; left &= left - 1) {
    const size_t ray = first + static_cast<size_t>(__builtin_ctz(left));
    const uint32_t start = rays.primitive[ray], lane = left & -left;
    if (start != number && !Coincide(sphere, geometry.spheres[start])) continue;
    // The sphere is in its own cell: rays that leave outward need no test.
    (rays.own_after[ray] == kLeavesOutward ? lanes : own) ^= lane;
  }
  return OccludedBits(d, sphere, rays, first, lanes, own);
}

HWY_INLINE bool IsOccludedBy(const TraceGeometry& geometry, uint32_t number,
                             const ShadowRayBatch& rays, size_t i) {
  return LanesOccludedBy(hn::CappedTag<double, 1>(), geometry, number, rays, i, 1) != 0;
}

// Tests one ray against the spheres of its cell, a vector of spheres at a time.
HWY_INLINE bool OccludedInCell(const TraceGeometry& geometry, const LightBins& bins,
                               const LightSpaceRay& ray, const ShadowRayBatch& rays, size_t i) {
  const hn::CappedTag<float, kMaxPacketWidth> d;
  using V = hn::Vec<decltype(d)>;
  const Vec3V<V> direction{hn::Set(d, ray.x), hn::Set(d, ray.y), hn::Set(d, ray.z)};
  const V length = hn::Set(d, ray.length);
  const uint32_t end = bins.end[ray.cell];
  for (uint32_t k = bins.Begin(ray.cell); k < end; k += static_cast<uint32_t>(hn::Lanes(d))) {
    // The last vector may extend into the next cell, whose spheres may be tested, too.
    Vec3V<V> center;
    V radius;
    hn::LoadInterleaved4(d, &bins.binned[k].x, center.x, center.y, center.z, radius);
    uint32_t bits = MayMeet(d, center, radius, direction, length, bins.positional);
    for (; bits != 0; bits &= bits - 1) {
      const uint32_t number = bins.spheres[k + static_cast<uint32_t>(__builtin_ctz(bits))];
      if (IsOccludedBy(geometry, number, rays, i)) return true;
    }
  }
  return false;
}

// The lanes, as bits, of the rays [first, first + count) that are not known to be occluded.
HWY_INLINE uint32_t OpenLanes(const ShadowRayBatch& rays, size_t first, size_t count) {
  uint32_t open = 0;
  for (size_t lane = 0; lane < count; ++lane) {
    open |= static_cast<uint32_t>(rays.occluded[first + lane] == 0) << lane;
  }
  return open;
}

HWY_INLINE void MarkOccluded(uint32_t lanes, size_t first, ShadowRayBatch* rays) {
  for (; lanes != 0; lanes &= lanes - 1) {
    rays->occluded[first + static_cast<size_t>(__builtin_ctz(lanes))] = 1;
  }
}

HWY_INLINE bool OccludedByAny(const TraceGeometry& geometry, const ShadowRayBatch& rays, size_t i) {
  for (uint32_t number = 0; number < geometry.SphereCount(); ++number) {
    if (IsOccludedBy(geometry, number, rays, i)) return true;
  }
  return false;
}

HWY_INLINE LightSpaceRay ToLightSpace(const LightBins& bins, const ShadowRayBatch& rays, size_t i) {
  const auto made = [](const Vec3d& at, double length, size_t cell) {
    return LightSpaceRay{static_cast<float>(at.x), static_cast<float>(at.y),
                         static_cast<float>(at.z), static_cast<float>(length),
                         static_cast<uint32_t>(cell)};
  };
  const Vec3d origin = VectorAt(rays.origin, i);
  if (!(origin.length2() <= bins.max_distance * bins.max_distance)) {
    return made(Vec3d(0), 0, kNoCell);
  }
  if (bins.positional) {
    const Vec3d from_light = -VectorAt(rays.direction, i);
    const double length = std::sqrt(from_light.length2());
    const CubePoint point = ProjectToCube(from_light);
    return made(from_light / length, length, bins.grids[point.face].Cell(point.x, point.y));
  }
  const Vec3d offset = origin - bins.center;
  const double x = offset.dot(bins.axes[0]), y = offset.dot(bins.axes[1]);
  const double z = offset.dot(bins.axes[2]);
  return made({x, y, z - std::abs(z) * 1e-6}, 0, bins.grids[0].Cell(x, y));
}

// Sets `occluded` where one of these spheres, against which every ray is tested, occludes the ray.
HWY_INLINE void TestEvery(const TraceGeometry& geometry, const std::vector<uint32_t>& spheres,
                          ShadowRayBatch* rays) {
  for (const uint32_t sphere : spheres) {
    for (size_t first = 0; first < rays->count; first += kMaxPacketWidth) {
      const size_t count = std::min<size_t>(kMaxPacketWidth, rays->count - first);
      const uint32_t open = OpenLanes(*rays, first, count);
      MarkOccluded(LanesOccludedBy(hn::ScalableTag<double>(), geometry, sphere, *rays, first, open),
                   first, rays);
    }
  }
}

// Starts fetching the spheres of a ray's cell.
HWY_INLINE void Prefetch(const LightBins& bins, uint32_t cell) {
  if (cell == kNoCell) return;
  const BinnedSphere* const next = bins.binned.data() + bins.Begin(cell);
  constexpr int kLine = 64 / sizeof(BinnedSphere);
  for (int line = 0; line < 4; ++line) __builtin_prefetch(next + line * kLine);
}

void OccludedByBinsT(const TraceGeometry& geometry, const LightBins& bins, ShadowRayBatch* rays) {
  LightSpaceRay local[kBatchCapacity];
  for (size_t i = 0; i < rays->count; ++i) {
    local[i] = ToLightSpace(bins, *rays, i);
    if (local[i].cell != kNoCell) __builtin_prefetch(bins.end.data() + local[i].cell);
  }
  std::fill_n(rays->occluded.data(), rays->count, uint8_t{0});
  TestEvery(geometry, bins.large, rays);
  TestEvery(geometry, bins.changed, rays);
  constexpr size_t kAhead = 4;
  for (size_t i = 0; i < rays->count; ++i) {
    if (i + kAhead < rays->count) Prefetch(bins, local[i + kAhead].cell);
    if (rays->occluded[i] != 0) continue;
    const bool occluded = local[i].cell == kNoCell
                              ? OccludedByAny(geometry, *rays, i)
                              : OccludedInCell(geometry, bins, local[i], *rays, i);
    rays->occluded[i] = occluded ? 1 : 0;
  }
}

}  // namespace
}  // namespace nacre::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace nacre {
HWY_EXPORT(OccludedByBinsT);

void OccludedByBins(const TraceGeometry& geometry, const LightBins& bins, ShadowRayBatch* rays) {
  HWY_DYNAMIC_DISPATCH(OccludedByBinsT)(geometry, bins, rays);
}
}  // namespace nacre
#endif
