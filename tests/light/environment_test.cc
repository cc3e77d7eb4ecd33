// SPDX-License-Identifier: Apache-2.0
// tests/light/environment_test.cc: images of environments: the mapping and its inverse, sampling
// that follows luminance and solid angle, pdfs that integrate to one, and the SIMD twins.
#include "light/environment.h"

#include <cmath>
#include <memory>
#include <random>
#include <vector>

#include "catch.h"
#include "chi_squared.h"
#include "light/environment_kernel.h"
#include "targets.h"

namespace nacre {
namespace {

Vec3d DirectionFromLatLong(double u, double v) {
  const double sin = std::sin(M_PI * v);
  return {std::sin(2 * M_PI * u) * sin, std::cos(M_PI * v), -std::cos(2 * M_PI * u) * sin};
}

size_t TexelCount(const EnvironmentMap& map) {
  return static_cast<size_t>(map.width) * static_cast<size_t>(map.height);
}

EnvironmentMap MakeMap(int width, int height, const std::vector<Vec3f>& texels, int threads = 1) {
  const auto shared = std::make_shared<std::vector<Vec3f>>(texels);
  return MakeEnvironmentMap(width, height, std::shared_ptr<const Vec3f[]>(shared, shared->data()),
                            threads);
}

// Random texels with a sun of a thousand times their radiance, and some black ones.
EnvironmentMap RandomMap(int width, int height) {
  std::mt19937 random(9);
  std::uniform_real_distribution<float> unit(0, 1);
  std::vector<Vec3f> texels;
  for (int i = 0; i < width * height; ++i) {
    const float scale = unit(random) < 0.1f ? 0.0f : 1.0f;
    texels.emplace_back(scale * unit(random), scale * unit(random), scale * unit(random));
  }
  texels[static_cast<size_t>(width * (height / 3) + width / 5)] = Vec3f(1000, 900, 700);
  return MakeMap(width, height, texels);
}

Vec3d RandomDirection(std::mt19937* random) {
  std::normal_distribution<double> normal;
  const double x = normal(*random), y = normal(*random), z = normal(*random);
  return Vec3d(x, y, z).normalized();
}

TEST_CASE("the image's rows run from +y down, its middle is -z, its right half +x") {
  CHECK((DirectionFromLatLong(0.3, 0.0) - Vec3d(0, 1, 0)).length() <= 1e-15);
  CHECK((DirectionFromLatLong(0.3, 1.0) - Vec3d(0, -1, 0)).length() <= 1e-15);
  CHECK((DirectionFromLatLong(0.0, 0.5) - Vec3d(0, 0, -1)).length() <= 1e-15);
  CHECK((DirectionFromLatLong(0.25, 0.5) - Vec3d(1, 0, 0)).length() <= 1e-15);
  CHECK((DirectionFromLatLong(0.5, 0.5) - Vec3d(0, 0, 1)).length() <= 1e-15);
  CHECK(LatLongFromDirection(Vec3d(-1, 0, 0)).u == 0.75);
  CHECK(LatLongFromDirection(Vec3d(0, 1, 0)).v == 0);
  CHECK(LatLongFromDirection(Vec3d(0, -1, 0)).v == 1);
  // Just left of the seam: u is below 1 even where it rounds to it.
  CHECK(LatLongFromDirection(Vec3d(-1e-30, 0, -1)).u < 1);
}

TEST_CASE("latitude and longitude are the inverse of the direction, also next to the poles") {
  for (const double v : {1e-9, 1e-4, 0.2, 0.5, 0.9, 1 - 1e-6}) {
    for (const double u : {0.0, 0.1, 0.25, 0.6, 0.999}) {
      CAPTURE(u, v);
      const LatLong<double> at = LatLongFromDirection(DirectionFromLatLong(u, v));
      CHECK(std::abs(at.u - u) <= 1e-15);
      CHECK(std::abs(at.v - v) <= 1e-15 + 1e-10 * std::min(v, 1 - v));
    }
  }
}

TEST_CASE("a map that several threads make is that of one") {
  std::mt19937 random(8);
  std::uniform_real_distribution<float> unit(0, 1);
  std::vector<Vec3f> texels;
  for (int i = 0; i < 19 * 37; ++i) texels.emplace_back(unit(random), 1e-41f * unit(random), 0.0f);
  const EnvironmentMap one = MakeMap(19, 37, texels);
  const EnvironmentMap several = MakeMap(19, 37, texels, 3);
  CHECK(several.sum == one.sum);
  REQUIRE(one.blocks.size() == 2 * 37);
  for (size_t i = 0; i < one.blocks.size(); ++i) {
    REQUIRE(several.blocks[i].sum == one.blocks[i].sum);
    REQUIRE(several.blocks[i].first == one.blocks[i].first);
  }
}

TEST_CASE("columns are those that a table of all texels gives, bit for bit") {
  std::mt19937 random(5);
  std::uniform_real_distribution<float> unit(0, 1);
  for (const int width : {1, 2, 15, 16, 17, 33, 640, 1000}) {
    CAPTURE(width);
    std::vector<Vec3f> texels;
    for (int x = 0; x < width; ++x) {
      // Black ones, denormals, and suns among dim ones.
      const float kind = unit(random);
      const float scale = kind < 0.2f ? 0 : kind < 0.3f ? 1e-40f : kind < 0.31f ? 1e6f : 1;
      texels.emplace_back(scale * unit(random), scale * unit(random), scale * unit(random));
    }
    texels[static_cast<size_t>(width / 2)] = Vec3f(3, 2, 1);
    const EnvironmentMap map = MakeMap(width, 1, texels);
    std::vector<double> luminances;
    for (const Vec3f& texel : texels) luminances.push_back(TexelLuminance(texel));
    const std::vector<CdfEntry> table = MakeInverseCdf(luminances);
    const auto check = [&](double u) {
      const CdfPick got = FindColumn(map, 0, u), want = PickIndex(table, u);
      if (got.index != want.index || got.remapped != want.remapped) {
        CAPTURE(u, got.index, want.index, got.remapped, want.remapped);
        FAIL("another texel, or another place in it");
      }
    };
    for (int i = 0; i < 20000; ++i) check(static_cast<double>(random()) * 0x1p-32);
    check(0);
    check(1 - 0x1p-32);
    // On the edges between texels, and a step to either side of them.
    for (const CdfEntry& entry : table) {
      for (const double u :
           {entry.upper, std::nextafter(entry.upper, 0.0), std::nextafter(entry.upper, 1.0)}) {
        if (u < 1) check(u);
      }
    }
  }
}

TEST_CASE("texels' solid angles add up to the sphere") {
  for (const int height : {1, 2, 7, 512}) {
    double sum = 0;
    for (int y = 0; y < height; ++y) sum += 2 * height * TexelSolidAngle(2 * height, height, y);
    CHECK(sum == Approx(4 * M_PI).epsilon(1e-12));
  }
}

TEST_CASE("pdfs times solid angles are the texels' shares of the light, and add up to 1") {
  const EnvironmentMap map = RandomMap(40, 21);
  double sum = 0;
  for (int y = 0; y < map.height; ++y) {
    for (int x = 0; x < map.width; ++x) {
      const Vec3d centre = DirectionFromLatLong((x + 0.5) / map.width, (y + 0.5) / map.height);
      sum += TexelAt(map, centre).pdf * TexelSolidAngle(map.width, map.height, y);
    }
  }
  CHECK(std::abs(sum - 1) <= 1e-6);
}

TEST_CASE("samples follow the pdf: texels by their share, directions evenly within") {
  constexpr int kSamples = 100000;
  for (const auto& [width, height] : {std::pair(24, 12), std::pair(15, 7), std::pair(3, 1)}) {
    CAPTURE(width, height);
    const EnvironmentMap map = RandomMap(width, height);
    const auto columns = static_cast<size_t>(width);
    std::vector<double> probabilities, counts(TexelCount(map));
    for (size_t i = 0; i < TexelCount(map); ++i) {
      probabilities.push_back(TexelOf(map, i).pdf *
                              TexelSolidAngle(width, height, static_cast<int>(i / columns)));
    }
    // The two halves, by solid angle, of the sun's texel, which has enough samples.
    double sun = 0, upper = 0, left = 0;
    std::mt19937 random(4);
    std::uniform_real_distribution<double> unit(0, 1);
    for (int i = 0; i < kSamples; ++i) {
      const double u0 = unit(random), u1 = unit(random);
      const EnvironmentSample<double> sample = SampleEnvironment<double>(map, u0, u1);
      REQUIRE(std::abs(sample.to_light.length() - 1) <= 1e-7);
      const size_t index = TexelIndexAt(map, sample.to_light);
      const EnvironmentTexel texel = TexelOf(map, index);
      if (sample.texel.pdf != texel.pdf) FAIL("the sample's pdf is that of another texel");
      counts[index] += 1;
      if (texel.red == 1000) {
        const auto row = static_cast<double>(index / columns);
        const double top = std::cos(M_PI * row / height);
        const double bottom = std::cos(M_PI * (row + 1) / height);
        const double column = LatLongFromDirection(sample.to_light).u * width;
        sun += 1;
        upper += (top - sample.to_light.y) / (top - bottom) < 0.5;
        left += column - std::floor(column) < 0.5;
      }
    }
    CHECK(FollowsProbabilities(counts, kSamples, probabilities));
    // Five standard deviations of a fair coin.
    CHECK(std::abs(upper - sun / 2) <= 2.5 * std::sqrt(sun));
    CHECK(std::abs(left - sun / 2) <= 2.5 * std::sqrt(sun));
  }
}

TEST_CASE("the mean of radiance over pdf is the integral of radiance") {
  const EnvironmentMap map = RandomMap(32, 16);
  double integral = 0, mean = 0;
  for (size_t i = 0; i < TexelCount(map); ++i) {
    integral += TexelOf(map, i).green * TexelSolidAngle(32, 16, static_cast<int>(i / 32));
  }
  constexpr int kSteps = 1500;
  for (int i = 0; i < kSteps * kSteps; ++i) {
    const EnvironmentSample<double> sample =
        SampleEnvironment<double>(map, (i % kSteps + 0.5) / kSteps, (i / kSteps + 0.5) / kSteps);
    mean += sample.texel.green / double{sample.texel.pdf} / (1.0 * kSteps * kSteps);
  }
  // Of 1500 steps each row, and each column of it, gets its share within 2 steps.
  CHECK(mean == Approx(integral).epsilon(2e-3));
}

TEST_CASE("a black environment has no samples, and a black row none in it") {
  const EnvironmentMap black = MakeMap(4, 2, std::vector<Vec3f>(8, Vec3f(0)));
  CHECK(SampleEnvironment<double>(black, 0.3, 0.4).texel.pdf == 0);
  CHECK(TexelAt(black, Vec3d(1, 0, 0)).pdf == 0);
  std::vector<Vec3f> half(8, Vec3f(0));
  half[6] = Vec3f(1);
  const EnvironmentMap map = MakeMap(4, 2, half);
  for (int i = 0; i < 100; ++i) {
    const EnvironmentSample<double> sample = SampleEnvironment<double>(map, i * 0.01, i * 0.01);
    CHECK(sample.to_light.y <= 0);
    CHECK(sample.texel.pdf == Approx(1 / (M_PI / 2)).epsilon(1e-6));
  }
  ForEachTarget(
      [&](Target) { CHECK(SampleEnvironments(black, {123456u}, {654321u})[0].texel.pdf == 0); });
}

TEST_CASE("SIMD environments agree with their double twins on every target") {
  const EnvironmentMap map = RandomMap(512, 256);
  std::mt19937 random(2);
  std::vector<Vec3f> directions;
  std::vector<uint32_t> bits0, bits1;
  for (int i = 0; i < 5000; ++i) {
    directions.emplace_back(RandomDirection(&random));
    bits0.push_back(static_cast<uint32_t>(random()));
    bits1.push_back(static_cast<uint32_t>(random()));
  }
  directions.insert(directions.end(), {{0, 1, 0}, {0, -1, 0}, {-1e-30f, 0, -1}, {0, 0, -1}});
  bits0.push_back(0xffffffffu);
  bits1.push_back(0xffffffffu);
  ForEachTarget([&](Target) {
    const std::vector<EnvironmentTexel> texels = LookUpTexels(map, directions);
    size_t others = 0;
    for (size_t i = 0; i < directions.size(); ++i) {
      others += texels[i].pdf != TexelAt(map, Vec3d(directions[i])).pdf;
    }
    // Latitude and longitude in float have errors of 1e-4 texels: that fraction lies in a
    // neighbouring texel.
    CHECK(others <= 5 + directions.size() / 1000);
    const std::vector<EnvironmentSample<float>> samples = SampleEnvironments(map, bits0, bits1);
    double worst = 0;
    for (size_t i = 0; i < samples.size(); ++i) {
      const EnvironmentSample<double> want =
          SampleEnvironment<double>(map, bits0[i] * 0x1p-32, bits1[i] * 0x1p-32);
      worst = std::max(worst, (Vec3d(samples[i].to_light) - want.to_light).length());
      CHECK(samples[i].texel.pdf == want.texel.pdf);
      CHECK(samples[i].texel.blue == want.texel.blue);
    }
    CHECK(worst <= 1e-6);
  });
}

}  // namespace
}  // namespace nacre
