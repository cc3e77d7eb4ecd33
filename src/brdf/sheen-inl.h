// SPDX-License-Identifier: Apache-2.0
// brdf/sheen-inl.h: the sheen lobe on SIMD vectors of floats or doubles. The lanes share one
// roughness, or each has its own. Scalar twin: brdf/sheen.h.
#if defined(NACRE_BRDF_SHEEN_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef NACRE_BRDF_SHEEN_INL_H_
#undef NACRE_BRDF_SHEEN_INL_H_
#else
#define NACRE_BRDF_SHEEN_INL_H_
#endif

#include <cmath>
#include <limits>

#include "hwy/contrib/math/math-inl.h"

#include "brdf/angles-inl.h"
#include "brdf/sheen.h"

HWY_BEFORE_NAMESPACE();
namespace nacre::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// All lanes have the same roughness.
template <class D, class V = hn::Vec<D>>
HWY_INLINE Charlie<V> BroadcastCharlie(D d, const Charlie<double>& charlie) {
  using T = hn::TFromD<D>;
  const auto all = [&](double value) HWY_ATTR { return hn::Set(d, static_cast<T>(value)); };
  Charlie<V> lanes{all(charlie.roughness),
                   all(charlie.alpha),
                   all(charlie.a),
                   all(charlie.b),
                   all(charlie.c),
                   all(charlie.d),
                   all(charlie.e),
                   all(charlie.twice_middle),
                   all(charlie.typical_lambda),
                   {}};
  for (size_t i = 0; i < kCharlieTerms; ++i) lanes.albedo[i] = all(charlie.albedo[i]);
  return lanes;
}

// There is no sheen where IsDeltaLobe(alpha).
template <class D, class V = hn::Vec<D>>
HWY_INLINE hn::Mask<D> HasSheen(D d, const Charlie<V>& charlie) {
  return hn::Ge(charlie.alpha, hn::Set(d, hn::TFromD<D>(0x1p-40)));
}

template <class D, class V = hn::Vec<D>>
HWY_INLINE V CharlieDistribution(D d, const HalfAnglesV<V>& a, V alpha) {
  using T = hn::TFromD<D>;
  const V one = hn::Set(d, T(1));
  const auto present =
      hn::And(hn::Gt(a.n_dot_u, hn::Zero(d)), hn::Ge(alpha, hn::Set(d, T(0x1p-40))));
  const V inverse = hn::Div(one, hn::IfThenElse(present, alpha, one));
  // Half vectors along the normal, where the distribution is 0, must not give infinity.
  const V ratio = hn::Min(hn::Div(hn::Mul(a.n_dot_u, a.n_dot_u), a.nxu_squared),
                          hn::Set(d, std::numeric_limits<T>::max()));
  const V exponent = hn::Mul(hn::Mul(hn::Set(d, T(-0.5)), inverse), hn::Log1p(d, ratio));
  const V scale = hn::MulAdd(inverse, hn::Set(d, T(M_1_PI / 2)), hn::Set(d, T(M_1_PI)));
  return hn::IfThenElseZero(present, hn::Mul(scale, hn::Exp(d, exponent)));
}

// log(Lambda) at x <= 1/2.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V CharlieLogLambda(D d, const Charlie<V>& charlie, V x) {
  using T = hn::TFromD<D>;
  const V smallest = hn::Set(d, std::numeric_limits<T>::min());
  const V power = hn::IfThenElseZero(
      hn::Ge(x, smallest), hn::Exp(d, hn::Mul(charlie.c, hn::Log(d, hn::Max(x, smallest)))));
  const V below = hn::MulAdd(charlie.b, power, hn::Set(d, T(1)));
  return hn::Add(hn::Div(charlie.a, below), hn::MulAdd(charlie.d, x, charlie.e));
}

template <class D, class V = hn::Vec<D>>
HWY_INLINE V CharlieCosineLambda(D d, const Charlie<V>& charlie, V n_dot_x) {
  using T = hn::TFromD<D>;
  const V one = hn::Set(d, T(1));
  const V x = hn::Max(n_dot_x, hn::Set(d, static_cast<T>(kLeastCharlieCosine)));
  const auto near = hn::Lt(x, hn::Set(d, T(0.5)));
  const V log_lambda =
      CharlieLogLambda(d, charlie, hn::IfThenElse(near, x, hn::Max(hn::Sub(one, x), hn::Zero(d))));
  return hn::Mul(
      x, hn::Exp(d, hn::IfThenElse(near, log_lambda, hn::Sub(charlie.twice_middle, log_lambda))));
}

// V, for n.l > 0 and n.v >= 0.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V CharlieVisibility(D d, V n_dot_l, V n_dot_v, V cosine_lambda_l, V cosine_lambda_v) {
  using T = hn::TFromD<D>;
  const V sum =
      hn::MulAdd(n_dot_l, hn::Add(n_dot_v, cosine_lambda_v), hn::Mul(n_dot_v, cosine_lambda_l));
  return hn::Div(hn::Set(d, T(0.25)), sum);
}

// D V; 0 unless n.l > 0 and n.v >= 0.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V CharlieLobe(D d, const Charlie<V>& charlie, const AnglesV<V>& a) {
  const V zero = hn::Zero(d), one = hn::Set(d, hn::TFromD<D>(1));
  const auto above = hn::And(hn::Gt(a.n_dot_l, zero), hn::Ge(a.n_dot_v, zero));
  const V n_dot_l = hn::IfThenElse(above, a.n_dot_l, one);
  const V n_dot_v = hn::IfThenElse(above, a.n_dot_v, one);
  const V visibility =
      CharlieVisibility(d, n_dot_l, n_dot_v, CharlieCosineLambda(d, charlie, n_dot_l),
                        CharlieCosineLambda(d, charlie, n_dot_v));
  return hn::IfThenElseZero(above, hn::Mul(CharlieDistribution(d, a, charlie.alpha), visibility));
}

// E, from n.v and n.v Lambda(n.v).
template <class D, class V = hn::Vec<D>>
HWY_INLINE V CharlieAlbedo(D d, const Charlie<V>& charlie, V n_dot_v, V cosine_lambda_v) {
  using T = hn::TFromD<D>;
  const V one = hn::Set(d, T(1));
  const auto present = HasSheen(d, charlie);
  const V roughness = hn::IfThenElse(present, charlie.roughness, one);
  const V alpha = hn::IfThenElse(present, charlie.alpha, one);
  const V mu = hn::Min(hn::Max(n_dot_v, hn::Zero(d)), one);
  const V mu2 = hn::Mul(mu, mu);
  V series = hn::MulAdd(mu2, hn::Set(d, T(-0.125)), hn::Set(d, T(-0.0625)));
  series = hn::Mul(mu2, hn::MulAdd(mu2, series, hn::Set(d, T(-0.25))));
  const V exponent = hn::Div(hn::Mul(hn::Set(d, T(0.5)), hn::Log1p(d, series)), alpha);
  const V offset = hn::Mul(hn::Set(d, T(3)), roughness);
  const V u = hn::Div(hn::Mul(mu, hn::Add(one, offset)), hn::Add(mu, offset));
  const V x = hn::MulSub(hn::Set(d, T(2)), hn::Sqrt(u), one);
  V sum = charlie.albedo[kCharlieTerms - 1];
  for (int i = kCharlieTerms - 2; i >= 0; --i) sum = hn::MulAdd(sum, x, charlie.albedo[i]);
  const V cosines = hn::MulAdd(mu, charlie.typical_lambda, hn::Add(mu, cosine_lambda_v));
  const V albedo = hn::Div(hn::Mul(hn::Exp(d, exponent), sum), hn::Mul(roughness, cosines));
  return hn::IfThenElseZero(present, hn::Max(albedo, hn::Zero(d)));
}

template <class D, class V = hn::Vec<D>>
HWY_INLINE V CharlieAlbedo(D d, const Charlie<V>& charlie, V n_dot_v) {
  return CharlieAlbedo(d, charlie, n_dot_v, CharlieCosineLambda(d, charlie, n_dot_v));
}

// Each lane has its own roughness, in [0, 1].
template <class D, class V = hn::Vec<D>>
HWY_INLINE Charlie<V> MakeCharlie(D d, V roughness) {
  using T = hn::TFromD<D>;
  const V one = hn::Set(d, T(1));
  Charlie<V> charlie;
  charlie.roughness = roughness;
  charlie.alpha = hn::Mul(roughness, roughness);
  const V smooth = hn::Mul(hn::Sub(one, charlie.alpha), hn::Sub(one, charlie.alpha));
  const auto mix = [&](double rough_end, double smooth_end) HWY_ATTR {
    return hn::MulAdd(hn::Set(d, static_cast<T>(smooth_end - rough_end)), smooth,
                      hn::Set(d, static_cast<T>(rough_end)));
  };
  charlie.a = mix(21.5473, 25.3245);
  charlie.b = mix(3.82987, 3.32435);
  charlie.c = mix(0.19823, 0.16801);
  charlie.d = mix(-1.97760, -1.27393);
  charlie.e = mix(-4.32054, -4.85967);
  const V middle = CharlieLogLambda(d, charlie, hn::Set(d, T(0.5)));
  charlie.twice_middle = hn::Add(middle, middle);
  const auto present = HasSheen(d, charlie);
  const V typical = hn::IfThenElse(present, hn::Div(roughness, hn::Add(one, roughness)), one);
  charlie.typical_lambda = hn::IfThenElseZero(
      present, hn::Div(CharlieCosineLambda(d, charlie, typical), hn::Add(typical, typical)));
  const V y = hn::MulSub(hn::Set(d, T(2)), hn::Sqrt(hn::Sqrt(roughness)), one);
  for (int i = 0; i < kCharlieTerms; ++i) {
    V sum = hn::Set(d, static_cast<T>(kCharlieAlbedo[i][kCharlieTerms - 1]));
    for (int j = kCharlieTerms - 2; j >= 0; --j) {
      sum = hn::MulAdd(sum, y, hn::Set(d, static_cast<T>(kCharlieAlbedo[i][j])));
    }
    charlie.albedo[i] = hn::IfThenElseZero(present, sum);
  }
  return charlie;
}

template <class D, class V = hn::Vec<D>>
HWY_INLINE SheenScale<V> ScaleSheen(D d, V largest_channel, V albedo_v, V albedo_l) {
  const V one = hn::Set(d, hn::TFromD<D>(1));
  const V share = hn::Mul(largest_channel, hn::Max(albedo_v, albedo_l));
  return {hn::Div(one, hn::Max(share, one)), hn::Max(hn::Sub(one, share), hn::Zero(d))};
}

}  // namespace nacre::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
