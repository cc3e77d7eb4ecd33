// SPDX-License-Identifier: Apache-2.0
// base/polynomial-inl.h: polynomials on float vectors.
#if defined(NACRE_BASE_POLYNOMIAL_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef NACRE_BASE_POLYNOMIAL_INL_H_
#undef NACRE_BASE_POLYNOMIAL_INL_H_
#else
#define NACRE_BASE_POLYNOMIAL_INL_H_
#endif

#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace nacre {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// The polynomial in x with these coefficients, lowest first, by Horner's rule.
template <class D, size_t kTerms, class V = hn::Vec<D>>
HWY_INLINE V EvaluatePolynomial(D d, const float (&coefficients)[kTerms], V x) {
  V p = hn::Set(d, coefficients[kTerms - 1]);
  for (size_t i = kTerms - 1; i != 0; --i) p = hn::MulAdd(p, x, hn::Set(d, coefficients[i - 1]));
  return p;
}

// A polynomial in x of kTerms terms, an even number; coefficient(i) is that of x^i. Even and odd
// powers are summed separately by Horner's rule: two chains of dependent operations, each half as
// long.
template <size_t kTerms, class V, class Coefficient>
HWY_INLINE V EvaluateEvenOdd(const Coefficient& coefficient, V x) {
  static_assert(kTerms % 2 == 0);
  const V x2 = hn::Mul(x, x);
  V last = coefficient(kTerms - 1), before = coefficient(kTerms - 2);
  for (size_t i = kTerms - 2; i != 0; i -= 2) {
    last = hn::MulAdd(last, x2, coefficient(i - 1));
    before = hn::MulAdd(before, x2, coefficient(i - 2));
  }
  return hn::MulAdd(last, x, before);
}

}  // namespace HWY_NAMESPACE
}  // namespace nacre
HWY_AFTER_NAMESPACE();
#endif
