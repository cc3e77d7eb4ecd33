// SPDX-License-Identifier: Apache-2.0
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
#include <type_traits>

#include "brdf/fresnel-inl.h"
#include "brdf/ggx-inl.h"
#include "shading/microfacet_albedo-inl.h"
#include "shading/packets-inl.h"

HWY_BEFORE_NAMESPACE();
namespace nacre {
namespace HWY_NAMESPACE {

// The models that a kernel is for: those of one shadowing, all of whose hits share a wide lobe over
// Lambert's base. `kIsPrepared`: with what PrepareMicrofacet has left of every hit: multiple
// scattering, or a base that gets what the lobe's albedo leaves.
template <Shadowing kShadowing, bool kIsPrepared>
struct UsualForm {
  static constexpr bool kUsual = true;
  static constexpr bool kPrepared = kIsPrepared;
  static HWY_INLINE Shadowing ShadowingOf(const MicrofacetModel&) { return kShadowing; }
};
// Or any, which is asked at each packet what it is.
struct AnyForm {
  static constexpr bool kUsual = false;
  static constexpr bool kPrepared = true;
  static HWY_INLINE Shadowing ShadowingOf(const MicrofacetModel& model) { return model.shadowing; }
};

// What a Fresnel curve makes of the light on a packet: the part that the lobe reflects, and the
// part that is left for a base under it (DiffuseCoupling::kOneMinusFresnel), of the light times
// the base's colour.
struct CurveV {
  RgbV reflected, left;
};

// Angles and lengths of the half vector that the curves are functions of.
struct HalfV {
  FloatV lv_squared, u_length;
};

// 1 - v.h for Schlick's weight; by kBrightF0.
template <class Number>
HWY_INLINE FloatV SchlickBase(FloatTag d, const HalfV& half, size_t i,
                              const MicrofacetUniformsOf<Number>& uniforms) {
  const FloatV rounded = hn::NegMulAdd(half.u_length, hn::Set(d, 0.5f), hn::Set(d, 1.0f));
  if constexpr (std::is_same_v<Number, float>) {
    return uniforms.is_bright ? rounded : OneMinusVDotH(d, half.lv_squared, half.u_length);
  } else {
    const RgbV f0 = RgbAt(d, uniforms.f0, i);
    const auto bright = hn::Ge(hn::Min(hn::Min(f0.r, f0.g), f0.b), hn::Set(d, kBrightF0));
    return hn::IfThenElse(bright, rounded, OneMinusVDotH(d, half.lv_squared, half.u_length));
  }
}

template <FresnelForm kFresnel, class Number>
HWY_INLINE CurveV EvaluateCurve(FloatTag d, const HalfV& half, size_t i,
                                const MicrofacetUniformsOf<Number>& uniforms,
                                const MicrofacetLightOf<Number>& light) {
  if constexpr (kFresnel == FresnelForm::kSchlick) {
    const FloatV weight = Power5(SchlickBase(d, half, i, uniforms));
    // Colour by colour: GCC 12 puts whole structs on the stack, asked for or not.
    const auto left = [&](size_t c) HWY_ATTR {
      return hn::NegMulAdd(NumberAt(d, light.diffuse_fall[c], i), weight,
                           NumberAt(d, light.diffuse_rest[c], i));
    };
    return {MulAddRgb(RgbAt(d, light.specular_rise, i), weight, RgbAt(d, light.specular_f0, i)),
            {left(0), left(1), left(2)}};
  } else {
    const FloatV one_minus_vh = OneMinusVDotH(d, half.lv_squared, half.u_length);
    const FloatV v_dot_h = VDotH(d, half.u_length);
    RgbV fresnel;
    if constexpr (kFresnel == FresnelForm::kF82) {
      const RgbV f0 = RgbAt(d, uniforms.f0, i), slope = RgbAt(d, uniforms.f82_slope, i);
      const FloatV f90 = NumberAt(d, uniforms.f90, i);
      fresnel = {FresnelF82(d, v_dot_h, one_minus_vh, f0.r, f90, slope.r),
                 FresnelF82(d, v_dot_h, one_minus_vh, f0.g, f90, slope.g),
                 FresnelF82(d, v_dot_h, one_minus_vh, f0.b, f90, slope.b)};
    } else if constexpr (kFresnel == FresnelForm::kDielectric) {
      const FloatV grey = FresnelDielectric(d, v_dot_h, one_minus_vh, hn::Set(d, uniforms.eta[0]));
      fresnel = {grey, grey, grey};
    } else {
      const RgbV eta = SetRgb(d, uniforms.eta), k = SetRgb(d, uniforms.k);
      fresnel = {FresnelConductor(d, v_dot_h, one_minus_vh, eta.r, k.r),
                 FresnelConductor(d, v_dot_h, one_minus_vh, eta.g, k.g),
                 FresnelConductor(d, v_dot_h, one_minus_vh, eta.b, k.b)};
    }
    const FloatV one = hn::Set(d, 1.0f);
    // The exact curves may round to just above 1 at grazing angles.
    const auto left = [&](FloatV f) HWY_ATTR { return hn::Max(hn::Sub(one, f), hn::Zero(d)); };
    return {
        MulRgb(fresnel, RgbAt(d, light.specular, i)),
        MulRgb({left(fresnel.r), left(fresnel.g), left(fresnel.b)}, RgbAt(d, light.diffuse, i))};
  }
}

// Turquin 2019: 1 + F0 (1 / E(v) - 1); `multiple` is the bracket.
HWY_INLINE RgbV TurquinScale(FloatTag d, const RgbV& f0, FloatV multiple) {
  const FloatV one = hn::Set(d, 1.0f);
  return MulAddRgb(f0, multiple, {one, one, one});
}

template <FresnelForm kFresnel, class Form, class Number>
struct Microfacet {
  static constexpr bool kReadsIrradiance = false;
  using Incident = HalfIncidentV;
  static constexpr bool kSame = std::is_same_v<Number, float>;  // for all hits
  // The curve's numbers tell what the base gets, coupled to the lobe or not (MakeLight).
  static constexpr bool kBaseByCurve =
      Form::kUsual && !Form::kPrepared && kFresnel == FresnelForm::kSchlick;
  const MicrofacetUniformsOf<Number> uniforms;  // a copy: nothing that a kernel stores is in it
  const MicrofacetModel& model;

  struct View {
    FloatV n_dot_v;
    const Surface* surface;  // with what was prepared, loaded where it is needed
  };

  HWY_INLINE bool ReadsLv() const {
    return kFresnel != FresnelForm::kSchlick || !kSame || !uniforms.is_bright;
  }

  HWY_INLINE View SeenBy(FloatTag d, const PacketV& p, const Surface& surface) const {
    // Interpolated mesh normals may lean away from the viewer; the cosine then counts as 0.
    return {hn::Max(FusedDot(p.normal, p.to_view), hn::Zero(d)), &surface};
  }

  // The denominator of the visibility times `scale`.
  HWY_INLINE FloatV Masking(FloatTag d, const View& view, const PacketV& p, const Incident& in,
                            FloatV scale) const {
    const FloatV alpha = NumberAt(d, uniforms.alpha, p.i);
    switch (Form::ShadowingOf(model)) {
      case Shadowing::kHeightCorrelated:
        return VisibilityDenominatorHeightCorrelated(d, in.n_dot_l, view.n_dot_v, alpha, scale);
      case Shadowing::kSeparable:
        return VisibilityDenominatorSeparable(d, in.n_dot_l, view.n_dot_v, alpha, scale);
      case Shadowing::kSchlickDirect:
        break;
    }
    return VisibilityDenominatorSchlick(d, in.n_dot_l, view.n_dot_v,
                                        NumberAt(d, uniforms.schlick_k, p.i), scale);
  }

  // Distribution, visibility, cosine and irradiance.
  HWY_INLINE FloatV Lobe(FloatTag d, const View& view, const PacketV& p, const Incident& in,
                         FloatV u_inverse) const {
    // Not less than the smallest normal number, for unlit lanes and for cosines below that; nor
    // more than the largest: infinity times a lobe, or a colour, of 0 would be NaN.
    const FloatV smallest = hn::Set(d, std::numeric_limits<float>::min());
    const FloatV largest = hn::Set(d, std::numeric_limits<float>::max());
    if (!Form::kUsual && kSame && uniforms.narrow != nullptr) return NarrowLobe(d, view, p, in);
    // h lies above the surface, and |u|^2 is a normal number: 0 and below there is no lobe.
    const auto above = hn::Gt(in.half.n_dot_u, hn::Set(d, 0x1p-63f));
    const FloatV q = GgxRootDenominator(d, in.half, hn::Mul(u_inverse, u_inverse),
                                        NumberAt(d, uniforms.alpha, p.i));
    const FloatV masking = Masking(d, view, p, in, NumberAt(d, uniforms.pi_over_alpha2, p.i));
    const FloatV denominator = hn::Max(hn::Mul(hn::Mul(q, q), masking), smallest);
    // Where the surface is not lit, the weight and so the product is 0.
    const FloatV wide =
        hn::IfThenElseZero(above, hn::Min(hn::Mul(in.weight, Reciprocal(d, denominator)), largest));
    if (Form::kUsual || kSame || uniforms.narrow == nullptr) return wide;
    const auto is_narrow = hn::Ge(hn::LoadU(d, uniforms.narrow + p.i), hn::Zero(d));
    return hn::IfThenElse(is_narrow, NarrowLobe(d, view, p, in), wide);
  }

  // The same with the distribution that was formed in double.
  HWY_INLINE FloatV NarrowLobe(FloatTag d, const View& view, const PacketV& p,
                               const Incident& in) const {
    const FloatV smallest = hn::Set(d, std::numeric_limits<float>::min());
    const FloatV largest = hn::Set(d, std::numeric_limits<float>::max());
    const FloatV masking = Masking(d, view, p, in, hn::Set(d, 1.0f));
    const FloatV visibility = hn::Min(hn::Div(in.weight, hn::Max(masking, smallest)), largest);
    const FloatV product = hn::Mul(hn::LoadU(d, uniforms.narrow + p.i), visibility);
    return hn::IfThenElseZero(in.lit, hn::Min(product, largest));
  }

  HWY_INLINE ReflectedV Reflect(FloatTag d, const View& view, const PacketV& p, const Incident& in,
                                size_t k) const {
    const MicrofacetLightOf<Number>& light = uniforms.lights[k];
    const FloatV u_squared =
        hn::Max(in.half.u_squared, hn::Set(d, std::numeric_limits<float>::min()));
    const FloatV u_inverse = ReciprocalSqrt(d, u_squared);
    const HalfV half{in.half.lv_squared, hn::Mul(u_squared, u_inverse)};
    const CurveV curve = EvaluateCurve<kFresnel>(d, half, p.i, uniforms, light);
    PartV reflected = ScaledPart(curve.reflected, Lobe(d, view, p, in, u_inverse));
    RgbV base = curve.left;
    if (!kBaseByCurve && model.coupling != DiffuseCoupling::kOneMinusFresnel) {
      base = RgbAt(d, light.diffuse, p.i);
    }
    if constexpr (Form::kPrepared) Complete(d, view, p.i, in, light, &reflected, &base);
    // Grazing light spreads by as much more as its weight is less: their product stays in range.
    if (!Form::kUsual && kFresnel != FresnelForm::kConductor && uniforms.spread != nullptr) {
      return {{{base, ScaleRgb(SpreadAt(d, p.i), in.weight)}}, reflected};
    }
    return {{ScaledPart(base, in.weight)}, reflected};
  }

  HWY_INLINE RgbV SpreadAt(FloatTag d, size_t i) const {
    const FloatV single = hn::LoadU(d, uniforms.spread->single.data() + i);
    const FloatV multiple = hn::LoadU(d, uniforms.spread->multiple.data() + i);
    return MulAddRgb(RgbAt(d, uniforms.base_ratio, i), multiple, {single, single, single});
  }

  HWY_INLINE AlbedoV AlbedoAt(FloatTag d, size_t i, FloatV cosine) const {
    const FloatV f90 = NumberAt(d, uniforms.f90, i);
    if constexpr (kSame) {
      return EvaluateAlbedo(d, model, f90, cosine);
    } else {
      if (uniforms.fit == nullptr) return EvaluateAlbedo(d, model, f90, cosine);
      return EvaluateAlbedo(d, model, FitAt(uniforms.fit + i, uniforms.fit_stride, model.shadowing),
                            f90, cosine);
    }
  }

  // Adds what bounces more than once, and takes from the base what the lobe's albedo does.
  HWY_INLINE void Complete(FloatTag d, const View& view, size_t i, const IncidentV& in,
                           const MicrofacetLightOf<Number>& light, PartV* reflected,
                           RgbV* base) const {
    const bool scaled = model.coupling == DiffuseCoupling::kAlbedoScaled;
    const Surface& surface = *view.surface;
    if (scaled) *base = MulRgb(*base, LoadRgb(d, surface.base, i));
    const FloatV multiple = hn::LoadU(d, surface.multiple.data() + i);
    if (model.compensation == Compensation::kTurquin) {
      // The lobe first: a bright light's colour times the scale may be beyond float's range.
      *reflected = {RgbOf(*reflected), TurquinScale(d, RgbAt(d, uniforms.f0, i), multiple)};
    }
    if (model.compensation != Compensation::kKullaConty) return;
    const FloatV largest = hn::Set(d, std::numeric_limits<float>::max());
    const AlbedoV from_light = AlbedoAt(d, i, hn::Max(in.n_dot_l, hn::Zero(d)));
    const FloatV amount = hn::Mul(hn::Mul(multiple, from_light.loss), in.weight);
    const RgbV more = ScaleRgb(RgbAt(d, light.multiple, i), hn::Min(amount, largest));
    *reflected = WholePart(d, AddRgb(RgbOf(*reflected), more));
    if (scaled) {
      const RgbV f0 = RgbAt(d, uniforms.f0, i), f_multiple = RgbAt(d, uniforms.f_multiple, i);
      *base = MulRgb(*base, {KullaContyBase(d, from_light, f0.r, f_multiple.r),
                             KullaContyBase(d, from_light, f0.g, f_multiple.g),
                             KullaContyBase(d, from_light, f0.b, f_multiple.b)});
    }
  }
};

template <FresnelForm kFresnel, class Form, class Number>
void ShadeMicrofacetForm(const MicrofacetUniformsOf<Number>& uniforms, const ShadeRange& range) {
  ShadePackets(FloatTag(), Microfacet<kFresnel, Form, Number>{uniforms, *uniforms.model}, range);
}

template <FresnelForm kFresnel, Shadowing kShadowing>
void ShadeUsualMicrofacet(const MicrofacetUniforms& uniforms, const ShadeRange& range) {
  if (uniforms.model->prepared) {
    ShadeMicrofacetForm<kFresnel, UsualForm<kShadowing, true>>(uniforms, range);
  } else {
    ShadeMicrofacetForm<kFresnel, UsualForm<kShadowing, false>>(uniforms, range);
  }
}

template <FresnelForm kFresnel>
void ShadeMicrofacet(const MicrofacetUniforms& uniforms, const ShadeRange& range) {
  if (uniforms.narrow != nullptr || uniforms.spread != nullptr) {
    return ShadeMicrofacetForm<kFresnel, AnyForm>(uniforms, range);
  }
  switch (uniforms.model->shadowing) {
    case Shadowing::kHeightCorrelated:
      return ShadeUsualMicrofacet<kFresnel, Shadowing::kHeightCorrelated>(uniforms, range);
    case Shadowing::kSeparable:
      return ShadeUsualMicrofacet<kFresnel, Shadowing::kSeparable>(uniforms, range);
    case Shadowing::kSchlickDirect:
      return ShadeUsualMicrofacet<kFresnel, Shadowing::kSchlickDirect>(uniforms, range);
  }
}

// Hits with numbers of their own, of which looking up and rounding them is most of the work: one
// kernel for all.
template <FresnelForm kFresnel>
void ShadeMicrofacetMaps(const MicrofacetUniformsOf<const float*>& uniforms,
                         const ShadeRange& range) {
  ShadeMicrofacetForm<kFresnel, AnyForm>(uniforms, range);
}

}  // namespace HWY_NAMESPACE
}  // namespace nacre
HWY_AFTER_NAMESPACE();
#endif
