// SPDX-License-Identifier: Apache-2.0
// image_io/zip_kernel.cc: SplitAndPredict of image_io/exr_chunk.h.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "image_io/zip_kernel.cc"
#include "hwy/foreach_target.h"

#include "hwy/highway.h"

#include "image_io/exr_chunk.h"

HWY_BEFORE_NAMESPACE();
namespace nacre {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

constexpr int kOffset = 128;

uint8_t Difference(int byte, int previous) {
  return static_cast<uint8_t>(byte - previous + kOffset);
}

void SplitAndPredictT(const uint16_t* HWY_RESTRICT words, size_t count,
                      uint8_t* HWY_RESTRICT bytes) {
  const hn::ScalableTag<int16_t> d;
  const hn::RebindToUnsigned<decltype(d)> du;
  const hn::Rebind<uint8_t, decltype(d)> du8;
  const size_t lanes = hn::Lanes(d);
  const auto offset = hn::Set(du, kOffset);
  const auto low_byte = hn::Set(du, 0xff);
  uint8_t* HWY_RESTRICT even = bytes;
  uint8_t* HWY_RESTRICT odd = bytes + count;

  even[0] = static_cast<uint8_t>(words[0] & 0xff);
  odd[0] = Difference(words[0] >> 8, words[count - 1] & 0xff);
  size_t i = 1;
  for (; i + lanes <= count; i += lanes) {
    const auto word = hn::LoadU(du, words + i);
    const auto previous = hn::LoadU(du, words + i - 1);
    // Differences modulo 2^8: bits above the low byte are dropped.
    const auto low = hn::Add(hn::Sub(word, previous), offset);
    const auto high =
        hn::Add(hn::Sub(hn::ShiftRight<8>(word), hn::ShiftRight<8>(previous)), offset);
    hn::StoreU(hn::DemoteTo(du8, hn::BitCast(d, hn::And(low, low_byte))), du8, even + i);
    hn::StoreU(hn::DemoteTo(du8, hn::BitCast(d, hn::And(high, low_byte))), du8, odd + i);
  }
  for (; i < count; ++i) {
    even[i] = Difference(words[i] & 0xff, words[i - 1] & 0xff);
    odd[i] = Difference(words[i] >> 8, words[i - 1] >> 8);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace nacre
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace nacre {
HWY_EXPORT(SplitAndPredictT);

void SplitAndPredict(const uint16_t* words, size_t count, uint8_t* bytes) {
  if (count != 0) HWY_DYNAMIC_DISPATCH(SplitAndPredictT)(words, count, bytes);
}
}  // namespace nacre
#endif
