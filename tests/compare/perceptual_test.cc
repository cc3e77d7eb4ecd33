// SPDX-License-Identifier: Apache-2.0
// tests/compare/perceptual_test.cc: which metrics images get, and what is said of those they do
// not.
#include "compare/perceptual.h"

#include <limits>

#include "base/error.h"
#include "catch.h"
#include "compare/test_images.h"

namespace nacre {
namespace {

PerceptualMetrics Only(const Image& got, const Image& reference,
                       const PerceptualOptions& what = {}) {
  const auto all = MeasurePerceptual(got, reference, what);
  REQUIRE(all.size() == 1);
  return all.front();
}

TEST_CASE("Equal images are equal to the eye", "[perceptual]") {
  const Image image = MakeImage({0, 0, 16, 12}, {"R", "G", "B", "A", "Z"}, 0.3f);
  const PerceptualMetrics metrics = Only(image, image);
  CHECK(metrics.layer.empty());
  CHECK(metrics.ssim.value() == Approx(1).epsilon(1e-12));
  CHECK((metrics.flip_mean == 0.0 && metrics.flip_max == 0.0));
  CHECK((metrics.hdr_flip_mean == 0.0 && metrics.hdr_flip_max == 0.0));
  CHECK(metrics.flip_map.size() == 16 * 12);
  CHECK(metrics.notes.empty());
}

TEST_CASE("Layers of colours are measured, others are not", "[perceptual]") {
  const Image image =
      MakeImage({0, 0, 12, 12}, {"R", "G", "B", "diffuse.R", "diffuse.G", "diffuse.B", "N.X"}, 1);
  const auto all = MeasurePerceptual(image, image, {});
  REQUIRE(all.size() == 2);
  CHECK(all[1].layer == "diffuse");
}

TEST_CASE("Alpha changes nothing, and negative radiance is black", "[perceptual]") {
  Image got = MakeImage({0, 0, 12, 12}, {"R", "G", "B", "A"}, 0);
  const Image reference = got;
  SampleAt(got, "A", 3, 3) = 1;
  SampleAt(got, "R", 4, 4) = -2;
  const PerceptualMetrics metrics = Only(got, reference);
  CHECK(metrics.flip_max == 0.0);
  CHECK(metrics.hdr_flip_max == 0.0);
}

TEST_CASE("What is not finite is named, not measured", "[perceptual]") {
  Image got = MakeImage({0, 0, 12, 12}, {"R", "G", "B"}, 0.5f);
  const Image reference = got;
  SampleAt(got, "G", 7, 2) = std::numeric_limits<float>::quiet_NaN();
  SampleAt(got, "B", 1, 9) = std::numeric_limits<float>::infinity();
  const PerceptualMetrics metrics = Only(got, reference);
  CHECK_FALSE((metrics.ssim || metrics.flip_mean || metrics.hdr_flip_mean));
  REQUIRE(metrics.notes.size() == 1);
  CHECK(metrics.notes[0] == "no SSIM or FLIP: 2 pixels are not finite, the first at (7, 2)");
}

TEST_CASE("Images smaller than a kernel have FLIP but no SSIM", "[perceptual]") {
  const Image small = MakeImage({0, 0, 10, 30}, {"R", "G", "B"}, 0.5f);
  const PerceptualMetrics metrics = Only(small, small);
  CHECK_FALSE(metrics.ssim);
  CHECK(metrics.flip_mean == 0.0);
  REQUIRE(metrics.notes.size() == 1);
  CHECK(metrics.notes[0] == "no SSIM: 10x30 is smaller than its window of 11x11");
}

TEST_CASE("Pictures of a display are shown as they are", "[perceptual]") {
  // Codes 0 and 1 are black and white; radiance 1 by the neutral operator is not white.
  Image black = MakeImage({0, 0, 12, 12}, {"R", "G", "B"}, 0);
  Image white = MakeImage({0, 0, 12, 12}, {"R", "G", "B"}, 1);
  black.metadata["transfer"] = white.metadata["transfer"] = "display";
  const PerceptualMetrics metrics = Only(white, black);
  CHECK(metrics.flip_mean.value() == Approx(0.967380).margin(1e-6));
  CHECK_FALSE(metrics.hdr_flip_mean);
  REQUIRE(metrics.notes.size() == 1);
  white.metadata.clear();
  CHECK(Only(white, black).flip_mean.value() < metrics.flip_mean.value());
}

TEST_CASE("The exposures asked for are used", "[perceptual]") {
  const Image got = MakeImage({0, 0, 4, 4}, {"R", "G", "B"}, 200);
  const Image reference = MakeImage({0, 0, 4, 4}, {"R", "G", "B"}, 100);
  PerceptualOptions what;
  what.start_exposure = -8;
  what.stop_exposure = -5.5;
  PerceptualMetrics metrics = Only(got, reference, what);
  CHECK(metrics.exposures.count == 3);  // the stops between, rounded up
  CHECK(metrics.hdr_flip_mean.value() > 0.1);
  what.exposures = 9;
  CHECK(Only(got, reference, what).exposures.count == 9);
  what.stop_exposure = -9;
  CHECK_FALSE(Only(got, reference, what).hdr_flip_mean);
}

TEST_CASE("Of images of different sizes the pixels that both have are compared", "[perceptual]") {
  const Image a = MakeImage({0, 0, 4, 4}, {"R", "G", "B"}, 1);
  Image b = MakeImage({0, 0, 4, 5}, {"R", "G", "B"}, 1);
  for (const char* channel : {"R", "G", "B"}) SampleAt(b, channel, 2, 4) = 9;
  CHECK_THROWS_AS(MeasurePerceptual(a, b, {}), Error);
  CompareOptions options{.sizes_may_differ = true};
  CHECK(MeasurePerceptual(a, b, {}, options).front().flip_max == 0);
}

}  // namespace
}  // namespace nacre
