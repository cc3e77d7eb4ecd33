// SPDX-License-Identifier: Apache-2.0
// color/srgb8-inl.h: 8-bit sRGB codes on SIMD vectors. Scalar twin: color/srgb8.h.
#if defined(NACRE_COLOR_SRGB8_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef NACRE_COLOR_SRGB8_INL_H_
#undef NACRE_COLOR_SRGB8_INL_H_
#else
#define NACRE_COLOR_SRGB8_INL_H_
#endif

#include "hwy/highway.h"

#include "color/srgb8.h"

HWY_BEFORE_NAMESPACE();
namespace nacre {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// The code, 0..255, of each lane of `linear`; `entries` is Srgb8Table's. NaN gives 0.
template <class D, class V = hn::Vec<D>, class VI = hn::Vec<hn::RebindToSigned<D>>>
HWY_INLINE VI Srgb8Codes(D d, V linear, const int32_t* HWY_RESTRICT entries) {
  const hn::RebindToSigned<D> di;
  const VI first_bits = hn::Set(di, static_cast<int32_t>(Srgb8Table::kFirstBits));
  const VI last_bits = hn::Set(di, static_cast<int32_t>(Srgb8Table::kLastBits));
  // Max returns its second operand where the first is NaN, so indices stay in the table.
  const V clamped = hn::Min(hn::Max(linear, hn::BitCast(d, first_bits)), hn::BitCast(d, last_bits));
  const VI offset = hn::Sub(hn::BitCast(di, clamped), first_bits);
  const VI entry = hn::GatherIndex(di, entries, hn::ShiftRight<16>(offset));
  return hn::ShiftRight<16>(hn::Add(entry, hn::And(offset, hn::Set(di, 0xffff))));
}

}  // namespace HWY_NAMESPACE
}  // namespace nacre
HWY_AFTER_NAMESPACE();
#endif
