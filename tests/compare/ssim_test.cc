// SPDX-License-Identifier: Apache-2.0
// tests/compare/ssim_test.cc: SSIM where its value is known.
#include "compare/ssim.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "catch.h"
#include "color/luminance.h"
#include "color/transfer.h"
#include "compare/plane.h"
#include "targets.h"

namespace nacre {
namespace {

double SsimOf(const Plane& a, const Plane& b) {
  const auto rows = [](const Plane& plane) {
    return [&plane](int y, float* greys) {
      std::copy_n(&plane.values[static_cast<size_t>(y) * static_cast<size_t>(plane.width)],
                  plane.width, greys);
    };
  };
  return Ssim(a.width, a.height, rows(a), rows(b));
}

// Eq. 13 window by window, with weights in two dimensions and variances as they are defined.
double PlainSsim(const Plane& a, const Plane& b) {
  const Kernel window = GaussianKernel(kSsimSigma, kSsimRadius);
  constexpr int kSide = 2 * kSsimRadius + 1;
  double sum = 0;
  for (int top = 0; top + kSide <= a.height; ++top) {
    for (int left = 0; left + kSide <= a.width; ++left) {
      const auto mean = [&](const auto& value) {
        double total = 0;
        for (int y = 0; y < kSide; ++y) {
          for (int x = 0; x < kSide; ++x) {
            total += window[static_cast<size_t>(x)] * window[static_cast<size_t>(y)] *
                     value(double{a.at(left + x, top + y)}, double{b.at(left + x, top + y)});
          }
        }
        return total;
      };
      const double ma = mean([](double p, double) { return p; });
      const double mb = mean([](double, double q) { return q; });
      const double va = mean([&](double p, double) { return (p - ma) * (p - ma); });
      const double vb = mean([&](double, double q) { return (q - mb) * (q - mb); });
      const double ab = mean([&](double p, double q) { return (p - ma) * (q - mb); });
      sum += (2 * ma * mb + kSsimC1) * (2 * ab + kSsimC2) /
             ((ma * ma + mb * mb + kSsimC1) * (va + vb + kSsimC2));
    }
  }
  return sum / ((a.width - kSide + 1) * (a.height - kSide + 1));
}

Plane Waves(int width, int height, double amplitude) {
  Plane plane(width, height);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      plane.at(x, y) = static_cast<float>(0.5 + amplitude * std::sin(0.7 * x) * std::cos(0.4 * y));
    }
  }
  return plane;
}

TEST_CASE("The SSIM of equal pictures is 1", "[ssim]") {
  const Plane waves = Waves(24, 17, 0.4);
  // Both factors are a number over itself, rounded alike.
  CHECK(SsimOf(waves, waves) == Approx(1).epsilon(1e-15));
}

TEST_CASE("SSIM is its definition on every target", "[ssim]") {
  // Widths that end within a vector, and more rows than a band has. Differences of means of squares
  // leave 1e-16 of them, beside C2 = 9e-4.
  for (const int width : {11, 24, 37}) {
    const Plane a = Waves(width, 81, 0.4), b = Waves(width, 81, 0.1);
    const double plain = PlainSsim(a, b);
    ForEachTarget([&](Target) { CHECK(SsimOf(a, b) == Approx(plain).epsilon(1e-11)); });
  }
}

TEST_CASE("Shown greys are sRGB's of the luminance", "[ssim]") {
  std::vector<float> light(300);
  for (size_t i = 0; i < light.size(); ++i) {
    light[i] = static_cast<float>(i * i) / static_cast<float>(light.size() * light.size());
  }
  const PictureView picture = {100, 1, {&light[0], &light[100], &light[200]}, 100};
  ForEachTarget([&](Target) {
    const ShowFunction none;
    float greys[112];
    ShownGreys(picture, none)(0, greys);
    for (size_t i = 0; i < 100; ++i) {
      const double expected =
          SrgbOetf(Luminance<double>({light[i], light[100 + i], light[200 + i]}));
      CHECK(greys[i] == Approx(expected).margin(5e-7));
    }
  });
}

TEST_CASE("The SSIM of two even greys is that of their means", "[ssim]") {
  // Variances are 0 up to rounding, 1e-16 beside C2 = 9e-4.
  const double expected = (2 * 0.25 * 0.75 + 1e-4) / (0.25 * 0.25 + 0.75 * 0.75 + 1e-4);
  CHECK(SsimOf(Plane(11, 11, 0.25f), Plane(11, 11, 0.75f)) == Approx(expected).epsilon(1e-12));
}

TEST_CASE("The SSIM of a picture and its faded self is that of its variance", "[ssim]") {
  // One window: weights of 11x11 on a step, so mean and variance have closed forms. b - 1/2 is half
  // of a - 1/2, so the covariance is half of a's variance and b's a quarter.
  Plane a(11, 11, 0.25f), b(11, 11, 0.375f);
  double weight = 0;  // of the bright columns
  const Kernel window = GaussianKernel(1.5, 5);
  for (int x = 7; x < 11; ++x) {
    weight += window[static_cast<size_t>(x)];
    for (int y = 0; y < 11; ++y) {
      a.at(x, y) = 0.75f;
      b.at(x, y) = 0.625f;
    }
  }
  const double mean_a = 0.25 + 0.5 * weight, mean_b = 0.375 + 0.25 * weight;
  const double variance = 0.25 * weight * (1 - weight);
  const double expected = (2 * mean_a * mean_b + 1e-4) * (variance + 9e-4) /
                          ((mean_a * mean_a + mean_b * mean_b + 1e-4) * (1.25 * variance + 9e-4));
  CHECK(SsimOf(a, b) == Approx(expected).epsilon(1e-12));
  CHECK(SsimOf(b, a) == Approx(expected).epsilon(1e-12));
}

TEST_CASE("SSIM falls as the structure is lost", "[ssim]") {
  const Plane waves = Waves(32, 32, 0.4);
  double last = 1;
  for (const double amplitude : {0.3, 0.2, 0.1, 0.0, -0.2}) {
    const double now = SsimOf(Waves(32, 32, amplitude), waves);
    CHECK(now < last);
    last = now;
  }
  CHECK(last < 0);  // the negative: covariance of the other sign
}

}  // namespace
}  // namespace nacre
