// SPDX-License-Identifier: Apache-2.0
// image_io/half_kernel.cc: FloatToHalf and CountNonfinite of image_io/half.h.
//
// All targets use integer arithmetic. Highway's conversion to half truncates on targets without
// F16C; on those with it, the clamping and counting dominate the time anyway.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "image_io/half_kernel.cc"
#include "hwy/foreach_target.h"

#include <cstring>

#include "hwy/highway.h"

#include "image_io/half.h"

HWY_BEFORE_NAMESPACE();
namespace nacre {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Bit patterns of floats.
constexpr int32_t kInfinityBits = 0x7f800000;
constexpr int32_t kMaxHalfBits = 0x477fe000;          // 65504
constexpr int32_t kMinNormalHalfBits = 0x38800000;    // 2^-14
constexpr int32_t kHalfBits = 0x3f000000;             // 0.5
constexpr int32_t kQuietNanBits = 0x47c00000;         // 2^16 * 1.5: becomes 0x7e00 below
constexpr int32_t kExponentShift = (127 - 15) << 23;  // the difference between the exponent biases

template <class VI, class DI>
HWY_INLINE void CountNonfinitePacket(DI di, VI magnitude, SampleCounts* counts) {
  const VI infinity = hn::Set(di, kInfinityBits);
  counts->infinite += hn::CountTrue(di, hn::Eq(magnitude, infinity));
  counts->nan += hn::CountTrue(di, hn::Gt(magnitude, infinity));
}

template <class D>
HWY_INLINE void ConvertPacket(D d, const float* in, uint16_t* out, SampleCounts* counts) {
  const hn::RebindToSigned<D> di;
  const hn::Rebind<uint16_t, D> du16;
  const auto bits = hn::BitCast(di, hn::LoadU(d, in));
  const auto sign = hn::And(hn::ShiftRight<16>(bits), hn::Set(di, 0x8000));
  auto magnitude = hn::And(bits, hn::Set(di, 0x7fffffff));

  const auto max_half = hn::Set(di, kMaxHalfBits);
  const auto beyond = hn::Gt(magnitude, max_half);
  if (HWY_UNLIKELY(!hn::AllFalse(di, beyond))) {
    const auto finite = hn::Lt(magnitude, hn::Set(di, kInfinityBits));
    counts->clamped += hn::CountTrue(di, hn::And(beyond, finite));
    CountNonfinitePacket(di, magnitude, counts);
    const auto nan = hn::Gt(magnitude, hn::Set(di, kInfinityBits));
    magnitude = hn::IfThenElse(beyond, max_half, magnitude);
    magnitude = hn::IfThenElse(nan, hn::Set(di, kQuietNanBits), magnitude);
  }

  // Normal halves lose 13 bits. Adding just under half of the last kept place, and one more if that
  // place is odd, rounds to nearest even; a carry correctly increments the exponent.
  const auto odd = hn::And(hn::ShiftRight<13>(magnitude), hn::Set(di, 1));
  const auto rounding = hn::Set(di, 0xfff - kExponentShift);
  const auto normal = hn::ShiftRight<13>(hn::Add(hn::Add(magnitude, rounding), odd));
  // Denormal halves are multiples of 2^-24, which is the last place of floats in [1/2, 1): adding
  // 1/2 rounds to it.
  const auto sum = hn::Add(hn::BitCast(d, magnitude), hn::Set(d, 0.5f));
  const auto denormal = hn::Sub(hn::BitCast(di, sum), hn::Set(di, kHalfBits));

  const auto is_normal = hn::Gt(magnitude, hn::Set(di, kMinNormalHalfBits - 1));
  const auto half = hn::Or(hn::IfThenElse(is_normal, normal, denormal), sign);
  hn::StoreU(hn::DemoteTo(du16, half), du16, out);
}

SampleCounts FloatToHalfT(const float* HWY_RESTRICT in, size_t count, uint16_t* HWY_RESTRICT out) {
  const hn::ScalableTag<float> d;
  const size_t lanes = hn::Lanes(d);
  SampleCounts counts;
  size_t i = 0;
  for (; i + lanes <= count; i += lanes) ConvertPacket(d, in + i, out + i, &counts);
  // The caller's arrays are not padded, so the rest goes through a padded copy.
  const size_t rest = count - i;
  if (rest != 0) {
    float padded[HWY_MAX_BYTES / sizeof(float)] = {};
    uint16_t padded_out[HWY_MAX_BYTES / sizeof(float)];
    std::memcpy(padded, in + i, rest * sizeof(float));
    ConvertPacket(d, padded, padded_out, &counts);
    std::memcpy(out + i, padded_out, rest * sizeof(uint16_t));
  }
  return counts;
}

SampleCounts CountNonfiniteT(const float* HWY_RESTRICT in, size_t count) {
  const hn::ScalableTag<float> d;
  const hn::RebindToSigned<decltype(d)> di;
  const size_t lanes = hn::Lanes(d);
  SampleCounts counts;
  const auto count_packet = [&](const float* values) HWY_ATTR {
    const auto bits = hn::BitCast(di, hn::LoadU(d, values));
    const auto magnitude = hn::And(bits, hn::Set(di, 0x7fffffff));
    if (HWY_LIKELY(hn::AllTrue(di, hn::Lt(magnitude, hn::Set(di, kInfinityBits))))) return;
    CountNonfinitePacket(di, magnitude, &counts);
  };
  size_t i = 0;
  for (; i + lanes <= count; i += lanes) count_packet(in + i);
  const size_t rest = count - i;
  if (rest != 0) {
    float padded[HWY_MAX_BYTES / sizeof(float)] = {};
    std::memcpy(padded, in + i, rest * sizeof(float));
    count_packet(padded);
  }
  return counts;
}

}  // namespace HWY_NAMESPACE
}  // namespace nacre
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace nacre {
HWY_EXPORT(FloatToHalfT);
HWY_EXPORT(CountNonfiniteT);

SampleCounts FloatToHalf(const float* in, size_t count, uint16_t* out) {
  return HWY_DYNAMIC_DISPATCH(FloatToHalfT)(in, count, out);
}

SampleCounts CountNonfinite(const float* in, size_t count) {
  return HWY_DYNAMIC_DISPATCH(CountNonfiniteT)(in, count);
}
}  // namespace nacre
#endif
