// SPDX-License-Identifier: Apache-2.0
#include "render/interval_kernel.h"

#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "render/interval_kernel.cc"
#include "hwy/foreach_target.h"

#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace nacre {
namespace HWY_NAMESPACE {
namespace {
namespace hn = hwy::HWY_NAMESPACE;

using D = hn::CappedTag<double, 8>;
using V = hn::Vec<D>;

struct SpreadV {
  V mean, half_width2;
};

// The same operations as in MeasureSpread, for the sums load(replicate).
template <class Load>
HWY_INLINE SpreadV Spread(const Load& load, V scale) {
  const D d;
  V values[kReplicates];
  V mean = hn::Zero(d), squares = hn::Zero(d);
  for (size_t r = 0; r < kReplicates; ++r) {
    values[r] = hn::Mul(load(r), scale);
    mean = hn::Add(mean, values[r]);
  }
  mean = hn::Mul(mean, hn::Set(d, 1.0 / kReplicates));
  for (const V value : values) {
    const V difference = hn::Sub(value, mean);
    squares = hn::Add(squares, hn::Mul(difference, difference));
  }
  return {mean, hn::Mul(hn::Set(d, kSquaresToHalfWidth2), squares)};
}

void MeasureBlockT(const double* const (&sums)[kReplicates][3], const uint32_t* samples,
                   const ErrorBound& error, BlockIntervals* intervals) {
  const D d;
  const hn::Rebind<int32_t, D> di;
  intervals->narrow = 0;
  for (size_t i = 0; i < kBlockPixels; i += hn::Lanes(d)) {
    const V taken =
        hn::PromoteTo(d, hn::BitCast(di, hn::LoadU(hn::Rebind<uint32_t, D>(), samples + i)));
    const V scale = hn::Div(hn::Set(d, 1.0), taken);
    auto narrow = hn::Eq(taken, taken);  // all lanes
    V widest = hn::Zero(d), strictest = hn::Set(d, std::numeric_limits<double>::infinity());
    for (size_t channel = 0; channel < 3; ++channel) {
      const auto load = [&](size_t r) HWY_ATTR { return hn::LoadU(d, sums[r][channel] + i); };
      const SpreadV spread = Spread(load, scale);
      const V bounded = hn::Min(hn::Abs(spread.mean), hn::Set(d, error.white));
      const V tolerance =
          hn::Mul(hn::Set(d, error.max_error), hn::Max(bounded, hn::Set(d, kDarkest)));
      narrow = hn::And(narrow, hn::Le(spread.half_width2, hn::Mul(tolerance, tolerance)));
      widest = hn::Max(spread.half_width2, widest);
      strictest = hn::Min(tolerance, strictest);
    }
    hn::StoreU(hn::Sqrt(widest), d, intervals->half_width + i);
    hn::StoreU(strictest, d, intervals->tolerance + i);
    uint8_t bits[8] = {};
    hn::StoreMaskBits(d, narrow, bits);
    intervals->narrow |= uint32_t{bits[0]} << i;
  }
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace nacre
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace nacre {

HWY_EXPORT(MeasureBlockT);

void MeasureBlock(const double* const (&sums)[kReplicates][3], const uint32_t* samples,
                  const ErrorBound& error, BlockIntervals* intervals) {
  HWY_DYNAMIC_DISPATCH(MeasureBlockT)(sums, samples, error, intervals);
}

}  // namespace nacre
#endif
