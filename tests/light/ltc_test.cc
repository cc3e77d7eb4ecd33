// SPDX-License-Identifier: Apache-2.0
// tests/light/ltc_test.cc: the fitted matrices against the lobe that they stand for.
#include "light/ltc.h"

#include <cmath>

#include "base/basis.h"
#include "brdf/lobe_sampling.h"
#include "catch.h"

namespace nacre {
namespace {

// The density of the transformed cosine: Heitz et al. 2016, eq. 1, without knowing the matrix's
// size.
double Density(const LtcNumbers& m, const Vec3d& l) {
  const Vec3d back = m.Apply(l);
  const double length = back.length();
  const double determinant = double{m.xx} * m.zz - double{m.xz} * m.zx;
  return std::max(back.z, 0.0) / (length * length * length * length) * std::abs(determinant) / M_PI;
}

TEST_CASE("matrices are round for views along the normal, and never flat") {
  for (const double roughness : {0.1, 0.33, 0.5, 0.85, 1.0}) {
    const LtcRow row = MakeLtcRows(roughness).one;
    CHECK(row[0].xx == Approx(1).epsilon(1e-6));
    CHECK(std::abs(row[0].xz) < 1e-6);
    for (const LtcNumbers& m : row) {
      CHECK(double{m.xx} * m.zz - double{m.xz} * m.zx > 0);
    }
  }
}

TEST_CASE("views and roughnesses between the table's are between its matrices") {
  const LtcRow row = MakeLtcRows(0.45).one;
  CHECK(AtView(row, 1).zz == row[0].zz);
  CHECK(AtView(row, 0).zz == row[kLtcViews - 1].zz);
  const float between = AtView(row, 1 - 0.25f).zz;  // at 15.5 of 31
  CHECK(between == Approx((row[15].zz + row[16].zz) / 2));
  const float low = MakeLtcRows(0.4).one[9].zz, high = MakeLtcRows(0.5).one[9].zz;
  CHECK(row[9].zz > std::min(low, high));
  CHECK(row[9].zz < std::max(low, high));
}

TEST_CASE("the transformed cosines have their light about where the lobe has it") {
  for (const double roughness : {0.15, 0.4, 0.7, 1.0}) {
    const double alpha = roughness * roughness;
    const LtcRow row = MakeLtcRows(roughness).one;
    for (const double cosine : {0.95, 0.7, 0.4}) {
      const Vec3d view(std::sqrt(1 - cosine * cosine), 0, cosine), normal(0, 0, 1);
      const LtcNumbers m = AtView(row, static_cast<float>(cosine));
      // The means over the lobe's samples of D_ltc / pdf, which falls short of 1 by what is below
      // the surface, and of |D_ltc / pdf - weight / albedo|.
      constexpr int kSteps = 128;
      double albedo = 0, sum = 0, apart = 0;
      const auto for_each = [&](const auto& add) {
        for (int i = 0; i < kSteps; ++i) {
          for (int j = 0; j < kSteps; ++j) {
            const Vec3d l =
                SampleGgxVisible(normal, view, alpha, (i + 0.5) / kSteps, (j + 0.5) / kSteps);
            const double pdf = GgxVisiblePdf(normal, view, l, alpha);
            if (!(l.z > 0) || !(pdf > 0)) continue;
            // f cos / pdf = G2 / G1 of Smith's height-correlated form.
            const auto lambda = [&](double c) {
              return (std::sqrt(1 + alpha * alpha * (1 / (c * c) - 1)) - 1) / 2;
            };
            const double weight = (1 + lambda(view.z)) / (1 + lambda(view.z) + lambda(l.z));
            add(weight, Density(m, l) / pdf);
          }
        }
      };
      constexpr double kCount = kSteps * kSteps;
      for_each([&](double weight, double) { albedo += weight / kCount; });
      for_each([&](double weight, double density) {
        sum += density / kCount;
        apart += std::abs(density - weight / albedo) / kCount;
      });
      const double elsewhere = (apart + 1 - sum) / 2;
      CAPTURE(roughness, cosine, sum, elsewhere);
      CHECK(sum < 1.01);
      CHECK(sum > 0.9);
      // As scripts/fit_ltc.py has it: up to 14 % among these.
      CHECK(elsewhere < 0.15);
    }
  }
}

}  // namespace
}  // namespace nacre
