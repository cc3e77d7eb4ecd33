// SPDX-License-Identifier: Apache-2.0
// brdf/fuzz-inl.h: the fuzz lobe on SIMD vectors of floats or doubles. The lanes share one
// roughness, or each has its own. Scalar twin: brdf/fuzz.h.
#if defined(NACRE_BRDF_FUZZ_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef NACRE_BRDF_FUZZ_INL_H_
#undef NACRE_BRDF_FUZZ_INL_H_
#else
#define NACRE_BRDF_FUZZ_INL_H_
#endif

#include <cmath>

#include "hwy/contrib/math/math-inl.h"

#include "brdf/angles-inl.h"
#include "brdf/fuzz.h"

HWY_BEFORE_NAMESPACE();
namespace nacre::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// All lanes have the same roughness.
template <class D, class V = hn::Vec<D>>
HWY_INLINE Fuzz<V> BroadcastFuzz(D d, const Fuzz<double>& fuzz) {
  using T = hn::TFromD<D>;
  Fuzz<V> lanes;
  lanes.roughness = hn::Set(d, static_cast<T>(fuzz.roughness));
  lanes.offset = hn::Set(d, static_cast<T>(fuzz.offset));
  for (int i = 0; i < kFuzzTerms; ++i) {
    lanes.log_albedo[i] = hn::Set(d, static_cast<T>(fuzz.log_albedo[i]));
    lanes.log_a[i] = hn::Set(d, static_cast<T>(fuzz.log_a[i]));
    lanes.tilt[i] = hn::Set(d, static_cast<T>(fuzz.tilt[i]));
  }
  return lanes;
}

// Row i of the table is the coefficient of x^i.
template <class D, class V = hn::Vec<D>>
HWY_INLINE void FuzzPolynomial(D d, const FuzzTable& table, V y, V factor, V* polynomial) {
  using T = hn::TFromD<D>;
  for (int i = 0; i < kFuzzTerms; ++i) {
    V sum = hn::Set(d, static_cast<T>(table.terms[i][kFuzzTerms - 1]));
    for (int j = kFuzzTerms - 2; j >= 0; --j) {
      sum = hn::MulAdd(sum, y, hn::Set(d, static_cast<T>(table.terms[i][j])));
    }
    polynomial[i] = hn::Mul(factor, sum);
  }
}

// Each lane has its own roughness, in [0, 1].
template <class D, class V = hn::Vec<D>>
HWY_INLINE Fuzz<V> MakeFuzz(D d, V roughness) {
  using T = hn::TFromD<D>;
  const V one = hn::Set(d, T(1));
  Fuzz<V> fuzz;
  fuzz.roughness = hn::Max(roughness, hn::Set(d, static_cast<T>(kLeastFuzzRoughness)));
  const V fourth_root = hn::Sqrt(hn::Sqrt(fuzz.roughness));
  const V product = hn::Mul(fuzz.roughness, fourth_root);
  fuzz.offset = hn::Add(product, product);
  // 2 (fourth_root - least) / (1 - least) - 1.
  const double least = std::sqrt(std::sqrt(kLeastFuzzRoughness));
  const V y = hn::MulSub(fourth_root, hn::Set(d, static_cast<T>(2 / (1 - least))),
                         hn::Set(d, static_cast<T>((1 + least) / (1 - least))));
  FuzzPolynomial(d, kFuzzLogAlbedo, y, one, fuzz.log_albedo);
  FuzzPolynomial(d, kFuzzLogA, y, one, fuzz.log_a);
  FuzzPolynomial(d, kFuzzTilt, y, hn::Sub(one, fuzz.roughness), fuzz.tilt);
  return fuzz;
}

template <class D, class V = hn::Vec<D>>
HWY_INLINE FuzzView<V> FuzzFromView(D d, const Fuzz<V>& fuzz, V n_dot_v) {
  using T = hn::TFromD<D>;
  const V one = hn::Set(d, T(1));
  const V mu = hn::Min(hn::Max(n_dot_v, hn::Zero(d)), one);
  const V ratio = hn::Div(hn::MulAdd(mu, fuzz.offset, mu), hn::Add(mu, fuzz.offset));
  const V x = hn::MulSub(hn::Set(d, T(2)), hn::Sqrt(hn::Sqrt(ratio)), one);
  V log_albedo = fuzz.log_albedo[kFuzzTerms - 1];
  V log_a = fuzz.log_a[kFuzzTerms - 1];
  V tilt = fuzz.tilt[kFuzzTerms - 1];
  for (int i = kFuzzTerms - 2; i >= 0; --i) {
    log_albedo = hn::MulAdd(log_albedo, x, fuzz.log_albedo[i]);
    log_a = hn::MulAdd(log_a, x, fuzz.log_a[i]);
    tilt = hn::MulAdd(tilt, x, fuzz.tilt[i]);
  }
  return {hn::Min(hn::Exp(d, log_albedo), one), hn::Exp(d, log_a), tilt};
}

template <class D, class V = hn::Vec<D>>
HWY_INLINE V FuzzAlbedo(D d, const Fuzz<V>& fuzz, V n_dot_v) {
  return FuzzFromView(d, fuzz, n_dot_v).albedo;
}

template <class D, class V = hn::Vec<D>>
HWY_INLINE V FuzzDistribution(D d, const FuzzView<V>& view, const AnglesV<V>& a) {
  using T = hn::TFromD<D>;
  const V one = hn::Set(d, T(1));
  const V across = hn::NegMulAdd(a.n_dot_l, a.n_dot_v, LightDotView(d, a));
  const V sin2_l = hn::Mul(hn::Sub(one, a.n_dot_l), hn::Add(one, a.n_dot_l));
  const V sin2_v = hn::Mul(hn::Sub(one, a.n_dot_v), hn::Add(one, a.n_dot_v));
  const V mixed = hn::Mul(hn::Mul(hn::Add(view.tilt, view.tilt), across), a.n_dot_l);
  const V along = hn::MulAdd(hn::Mul(view.tilt, view.tilt), sin2_v, one);
  const V length2 = hn::MulAdd(view.a, hn::MulAdd(view.a, sin2_l, mixed),
                               hn::Mul(hn::Mul(along, a.n_dot_l), a.n_dot_l));
  const V ratio = hn::Div(view.a, length2);
  return hn::Mul(hn::Mul(ratio, ratio), hn::Set(d, static_cast<T>(M_1_PI)));
}

// The BRDF, without the colour; 0 unless n.l > 0.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V FuzzLobe(D d, const FuzzView<V>& view, const AnglesV<V>& a) {
  return hn::IfThenElseZero(hn::Gt(a.n_dot_l, hn::Zero(d)),
                            hn::Mul(view.albedo, FuzzDistribution(d, view, a)));
}

template <class D, class V = hn::Vec<D>>
HWY_INLINE V FuzzPdf(D d, const FuzzView<V>& view, const AnglesV<V>& a) {
  return hn::Mul(hn::Max(a.n_dot_l, hn::Zero(d)), FuzzDistribution(d, view, a));
}

}  // namespace nacre::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
