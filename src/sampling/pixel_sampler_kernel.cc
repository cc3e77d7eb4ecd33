// SPDX-License-Identifier: Apache-2.0
// sampling/pixel_sampler_kernel.cc: SamplePixels of sampling/pixel_sampler.h. Scalar twin:
// SamplePixel. Products and sums are never fused, so that both agree to the bit on every target.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "sampling/pixel_sampler_kernel.cc"
#include "hwy/foreach_target.h"

#include <algorithm>

#include "hwy/highway.h"

#include "sampling/hash.h"
#include "sampling/pixel_sampler.h"

HWY_BEFORE_NAMESPACE();
namespace nacre {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using D = hn::ScalableTag<double>;
using V = hn::Vec<D>;
using DU32 = hn::Rebind<uint32_t, D>;
using VU32 = hn::Vec<DU32>;

// With its top bit flipped a number without sign is, as one with a sign, lower by 2^31.
inline constexpr uint32_t kTopBit = 0x80000000u;

// 2^32 (u - 1/2), exactly, where u is UnitFromBits of the bits before their top one was flipped.
HWY_INLINE V CenteredFromFlipped(VU32 flipped) {
  const hn::Rebind<int32_t, D> di32;
  return hn::PromoteTo(D(), hn::BitCast(di32, flipped));
}

// u of that.
HWY_INLINE V UnitFromCentered(V centered) {
  const D d;
  return hn::Add(hn::Mul(centered, hn::Set(d, 0x1p-32)), hn::Set(d, 0.5));
}

// SampleDistance of pixel_filter.cc.
HWY_INLINE V Distance(const double* HWY_RESTRICT quantiles, V u) {
  const D d;
  const hn::Rebind<int32_t, D> di32;
  const V one = hn::Set(d, 1.0);
  const V side = hn::Sub(hn::Add(u, u), one);
  const V rest = hn::Sub(one, hn::Abs(side));
  const V position = hn::Mul(hn::Sub(one, hn::Sqrt(rest)), hn::Set(d, double{kQuantileSteps}));
  const auto step = hn::DemoteTo(di32, hn::Min(position, hn::Set(d, kQuantileSteps - 1.0)));
  const V fraction = hn::Sub(position, hn::PromoteTo(d, step));
  const auto i = hn::PromoteTo(hn::RebindToSigned<D>(), step);
  const V low = hn::GatherIndex(d, quantiles, i);
  const V high = hn::GatherIndex(d, quantiles + 1, i);
  const V distance = hn::Add(low, hn::Mul(fraction, hn::Sub(high, low)));
  return hn::IfThenElse(hn::Lt(side, hn::Zero(d)), hn::Neg(distance), distance);
}

// The only sample of a pixel.
struct Center {
  HWY_INLINE void operator()(V, V, V* dx, V* dy) const {
    *dx = hn::Zero(D());
    *dy = hn::Zero(D());
  }
};

struct Box {
  double scale;  // the box's width / 2^32
  HWY_INLINE void operator()(V centered_x, V centered_y, V* dx, V* dy) const {
    *dx = hn::Mul(centered_x, hn::Set(D(), scale));
    *dy = hn::Mul(centered_y, hn::Set(D(), scale));
  }
};

// A filter without negative values.
struct Positive {
  const double* quantiles;
  HWY_INLINE void operator()(V centered_x, V centered_y, V* dx, V* dy) const {
    *dx = Distance(quantiles, UnitFromCentered(centered_x));
    *dy = Distance(quantiles, UnitFromCentered(centered_y));
  }
};

// A part of a filter with both signs.
struct Signed {
  const double* first_x;
  const double* second_x;
  const double* first_y;
  const double* second_y;
  double first_share;
  HWY_INLINE void operator()(V centered_x, V centered_y, V* dx, V* dy) const {
    const D d;
    const V u = UnitFromCentered(centered_x);
    const V v = UnitFromCentered(centered_y);
    const V share = hn::Set(d, first_share);
    const auto first = hn::Lt(u, share);
    const V first_u = hn::Div(u, share);
    const V second_u = hn::Div(hn::Sub(u, share), hn::Set(d, 1 - first_share));
    // Lanes of the other kind look up something harmless, inside the table.
    const V zero = hn::Zero(d);
    *dx = hn::IfThenElse(first, Distance(first_x, hn::IfThenElse(first, first_u, zero)),
                         Distance(second_x, hn::IfThenElse(first, zero, second_u)));
    *dy = hn::IfThenElse(first, Distance(first_y, v), Distance(second_y, v));
  }
};

// One sample of each pixel. Whole vectors are stored: what lies past a row is overwritten by the
// next one, or is the caller's padding.
template <class Filter>
HWY_INLINE void SamplePlane(const Filter& filter, const PixelSampler& sampler, int index,
                            const Window& pixels, const PixelShifts& shifts,
                            double* HWY_RESTRICT film_x, double* HWY_RESTRICT film_y) {
  const D d;
  const DU32 du32;
  const VU32 point_x = hn::Set(du32, sampler.points_x[static_cast<size_t>(index)] ^ kTopBit);
  const VU32 point_y = hn::Set(du32, sampler.points_y[static_cast<size_t>(index)] ^ kTopBit);
  const uint32_t* HWY_RESTRICT const shift_x = shifts.x.data();
  const uint32_t* HWY_RESTRICT const shift_y = shifts.y.data();
  const auto width = static_cast<size_t>(pixels.width());
  const V first_column = hn::Iota(d, pixels.x0 + 0.5);
  const V step = hn::Set(d, static_cast<double>(hn::Lanes(d)));
  size_t row = 0;
  for (int y = pixels.y0; y < pixels.y1; ++y, row += width) {
    const V center_y = hn::Set(d, y + 0.5);
    V center_x = first_column;
    for (size_t i = row; i < row + width; i += hn::Lanes(d)) {
      V dx, dy;
      filter(CenteredFromFlipped(hn::Xor(point_x, hn::LoadU(du32, shift_x + i))),
             CenteredFromFlipped(hn::Xor(point_y, hn::LoadU(du32, shift_y + i))), &dx, &dy);
      hn::StoreU(hn::Add(center_x, dx), d, film_x + i);
      hn::StoreU(hn::Add(center_y, dy), d, film_y + i);
      center_x = hn::Add(center_x, step);  // exactly: halves
    }
  }
}

// Positive and negative samples by their own filters.
template <class PositiveFilter, class NegativeFilter>
HWY_INLINE void SampleAll(const PositiveFilter& positive, const NegativeFilter& negative,
                          const PixelSampler& sampler, const Window& pixels,
                          const PixelShifts& shifts, int first, int end, double* film_x,
                          double* film_y) {
  for (int i = first; i < end; ++i) {
    if (i < sampler.positive_count) {
      SamplePlane(positive, sampler, i, pixels, shifts, film_x, film_y);
    } else {
      SamplePlane(negative, sampler, i, pixels, shifts, film_x, film_y);
    }
    film_x += pixels.pixel_count();
    film_y += pixels.pixel_count();
  }
}

// Calls sample(positive, negative) with the filter's two ways to sample.
template <class Sample>
HWY_INLINE void WithFilters(const PixelSampler& sampler, const Sample& sample) {
  const FilterSampler& filter = sampler.filter;
  const double* p = filter.positive.data();
  const double* n = filter.negative.data();
  if (sampler.centered) {
    sample(Center(), Center());
  } else if (filter.positive.empty()) {
    sample(Box{filter.filter.width * 0x1p-32}, Center());
  } else if (filter.negative.empty()) {
    sample(Positive{p}, Center());
  } else {
    sample(Signed{p, n, p, n, FirstRegionShare(filter, FilterPart::kPositive)},
           Signed{n, p, p, n, FirstRegionShare(filter, FilterPart::kNegative)});
  }
}

void SamplePixelsT(const PixelSampler& sampler, const Window& pixels, const PixelShifts& shifts,
                   int first, int count, double* film_x, double* film_y) {
  WithFilters(sampler, [&](const auto& positive, const auto& negative) HWY_ATTR {
    SampleAll(positive, negative, sampler, pixels, shifts, first, first + count, film_x, film_y);
  });
}

// Mix64 of sampling/hash.h.
template <class DU64>
HWY_INLINE hn::Vec<DU64> MixEach(DU64 d, hn::Vec<DU64> x) {
  x = hn::Mul(hn::Xor(x, hn::ShiftRight<30>(x)), hn::Set(d, 0xbf58476d1ce4e5b9u));
  x = hn::Mul(hn::Xor(x, hn::ShiftRight<27>(x)), hn::Set(d, 0x94d049bb133111ebu));
  return hn::Xor(x, hn::ShiftRight<31>(x));
}

// PixelSeed of each pixel, in halves. Whole vectors are stored, as in SamplePlane.
void ShiftPixelsT(uint32_t seed, const Window& pixels, PixelShifts* shifts) {
  const hn::Rebind<uint64_t, D> du64;
  const DU32 du32;
  const auto first = hn::Set(du64, MixFirst(seed));
  const auto lane = hn::Iota(du32, 0);
  size_t row = 0;
  for (int y = pixels.y0; y < pixels.y1; ++y) {
    const auto high = hn::Set(du64, static_cast<uint64_t>(static_cast<uint32_t>(y)) << 32);
    size_t i = row;
    for (int x = pixels.x0; x < pixels.x1; x += static_cast<int>(hn::Lanes(du64))) {
      // Modulo 2^32, as PixelSeed's. Not Iota from x on: that takes the lanes through memory.
      const auto columns = hn::Add(lane, hn::Set(du32, static_cast<uint32_t>(x)));
      const auto pixel = hn::Or(high, hn::PromoteTo(du64, columns));
      const auto shift = MixEach(du64, hn::Xor(first, pixel));
      hn::StoreU(hn::TruncateTo(du32, shift), du32, shifts->x.data() + i);
      hn::StoreU(hn::TruncateTo(du32, hn::ShiftRight<32>(shift)), du32, shifts->y.data() + i);
      i += hn::Lanes(du64);
    }
    row += static_cast<size_t>(pixels.width());
  }
}

// Samples of one pixel and one part of the filter.
template <class Filter>
HWY_INLINE void SampleRun(const Filter& filter, const PixelSampler& sampler, int x, int y,
                          size_t first, size_t end, double* film_x, double* film_y) {
  const D d;
  const DU32 du32;
  const uint64_t shift = PixelSeed(x, y, sampler.seed);
  const VU32 shift_x = hn::Set(du32, static_cast<uint32_t>(shift) ^ kTopBit);
  const VU32 shift_y = hn::Set(du32, static_cast<uint32_t>(shift >> 32) ^ kTopBit);
  for (size_t i = first; i < end; i += hn::Lanes(d)) {
    V dx, dy;
    filter(CenteredFromFlipped(hn::Xor(hn::LoadU(du32, sampler.points_x.data() + i), shift_x)),
           CenteredFromFlipped(hn::Xor(hn::LoadU(du32, sampler.points_y.data() + i), shift_y)), &dx,
           &dy);
    hn::StoreU(hn::Add(hn::Set(d, x + 0.5), dx), d, film_x + (i - first));
    hn::StoreU(hn::Add(hn::Set(d, y + 0.5), dy), d, film_y + (i - first));
  }
}

void SamplePixelListT(const PixelSampler* samplers, std::span<const SampledPixel> pixels, int first,
                      int count, double* film_x, double* film_y) {
  const auto begin = static_cast<size_t>(first);
  const auto end = static_cast<size_t>(first + count);
  WithFilters(samplers[0], [&](const auto& positive, const auto& negative) HWY_ATTR {
    for (const SampledPixel& pixel : pixels) {
      const PixelSampler& sampler = samplers[pixel.sampler];
      const size_t split = std::clamp(static_cast<size_t>(sampler.positive_count), begin, end);
      SampleRun(positive, sampler, pixel.x, pixel.y, begin, split, film_x, film_y);
      SampleRun(negative, sampler, pixel.x, pixel.y, split, end, film_x + (split - begin),
                film_y + (split - begin));
      film_x += count;
      film_y += count;
    }
  });
}

}  // namespace HWY_NAMESPACE
}  // namespace nacre
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace nacre {
HWY_EXPORT(ShiftPixelsT);
HWY_EXPORT(SamplePixelsT);
HWY_EXPORT(SamplePixelListT);
void ShiftPixels(const PixelSampler& sampler, const Window& pixels, PixelShifts* shifts) {
  if (sampler.centered) return;
  HWY_DYNAMIC_DISPATCH(ShiftPixelsT)(sampler.seed, pixels, shifts);
}

void SamplePixels(const PixelSampler& sampler, const Window& pixels, const PixelShifts& shifts,
                  int first, int count, double* film_x, double* film_y) {
  HWY_DYNAMIC_DISPATCH(SamplePixelsT)(sampler, pixels, shifts, first, count, film_x, film_y);
}

void SamplePixelList(const PixelSampler* samplers, std::span<const SampledPixel> pixels, int first,
                     int count, double* film_x, double* film_y) {
  HWY_DYNAMIC_DISPATCH(SamplePixelListT)(samplers, pixels, first, count, film_x, film_y);
}
}  // namespace nacre
#endif
