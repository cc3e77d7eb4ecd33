// visibility/light_bins_kernel.cc: each shadow ray against the spheres of its cell, a vector of
// them at a time, in float; the double test decides those that it proposes.
#include <algorithm>

#include "visibility/light_bins.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "visibility/light_bins_kernel.cc"
#include "hwy/foreach_target.h"

#include "visibility/occlusion-inl.h"
#include "visibility/packet-inl.h"
#include "visibility/sphere_test.h"

HWY_BEFORE_NAMESPACE();
namespace nacre {
namespace HWY_NAMESPACE {
namespace {
namespace hn = hwy::HWY_NAMESPACE;

constexpr uint32_t kNoCell = 0xffffffffu;

// One shadow ray of a batch.
struct OneRay {
  Vec3d origin, direction;
  double t_max;
  uint32_t start;
  bool outward;
};

HWY_INLINE OneRay RayAt(const ShadowRayBatch& rays, size_t i) {
  return {{rays.origin.x[i], rays.origin.y[i], rays.origin.z[i]},
          {rays.direction.x[i], rays.direction.y[i], rays.direction.z[i]},
          rays.t_max[i],
          rays.primitive[i],
          rays.outward};
}

// InTheWay's scalar twin.
HWY_INLINE bool IsInTheWay(const TraceGeometry& geometry, uint32_t number, const OneRay& ray) {
  if (ray.outward && number == ray.start) return false;
  const TraceSphere& sphere = geometry.spheres[number];
  const auto hit = nacre::TestSphere(sphere.center - ray.origin, ray.direction, sphere.radius);
  if (number == ray.start || Coincide(sphere, geometry.spheres[ray.start])) {
    const double t = hit.closest + hit.closest;
    return !ray.outward && t > 0 && t < ray.t_max;
  }
  return hit.hit && hit.t < ray.t_max;
}

// A ray as the float test has it, in the coordinates of BinnedSphere.
struct BinnedRay {
  float x, y, z;  // directional: where it starts, z rounded down; else its direction, unit, from
                  // the light
  float length;   // of that to where it starts
};

HWY_INLINE BinnedRay PlaceRay(const LightBins& bins, const OneRay& ray) {
  if (bins.positional) {
    const double length = ray.direction.length();
    const Vec3d unit = ray.direction * (-1 / length);
    return {static_cast<float>(unit.x), static_cast<float>(unit.y), static_cast<float>(unit.z),
            static_cast<float>(length)};
  }
  const Vec3d offset = ray.origin - bins.center;
  const double z = offset.dot(bins.axes[2]);
  return {static_cast<float>(offset.dot(bins.axes[0])),
          static_cast<float>(offset.dot(bins.axes[1])), static_cast<float>(z - 1e-6 * std::abs(z)),
          0};
}

// The spheres of a vector that the ray may meet, as bits. Their radii cover the roundings here.
template <class D>
HWY_INLINE uint32_t MayMeet(D d, const BinnedSphere* spheres, const BinnedRay& ray,
                            bool positional) {
  using V = hn::Vec<D>;
  V x, y, z, radius;
  hn::LoadInterleaved4(d, &spheres->x, x, y, z, radius);
  const V radius2 = hn::Mul(radius, radius);
  if (positional) {
    const Vec3V<V> center{x, y, z};
    const Vec3V<V> direction{hn::Set(d, ray.x), hn::Set(d, ray.y), hn::Set(d, ray.z)};
    const V closest = FusedDot(center, direction);
    const Vec3V<V> across = Sub(center, Scale(direction, closest));
    const auto near = hn::Le(FusedDot(across, across), radius2);
    const auto ahead = hn::Gt(hn::Add(closest, radius), hn::Zero(d));
    const auto before = hn::Lt(hn::Sub(closest, radius), hn::Set(d, ray.length));
    return BitsOfMask(d, hn::And(near, hn::And(ahead, before)));
  }
  const V across_x = hn::Sub(x, hn::Set(d, ray.x));
  const V across_y = hn::Sub(y, hn::Set(d, ray.y));
  const V distance2 = hn::MulAdd(across_x, across_x, hn::Mul(across_y, across_y));
  return BitsOfMask(d, hn::And(hn::Le(distance2, radius2), hn::Gt(z, hn::Set(d, ray.z))));
}

HWY_INLINE bool OccludedInCell(const TraceGeometry& geometry, const LightBins& bins, uint32_t cell,
                               const OneRay& ray) {
  const hn::CappedTag<float, kMaxPacketWidth> d;
  const BinnedRay placed = PlaceRay(bins, ray);
  const uint32_t end = bins.end[cell];
  for (uint32_t i = bins.Begin(cell); i < end; i += static_cast<uint32_t>(hn::Lanes(d))) {
    // The last vector goes on into the next cell: its spheres are as good as any.
    uint32_t bits = MayMeet(d, bins.binned.data() + i, placed, bins.positional);
    for (; bits != 0; bits &= bits - 1) {
      const uint32_t number = bins.spheres[i + static_cast<uint32_t>(__builtin_ctz(bits))];
      if (IsInTheWay(geometry, number, ray)) return true;
    }
  }
  return false;
}

HWY_INLINE bool OccludedByAny(const TraceGeometry& geometry, const OneRay& ray) {
  for (uint32_t i = 0; i < geometry.SphereCount(); ++i) {
    if (IsInTheWay(geometry, i, ray)) return true;
  }
  return false;
}

// The cells of rays; kNoCell for those beyond the bins' reach. Starts fetching what comes next.
HWY_INLINE void FindCells(const LightBins& bins, const ShadowRayBatch& rays, uint32_t* cells) {
  for (size_t i = 0; i < rays.count; ++i) {
    const OneRay ray = RayAt(rays, i);
    size_t cell = 0;
    if (bins.positional) {
      const FacePlace place = PlaceOnCube(-ray.direction);
      cell = bins.grids[place.face].Cell(place.x, place.y);
    } else {
      const Vec3d offset = ray.origin - bins.center;
      cell = bins.grids[0].Cell(offset.dot(bins.axes[0]), offset.dot(bins.axes[1]));
    }
    __builtin_prefetch(bins.end.data() + cell);
    const bool within = ray.origin.length2() <= bins.max_reach * bins.max_reach;
    cells[i] = within ? static_cast<uint32_t>(cell) : kNoCell;
  }
}

// Sets `occluded` for the rays that the large spheres are in the way of, and only for these.
HWY_INLINE void TestLarge(const TraceGeometry& geometry, const LightBins& bins,
                          ShadowRayBatch* rays) {
  const hn::ScalableTag<double> d;
  const size_t step = hn::Lanes(d);
  const std::vector<uint32_t>& large = bins.large;
  const auto twin_of = [&](uint32_t sphere) {
    const auto found = std::lower_bound(large.begin(), large.end(), sphere);
    const bool is_large = found != large.end() && *found == sphere;
    return is_large ? bins.large_twin[static_cast<size_t>(found - large.begin())] : kNoPrimitive;
  };
  for (size_t first = 0; first < rays->count; first += step) {
    const size_t count = std::min(step, rays->count - first);
    uint32_t twins[kMaxPacketWidth];
    for (size_t lane = 0; lane < count; ++lane)
      twins[lane] = twin_of(rays->primitive[first + lane]);
    const auto loaded = LoadShadowRays(d, *rays, first);
    uint32_t left = (1u << count) - 1;
    for (size_t i = 0; i < large.size() && left != 0; ++i) {
      uint32_t own = 0;
      for (size_t lane = 0; lane < count; ++lane) {
        own |= static_cast<uint32_t>(twins[lane] == bins.large_twin[i]) << lane;
      }
      left &= ~BitsOfMask(
          d, OccludedLanes(d, geometry.spheres[large[i]], loaded, MaskOfBits(d, left, 0),
                           MaskOfBits(d, own, 0), rays->outward));
    }
    for (size_t lane = 0; lane < count; ++lane) {
      rays->occluded[first + lane] = static_cast<uint8_t>(~(left >> lane) & 1);
    }
  }
}

void OccludedByBinsT(const TraceGeometry& geometry, const LightBins& bins, ShadowRayBatch* rays) {
  uint32_t cells[kBatchCapacity];
  FindCells(bins, *rays, cells);
  TestLarge(geometry, bins, rays);
  constexpr size_t kAhead = 4;
  for (size_t i = 0; i < rays->count; ++i) {
    if (i + kAhead < rays->count && cells[i + kAhead] != kNoCell) {
      const BinnedSphere* next = bins.binned.data() + bins.Begin(cells[i + kAhead]);
      __builtin_prefetch(next);
      __builtin_prefetch(next + 4);
      __builtin_prefetch(next + 8);
      __builtin_prefetch(next + 12);
    }
    if (rays->occluded[i] != 0) continue;
    const OneRay ray = RayAt(*rays, i);
    const bool occluded = cells[i] == kNoCell ? OccludedByAny(geometry, ray)
                                              : OccludedInCell(geometry, bins, cells[i], ray);
    rays->occluded[i] = occluded ? 1 : 0;
  }
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace nacre
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace nacre {
HWY_EXPORT(OccludedByBinsT);

void OccludedByBins(const TraceGeometry& geometry, const LightBins& bins, ShadowRayBatch* rays) {
  HWY_DYNAMIC_DISPATCH(OccludedByBinsT)(geometry, bins, rays);
}
}  // namespace nacre
#endif
