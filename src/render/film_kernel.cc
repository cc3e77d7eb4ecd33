// SPDX-License-Identifier: Apache-2.0
// render/film_kernel.cc: the kernels of film_kernel.h.
#include "render/film_kernel.h"

#include <algorithm>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "render/film_kernel.cc"
#include "hwy/foreach_target.h"

#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace nacre {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using D = hn::ScalableTag<double>;
using V = hn::Vec<D>;
using F = hn::Rebind<float, D>;

void AddSamplesT(const double* values, const double* weights, int samples, size_t pixels,
                 double* sums) {
  const D d;
  for (size_t p = 0; p < pixels; p += hn::Lanes(d)) {
    V sum = hn::Load(d, sums + p);
    const double* value = values + p;
    for (int s = 0; s < samples; ++s, value += pixels) {
      sum = hn::Add(sum, hn::Mul(hn::Set(d, weights[s]), hn::LoadU(d, value)));
    }
    hn::Store(sum, d, sums + p);
  }
}

// One run of RoundSums.
HWY_INLINE void RoundRow(const double* sums, const double* coverage, const Resolution& by,
                         size_t width, float* out) {
  const D d;
  const V background = hn::Set(d, by.background);
  const V weight = hn::Set(d, by.weight);
  const V scale = hn::Set(d, by.scale);
  const auto rounded = [&](size_t i) HWY_ATTR {
    const V missed = hn::Sub(weight, hn::LoadU(d, coverage + i));
    const V sum = hn::Add(hn::LoadU(d, sums + i), hn::Mul(background, missed));
    return hn::DemoteTo(F(), hn::Mul(sum, scale));
  };
  size_t i = 0;
  for (; i + hn::Lanes(d) <= width; i += hn::Lanes(d)) hn::StoreU(rounded(i), F(), out + i);
  if (i < width) hn::BlendedStore(rounded(i), hn::FirstN(F(), width - i), F(), out + i);
}

void RoundSumsT(const double* sums, const double* coverage, const Resolution& by,
                std::span<const PixelRun> runs, const Window& tile, const PixelRows<float>& rows) {
  for (const PixelRun& run : runs) {
    const auto x = static_cast<size_t>(run.x - tile.x0), y = static_cast<size_t>(run.y - tile.y0);
    const auto width = static_cast<size_t>(run.count);
    RoundRow(sums, coverage, by, width, rows.first + y * rows.stride + x);
    sums += width;
    coverage += width;
  }
}

// Stores whole vectors: the compiler's own loop stores four floats at a time.
void FillPixelsT(float value, const PixelRows<float>& rows) {
  const hn::ScalableTag<float> d;
  const auto filled = hn::Set(d, value);
  float* row = rows.first;
  for (size_t y = 0; y < rows.height; ++y, row += rows.stride) {
    size_t i = 0;
    for (; i + hn::Lanes(d) <= rows.width; i += hn::Lanes(d)) hn::StoreU(filled, d, row + i);
    std::fill(row + i, row + rows.width, value);
  }
}

// The number of hits from `first` on, before `end`, that have consecutive rays. Rays ascend.
HWY_INLINE size_t CountConsecutive(const uint32_t* HWY_RESTRICT ray, size_t first, size_t end) {
  if (ray[end - 1] - ray[first] == end - 1 - first) return end - first;
  const hn::ScalableTag<uint32_t> d;
  const auto lane = hn::Iota(d, 0);
  for (size_t i = first;; i += hn::Lanes(d)) {  // the loop ends: there is a gap before `end`
    const auto next = hn::Add(lane, hn::Set(d, ray[first] + static_cast<uint32_t>(i - first)));
    const intptr_t other = hn::FindFirstTrue(d, hn::Ne(hn::LoadU(d, ray + i), next));
    if (other >= 0) return i + static_cast<size_t>(other) - first;
  }
}

void FindHitSpansT(const HitRays& hits, size_t pixels, size_t row, const double* weights,
                   std::vector<HitSpan>* spans) {
  spans->clear();
  size_t sample = 0;
  size_t row_end = row;
  for (size_t i = hits.begin; i < hits.end;) {
    const size_t ray = hits.ray[i];
    while (ray >= (sample + 1) * pixels) ++sample;
    while (ray >= row_end) row_end += row;  // faster than a division
    const size_t end = std::min(hits.end, i + (row_end - ray));
    const size_t count = CountConsecutive(hits.ray, i, end);
    spans->push_back({static_cast<uint32_t>(i), static_cast<uint32_t>(ray - sample * pixels),
                      static_cast<uint32_t>(count), weights[sample]});
    i += count;
  }
}

// Adds the values of hits to the sums of the spans' pixels, span by span, and all channels of a
// span at once, because many spans are short.
template <size_t kChannels>
struct ToSums {
  // Where all of a tile's pixels are hit, this many samples of them follow one another in a batch.
  // Their sums then stay in registers.
  static constexpr size_t kSamples = 8;
  double* const* sums;

  // value(c, i) is a vector of the values in channel c of the hits from i on.
  template <class Value>
  HWY_INLINE void operator()(std::span<const HitSpan> spans, const Value& value) const {
    const D d;
    while (!spans.empty()) {
      const HitSpan& span = spans[0];
      if (span.weight != 1) {
        const V weight = hn::Set(d, span.weight);
        Add<1>(spans, [weight, value](size_t c, size_t i)
                          HWY_ATTR { return hn::Mul(weight, value(c, i)); });
        spans = spans.subspan(1);
      } else if (AreSamePixels(spans)) {  // weights are all 1 if the filter has no negative lobes
        Add<kSamples>(spans, value);
        spans = spans.subspan(kSamples);
      } else {
        Add<1>(spans, value);
        spans = spans.subspan(1);
      }
    }
  }

  // Whether the first kSamples spans are samples of the same pixels, with the same weight.
  static HWY_INLINE bool AreSamePixels(std::span<const HitSpan> spans) {
    if (spans.size() < kSamples) return false;
    for (size_t k = 1; k < kSamples; ++k) {
      if (spans[k].pixel != spans[0].pixel || spans[k].count != spans[0].count ||
          spans[k].weight != spans[0].weight) {
        return false;
      }
    }
    return true;
  }

  // `weighted` is a copy, and so are the numbers of the spans: the compiler must assume that stores
  // to the sums change anything that it has a reference to.
  template <size_t kSpans, class Weighted>
  HWY_INLINE void Add(std::span<const HitSpan> spans, Weighted weighted) const {
    const D d;
    const size_t count = spans[0].count;
    double* to[kChannels];
    for (size_t c = 0; c < kChannels; ++c) to[c] = sums[c] + spans[0].pixel;
    size_t hit[kSpans];
    for (size_t k = 0; k < kSpans; ++k) hit[k] = spans[k].hit;
    const auto sum_at = [&](size_t c, size_t i) HWY_ATTR {
      V sum = hn::LoadU(d, to[c] + i);
      for (size_t k = 0; k < kSpans; ++k) sum = hn::Add(sum, weighted(c, hit[k] + i));
      return sum;
    };
    size_t i = 0;
    for (; i + hn::Lanes(d) <= count; i += hn::Lanes(d)) {
      for (size_t c = 0; c < kChannels; ++c) hn::StoreU(sum_at(c, i), d, to[c] + i);
    }
    if (i == count) return;
    const auto rest = hn::FirstN(d, count - i);
    for (size_t c = 0; c < kChannels; ++c) hn::BlendedStore(sum_at(c, i), rest, d, to[c] + i);
  }
};

// Writes the values of hits to the spans' pixels, all channels of a vector at a time, because many
// spans are short, and each channel's own loop would have an end of its own.
template <size_t kChannels>
struct ToRows {
  const PixelRows<float>* rows;

  template <class Value>
  HWY_INLINE void operator()(std::span<const HitSpan> spans, const Value& value) const {
    const D d;
    const F f;
    for (const HitSpan& span : spans) {
      const size_t y = span.pixel / rows[0].width, x = span.pixel % rows[0].width;
      float* to[kChannels];
      for (size_t c = 0; c < kChannels; ++c) to[c] = rows[c].first + y * rows[c].stride + x;
      const auto rounded = [f, value, hit = span.hit](size_t c, size_t i)
                               HWY_ATTR { return hn::DemoteTo(f, value(c, hit + i)); };
      const size_t count = span.count;
      size_t i = 0;
      for (; i + hn::Lanes(d) <= count; i += hn::Lanes(d)) {
        for (size_t c = 0; c < kChannels; ++c) hn::StoreU(rounded(c, i), f, to[c] + i);
      }
      if (i == count) continue;
      const auto rest = hn::FirstN(f, count - i);
      for (size_t c = 0; c < kChannels; ++c) hn::BlendedStore(rounded(c, i), rest, f, to[c] + i);
    }
  }
};

// The fourth channel is coverage.
template <size_t kChannels>
inline constexpr size_t kColorsOf = std::min<size_t>(kChannels, 3);

// The values of hits, as vectors. No value is -0, because sums that begin with 0 never are.
template <size_t kChannels, bool kHasConstant2>
struct ValuesV {
  static constexpr size_t kColors = kColorsOf<kChannels>;
  const float* from[kColors];
  V constant[kColors], constant2[kColors];

  explicit HWY_INLINE ValuesV(const HitValues& values) {
    const D d;
    for (size_t c = 0; c < kColors; ++c) {
      from[c] = values.values[c];
      // Adding 0 turns a constant of -0 into 0.
      constant[c] = hn::Add(hn::Zero(d), hn::Set(d, values.constant[c]));
      constant2[c] = hn::Set(d, values.constant2[c]);
    }
  }

  HWY_INLINE V operator()(size_t c, size_t i) const {
    const D d;
    if (c >= kColors) return hn::Set(d, 1.0);
    const V sum = hn::Add(hn::PromoteTo(d, hn::LoadU(F(), from[c] + i)), constant[c]);
    return kHasConstant2 ? hn::Add(sum, constant2[c]) : sum;
  }
};

template <size_t kChannels, class To>
HWY_INLINE void WriteChannels(const HitValues& values, std::span<const HitSpan> spans,
                              const To& to) {
  bool has_constant2 = false;
  constexpr size_t kColors = kColorsOf<kChannels>;
  for (size_t c = 0; c < kColors; ++c) has_constant2 = has_constant2 || values.constant2[c] != 0;
  if (values.values[0] == nullptr) {
    const D d;
    V both[kChannels];
    for (size_t c = 0; c < kChannels; ++c) {
      both[c] = hn::Set(d, c < kColors ? 0.0 + values.constant[c] + values.constant2[c] : 1.0);
    }
    to(spans, [both](size_t c, size_t) HWY_ATTR { return both[c]; });
  } else {
    if (has_constant2) return to(spans, ValuesV<kChannels, true>(values));
    to(spans, ValuesV<kChannels, false>(values));
  }
}

void AddHitsT(const HitValues& values, std::span<const HitSpan> spans, double* const* sums) {
  if (values.channels == 1) return WriteChannels<1>(values, spans, ToSums<1>{sums});
  if (values.channels == 3) return WriteChannels<3>(values, spans, ToSums<3>{sums});
  WriteChannels<4>(values, spans, ToSums<4>{sums});
}

void StoreHitsT(const HitValues& values, std::span<const HitSpan> spans,
                const PixelRows<float>* rows) {
  if (values.channels == 1) return WriteChannels<1>(values, spans, ToRows<1>{rows});
  if (values.channels == 3) return WriteChannels<3>(values, spans, ToRows<3>{rows});
  WriteChannels<4>(values, spans, ToRows<4>{rows});
}

HWY_INLINE V LoadDouble(const float* from, size_t i) {
  return hn::PromoteTo(D(), hn::LoadU(F(), from + i));
}

void AddFloatsT(const float* from, double constant, double constant2, size_t begin, size_t end,
                double* to) {
  const D d;
  const V first = hn::Set(d, constant);
  const V second = hn::Set(d, constant2);
  for (size_t i = begin; i < end; i += hn::Lanes(d)) {
    hn::StoreU(hn::Add(hn::Add(LoadDouble(from, i), first), second), d, to + i);
  }
}

void AddFloatsByHitT(const FloatsToAdd& floats, size_t begin, size_t end, double* to) {
  const D d;
  for (size_t i = begin; i < end; i += hn::Lanes(d)) {
    const V sum = hn::Add(LoadDouble(floats.from, i), LoadDouble(floats.constant, i));
    hn::StoreU(hn::Add(sum, LoadDouble(floats.constant2, i)), d, to + i);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace nacre
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace nacre {
HWY_EXPORT(AddSamplesT);
HWY_EXPORT(FindHitSpansT);
HWY_EXPORT(AddHitsT);
HWY_EXPORT(StoreHitsT);
HWY_EXPORT(RoundSumsT);
HWY_EXPORT(FillPixelsT);
HWY_EXPORT(AddFloatsT);
HWY_EXPORT(AddFloatsByHitT);

void AddSamples(const double* values, const double* weights, int samples, size_t pixels,
                double* sums) {
  HWY_DYNAMIC_DISPATCH(AddSamplesT)(values, weights, samples, pixels, sums);
}

void FindHitSpans(const HitRays& hits, size_t pixels, size_t row, const double* weights,
                  std::vector<HitSpan>* spans) {
  HWY_DYNAMIC_DISPATCH(FindHitSpansT)(hits, pixels, row, weights, spans);
}

void AddHits(const HitValues& values, std::span<const HitSpan> spans, double* const* sums) {
  HWY_DYNAMIC_DISPATCH(AddHitsT)(values, spans, sums);
}

void StoreHits(const HitValues& values, std::span<const HitSpan> spans,
               const PixelRows<float>* rows) {
  HWY_DYNAMIC_DISPATCH(StoreHitsT)(values, spans, rows);
}

void RoundSums(const double* sums, const double* coverage, const Resolution& by,
               std::span<const PixelRun> runs, const Window& tile, const PixelRows<float>& rows) {
  HWY_DYNAMIC_DISPATCH(RoundSumsT)(sums, coverage, by, runs, tile, rows);
}

void FillPixels(float value, const PixelRows<float>& rows) {
  HWY_DYNAMIC_DISPATCH(FillPixelsT)(value, rows);
}

void AddFloats(const float* from, double constant, double constant2, size_t begin, size_t end,
               double* to) {
  HWY_DYNAMIC_DISPATCH(AddFloatsT)(from, constant, constant2, begin, end, to);
}

void AddFloats(const FloatsToAdd& floats, size_t begin, size_t end, double* to) {
  HWY_DYNAMIC_DISPATCH(AddFloatsByHitT)(floats, begin, end, to);
}
}  // namespace nacre
#endif
