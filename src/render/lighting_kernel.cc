// SPDX-License-Identifier: Apache-2.0
#include "render/lighting_kernel.h"

#include <cmath>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "render/lighting_kernel.cc"
#include "hwy/foreach_target.h"

#include "shading/soa-inl.h"

HWY_BEFORE_NAMESPACE();
namespace nacre {
namespace HWY_NAMESPACE {
namespace {
namespace hn = hwy::HWY_NAMESPACE;

using D = hn::ScalableTag<float>;
using V = hn::Vec<D>;
using DD = hn::ScalableTag<double>;

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

size_t IlluminateAlongT(const LightDirections& directions, const Surface& surface, size_t count,
                        LightBatch* light) {
  const D d;
  const V zero = hn::Zero(d), lowest = hn::Set(d, LowestHeight(surface));
  const Soa3<float>& horizon = HorizonNormal(surface);
  size_t not_finite = 0;
  for (size_t i = 0; i < count; i += hn::Lanes(d)) {
    const Vec3V<V> l = LoadSoa(d, directions.to_light, i);
    // Finite if and only if the direction is.
    const V height = Dot(LoadSoa(d, horizon, i), l);
    const auto finite = hn::IsFinite(height);
    if (!hn::AllTrue(d, finite)) {
      not_finite += hn::CountTrue(d, hn::AndNot(finite, hn::FirstN(d, count - i)));
    }
    const auto faces = hn::And(hn::Gt(height, lowest), finite);
    const auto shines = hn::And(hn::Gt(hn::LoadU(d, directions.distance.data() + i), zero), faces);
    StoreSoa(d, l, i, &light->light_vector);
    hn::StoreU(hn::IfThenElseZero(shines, hn::Set(d, 1.0f)), d, light->irradiance.data() + i);
  }
  return not_finite;
}

HWY_INLINE void StorePromoted(hn::Vec<hn::Rebind<float, DD>> v, double* to) {
  hn::StoreU(hn::PromoteTo(DD(), v), DD(), to);
}

void AimShadowRaysT(const LightDirections& directions, const float* irradiance, size_t count,
                    ShadowRayBatch* rays) {
  const hn::Rebind<float, DD> d;
  const Soa3<float>& l = directions.to_light;
  const auto zero = hn::Zero(d), one = hn::Set(d, 1.0f);
  for (size_t i = 0; i < count; i += hn::Lanes(d)) {
    const auto lit = hn::Gt(hn::LoadU(d, irradiance + i), zero);
    // Inactive rays get a dummy direction: their own may not be finite.
    const auto aim = [&](const AlignedArray<float>& from, auto dummy, AlignedArray<double>* to)
                         HWY_ATTR {
                           const auto toward = hn::LoadU(d, from.data() + i);
                           StorePromoted(hn::IfThenElse(lit, toward, dummy), to->data() + i);
                         };
    aim(l.x, zero, &rays->direction.x);
    aim(l.y, zero, &rays->direction.y);
    aim(l.z, one, &rays->direction.z);
    const auto end = hn::IfThenElseZero(lit, hn::LoadU(d, directions.distance.data() + i));
    StorePromoted(end, rays->t_max.data() + i);
  }
}

void ComputeWeightsT(const float* irradiance, const float* a, const float* b, size_t count,
                     float* weight) {
  const D d;
  const V zero = hn::Zero(d), one = hn::Set(d, 1.0f);
  const auto at = [&](const float* pdf, size_t i)
                      HWY_ATTR { return pdf != nullptr ? hn::LoadU(d, pdf + i) : zero; };
  for (size_t i = 0; i < count; i += hn::Lanes(d)) {
    const V pdf = hn::Add(at(a, i), at(b, i));
    const auto counts = hn::And(hn::Gt(hn::LoadU(d, irradiance + i), zero), hn::Gt(pdf, zero));
    const V inverse = hn::Div(one, hn::IfThenElse(counts, pdf, one));
    hn::StoreU(hn::IfThenElseZero(counts, inverse), d, weight + i);
  }
}

// `radiance` may be null.
HWY_INLINE void AddChannel(const float* part, const float* weight, const float* radiance,
                           double color, size_t count, float* sum) {
  const D d;
  const V scale = hn::Set(d, static_cast<float>(color));
  for (size_t i = 0; i < count; i += hn::Lanes(d)) {
    const V weighed = hn::Mul(hn::LoadU(d, part + i), hn::LoadU(d, weight + i));
    const V seen = radiance != nullptr ? hn::Mul(hn::LoadU(d, radiance + i), scale) : scale;
    hn::StoreU(hn::Add(hn::LoadU(d, sum + i), hn::Mul(weighed, seen)), d, sum + i);
  }
}

void AddWeightedT(const Soa3<float>& part, const float* weight, const Soa3<float>* radiance,
                  const Rgb& color, size_t count, Soa3<float>* sum) {
  const auto of = [&](AlignedArray<float> Soa3<float>::*channel) {
    return radiance != nullptr ? (radiance->*channel).data() : nullptr;
  };
  AddChannel(part.x.data(), weight, of(&Soa3<float>::x), color.x, count, sum->x.data());
  AddChannel(part.y.data(), weight, of(&Soa3<float>::y), color.y, count, sum->y.data());
  AddChannel(part.z.data(), weight, of(&Soa3<float>::z), color.z, count, sum->z.data());
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace nacre
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace nacre {
HWY_EXPORT(FillShadowRaysT);
HWY_EXPORT(IlluminateAlongT);
HWY_EXPORT(AimShadowRaysT);
HWY_EXPORT(ComputeWeightsT);
HWY_EXPORT(AddWeightedT);

void FillShadowRays(const ShadingLight& light, const HitBatch& hits, const Soa3<double>& origin,
                    const AlignedArray<uint32_t>& from, ShadowRayBatch* rays) {
  HWY_DYNAMIC_DISPATCH(FillShadowRaysT)(light, hits, origin, from, rays);
}

size_t IlluminateAlong(const LightDirections& directions, const Surface& surface, size_t count,
                       LightBatch* light) {
  return HWY_DYNAMIC_DISPATCH(IlluminateAlongT)(directions, surface, count, light);
}

void AimShadowRays(const LightDirections& directions, const float* irradiance, size_t count,
                   ShadowRayBatch* rays) {
  HWY_DYNAMIC_DISPATCH(AimShadowRaysT)(directions, irradiance, count, rays);
}

void ComputeWeights(const float* irradiance, const float* a, const float* b, size_t count,
                    float* weight) {
  HWY_DYNAMIC_DISPATCH(ComputeWeightsT)(irradiance, a, b, count, weight);
}

void AddWeighted(const Soa3<float>& part, const float* weight, const Soa3<float>* radiance,
                 const Rgb& color, size_t count, Soa3<float>* sum) {
  HWY_DYNAMIC_DISPATCH(AddWeightedT)(part, weight, radiance, color, count, sum);
}
}  // namespace nacre
#endif
