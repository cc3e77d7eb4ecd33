// SPDX-License-Identifier: Apache-2.0
// color/transfer-inl.h: the sRGB transfer curves on SIMD vectors of floats. Scalar twins:
// color/transfer.h.
#if defined(NACRE_COLOR_TRANSFER_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef NACRE_COLOR_TRANSFER_INL_H_
#undef NACRE_COLOR_TRANSFER_INL_H_
#else
#define NACRE_COLOR_TRANSFER_INL_H_
#endif

#include "base/math-inl.h"

HWY_BEFORE_NAMESPACE();
namespace nacre::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Calls of Log2 and Exp2 are qualified: hwy/contrib/math has functions of the same names, which
// argument-dependent look-up would find, too.

// Maps linear light in [0, 1] to the encoded value, within 5e-7: Log2 and Exp2 of base/math-inl.h
// leave a relative error of 3e-7 in the power.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V SrgbOetf(D d, V linear) {
  const V power =
      HWY_NAMESPACE::Exp2(d, hn::Mul(HWY_NAMESPACE::Log2(d, hn::Max(linear, hn::Set(d, 1e-3f))),
                                     hn::Set(d, static_cast<float>(1 / 2.4))));
  return hn::IfThenElse(hn::Le(linear, hn::Set(d, 0.0031308f)), hn::Mul(linear, hn::Set(d, 12.92f)),
                        hn::MulSub(power, hn::Set(d, 1.055f), hn::Set(d, 0.055f)));
}

// Maps the encoded value in [0, 1] to linear light, within 6e-7.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V SrgbEotf(D d, V encoded) {
  const V base =
      hn::Mul(hn::Add(encoded, hn::Set(d, 0.055f)), hn::Set(d, static_cast<float>(1 / 1.055)));
  const V power = HWY_NAMESPACE::Exp2(d, hn::Mul(HWY_NAMESPACE::Log2(d, base), hn::Set(d, 2.4f)));
  return hn::IfThenElse(hn::Le(encoded, hn::Set(d, 0.04045f)),
                        hn::Mul(encoded, hn::Set(d, static_cast<float>(1 / 12.92))), power);
}

}  // namespace nacre::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
