// SPDX-License-Identifier: Apache-2.0
// tests/color/display_test.cc: EncodeDisplay: codes, tails, alignment, NaN and infinities.
#include "color/display.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "catch.h"
#include "color/transfer.h"
#include "targets.h"

namespace nacre {
namespace {

using Color = Imath::Color3<double>;
constexpr float kInf = std::numeric_limits<float>::infinity();
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

constexpr ToneOperator kAllTones[] = {
    ToneOperator::kNeutral, ToneOperator::kReinhard, ToneOperator::kReinhardExtended,
    ToneOperator::kAces,    ToneOperator::kAgx,      ToneOperator::kNone};

int Code(double light) {
  return static_cast<int>(std::floor(255 * SrgbOetf(std::clamp(light, 0.0, 1.0)) + 0.5));
}

TEST_CASE("Codes are those of the double twin, within display.h's error", "[color]") {
  const size_t count = 100'003;
  std::mt19937 engine(3);
  std::uniform_real_distribution<float> log2_value(-16, 8);
  std::vector<float> planes[3];
  for (auto& plane : planes) {
    for (size_t i = 0; i < count; ++i) {
      plane.push_back(i % 7 == 0 ? -1.0f : std::exp2(log2_value(engine)));
    }
  }
  std::vector<uint8_t> rgb8(3 * count);
  ForEachTarget([&](Target) {
    for (const ToneOperator tone : kAllTones) {
      DisplaySettings settings{.tone = tone, .exposure_ev = 0.7};
      const bool is_agx = tone == ToneOperator::kAgx;
      const double relative = is_agx ? 4e-6 : 1e-6;
      const double absolute = is_agx ? 1e-6 : 1e-7;
      const size_t nans = EncodeDisplay(settings, planes[0].data(), planes[1].data(),
                                        planes[2].data(), count, rgb8.data());
      CHECK(nans == 0);
      size_t wrong = 0;
      for (size_t i = 0; i < count; ++i) {
        const Color light = DisplayLight(settings, Color(planes[0][i], planes[1][i], planes[2][i]));
        for (size_t c = 0; c < 3; ++c) {
          const double exact = light[static_cast<int>(c)];
          const double error = std::max(relative * exact, absolute);
          const int code = rgb8[3 * i + c];
          wrong += code < Code(exact - error) || code > Code(exact + error);
        }
      }
      CAPTURE(ToneOperatorName(tone));
      CHECK(wrong == 0);
    }
  });
}

TEST_CASE("Light is that of the double twin, for any count", "[color]") {
  const size_t count = 1003;
  std::mt19937 engine(4);
  std::uniform_real_distribution<float> log2_value(-16, 8);
  std::vector<float> planes[3];
  for (auto& plane : planes) {
    for (size_t i = 0; i < count; ++i)
      plane.push_back(i % 7 == 0 ? -1 : std::exp2(log2_value(engine)));
  }
  ForEachTarget([&](Target) {
    for (const ToneOperator tone : kAllTones) {
      CAPTURE(ToneOperatorName(tone));
      const DisplaySettings settings = {.tone = tone, .exposure_ev = 0.7};
      const bool is_agx = tone == ToneOperator::kAgx;
      for (const size_t shown : {count, size_t{5}}) {
        // Planes that end with the pixels, for the address sanitizer to see an access beyond.
        std::vector<float> light[3];
        for (size_t c = 0; c < 3; ++c) {
          light[c].assign(planes[c].begin(), planes[c].begin() + std::ptrdiff_t(shown));
        }
        ShowLight(settings, shown, light[0].data(), light[1].data(), light[2].data());
        size_t wrong = 0;
        for (size_t i = 0; i < shown; ++i) {
          const Color exact =
              DisplayLight(settings, Color(planes[0][i], planes[1][i], planes[2][i]));
          for (size_t c = 0; c < 3; ++c) {
            const double value = exact[static_cast<int>(c)];
            const double allowed =
                is_agx ? std::max(4e-6 * value, 1e-6) : std::max(1e-6 * value, 1e-7);
            wrong += !(std::abs(light[c][i] - value) <= allowed);
          }
        }
        CHECK(wrong == 0);
      }
    }
  });
}

TEST_CASE("sRGB is decoded as by its double twin", "[color]") {
  ForEachTarget([&](Target) {
    for (const size_t count : {size_t{1}, size_t{37}, size_t{1003}}) {
      std::vector<float> encoded(count), light(count);
      for (size_t i = 0; i < count; ++i) {
        encoded[i] = 1.2f * static_cast<float>(i) / static_cast<float>(count) - 0.1f;
      }
      light = encoded;
      DecodeSrgb(count, light.data());
      for (size_t i = 0; i < count; ++i) {
        const double exact = SrgbEotf(std::clamp(double{encoded[i]}, 0.0, 1.0));
        REQUIRE(std::abs(light[i] - exact) <= 6e-7);
      }
    }
  });
}

TEST_CASE("Any count and alignment gives the same pixels and nothing beyond", "[color]") {
  std::vector<float> planes[3];
  for (size_t i = 0; i < 400; ++i) {
    for (size_t c = 0; c < 3; ++c) planes[c].push_back(static_cast<float>((i * (c + 3)) % 97) / 90);
  }
  ForEachTarget([&](Target) {
    std::vector<uint8_t> all(3 * 400);
    EncodeDisplay({}, planes[0].data(), planes[1].data(), planes[2].data(), 400, all.data());
    for (size_t count = 0; count <= 300; ++count) {
      const size_t offset = count % 5;
      std::vector<uint8_t> some(3 * count + 64, 0xa5);
      // The planes have no padding, so that the address sanitizer finds reads beyond their ends.
      const std::vector<float> r(planes[0].begin(),
                                 planes[0].begin() + std::ptrdiff_t(offset + count));
      const std::vector<float> g(planes[1].begin(),
                                 planes[1].begin() + std::ptrdiff_t(offset + count));
      const std::vector<float> b(planes[2].begin(),
                                 planes[2].begin() + std::ptrdiff_t(offset + count));
      EncodeDisplay({}, r.data() + offset, g.data() + offset, b.data() + offset, count,
                    some.data());
      CAPTURE(count);
      CHECK(
          std::equal(some.begin(), some.begin() + long(3 * count), all.begin() + long(3 * offset)));
      CHECK(std::all_of(some.begin() + long(3 * count), some.end(),
                        [](uint8_t byte) { return byte == 0xa5; }));
    }
  });
}

TEST_CASE("Pixels that repeat those before them are encoded as any others", "[color]") {
  // Chunks of 128 pixels, each equal to the one before or different in one channel; first of one
  // colour, then with a pattern. NaN pixels are counted each time.
  const float colors[][3] = {{0.2f, 0.2f, 0.2f}, {0.2f, 0.2f, 0.2f}, {0.2f, 0.2f, 0.7f},
                             {0.2f, 0.2f, 0.7f}, {0.2f, 0.9f, 0.7f}, {0.5f, 0.9f, 0.7f},
                             {0.5f, 0.9f, 0.7f}, {kNan, 0.9f, 0.7f}, {kNan, 0.9f, 0.7f},
                             {kNan, 0.9f, 0.7f}, {0.5f, 0.9f, 0.7f}};
  std::vector<float> planes[3];
  for (const float pattern : {0.0f, 0.01f}) {
    for (const auto& color : colors) {
      for (int i = 0; i < 128; ++i) {
        const float more = static_cast<float>(i % 9) * pattern;
        for (int c = 0; c < 3; ++c) planes[c].push_back(color[c] + more);
      }
    }
  }
  const size_t count = planes[0].size();
  ForEachTarget([&](Target) {
    std::vector<uint8_t> all(3 * count), one(3 * count);
    const size_t nans =
        EncodeDisplay({}, planes[0].data(), planes[1].data(), planes[2].data(), count, all.data());
    size_t nans_one_by_one = 0;
    for (size_t i = 0; i < count; ++i) {
      nans_one_by_one +=
          EncodeDisplay({}, &planes[0][i], &planes[1][i], &planes[2][i], 1, &one[3 * i]);
    }
    CHECK(all == one);
    CHECK(nans == nans_one_by_one);
    CHECK(nans == 2 * 3 * 128);
  });
}

TEST_CASE("a pixel that breaks a repetition is seen wherever it is", "[color]") {
  // Two chunks of 128 pixels that differ in one value.
  ForEachTarget([&](Target) {
    size_t missed = 0;
    for (size_t i = 128; i < 256; ++i) {
      for (size_t c = 0; c < 3; ++c) {
        std::vector<float> planes[3];
        for (auto& plane : planes) plane.assign(256, 0.2f);
        planes[c][i] = 0.7f;
        std::vector<uint8_t> rgb8(3 * 256);
        EncodeDisplay({}, planes[0].data(), planes[1].data(), planes[2].data(), 256, rgb8.data());
        missed += rgb8[3 * i + c] == rgb8[c];
      }
    }
    CHECK(missed == 0);
  });
}

TEST_CASE("NaN pixels are magenta and counted, infinities are light or dark", "[color]") {
  std::vector<float> r(301, 0.5f), g(301, 0.5f), b(301, 0.5f);
  r[0] = g[130] = b[300] = kNan;
  r[7] = g[7] = b[7] = kInf;
  r[8] = g[8] = b[8] = -kInf;
  r[9] = kNan;
  g[9] = kInf;
  b[9] = -kInf;
  r[10] = -std::numeric_limits<float>::quiet_NaN();
  std::vector<uint8_t> rgb8(3 * r.size());
  ForEachTarget([&](Target) {
    for (const ToneOperator tone : kAllTones) {
      DisplaySettings settings{.tone = tone};
      CAPTURE(ToneOperatorName(tone));
      CHECK(EncodeDisplay(settings, r.data(), g.data(), b.data(), r.size(), rgb8.data()) == 5);
      for (const size_t i : {0u, 9u, 10u, 130u, 300u}) {
        CHECK((rgb8[3 * i] == 255 && rgb8[3 * i + 1] == 0 && rgb8[3 * i + 2] == 255));
      }
      for (const size_t c : {0u, 1u, 2u}) CHECK((rgb8[21 + c] == 255 && rgb8[24 + c] == 0));
    }
  });
}

TEST_CASE("Codes of sorted greys never fall", "[color]") {
  std::vector<float> greys;
  for (int i = 0; i < 1'000'000; ++i) {
    greys.push_back(static_cast<float>(std::exp2(-40 + i * (160.0 / 999'999))));
  }
  std::vector<uint8_t> rgb8(3 * greys.size());
  ForEachTarget([&](Target) {
    for (const ToneOperator tone : kAllTones) {
      DisplaySettings settings{.tone = tone};
      EncodeDisplay(settings, greys.data(), greys.data(), greys.data(), greys.size(), rgb8.data());
      size_t falls = 0;
      for (size_t i = 3; i < rgb8.size(); ++i) falls += rgb8[i] < rgb8[i - 3];
      CAPTURE(ToneOperatorName(tone));
      CHECK(falls == 0);
      CHECK(rgb8.back() == 255);
    }
  });
}

}  // namespace
}  // namespace nacre
