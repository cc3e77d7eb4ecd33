// SPDX-License-Identifier: Apache-2.0
// compare/flip_kernel.cc: FilterFlipRow and FlipBlock of compare/flip_rows.h.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "compare/flip_kernel.cc"
#include "hwy/foreach_target.h"

#include "hwy/highway.h"

#include "compare/flip_color-inl.h"
#include "compare/flip_rows.h"

HWY_BEFORE_NAMESPACE();
namespace nacre {
namespace HWY_NAMESPACE {

static_assert(kFlipColumns % (2 * HWY_MAX_BYTES / sizeof(float)) == 0);

// Applies a symmetric filter to a line: samples at equal distance to the left and right are added
// first.
template <class D, class V>
HWY_INLINE V FilterSymmetric(D d, const FlipFilter& filter, const float* centre) {
  V sum = hn::Mul(hn::Set(d, filter.half[0]), hn::LoadU(d, centre));
  for (size_t i = 1; i < filter.half.size(); ++i) {
    const V pair = hn::Add(hn::LoadU(d, centre - i), hn::LoadU(d, centre + i));
    sum = hn::MulAdd(hn::Set(d, filter.half[i]), pair, sum);
  }
  return sum;
}

// `edge` and `point` have a sum of 0, and are applied to differences of samples. So they are
// exactly 0 in flat regions, where the feature error would take the square root of a rounding
// error.
template <class D>
HWY_INLINE void FilterFeatures(D d, const FlipWeights& weights, const float* centre, float* row) {
  using V = hn::Vec<D>;
  const V middle = hn::LoadU(d, centre);
  const V twice = hn::Add(middle, middle);
  V smooth = hn::Mul(hn::Set(d, weights.smooth.half[0]), middle);
  V edge = hn::Zero(d), point = hn::Zero(d);
  for (size_t i = 1; i < weights.smooth.half.size(); ++i) {
    const V left = hn::LoadU(d, centre - i), right = hn::LoadU(d, centre + i);
    const V pair = hn::Add(left, right);
    smooth = hn::MulAdd(hn::Set(d, weights.smooth.half[i]), pair, smooth);
    edge = hn::MulAdd(hn::Set(d, weights.edge.half[i]), hn::Sub(right, left), edge);
    point = hn::MulAdd(hn::Set(d, weights.point.half[i]), hn::Sub(pair, twice), point);
  }
  hn::Store(smooth, d, row + kSmooth * kFlipColumns);
  hn::Store(edge, d, row + kEdge * kFlipColumns);
  hn::Store(point, d, row + kPoint * kFlipColumns);
}

void FilterFlipRowT(const FlipWeights& weights, const std::array<float*, 3>& light, float* row) {
  const hn::ScalableTag<float> d;
  using V = hn::Vec<decltype(d)>;
  float* const luminance = light[0];
  float* const red_green = light[1];
  float* const blue_yellow = light[2];
  for (size_t x = 0; x < kFlipColumns + 2 * weights.radius; x += hn::Lanes(d)) {
    const auto opponent = OpponentFromRgb(d, hn::LoadU(d, light[0] + x), hn::LoadU(d, light[1] + x),
                                          hn::LoadU(d, light[2] + x));
    hn::StoreU(opponent.luminance, d, luminance + x);
    hn::StoreU(opponent.red_green, d, red_green + x);
    hn::StoreU(opponent.blue_yellow, d, blue_yellow + x);
  }
  const auto store = [&](FlipPlane plane, size_t x, V value)
                         HWY_ATTR { hn::Store(value, d, row + plane * kFlipColumns + x); };
  for (size_t x = 0; x < kFlipColumns; x += hn::Lanes(d)) {
    const size_t centre = weights.radius + x;
    const auto filter = [&](const FlipFilter& weights_of, const float* line) HWY_ATTR {
      return FilterSymmetric<decltype(d), V>(d, weights_of, line + centre);
    };
    store(kLuminance, x, filter(weights.luminance, luminance));
    store(kRedGreen, x, filter(weights.red_green, red_green));
    store(kBlueYellow0, x, filter(weights.blue_yellow[0], blue_yellow));
    store(kBlueYellow1, x, filter(weights.blue_yellow[1], blue_yellow));
    FilterFeatures(d, weights, luminance + centre, row + x);
  }
}

// Sums for two vectors of pixels in all rows of a block.
template <class V>
struct BlockSums {
  V left[kFlipBlockRows], right[kFlipBlockRows];
};

// Adds the results of a vertical filter at `column`. rows[0] is the uppermost filtered row that it
// reads. kOfDifferences: the filter has a sum of 0, and is applied to differences as in
// FilterFeatures.
template <bool kOfDifferences, class D, class V = hn::Vec<D>>
HWY_INLINE void FilterDown(D d, const FlipFilter& filter, const float* const* rows, size_t column,
                           BlockSums<V>* sums) {
  const size_t lanes = hn::Lanes(d);
  const size_t count = filter.full.size() - (kFlipBlockRows - 1);
  const float* HWY_RESTRICT weights = filter.full.data() + (kFlipBlockRows - 1);
  const float* const middle = rows[count / 2] + column;
  const V middle_left = hn::Load(d, middle), middle_right = hn::Load(d, middle + lanes);
  for (size_t i = 0; i < count; ++i) {
    V left = hn::Load(d, rows[i] + column), right = hn::Load(d, rows[i] + column + lanes);
    if constexpr (kOfDifferences) {
      left = hn::Sub(left, middle_left);
      right = hn::Sub(right, middle_right);
    }
    for (size_t row = 0; row < kFlipBlockRows; ++row) {
      const V weight = hn::Set(d, *(weights + i - row));
      sums->left[row] = hn::MulAdd(weight, left, sums->left[row]);
      sums->right[row] = hn::MulAdd(weight, right, sums->right[row]);
    }
  }
}

template <class D>
HWY_INLINE void FilterPictureDown(D d, const FlipWeights& weights, const float* const* rows,
                                  float* to) {
  using V = hn::Vec<D>;
  const size_t lanes = hn::Lanes(d);
  constexpr size_t kPlane = kFlipBlockRows * kFlipColumns;
  const auto first = [&](const FlipFilter& filter)
                         HWY_ATTR { return rows + (weights.radius - filter.radius()); };
  BlockSums<V> sums;
  for (size_t row = 0; row < kFlipBlockRows; ++row) sums.left[row] = sums.right[row] = hn::Zero(d);
  for (size_t x = 0; x < kFlipColumns; x += 2 * lanes) {
    // Stores the sums, and begins new ones.
    const auto store = [&](size_t plane) HWY_ATTR {
      float* at = to + plane * kPlane + x;
      for (size_t row = 0; row < kFlipBlockRows; ++row, at += kFlipColumns) {
        hn::Store(sums.left[row], d, at);
        hn::Store(sums.right[row], d, at + lanes);
        sums.left[row] = sums.right[row] = hn::Zero(d);
      }
    };
    const auto smooth = [&](const FlipFilter& filter, FlipPlane plane) HWY_ATTR {
      FilterDown<false>(d, filter, first(filter), plane * kFlipColumns + x, &sums);
    };
    const auto derive = [&](const FlipFilter& filter) HWY_ATTR {
      FilterDown<true>(d, filter, first(filter), kSmooth * kFlipColumns + x, &sums);
    };
    smooth(weights.luminance, kLuminance);
    store(0);
    smooth(weights.red_green, kRedGreen);
    store(1);
    smooth(weights.blue_yellow[0], kBlueYellow0);
    smooth(weights.blue_yellow[1], kBlueYellow1);
    store(2);
    smooth(weights.smooth, kEdge);
    store(3);
    derive(weights.edge);
    store(4);
    smooth(weights.smooth, kPoint);
    store(5);
    derive(weights.point);
    store(6);
  }
}

void FlipBlockT(const FlipWeights& weights, double largest, const float* const* reference,
                const float* const* test, float* HWY_RESTRICT scratch, float* HWY_RESTRICT flip) {
  const hn::ScalableTag<float> d;
  using V = hn::Vec<decltype(d)>;
  constexpr size_t kPlane = kFlipBlockRows * kFlipColumns;
  const FlipScale scale(largest);
  float* const of_reference = scratch;
  float* const of_test = scratch + kFlipScratch / 2;
  FilterPictureDown(d, weights, reference, of_reference);
  FilterPictureDown(d, weights, test, of_test);
  for (size_t i = 0; i < kPlane; i += hn::Lanes(d)) {
    const auto load = [&](const float* from, size_t plane)
                          HWY_ATTR { return hn::Load(d, from + plane * kPlane + i); };
    const auto seen = [&](const float* from) HWY_ATTR {
      return SeenColor(d, FlipOpponent<V>{load(from, 0), load(from, 1), load(from, 2)});
    };
    const auto difference = [&](size_t across, size_t down) HWY_ATTR {
      return hn::Sub(FlipNorm(d, load(of_reference, across), load(of_reference, down)),
                     FlipNorm(d, load(of_test, across), load(of_test, down)));
    };
    const V color = ColorError(d, scale, seen(of_reference), seen(of_test));
    const V feature = FeatureError(d, difference(3, 4), difference(5, 6));
    hn::Store(FlipPower(d, color, hn::Sub(hn::Set(d, 1.0f), feature)), d, flip + i);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace nacre
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace nacre {
HWY_EXPORT(FilterFlipRowT);
HWY_EXPORT(FlipBlockT);

void FilterFlipRow(const FlipWeights& weights, const std::array<float*, 3>& light, float* row) {
  HWY_DYNAMIC_DISPATCH(FilterFlipRowT)(weights, light, row);
}

void FlipBlock(const FlipWeights& weights, const float* const* reference, const float* const* test,
               float* scratch, float* flip) {
  static const double largest = flip::LargestDifference();
  HWY_DYNAMIC_DISPATCH(FlipBlockT)(weights, largest, reference, test, scratch, flip);
}
}  // namespace nacre
#endif
