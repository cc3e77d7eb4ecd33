// SPDX-License-Identifier: Apache-2.0
// compare/ssim_rows_kernel.cc: the kernels of compare/ssim.h.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "compare/ssim_rows_kernel.cc"
#include "hwy/foreach_target.h"

#include "hwy/highway.h"

#include "base/aligned.h"
#include "color/transfer-inl.h"
#include "compare/ssim.h"

HWY_BEFORE_NAMESPACE();
namespace nacre {
namespace HWY_NAMESPACE {

void EncodeGreysT(size_t count, const float* r, const float* g, const float* b, float* greys) {
  const hn::ScalableTag<float> d;
  for (size_t i = 0; i < count; i += hn::Lanes(d)) {
    // The weights are those of color/luminance.h.
    const auto luminance =
        hn::MulAdd(hn::Set(d, 0.2126f), hn::LoadU(d, r + i),
                   hn::MulAdd(hn::Set(d, 0.7152f), hn::LoadU(d, g + i),
                              hn::Mul(hn::Set(d, 0.0722f), hn::LoadU(d, b + i))));
    hn::StoreU(SrgbOetf(d, luminance), d, greys + i);
  }
}

// Weighted means of both pictures, of their squares and of their product.
template <class V>
struct SsimMeans {
  V a, b, aa, bb, ab;
};

// Eqs. 13 to 16, with variances and covariance as E[ab] - E[a] E[b]. Fused operations are avoided:
// they would round numerator and denominator differently for equal pictures.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V SsimOf(D d, const SsimMeans<V>& mean) {
  const V product = hn::Mul(mean.a, mean.b);
  const V square_a = hn::Mul(mean.a, mean.a), square_b = hn::Mul(mean.b, mean.b);
  const V variance_a = hn::Sub(mean.aa, square_a);
  const V variance_b = hn::Sub(mean.bb, square_b);
  const V covariance = hn::Sub(mean.ab, product);
  const V c1 = hn::Set(d, kSsimC1), c2 = hn::Set(d, kSsimC2);
  const V upper =
      hn::Mul(hn::Add(hn::Add(product, product), c1), hn::Add(hn::Add(covariance, covariance), c2));
  const V lower = hn::Mul(hn::Add(hn::Add(square_a, square_b), c1),
                          hn::Add(hn::Add(variance_a, variance_b), c2));
  return hn::Div(upper, lower);
}

// The sums are in double, because a variance is a small difference of two means.
double SsimRowSumT(const Kernel& kernel, size_t width, const float* const* a, const float* const* b,
                   double* HWY_RESTRICT scratch) {
  const hn::ScalableTag<double> d;
  const hn::Rebind<float, decltype(d)> df;
  using V = hn::Vec<decltype(d)>;
  const size_t lanes = hn::Lanes(d), line = SsimScratch(width) / 5;
  for (size_t x = 0; x < width; x += lanes) {
    SsimMeans<V> mean = {hn::Zero(d), hn::Zero(d), hn::Zero(d), hn::Zero(d), hn::Zero(d)};
    for (size_t i = 0; i < kernel.size(); ++i) {
      const V weight = hn::Set(d, kernel[i]);
      const V of_a = hn::PromoteTo(d, hn::LoadU(df, a[i] + x));
      const V of_b = hn::PromoteTo(d, hn::LoadU(df, b[i] + x));
      const V weighted_a = hn::Mul(weight, of_a), weighted_b = hn::Mul(weight, of_b);
      mean.a = hn::Add(mean.a, weighted_a);
      mean.b = hn::Add(mean.b, weighted_b);
      mean.aa = hn::MulAdd(weighted_a, of_a, mean.aa);
      mean.bb = hn::MulAdd(weighted_b, of_b, mean.bb);
      mean.ab = hn::MulAdd(weighted_a, of_b, mean.ab);
    }
    hn::StoreU(mean.a, d, scratch + x);
    hn::StoreU(mean.b, d, scratch + line + x);
    hn::StoreU(mean.aa, d, scratch + 2 * line + x);
    hn::StoreU(mean.bb, d, scratch + 3 * line + x);
    hn::StoreU(mean.ab, d, scratch + 4 * line + x);
  }
  const size_t radius = kernel.size() / 2;
  const size_t count = width - 2 * radius;
  V sum = hn::Zero(d);
  for (size_t x = 0; x < count; x += lanes) {
    const auto across = [&](size_t of) HWY_ATTR {
      const double* const centre = scratch + of * line + x + radius;
      V total = hn::Mul(hn::Set(d, kernel[radius]), hn::LoadU(d, centre));
      for (size_t i = 1; i <= radius; ++i) {
        const V pair = hn::Add(hn::LoadU(d, centre - i), hn::LoadU(d, centre + i));
        total = hn::MulAdd(hn::Set(d, kernel[radius + i]), pair, total);
      }
      return total;
    };
    const V ssim = SsimOf(d, SsimMeans<V>{across(0), across(1), across(2), across(3), across(4)});
    const auto within = hn::FirstN(d, count - x);
    sum = hn::Add(sum, hn::IfThenElseZero(within, ssim));
  }
  return hn::GetLane(hn::SumOfLanes(d, sum));
}

}  // namespace HWY_NAMESPACE
}  // namespace nacre
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace nacre {
HWY_EXPORT(EncodeGreysT);
HWY_EXPORT(SsimRowSumT);

void EncodeGreys(size_t count, const float* r, const float* g, const float* b, float* greys) {
  HWY_DYNAMIC_DISPATCH(EncodeGreysT)(count, r, g, b, greys);
}

size_t SsimScratch(size_t width) { return 5 * (RoundUp(width, kBatchPadding) + kBatchPadding); }

double SsimRowSum(const Kernel& kernel, size_t width, const float* const* a, const float* const* b,
                  double* scratch) {
  return HWY_DYNAMIC_DISPATCH(SsimRowSumT)(kernel, width, a, b, scratch);
}
}  // namespace nacre
#endif
