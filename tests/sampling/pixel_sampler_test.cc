// SPDX-License-Identifier: Apache-2.0
// tests/sampling/pixel_sampler_test.cc: the samples of pixels: weights, pdfs, unbiasedness.
#include "sampling/pixel_sampler.h"

#include <cmath>
#include <set>
#include <vector>

#include "catch.h"
#include "targets.h"

namespace nacre {
namespace {

constexpr PixelFilter kFilters[] = {{FilterKind::kBox, 1},
                                    {FilterKind::kBox, 1.7},
                                    {FilterKind::kGaussian, 3},
                                    {FilterKind::kBlackmanHarris, 3.3},
                                    {FilterKind::kMitchell, 4}};

TEST_CASE("One sample per pixel is the centre", "[sampling]") {
  for (const PixelFilter& filter : kFilters) {
    const PixelSampler sampler = MakePixelSampler(filter, 1, 7);
    const PixelSample sample = SamplePixel(sampler, 12, 34, 0);
    CHECK((sample.dx == 0 && sample.dy == 0 && sample.weight == 1));
  }
}

TEST_CASE("The weights of a pixel have the mean 1", "[sampling]") {
  for (const PixelFilter& filter : kFilters) {
    for (const int spp : {1, 2, 3, 4, 5, 7, 8, 16, 31, 64, 100, 256}) {
      const PixelSampler sampler = MakePixelSampler(filter, spp, 0);
      double sum = 0;
      for (int i = 0; i < spp; ++i) sum += SamplePixel(sampler, 3, 5, i).weight;
      CAPTURE(static_cast<int>(filter.kind), spp);
      CHECK(std::abs(sum / spp - 1) <= 1e-14 * spp);  // one rounding per sum
    }
  }
}

TEST_CASE("Samples have the filter as their signed density", "[sampling]") {
  // Sums of weights in bins of x against the integral of the filter there. Over pixels samples are
  // independent; within a pixel they are better than that, so 4.5 standard deviations of
  // independent samples are a bound, by Chebyshev and in practice.
  constexpr int kBins = 40, kPixels = 20'000, kSpp = 16;
  for (const PixelFilter& filter : kFilters) {
    const PixelSampler sampler = MakePixelSampler(filter, kSpp, 3);
    std::vector<double> sums_x(kBins), sums_y(kBins), squares(kBins);
    for (int pixel = 0; pixel < kPixels; ++pixel) {
      for (int i = 0; i < kSpp; ++i) {
        const PixelSample s = SamplePixel(sampler, pixel % 200, pixel / 200, i);
        const auto bin = [&](double d) {
          const int b = static_cast<int>((d / filter.width + 0.5) * kBins);
          return static_cast<size_t>(std::min(b, kBins - 1));
        };
        CHECK_FALSE((std::abs(s.dx) > filter.width / 2 || std::abs(s.dy) > filter.width / 2));
        sums_x[bin(s.dx)] += s.weight;
        sums_y[bin(s.dy)] += s.weight;
        squares[bin(s.dx)] += s.weight * s.weight;
      }
    }
    constexpr double kCount = static_cast<double>(kPixels) * kSpp;
    for (size_t b = 0; b < kBins; ++b) {
      const auto integral = [&](double x) {
        return std::copysign(FilterIntegral(filter, std::abs(x)), x);
      };
      const double left = (static_cast<double>(b) / kBins - 0.5) * filter.width;
      const double expected = integral(left + filter.width / kBins) - integral(left);
      // One sample's weight more, for bins that few samples reach.
      const double bound =
          (4.5 * std::sqrt(squares[b]) + 4 * std::abs(sampler.positive_weight)) / kCount;
      CAPTURE(static_cast<int>(filter.kind), b);
      CHECK(std::abs(sums_x[b] / kCount - expected) <= bound);
      CHECK(std::abs(sums_y[b] / kCount - expected) <= bound);
    }
  }
}

// A smooth image, and its filtered value, by the midpoint rule.
double Picture(double x, double y) { return 1 + std::cos(0.9 * x + 0.3) * std::sin(1.7 * y + 1); }

double Filtered(const PixelFilter& filter) {
  constexpr int kSteps = 400;
  const double h = filter.width / kSteps;
  double sum = 0;
  for (int i = 0; i < kSteps; ++i) {
    for (int j = 0; j < kSteps; ++j) {
      const double x = (i + 0.5) * h - filter.width / 2, y = (j + 0.5) * h - filter.width / 2;
      sum += FilterValue(filter, x) * FilterValue(filter, y) * Picture(x, y) * h * h;
    }
  }
  return sum;
}

TEST_CASE("Estimates are unbiased and their errors independent", "[sampling]") {
  constexpr int kSide = 100;
  for (const PixelFilter& filter : kFilters) {
    const double exact = Filtered(filter);
    for (const int spp : {2, 4, 16, 64}) {
      const PixelSampler sampler = MakePixelSampler(filter, spp, 11);
      std::vector<double> errors;
      double sum = 0, squares = 0, neighbours = 0;
      for (int pixel = 0; pixel < kSide * kSide; ++pixel) {
        double mean = 0;
        for (int i = 0; i < spp; ++i) {
          const PixelSample s = SamplePixel(sampler, pixel % kSide, pixel / kSide, i);
          mean += s.weight * Picture(s.dx, s.dy) / spp;
        }
        const double error = mean - exact;
        sum += error;
        squares += error * error;
        if (!errors.empty()) neighbours += error * errors.back();
        errors.push_back(error);
      }
      const double deviation = std::sqrt(squares / (kSide * kSide));
      CAPTURE(static_cast<int>(filter.kind), spp, deviation);
      // 4.5 standard errors, and the quantile tables' 5e-4 of the negative part's 6e-2.
      CHECK(std::abs(sum) / (kSide * kSide) <= 4.5 * deviation / kSide + 3e-5);
      CHECK(std::abs(neighbours / squares) <= 4.5 / kSide);
    }
  }
}

std::vector<PixelRun> RowsOf(const Window& window) {
  std::vector<PixelRun> rows;
  for (int y = window.y0; y < window.y1; ++y) rows.push_back({window.x0, y, window.width()});
  return rows;
}

size_t CountPixels(const std::vector<PixelRun>& runs) {
  size_t count = 0;
  for (const PixelRun& run : runs) count += static_cast<size_t>(run.count);
  return count;
}

// Samples of the runs' pixels, in arrays exactly as large as documented, for the address sanitizer.
struct Placed {
  Placed(const PixelSampler& sampler, const std::vector<PixelRun>& runs, int first, int count)
      : size(CountPixels(runs) * static_cast<size_t>(count)), x(size), y(size) {
    PixelBatch batch(CountPixels(runs));
    PreparePixels(sampler, runs, &batch);
    CHECK(batch.count == CountPixels(runs));
    SamplePixels(sampler, batch, first, count, x.data(), y.data());
  }

  size_t size;
  AlignedArray<double> x, y;
};

TEST_CASE("the only sample of a pixel is placed at its centre on every target", "[sampling]") {
  const Window pixels{-3, 5, 8, 9};
  ForEachTarget([&](Target) {
    AlignedArray<double> x(pixels.pixel_count()), y(pixels.pixel_count());
    PlaceCenters(pixels, x.data(), y.data());
    size_t wrong = 0;
    for (int row = pixels.y0; row < pixels.y1; ++row) {
      for (int column = pixels.x0; column < pixels.x1; ++column) {
        const size_t i = IndexIn(pixels, column, row);
        wrong += x[i] != column + 0.5 || y[i] != row + 0.5;
      }
    }
    CHECK(wrong == 0);
  });
}

TEST_CASE("SamplePixels is SamplePixel to the bit on every target", "[sampling]") {
  const Window pixels{-3, 5, 8, 9};
  const std::vector<PixelRun> some{{-1, 5, 1}, {3, 5, 5}, {-3, 6, 11}, {-2, 8, 9}};
  for (const PixelFilter& filter : kFilters) {
    for (const int spp : {2, 3, 16, 61}) {
      const PixelSampler sampler = MakePixelSampler(filter, spp, 9);
      ForEachTarget([&](Target) {
        for (const auto& [first, count] : {std::pair{0, spp}, {spp / 2, spp - spp / 2}, {0, 1}}) {
          CAPTURE(static_cast<int>(filter.kind), spp, first, count);
          for (const std::vector<PixelRun>& runs : {RowsOf(pixels), some}) {
            const Placed placed(sampler, runs, first, count);
            size_t wrong = 0, i = 0;
            for (int sample = 0; sample < count; ++sample) {
              for (const PixelRun& run : runs) {
                for (int x = run.x; x < run.x + run.count; ++x, ++i) {
                  const PixelSample s = SamplePixel(sampler, x, run.y, first + sample);
                  wrong += placed.x[i] != x + 0.5 + s.dx || placed.y[i] != run.y + 0.5 + s.dy ||
                           SampleWeight(sampler, first + sample) != s.weight;
                }
              }
            }
            CHECK((wrong == 0 && i == placed.size));
          }
          // And the samples of listed pixels, pixel by pixel.
          const std::vector<SampledPixel> list{{5, -2, 0}, {7, 9, 0}, {5, -2, 0}};
          AlignedArray<double> list_x(3 * static_cast<size_t>(count));
          AlignedArray<double> list_y(3 * static_cast<size_t>(count));
          SamplePixelList(&sampler, list, first, count, list_x.data(), list_y.data());
          size_t wrong = 0, ray = 0;
          for (const SampledPixel& pixel : list) {
            for (int i = first; i < first + count; ++i, ++ray) {
              const PixelSample s = SamplePixel(sampler, pixel.x, pixel.y, i);
              wrong += list_x[ray] != pixel.x + 0.5 + s.dx || list_y[ray] != pixel.y + 0.5 + s.dy;
            }
          }
          CHECK(wrong == 0);
        }
      });
    }
  }
}

TEST_CASE("Each pixel has a net of its own", "[sampling]") {
  const PixelSampler sampler = MakePixelSampler({FilterKind::kBox, 1}, 16, 0);
  std::set<double> first_positions;
  for (int pixel = 0; pixel < 1000; ++pixel) {
    std::set<int> boxes[3];  // 4 x 4, 16 x 1 and 1 x 16
    for (int i = 0; i < 16; ++i) {
      const PixelSample s = SamplePixel(sampler, pixel, 2 * pixel, i);
      const double x = s.dx + 0.5, y = s.dy + 0.5;
      boxes[0].insert(static_cast<int>(x * 4) * 4 + static_cast<int>(y * 4));
      boxes[1].insert(static_cast<int>(x * 16));
      boxes[2].insert(static_cast<int>(y * 16));
    }
    for (const auto& set : boxes) CHECK(set.size() == 16);
    first_positions.insert(SamplePixel(sampler, pixel, 2 * pixel, 0).dx);
  }
  CHECK(first_positions.size() == 1000);
}

TEST_CASE("Samples depend on pixel, index and seed only", "[sampling]") {
  const PixelSampler a = MakePixelSampler({FilterKind::kGaussian, 3}, 16, 5);
  const PixelSampler b = MakePixelSampler({FilterKind::kGaussian, 3}, 16, 5);
  const PixelSampler other = MakePixelSampler({FilterKind::kGaussian, 3}, 16, 6);
  int equal = 0;
  for (int i = 0; i < 16; ++i) {
    const PixelSample s = SamplePixel(a, 100, 200, i);
    CHECK(s.dx == SamplePixel(b, 100, 200, i).dx);
    CHECK(s.dy == SamplePixel(b, 100, 200, i).dy);
    equal += s.dx == SamplePixel(other, 100, 200, i).dx;
    equal += s.dx == SamplePixel(a, 101, 200, i).dx;
    equal += s.dx == SamplePixel(a, 200, 100, i).dx;
  }
  CHECK(equal == 0);
}

TEST_CASE("Sampling beats random pixels", "[sampling]") {
  // The error of 64 stratified samples of a smooth picture. That of independent samples would be 1
  // / 8 of the standard deviation of one.
  const PixelFilter filter{FilterKind::kBox, 1};
  const PixelSampler sampler = MakePixelSampler(filter, 64, 0);
  const double exact = Filtered(filter);
  double squares = 0, spread = 0;
  for (int pixel = 0; pixel < 1000; ++pixel) {
    double mean = 0;
    for (int i = 0; i < 64; ++i) {
      const PixelSample s = SamplePixel(sampler, pixel, 0, i);
      mean += Picture(s.dx, s.dy) / 64;
      spread += std::pow(Picture(s.dx, s.dy) - exact, 2) / 64;
    }
    squares += std::pow(mean - exact, 2);
  }
  CHECK(std::sqrt(squares) < 0.1 * std::sqrt(spread / 64));
}

}  // namespace
}  // namespace nacre
