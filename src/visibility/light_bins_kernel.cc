// SPDX-License-Identifier: Apache-2.0
// visibility/light_bins_kernel.cc: tests shadow rays against the spheres of their cells. A
// conservative float test of a vector of spheres proposes candidates, and the exact test in double
// decides.
#include <algorithm>

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

// A batch's rays in float, in the coordinates of BinnedSphere, and their cells.
struct LightSpaceRays {
  static constexpr size_t kSize = kBatchCapacity + kMaxPacketWidth;
  // For a directional light, the origins, z rounded down; for a positional light, the unit
  // directions from the light.
  alignas(64) float x[kSize], y[kSize], z[kSize];
  alignas(64) float length[kSize];   // positional: the distance from the light to the origin
  alignas(64) uint32_t cell[kSize];  // kNoCell: beyond LightBins::max_distance
};

// The conservative test of one ray against a vector of spheres, or of a vector of rays against one
// sphere. The spheres' radii cover the rounding errors here.
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
    const int lane = __builtin_ctz(left);
    const uint32_t start = rays.primitive[first + static_cast<size_t>(lane)];
    own |= static_cast<uint32_t>(start == number || Coincide(sphere, geometry.spheres[start]))
           << lane;
  }
  if (rays.outward) lanes &= ~own;
  return OccludedBits(d, sphere, rays, first, lanes, own);
}

HWY_INLINE bool IsOccludedBy(const TraceGeometry& geometry, uint32_t number,
                             const ShadowRayBatch& rays, size_t i) {
  return LanesOccludedBy(hn::CappedTag<double, 1>(), geometry, number, rays, i, 1) != 0;
}

// Tests one ray against the spheres of its cell, a vector of spheres at a time.
HWY_INLINE bool OccludedInCell(const TraceGeometry& geometry, const LightBins& bins,
                               const LightSpaceRays& local, const ShadowRayBatch& rays, size_t i) {
  const hn::CappedTag<float, kMaxPacketWidth> d;
  using V = hn::Vec<decltype(d)>;
  const Vec3V<V> direction{hn::Set(d, local.x[i]), hn::Set(d, local.y[i]), hn::Set(d, local.z[i])};
  const V length = hn::Set(d, local.length[i]);
  const uint32_t end = bins.end[local.cell[i]];
  for (uint32_t k = bins.Begin(local.cell[i]); k < end; k += static_cast<uint32_t>(hn::Lanes(d))) {
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

// Tests rays [begin, end), which share a cell, against its spheres, a vector of rays at a time.
HWY_INLINE void TestRun(const TraceGeometry& geometry, const LightBins& bins,
                        const LightSpaceRays& local, size_t begin, size_t end,
                        ShadowRayBatch* rays) {
  const hn::CappedTag<float, kMaxPacketWidth> d;
  using V = hn::Vec<decltype(d)>;
  const uint32_t cell = local.cell[begin];
  const size_t step = hn::Lanes(d);
  for (size_t first = begin; first < end; first += step) {
    const uint32_t tested = OpenLanes(*rays, first, std::min(step, end - first));
    uint32_t left = tested;
    const Vec3V<V> direction = LoadU3(d, local.x + first, local.y + first, local.z + first);
    const V length = hn::LoadU(d, local.length + first);
    for (uint32_t k = bins.Begin(cell); k < bins.end[cell] && left != 0; ++k) {
      const BinnedSphere& sphere = bins.binned[k];
      const Vec3V<V> center{hn::Set(d, sphere.x), hn::Set(d, sphere.y), hn::Set(d, sphere.z)};
      const uint32_t bits =
          left & MayMeet(d, center, hn::Set(d, sphere.radius), direction, length, bins.positional);
      if (bits == 0) continue;
      left &= ~LanesOccludedBy(hn::ScalableTag<double>(), geometry, bins.spheres[k], *rays, first,
                               bits);
    }
    MarkOccluded(tested & ~left, first, rays);
  }
}

HWY_INLINE bool OccludedByAny(const TraceGeometry& geometry, const ShadowRayBatch& rays, size_t i) {
  for (uint32_t number = 0; number < geometry.SphereCount(); ++number) {
    if (IsOccludedBy(geometry, number, rays, i)) return true;
  }
  return false;
}

using RayTag = hn::ScalableTag<double>;
using RayV = hn::Vec<RayTag>;

HWY_INLINE void StoreRounded(RayV v, float* to) {
  const hn::Rebind<float, RayTag> df;
  hn::StoreU(hn::DemoteTo(df, v), df, to);
}

// LightGrid::Cell on vectors.
HWY_INLINE void StoreCells(const LightGrid& grid, RayV x, RayV y, uint32_t* cells) {
  const RayTag d;
  const hn::Rebind<int32_t, RayTag> di;
  const auto clamped = [&](RayV position, double begin, int count) HWY_ATTR {
    const RayV at = hn::Mul(hn::Sub(position, hn::Set(d, begin)), hn::Set(d, grid.inverse_cell));
    return hn::DemoteTo(di, hn::Min(hn::Max(at, hn::Zero(d)), hn::Set(d, count - 0.5)));
  };
  const auto column = clamped(x, grid.x0, grid.columns);
  const auto row = clamped(y, grid.y0, grid.rows);
  const auto block_columns = hn::Set(di, static_cast<int32_t>(grid.BlockColumns()));
  const auto first = hn::Set(di, static_cast<int32_t>(grid.first_block));
  const auto in_block = hn::Set(di, kBlockSize - 1);
  const auto block_row = hn::Mul(hn::ShiftRight<kBlockBits>(row), block_columns);
  const auto block = hn::Add(first, hn::Add(block_row, hn::ShiftRight<kBlockBits>(column)));
  const auto cell_row = hn::Add(hn::ShiftLeft<kBlockBits>(block), hn::And(row, in_block));
  const auto cell = hn::Add(hn::ShiftLeft<kBlockBits>(cell_row), hn::And(column, in_block));
  hn::StoreU(cell, di, reinterpret_cast<int32_t*>(cells));
}

// Transforms a vector of rays to a directional light, from ray i on.
HWY_INLINE void ToDirectionalLightSpace(const LightBins& bins, const ShadowRayBatch& rays, size_t i,
                                        LightSpaceRays* local) {
  const RayTag d;
  const Vec3V<RayV> origin =
      Load3(d, rays.origin.x.data() + i, rays.origin.y.data() + i, rays.origin.z.data() + i);
  const Vec3V<RayV> offset = Sub(origin, SetVec3(d, bins.center));
  const RayV x = Dot(offset, SetVec3(d, bins.axes[0]));
  const RayV y = Dot(offset, SetVec3(d, bins.axes[1]));
  const RayV z = Dot(offset, SetVec3(d, bins.axes[2]));
  StoreCells(bins.grids[0], x, y, local->cell + i);
  StoreRounded(x, local->x + i);
  StoreRounded(y, local->y + i);
  StoreRounded(hn::Sub(z, hn::Mul(hn::Abs(z), hn::Set(d, 1e-6))), local->z + i);
}

// Transforms a vector of rays to a positional light, from ray i on.
HWY_INLINE void ToPointLightSpace(const LightBins& bins, const ShadowRayBatch& rays, size_t i,
                                  LightSpaceRays* local) {
  const RayTag d;
  const RayV zero = hn::Zero(d);
  const RayV one = hn::Set(d, 1.0);
  const Vec3V<RayV> to_light = Load3(d, rays.direction.x.data() + i, rays.direction.y.data() + i,
                                     rays.direction.z.data() + i);
  const Vec3V<RayV> from_light = Sub(Vec3V<RayV>{zero, zero, zero}, to_light);
  const RayV length = hn::Sqrt(Dot(from_light, from_light));
  const Vec3V<RayV> unit = Scale(from_light, hn::Div(one, length));
  StoreRounded(unit.x, local->x + i);
  StoreRounded(unit.y, local->y + i);
  StoreRounded(unit.z, local->z + i);
  StoreRounded(length, local->length + i);
  // ProjectToCube on vectors.
  const Vec3V<RayV> size{hn::Abs(unit.x), hn::Abs(unit.y), hn::Abs(unit.z)};
  const auto on_x = hn::And(hn::Ge(size.x, size.y), hn::Ge(size.x, size.z));
  const auto on_y = hn::AndNot(on_x, hn::Ge(size.y, size.z));
  const auto choose = [&](RayV x, RayV y, RayV z)
                          HWY_ATTR { return hn::IfThenElse(on_x, x, hn::IfThenElse(on_y, y, z)); };
  const RayV main = choose(unit.x, unit.y, unit.z);
  const RayV face = hn::Add(choose(zero, hn::Set(d, 2.0), hn::Set(d, 4.0)),
                            hn::IfThenElseZero(hn::Lt(main, zero), one));
  const auto first_face = static_cast<size_t>(hn::GetLane(face));
  if (hn::AllTrue(d, hn::Eq(face, hn::Set(d, static_cast<double>(first_face))))) {
    const RayV inverse = hn::Div(one, hn::Abs(main));
    StoreCells(bins.grids[first_face], hn::Mul(choose(unit.y, unit.z, unit.x), inverse),
               hn::Mul(choose(unit.z, unit.x, unit.y), inverse), local->cell + i);
    return;
  }
  for (size_t k = i; k < i + hn::Lanes(d); ++k) {
    const CubePoint point =
        ProjectToCube({-rays.direction.x[k], -rays.direction.y[k], -rays.direction.z[k]});
    local->cell[k] = static_cast<uint32_t>(bins.grids[point.face].Cell(point.x, point.y));
  }
}

HWY_INLINE void ToLightSpace(const LightBins& bins, const ShadowRayBatch& rays,
                             LightSpaceRays* local) {
  for (size_t i = 0; i < rays.count; i += hn::Lanes(RayTag())) {
    bins.positional ? ToPointLightSpace(bins, rays, i, local)
                    : ToDirectionalLightSpace(bins, rays, i, local);
  }
  const double max_distance2 = bins.max_distance * bins.max_distance;
  const AlignedArray<double>&x = rays.origin.x, &y = rays.origin.y, &z = rays.origin.z;
  for (size_t i = 0; i < rays.count; ++i) {
    __builtin_prefetch(bins.end.data() + local->cell[i]);
    const bool within = x[i] * x[i] + y[i] * y[i] + z[i] * z[i] <= max_distance2;
    local->cell[i] = within ? local->cell[i] : kNoCell;
  }
}

// Sets `occluded` to whether a large sphere occludes the ray.
HWY_INLINE void TestLarge(const TraceGeometry& geometry, const LightBins& bins,
                          ShadowRayBatch* rays) {
  const hn::ScalableTag<double> d;
  const size_t step = hn::Lanes(d);
  const std::vector<uint32_t>& large = bins.large;
  if (large.empty()) {
    std::fill_n(rays->occluded.data(), rays->count, uint8_t{0});
    return;
  }
  StartSpheres starts{};  // the spheres that the rays start on
  for (size_t first = 0; first < rays->count; first += step) {
    const size_t count = std::min(step, rays->count - first);
    for (size_t lane = 0; lane < count; ++lane) {
      const uint32_t start = rays->primitive[first + lane];
      starts.Set(lane, start < geometry.SphereCount() ? geometry.spheres[start] : kNoSphere);
    }
    const auto load = [&]() HWY_ATTR { return LoadShadowRays(d, *rays, first); };
    const auto loaded = load();
    uint32_t left = (1u << count) - 1;
    for (size_t i = 0; i < large.size() && left != 0; ++i) {
      const TraceSphere& sphere = geometry.spheres[large[i]];
      left &= ~BitsOfMask(d, OccludedLanes(d, sphere, loaded, MaskOfBits(d, left, 0),
                                           StartsOn(d, starts, 0, sphere), rays->outward, load));
    }
    StoreOccluded(~left, first, count, rays);
  }
}

// Sets `occluded` where a sphere that has changed occludes the ray.
HWY_INLINE void TestChanged(const TraceGeometry& geometry, const LightBins& bins,
                            ShadowRayBatch* rays) {
  for (const uint32_t sphere : bins.changed) {
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
  LightSpaceRays local;
  ToLightSpace(bins, *rays, &local);
  TestLarge(geometry, bins, rays);
  TestChanged(geometry, bins, rays);
  constexpr size_t kAhead = 4;
  constexpr size_t kRun = 6;  // runs at least as long are tested as vectors of rays
  for (size_t i = 0, end = 0; i < rays->count; i = end) {
    const uint32_t cell = local.cell[i];
    for (end = i + 1; end < rays->count && local.cell[end] == cell;) ++end;
    if (end + kAhead <= rays->count) Prefetch(bins, local.cell[end + kAhead - 1]);
    if (cell != kNoCell && end - i >= kRun) {
      TestRun(geometry, bins, local, i, end, rays);
      continue;
    }
    for (size_t k = i; k < end; ++k) {
      if (rays->occluded[k] != 0) continue;
      const bool occluded = cell == kNoCell ? OccludedByAny(geometry, *rays, k)
                                            : OccludedInCell(geometry, bins, local, *rays, k);
      rays->occluded[k] = occluded ? 1 : 0;
    }
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
