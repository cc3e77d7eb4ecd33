// SPDX-License-Identifier: Apache-2.0
#include "render/sampled_kernel.h"

#include <cmath>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "render/sampled_kernel.cc"
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
    StoreSoa(d, l, i, &light->to_light);
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

void AddPdfsT(const float* a, const float* b, size_t count, float* sum) {
  const D d;
  const auto at = [&](const float* pdf, size_t i)
                      HWY_ATTR { return pdf != nullptr ? hn::LoadU(d, pdf + i) : hn::Zero(d); };
  for (size_t i = 0; i < count; i += hn::Lanes(d)) {
    hn::StoreU(hn::Add(at(a, i), at(b, i)), d, sum + i);
  }
}

void ComputeWeightsT(const float* irradiance, const float* pdf, size_t count, float* weight) {
  const D d;
  const V zero = hn::Zero(d), one = hn::Set(d, 1.0f);
  for (size_t i = 0; i < count; i += hn::Lanes(d)) {
    const V chosen = hn::LoadU(d, pdf + i);
    const auto counts = hn::And(hn::Gt(hn::LoadU(d, irradiance + i), zero), hn::Gt(chosen, zero));
    const V inverse = hn::Div(one, hn::IfThenElse(counts, chosen, one));
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
HWY_EXPORT(IlluminateAlongT);
HWY_EXPORT(AimShadowRaysT);
HWY_EXPORT(AddPdfsT);
HWY_EXPORT(ComputeWeightsT);
HWY_EXPORT(AddWeightedT);

size_t IlluminateAlong(const LightDirections& directions, const Surface& surface, size_t count,
                       LightBatch* light) {
  return HWY_DYNAMIC_DISPATCH(IlluminateAlongT)(directions, surface, count, light);
}

void AimShadowRays(const LightDirections& directions, const float* irradiance, size_t count,
                   ShadowRayBatch* rays) {
  HWY_DYNAMIC_DISPATCH(AimShadowRaysT)(directions, irradiance, count, rays);
}

void AddPdfs(const float* a, const float* b, size_t count, float* sum) {
  HWY_DYNAMIC_DISPATCH(AddPdfsT)(a, b, count, sum);
}

void ComputeWeights(const float* irradiance, const float* pdf, size_t count, float* weight) {
  HWY_DYNAMIC_DISPATCH(ComputeWeightsT)(irradiance, pdf, count, weight);
}

void AddWeighted(const Soa3<float>& part, const float* weight, const Soa3<float>* radiance,
                 const Rgb& color, size_t count, Soa3<float>* sum) {
  HWY_DYNAMIC_DISPATCH(AddWeightedT)(part, weight, radiance, color, count, sum);
}
}  // namespace nacre
#endif
