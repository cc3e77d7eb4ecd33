// SPDX-License-Identifier: Apache-2.0
// tests/visibility/products_kernel.cc: the call behind products_kernel.h.
#include "visibility/products_kernel.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "visibility/products_kernel.cc"
#include "hwy/foreach_target.h"

#include "visibility/two_product-inl.h"

HWY_BEFORE_NAMESPACE();
namespace nacre {
namespace HWY_NAMESPACE {

template <class D>
HWY_INLINE double Difference(D d, double a, double b, double c, double e) {
  return hn::GetLane(
      AccurateDifference(d, hn::Set(d, a), hn::Set(d, b), hn::Set(d, c), hn::Set(d, e)));
}

Differences DifferencesT(double a, double b, double c, double e) {
  return {Difference(hn::ScalableTag<double>(), a, b, c, e),
          Difference(hn::CappedTag<double, 1>(), a, b, c, e)};
}

}  // namespace HWY_NAMESPACE
}  // namespace nacre
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace nacre {
HWY_EXPORT(DifferencesT);

Differences DifferencesOfProducts(double a, double b, double c, double e) {
  return HWY_DYNAMIC_DISPATCH(DifferencesT)(a, b, c, e);
}
}  // namespace nacre
#endif
