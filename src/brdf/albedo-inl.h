// SPDX-License-Identifier: Apache-2.0
// brdf/albedo-inl.h: directional albedos on SIMD vectors of floats or doubles. The lanes share one
// material, or each has its own roughness. Scalar twins: brdf/albedo_curve.h and brdf/albedo.h.
#if defined(NACRE_BRDF_ALBEDO_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef NACRE_BRDF_ALBEDO_INL_H_
#undef NACRE_BRDF_ALBEDO_INL_H_
#else
#define NACRE_BRDF_ALBEDO_INL_H_
#endif

#include "base/math-inl.h"
#include "brdf/albedo.h"
#include "brdf/fresnel-inl.h"

HWY_BEFORE_NAMESPACE();
namespace nacre::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// An AlbedoFit for each lane, as structure of arrays.
struct AlbedoShapeLanes {
  const float *offset, *scale, *k, *softening;
  AlbedoForm form;
};
struct AlbedoPolynomialLanes {
  const float* first;
  size_t stride;  // from one coefficient to the next
};
struct AlbedoFitLanes {
  AlbedoShapeLanes shape;
  AlbedoPolynomialLanes one, schlick;
};

template <class D>
HWY_INLINE hn::Vec<D> AlbedoNumber(D d, float number) {
  return hn::Set(d, number);
}
template <class D>
HWY_INLINE hn::Vec<D> AlbedoNumber(D d, const float* numbers) {
  if constexpr (sizeof(hn::TFromD<D>) == sizeof(double)) {
    return hn::PromoteTo(d, hn::LoadU(hn::Rebind<float, D>(), numbers));
  } else {
    return hn::LoadU(d, numbers);
  }
}
template <class D>
HWY_INLINE hn::Vec<D> AlbedoCoefficient(D d, const AlbedoPolynomial& polynomial, size_t i) {
  return hn::Set(d, polynomial[i]);
}
template <class D>
HWY_INLINE hn::Vec<D> AlbedoCoefficient(D d, const AlbedoPolynomialLanes& polynomial, size_t i) {
  return AlbedoNumber(d, polynomial.first + i * polynomial.stride);
}
template <class Shape>
HWY_INLINE bool HasMasking(const Shape& shape) {
  return shape.form == AlbedoForm::kMasked;
}

// The variables that all curves of one n.v share, computed once.
template <class V>
struct AlbedoVariablesV {
  V z, n_dot_v;
  V factor;  // AlbedoFactor
};

template <class D, class Shape, class V = hn::Vec<D>>
HWY_INLINE V AlbedoMasking(D d, const Shape& shape, V n_dot_v) {
  const V k = AlbedoNumber(d, shape.k);
  const V one_minus_k = hn::Sub(hn::Set(d, 1.0f), k);
  const V y2 = hn::MulAdd(n_dot_v, n_dot_v, AlbedoNumber(d, shape.softening));
  const V product =
      hn::Mul(hn::MulAdd(n_dot_v, one_minus_k, k), hn::MulAdd(SquareRoot(d, y2), one_minus_k, k));
  return hn::Mul(y2, Reciprocal(d, product));
}

template <class D, class Shape, class V = hn::Vec<D>>
HWY_INLINE AlbedoVariablesV<V> ComputeAlbedoVariables(D d, const Shape& shape, V n_dot_v) {
  const V one = hn::Set(d, 1.0f);
  const V least = hn::Set(d, static_cast<float>(kLeastAlbedoCosine));
  const V mu = hn::Min(hn::Max(n_dot_v, least), one);
  const V offset = AlbedoNumber(d, shape.offset);
  const V root = SquareRoot(d, hn::MulAdd(mu, mu, hn::Mul(offset, offset)));
  const V inverse = Reciprocal(d, hn::Add(offset, root));
  const V scale = AlbedoNumber(d, shape.scale);
  const V z = hn::MulSub(scale, SquareRoot(d, hn::Mul(mu, inverse)), one);
  // The branches compute a vector, not a struct: GCC would pass a struct through memory.
  V factor;
  if (HasMasking(shape)) {
    factor = AlbedoMasking(d, shape, mu);
  } else {
    const V layer = hn::Mul(hn::Add(offset, offset), inverse);
    factor = hn::Mul(hn::MulAdd(mu, mu, one), hn::Mul(layer, layer));
    if (shape.form == AlbedoForm::kLossLinear) {
      const V twelfth = hn::Set(d, static_cast<hn::TFromD<D>>(1.0 / 12));
      const V scaled = hn::Mul(layer, hn::MulAdd(offset, hn::Set(d, 0.25f), twelfth));
      factor = hn::Mul(layer, hn::Add(hn::Sub(one, mu), scaled));
    }
  }
  return {z, mu, factor};
}

template <class D, class Polynomial, class V = hn::Vec<D>>
HWY_INLINE V EvaluateAlbedoPolynomial(D d, const Polynomial& polynomial, V z) {
  return EvaluateEvenOdd<kAlbedoTerms>(
      [&](size_t i) HWY_ATTR { return AlbedoCoefficient(d, polynomial, i); }, z);
}

// 1 - E.
template <class D, class Fit, class V = hn::Vec<D>>
HWY_INLINE V AlbedoLoss(D d, const Fit& fit, const AlbedoVariablesV<V>& x) {
  const V product = hn::Mul(x.factor, EvaluateAlbedoPolynomial(d, fit.one, x.z));
  const V loss = HasMasking(fit.shape) ? hn::Sub(hn::Set(d, 1.0f), product) : product;
  return hn::Max(loss, hn::Zero(d));
}

// E: the albedo for F = 1.
template <class D, class Fit, class V = hn::Vec<D>>
HWY_INLINE V AlbedoOne(D d, const Fit& fit, const AlbedoVariablesV<V>& x) {
  const V one = hn::Set(d, 1.0f);
  const V product = hn::Mul(x.factor, EvaluateAlbedoPolynomial(d, fit.one, x.z));
  if (HasMasking(fit.shape)) return hn::Min(product, one);
  return hn::Sub(one, hn::Max(product, hn::Zero(d)));
}

template <class D, class Fit, class Polynomial, class V = hn::Vec<D>>
HWY_INLINE V AlbedoNearMirror(D d, const Fit& fit, const Polynomial& polynomial, V mirror,
                              V albedo_one, const AlbedoVariablesV<V>& x) {
  const V value = EvaluateAlbedoPolynomial(d, polynomial, x.z);
  const V wider = HasMasking(fit.shape) ? hn::Mul(value, x.factor) : value;
  const V albedo = hn::MulAdd(mirror, albedo_one, wider);
  return hn::Min(hn::Max(albedo, hn::Zero(d)), hn::Set(d, 1.0f));
}

// B: the albedo for F = (1 - v.h)^5, from E.
template <class D, class Fit, class V = hn::Vec<D>>
HWY_INLINE V AlbedoSchlick(D d, const Fit& fit, V albedo_one, const AlbedoVariablesV<V>& x) {
  const V mirror = Power5(hn::Sub(hn::Set(d, 1.0f), x.n_dot_v));
  return AlbedoNearMirror(d, fit, fit.schlick, mirror, albedo_one, x);
}

// The albedo for the exact Fresnel curve of the fit, from E.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V AlbedoFresnel(D d, const FresnelAlbedoFit& fit, V albedo_one,
                           const AlbedoVariablesV<V>& x) {
  const V one_minus_mu = hn::Sub(hn::Set(d, 1.0f), x.n_dot_v);
  const V mirror = FresnelCoatedDielectric(d, x.n_dot_v, one_minus_mu, fit.curve);
  return AlbedoNearMirror(d, fit.lobe, fit.fresnel, mirror, albedo_one, x);
}

}  // namespace nacre::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
