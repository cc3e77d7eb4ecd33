// SPDX-License-Identifier: Apache-2.0
// tests/compare/metrics_test.cc: the figures of a comparison, on images made so that they are
// known.
#include "compare/metrics.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "catch.h"
#include "compare/test_images.h"
#include "compare/verdict.h"
#include "targets.h"

namespace nacre {
namespace {

constexpr float kInf = std::numeric_limits<float>::infinity();
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

// The metrics of each layer, in the reference's order.
std::vector<LayerMetrics> CompareImages(const Image& got, const Image& reference,
                                        const CompareOptions& options = {}) {
  const ImagePair pair = PairImages(got, reference, options);
  std::vector<LayerMetrics> metrics;
  for (const LayerPair& layer : pair.layers) metrics.push_back(CompareLayer(pair, layer));
  return metrics;
}

TEST_CASE("Equal images have no error", "[compare]") {
  const Image image = MakeImage({0, 0, 10, 10}, {"R", "G", "B", "Z"}, 0.7f);
  const auto layers = CompareImages(image, image);
  REQUIRE(layers.size() == 2);
  for (const LayerMetrics& m : layers) {
    CHECK((m.rmse == 0 && m.rel_mse == 0 && m.max_abs == 0 && m.max_rel == 0 && m.p999_rel == 0));
    CHECK(std::isinf(m.psnr_db));
    CHECK(m.max_abs_at.channel.empty());
    CHECK(m.mean_got == m.mean_reference);
  }
  CHECK(layers[0].samples == 300);
  CHECK(layers[1].layer == "Z");
}

TEST_CASE("A known difference has known figures", "[compare]") {
  Image got = MakeImage({0, 0, 10, 10}, {"R", "G", "B"}, 2);
  Image reference = got;
  SampleAt(got, "G", 3, 4) = 2.5f;
  SampleAt(got, "B", 9, 9) = 1.75f;
  const LayerMetrics m = CompareImages(got, reference).at(0);
  CHECK(m.rmse == Approx(std::sqrt((0.25 + 0.0625) / 300)).epsilon(1e-14));
  CHECK(m.rel_mse == Approx((0.25 + 0.0625) / 4.0001 / 300).epsilon(1e-14));
  CHECK(m.max_abs == 0.5);
  CHECK((m.max_abs_at.x == 3 && m.max_abs_at.y == 4 && m.max_abs_at.channel == "G"));
  CHECK((m.max_abs_at.got == 2.5f && m.max_abs_at.reference == 2));
  CHECK(m.max_rel == 0.25);
  CHECK(m.zero_mismatches == 0);
  CHECK(m.psnr_peak == 2);
  CHECK(m.psnr_db == Approx(20 * std::log10(2 / m.rmse)).epsilon(1e-14));
  CHECK(m.mean_reference == 2);
  CHECK(m.mean_got == Approx(2 + 0.25 / 300).epsilon(1e-14));
}

TEST_CASE("The 99.9 % quantile ignores one sample in a thousand", "[compare]") {
  Image got = MakeImage({0, 0, 100, 20}, {"Y"}, 1);
  Image reference = got;
  SampleAt(got, "Y", 0, 0) = 9;
  SampleAt(got, "Y", 1, 0) = 9;
  CHECK(CompareImages(got, reference).at(0).p999_rel == 0);  // 2 of 2000
  SampleAt(got, "Y", 2, 0) = 1.5f;
  CHECK(CompareImages(got, reference).at(0).p999_rel == 0.5);
  CHECK(CompareImages(got, reference).at(0).max_rel == 8);
}

// What the column "max rel" says is what --max-rel is held against.
TEST_CASE("Relative errors are relative, however dark the reference", "[compare]") {
  Image got = MakeImage({0, 0, 40, 50}, {"Y"}, 0);  // 0, of which no error is relative
  Image reference = got;
  for (int x = 0; x < 40; ++x) SampleAt(got, "Y", x, 0) = SampleAt(reference, "Y", x, 0) = 1;
  SampleAt(reference, "Y", 3, 0) = 0x1p-20f;
  SampleAt(got, "Y", 3, 0) = 1.5f * 0x1p-20f;
  SampleAt(reference, "Y", 4, 0) = -0x1p-140f;  // a denormal
  SampleAt(got, "Y", 4, 0) = -0x1p-139f;
  SampleAt(got, "Y", 5, 9) = 0x1p-10f;
  const LayerMetrics m = CompareImages(got, reference).at(0);
  CHECK(m.max_rel == 1);
  CHECK(m.p999_rel == 1);  // of the 40 samples that have a reference
  CHECK(m.zero_mismatches == 1);
  SampleAt(got, "Y", 5, 9) = 0;
  Tolerances tolerances{.max_rel = m.max_rel};
  CHECK(Judge(got, reference, tolerances).match);
  tolerances.max_rel = std::nextafter(m.max_rel, 0);
  CHECK(Judge(got, reference, tolerances).exceeding_pixels == 1);
  SampleAt(got, "Y", 4, 0) = 1e38f;  // beyond float's range of its reference
  CHECK(CompareImages(got, reference).at(0).max_rel == Approx(1e38 / 0x1p-140).epsilon(1e-7));
}

TEST_CASE("The quantile finds the largest errors where they come first, in any order",
          "[compare]") {
  const int width = 200, height = 100, large = 5000;
  Image reference = MakeImage({0, 0, width, height}, {"Y"}, 1);
  Image got = reference;
  std::vector<float>& samples = got.channels[0].samples;
  for (size_t i = 0; i < samples.size(); ++i) {
    samples[i] = i < large ? 2 + static_cast<float>(i * 1237 % large) * 0x1p-13f : 1.5f;
  }
  // 20 of the 20 000 errors are above it: 1237 and 5000 have no common factor.
  CHECK(CompareImages(got, reference).at(0).p999_rel == 1 + (large - 21) * 0x1p-13f);
}

TEST_CASE("The figures of large images are plain sums on every target", "[compare]") {
  // More errors than are kept for the quantile; rows that end within a vector; several bands. Some
  // samples are equal, some references 0; a row has what is not finite.
  const int width = 331, height = 401;
  Image reference = MakeImage({0, 0, width, height}, {"R", "G"}, 0);
  Image got = reference;
  uint32_t state = 1;
  const auto draw = [&state] {
    state = state * 1664525 + 1013904223;
    return static_cast<float>(state >> 8) * 0x1p-24f;
  };
  for (size_t c = 0; c < 2; ++c) {
    for (size_t i = 0; i < got.channels[c].samples.size(); ++i) {
      const float kind = draw();
      reference.channels[c].samples[i] = kind < 0.1f ? 0 : draw() - 0.3f;
      const float noise = draw();
      got.channels[c].samples[i] =
          reference.channels[c].samples[i] + (kind < 0.3f ? 0 : 1e-3f * noise * noise);
    }
  }
  SampleAt(got, "R", 7, 100) = SampleAt(reference, "R", 7, 100) = kInf;
  SampleAt(got, "G", 300, 290) += 3;
  double squares = 0, softened = 0, sum = 0, max_rel = 0;
  size_t zero_mismatches = 0, pixels = 0;
  std::vector<double> relative;
  const double limit = 2e-4;
  for (size_t i = 0; i < got.channels[0].samples.size(); ++i) {
    bool exceeds = false;
    for (size_t c = 0; c < 2; ++c) {
      const double g = got.channels[c].samples[i], r = reference.channels[c].samples[i];
      if (std::isinf(r)) continue;
      const double error = std::abs(g - r);
      exceeds = exceeds || error > limit;
      squares += error * error;
      softened += error * error / (r * r + 1e-4);
      sum += g;
      if (r == 0) {
        zero_mismatches += error > 0;
        continue;
      }
      relative.push_back(error / std::abs(r));
      max_rel = std::max(max_rel, relative.back());
    }
    pixels += exceeds;
  }
  std::sort(relative.begin(), relative.end());
  const auto rank =
      static_cast<size_t>(std::ceil(0.999 * static_cast<double>(relative.size()))) - 1;
  const double count = 2.0 * width * height - 1;
  ForEachTarget([&](Target) {
    const LayerMetrics m = CompareImages(got, reference).at(0);
    // 1e5 roundings of double, mostly against each other.
    CHECK(m.rmse == Approx(std::sqrt(squares / count)).epsilon(1e-12));
    CHECK(m.rel_mse == Approx(softened / count).epsilon(1e-12));
    CHECK(m.mean_got == Approx(sum / count).epsilon(1e-12));
    CHECK(m.max_rel == max_rel);
    CHECK(m.p999_rel == static_cast<float>(relative[rank]));
    CHECK(m.zero_mismatches == zero_mismatches);
    CHECK((m.max_abs_at.x == 300 && m.max_abs_at.y == 290 && m.max_abs_at.channel == "G"));
    CHECK(m.nonfinite_mismatches == 0);
    const Verdict verdict = Judge(got, reference, Tolerances{.max_abs = limit});
    CHECK(verdict.exceeding_pixels == pixels);
    CHECK(verdict.reason.find("worst G at (300, 290)") != std::string::npos);
  });
}

TEST_CASE("Metrics know NaN and infinity", "[compare]") {
  Image got = MakeImage({0, 0, 4, 4}, {"R"}, 1);
  Image reference = got;
  SampleAt(got, "R", 0, 0) = SampleAt(reference, "R", 0, 0) = kNan;
  SampleAt(got, "R", 1, 0) = SampleAt(reference, "R", 1, 0) = -kInf;
  SampleAt(got, "R", 3, 3) = 1.25f;
  LayerMetrics m = CompareImages(got, reference).at(0);
  CHECK(m.nonfinite_mismatches == 0);
  CHECK(m.samples == 16);
  CHECK(m.rmse == Approx(0.25 / std::sqrt(14)).epsilon(1e-14));
  SampleAt(got, "R", 2, 1) = kNan;
  SampleAt(reference, "R", 2, 2) = kInf;
  m = CompareImages(got, reference).at(0);
  CHECK(m.nonfinite_mismatches == 2);
  CHECK((m.max_abs_at.x == 2 && m.max_abs_at.y == 1));
  CHECK(m.max_abs == 0.25);  // of the finite ones
  CHECK(m.rmse == Approx(0.25 / std::sqrt(12)).epsilon(1e-14));
  CHECK(std::isfinite(m.mean_got));
}

TEST_CASE("Only the layers asked for are compared", "[compare]") {
  Image got = MakeImage({0, 0, 4, 4}, {"R", "diffuse.R", "id.object"}, 1);
  const Image reference = MakeImage({0, 0, 4, 4}, {"R", "diffuse.R"}, 1);
  CompareOptions options{.layers = {"diffuse"}};
  const auto layers = CompareImages(got, reference, options);
  REQUIRE(layers.size() == 1);
  CHECK(layers[0].layer == "diffuse");
}

}  // namespace
}  // namespace nacre
