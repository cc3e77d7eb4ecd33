// SPDX-License-Identifier: Apache-2.0
// visibility/two_product.h: products without rounding error. SIMD twin: two_product-inl.h.
#pragma once

#include <cmath>

namespace nacre {

// a b = product + error exactly, barring overflow and underflow (Dekker 1971).
template <typename Real>
struct TwoProductResult {
  Real product;
  Real error;
};

template <typename Real>
TwoProductResult<Real> TwoProduct(Real a, Real b) {
  const Real product = a * b;
  return {product, std::fma(a, b, -product)};
}

// a b - c d with the sign of the exact value, 0 only if that is 0, and a relative error of a few
// roundings unless the two products agree to almost all their digits. Exactly negated when the
// products are exchanged.
template <typename Real>
Real DifferenceOfProducts(Real a, Real b, Real c, Real d) {
  // The rounded products compare as the exact ones do, or are equal: then the errors decide.
  const auto ab = TwoProduct(a, b);
  const auto cd = TwoProduct(c, d);
  return (ab.product - cd.product) + (ab.error - cd.error);
}

}  // namespace nacre
