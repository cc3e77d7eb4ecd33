// shading/microfacet_kernel-inl.h: a GGX lobe over a diffuse base, for any Fresnel curve. The
// kernels of the curves instantiate it: metallic_roughness_kernel.cc, conductor_kernel.cc,
// dielectric_kernel.cc.
#if defined(NACRE_SHADING_MICROFACET_KERNEL_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef NACRE_SHADING_MICROFACET_KERNEL_INL_H_
#undef NACRE_SHADING_MICROFACET_KERNEL_INL_H_
#else
#define NACRE_SHADING_MICROFACET_KERNEL_INL_H_
#endif

#include <limits>

#include "brdf/fresnel-inl.h"
#include "brdf/ggx-inl.h"
#include "shading/microfacet_albedo-inl.h"

HWY_BEFORE_NAMESPACE();
namespace nacre {
namespace HWY_NAMESPACE {

template <Shadowing kShadowing>
HWY_INLINE FloatV VisibilityDenominator(FloatTag d, FloatV n_dot_l, FloatV n_dot_v, FloatV alpha,
                                        FloatV schlick_k) {
  if constexpr (kShadowing == Shadowing::kHeightCorrelated) {
    return VisibilityDenominatorHeightCorrelated(d, n_dot_l, n_dot_v, alpha);
  } else if constexpr (kShadowing == Shadowing::kSeparable) {
    return VisibilityDenominatorSeparable(d, n_dot_l, n_dot_v, alpha);
  } else {
    return VisibilityDenominatorSchlick(d, n_dot_l, n_dot_v, schlick_k);
  }
}

// The constants of a Fresnel curve, in registers.
struct CurveV {
  RgbV f0, slope, eta, k;
};

template <FresnelForm kFresnel>
HWY_INLINE RgbV Fresnel(FloatTag d, const AnglesV<FloatV>& angles, const CurveV& curve) {
  const FloatV one_minus_vh = OneMinusVDotH(d, angles);
  const auto each = [&](const auto& of_channel) HWY_ATTR {
    return RgbV{of_channel(curve.f0.r, curve.slope.r, curve.eta.r, curve.k.r),
                of_channel(curve.f0.g, curve.slope.g, curve.eta.g, curve.k.g),
                of_channel(curve.f0.b, curve.slope.b, curve.eta.b, curve.k.b)};
  };
  if constexpr (kFresnel == FresnelForm::kSchlick) {
    const FloatV weight = Power5(one_minus_vh);
    return each([&](FloatV f0, FloatV, FloatV, FloatV)
                    HWY_ATTR { return FresnelSchlick(d, f0, weight); });
  } else {
    const FloatV v_dot_h = VDotH(d, angles);
    if constexpr (kFresnel == FresnelForm::kF82) {
      return each([&](FloatV f0, FloatV slope, FloatV, FloatV)
                      HWY_ATTR { return FresnelF82(d, v_dot_h, one_minus_vh, f0, slope); });
    } else if constexpr (kFresnel == FresnelForm::kDielectric) {
      const FloatV grey = FresnelDielectric(d, v_dot_h, one_minus_vh, curve.eta.r);
      return {grey, grey, grey};
    } else {
      return each([&](FloatV, FloatV, FloatV eta, FloatV k)
                      HWY_ATTR { return FresnelConductor(d, v_dot_h, one_minus_vh, eta, k); });
    }
  }
}

HWY_INLINE RgbV MulRgb(const RgbV& a, const RgbV& b) {
  return {hn::Mul(a.r, b.r), hn::Mul(a.g, b.g), hn::Mul(a.b, b.b)};
}

// Turquin 2019: 1 + F0 (1 / E(v) - 1); `multiple` is the bracket.
HWY_INLINE RgbV TurquinScale(FloatTag d, const RgbV& f0, FloatV multiple) {
  const FloatV one = hn::Set(d, 1.0f);
  return {hn::MulAdd(f0.r, multiple, one), hn::MulAdd(f0.g, multiple, one),
          hn::MulAdd(f0.b, multiple, one)};
}

template <FresnelForm kFresnel, Shadowing kShadowing>
void ShadeMicrofacetForm(const MicrofacetUniforms& uniforms, const ShadeRange& range) {
  const FloatTag d;
  const MicrofacetModel& model = *uniforms.model;
  const FloatV zero = hn::Zero(d);
  const FloatV one = hn::Set(d, 1.0f);
  const FloatV smallest = hn::Set(d, std::numeric_limits<float>::min());
  const FloatV largest = hn::Set(d, std::numeric_limits<float>::max());
  const RgbV diffuse = SetRgb(d, uniforms.diffuse);
  const RgbV specular = SetRgb(d, uniforms.specular);
  const CurveV curve{SetRgb(d, model.f0), SetRgb(d, model.f82_slope), SetRgb(d, model.eta),
                     SetRgb(d, model.k)};
  const FloatV alpha = hn::Set(d, model.delta ? 1.0f : static_cast<float>(model.alpha));
  const FloatV schlick_k = hn::Set(d, static_cast<float>(model.schlick_k));
  const bool kulla_conty = model.compensation == Compensation::kKullaConty;
  const bool one_minus_fresnel = model.coupling == DiffuseCoupling::kOneMinusFresnel;
  const bool reciprocal = kulla_conty && model.coupling == DiffuseCoupling::kAlbedoScaled;
  const Surface& surface = range.surface;
  ForEachPacket(d, range, [&](const LitPacket& p, size_t i, hn::Mask<FloatTag> mask) HWY_ATTR {
    const AnglesV<FloatV> angles = ComputeAngles(d, p.normal, p.to_light, p.to_view);
    const FloatV weight = hn::Mul(angles.n_dot_l, p.irradiance);
    // Interpolated mesh normals may lean away from the viewer; the cosine then counts as 0.
    const FloatV n_dot_v = hn::Max(angles.n_dot_v, zero);
    const FloatV denominator =
        VisibilityDenominator<kShadowing>(d, angles.n_dot_l, n_dot_v, alpha, schlick_k);
    const auto lit = hn::Gt(weight, zero);
    // Not less than the smallest normal number, for unlit lanes and for cosines below that; nor
    // more than the largest: infinity times a lobe, or a colour, of 0 would be NaN.
    const FloatV visibility = hn::Min(hn::Div(weight, hn::Max(denominator, smallest)), largest);
    const FloatV distribution = uniforms.narrow != nullptr ? hn::LoadU(d, uniforms.narrow + i)
                                                           : GgxDistribution(d, angles, alpha);
    const FloatV product = hn::Mul(distribution, visibility);
    const FloatV lobe = hn::IfThenElseZero(lit, hn::Min(product, largest));
    const RgbV fresnel = Fresnel<kFresnel>(d, angles, curve);
    const FloatV multiple = hn::LoadU(d, surface.multiple.data() + i);
    RgbV reflected = ScaleRgb(MulRgb(fresnel, specular), lobe);
    RgbV base = LoadRgb(d, surface.base, i);
    if (kulla_conty) {
      const AlbedoV from_light = EvaluateAlbedo(d, model, hn::Max(angles.n_dot_l, zero));
      const FloatV amount = hn::Mul(hn::Mul(multiple, from_light.loss), weight);
      const RgbV added = ScaleRgb(SetRgb(d, uniforms.multiple), hn::Min(amount, largest));
      reflected = {hn::Add(reflected.r, added.r), hn::Add(reflected.g, added.g),
                   hn::Add(reflected.b, added.b)};
      if (reciprocal) {
        const RgbV f_multiple = SetRgb(d, model.f_multiple);
        base = MulRgb(base, {KullaContyBase(d, from_light, curve.f0.r, f_multiple.r),
                             KullaContyBase(d, from_light, curve.f0.g, f_multiple.g),
                             KullaContyBase(d, from_light, curve.f0.b, f_multiple.b)});
      }
    } else {
      reflected = MulRgb(reflected, TurquinScale(d, curve.f0, multiple));
    }
    if (one_minus_fresnel) {
      // The exact curves may round to just above 1 at grazing angles.
      const auto rest = [&](FloatV f) HWY_ATTR { return hn::Max(hn::Sub(one, f), zero); };
      base = {rest(fresnel.r), rest(fresnel.g), rest(fresnel.b)};
    }
    Accumulate(d, mask, ScaleRgb(MulRgb(base, diffuse), weight), i, &range.radiance->diffuse);
    Accumulate(d, mask, reflected, i, &range.radiance->specular);
  });
}

template <FresnelForm kFresnel>
void ShadeMicrofacet(const MicrofacetUniforms& uniforms, const ShadeRange& range) {
  switch (uniforms.model->shadowing) {
    case Shadowing::kHeightCorrelated:
      return ShadeMicrofacetForm<kFresnel, Shadowing::kHeightCorrelated>(uniforms, range);
    case Shadowing::kSeparable:
      return ShadeMicrofacetForm<kFresnel, Shadowing::kSeparable>(uniforms, range);
    case Shadowing::kSchlickDirect:
      return ShadeMicrofacetForm<kFresnel, Shadowing::kSchlickDirect>(uniforms, range);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace nacre
HWY_AFTER_NAMESPACE();
#endif
