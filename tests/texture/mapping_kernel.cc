// SPDX-License-Identifier: Apache-2.0
// tests/texture/mapping_kernel.cc: the loop behind mapping_kernel.h.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "texture/mapping_kernel.cc"
#include "hwy/foreach_target.h"

#include "hwy/highway.h"

#include "texture/mapping-inl.h"
#include "texture/mapping_kernel.h"

HWY_BEFORE_NAMESPACE();
namespace nacre {
namespace HWY_NAMESPACE {

void MapPointsT(MappingKind kind, const std::vector<Vec3d>& points,
                std::vector<Mapped<double>>* mapped) {
  const hn::ScalableTag<double> d;
  using V = hn::Vec<decltype(d)>;
  const auto component = [&](double x) HWY_ATTR { return hn::Set(d, x); };
  const auto get = [](V v) HWY_ATTR { return hn::GetLane(v); };
  for (const Vec3d& p : points) {
    const MappedV<V> m =
        MapPoint(d, kind, Vec3V<V>{component(p.x), component(p.y), component(p.z)});
    mapped->push_back({get(m.u),
                       get(m.v),
                       {get(m.du.x), get(m.du.y), get(m.du.z)},
                       {get(m.dv.x), get(m.dv.y), get(m.dv.z)}});
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace nacre
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace nacre {
HWY_EXPORT(MapPointsT);
std::vector<Mapped<double>> MapPoints(MappingKind kind, const std::vector<Vec3d>& points) {
  std::vector<Mapped<double>> mapped;
  HWY_DYNAMIC_DISPATCH(MapPointsT)(kind, points, &mapped);
  return mapped;
}
}  // namespace nacre
#endif
