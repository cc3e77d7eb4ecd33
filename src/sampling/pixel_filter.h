// SPDX-License-Identifier: Apache-2.0
// sampling/pixel_filter.h: reconstruction filters, sampled by importance.
//
// A pixel's value is the integral of filter x image. Each pixel draws its own samples from the
// pdf |filter|, with weight sign(filter) (Ernst, Stamminger and Greiner 2006), so there is no
// splatting: a pixel depends on its own samples only. sampling/pixel_sampler.h places them.
#pragma once

#include <cstdint>
#include <vector>

#include "base/vec.h"

namespace nacre {

// All are products f(x) f(y) of one even function, zero outside [-width / 2, width / 2]:
//   kBox             constant
//   kGaussian        standard deviation width / 6, so cut off at 3 standard deviations
//   kBlackmanHarris  the four-term window (Harris 1978), minimum side lobes
//   kMitchell        Mitchell and Netravali 1988, B = C = 1/3, negative outside 2/7 of the width;
//                    the paper's filter has width 4
enum class FilterKind : uint8_t { kBox, kGaussian, kBlackmanHarris, kMitchell };

struct PixelFilter {
  FilterKind kind = FilterKind::kBox;
  double width = 1;  // full support in pixels, in (0, 16]
  friend bool operator==(const PixelFilter&, const PixelFilter&) = default;
};

// f(x), x in pixels from the pixel's centre; its integral is 1.
double FilterValue(const PixelFilter& filter, double x);

// The integral of f from 0 to x in [0, width / 2].
double FilterIntegral(const PixelFilter& filter, double x);

// The inverse CDF of the distance |x|, at equal steps of t, where (1 - t)^2 is the fraction of a
// filter part's mass that lies further out: the square keeps the interpolation accurate where the
// filter fades to 0. The table is interpolated linearly; the fraction is met within 3e-7 (in
// negative lobes, which begin at 0, within 5e-4).
using QuantileTable = std::vector<double>;
inline constexpr int kQuantileSteps = 1024;

// A filter prepared for sampling. f = p - n with p, n >= 0.
struct FilterSampler {
  PixelFilter filter;
  double positive_mass = 1;  // integral of p
  double negative_mass = 0;  // integral of n
  QuantileTable positive;    // quantiles of p; empty for the box
  QuantileTable negative;    // quantiles of n; empty if n = 0
};

FilterSampler MakeFilterSampler(const PixelFilter& filter);

// f(x) f(y) is positive where both factors have the same sign, and negative elsewhere. The two
// parts are sampled separately, so that each gets exactly its share of a pixel's weight.
enum class FilterPart : uint8_t { kPositive, kNegative };

// The integral of |f(x) f(y)| over a part.
double PartMass(const FilterSampler& sampler, FilterPart part);

// Each part consists of two regions: both factors positive and both negative; or f(x) alone
// negative and f(y) alone negative. Returns the first region's share of the part's mass.
double FirstRegionShare(const FilterSampler& sampler, FilterPart part);

// An offset from the pixel's centre, in pixels, with the pdf |f(x) f(y)| / PartMass, for a
// uniform u in [0, 1)^2. The part must not be empty.
Vec2d SampleFilter(const FilterSampler& sampler, FilterPart part, const Vec2d& u);

}  // namespace nacre
