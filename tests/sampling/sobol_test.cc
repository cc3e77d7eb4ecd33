// SPDX-License-Identifier: Apache-2.0
// tests/sampling/sobol_test.cc: the scrambled Sobol' sequence is a net, uniform and fast.
#include "sampling/sobol.h"

#include <cmath>
#include <numbers>
#include <random>
#include <set>
#include <vector>

#include "catch.h"
#include "sampling/hash.h"

namespace nacre {
namespace {

// Whether 2^m points have exactly one point in every box of size 2^-k by 2^-(m-k).
bool IsNet(const std::vector<Vec2d>& points, int m) {
  for (int k = 0; k <= m; ++k) {
    std::set<std::pair<int, int>> boxes;
    for (const Vec2d& p : points) {
      boxes.insert(
          {static_cast<int>(std::ldexp(p.x, k)), static_cast<int>(std::ldexp(p.y, m - k))});
    }
    if (boxes.size() != points.size()) return false;
  }
  return true;
}

// The 1 - 1e-6 quantile of chi-squared, nearly (Wilson and Hilferty 1931).
double ChiSquaredLimit(double degrees) {
  const double v = 2 / (9 * degrees);
  return degrees * std::pow(1 - v + 4.75 * std::sqrt(v), 3);
}

TEST_CASE("Blocks of the first pair of each sequence are (0, m, 2)-nets", "[sampling]") {
  for (const uint32_t pair : {0u, kSobolPairs, 3 * kSobolPairs}) {
    for (uint64_t seed = 0; seed < 20; ++seed) {
      for (int m = 0; m <= 10; ++m) {
        for (const uint32_t block : {0u, 1u, 5u, 77u}) {
          std::vector<Vec2d> points;
          for (uint32_t i = 0; i < (1u << m); ++i) {
            points.push_back(SobolSample2D((block << m) + i, pair, Mix64(seed)));
          }
          if (!IsNet(points, m)) FAIL("pair " << pair << " m " << m << " block " << block);
        }
      }
    }
  }
}

TEST_CASE("Every dimension is a (0, m, 1)-net", "[sampling]") {
  for (uint32_t dimension = 0; dimension < kSobolDimensions; ++dimension) {
    for (const int m : {1, 4, 8, 12}) {
      std::set<uint32_t> intervals, scrambled;
      for (uint32_t i = 0; i < (1u << m); ++i) {
        const uint32_t bits = SobolBits(i, dimension);
        intervals.insert(bits >> (32 - m));
        scrambled.insert(OwenScramble(bits, 0x9e3779b9u * (dimension + 1)) >> (32 - m));
      }
      CHECK(intervals.size() == size_t{1} << m);
      CHECK(scrambled.size() == size_t{1} << m);
    }
  }
}

TEST_CASE("The direction numbers have Sobol's property A in all dimensions", "[sampling]") {
  // Joe and Kuo's numbers satisfy it: 2^d points fall into the 2^d orthants of d dimensions. A
  // wrong digit in a first row of the matrices breaks it for some d.
  for (uint32_t d = 1; d <= kSobolDimensions; ++d) {
    std::set<uint32_t> orthants;
    for (uint32_t i = 0; i < (1u << d); ++i) {
      uint32_t orthant = 0;
      for (uint32_t k = 0; k < d; ++k) orthant |= (SobolBits(i, k) >> 31) << k;
      orthants.insert(orthant);
    }
    CHECK(orthants.size() == size_t{1} << d);
  }
}

TEST_CASE("The unscrambled sequence has the published points", "[sampling]") {
  // As Joe and Kuo's page prints them for ten dimensions; it goes in the order of Gray's code,
  // where what is point 2 here comes after point 3.
  for (uint32_t k = 0; k < 10; ++k) CHECK(UnitFromBits(SobolBits(1, k)) == 0.5);
  const double second[] = {0.25, 0.75, 0.75, 0.75, 0.25, 0.25, 0.75, 0.25, 0.25, 0.25};
  for (uint32_t k = 0; k < 10; ++k) CHECK(UnitFromBits(SobolBits(2, k)) == second[k]);
}

TEST_CASE("Every dimension begins with Joe and Kuo's direction numbers", "[sampling]") {
  // new-joe-kuo-6.21201, dimensions 2 to 16: m_1, m_2, ... Point 2^k is m_k+1 / 2^(k+1).
  const std::vector<std::vector<uint32_t>> published = {{1},
                                                        {1, 3},
                                                        {1, 3, 1},
                                                        {1, 1, 1},
                                                        {1, 1, 3, 3},
                                                        {1, 3, 5, 13},
                                                        {1, 1, 5, 5, 17},
                                                        {1, 1, 5, 5, 5},
                                                        {1, 1, 7, 11, 19},
                                                        {1, 1, 5, 1, 1},
                                                        {1, 1, 1, 3, 11},
                                                        {1, 3, 5, 5, 31},
                                                        {1, 3, 3, 9, 7, 49},
                                                        {1, 1, 1, 15, 21, 21},
                                                        {1, 3, 1, 13, 27, 49}};
  REQUIRE(published.size() == kSobolDimensions - 1);
  for (uint32_t i = 0; i < published.size(); ++i) {
    for (uint32_t k = 0; k < published[i].size(); ++k) {
      CAPTURE(i + 2, k);
      CHECK(SobolBits(1u << k, i + 1) == published[i][k] << (31 - k));
    }
  }
}

TEST_CASE("Owen's scrambling lets a bit depend on higher bits only", "[sampling]") {
  std::mt19937 engine(1);
  std::uniform_int_distribution<uint32_t> any;
  for (int i = 0; i < 10'000; ++i) {
    const uint32_t a = any(engine), seed = any(engine);
    const uint32_t keep = any(engine) % 32;
    const uint32_t b = a ^ (any(engine) >> keep);  // the same in the upper `keep` bits
    const uint32_t difference = OwenScramble(a, seed) ^ OwenScramble(b, seed);
    CHECK((keep == 0 || difference >> (32 - keep) == 0));
    CHECK((a == b) == (difference == 0));
  }
}

TEST_CASE("Samples are multiples of 2^-32 in [0, 1)", "[sampling]") {
  for (uint32_t i = 0; i < 10'000; ++i) {
    const Vec2d p = SobolSample2D(i, i % 20, i);
    for (const double u : {p.x, p.y}) {
      CHECK((u >= 0 && u < 1));
      CHECK(u * 0x1p32 == std::floor(u * 0x1p32));
    }
  }
}

TEST_CASE("Over seeds every sample is uniform", "[sampling]") {
  constexpr size_t kBins = 16;
  constexpr int kSeeds = 200'000;
  for (const auto& [index, pair] : {std::pair{0u, 0u}, {1u, 0u}, {13u, 0u}, {0u, 3u}, {5u, 9u}}) {
    std::vector<int> counts(kBins * kBins);
    for (int seed = 0; seed < kSeeds; ++seed) {
      const Vec2d p = SobolSample2D(index, pair, PixelSeed(seed % 500, seed / 500, 0));
      ++counts[static_cast<size_t>(p.x * kBins) * kBins + static_cast<size_t>(p.y * kBins)];
    }
    double chi_squared = 0;
    const double expected = static_cast<double>(kSeeds) / (kBins * kBins);
    for (const int count : counts)
      chi_squared += (count - expected) * (count - expected) / expected;
    CAPTURE(index, pair);
    CHECK(chi_squared < ChiSquaredLimit(kBins * kBins - 1));
  }
}

TEST_CASE("Different sequences of one seed are uncorrelated", "[sampling]") {
  constexpr int kCount = 1 << 14;
  const uint32_t pairs[] = {0, 1, 7, 8, 9, 16};
  for (const uint32_t a : pairs) {
    for (const uint32_t b : pairs) {
      if (a == b) continue;
      double sum = 0;
      for (uint32_t i = 0; i < kCount; ++i) {
        sum += (SobolSample2D(i, a, 42).x - 0.5) * (SobolSample2D(i, b, 42).x - 0.5) * 12;
      }
      // 5 standard deviations of independent samples.
      CHECK(std::abs(sum / kCount) < 5 / std::sqrt(kCount));
    }
  }
}

// The slope of log(RMS error over seeds) against log(count) for the mean of a smooth function.
template <class Sample>
double ConvergenceSlope(const Sample& sample) {
  const double exact = (std::numbers::e - 1) * (1 - std::cos(1.0));
  double sx = 0, sy = 0, sxx = 0, sxy = 0;
  int n = 0;
  for (int m = 4; m <= 12; ++m, ++n) {
    double squares = 0;
    for (int seed = 0; seed < 64; ++seed) {
      double sum = 0;
      for (uint32_t i = 0; i < (1u << m); ++i) {
        const Vec2d p = sample(i, seed);
        sum += std::exp(p.x) * std::sin(p.y);
      }
      squares += std::pow(std::ldexp(sum, -m) - exact, 2);
    }
    const double x = m * std::log(2.0), y = 0.5 * std::log(squares / 64);
    sx += x;
    sy += y;
    sxx += x * x;
    sxy += x * y;
  }
  return (n * sxy - sx * sy) / (n * sxx - sx * sx);
}

TEST_CASE("Scrambled Sobol' converges faster than N^-1.3 on a smooth function", "[sampling]") {
  const double sobol = ConvergenceSlope(
      [](uint32_t i, int seed) { return SobolSample2D(i, 0, Mix64(static_cast<uint64_t>(seed))); });
  std::mt19937_64 engine(5);
  std::uniform_real_distribution<double> uniform;
  const double random = ConvergenceSlope([&](uint32_t, int) {
    return Vec2d{uniform(engine), uniform(engine)};
  });
  INFO("slopes: Sobol " << sobol << ", random " << random);
  CHECK(sobol < -1.3);
  CHECK(std::abs(random + 0.5) < 0.05);
}

TEST_CASE("Pixel seeds depend on coordinates and seed", "[sampling]") {
  std::set<uint64_t> seeds;
  for (int y = -8; y < 300; ++y) {
    for (int x = -8; x < 300; ++x) {
      seeds.insert(PixelSeed(x, y, 0));
      seeds.insert(PixelSeed(x, y, 1));
    }
  }
  CHECK(seeds.size() == size_t{2} * 308 * 308);
  // Pinned: a change of the hash changes every picture.
  CHECK(PixelSeed(0, 0, 0) == 0x48218226ff3cd4bfu);
  CHECK(SobolSample2D(3, 0, PixelSeed(10, 20, 0)).x * 0x1p32 == 2619199486.0);
}

}  // namespace
}  // namespace nacre
