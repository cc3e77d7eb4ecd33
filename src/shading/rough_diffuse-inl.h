// SPDX-License-Identifier: Apache-2.0
// shading/rough_diffuse-inl.h: the factors by which rough diffuse surfaces differ from Lambertian
// ones, for matte materials (matte_kernel.cc) and for bases under a lobe (rough_base_kernel.cc).
#if defined(NACRE_SHADING_ROUGH_DIFFUSE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef NACRE_SHADING_ROUGH_DIFFUSE_INL_H_
#undef NACRE_SHADING_ROUGH_DIFFUSE_INL_H_
#else
#define NACRE_SHADING_ROUGH_DIFFUSE_INL_H_
#endif

#include "brdf/burley-inl.h"
#include "brdf/eon-inl.h"
#include "shading/range-inl.h"

HWY_BEFORE_NAMESPACE();
namespace nacre {
namespace HWY_NAMESPACE {

// Lambertian reflection is multiplied by single + ratio multiple, where `ratio` is EonMultipleRatio
// of each channel's albedo.
struct SpreadV {
  FloatV single, multiple;
};

HWY_INLINE RgbV SpreadRgb(const SpreadV& spread, const RgbV& ratio) {
  return MulAdd3(ratio, spread.multiple, {spread.single, spread.single, spread.single});
}

// kForm is kOrenNayar or kBurley.
template <DiffuseForm kForm>
HWY_INLINE SpreadV RoughSpread(FloatTag d, const PacketV& p, const IncidentV& in,
                               FloatV roughness) {
  const FloatV n_dot_v = CosineToView(d, p);
  if constexpr (kForm == DiffuseForm::kOrenNayar) {
    const FloatV one = hn::Set(d, 1.0f);
    const FloatV scale = EonScale(d, roughness);
    const FloatV n_dot_l = hn::IfThenElse(IsLit(d, in.n_dot_l), in.n_dot_l, one);
    const Vec3V<FloatV> l_minus_v = in.toward.Minus(p.to_view);
    const FloatV l_dot_v = hn::NegMulAdd(hn::Set(d, 0.5f), FusedDot(l_minus_v, l_minus_v), one);
    return {EonSingleSpread(d, n_dot_l, n_dot_v, l_dot_v, roughness, scale),
            EonMultipleSpread(d, EonLoss(d, n_dot_l), EonLoss(d, n_dot_v), roughness, scale)};
  } else {
    const FloatV n_dot_l = hn::Max(in.n_dot_l, hn::Zero(d));
    const Vec3V<FloatV> u = in.toward.Plus(p.to_view);
    return {BurleySpread(d, FusedDot(u, u), BurleyGrazing(d, n_dot_l), BurleyGrazing(d, n_dot_v),
                         roughness),
            hn::Zero(d)};
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace nacre
HWY_AFTER_NAMESPACE();
#endif
