// SPDX-License-Identifier: Apache-2.0
// tests/texture/sample_test.cc: look-ups against tables/texture.json, their edges, and the SIMD
// twin against the scalar one.
#include "texture/sample.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <random>
#include <string>

#include <Imath/half.h>

#include "base/parallel.h"
#include "catch.h"
#include "tables.h"
#include "targets.h"
#include "texture/lesson.h"
#include "texture/sample_kernel.h"

namespace nacre {
namespace {

constexpr Wrap kWraps[] = {Wrap::kRepeat, Wrap::kClamp, Wrap::kMirror};
constexpr const char* kWrapNames[] = {"repeat", "clamp", "mirror"};
constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

// One point, every channel, by the kernel.
std::vector<float> SampleAt(const MipChain& image, const SampleSettings& settings, double u,
                            double v, const TextureFootprint<float>& footprint = {}) {
  constexpr size_t kRoom = 16;
  const std::vector<double> us(kRoom, u), vs(kRoom, v);
  const std::vector<float> f[4] = {
      std::vector<float>(kRoom, footprint.du_dx), std::vector<float>(kRoom, footprint.dv_dx),
      std::vector<float>(kRoom, footprint.du_dy), std::vector<float>(kRoom, footprint.dv_dy)};
  std::vector<float> out[4];
  float* to[4];
  for (int c = 0; c < 4; ++c) {
    out[c].resize(kRoom);
    to[c] = out[c].data();
  }
  SampleTexture(image, settings,
                {us.data(), vs.data(), {f[0].data(), f[1].data(), f[2].data(), f[3].data()}, 1},
                image.channels, to);
  std::vector<float> values;
  for (int c = 0; c < image.channels; ++c) values.push_back(out[c][0]);
  return values;
}

MipChain RandomImage(int width, int height, int channels, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> value(0, 1);
  std::vector<float> values(static_cast<size_t>(width * height * channels));
  for (float& v : values) v = value(random);
  return MakeMipChain(width, height, channels, std::move(values));
}

MipChain TableImage(const nlohmann::json& table) {
  std::vector<float> values;
  for (const auto& row : table.at("texels_row_major_row0_is_v0")) {
    for (const auto& value : row) values.push_back(value.get<float>());
  }
  return MakeMipChain(table.at("width"), table.at("height"), 1, std::move(values));
}

TEST_CASE("look-ups match the table", "[table]") {
  const nlohmann::json table = LoadTable("texture");
  const MipChain image = TableImage(table);
  REQUIRE(table.at("rows").size() > 0);
  for (const auto& row : table.at("rows")) {
    const double u = row["u"], v = row["v"];
    for (size_t w = 0; w < 3; ++w) {
      const SampleSettings linear{TextureFilter::kBilinear, kWraps[w], kWraps[w]};
      const SampleSettings nearest{TextureFilter::kNearest, kWraps[w], kWraps[w]};
      CAPTURE(u, v, kWrapNames[w]);
      // 4u is the table's rule.
      const auto close = [&](double got, const char* prefix, double unit) {
        const double reference = TableNumber(row[std::string(prefix) + kWrapNames[w]]);
        return std::abs(got - reference) <= 4 * unit * std::abs(reference);
      };
      CHECK(close(LessonNearest(image, nearest, u, v, 0), "lesson_nearest_", kHalfUlpDouble));
      CHECK(close(LessonBilinear(image, linear, u, v, 0), "lesson_bilinear_", kHalfUlpDouble));
      CHECK(close(SampleNearest(image, 0, nearest, u, v, 0), "gpu_nearest_", kHalfUlpDouble));
      CHECK(close(SampleBilinear(image, 0, linear, u, v, 0), "gpu_bilinear_", kHalfUlpDouble));
      ForEachTarget([&](Target) {
        CHECK(close(double{SampleAt(image, nearest, u, v)[0]}, "gpu_nearest_", kHalfUlpFloat));
        CHECK(close(double{SampleAt(image, linear, u, v)[0]}, "gpu_bilinear_", kHalfUlpFloat));
      });
    }
  }
}

TEST_CASE("the lesson's lerp is exact at both ends") {
  CHECK(LessonLerp(0.1f, 0.7f, 0.0f) == 0.1f);
  CHECK(LessonLerp(0.1f, 0.7f, 1.0f) == 0.7f);
}

TEST_CASE("coordinates that are no numbers, or not near 0, have a defined texel") {
  for (const Wrap wrap : kWraps) {
    CHECK(WrapCoordinate(kNan, wrap) == 0);
    CHECK(WrapCoordinate(-kInfinity, wrap) == 0);
    CHECK(WrapCoordinate(kInfinity, wrap) == (wrap == Wrap::kClamp ? 1 : 0));
    // 2^30 is an even number of periods, and exact in double.
    const double huge = 0x1p30;
    CHECK(WrapCoordinate(huge + 0.25, wrap) == (wrap == Wrap::kClamp ? 1 : 0.25));
    CHECK(WrapCoordinate(-huge + 0.25, wrap) == (wrap == Wrap::kClamp ? 0 : 0.25));
  }
  CHECK(WrapCoordinate(1.0, Wrap::kRepeat) == 0);
  CHECK(WrapCoordinate(1.0, Wrap::kMirror) == 1);
  CHECK(WrapCoordinate(1.25, Wrap::kMirror) == 0.75);
  CHECK(WrapCoordinate(-0.25, Wrap::kMirror) == 0.25);
  // Just below 0, so that it wraps to 1 itself: the last texel, not the one behind it.
  CHECK(FindTaps(WrapCoordinate(-1e-20, Wrap::kRepeat), 4, Wrap::kRepeat).near == 3);
}

TEST_CASE("every size and coordinate samples within the image, the same in both twins") {
  const double inputs[] = {0,           1,          0.5,     -0.5,         -1e-20,
                           1 - 0x1p-53, 0x1p30,     -0x1p30, 0x1p30 + 0.3, 1e300,
                           kInfinity,   -kInfinity, kNan,    0.99999999};
  const int sizes[][2] = {{1, 1}, {1, 5}, {7, 1}, {4, 4}, {5, 3}};
  ForEachTarget([&](Target) {
    for (const auto& size : sizes) {
      for (int channels = 1; channels <= 4; ++channels) {
        const MipChain image = RandomImage(size[0], size[1], channels, 3);
        for (const Wrap wrap : kWraps) {
          for (const double u : inputs) {
            for (const double v : inputs) {
              CAPTURE(size[0], size[1], channels, static_cast<int>(wrap), u, v);
              const auto nearest = SampleAt(image, {TextureFilter::kNearest, wrap, wrap}, u, v);
              const auto linear = SampleAt(image, {TextureFilter::kBilinear, wrap, wrap}, u, v);
              for (int c = 0; c < channels; ++c) {
                const SampleSettings settings{TextureFilter::kBilinear, wrap, wrap};
                const double exact = SampleBilinear(image, 0, settings, u, v, c);
                const double texel = SampleNearest(image, 0, settings, u, v, c);
                REQUIRE(double{nearest[static_cast<size_t>(c)]} == texel);
                // Values of up to 1, five roundings.
                REQUIRE(std::abs(double{linear[static_cast<size_t>(c)]} - exact) <= 3e-7);
              }
            }
          }
        }
      }
    }
  });
}

TEST_CASE("the mip level follows the footprint, and every level is sampled alike") {
  const MipChain image = RandomImage(37, 20, 3, 5);
  std::mt19937 random(11);
  std::uniform_real_distribution<double> coordinate(-2, 3);
  std::uniform_real_distribution<double> exponent(-8, 2);
  const SampleSettings settings{TextureFilter::kTrilinear, Wrap::kRepeat, Wrap::kMirror};
  ForEachTarget([&](Target) {
    for (int i = 0; i < 300; ++i) {
      const double u = coordinate(random), v = coordinate(random);
      const auto draw = [&] { return static_cast<float>(std::exp2(exponent(random))); };
      const TextureFootprint<float> f{draw(), draw(), draw(), draw()};
      const double level = MipLevelOf<double>(image, {f.du_dx, f.dv_dx, f.du_dy, f.dv_dy});
      const std::vector<float> got = SampleAt(image, settings, u, v, f);
      for (int c = 0; c < 3; ++c) {
        // The level, up to 5, is right to a few 1e-7, and values differ by up to 1 from level to
        // level.
        CHECK(std::abs(double{got[static_cast<size_t>(c)]} -
                       SampleTrilinear(image, settings, level, u, v, c)) <= 3e-6);
      }
    }
    const auto mean = [&](float size) {
      return SampleAt(image, settings, 0.3, 0.3, {size, 0, 0, size})[0];
    };
    CHECK(mean(kNan) == image.Value(image.levels.size() - 1, 0, 0, 0));
    CHECK(mean(1e30f) == image.Value(image.levels.size() - 1, 0, 0, 0));
    CHECK(mean(0) ==
          SampleAt(image, {TextureFilter::kBilinear, Wrap::kRepeat, Wrap::kMirror}, 0.3, 0.3)[0]);
  });
  CHECK(MipLevelOf<double>(image, {2 / 37.0, 0, 0, 0}) == Approx(1));
  CHECK(MipLevelOf<double>(image, {0, 0, 0, 4 / 20.0}) == Approx(2));
}

TEST_CASE("a constant image has its value everywhere, to the bit") {
  const float value = 0.3f;
  const MipChain image = MakeMipChain(37, 20, 1, std::vector<float>(37 * 20, value));
  for (size_t level = 0; level < image.levels.size(); ++level) {
    const TexelView texels = image.Level(level);
    for (size_t i = 0; i < texels.size(); ++i) REQUIRE(texels[i] == value);
  }
  ForEachTarget([&](Target) {
    for (const TextureFilter filter :
         {TextureFilter::kNearest, TextureFilter::kBilinear, TextureFilter::kTrilinear}) {
      for (int i = 0; i < 100; ++i) {
        const double u = 0.01 * i, v = 1 - 0.013 * i;
        const float size = 0.001f * static_cast<float>(i * i);
        REQUIRE(SampleAt(image, {filter, Wrap::kRepeat, Wrap::kClamp}, u, v,
                         {size, 0, 0, size})[0] == value);
      }
    }
  });
}

MipChain FloatImage(int width, int height, int channels, const std::vector<float>& values) {
  Texels texels(nullptr, values.size());
  std::copy(values.begin(), values.end(), texels.As<float>());
  return {width, height, channels, std::move(texels)};
}

// Bits of all that an image gives at some points.
std::vector<uint32_t> BitsOf(const MipChain& image, TextureFilter filter, Wrap wrap) {
  constexpr size_t kPoints = 203, kRoom = kPoints + 16;
  std::mt19937 random(7);
  std::uniform_real_distribution<double> coordinate(-2, 3);
  std::uniform_real_distribution<float> exponent(-8, 2);
  std::vector<double> u(kRoom), v(kRoom);
  std::vector<float> footprint[4], out[6];
  for (size_t i = 0; i < kRoom; ++i) {
    u[i] = coordinate(random);
    v[i] = coordinate(random);
    for (auto& f : footprint) f.push_back(std::exp2(exponent(random)));
  }
  for (auto& o : out) o.resize(kRoom);
  const SamplePoints points{
      u.data(),
      v.data(),
      {footprint[0].data(), footprint[1].data(), footprint[2].data(), footprint[3].data()},
      kPoints};
  float* const to[4] = {out[0].data(), out[1].data(), out[2].data(), out[3].data()};
  SampleTexture(image, {filter, wrap, wrap}, points, 4, to);
  SampleSlopes(image, {filter, wrap, wrap}, points, out[4].data(), out[5].data());
  std::vector<uint32_t> bits;
  for (const auto& o : out) {
    for (size_t i = 0; i < kPoints; ++i) bits.push_back(std::bit_cast<uint32_t>(o[i]));
  }
  return bits;
}

TEST_CASE("an image keeps its precision, and gives the bits of floats") {
  struct Case {
    TexelKind kind;
    size_t bytes;  // of a value
    float (*draw)(std::mt19937&);
  };
  const Case cases[] = {{TexelKind::kBytes, 1,
                         [](std::mt19937& random) {
                           return static_cast<float>(static_cast<double>(random() & 255) / 255);
                         }},
                        {TexelKind::kWords, 2,
                         [](std::mt19937& random) {
                           return static_cast<float>(static_cast<double>(random() & 65535) / 65535);
                         }},
                        // Halves of either sign, denormals among them.
                        {TexelKind::kWords, 2,
                         [](std::mt19937& random) {
                           return imath_half_to_float(static_cast<uint16_t>(random() & 0xbbff));
                         }},
                        {TexelKind::kFloats, 4, [](std::mt19937& random) {
                           return static_cast<float>(random()) * 0x1p-32f;
                         }}};
  constexpr int kWidth = 37, kHeight = 20;
  for (const Case& c : cases) {
    for (int channels = 1; channels <= 4; ++channels) {
      CAPTURE(&c - cases, channels);
      std::mt19937 random(3);
      std::vector<float> values(static_cast<size_t>(kWidth * kHeight * channels));
      for (float& value : values) value = c.draw(random);
      const MipChain image = MakeMipChain(kWidth, kHeight, channels, values);
      const MipChain floats = FloatImage(kWidth, kHeight, channels, values);
      REQUIRE(image.Level(0).kind == c.kind);
      REQUIRE(floats.Level(0).kind == TexelKind::kFloats);
      CHECK(image.ImageBytes() - values.size() * c.bytes < 4);  // the last one's padding
      CHECK(image.least == floats.least);
      CHECK(image.greatest == floats.greatest);
      for (size_t i = 0; i < values.size(); ++i) {
        REQUIRE(std::bit_cast<uint32_t>(image.Level(0)[i]) == std::bit_cast<uint32_t>(values[i]));
      }
      ForEachTarget([&](Target) {
        for (const Wrap wrap : kWraps) {
          for (const TextureFilter filter :
               {TextureFilter::kNearest, TextureFilter::kBilinear, TextureFilter::kTrilinear}) {
            REQUIRE(BitsOf(image, filter, wrap) == BitsOf(floats, filter, wrap));
          }
        }
      });
      for (size_t level = 1; level < image.levels.size(); ++level) {
        for (size_t i = 0; i < image.Level(level).size(); ++i) {
          REQUIRE(image.Level(level)[i] == floats.Level(level)[i]);
        }
      }
    }
  }
  // The sign of a zero is one of its bits.
  CHECK(std::signbit(MakeMipChain(2, 1, 1, {1, -0.0f}).Value(0, 1, 0, 0)));
}

TEST_CASE("a mip level takes memory once a look-up needs it") {
  constexpr int kSide = 64;
  const std::vector<float> white(3 * kSide * kSide, 1.0f);
  const auto size = [](float texels) {
    return TextureFootprint<float>{texels / kSide, 0, 0, texels / kSide};
  };
  const auto bytes = [](int side) { return static_cast<size_t>(3 * side * side) * sizeof(float); };
  constexpr SampleSettings kNearest{TextureFilter::kNearest}, kBilinear{TextureFilter::kBilinear};
  ForEachTarget([&](Target) {
    const MipChain image = MakeMipChain(kSide, kSide, 3, white);
    for (const SampleSettings& settings : {kNearest, kBilinear}) {
      SampleAt(image, settings, 0.3, 0.4, size(5));
    }
    SampleAt(image, {}, 0.3, 0.4, size(1));
    CHECK(image.LevelBytes() == 0);
    SampleAt(image, {}, 0.3, 0.4, size(5));  // between the levels 2 and 3
    CHECK(image.LevelBytes() == bytes(16) + bytes(8));
    SampleAt(image, {}, 0.3, 0.4, size(3));
    CHECK(image.LevelBytes() == bytes(32) + bytes(16) + bytes(8));
    SampleAt(image, {}, 0.3, 0.4, size(1e9f));
    CHECK(image.LevelBytes() == bytes(32) + bytes(16) + bytes(8) + bytes(1));
  });
}

TEST_CASE("threads that need a level at once get the same one") {
  const MipChain image = RandomImage(256, 256, 3, 4);
  std::vector<const void*> found(8);
  ParallelFor(found.size(), 4, [&](size_t i) { found[i] = image.Level(3 - i % 3).data; });
  for (size_t i = 3; i < found.size(); ++i) CHECK(found[i] == found[i - 3]);
}

TEST_CASE("mip levels keep the mean of any size") {
  const int sizes[][2] = {{8, 8}, {7, 5}, {13, 1}, {1, 9}, {6, 3}};
  for (const auto& size : sizes) {
    const MipChain image = RandomImage(size[0], size[1], 2, 9);
    CAPTURE(size[0], size[1]);
    CHECK(image.levels.back().width == 1);
    CHECK(image.levels.back().height == 1);
    for (int c = 0; c < 2; ++c) {
      double sum = 0;
      for (int y = 0; y < size[1]; ++y) {
        for (int x = 0; x < size[0]; ++x) sum += double{image.Value(0, x, y, c)};
      }
      // Each level rounds to float once.
      CHECK(double{image.Value(image.levels.size() - 1, 0, 0, c)} ==
            Approx(sum / (size[0] * size[1])).epsilon(3e-7));
    }
  }
  // Three texels become two: half of the middle one counts for either side.
  const MipChain thirds = MakeMipChain(3, 2, 1, {1, 2, 4, 1, 2, 4});
  CHECK(thirds.levels[1].width == 1);
  const MipChain five = MakeMipChain(5, 1, 1, {1, 2, 3, 4, 5});
  REQUIRE(five.levels[1].width == 2);
  CHECK(five.Value(1, 0, 0, 0) == Approx((1 + 2 + 1.5) / 2.5));
  CHECK(five.Value(1, 1, 0, 0) == Approx((1.5 + 4 + 5) / 2.5));
}

}  // namespace
}  // namespace nacre
