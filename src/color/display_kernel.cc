// SPDX-License-Identifier: Apache-2.0
// color/display_kernel.cc: EncodeDisplay, ShowLight and DecodeSrgb of color/display.h.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "color/display_kernel.cc"
#include "hwy/foreach_target.h"

#include <cmath>
#include <cstring>

#include "hwy/highway.h"

#include "color/display.h"
#include "color/srgb8.h"
#include "color/tone-inl.h"
#include "color/transfer-inl.h"

HWY_BEFORE_NAMESPACE();
namespace nacre::HWY_NAMESPACE {

// Pixels are encoded in chunks by two loops. Tone operators have long dependency chains, and table
// look-ups many micro-operations; in one loop they would not overlap.
constexpr size_t kChunk = 128;
static_assert(kChunk % (HWY_MAX_BYTES / sizeof(float)) == 0);

struct Chunk {
  alignas(HWY_MAX_BYTES) float r[kChunk];
  alignas(HWY_MAX_BYTES) float g[kChunk];
  alignas(HWY_MAX_BYTES) float b[kChunk];
};

struct Planes {
  float *r, *g, *b;

  Planes operator+(size_t i) const { return {r + i, g + i, b + i}; }
};

// Stores the display light of a vector of pixels in `light`, which may alias the input. The planes
// may have any alignment. light.r becomes NaN where any channel of the pixel is NaN.
template <class D, class Tone>
HWY_INLINE void ToneVector(D d, const Tone& tone, float scale, const float* r, const float* g,
                           const float* b, const Planes& light) {
  using V = hn::Vec<D>;
  const V zero = hn::Zero(d);
  const V exposure = hn::Set(d, scale);
  V red = hn::LoadU(d, r);
  V green = hn::LoadU(d, g);
  V blue = hn::LoadU(d, b);
  const auto nan = hn::Or(hn::Or(hn::IsNaN(red), hn::IsNaN(green)), hn::IsNaN(blue));
  red = hn::Mul(hn::Max(red, zero), exposure);
  green = hn::Mul(hn::Max(green, zero), exposure);
  blue = hn::Mul(hn::Max(blue, zero), exposure);
  tone(d, red, green, blue);
  hn::StoreU(hn::IfThenElse(nan, hn::NaN(d), red), d, light.r);
  hn::StoreU(green, d, light.g);
  hn::StoreU(blue, d, light.b);
}

// Stores the display light of a chunk's pixels in `light`, as ToneVector does.
template <class D, class Tone>
HWY_INLINE void ToneChunk(D d, const Tone& tone, float scale, const float* r, const float* g,
                          const float* b, Chunk* light) {
  const Planes to = {light->r, light->g, light->b};
  for (size_t i = 0; i < kChunk; i += hn::Lanes(d)) {
    ToneVector(d, tone, scale, r + i, g + i, b + i, to + i);
  }
}

// SIMD twin of Srgb8 in color/srgb8.h: the code, 0..255, of each lane of `linear`; `entries` is
// Srgb8Table's. NaN gives 0.
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

// Encodes a chunk. Returns the number of pixels whose light.r is NaN.
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

// Calls work(tone, scale) with the tone operator and the factor that exposes the radiance.
template <class Work>
HWY_INLINE auto WithTone(const DisplaySettings& settings, const Work& work) {
  const float scale = static_cast<float>(std::exp2(settings.exposure_ev));
  switch (settings.tone) {
    case ToneOperator::kReinhard:
      return work(ReinhardTone(), scale);
    case ToneOperator::kReinhardExtended:
      return work(ReinhardExtendedTone{ReinhardExtendedCurve(settings.white)}, scale);
    case ToneOperator::kAces:
      return work(AcesTone(), scale);
    case ToneOperator::kAgx:
      return work(AgxTone(), scale);
    case ToneOperator::kNone:
      return work(NoneTone(), scale);
    case ToneOperator::kNeutral:
      break;
  }
  return work(NeutralTone(), scale);
}

size_t EncodeDisplayT(const DisplaySettings& settings, const float* r, const float* g,
                      const float* b, size_t count, uint8_t* rgb8) {
  return WithTone(settings, [&](const auto& tone, float scale) HWY_ATTR {
    return EncodePixels(tone, scale, r, g, b, count, rgb8);
  });
}

void ShowLightT(const DisplaySettings& settings, size_t count, float* r, float* g, float* b) {
  const hn::ScalableTag<float> d;
  WithTone(settings, [&](const auto& tone, float scale) HWY_ATTR {
    const size_t lanes = hn::Lanes(d);
    size_t i = 0;
    for (; i + lanes <= count; i += lanes) {
      ToneVector(d, tone, scale, r + i, g + i, b + i, {r + i, g + i, b + i});
    }
    if (i == count) return;
    float rest[3][HWY_MAX_BYTES / sizeof(float)] = {};
    float* const planes[] = {r, g, b};
    const size_t bytes = (count - i) * sizeof(float);
    for (size_t c = 0; c < 3; ++c) std::memcpy(rest[c], planes[c] + i, bytes);
    ToneVector(d, tone, scale, rest[0], rest[1], rest[2], {rest[0], rest[1], rest[2]});
    for (size_t c = 0; c < 3; ++c) std::memcpy(planes[c] + i, rest[c], bytes);
  });
}

void DecodeSrgbT(size_t count, float* values) {
  const hn::ScalableTag<float> d;
  const size_t lanes = hn::Lanes(d);
  const auto decode = [&](float* at) HWY_ATTR {
    const auto encoded = hn::Min(hn::Max(hn::LoadU(d, at), hn::Zero(d)), hn::Set(d, 1.0f));
    hn::StoreU(SrgbEotf(d, encoded), d, at);
  };
  size_t i = 0;
  for (; i + lanes <= count; i += lanes) decode(values + i);
  if (i == count) return;
  float rest[HWY_MAX_BYTES / sizeof(float)] = {};
  std::memcpy(rest, values + i, (count - i) * sizeof(float));
  decode(rest);
  std::memcpy(values + i, rest, (count - i) * sizeof(float));
}

}  // namespace nacre::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace nacre {
HWY_EXPORT(EncodeDisplayT);
HWY_EXPORT(ShowLightT);
HWY_EXPORT(DecodeSrgbT);

size_t EncodeDisplay(const DisplaySettings& settings, const float* r, const float* g,
                     const float* b, size_t count, uint8_t* rgb8) {
  return HWY_DYNAMIC_DISPATCH(EncodeDisplayT)(settings, r, g, b, count, rgb8);
}

void ShowLight(const DisplaySettings& settings, size_t count, float* r, float* g, float* b) {
  HWY_DYNAMIC_DISPATCH(ShowLightT)(settings, count, r, g, b);
}

void DecodeSrgb(size_t count, float* values) { HWY_DYNAMIC_DISPATCH(DecodeSrgbT)(count, values); }

}  // namespace nacre
#endif
