// SPDX-License-Identifier: Apache-2.0
// tests/compare/ssim_test.cc: SSIM where its value is known.
#include "compare/ssim.h"

#include <cmath>

#include "catch.h"

namespace nacre {
namespace {

Plane Waves(int width, int height, double amplitude) {
  Plane plane(width, height);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      plane.at(x, y) = 0.5 + amplitude * std::sin(0.7 * x) * std::cos(0.4 * y);
    }
  }
  return plane;
}

TEST_CASE("The SSIM of equal pictures is 1", "[ssim]") {
  const Plane waves = Waves(24, 17, 0.4);
  // Both factors are a number over itself, rounded alike.
  CHECK(Ssim(waves, waves) == Approx(1).epsilon(1e-15));
  const Plane map = SsimMap(waves, waves);
  CHECK((map.width == 14 && map.height == 7));
}

TEST_CASE("The SSIM of two even greys is that of their means", "[ssim]") {
  // Variances are 0 up to rounding, 1e-16 beside C2 = 9e-4.
  const double expected = (2 * 0.25 * 0.75 + 1e-4) / (0.25 * 0.25 + 0.75 * 0.75 + 1e-4);
  CHECK(Ssim(Plane(11, 11, 0.25), Plane(11, 11, 0.75)) == Approx(expected).epsilon(1e-12));
}

TEST_CASE("The SSIM of a picture and its faded self is that of its variance", "[ssim]") {
  // One window: weights of 11x11 on a step, so mean and variance have closed forms. b - 1/2 is half
  // of a - 1/2, so the covariance is half of a's variance and b's a quarter.
  Plane a(11, 11, 0.3), b(11, 11, 0.4);
  double weight = 0;  // of the bright columns
  const Kernel window = GaussianKernel(1.5, 5);
  for (int x = 7; x < 11; ++x) {
    weight += window[static_cast<size_t>(x)];
    for (int y = 0; y < 11; ++y) {
      a.at(x, y) = 0.7;
      b.at(x, y) = 0.6;
    }
  }
  const double mean_a = 0.3 + 0.4 * weight, mean_b = 0.4 + 0.2 * weight;
  const double variance = 0.16 * weight * (1 - weight);
  const double expected = (2 * mean_a * mean_b + 1e-4) * (variance + 9e-4) /
                          ((mean_a * mean_a + mean_b * mean_b + 1e-4) * (1.25 * variance + 9e-4));
  CHECK(Ssim(a, b) == Approx(expected).epsilon(1e-12));
  CHECK(Ssim(b, a) == Approx(expected).epsilon(1e-12));
}

TEST_CASE("SSIM falls as the structure is lost", "[ssim]") {
  const Plane waves = Waves(32, 32, 0.4);
  double last = 1;
  for (const double amplitude : {0.3, 0.2, 0.1, 0.0, -0.2}) {
    const double now = Ssim(Waves(32, 32, amplitude), waves);
    CHECK(now < last);
    last = now;
  }
  CHECK(last < 0);  // the negative: covariance of the other sign
}

}  // namespace
}  // namespace nacre
