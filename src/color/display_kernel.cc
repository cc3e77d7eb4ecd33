// SPDX-License-Identifier: Apache-2.0
// color/display_kernel.cc: EncodeDisplay of color/display.h.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "color/display_kernel.cc"
#include "hwy/foreach_target.h"

#include <cstring>

#include "hwy/highway.h"

#include "color/display.h"
#include "color/srgb8-inl.h"
#include "color/tone-inl.h"

HWY_BEFORE_NAMESPACE();
namespace nacre {
namespace HWY_NAMESPACE {

// Pixels are encoded in chunks by two loops. Tone operators have long dependency chains, and table
// look-ups many micro-operations; in one loop they would not overlap.
constexpr size_t kChunk = 128;
static_assert(kChunk % (HWY_MAX_BYTES / sizeof(float)) == 0);

struct Chunk {
  alignas(HWY_MAX_BYTES) float r[kChunk];
  alignas(HWY_MAX_BYTES) float g[kChunk];
  alignas(HWY_MAX_BYTES) float b[kChunk];
};

// Display light of a chunk's pixels into `light`; r is NaN where the pixel has any NaN. The planes
// may be those of `light` itself.
template <class D, class Tone>
HWY_INLINE void ToneChunk(D d, const Tone& tone, float scale, const float* r, const float* g,
                          const float* b, Chunk* light) {
  using V = hn::Vec<D>;
  const V zero = hn::Zero(d);
  const V exposure = hn::Set(d, scale);
  for (size_t i = 0; i < kChunk; i += hn::Lanes(d)) {
    V red = hn::LoadU(d, r + i);
    V green = hn::LoadU(d, g + i);
    V blue = hn::LoadU(d, b + i);
    const auto nan = hn::Or(hn::Or(hn::IsNaN(red), hn::IsNaN(green)), hn::IsNaN(blue));
    red = hn::Mul(hn::Max(red, zero), exposure);
    green = hn::Mul(hn::Max(green, zero), exposure);
    blue = hn::Mul(hn::Max(blue, zero), exposure);
    tone(d, red, green, blue);
    hn::Store(hn::IfThenElse(nan, hn::NaN(d), red), d, light->r + i);
    hn::Store(green, d, light->g + i);
    hn::Store(blue, d, light->b + i);
  }
}

// The codes of a chunk; returns how many pixels are NaN.
template <class D>
HWY_INLINE size_t EncodeChunk(D d, const int32_t* HWY_RESTRICT srgb8_entries, const Chunk& light,
                              uint8_t* HWY_RESTRICT rgb8) {
  const hn::RebindToSigned<D> di;
  const hn::Rebind<uint8_t, D> du8;
  const auto full = hn::Set(di, 255);
  size_t nan_count = 0;
  for (size_t i = 0; i < kChunk; i += hn::Lanes(d)) {
    const auto red = hn::Load(d, light.r + i);
    const auto nan = hn::IsNaN(red);
    const auto nan_codes = hn::RebindMask(di, nan);
    const auto r = Srgb8Codes(d, red, srgb8_entries);
    const auto g = Srgb8Codes(d, hn::Load(d, light.g + i), srgb8_entries);
    const auto b = Srgb8Codes(d, hn::Load(d, light.b + i), srgb8_entries);
    hn::StoreInterleaved3(hn::DemoteTo(du8, hn::IfThenElse(nan_codes, full, r)),
                          hn::DemoteTo(du8, hn::IfThenZeroElse(nan_codes, g)),
                          hn::DemoteTo(du8, hn::IfThenElse(nan_codes, full, b)), du8, rgb8 + 3 * i);
    nan_count += hn::CountTrue(d, nan);
  }
  return nan_count;
}

// Whether the chunk that begins at `plane` holds the bits of the chunk before it.
HWY_INLINE bool RepeatsChunk(const float* plane) {
  return std::memcmp(plane, plane - kChunk, kChunk * sizeof(float)) == 0;
}

template <class Tone>
HWY_INLINE size_t EncodePixels(const Tone& tone, float scale, const float* r, const float* g,
                               const float* b, size_t count, uint8_t* rgb8) {
  const hn::ScalableTag<float> d;
  const int32_t* entries = GetSrgb8Table().entries.data();
  Chunk light;
  size_t nan_count = 0, nan_in_chunk = 0;
  size_t i = 0;
  for (; i + kChunk <= count; i += kChunk) {
    // Early out: large parts of most pictures are a background of one colour.
    if (i > 0 && RepeatsChunk(r + i) && RepeatsChunk(g + i) && RepeatsChunk(b + i)) {
      std::memcpy(rgb8 + 3 * i, rgb8 + 3 * (i - kChunk), 3 * kChunk);
    } else {
      ToneChunk(d, tone, scale, r + i, g + i, b + i, &light);
      nan_in_chunk = EncodeChunk(d, entries, light, rgb8 + 3 * i);
    }
    nan_count += nan_in_chunk;
  }
  // The caller's planes have no padding: the remaining pixels are copied to padded arrays.
  const size_t remaining = count - i;
  if (remaining != 0) {
    light = {};
    std::memcpy(light.r, r + i, remaining * sizeof(float));
    std::memcpy(light.g, g + i, remaining * sizeof(float));
    std::memcpy(light.b, b + i, remaining * sizeof(float));
    ToneChunk(d, tone, scale, light.r, light.g, light.b, &light);
    uint8_t padded_rgb8[3 * kChunk];
    nan_count += EncodeChunk(d, entries, light, padded_rgb8);
    std::memcpy(rgb8 + 3 * i, padded_rgb8, 3 * remaining);
  }
  return nan_count;
}

size_t EncodeDisplayT(const DisplaySettings& settings, const float* r, const float* g,
                      const float* b, size_t count, uint8_t* rgb8) {
  const float scale = static_cast<float>(std::exp2(settings.exposure_ev));
  const auto encode = [&](const auto& tone)
                          HWY_ATTR { return EncodePixels(tone, scale, r, g, b, count, rgb8); };
  switch (settings.tone) {
    case ToneOperator::kNeutral:
      return encode(NeutralTone());
    case ToneOperator::kReinhard:
      return encode(ReinhardTone());
    case ToneOperator::kReinhardExtended:
      return encode(ReinhardExtendedTone(settings.white));
    case ToneOperator::kAces:
      return encode(AcesTone());
    case ToneOperator::kAgx:
      return encode(AgxTone());
    case ToneOperator::kNone:
      return encode(NoneTone());
  }
  return 0;
}

}  // namespace HWY_NAMESPACE
}  // namespace nacre
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace nacre {
HWY_EXPORT(EncodeDisplayT);
size_t EncodeDisplay(const DisplaySettings& settings, const float* r, const float* g,
                     const float* b, size_t count, uint8_t* rgb8) {
  return HWY_DYNAMIC_DISPATCH(EncodeDisplayT)(settings, r, g, b, count, rgb8);
}
}  // namespace nacre
#endif
