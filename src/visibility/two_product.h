// SPDX-License-Identifier: Apache-2.0
// visibility/two_product.h: products without rounding error, and products that are fused with a sum
// or not, as on the active target. SIMD twin: two_product-inl.h.
#pragma once

#include <cmath>

#include "base/vec.h"

namespace nacre {

// Whether a target rounds a product before it is added to another number.
enum class Products {
  kFused,    // not rounded: targets with fused multiply-add
  kRounded,  // rounded: SSE4 and plain C++
};

// a b + c.
template <typename Real>
Real MulAdd(Real a, Real b, Real c, Products products) {
  return products == Products::kFused ? std::fma(a, b, c) : a * b + c;
}

// Scalar twin of FusedDot (base/vec3-inl.h).
template <typename Real>
Real Dot(const Imath::Vec3<Real>& a, const Imath::Vec3<Real>& b, Products products) {
  return MulAdd(a.z, b.z, MulAdd(a.y, b.y, a.x * b.x, products), products);
}

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

// a b - c d within 1.5 ulp where the target fuses (Kahan's algorithm; Jeannerod, Louvet and Muller
// 2013), else by DifferenceOfProducts: the rounding error of one product is computed and added.
template <typename Real>
Real AccurateDifference(Real a, Real b, Real c, Real d, Products products) {
  if (products == Products::kRounded) return DifferenceOfProducts(a, b, c, d);
  const Real product = c * d;
  return std::fma(a, b, -product) + std::fma(-c, d, product);
}

// a x b, each component by AccurateDifference.
template <typename Real>
Imath::Vec3<Real> AccurateCross(const Imath::Vec3<Real>& a, const Imath::Vec3<Real>& b,
                                Products products) {
  return {AccurateDifference(a.y, b.z, a.z, b.y, products),
          AccurateDifference(a.z, b.x, a.x, b.z, products),
          AccurateDifference(a.x, b.y, a.y, b.x, products)};
}

}  // namespace nacre
