// SPDX-License-Identifier: Apache-2.0
// tests/visibility/products_kernel.h: visibility/two_product-inl.h, for tests.
#pragma once

namespace nacre {

// AccurateDifference of a b - c e on the active target, in the first lane of a full vector and in a
// vector of one lane.
struct Differences {
  double of_many, of_one;
};
Differences DifferencesOfProducts(double a, double b, double c, double e);

}  // namespace nacre
