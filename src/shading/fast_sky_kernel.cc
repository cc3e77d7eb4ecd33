// SPDX-License-Identifier: Apache-2.0
// shading/fast_sky_kernel.cc: the halves of the split sum. What lobes reflect of light that is the
// same all round (scalar twin: LobeAlbedo of material.h), and what of a sky they see on average
// (scalar twin: LookUp of light/prefilter.h, which works lane by lane here: two texels side by
// side are two loads, which no gather makes faster).
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "shading/fast_sky_kernel.cc"
#include "hwy/foreach_target.h"

#include "hwy/highway.h"

#include "light/environment-inl.h"
#include "shading/fast_sky.h"
#include "shading/microfacet_albedo-inl.h"

#ifndef NACRE_FAST_SKY_TURNED_BY_
#define NACRE_FAST_SKY_TURNED_BY_
namespace nacre {
// By which angle a sky is, about +y.
struct TurnedBy {
  float cosine, sine;
};
}  // namespace nacre
#endif

HWY_BEFORE_NAMESPACE();
namespace nacre {
namespace HWY_NAMESPACE {
namespace {

// What single scattering is multiplied by, and what is added to it.
struct MultipleV {
  FloatV scale, sum;
};

HWY_INLINE MultipleV MultipleOf(FloatTag d, const MicrofacetModel& model, const AlbedoV& albedo,
                                int c) {
  const FloatV one = hn::Set(d, 1.0f);
  switch (model.compensation) {
    case Compensation::kTurquin: {
      const FloatV f0 = hn::Set(d, static_cast<float>(model.f0[c]));
      return {hn::MulAdd(f0, hn::Div(albedo.loss, albedo.one), one), hn::Zero(d)};
    }
    case Compensation::kKullaConty:
      return {one, hn::Mul(hn::Set(d, static_cast<float>(model.f_multiple[c])), albedo.loss)};
    case Compensation::kNone:
      break;
  }
  return {one, hn::Zero(d)};
}

float* ChannelOf(Soa3<float>* soa, int c) {
  return c == 0 ? soa->x.data() : c == 1 ? soa->y.data() : soa->z.data();
}

void ReflectanceT(const MicrofacetModel& model, const LobeRange& range, Soa3<float>* reflectance,
                  Soa3<float>* grazing) {
  const FloatTag d;
  const Soa3<float>&n = range.surface.normal, &v = range.surface.to_view;
  for (size_t i = range.begin; i < range.end; i += hn::Lanes(d)) {
    const auto mask = hn::FirstN(d, range.end - i);
    const FloatV n_dot_v =
        hn::Max(FusedDot(LoadU3(d, n.x.data() + i, n.y.data() + i, n.z.data() + i),
                         LoadU3(d, v.x.data() + i, v.y.data() + i, v.z.data() + i)),
                hn::Zero(d));
    const FloatV f90 = hn::Set(d, static_cast<float>(model.f90));
    const AlbedoV albedo = EvaluateAlbedo(d, model, f90, n_dot_v);
    for (int c = 0; c < 3; ++c) {
      const FloatV f0 = hn::Set(d, static_cast<float>(model.f0[c]));
      const FloatV single = hn::MulAdd(f0, albedo.scale, albedo.bias);
      const MultipleV multiple = MultipleOf(d, model, albedo, c);
      hn::BlendedStore(hn::MulAdd(single, multiple.scale, multiple.sum), mask, d,
                       ChannelOf(reflectance, c) + i);
      if (grazing == nullptr) continue;
      const FloatV added = hn::Max(hn::NegMulAdd(f0, albedo.one, single), hn::Zero(d));
      hn::BlendedStore(hn::Mul(added, multiple.scale), mask, d, ChannelOf(grazing, c) + i);
    }
  }
}

void RadianceT(const PrefilteredMap& lobe, const TurnedBy& turned, size_t begin, size_t end,
               const Soa3<float>& mirrored, Soa3<float>* radiance) {
  const hn::ScalableTag<float> d;
  const auto c = hn::Set(d, turned.cosine), s = hn::Set(d, turned.sine);
  alignas(64) float u[kMaxEnvironmentLanes], v[kMaxEnvironmentLanes];
  for (size_t i = begin; i < end; i += hn::Lanes(d)) {
    const auto l = LoadU3(d, mirrored.x.data() + i, mirrored.y.data() + i, mirrored.z.data() + i);
    const Vec3V<hn::Vec<decltype(d)>> back{hn::MulSub(l.x, c, hn::Mul(l.z, s)), l.y,
                                           hn::MulAdd(l.z, c, hn::Mul(l.x, s))};
    const auto at = LatLongFromDirection(d, back);
    hn::Store(at.u, d, u);
    hn::Store(at.v, d, v);
    for (size_t k = 0; k < HWY_MIN(hn::Lanes(d), end - i); ++k) {
      const Vec3f seen = LookUp(lobe, u[k], v[k]);
      radiance->x[i + k] = seen.x;
      radiance->y[i + k] = seen.y;
      radiance->z[i + k] = seen.z;
    }
  }
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace nacre
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace nacre {
HWY_EXPORT(ReflectanceT);
HWY_EXPORT(RadianceT);

void FastReflectance(const ShadingMaterial& material, const LobeRange& range,
                     Soa3<float>* reflectance, Soa3<float>* grazing) {
  HWY_DYNAMIC_DISPATCH(ReflectanceT)
  (std::get<MicrofacetModel>(material.model), range, reflectance, grazing);
}

void FastRadiance(const SampledLight& light, const ShadingMaterial& material, size_t begin,
                  size_t end, const Soa3<float>& mirrored, Soa3<float>* radiance) {
  const double alpha = std::get<MicrofacetModel>(material.model).alpha;
  const PrefilteredMap* const lobe = FindLobe(*light.sky.fast, alpha);
  if (lobe == nullptr) return;  // the same all round
  const bool picture = light.form == SampledForm::kPictureSky;
  const auto cosine = static_cast<float>(picture ? light.sky.cos_rotation : 1);
  const auto sine = static_cast<float>(picture ? light.sky.sin_rotation : 0);
  HWY_DYNAMIC_DISPATCH(RadianceT)(*lobe, {cosine, sine}, begin, end, mirrored, radiance);
}

}  // namespace nacre
#endif
