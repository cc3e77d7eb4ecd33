// SPDX-License-Identifier: Apache-2.0
// brdf/fresnel-inl.h: Fresnel terms on SIMD vectors. Scalar twin: brdf/fresnel.h.
#if defined(NACRE_BRDF_FRESNEL_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef NACRE_BRDF_FRESNEL_INL_H_
#undef NACRE_BRDF_FRESNEL_INL_H_
#else
#define NACRE_BRDF_FRESNEL_INL_H_
#endif

#include "base/target_ops-inl.h"
#include "brdf/angles-inl.h"
#include "brdf/fresnel.h"

HWY_BEFORE_NAMESPACE();
namespace nacre::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// 1 - v.h, computed without cancellation, at most 1.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V OneMinusVDotH(D d, V lv_squared, V twice_u_length) {
  using T = hn::TFromD<D>;
  const V denominator = hn::Add(twice_u_length, hn::Set(d, T(4)));
  return hn::Min(hn::Mul(lv_squared, Reciprocal(d, denominator)), hn::Set(d, T(1)));
}

template <class D, class V = hn::Vec<D>>
HWY_INLINE V VDotH(D d, V twice_u_length) {
  return hn::Mul(twice_u_length, hn::Set(d, hn::TFromD<D>(0.25)));
}

template <class V>
HWY_INLINE V Power5(V x) {
  const V squared = hn::Mul(x, x);
  return hn::Mul(hn::Mul(squared, squared), x);
}

// (1 - v.h)^5 of Schlick 1994.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V SchlickWeight(D d, const AnglesV<V>& a) {
  const V twice_u_length = hn::Mul(hn::Set(d, hn::TFromD<D>(2)), hn::Sqrt(a.u_squared));
  return Power5(OneMinusVDotH(d, a.lv_squared, twice_u_length));
}

// F0 + (F90 - F0) weight.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V FresnelSchlick(D, V f0, V f90, V schlick_weight) {
  return hn::MulAdd(hn::Sub(f90, f0), schlick_weight, f0);
}

// Fresnel's equations of a dielectric, eta = n_t / n_i.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V FresnelDielectric(D d, V v_dot_h, V one_minus_vh, V eta) {
  const V one = hn::Set(d, hn::TFromD<D>(1));
  const V eta2 = hn::Mul(eta, eta);
  const V contrast = hn::Mul(hn::Sub(eta, one), hn::Add(eta, one));
  const V cos2 = hn::Mul(v_dot_h, v_dot_h);
  const V sin2 = hn::MulAdd(one_minus_vh, v_dot_h, one_minus_vh);
  const V g2 = hn::IfThenElse(hn::Lt(eta, one), hn::Sub(eta2, sin2), hn::Add(contrast, cos2));
  const auto partial = hn::Gt(g2, hn::Zero(d));
  const V g = hn::Sqrt(hn::IfThenElse(partial, g2, one));
  const V root_s = hn::Add(v_dot_h, g);
  const V root_p = hn::MulAdd(eta2, v_dot_h, g);
  const V s = hn::Div(contrast, hn::Mul(root_s, root_s));
  const V p =
      hn::Div(hn::Mul(contrast, hn::Sub(hn::Mul(eta2, cos2), sin2)), hn::Mul(root_p, root_p));
  const V mean = hn::Mul(hn::MulAdd(s, s, hn::Mul(p, p)), hn::Set(d, hn::TFromD<D>(0.5)));
  return hn::IfThenElse(partial, mean, one);
}

// The curve of a dielectric base of which a coat covers a fraction, the same for all lanes.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V FresnelCoatedDielectric(D d, V v_dot_h, V one_minus_vh,
                                     const CoatedDielectric<double>& base) {
  const auto set = [&](double number)
                       HWY_ATTR { return hn::Set(d, static_cast<hn::TFromD<D>>(number)); };
  const V one = set(1);
  const V in_air = FresnelDielectric(d, v_dot_h, one_minus_vh, set(base.eta));
  if (!(base.coat > 0)) return in_air;
  const V inverse2 = set(base.inverse_coat_eta * base.inverse_coat_eta);
  const V sin2 = hn::Mul(hn::MulAdd(one_minus_vh, v_dot_h, one_minus_vh), inverse2);
  const V cos = hn::Sqrt(hn::Max(hn::Sub(one, sin2), hn::Zero(d)));
  const V refracted =
      FresnelDielectric(d, cos, hn::Div(sin2, hn::Add(one, cos)), set(base.eta_in_coat));
  const V in_coat = hn::IfThenElseZero(hn::Lt(sin2, one), refracted);
  return hn::MulAdd(set(base.coat), hn::Sub(in_coat, in_air), in_air);
}

// Fresnel's equations of a conductor, eta + i k, from vacuum.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V FresnelConductor(D d, V v_dot_h, V one_minus_vh, V eta, V k) {
  using T = hn::TFromD<D>;
  const V half = hn::Set(d, T(0.5));
  const V sin2 = hn::MulAdd(one_minus_vh, v_dot_h, one_minus_vh);
  const V ab = hn::Mul(eta, k);
  const V difference = hn::Sub(hn::Mul(hn::Sub(eta, k), hn::Add(eta, k)), sin2);
  const V two_ab = hn::Add(ab, ab);
  const V sum = hn::Sqrt(hn::MulAdd(difference, difference, hn::Mul(two_ab, two_ab)));
  const V larger = hn::Mul(hn::Add(sum, hn::Abs(difference)), half);
  const auto some = hn::Gt(larger, hn::Zero(d));
  const V smaller = hn::IfThenElseZero(
      some, hn::Div(hn::Mul(ab, ab), hn::IfThenElse(some, larger, hn::Set(d, T(1)))));
  const auto dielectric = hn::Gt(difference, hn::Zero(d));
  const V a = hn::Sqrt(hn::IfThenElse(dielectric, larger, smaller));
  const V b2 = hn::IfThenElse(dielectric, smaller, larger);
  const V b2_cos2 = hn::Mul(b2, hn::Mul(v_dot_h, v_dot_h));
  const V a_cos = hn::Mul(a, v_dot_h);
  const auto squares = [](V x, V y2) HWY_ATTR { return hn::MulAdd(x, x, y2); };
  const V s_below = squares(hn::Add(a, v_dot_h), b2);
  const auto present = hn::Gt(s_below, hn::Zero(d));
  const V s =
      hn::Div(squares(hn::Sub(a, v_dot_h), b2), hn::IfThenElse(present, s_below, hn::Set(d, T(1))));
  const V p =
      hn::Div(squares(hn::Sub(a_cos, sin2), b2_cos2), squares(hn::Add(a_cos, sin2), b2_cos2));
  return hn::Mul(half, hn::MulAdd(s, p, s));
}

// Schlick's curve minus slope c (1 - c)^6, clamped to [0, 1]; `slope` is F82Slope's.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V FresnelF82(D d, V v_dot_h, V one_minus_vh, V f0, V slope) {
  const V one = hn::Set(d, hn::TFromD<D>(1));
  const V weight = Power5(one_minus_vh);
  const V dip = hn::Mul(hn::Mul(slope, v_dot_h), hn::Mul(one_minus_vh, weight));
  const V value = hn::Sub(FresnelSchlick(d, f0, one, weight), dip);
  return hn::Min(hn::Max(value, hn::Zero(d)), one);
}

}  // namespace nacre::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
