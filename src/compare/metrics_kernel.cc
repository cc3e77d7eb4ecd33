// SPDX-License-Identifier: Apache-2.0
// compare/metrics_kernel.cc: the kernels of compare/metrics_rows.h.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "compare/metrics_kernel.cc"
#include "hwy/foreach_target.h"

#include <algorithm>
#include <cstring>

#include "hwy/highway.h"

#include "compare/layers.h"
#include "compare/metrics_rows.h"

HWY_BEFORE_NAMESPACE();
namespace nacre {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Calls body(got, reference) for each vector of both rows; the last one is padded with zeros, which
// are equal and do not affect sums. Stops and returns false when a body returns false.
template <class D, class Body>
HWY_INLINE bool ForEachVector(D d, const float* got, const float* reference, size_t count,
                              const Body& body) {
  const hn::Rebind<float, D> df;
  const size_t lanes = hn::Lanes(d);
  size_t i = 0;
  for (; i + lanes <= count; i += lanes) {
    if (!body(hn::PromoteTo(d, hn::LoadU(df, got + i)),
              hn::PromoteTo(d, hn::LoadU(df, reference + i)))) {
      return false;
    }
  }
  if (i == count) return true;
  float last[2][HWY_MAX_BYTES / sizeof(double)] = {};
  std::memcpy(last[0], got + i, (count - i) * sizeof(float));
  std::memcpy(last[1], reference + i, (count - i) * sizeof(float));
  return body(hn::PromoteTo(d, hn::LoadU(df, last[0])), hn::PromoteTo(d, hn::LoadU(df, last[1])));
}

// Bit for bit equal to SoftenedSquare, so nothing is fused.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V SoftenedSquares(D d, V error, V reference) {
  const V dark = hn::Set(d, kDarkReference * kDarkReference);
  return hn::Div(hn::Mul(error, error), hn::Add(hn::Mul(reference, reference), dark));
}

// Whether all lanes of both are finite: 0 times infinity or NaN is NaN.
template <class D, class V = hn::Vec<D>>
HWY_INLINE bool AllFinite(D d, V a, V b) {
  const V zero = hn::Zero(d);
  return hn::AllTrue(d, hn::Eq(hn::Add(hn::Mul(a, zero), hn::Mul(b, zero)), zero));
}

bool SumRowT(const float* got, const float* reference, size_t count, ErrorSums* sums,
             LargestErrors* relative) {
  const hn::ScalableTag<double> d;
  using V = hn::Vec<decltype(d)>;
  const V zero = hn::Zero(d);
  V squares = zero, softened = zero, sum_got = zero, sum_reference = zero;
  V largest = zero, peak = zero;
  // Rows that are not finite must be detected before any of their errors are kept.
  if (!ForEachVector(d, got, reference, count,
                     [&](V g, V r) HWY_ATTR { return AllFinite(d, g, r); })) {
    return false;
  }
  // Slightly lowered, so that LargestErrors decides about lanes at the threshold.
  const auto threshold = [&] { return static_cast<double>(relative->threshold()) * (1 - 0x1p-20); };
  double above = threshold();
  ForEachVector(d, got, reference, count, [&](V g, V r) HWY_ATTR {
    const V error = hn::Abs(hn::Sub(g, r));
    const V size = hn::Abs(r);
    sum_got = hn::Add(sum_got, g);
    sum_reference = hn::Add(sum_reference, r);
    peak = hn::Max(peak, size);
    const auto is_zero = hn::Eq(r, zero);
    sums->relative += hn::Lanes(d) - hn::CountTrue(d, is_zero);
    const auto differs = hn::Gt(error, zero);
    if (hn::AllFalse(d, differs)) return true;
    squares = hn::Add(squares, hn::Mul(error, error));
    softened = hn::Add(softened, SoftenedSquares(d, error, r));
    largest = hn::Max(largest, error);
    sums->zero_mismatches += hn::CountTrue(d, hn::And(differs, is_zero));
    const auto large = hn::AndNot(is_zero, hn::Gt(error, hn::Mul(size, hn::Set(d, above))));
    if (hn::AllFalse(d, large)) return true;
    alignas(HWY_MAX_BYTES) double ratios[HWY_MAX_BYTES / sizeof(double)];
    hn::Store(hn::IfThenElseZero(large, hn::Div(error, size)), d, ratios);
    for (size_t lane = 0; lane < hn::Lanes(d); ++lane) {
      sums->largest_relative = std::max(sums->largest_relative, ratios[lane]);
      relative->Add(RelativeToFloat(ratios[lane]));
    }
    above = threshold();
    return true;
  });
  const auto total = [&](V v) HWY_ATTR { return hn::GetLane(hn::SumOfLanes(d, v)); };
  const auto most = [&](V v) HWY_ATTR { return hn::GetLane(hn::MaxOfLanes(d, v)); };
  sums->finite += count;
  sums->squares += total(squares);
  sums->softened_squares += total(softened);
  sums->sum_got += total(sum_got);
  sums->sum_reference += total(sum_reference);
  sums->largest = std::max(sums->largest, most(largest));
  sums->peak = std::max(sums->peak, most(peak));
  return true;
}

bool MarkExcessT(const float* got, const float* reference, size_t count, double max_abs,
                 double max_rel, uint8_t* marks, double* largest) {
  const hn::ScalableTag<double> d;
  using V = hn::Vec<decltype(d)>;
  static_assert(HWY_MAX_BYTES / sizeof(double) <= 8);
  const V absolute = hn::Set(d, max_abs), relative = hn::Set(d, max_rel);
  V worst = hn::Zero(d);
  uint8_t* mark = marks;  // one byte per vector
  const bool finite = ForEachVector(d, got, reference, count, [&](V g, V r) HWY_ATTR {
    if (!AllFinite(d, g, r)) return false;
    const V error = hn::Abs(hn::Sub(g, r));
    // Not fused, because the sum in Exceeds is not.
    const auto exceeds = hn::Gt(error, hn::Add(absolute, hn::Mul(relative, hn::Abs(r))));
    if (!hn::AllFalse(d, exceeds)) {
      uint8_t bits[8] = {};
      hn::StoreMaskBits(d, exceeds, bits);
      *mark = static_cast<uint8_t>(*mark | bits[0]);
      worst = hn::Max(worst, hn::IfThenElseZero(exceeds, error));
    }
    ++mark;
    return true;
  });
  *largest = std::max(*largest, hn::GetLane(hn::MaxOfLanes(d, worst)));
  return finite;
}

}  // namespace HWY_NAMESPACE
}  // namespace nacre
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace nacre {
HWY_EXPORT(SumRowT);
HWY_EXPORT(MarkExcessT);

bool SumRow(const float* got, const float* reference, size_t count, ErrorSums* sums,
            LargestErrors* relative) {
  return HWY_DYNAMIC_DISPATCH(SumRowT)(got, reference, count, sums, relative);
}

bool MarkExcess(const float* got, const float* reference, size_t count, double max_abs,
                double max_rel, uint8_t* marks, double* largest) {
  return HWY_DYNAMIC_DISPATCH(MarkExcessT)(got, reference, count, max_abs, max_rel, marks, largest);
}
}  // namespace nacre
#endif
