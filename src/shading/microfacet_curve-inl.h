// SPDX-License-Identifier: Apache-2.0
// shading/microfacet_curve-inl.h: Fresnel curves applied to light: the part that a lobe reflects,
// and the part that is left for a base under it.
#if defined(NACRE_SHADING_MICROFACET_CURVE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef NACRE_SHADING_MICROFACET_CURVE_INL_H_
#undef NACRE_SHADING_MICROFACET_CURVE_INL_H_
#else
#define NACRE_SHADING_MICROFACET_CURVE_INL_H_
#endif

#include <type_traits>

#include "brdf/fresnel-inl.h"
#include "brdf/table_albedo-inl.h"
#include "shading/range-inl.h"

HWY_BEFORE_NAMESPACE();
namespace nacre {
namespace HWY_NAMESPACE {

// The value of a Fresnel curve, in one of three forms: Schlick's weight W, where F = F0 + (F90 -
// F0) W; F of each channel; or F of dielectric and metal, each times its share of the mix.
struct SchlickCurveV {
  FloatV weight;
};
struct FresnelCurveV {
  RgbV fresnel;
};
struct MixedCurveV {
  RgbV dielectric, metal;
};
HWY_INLINE RgbV FresnelOf(const FresnelCurveV& curve) { return curve.fresnel; }
HWY_INLINE RgbV FresnelOf(const MixedCurveV& curve) { return Add(curve.dielectric, curve.metal); }

// F82's curve of a metal in each channel.
template <class Number>
HWY_INLINE RgbV MetalF82(FloatTag d, const HalfIncidentV& in, FloatV v_dot_h, size_t i,
                         const MicrofacetUniforms<Number>& uniforms) {
  const RgbV f0 = RgbAt(d, uniforms.metal_f0, i), slope = RgbAt(d, uniforms.f82_slope, i);
  return {FresnelF82(d, v_dot_h, in.one_minus_vh, f0.x, slope.x),
          FresnelF82(d, v_dot_h, in.one_minus_vh, f0.y, slope.y),
          FresnelF82(d, v_dot_h, in.one_minus_vh, f0.z, slope.z)};
}

// `scale` times the reflectance of a table, or 0.
HWY_INLINE RgbV UnderFilm(FloatTag d, const FresnelTable& table, bool reflects, FloatV v_dot_h,
                          const RgbV& scale) {
  const FloatV zero = hn::Zero(d);
  FloatV red = zero, green = zero, blue = zero;
  if (reflects) {
    const RgbV reflected = Mul3(TableReflectance(d, table, v_dot_h), scale);
    red = reflected.x, green = reflected.y, blue = reflected.z;
  }
  return {red, green, blue};
}

template <FresnelForm kFresnel, class Number>
HWY_INLINE auto EvaluateCurve(FloatTag d, const HalfIncidentV& in, size_t i,
                              const MicrofacetUniforms<Number>& uniforms) {
  const FloatV one_minus_vh = in.one_minus_vh;
  if constexpr (kFresnel == FresnelForm::kSchlick) {
    return SchlickCurveV{Power5(one_minus_vh)};
  } else {
    const FloatV v_dot_h = VDotH(d, in.twice_u_length);
    if constexpr (kFresnel == FresnelForm::kF82) {
      const FloatV one = hn::Set(d, 1.0f), metallic = NumberAt(d, uniforms.metallic, i);
      const RgbV metal = MetalF82(d, in, v_dot_h, i, uniforms);
      const RgbV other = RgbAt(d, uniforms.dielectric_f0, i);
      const FloatV f90 = NumberAt(d, uniforms.dielectric_f90, i), weight = Power5(one_minus_vh);
      const RgbV dielectric{FresnelSchlick(d, other.x, f90, weight),
                            FresnelSchlick(d, other.y, f90, weight),
                            FresnelSchlick(d, other.z, f90, weight)};
      return MixedCurveV{Scale(dielectric, hn::Sub(one, metallic)), Scale(metal, metallic)};
    } else if constexpr (kFresnel == FresnelForm::kOpenPbr) {
      const FloatV grey =
          FresnelCoatedDielectric(d, v_dot_h, one_minus_vh, uniforms.model.dielectric);
      const RgbV dielectric = Scale(RgbAt(d, uniforms.dielectric, i), grey);
      const FloatV zero = hn::Zero(d);
      RgbV metal{zero, zero, zero};
      if (!uniforms.model.is_dielectric) {
        metal = Scale(MetalF82(d, in, v_dot_h, i, uniforms), NumberAt(d, uniforms.metal, i));
      }
      return MixedCurveV{dielectric, metal};
    } else if constexpr (kFresnel == FresnelForm::kThinFilm) {
      const ThinFilmLobe& film = *uniforms.model.film;
      const FloatV share = NumberAt(d, uniforms.metal, i);
      RgbV metal =
          UnderFilm(d, film.metal, film.has_metal && !film.metal_by_hit, v_dot_h, GreyOf(share));
      if (film.metal_by_hit) metal = Scale(MetalF82(d, in, v_dot_h, i, uniforms), share);
      return MixedCurveV{UnderFilm(d, film.dielectric, film.has_dielectric, v_dot_h,
                                   RgbAt(d, uniforms.dielectric, i)),
                         metal};
    } else if constexpr (kFresnel == FresnelForm::kDielectric) {
      const FloatV grey = FresnelDielectric(d, v_dot_h, one_minus_vh, hn::Set(d, uniforms.eta[0]));
      return FresnelCurveV{{grey, grey, grey}};
    } else {
      const RgbV eta = SetRgb(d, uniforms.eta), k = SetRgb(d, uniforms.k);
      return FresnelCurveV{{FresnelConductor(d, v_dot_h, one_minus_vh, eta.x, k.x),
                            FresnelConductor(d, v_dot_h, one_minus_vh, eta.y, k.y),
                            FresnelConductor(d, v_dot_h, one_minus_vh, eta.z, k.z)}};
    }
  }
}

// F times the light.
template <class Number>
HWY_INLINE RgbV ReflectedBy(FloatTag d, const SchlickCurveV& curve, size_t i,
                            const MicrofacetLight<Number>& light) {
  return MulAdd3(RgbAt(d, light.specular_rise, i), curve.weight, RgbAt(d, light.specular_f0, i));
}
template <class Curve, class Number>
HWY_INLINE RgbV ReflectedBy(FloatTag d, const Curve& curve, size_t i,
                            const MicrofacetLight<Number>& light) {
  return Mul3(FresnelOf(curve), RgbAt(d, light.specular, i));
}

// F0 F times the light, where dielectric and metal of a mix each have their own F0: Turquin's
// compensation adds this times 1 / E - 1 (TurquinTerm of scalar_bsdf.h).
template <class Number>
HWY_INLINE RgbV TurquinTerm(FloatTag d, const SchlickCurveV& curve, size_t i,
                            const MicrofacetUniforms<Number>&,
                            const MicrofacetLight<Number>& light) {
  return MulAdd3(RgbAt(d, light.turquin_rise, i), curve.weight, RgbAt(d, light.turquin_f0, i));
}
template <class Number>
HWY_INLINE RgbV TurquinTerm(FloatTag d, const MixedCurveV& curve, size_t i,
                            const MicrofacetUniforms<Number>& uniforms,
                            const MicrofacetLight<Number>& light) {
  const RgbV of_dielectric = Mul3(RgbAt(d, uniforms.dielectric_f0, i), curve.dielectric);
  const RgbV of_metal = Mul3(RgbAt(d, uniforms.metal_f0, i), curve.metal);
  return Mul3(Add(of_dielectric, of_metal), RgbAt(d, light.specular, i));
}

// The light that the base gets, times its colour and `weight`: all of it, or the fraction 1 - F
// (DiffuseCoupling::kOneMinusFresnel), which by Schlick is (1 - F0) (1 - W) + (1 - F90) W.
template <class Number>
HWY_INLINE PartV LeftForBase(FloatTag d, const SchlickCurveV& curve, size_t i,
                             const MicrofacetModel& model, const MicrofacetLight<Number>& light,
                             FloatV weight) {
  // The branch selects vectors, not structs, because GCC would pass a struct through memory.
  FloatV r = NumberAt(d, light.diffuse_normal[0], i);
  FloatV g = NumberAt(d, light.diffuse_normal[1], i);
  FloatV b = NumberAt(d, light.diffuse_normal[2], i);
  if (model.coupling == DiffuseCoupling::kOneMinusFresnel) {
    const FloatV rest = hn::NegMulAdd(weight, curve.weight, weight);
    const FloatV rise = hn::Mul(weight, curve.weight);
    r = hn::MulAdd(NumberAt(d, light.diffuse_grazing[0], i), rise, hn::Mul(r, rest));
    g = hn::MulAdd(NumberAt(d, light.diffuse_grazing[1], i), rise, hn::Mul(g, rest));
    b = hn::MulAdd(NumberAt(d, light.diffuse_grazing[2], i), rise, hn::Mul(b, rest));
    weight = hn::Set(d, 1.0f);
  }
  return ScaledPart({r, g, b}, weight);
}
template <class Curve, class Number>
HWY_INLINE PartV LeftForBase(FloatTag d, const Curve& curve, size_t i, const MicrofacetModel& model,
                             const MicrofacetLight<Number>& light, FloatV weight) {
  const bool coupled = model.coupling == DiffuseCoupling::kOneMinusFresnel;
  // The exact curves may round to just above 1 at grazing angles.
  const auto left = [&](FloatV fresnel, size_t c) HWY_ATTR {
    FloatV all = NumberAt(d, light.diffuse[c], i);
    if (coupled) {
      all = hn::Mul(hn::Max(hn::Sub(hn::Set(d, 1.0f), fresnel), hn::Zero(d)), all);
    }
    return all;
  };
  const RgbV fresnel = FresnelOf(curve);
  return ScaledPart({left(fresnel.x, 0), left(fresnel.y, 1), left(fresnel.z, 2)}, weight);
}

}  // namespace HWY_NAMESPACE
}  // namespace nacre
HWY_AFTER_NAMESPACE();
#endif
