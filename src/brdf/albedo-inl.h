// brdf/albedo-inl.h: directional albedos on SIMD vectors, all lanes of one material. Scalar twins:
// brdf/albedo_curve.h and brdf/albedo.h.
#if defined(NACRE_BRDF_ALBEDO_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef NACRE_BRDF_ALBEDO_INL_H_
#undef NACRE_BRDF_ALBEDO_INL_H_
#else
#define NACRE_BRDF_ALBEDO_INL_H_
#endif

#include "brdf/albedo.h"
#include "brdf/fresnel-inl.h"

HWY_BEFORE_NAMESPACE();
namespace nacre {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// What the curves of one n.v share: evaluated once for all of them.
template <class V>
struct AlbedoVariablesV {
  V z, n_dot_v;
  V factor;  // of fit.one: of the loss for Smith's forms, of E for kSchlickDirect
};

template <class D, class V = hn::Vec<D>>
HWY_INLINE V AlbedoMasking(D d, const AlbedoShape& shape, V n_dot_v) {
  const V k = hn::Set(d, shape.k);
  const V one_minus_k = hn::Set(d, 1.0f - shape.k);
  const V y2 = hn::MulAdd(n_dot_v, n_dot_v, hn::Set(d, shape.softening));
  return hn::Div(
      y2, hn::Mul(hn::MulAdd(n_dot_v, one_minus_k, k), hn::MulAdd(hn::Sqrt(y2), one_minus_k, k)));
}

template <class D, class V = hn::Vec<D>>
HWY_INLINE AlbedoVariablesV<V> ComputeAlbedoVariables(D d, const AlbedoShape& shape, V n_dot_v) {
  const V one = hn::Set(d, 1.0f);
  const V least = hn::Set(d, static_cast<float>(kLeastAlbedoCosine));
  const V mu = hn::Min(hn::Max(n_dot_v, least), one);
  const V offset = hn::Set(d, shape.offset);
  const V root = hn::Sqrt(hn::MulAdd(mu, mu, hn::Mul(offset, offset)));
  const V inverse = hn::Div(one, hn::Add(offset, root));
  const V z = hn::MulSub(hn::Set(d, shape.scale), hn::Sqrt(hn::Mul(mu, inverse)), one);
  if (shape.k > 0) return {z, mu, AlbedoMasking(d, shape, mu)};
  const V layer = hn::Mul(hn::Add(offset, offset), inverse);
  return {z, mu, hn::Mul(hn::MulAdd(mu, mu, one), hn::Mul(layer, layer))};
}

template <class D, class V = hn::Vec<D>>
HWY_INLINE V EvaluateAlbedoPolynomial(D d, const AlbedoPolynomial& polynomial, V z) {
  V sum = hn::Set(d, polynomial[kAlbedoTerms - 1]);
  for (size_t i = kAlbedoTerms - 1; i-- > 0;) {
    sum = hn::MulAdd(sum, z, hn::Set(d, polynomial[i]));
  }
  return sum;
}

// 1 - E.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V AlbedoLoss(D d, const AlbedoFit& fit, const AlbedoVariablesV<V>& x) {
  const V product = hn::Mul(x.factor, EvaluateAlbedoPolynomial(d, fit.one, x.z));
  const V loss = fit.shape.k > 0 ? hn::Sub(hn::Set(d, 1.0f), product) : product;
  return hn::Max(loss, hn::Zero(d));
}

// E: the albedo for F = 1.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V AlbedoOne(D d, const AlbedoFit& fit, const AlbedoVariablesV<V>& x) {
  const V one = hn::Set(d, 1.0f);
  const V product = hn::Mul(x.factor, EvaluateAlbedoPolynomial(d, fit.one, x.z));
  if (fit.shape.k > 0) return hn::Min(product, one);
  return hn::Sub(one, hn::Max(product, hn::Zero(d)));
}

template <class D, class V = hn::Vec<D>>
HWY_INLINE V AlbedoNearMirror(D d, const AlbedoFit& fit, const AlbedoPolynomial& polynomial,
                              V mirror, V albedo_one, const AlbedoVariablesV<V>& x) {
  const V value = EvaluateAlbedoPolynomial(d, polynomial, x.z);
  const V wider = fit.shape.k > 0 ? hn::Mul(value, x.factor) : value;
  const V albedo = hn::MulAdd(mirror, albedo_one, wider);
  return hn::Min(hn::Max(albedo, hn::Zero(d)), hn::Set(d, 1.0f));
}

// B: the albedo for F = (1 - v.h)^5, from E.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V AlbedoSchlick(D d, const AlbedoFit& fit, V albedo_one, const AlbedoVariablesV<V>& x) {
  const V mirror = Power5(hn::Sub(hn::Set(d, 1.0f), x.n_dot_v));
  return AlbedoNearMirror(d, fit, fit.schlick, mirror, albedo_one, x);
}

// The albedo for the exact Fresnel curve of the fit's index, from E.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V AlbedoFresnel(D d, const FresnelAlbedoFit& fit, V albedo_one,
                           const AlbedoVariablesV<V>& x) {
  const V one_minus_mu = hn::Sub(hn::Set(d, 1.0f), x.n_dot_v);
  const V mirror = FresnelDielectric(d, x.n_dot_v, one_minus_mu, hn::Set(d, fit.eta));
  return AlbedoNearMirror(d, fit.lobe, fit.fresnel, mirror, albedo_one, x);
}

// The same from n.v alone, for callers of one of them.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V AlbedoOne(D d, const AlbedoFit& fit, V n_dot_v) {
  return AlbedoOne(d, fit, ComputeAlbedoVariables(d, fit.shape, n_dot_v));
}

template <class D, class V = hn::Vec<D>>
HWY_INLINE V AlbedoLoss(D d, const AlbedoFit& fit, V n_dot_v) {
  return AlbedoLoss(d, fit, ComputeAlbedoVariables(d, fit.shape, n_dot_v));
}

template <class D, class V = hn::Vec<D>>
HWY_INLINE V AlbedoSchlick(D d, const AlbedoFit& fit, V n_dot_v) {
  const AlbedoVariablesV<V> x = ComputeAlbedoVariables(d, fit.shape, n_dot_v);
  return AlbedoSchlick(d, fit, AlbedoOne(d, fit, x), x);
}

template <class D, class V = hn::Vec<D>>
HWY_INLINE V AlbedoFresnel(D d, const FresnelAlbedoFit& fit, V n_dot_v) {
  const AlbedoVariablesV<V> x = ComputeAlbedoVariables(d, fit.lobe.shape, n_dot_v);
  return AlbedoFresnel(d, fit, AlbedoOne(d, fit.lobe, x), x);
}

}  // namespace HWY_NAMESPACE
}  // namespace nacre
HWY_AFTER_NAMESPACE();
#endif
