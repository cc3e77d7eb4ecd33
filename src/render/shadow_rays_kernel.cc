// SPDX-License-Identifier: Apache-2.0
// render/shadow_rays_kernel.cc: the kernel of shadow_rays_kernel.h.
#include "render/shadow_rays_kernel.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "render/shadow_rays_kernel.cc"
#include "hwy/foreach_target.h"

#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace nacre {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Fills one coordinate of the rays' origins, and of their directions to a light at `light`.
HWY_INLINE void FillCoordinate(const double* HWY_RESTRICT origin, double light,
                               const uint32_t* HWY_RESTRICT from, size_t count,
                               double* HWY_RESTRICT ray_origin, double* HWY_RESTRICT direction) {
  const hn::ScalableTag<double> d;
  const hn::Rebind<int64_t, decltype(d)> di;
  const hn::Rebind<uint32_t, decltype(d)> du;
  const auto place = hn::Set(d, light);
  for (size_t ray = 0; ray < count; ray += hn::Lanes(d)) {
    const auto hit = hn::BitCast(
        di, hn::PromoteTo(hn::RebindToUnsigned<decltype(di)>(), hn::LoadU(du, from + ray)));
    const auto start = hn::GatherIndex(d, origin, hit);
    hn::Store(start, d, ray_origin + ray);
    hn::Store(hn::Sub(place, start), d, direction + ray);
  }
}

void FillShadowRaysT(const ShadingLight& light, const HitBatch& hits, const Soa3<double>& origin,
                     const AlignedArray<uint32_t>& from, ShadowRayBatch* rays) {
  const Vec3d& place = light.position;
  const size_t count = rays->count;
  ShadowRayBatch& r = *rays;
  const uint32_t* const hit = from.data();
  FillCoordinate(origin.x.data(), place.x, hit, count, r.origin.x.data(), r.direction.x.data());
  FillCoordinate(origin.y.data(), place.y, hit, count, r.origin.y.data(), r.direction.y.data());
  FillCoordinate(origin.z.data(), place.z, hit, count, r.origin.z.data(), r.direction.z.data());
  const hn::ScalableTag<double> d;
  const auto t_max = hn::Set(d, light.TMax());
  for (size_t ray = 0; ray < count; ray += hn::Lanes(d)) hn::Store(t_max, d, r.t_max.data() + ray);
  for (size_t ray = 0; ray < count; ++ray) r.primitive[ray] = hits.primitive[hit[ray]];
  if (light.form != LightForm::kDirectional) return;
  const auto x = hn::Set(d, light.to_light.x);
  const auto y = hn::Set(d, light.to_light.y);
  const auto z = hn::Set(d, light.to_light.z);
  for (size_t ray = 0; ray < count; ray += hn::Lanes(d)) {
    hn::Store(x, d, r.direction.x.data() + ray);
    hn::Store(y, d, r.direction.y.data() + ray);
    hn::Store(z, d, r.direction.z.data() + ray);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace nacre
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace nacre {
HWY_EXPORT(FillShadowRaysT);

void FillShadowRays(const ShadingLight& light, const HitBatch& hits, const Soa3<double>& origin,
                    const AlignedArray<uint32_t>& from, ShadowRayBatch* rays) {
  HWY_DYNAMIC_DISPATCH(FillShadowRaysT)(light, hits, origin, from, rays);
}
}  // namespace nacre
#endif
