// SPDX-License-Identifier: Apache-2.0
// sampling/pixel_sampler_kernel.cc: SamplePixels of sampling/pixel_sampler.h. Scalar twin:
// SamplePixel. Products and sums are never fused, so that both agree to the bit on every target.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "sampling/pixel_sampler_kernel.cc"
#include "hwy/foreach_target.h"

#include <algorithm>

#include "hwy/highway.h"

#include "base/prefetch.h"
#include "sampling/hash.h"
#include "sampling/pixel_sampler.h"

HWY_BEFORE_NAMESPACE();
namespace nacre::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using D = hn::ScalableTag<double>;
using V = hn::Vec<D>;
using DU32 = hn::Rebind<uint32_t, D>;
using DU64 = hn::Rebind<uint64_t, D>;
using VU64 = hn::Vec<DU64>;

// The last bit of a double in [2^20, 2^21) is worth 2^-32: combined with this exponent, the 32 bits
// of u are the double 2^20 + u, exactly.
inline constexpr uint64_t kUnitExponent = 0x4130000000000000u;
inline constexpr double kUnitOrigin = 0x1p20;

HWY_INLINE V UnitFromBits(VU64 bits) {
  const D d;
  return hn::Sub(hn::BitCast(d, bits), hn::Set(d, kUnitOrigin));
}

// SIMD twin of SampleDistance in pixel_filter.cc.
HWY_INLINE V Distance(const double* HWY_RESTRICT quantiles, V u) {
  const D d;
  const hn::Rebind<int32_t, D> di32;
  const V one = hn::Set(d, 1.0);
  const V side = hn::Sub(hn::Add(u, u), one);
  const V outside = hn::Sub(one, hn::Abs(side));
  const V position = hn::Mul(hn::Sub(one, hn::Sqrt(outside)), hn::Set(d, double{kQuantileSteps}));
  const auto step = hn::DemoteTo(di32, hn::Min(position, hn::Set(d, kQuantileSteps - 1.0)));
  const V fraction = hn::Sub(position, hn::PromoteTo(d, step));
  const auto i = hn::PromoteTo(hn::RebindToSigned<D>(), step);
  const V low = hn::GatherIndex(d, quantiles, i);
  const V high = hn::GatherIndex(d, quantiles + 1, i);
  const V distance = hn::Add(low, hn::Mul(fraction, hn::Sub(high, low)));
  return hn::IfThenElse(hn::Lt(side, hn::Zero(d)), hn::Neg(distance), distance);
}

// The box filter of width 1, whose samples lie at column + u: column - 2^20 + (2^20 + u), rounded
// once.
struct PixelBox {
  static HWY_INLINE V Position(V origin, VU64 bits) {
    return hn::Add(origin, hn::BitCast(D(), bits));
  }
  HWY_INLINE void operator()(V origin_x, V origin_y, VU64 bits_x, VU64 bits_y, V* x, V* y) const {
    *x = Position(origin_x, bits_x);
    *y = Position(origin_y, bits_y);
  }
};

// Samples at the offsets from the pixels' centres that offset(u, v, &dx, &dy) computes.
template <class Offset>
struct AboutCenter {
  Offset offset;
  HWY_INLINE void operator()(V origin_x, V origin_y, VU64 bits_x, VU64 bits_y, V* x, V* y) const {
    const V to_center = hn::Set(D(), kUnitOrigin + 0.5);
    V dx, dy;
    offset(UnitFromBits(bits_x), UnitFromBits(bits_y), &dx, &dy);
    *x = hn::Add(hn::Add(origin_x, to_center), dx);
    *y = hn::Add(hn::Add(origin_y, to_center), dy);
  }
};

struct Box {
  double width;
  HWY_INLINE void operator()(V u, V v, V* dx, V* dy) const {
    const D d;
    *dx = hn::Mul(hn::Sub(u, hn::Set(d, 0.5)), hn::Set(d, width));
    *dy = hn::Mul(hn::Sub(v, hn::Set(d, 0.5)), hn::Set(d, width));
  }
};

// A filter without negative values.
struct Positive {
  const double* quantiles;
  HWY_INLINE void operator()(V u, V v, V* dx, V* dy) const {
    *dx = Distance(quantiles, u);
    *dy = Distance(quantiles, v);
  }
};

// One part of a filter with negative lobes.
struct Signed {
  const double* first_x;
  const double* second_x;
  const double* first_y;
  const double* second_y;
  double first_share;
  HWY_INLINE void operator()(V u, V v, V* dx, V* dy) const {
    const D d;
    const V share = hn::Set(d, first_share);
    const auto first = hn::Lt(u, share);
    const V first_u = hn::Div(u, share);
    const V second_u = hn::Div(hn::Sub(u, share), hn::Set(d, 1 - first_share));
    // Lanes that belong to the other region look up an arbitrary entry of the table.
    const V zero = hn::Zero(d);
    *dx = hn::IfThenElse(first, Distance(first_x, hn::IfThenElse(first, first_u, zero)),
                         Distance(second_x, hn::IfThenElse(first, zero, second_u)));
    *dy = hn::IfThenElse(first, Distance(first_y, v), Distance(second_y, v));
  }
};

// Places one sample in each pixel. Whole vectors are stored.
template <class Place>
HWY_INLINE void SamplePlane(const Place& place, const PixelSampler& sampler, int index,
                            const PixelBatch& pixels, double* HWY_RESTRICT film_x,
                            double* HWY_RESTRICT film_y) {
  const D d;
  const DU64 du64;
  const auto point_x = hn::Set(du64, uint64_t{sampler.points_x[static_cast<size_t>(index)]});
  const auto point_y = hn::Set(du64, uint64_t{sampler.points_y[static_cast<size_t>(index)]});
  const double* HWY_RESTRICT const origin_x = pixels.origin_x.data();
  const double* HWY_RESTRICT const origin_y = pixels.origin_y.data();
  const uint64_t* HWY_RESTRICT const shift_x = pixels.shift_x.data();
  const uint64_t* HWY_RESTRICT const shift_y = pixels.shift_y.data();
  const size_t count = pixels.count;
  for (size_t i = 0; i < count; i += hn::Lanes(d)) {
    V x, y;
    place(hn::Load(d, origin_x + i), hn::Load(d, origin_y + i),
          hn::Xor(point_x, hn::Load(du64, shift_x + i)),
          hn::Xor(point_y, hn::Load(du64, shift_y + i)), &x, &y);
    PrefetchToWrite(film_x + i);
    PrefetchToWrite(film_y + i);
    hn::StoreU(x, d, film_x + i);
    hn::StoreU(y, d, film_y + i);
  }
}

// Calls sample(positive, negative) with functors that place the samples of the filter's two parts.
template <class Sample>
HWY_INLINE void WithFilters(const PixelSampler& sampler, const Sample& sample) {
  const FilterSampler& filter = sampler.filter;
  const double* p = filter.positive.data();
  const double* n = filter.negative.data();
  const auto sample_one = [&](const auto& place) HWY_ATTR { sample(place, place); };
  if (filter.positive.empty()) {
    if (filter.filter.width == 1) return sample_one(PixelBox());
    sample_one(AboutCenter<Box>{{filter.filter.width}});
  } else if (filter.negative.empty()) {
    sample_one(AboutCenter<Positive>{{p}});
  } else {
    sample(AboutCenter<Signed>{{p, n, p, n, FirstRegionShare(filter, FilterPart::kPositive)}},
           AboutCenter<Signed>{{n, p, p, n, FirstRegionShare(filter, FilterPart::kNegative)}});
  }
}

void SamplePixelsT(const PixelSampler& sampler, const PixelBatch& pixels, int first, int count,
                   double* film_x, double* film_y) {
  WithFilters(sampler, [&](const auto& positive, const auto& negative) HWY_ATTR {
    for (int i = first; i < first + count; ++i) {
      if (i < sampler.positive_count) {
        SamplePlane(positive, sampler, i, pixels, film_x, film_y);
      } else {
        SamplePlane(negative, sampler, i, pixels, film_x, film_y);
      }
      film_x += pixels.count;
      film_y += pixels.count;
    }
  });
}

// SIMD twin of Mix64 in sampling/hash.h.
HWY_INLINE VU64 MixEach(VU64 x) {
  const DU64 d;
  x = hn::Mul(hn::Xor(x, hn::ShiftRight<30>(x)), hn::Set(d, 0xbf58476d1ce4e5b9u));
  x = hn::Mul(hn::Xor(x, hn::ShiftRight<27>(x)), hn::Set(d, 0x94d049bb133111ebu));
  return hn::Xor(x, hn::ShiftRight<31>(x));
}

// Stores the halves of the PixelSeeds of a run's pixels, with kUnitExponent. Whole vectors are
// stored, here and below: entries behind a run are overwritten by the next one, or are padding.
HWY_INLINE void ShiftRun(const PixelRun& run, VU64 first, uint64_t* shift_x, uint64_t* shift_y) {
  const DU64 du64;
  const DU32 du32;
  const auto lane = hn::Iota(du32, 0);
  const auto low_half = hn::Set(du64, uint64_t{0xffffffffu});
  const auto exponent = hn::Set(du64, kUnitExponent);
  const auto row = hn::Set(du64, static_cast<uint64_t>(static_cast<uint32_t>(run.y)) << 32);
  for (int i = 0; i < run.count; i += static_cast<int>(hn::Lanes(du64))) {
    // Columns are modulo 2^32, as in PixelSeed. Iota with a variable start would be slower: it goes
    // through memory.
    const auto columns = hn::Add(lane, hn::Set(du32, static_cast<uint32_t>(run.x + i)));
    const auto pixel = hn::Or(row, hn::PromoteTo(du64, columns));
    const auto shift = MixEach(hn::Xor(first, pixel));
    hn::StoreU(hn::Or(exponent, hn::And(shift, low_half)), du64, shift_x + i);
    hn::StoreU(hn::Or(exponent, hn::ShiftRight<32>(shift)), du64, shift_y + i);
  }
}

// Stores the columns and rows of a run's pixels, each plus `offset`.
HWY_INLINE void StorePixelsOfRun(const PixelRun& run, double offset, double* HWY_RESTRICT x,
                                 double* HWY_RESTRICT y) {
  const D d;
  const V row = hn::Set(d, run.y + offset);
  V column = hn::Add(hn::Iota(d, 0.0), hn::Set(d, run.x + offset));
  for (size_t i = 0; i < static_cast<size_t>(run.count); i += hn::Lanes(d)) {
    PrefetchToWrite(x + i);
    PrefetchToWrite(y + i);
    hn::StoreU(column, d, x + i);
    hn::StoreU(row, d, y + i);
    column = hn::Add(column, hn::Set(d, static_cast<double>(hn::Lanes(d))));  // exact
  }
}

void PlaceCentersT(const Window& pixels, double* film_x, double* film_y) {
  for (int y = pixels.y0; y < pixels.y1; ++y) {
    StorePixelsOfRun({pixels.x0, y, pixels.width()}, 0.5, film_x, film_y);
    film_x += pixels.width();
    film_y += pixels.width();
  }
}

void PreparePixelsT(const PixelSampler& sampler, std::span<const PixelRun> runs,
                    PixelBatch* pixels) {
  const auto first = hn::Set(DU64(), MixFirst(sampler.seed));
  size_t begin = 0;
  for (const PixelRun& run : runs) {
    ShiftRun(run, first, pixels->shift_x.data() + begin, pixels->shift_y.data() + begin);
    StorePixelsOfRun(run, -kUnitOrigin, pixels->origin_x.data() + begin,
                     pixels->origin_y.data() + begin);
    begin += static_cast<size_t>(run.count);
  }
  pixels->count = begin;
}

// Places samples [first, end) of one pixel, all from one part of the filter.
template <class Place>
HWY_INLINE void SampleRun(const Place& place, const PixelSampler& sampler, int x, int y,
                          size_t first, size_t end, double* film_x, double* film_y) {
  const D d;
  const DU64 du64;
  const DU32 du32;
  const uint64_t shift = PixelSeed(x, y, sampler.seed);
  const auto shift_x = hn::Set(du64, kUnitExponent | static_cast<uint32_t>(shift));
  const auto shift_y = hn::Set(du64, kUnitExponent | shift >> 32);
  const V origin_x = hn::Set(d, x - kUnitOrigin), origin_y = hn::Set(d, y - kUnitOrigin);
  const auto points = [&](const std::vector<uint32_t>& from, size_t i) HWY_ATTR {
    return hn::PromoteTo(du64, hn::LoadU(du32, from.data() + i));
  };
  for (size_t i = first; i < end; i += hn::Lanes(d)) {
    V at_x, at_y;
    place(origin_x, origin_y, hn::Xor(points(sampler.points_x, i), shift_x),
          hn::Xor(points(sampler.points_y, i), shift_y), &at_x, &at_y);
    hn::StoreU(at_x, d, film_x + (i - first));
    hn::StoreU(at_y, d, film_y + (i - first));
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

}  // namespace nacre::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace nacre {
HWY_EXPORT(PlaceCentersT);
HWY_EXPORT(PreparePixelsT);
HWY_EXPORT(SamplePixelsT);
HWY_EXPORT(SamplePixelListT);
void PlaceCenters(const Window& pixels, double* film_x, double* film_y) {
  HWY_DYNAMIC_DISPATCH(PlaceCentersT)(pixels, film_x, film_y);
}

void PreparePixels(const PixelSampler& sampler, std::span<const PixelRun> runs,
                   PixelBatch* pixels) {
  HWY_DYNAMIC_DISPATCH(PreparePixelsT)(sampler, runs, pixels);
}

void SamplePixels(const PixelSampler& sampler, const PixelBatch& pixels, int first, int count,
                  double* film_x, double* film_y) {
  HWY_DYNAMIC_DISPATCH(SamplePixelsT)(sampler, pixels, first, count, film_x, film_y);
}

void SamplePixelList(const PixelSampler* samplers, std::span<const SampledPixel> pixels, int first,
                     int count, double* film_x, double* film_y) {
  HWY_DYNAMIC_DISPATCH(SamplePixelListT)(samplers, pixels, first, count, film_x, film_y);
}
}  // namespace nacre
#endif
