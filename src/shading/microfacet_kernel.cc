// SPDX-License-Identifier: Apache-2.0
// shading/microfacet_kernel.cc: a GGX lobe over a diffuse base, for any Fresnel curve.
#include <limits>
#include <type_traits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "shading/microfacet_kernel.cc"
#include "hwy/foreach_target.h"

#include "hwy/highway.h"

#include "brdf/ggx-inl.h"
#include "shading/microfacet_albedo-inl.h"
#include "shading/microfacet_curve-inl.h"
#include "shading/packets-inl.h"

HWY_BEFORE_NAMESPACE();
namespace nacre {
namespace HWY_NAMESPACE {

template <FresnelForm kFresnel, class Number>
struct Microfacet {
  using Incident = HalfIncidentV;
  static constexpr bool kSame = std::is_same_v<Number, float>;  // all hits share the constants
  // Whether a dielectric and a metal are mixed, which Turquin's compensation scales each by its own
  // F0.
  static constexpr bool kIsMix =
      kFresnel != FresnelForm::kDielectric && kFresnel != FresnelForm::kConductor;
  MicrofacetUniforms<Number> uniforms;  // a copy, which no store can alias
  const MicrofacetModel& model;
  const Surface& surface;
  AlbedoBlock* from_light;  // scratch: the albedos from the light of a block of hits

  // The denominator of the visibility times `scale`.
  HWY_INLINE FloatV Masking(FloatTag d, const PacketV& p, const Incident& in, FloatV scale) const {
    if (uniforms.light_root != nullptr) return AnisotropicMasking(d, p, in, scale);
    const FloatV alpha = NumberAt(d, uniforms.alpha, p.i);
    switch (model.shadowing) {
      case Shadowing::kHeightCorrelated:
        return VisibilityDenominatorHeightCorrelated(d, in.n_dot_l, in.n_dot_v, alpha, scale);
      case Shadowing::kSeparable:
        return VisibilityDenominatorSeparable(d, in.n_dot_l, in.n_dot_v, alpha, scale);
      case Shadowing::kSchlickDirect:
      case Shadowing::kSchlickIbl:
        break;
    }
    return VisibilityDenominatorSchlick(d, in.n_dot_l, in.n_dot_v,
                                        NumberAt(d, uniforms.schlick_k, p.i), scale);
  }

  // By the cosines of `in`, whose n.l the weight holds, too: those in double may have another sign.
  HWY_INLINE FloatV AnisotropicMasking(FloatTag d, const PacketV& p, const Incident& in,
                                       FloatV scale) const {
    const FloatV light_root = hn::LoadU(d, uniforms.light_root + p.i);
    const FloatV view_root = hn::LoadU(d, uniforms.view_root + p.i);
    if (model.shadowing == Shadowing::kSeparable) {
      const FloatV of_light = hn::Add(in.n_dot_l, light_root);
      return hn::Mul(hn::Mul(of_light, hn::Add(in.n_dot_v, view_root)), scale);
    }
    const FloatV sum = hn::MulAdd(in.n_dot_l, view_root, hn::Mul(in.n_dot_v, light_root));
    return hn::Mul(sum, hn::Add(scale, scale));
  }

  // The product of distribution, visibility, n.l and irradiance.
  HWY_INLINE FloatV Lobe(FloatTag d, const PacketV& p, const Incident& in) const {
    if (kSame && uniforms.sharp_distribution != nullptr) return SharpLobe(d, p, in);
    const FloatV q = GgxRootDenominator(d, in.half, NumberAt(d, uniforms.alpha, p.i));
    const FloatV masking = Masking(d, p, in, NumberAt(d, uniforms.pi_over_alpha2, p.i));
    // Usually the square of |u|^2 is far from float's limits, and this need not wait for |u|.
    FloatV wide = LobeBy(d, hn::Mul(hn::Mul(q, q), masking),
                         hn::Mul(hn::Mul(in.half.u_squared, in.half.u_squared), in.weight));
    // On spheres, n.v of visible points rounds to above -4e-7, and so does n.u of lit points. Such
    // values count as 0, not as below the surface.
    wide = hn::IfThenElseZero(hn::Gt(in.half.n_dot_u, hn::Set(d, -0x1p-20f)), wide);
    if (in.any_short) {
      const FloatV inverse = hn::Div(hn::Set(d, 4.0f), in.twice_u_length);  // 2 / |u|
      const FloatV four_q = hn::Mul(q, hn::Mul(inverse, inverse));
      const FloatV sixteenth = hn::Mul(masking, hn::Set(d, 0.0625f));
      const FloatV of_short = LobeBy(d, hn::Mul(hn::Mul(four_q, four_q), sixteenth), in.weight);
      // There is a lobe only where h lies above the surface and |u|^2 is a normal number.
      const auto above = hn::Gt(in.half.n_dot_u, hn::Set(d, 0x1p-63f));
      wide = hn::IfThenElse(IsUpright(d, in.half), wide, hn::IfThenElseZero(above, of_short));
    }
    if (kSame || uniforms.sharp_distribution == nullptr) return wide;
    const auto is_sharp = hn::Ge(hn::LoadU(d, uniforms.sharp_distribution + p.i), hn::Zero(d));
    return hn::IfThenElse(is_sharp, SharpLobe(d, p, in), wide);
  }

  // weight / denominator. `weight` is 0 where the surface is not lit.
  static HWY_INLINE FloatV LobeBy(FloatTag d, FloatV denominator, FloatV weight) {
    // The denominator is at least the smallest normal number, for unlit lanes and for cosines below
    // that. The result is at most the largest number: infinity times a lobe, or a colour, of 0
    // would be NaN.
    const FloatV smallest = hn::Set(d, std::numeric_limits<float>::min());
    const FloatV largest = hn::Set(d, std::numeric_limits<float>::max());
    const FloatV inverse = Reciprocal(d, hn::Max(denominator, smallest));
    return hn::Min(hn::Mul(weight, inverse), largest);
  }

  // Lobe with the distribution that was computed in double.
  HWY_INLINE FloatV SharpLobe(FloatTag d, const PacketV& p, const Incident& in) const {
    const FloatV smallest = hn::Set(d, std::numeric_limits<float>::min());
    const FloatV largest = hn::Set(d, std::numeric_limits<float>::max());
    const FloatV masking = Masking(d, p, in, hn::Set(d, 1.0f));
    const FloatV visibility = hn::Min(hn::Div(in.weight, hn::Max(masking, smallest)), largest);
    const FloatV product = hn::Mul(hn::LoadU(d, uniforms.sharp_distribution + p.i), visibility);
    return hn::IfThenElseZero(IsLit(d, in.n_dot_l), hn::Min(product, largest));
  }

  HWY_INLINE ReflectedV Reflect(FloatTag d, const PacketV& p, const Incident& in) const {
    const MicrofacetLight<Number>& light = uniforms.light;
    // At grazing light the spread grows as much as the weight falls: their product stays in range.
    const bool spreads = kFresnel != FresnelForm::kConductor && uniforms.spread != nullptr;
    const FloatV base_weight = spreads ? hn::Set(d, 1.0f) : in.weight;
    const auto curve = EvaluateCurve<kFresnel>(d, in, p.i, uniforms);
    const FloatV lobe = Lobe(d, p, in);
    PartV reflected = ScaledPart(ReflectedBy(d, curve, p.i, light), lobe);
    PartV base = LeftForBase(d, curve, p.i, model, light, base_weight);
    if (model.compensation == Compensation::kTurquin) {
      // `multiple` is multiplied by the lobe, not by the term: a bright light's colour times the
      // weight may be beyond float's range.
      const FloatV multiple = hn::LoadU(d, surface.multiple.data() + p.i);
      if constexpr (kIsMix) {
        const FloatV largest = hn::Set(d, std::numeric_limits<float>::max());
        const FloatV more = hn::Min(hn::Mul(multiple, lobe), largest);
        const RgbV term = TurquinTerm(d, curve, p.i, uniforms, light);
        reflected = WholePart(d, MulAdd3(term, more, RgbOf(reflected)));
      } else {
        const FloatV one = hn::Set(d, 1.0f);
        const RgbV scale = MulAdd3(RgbAt(d, uniforms.f0, p.i), multiple, {one, one, one});
        reflected = {RgbOf(reflected), scale};
      }
    }
    Complete(d, p.i, in, light, &reflected, &base.color);
    if (spreads) return {{{RgbOf(base), Scale(SpreadAt(d, p.i), in.weight)}}, reflected};
    return {{base}, reflected};
  }

  HWY_INLINE RgbV SpreadAt(FloatTag d, size_t i) const {
    const FloatV single = hn::LoadU(d, uniforms.spread->single.data() + i);
    const FloatV multiple = hn::LoadU(d, uniforms.spread->multiple.data() + i);
    return MulAdd3(RgbAt(d, uniforms.base.ratio, i), multiple, {single, single, single});
  }

  // Whether the albedos from the light are read, by Kulla and Conty's lobe or by the base.
  HWY_INLINE bool ReadsAlbedos() const {
    return model.compensation == Compensation::kKullaConty || model.reciprocal;
  }

  // Stores the albedos from the light of the lobes of hits [begin, end), whose light `block` holds.
  HWY_INLINE void FillAlbedos(size_t begin, size_t end, const IncidentBlock& block) const {
    if (!ReadsAlbedos()) return;
    const FloatTag d;
    from_light->with_curve = model.reciprocal;
    const auto n_dot_l = [&](size_t i)
                             HWY_ATTR { return hn::Max(block.NDotL(d, i - begin), hn::Zero(d)); };
    if (uniforms.light_root == nullptr) {
      return HWY_NAMESPACE::FillAlbedos(uniforms, begin, end, n_dot_l, from_light);
    }
    const auto cosines = [&](size_t i) HWY_ATTR {
      return LobeCosinesV{n_dot_l(i), hn::LoadU(d, uniforms.t_dot_l + i),
                          hn::LoadU(d, uniforms.b_dot_l + i)};
    };
    FillAnisotropic(uniforms, begin, end, cosines, from_light);
  }

  HWY_INLINE FloatV CoverAt(FloatTag d, int c, size_t i) const {
    if constexpr (HasCover(kFresnel)) return NumberAt(d, uniforms.cover[c], i);
    return hn::Set(d, 1.0f);
  }

  // Adds Kulla and Conty's lobe, and, if kAlbedoScaled, scales the base by 1 - the albedo of the
  // lobe that covers it.
  HWY_INLINE void Complete(FloatTag d, size_t i, const Incident& in,
                           const MicrofacetLight<Number>& light, PartV* reflected,
                           RgbV* base) const {
    const bool scaled = model.coupling == DiffuseCoupling::kAlbedoScaled;
    if (scaled) *base = Mul3(*base, LoadSoa(d, surface.transmittance, i));
    if (!ReadsAlbedos()) return;
    const AlbedoV albedo = from_light->Albedo(d, in.at);
    if (model.compensation == Compensation::kKullaConty) {
      const FloatV multiple = hn::LoadU(d, surface.multiple.data() + i);
      const FloatV largest = hn::Set(d, std::numeric_limits<float>::max());
      const FloatV amount = hn::Mul(hn::Mul(multiple, albedo.loss), in.weight);
      const RgbV more = Scale(RgbAt(d, light.multiple, i), hn::Min(amount, largest));
      *reflected = WholePart(d, Add(RgbOf(*reflected), more));
    }
    if (model.reciprocal) {
      const RgbV f0 = RgbAt(d, uniforms.dielectric_f0, i);
      const RgbV f_multiple = RgbAt(d, uniforms.dielectric_f_multiple, i);
      const RgbV& bias = albedo.bias;
      *base =
          Mul3(*base, {KullaContyBase(d, albedo, bias.x, f0.x, f_multiple.x, CoverAt(d, 0, i)),
                       KullaContyBase(d, albedo, bias.y, f0.y, f_multiple.y, CoverAt(d, 1, i)),
                       KullaContyBase(d, albedo, bias.z, f0.z, f_multiple.z, CoverAt(d, 2, i))});
    }
  }
};

template <FresnelForm kFresnel, class Number>
void ShadeByCurve(const MicrofacetUniforms<Number>& uniforms, const LitHits& lit) {
  static_assert(AlbedoBlock::kHits == kBlockHits);
  AlbedoBlock from_light;
  ShadePackets(FloatTag(),
               Microfacet<kFresnel, Number>{uniforms, uniforms.model, lit.surface, &from_light},
               lit);
}

// The kernel of a Fresnel curve.
template <class Number>
auto CurveKernel(FresnelForm form) {
  switch (form) {
    case FresnelForm::kSchlick:
      return &ShadeByCurve<FresnelForm::kSchlick, Number>;
    case FresnelForm::kF82:
      return &ShadeByCurve<FresnelForm::kF82, Number>;
    case FresnelForm::kDielectric:
      return &ShadeByCurve<FresnelForm::kDielectric, Number>;
    case FresnelForm::kOpenPbr:
      return &ShadeByCurve<FresnelForm::kOpenPbr, Number>;
    case FresnelForm::kThinFilm:
      return &ShadeByCurve<FresnelForm::kThinFilm, Number>;
    case FresnelForm::kConductor:
      break;
  }
  return &ShadeByCurve<FresnelForm::kConductor, Number>;
}
constexpr auto& CurveKernelT = CurveKernel<float>;
constexpr auto& CurveKernelMapsT = CurveKernel<float*>;

}  // namespace HWY_NAMESPACE
}  // namespace nacre
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace nacre {
HWY_EXPORT(CurveKernelT);
HWY_EXPORT(CurveKernelMapsT);

void ShadeMicrofacet(const MicrofacetUniforms<float>& uniforms, const LitHits& lit) {
  HWY_DYNAMIC_DISPATCH(CurveKernelT)(uniforms.model.fresnel)(uniforms, lit);
}

void ShadeMicrofacet(const MicrofacetUniforms<float*>& uniforms, const LitHits& lit) {
  HWY_DYNAMIC_DISPATCH(CurveKernelMapsT)(uniforms.model.fresnel)(uniforms, lit);
}
}  // namespace nacre
#endif
