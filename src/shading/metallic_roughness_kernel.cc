// shading/metallic_roughness_kernel.cc: the metallic-roughness model: GGX with Schlick's Fresnel
// over a Lambertian base.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "shading/metallic_roughness_kernel.cc"
#include "hwy/foreach_target.h"

#include <limits>

#include "hwy/highway.h"

#include "brdf/fresnel-inl.h"
#include "brdf/ggx-inl.h"
#include "shading/range-inl.h"

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

template <Shadowing kShadowing>
void ShadeMetallicRoughnessForm(const MetallicRoughnessUniforms& uniforms,
                                const ShadeRange& range) {
  const FloatTag d;
  const FloatV zero = hn::Zero(d);
  const FloatV one = hn::Set(d, 1.0f);
  const FloatV largest = hn::Set(d, std::numeric_limits<float>::max());
  const RgbV diffuse = SetRgb(d, uniforms.diffuse);
  const RgbV specular = SetRgb(d, uniforms.specular);
  const RgbV f0 = SetRgb(d, uniforms.f0);
  const FloatV alpha = hn::Set(d, uniforms.alpha);
  const FloatV schlick_k = hn::Set(d, uniforms.schlick_k);
  ForEachPacket(d, range, [&](const LitPacket& p, size_t i, hn::Mask<FloatTag> mask) HWY_ATTR {
    const AnglesV<FloatV> angles = ComputeAngles(d, p.normal, p.to_light, p.to_view);
    const FloatV weight = hn::Mul(angles.n_dot_l, p.irradiance);
    // Interpolated mesh normals may lean away from the viewer; the cosine then counts as 0.
    const FloatV n_dot_v = hn::Max(angles.n_dot_v, zero);
    const FloatV denominator =
        VisibilityDenominator<kShadowing>(d, angles.n_dot_l, n_dot_v, alpha, schlick_k);
    // Unlit lanes have weight 0, and their denominator may be anything.
    const auto lit = hn::Gt(weight, zero);
    // Held within float's range: infinity times a lobe, or a colour, of 0 would be NaN.
    const FloatV visibility =
        hn::Min(hn::Div(weight, hn::IfThenElse(lit, denominator, one)), largest);
    const FloatV product = hn::Mul(GgxDistribution(d, angles, alpha), visibility);
    const FloatV lobe = hn::IfThenElseZero(lit, hn::Min(product, largest));
    const FloatV schlick = SchlickWeight(d, angles);
    const RgbV fresnel{FresnelSchlick(d, f0.r, schlick), FresnelSchlick(d, f0.g, schlick),
                       FresnelSchlick(d, f0.b, schlick)};
    const RgbV reflected{hn::Mul(hn::Mul(fresnel.r, specular.r), lobe),
                         hn::Mul(hn::Mul(fresnel.g, specular.g), lobe),
                         hn::Mul(hn::Mul(fresnel.b, specular.b), lobe)};
    const RgbV transmitted{hn::Sub(one, fresnel.r), hn::Sub(one, fresnel.g),
                           hn::Sub(one, fresnel.b)};
    const RgbV scattered{hn::Mul(hn::Mul(transmitted.r, diffuse.r), weight),
                         hn::Mul(hn::Mul(transmitted.g, diffuse.g), weight),
                         hn::Mul(hn::Mul(transmitted.b, diffuse.b), weight)};
    Accumulate(d, mask, scattered, i, &range.radiance->diffuse);
    Accumulate(d, mask, reflected, i, &range.radiance->specular);
  });
}

void ShadeMetallicRoughnessT(const MetallicRoughnessUniforms& uniforms, const ShadeRange& range) {
  switch (uniforms.shadowing) {
    case Shadowing::kHeightCorrelated:
      return ShadeMetallicRoughnessForm<Shadowing::kHeightCorrelated>(uniforms, range);
    case Shadowing::kSeparable:
      return ShadeMetallicRoughnessForm<Shadowing::kSeparable>(uniforms, range);
    case Shadowing::kSchlickDirect:
      return ShadeMetallicRoughnessForm<Shadowing::kSchlickDirect>(uniforms, range);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace nacre
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace nacre {
HWY_EXPORT(ShadeMetallicRoughnessT);
void ShadeMetallicRoughness(const MetallicRoughnessUniforms& uniforms, const ShadeRange& range) {
  HWY_DYNAMIC_DISPATCH(ShadeMetallicRoughnessT)(uniforms, range);
}
}  // namespace nacre
#endif
