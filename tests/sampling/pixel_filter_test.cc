// SPDX-License-Identifier: Apache-2.0
// tests/sampling/pixel_filter_test.cc: filters and their importance sampling.
#include "sampling/pixel_filter.h"

#include <cmath>
#include <vector>

#include "catch.h"

namespace nacre {
namespace {

constexpr PixelFilter kFilters[] = {{FilterKind::kBox, 1},      {FilterKind::kBox, 2.5},
                                    {FilterKind::kGaussian, 3}, {FilterKind::kGaussian, 7},
                                    {FilterKind::kMitchell, 4}, {FilterKind::kBlackmanHarris, 3.3},
                                    {FilterKind::kMitchell, 3}, {FilterKind::kBlackmanHarris, 0.5}};

TEST_CASE("Filters integrate to 1, and FilterIntegral is their integral", "[sampling]") {
  for (const PixelFilter& filter : kFilters) {
    CAPTURE(static_cast<int>(filter.kind), filter.width);
    CHECK(std::abs(FilterIntegral(filter, filter.width / 2) - 0.5) <= 1e-15);
    // Simpson's rule with these steps has an error below 1e-12; the knots of Mitchell's pieces are
    // ends of steps of width / 4.
    constexpr int kSteps = 400;
    const double h = filter.width / 2 / kSteps;
    double sum = 0;
    for (int i = 0; i < kSteps; ++i) {
      const double x = i * h;
      sum += h / 6 *
             (FilterValue(filter, x) + 4 * FilterValue(filter, x + h / 2) +
              FilterValue(filter, std::min(x + h, filter.width / 2)));
      CHECK(std::abs(FilterIntegral(filter, x + h) - sum) <= 1e-10);
    }
  }
}

TEST_CASE("Filters are even and vanish outside their support", "[sampling]") {
  for (const PixelFilter& filter : kFilters) {
    for (const double x : {0.1, 0.2, 0.49}) {
      CHECK(FilterValue(filter, x * filter.width) == FilterValue(filter, -x * filter.width));
    }
    CHECK(FilterValue(filter, filter.width * 0.5001) == 0);
  }
}

TEST_CASE("Mitchell's filter has the values of the paper", "[sampling]") {
  const PixelFilter filter{FilterKind::kMitchell, 4};
  CHECK(FilterValue(filter, 0) == Approx(8.0 / 9).epsilon(1e-15));   // (6 - 2B) / 6
  CHECK(FilterValue(filter, 1) == Approx(1.0 / 18).epsilon(1e-14));  // B / 6
  CHECK(std::abs(FilterValue(filter, 2)) <= 1e-15);
  CHECK(std::abs(FilterValue(filter, 8.0 / 7)) <= 1e-15);
  CHECK(FilterValue(filter, 1.5) == Approx(-5.0 / 144).epsilon(1e-13));
  // At integer distances the weights of all pixels sum to 1 (B-spline and Catmull-Rom do).
  for (const double x : {0.0, 0.3, 0.5, 0.9}) {
    double sum = 0;
    for (int i = -3; i <= 3; ++i) sum += FilterValue(filter, x + i);
    CHECK(sum == Approx(1).epsilon(1e-14));
  }
}

TEST_CASE("The Gaussian's deviation is a sixth of its width", "[sampling]") {
  const PixelFilter filter{FilterKind::kGaussian, 3};
  CHECK(FilterValue(filter, 0.5) / FilterValue(filter, 0) == Approx(std::exp(-0.5)).epsilon(1e-14));
}

TEST_CASE("Harris' window ends at 6e-5 of its peak", "[sampling]") {
  const PixelFilter filter{FilterKind::kBlackmanHarris, 3.3};
  const double end = FilterValue(filter, filter.width / 2) / FilterValue(filter, 0);
  CHECK(end == Approx(6e-5).epsilon(1e-9));  // a0 - a1 + a2 - a3; the terms add up to 1
}

TEST_CASE("Tabulated quantiles meet their shares", "[sampling]") {
  for (const PixelFilter& filter : kFilters) {
    const FilterSampler sampler = MakeFilterSampler(filter);
    for (const FilterPart part : {FilterPart::kPositive, FilterPart::kNegative}) {
      if (PartMass(sampler, part) == 0) continue;
      double worst_n = 0, worst_p = 0;
      constexpr int kSteps = 100'003;
      for (int i = 0; i < kSteps; ++i) {
        const double u = (i + 0.5) / kSteps;
        // With these u.x, positive samples have y from p, and negative ones from n.
        const bool is_n = part == FilterPart::kNegative;
        const Vec2d offset = SampleFilter(sampler, part, Vec2d(is_n ? 0.75 : 0.25, u));
        CHECK_FALSE(std::abs(offset.y) > filter.width / 2);
        const double zero = is_n ? 2.0 / 7 * filter.width : 0;
        const double mass = is_n ? sampler.negative_mass : sampler.positive_mass;
        const double share =
            2 *
            std::abs(FilterIntegral(filter, std::abs(offset.y)) - FilterIntegral(filter, zero)) /
            mass;
        double& worst = is_n ? worst_n : worst_p;
        worst = std::max(worst, std::abs(share - std::abs(2 * u - 1)));
        if ((offset.y < 0) != (u < 0.5)) FAIL("wrong side");
      }
      CAPTURE(static_cast<int>(filter.kind), filter.width);
      INFO("n " << worst_n << " p " << worst_p);
      CHECK(worst_p <= 3e-7);  // as pixel_filter.h says
      CHECK(worst_n <= 5e-4);
    }
  }
}

TEST_CASE("The parts of Mitchell's filter have their masses", "[sampling]") {
  const FilterSampler sampler = MakeFilterSampler({FilterKind::kMitchell, 4});
  double positive = 0, negative = 0;
  constexpr int kSteps = 2000;
  for (int i = 0; i < kSteps; ++i) {
    const double value = FilterValue(sampler.filter, (i + 0.5) * 4 / kSteps - 2) * 4 / kSteps;
    (value > 0 ? positive : negative) += std::abs(value);
  }
  CHECK(sampler.positive_mass == Approx(positive).epsilon(1e-5));  // midpoint rule
  CHECK(sampler.negative_mass == Approx(negative).epsilon(1e-4));
  CHECK(PartMass(sampler, FilterPart::kPositive) - PartMass(sampler, FilterPart::kNegative) ==
        Approx(1).epsilon(1e-14));
}

}  // namespace
}  // namespace nacre
