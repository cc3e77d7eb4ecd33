// SPDX-License-Identifier: Apache-2.0
// brdf/anisotropic_albedo-inl.h: anisotropic directional albedos on SIMD vectors of floats or
// doubles. The lanes share one fit, or each has its own. Scalar twins:
// brdf/anisotropic_albedo_curve.h and brdf/anisotropic_albedo.h.
#if defined(NACRE_BRDF_ANISOTROPIC_ALBEDO_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef NACRE_BRDF_ANISOTROPIC_ALBEDO_INL_H_
#undef NACRE_BRDF_ANISOTROPIC_ALBEDO_INL_H_
#else
#define NACRE_BRDF_ANISOTROPIC_ALBEDO_INL_H_
#endif

#include <limits>

#include "brdf/albedo-inl.h"
#include "brdf/anisotropic_albedo.h"

HWY_BEFORE_NAMESPACE();
namespace nacre::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// An AnisotropicAlbedoFit for each lane, as structure of arrays.
struct AnisotropicAlbedoShapeLanes {
  const float *alpha_x, *alpha_y, *mean_square, *ratio_squared, *streak, *scale;
};
struct KappaPolynomialLanes {
  const float* first;
  size_t stride;  // from one coefficient to the next
};
template <size_t kTerms>
struct AlbedoPolynomialsLanes {
  const float* first;
  size_t stride;
  KappaPolynomialLanes operator[](size_t i) const {
    return {first + i * kKappaTerms * stride, stride};
  }
};
struct AnisotropicAlbedoFitLanes {
  AnisotropicAlbedoShapeLanes shape;
  AlbedoPolynomialsLanes<kShareTerms> loss, schlick;
  AlbedoPolynomialsLanes<kWidthTerms> streak;
};

// An AnisotropicFresnelCurve for each lane, all of one dielectric.
struct AnisotropicFresnelCurveLanes {
  AlbedoPolynomialsLanes<kShareTerms> wider;
  AlbedoPolynomialsLanes<kStreakTerms> streak;
  float bend;
};

template <class V>
struct AnisotropicAlbedoVariablesV {
  V z, share, width, n_dot_x, factor, rest;
};

template <class D, class Shape, class V = hn::Vec<D>>
HWY_INLINE AnisotropicAlbedoVariablesV<V> ComputeAlbedoVariables(D d, const Shape& shape, V n_dot_x,
                                                                 V t_dot_x, V b_dot_x) {
  const V one = hn::Set(d, 1.0f);
  const V tiny = hn::Set(d, std::numeric_limits<float>::min());
  const V length2 = hn::MulAdd(t_dot_x, t_dot_x, hn::Mul(b_dot_x, b_dot_x));
  const auto below = hn::Lt(n_dot_x, hn::Zero(d));
  const auto upright = hn::And(below, hn::Le(length2, tiny));
  const V lengthen =
      hn::IfThenElse(below, hn::Div(one, SquareRoot(d, hn::Max(length2, tiny))), one);
  t_dot_x = hn::IfThenElse(upright, one, hn::Mul(t_dot_x, lengthen));
  b_dot_x = hn::Mul(b_dot_x, lengthen);
  const V n = hn::Min(hn::Max(n_dot_x, hn::Set(d, static_cast<float>(kLeastAlbedoCosine))), one);
  const V n2 = hn::Mul(n, n);
  const V x = hn::Mul(AlbedoNumber(d, shape.alpha_x), t_dot_x);
  const V y = hn::Mul(AlbedoNumber(d, shape.alpha_y), b_dot_x);
  const V rho2 = hn::MulAdd(x, x, hn::Mul(y, y));
  const V normal2 = hn::Mul(AlbedoNumber(d, shape.mean_square), n2);
  const V k2 = hn::Max(hn::Add(rho2, normal2), tiny);
  const V k6 = hn::Mul(hn::Set(d, 6.0f), SquareRoot(d, k2));
  const V root = SquareRoot(d, hn::MulAdd(hn::Set(d, 36.0f), k2, n2));
  const V inverse = hn::Div(one, hn::Add(k6, root));
  const V layer = hn::Mul(hn::Add(k6, k6), inverse);
  const V z = hn::MulSub(AlbedoNumber(d, shape.scale), SquareRoot(d, hn::Mul(n, inverse)), one);
  const V share = hn::Div(hn::Abs(y), SquareRoot(d, hn::Max(rho2, tiny)));
  const V across2 = hn::MulAdd(AlbedoNumber(d, shape.ratio_squared), hn::Mul(b_dot_x, b_dot_x),
                               hn::Mul(t_dot_x, t_dot_x));
  const V width2 = hn::Min(hn::Add(n2, across2), one);
  const V factor = hn::Mul(hn::Mul(layer, layer), hn::Add(one, hn::Div(normal2, k2)));
  return {z,
          hn::Sub(hn::Add(share, share), one),
          SquareRoot(d, width2),
          n,
          factor,
          hn::NegMulAdd(AlbedoNumber(d, shape.streak), width2, one)};
}

template <class D>
HWY_INLINE hn::Vec<D> AlbedoCoefficient(D d, const KappaPolynomial& polynomial, size_t i) {
  return hn::Set(d, polynomial[i]);
}
template <class D>
HWY_INLINE hn::Vec<D> AlbedoCoefficient(D d, const KappaPolynomialLanes& polynomial, size_t i) {
  return AlbedoNumber(d, polynomial.first + i * polynomial.stride);
}

// A polynomial in z whose coefficients are polynomials in `other`.
template <size_t kTerms, class D, class Polynomials, class V = hn::Vec<D>>
HWY_INLINE V EvaluateAlbedoPolynomials(D d, const Polynomials& polynomials, V z, V other) {
  const auto row = [&](size_t i) HWY_ATTR {
    return EvaluateEvenOdd<kKappaTerms>(
        [&](size_t k) HWY_ATTR { return AlbedoCoefficient(d, polynomials[i], k); }, z);
  };
  V sum = row(kTerms - 1);
  for (size_t i = kTerms - 1; i != 0; --i) sum = hn::MulAdd(sum, other, row(i - 1));
  return sum;
}

// 1 - E.
template <class D, class Fit, class V = hn::Vec<D>>
HWY_INLINE V AlbedoLoss(D d, const Fit& fit, const AnisotropicAlbedoVariablesV<V>& x) {
  const V polynomial = EvaluateAlbedoPolynomials<kShareTerms>(d, fit.loss, x.z, x.share);
  return hn::Min(hn::Max(hn::Mul(x.factor, polynomial), hn::Zero(d)), hn::Set(d, 1.0f));
}

// B: the albedo for F = (1 - v.h)^5, from E.
template <class D, class Fit, class V = hn::Vec<D>>
HWY_INLINE V AlbedoSchlick(D d, const Fit& fit, V albedo_one,
                           const AnisotropicAlbedoVariablesV<V>& x) {
  const V one = hn::Set(d, 1.0f);
  const V wider = EvaluateAlbedoPolynomials<kShareTerms>(d, fit.schlick, x.z, x.share);
  const V streak = EvaluateAlbedoPolynomials<kWidthTerms>(d, fit.streak, x.z, x.width);
  const V more = hn::MulAdd(x.width, streak, hn::Mul(x.rest, wider));
  const V albedo = hn::MulAdd(Power5(hn::Sub(one, x.n_dot_x)), albedo_one, more);
  return hn::Min(hn::Max(albedo, hn::Zero(d)), one);
}

// The albedo for an exact Fresnel curve, from E and the curve's value at v.h = x.n_dot_x.
template <class D, class Curve, class V = hn::Vec<D>>
HWY_INLINE V AlbedoFresnel(D d, const Curve& curve, V albedo_one, V mirror,
                           const AnisotropicAlbedoVariablesV<V>& x) {
  const V one = hn::Set(d, 1.0f);
  const V bend = hn::Set(d, curve.bend);
  const V twice = hn::Set(d, 2 * (1 + hn::TFromD<D>{curve.bend}));
  const V u = hn::MulSub(twice, hn::Div(x.width, hn::Add(x.width, bend)), one);
  const V wider = EvaluateAlbedoPolynomials<kShareTerms>(d, curve.wider, x.z, x.share);
  const V streak = EvaluateAlbedoPolynomials<kStreakTerms>(d, curve.streak, x.z, u);
  const V added = hn::MulAdd(x.rest, wider, hn::Mul(x.width, streak));
  const V albedo = hn::MulAdd(mirror, albedo_one, added);
  return hn::Min(hn::Max(albedo, hn::Zero(d)), one);
}

}  // namespace nacre::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
