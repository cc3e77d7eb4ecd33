// SPDX-License-Identifier: Apache-2.0
// brdf/eon-inl.h: rough diffuse reflection on SIMD vectors. Scalar twin: brdf/eon.h.
#if defined(NACRE_BRDF_EON_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef NACRE_BRDF_EON_INL_H_
#undef NACRE_BRDF_EON_INL_H_
#else
#define NACRE_BRDF_EON_INL_H_
#endif

#include <cmath>
#include <limits>

#include "base/trig-inl.h"
#include "brdf/angles-inl.h"
#include "brdf/eon.h"

HWY_BEFORE_NAMESPACE();
namespace nacre::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

template <class D, class V = hn::Vec<D>>
HWY_INLINE V EonScale(D d, V roughness) {
  const V one = hn::Set(d, 1.0f);
  return hn::Div(one, hn::MulAdd(hn::Set(d, static_cast<float>(kEonAlbedo)), roughness, one));
}

template <class D, class V = hn::Vec<D>>
HWY_INLINE V EonLoss(D d, V cos) {
  const V one = hn::Set(d, 1.0f);
  const V sin2 = hn::Max(hn::Mul(hn::Sub(one, cos), hn::Add(one, cos)), hn::Zero(d));
  const V sin = hn::Sqrt(sin2);
  const V angle = Atan2Upper(d, sin, cos);
  const V one_plus_sin = hn::Add(one, sin);
  const V tangential =
      hn::Sub(hn::Div(hn::Mul(cos, hn::Add(one_plus_sin, sin2)), one_plus_sin), one);
  const V sum = hn::MulAdd(hn::Set(d, 2.0f / 3), tangential, hn::NegMulAdd(sin, cos, angle));
  const V g = hn::Mul(sin, sum);
  const V loss = hn::NegMulAdd(hn::Set(d, static_cast<float>(M_1_PI)), g,
                               hn::Set(d, static_cast<float>(kEonAlbedo)));
  return hn::Max(loss, hn::Zero(d));  // 0 at grazing angles, where rounding may make it negative
}

// pi times EonSingle. `scale` is EonScale(roughness). At least one of the cosines must be above 0;
// the lower limit keeps the quotient finite where the larger cosine is denormal.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V EonSingleSpread(D d, V n_dot_l, V n_dot_v, V l_dot_v, V roughness, V scale) {
  const V one = hn::Set(d, 1.0f);
  const V s = hn::NegMulAdd(n_dot_l, n_dot_v, l_dot_v);
  const auto forward = hn::Gt(s, hn::Zero(d));
  const V larger =
      hn::Max(hn::Max(n_dot_l, n_dot_v), hn::Set(d, std::numeric_limits<float>::min()));
  const V t = hn::IfThenElse(forward, larger, one);
  // Opposite directions at roughness 1 give 0, which rounding may make negative.
  return hn::Mul(scale, hn::Max(hn::MulAdd(roughness, hn::Div(s, t), one), hn::Zero(d)));
}

// pi times EonMultiple, from EonLoss of both cosines.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V EonMultipleSpread(D d, V loss_l, V loss_v, V roughness, V scale) {
  const V inverse_mean = hn::Set(d, static_cast<float>(1 / (kEonAlbedo - kEonMeanAlbedo)));
  return hn::Mul(hn::Mul(hn::Mul(scale, roughness), inverse_mean), hn::Mul(loss_l, loss_v));
}

template <class D, class V = hn::Vec<D>>
HWY_INLINE V EonMultipleAlbedo(D d, V albedo, V roughness, V scale) {
  const V one = hn::Set(d, 1.0f);
  const V mean =
      hn::Mul(scale, hn::MulAdd(hn::Set(d, static_cast<float>(kEonMeanAlbedo)), roughness, one));
  const V rest = hn::NegMulAdd(albedo, hn::Sub(one, mean), one);
  return hn::Div(hn::Mul(hn::Mul(albedo, albedo), mean), rest);
}

}  // namespace nacre::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
