// SPDX-License-Identifier: Apache-2.0
// base/power_of_two-inl.h: extracts the power of two in a number. Dividing by it is exact, and
// keeps products in the range of the floating-point format.
#if defined(NACRE_BASE_POWER_OF_TWO_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef NACRE_BASE_POWER_OF_TWO_INL_H_
#undef NACRE_BASE_POWER_OF_TWO_INL_H_
#else
#define NACRE_BASE_POWER_OF_TWO_INL_H_
#endif

#include <cstdint>
#include <type_traits>

#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace nacre {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

template <class V>
struct PowerOfTwoV {
  V power, inverse;
};

// For a normal v > 0: the power of two 2^e for which v / 2^e is in [1, 2), and 2^-e, which is 0 for
// the largest e. For v = 0, both are finite.
template <class D, class V = hn::Vec<D>>
HWY_INLINE PowerOfTwoV<V> PowerOfTwo(D d, V v) {
  using Bits = std::conditional_t<sizeof(hn::TFromD<D>) == 4, uint32_t, uint64_t>;
  constexpr Bits kExponent = static_cast<Bits>(sizeof(Bits) == 4 ? 0x7f800000 : 0x7ff0000000000000);
  constexpr Bits kTwiceOne = static_cast<Bits>(sizeof(Bits) == 4 ? 0x7f000000 : 0x7fe0000000000000);
  const hn::Rebind<Bits, D> bits;
  const auto exponent = hn::And(hn::BitCast(bits, v), hn::Set(bits, kExponent));
  return {hn::BitCast(d, exponent), hn::BitCast(d, hn::Sub(hn::Set(bits, kTwiceOne), exponent))};
}

}  // namespace HWY_NAMESPACE
}  // namespace nacre
HWY_AFTER_NAMESPACE();
#endif
