// SPDX-License-Identifier: Apache-2.0
// tests/compare/heat_map_test.cc: colours of errors.
#include "compare/heat_map.h"

#include <cmath>
#include <limits>

#include "catch.h"
#include "color/luminance.h"
#include "color/transfer.h"
#include "compare/test_images.h"

namespace nacre {
namespace {

double LuminanceOf(const Rgb8& color) {
  const auto linear = [](uint8_t code) { return SrgbEotf(code / 255.0); };
  return Luminance(Imath::Color3<double>(linear(color[0]), linear(color[1]), linear(color[2])));
}

TEST_CASE("The map is viridis, brighter with every step", "[compare]") {
  CHECK(HeatColor(0) == Rgb8{0x44, 0x01, 0x54});
  CHECK(HeatColor(1) == Rgb8{0xfd, 0xe7, 0x25});
  CHECK(HeatColor(-5) == HeatColor(0));
  CHECK(HeatColor(7) == HeatColor(1));
  // matplotlib gives (0.1281, 0.5651, 0.5509) for 0.5: 33, 144, 140.
  const Rgb8 middle = HeatColor(0.5);
  CHECK((std::abs(middle[0] - 33) <= 3 && std::abs(middle[1] - 144) <= 3));
  CHECK(std::abs(middle[2] - 140) <= 3);
  for (int i = 1; i <= 64; ++i) {
    CHECK(LuminanceOf(HeatColor(i / 64.0)) > LuminanceOf(HeatColor((i - 1) / 64.0)));
  }
}

TEST_CASE("The scale is logarithmic and ends at its ends", "[compare]") {
  const HeatScale scale{1e-6, 1};
  CHECK(scale.Position(1e-3) == Approx(0.5).epsilon(1e-14));
  CHECK(scale.Position(1e-9) == 0);
  CHECK(scale.Position(50) == 1);
}

TEST_CASE("Pixels have the colour of their largest error", "[compare]") {
  Image got = MakeImage({0, 0, 4, 2}, {"R", "G", "B"}, 10);
  const Image reference = got;
  SampleAt(got, "R", 1, 0) = 10.01f;
  SampleAt(got, "G", 1, 0) = 11;
  SampleAt(got, "B", 3, 1) = std::numeric_limits<float>::quiet_NaN();
  const HeatScale scale{1e-3, 1};
  const auto color = [](const Rgb8Picture& picture, int x, int y) {
    const size_t i =
        3 * (static_cast<size_t>(y) * static_cast<size_t>(picture.width) + static_cast<size_t>(x));
    return Rgb8{picture.rgb8[i], picture.rgb8[i + 1], picture.rgb8[i + 2]};
  };
  const Rgb8Picture absolute = HeatMap(got, reference, "", HeatQuantity::kAbsolute, scale);
  CHECK((absolute.width == 4 && absolute.height == 2 && absolute.rgb8.size() == 24));
  CHECK(color(absolute, 0, 0) == kHeatEqual);
  CHECK(color(absolute, 1, 0) == HeatColor(1));
  CHECK(color(absolute, 3, 1) == kHeatNotFinite);
  const Rgb8Picture relative = HeatMap(got, reference, "", HeatQuantity::kRelative, scale);
  CHECK(color(relative, 1, 0) == HeatColor(scale.Position(0.1)));
}

TEST_CASE("The legend shows the whole map", "[compare]") {
  const Rgb8Picture legend = HeatLegend(256, 2);
  REQUIRE(legend.rgb8.size() == size_t{256} * 2 * 3);
  CHECK(legend.rgb8[0] == HeatColor(0)[0]);
  CHECK(legend.rgb8[3 * 255 + 1] == HeatColor(1)[1]);
}

}  // namespace
}  // namespace nacre
