// brdf/burley-inl.h: Burley's diffuse term on SIMD vectors. Scalar twin: brdf/burley.h.
#if defined(NACRE_BRDF_BURLEY_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef NACRE_BRDF_BURLEY_INL_H_
#undef NACRE_BRDF_BURLEY_INL_H_
#else
#define NACRE_BRDF_BURLEY_INL_H_
#endif

#include "brdf/angles-inl.h"

HWY_BEFORE_NAMESPACE();
namespace nacre {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

template <class D, class V = hn::Vec<D>>
HWY_INLINE V BurleyGrazing(D d, V cos) {
  const V x = hn::Sub(hn::Set(d, hn::TFromD<D>(1)), cos);
  const V x2 = hn::Mul(x, x);
  return hn::Mul(hn::Mul(x2, x2), x);
}

template <class D, class V = hn::Vec<D>>
HWY_INLINE V BurleyDiffuse(D d, const AnglesV<V>& a, V roughness) {
  using T = hn::TFromD<D>;
  const V zero = hn::Zero(d);
  const V one = hn::Set(d, T(1));
  const V half = hn::Set(d, T(0.5));
  const auto above = hn::And(hn::Gt(a.n_dot_l, zero), hn::Gt(a.n_dot_v, zero));
  const V rise = hn::Mul(half, hn::MulSub(roughness, a.u_squared, one));
  const V product = hn::Mul(hn::MulAdd(rise, BurleyGrazing(d, a.n_dot_l), one),
                            hn::MulAdd(rise, BurleyGrazing(d, a.n_dot_v), one));
  return hn::IfThenElseZero(above, hn::Mul(product, hn::Set(d, T(0.31830988618379067))));
}

}  // namespace HWY_NAMESPACE
}  // namespace nacre
HWY_AFTER_NAMESPACE();
#endif
