// SPDX-License-Identifier: Apache-2.0
// shading/light_at_kernel.cc: lights evaluated at all hits of a batch, and the rounding of the
// hits' directions to float.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "shading/light_at_kernel.cc"
#include "hwy/foreach_target.h"

#include "hwy/highway.h"

#include "shading/light_at-inl.h"
#include "shading/soa-inl.h"

HWY_BEFORE_NAMESPACE();
namespace nacre {
namespace HWY_NAMESPACE {

// to[i] = from[i] for the batch's padded length.
void RoundArray(const AlignedArray<double>& from, size_t count, AlignedArray<float>* to) {
  const hn::ScalableTag<double> dd;
  const hn::Rebind<float, decltype(dd)> df;
  for (size_t i = 0; i < count; i += hn::Lanes(dd)) {
    hn::StoreU(hn::DemoteTo(df, hn::LoadU(dd, from.data() + i)), df, to->data() + i);
  }
}

void RoundArray3(const Soa3<double>& from, size_t count, Soa3<float>* to) {
  RoundArray(from.x, count, &to->x);
  RoundArray(from.y, count, &to->y);
  RoundArray(from.z, count, &to->z);
}

void PrepareSurfaceT(const HitBatch& hits, Surface* surface) {
  RoundArray3(hits.normal, hits.count, &surface->normal);
  RoundArray3(hits.to_view, hits.count, &surface->to_view);
}

// Calls at(i) for each packet of hits and stores the LightV that it returns.
template <class At>
HWY_INLINE void ForEachPacket(const HitBatch& hits, const Surface& surface, LightBatch* result,
                              const At& at) {
  const FloatTag d;
  // Normal-mapped hits get light from above the unmapped surface.
  const Soa3<float>& n = HorizonNormal(surface);
  for (size_t i = 0; i < hits.count; i += hn::Lanes(d)) {
    const LightV light = at(i);
    const FloatV n_dot_l = light.toward.Dot(LoadSoa(d, n, i));
    // No model reflects light from below the surface, so no shadow ray need be traced to it.
    const FloatV irradiance = hn::IfThenElseZero(hn::Gt(n_dot_l, hn::Zero(d)), light.irradiance);
    StoreSoa(d, light.toward.offset, i, &result->light_vector);
    hn::StoreU(light.toward.inverse_length, d, result->inverse_length.data() + i);
    hn::StoreU(irradiance, d, result->irradiance.data() + i);
  }
}

template <LightForm kForm>
void EvaluatePositional(const ShadingLight& light, const HitBatch& hits, const Surface& surface,
                        LightBatch* result) {
  const FloatTag d;
  const Soa3<float>& n = HorizonNormal(surface);
  VisitOffsets(d, light, hits, [&](const auto& offset) HWY_ATTR {
    ForEachPacket(hits, surface, result, [&](size_t i) HWY_ATTR {
      LightV at = PositionalAt<kForm>(d, light, offset(d, i, LoadSoa(d, n, i)));
      if constexpr (kForm == LightForm::kSpot) {
        at.irradiance = hn::Mul(at.irradiance, SpotFactorAt(d, light, hits, i));
      }
      return at;
    });
  });
}

void EvaluateLightT(const ShadingLight& light, const HitBatch& hits, const Surface& surface,
                    LightBatch* result) {
  switch (light.form) {
    case LightForm::kDirectional:
      return ForEachPacket(hits, surface, result,
                           [&](size_t) HWY_ATTR { return DirectionalAt(FloatTag(), light); });
    case LightForm::kInverseSquare:
      return EvaluatePositional<LightForm::kInverseSquare>(light, hits, surface, result);
    case LightForm::kPoint:
      return EvaluatePositional<LightForm::kPoint>(light, hits, surface, result);
    case LightForm::kSpot:
      return EvaluatePositional<LightForm::kSpot>(light, hits, surface, result);
    case LightForm::kGiven:
      return;
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace nacre
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace nacre {
HWY_EXPORT(PrepareSurfaceT);
HWY_EXPORT(EvaluateLightT);

void PrepareSurface(const HitBatch& hits, Surface* surface) {
  HWY_DYNAMIC_DISPATCH(PrepareSurfaceT)(hits, surface);
}

void EvaluateLight(const ShadingLight& light, const HitBatch& hits, const Surface& surface,
                   LightBatch* result) {
  HWY_DYNAMIC_DISPATCH(EvaluateLightT)(light, hits, surface, result);
}
}  // namespace nacre
#endif
