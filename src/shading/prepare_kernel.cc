// SPDX-License-Identifier: Apache-2.0
// shading/prepare_kernel.cc: what microfacet materials need of a hit whatever the light: the
// weight of multiple scattering and the base's share of the light, once per hit.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "shading/prepare_kernel.cc"
#include "hwy/foreach_target.h"

#include "hwy/highway.h"

#include "shading/microfacet_albedo-inl.h"
#include "shading/textures.h"

HWY_BEFORE_NAMESPACE();
namespace nacre {
namespace HWY_NAMESPACE {

// Stores the lanes of `mask`: a packet may reach into the next run.
HWY_INLINE void StoreMasked(FloatTag d, hn::Mask<FloatTag> mask, FloatV value, float* to) {
  hn::StoreU(hn::IfThenElse(mask, value, hn::LoadU(d, to)), d, to);
}

// Kulla and Conty's weight carries the scale of their lobe: 1 / (pi (1 - E_avg)) of a smooth
// surface times a light would leave float's range before the small losses bring it back.
HWY_INLINE FloatV Multiple(FloatTag d, Compensation compensation, const AlbedoV& albedo,
                           FloatV scale) {
  switch (compensation) {
    case Compensation::kTurquin:
      return hn::Mul(albedo.loss, Reciprocal(d, albedo.one));
    case Compensation::kKullaConty:
      return hn::Mul(albedo.loss, scale);
    case Compensation::kNone:
      break;
  }
  return hn::Zero(d);
}

// A model's numbers for all hits.
struct SameForAll {
  const MicrofacetModel& model;
  HWY_INLINE AlbedoV Albedo(FloatTag d, size_t, FloatV n_dot_v) const {
    return EvaluateAlbedo(d, model, hn::Set(d, static_cast<float>(model.f90)), n_dot_v);
  }
  HWY_INLINE FloatV MultipleScale(FloatTag d, size_t) const {
    return hn::Set(d, static_cast<float>(model.multiple));
  }
  HWY_INLINE FloatV F0(FloatTag d, size_t, int c) const {
    return hn::Set(d, static_cast<float>(model.f0[c]));
  }
  HWY_INLINE FloatV FMultiple(FloatTag d, size_t, int c) const {
    return hn::Set(d, static_cast<float>(model.f_multiple[c]));
  }
};

// Those that maps give to each hit.
struct ByHit {
  const MicrofacetModel& model;
  const HitTextures& t;
  bool own_fits;
  HWY_INLINE AlbedoV Albedo(FloatTag d, size_t i, FloatV n_dot_v) const {
    const FloatV f90 = hn::LoadU(d, t.f90.data() + i);
    if (!own_fits) return EvaluateAlbedo(d, model, f90, n_dot_v);
    return EvaluateAlbedo(
        d, model, FitAt(t.fit.data() + i, HitTextures::kFitStride, model.shadowing), f90, n_dot_v);
  }
  HWY_INLINE FloatV MultipleScale(FloatTag d, size_t i) const {
    return hn::LoadU(d, t.multiple_scale.data() + i);
  }
  static HWY_INLINE FloatV Channel(FloatTag d, const Soa3<float>& soa, size_t i, int c) {
    return hn::LoadU(d, (c == 0 ? soa.x : c == 1 ? soa.y : soa.z).data() + i);
  }
  HWY_INLINE FloatV F0(FloatTag d, size_t i, int c) const { return Channel(d, t.f0, i, c); }
  HWY_INLINE FloatV FMultiple(FloatTag d, size_t i, int c) const {
    return Channel(d, t.f_multiple, i, c);
  }
};

template <class Numbers>
HWY_INLINE void PrepareRange(const MicrofacetModel& model, const Numbers& numbers, size_t begin,
                             size_t end, Surface* surface) {
  const FloatTag d;
  const FloatV one = hn::Set(d, 1.0f);
  const Soa3<float>& n = surface->normal;
  const Soa3<float>& v = surface->to_view;
  float* const base[3] = {surface->base.x.data(), surface->base.y.data(), surface->base.z.data()};
  const bool scaled = model.coupling == DiffuseCoupling::kAlbedoScaled;
  const bool kulla_conty = model.compensation == Compensation::kKullaConty;
  for (size_t i = begin; i < end; i += hn::Lanes(d)) {
    const auto mask = hn::FirstN(d, end - i);
    const FloatV n_dot_v =
        hn::Max(FusedDot(LoadU3(d, n.x.data() + i, n.y.data() + i, n.z.data() + i),
                         LoadU3(d, v.x.data() + i, v.y.data() + i, v.z.data() + i)),
                hn::Zero(d));
    const AlbedoV albedo = numbers.Albedo(d, i, n_dot_v);
    const FloatV multiple = Multiple(d, model.compensation, albedo, numbers.MultipleScale(d, i));
    StoreMasked(d, mask, multiple, surface->multiple.data() + i);
    for (int c = 0; c < 3; ++c) {
      const FloatV f0 = numbers.F0(d, i, c);
      const FloatV f_multiple = numbers.FMultiple(d, i, c);
      const FloatV left = !scaled       ? one
                          : kulla_conty ? KullaContyBase(d, albedo, f0, f_multiple)
                                        : TurquinBase(d, albedo, f0, multiple);
      StoreMasked(d, mask, left, base[c] + i);
    }
  }
}

void PrepareMicrofacetT(const MicrofacetModel& model, size_t begin, size_t end, Surface* surface) {
  PrepareRange(model, SameForAll{model}, begin, end, surface);
}

void PrepareMicrofacetMapsT(const MicrofacetModel& model, const HitTextures& textures,
                            bool own_fits, size_t begin, size_t end, Surface* surface) {
  PrepareRange(model, ByHit{model, textures, own_fits}, begin, end, surface);
}

}  // namespace HWY_NAMESPACE
}  // namespace nacre
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace nacre {
HWY_EXPORT(PrepareMicrofacetT);
HWY_EXPORT(PrepareMicrofacetMapsT);
void PrepareMicrofacet(const MicrofacetModel& model, size_t begin, size_t end, Surface* surface) {
  HWY_DYNAMIC_DISPATCH(PrepareMicrofacetT)(model, begin, end, surface);
}
void PrepareMicrofacetMaps(const MicrofacetModel& model, const HitTextures& textures, bool own_fits,
                           size_t begin, size_t end, Surface* surface) {
  HWY_DYNAMIC_DISPATCH(PrepareMicrofacetMapsT)(model, textures, own_fits, begin, end, surface);
}
}  // namespace nacre
#endif
