// SPDX-License-Identifier: Apache-2.0
// tests/compare/layers_test.cc: what is compared with what, and the errors of single samples.
#include "compare/layers.h"

#include <cmath>
#include <limits>

#include "base/error.h"
#include "catch.h"
#include "compare/test_images.h"

namespace nacre {
namespace {

constexpr float kInf = std::numeric_limits<float>::infinity();
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

// The error that pairing throws, as text, with its exit code checked.
std::string PairingError(const Image& got, const Image& reference, const CompareOptions& options) {
  try {
    PairImages(got, reference, options);
  } catch (const Error& error) {
    CHECK(error.code() == ExitCode::kCannotCompare);
    return error.what();
  }
  return "no error";
}

TEST_CASE("Channels belong to layers by their prefix", "[compare]") {
  CHECK(LayerOfChannel("R").empty());
  CHECK(LayerOfChannel("B").empty());
  CHECK(LayerOfChannel("A") == "A");
  CHECK(LayerOfChannel("Z") == "Z");
  CHECK(LayerOfChannel("diffuse.G") == "diffuse");
  CHECK(LayerOfChannel("light.key.R") == "light.key");
}

TEST_CASE("Layers are paired over the pixels that both cover", "[compare]") {
  Image got = MakeImage({0, 0, 8, 6}, {"A", "B", "G", "R", "N.X", "N.Y"}, 0);
  Image reference = MakeImage({0, 0, 8, 6}, {"N.Y", "N.X", "R", "G", "B", "A"}, 0);
  reference.data = {2, 1, 5, 9};  // a crop, reaching beyond the frame
  for (Channel& channel : reference.channels) channel.samples.assign(3 * 8, 0);
  SampleAt(got, "G", 4, 5) = 7;
  SampleAt(reference, "G", 4, 5) = 9;
  const ImagePair pair = PairImages(got, reference, {});
  CHECK(pair.window == Window{2, 1, 5, 6});
  REQUIRE(pair.layers.size() == 3);
  CHECK(pair.layers[0].layer == "N");
  CHECK(pair.layers[1].layer.empty());
  REQUIRE(pair.layers[1].channels.size() == 3);
  const ChannelPair& green = pair.layers[1].channels[1];
  CHECK(green.name == "G");
  CHECK(green.got[pair.GotIndex(4, 5)] == 7);
  CHECK(green.reference[pair.ReferenceIndex(4, 5)] == 9);
}

TEST_CASE("Images that cannot be compared say why", "[compare]") {
  const Image rgb = MakeImage({0, 0, 4, 3}, {"R", "G", "B"}, 0);
  const Image rgba = MakeImage({0, 0, 4, 3}, {"R", "G", "B", "A"}, 0);
  CompareOptions options{.got_name = "a.exr", .reference_name = "b.exr"};
  CHECK(PairingError(MakeImage({0, 0, 5, 3}, {"R"}, 0), rgb, options) ==
        "error: a.exr: is 5x3, but b.exr is 4x3");
  Image wide = rgb;
  wide.metadata["chromaticities"] = "0.708 0.292 0.17 0.797 0.131 0.046 0.3127 0.329";
  CHECK(PairingError(wide, rgb, options) ==
        "error: a.exr: its primaries are 0.708 0.292 0.17 0.797 0.131 0.046 0.3127 0.329, those of "
        "b.exr 0.64 0.33 0.3 0.6 0.15 0.06 0.3127 0.329\n  hint: convert one of them first");
  CHECK(PairingError(wide, wide, options) == "no error");
  Image unknown = rgb;
  unknown.metadata["chromaticities"] = "0 0 0 0 0 0 0 0";
  CHECK(PairingError(unknown, rgb, options) == "no error");
  CHECK(PairingError(rgb, rgba, options) ==
        "error: a.exr: has no channel A, which b.exr has\n  hint: name the layers to compare");
  CHECK(PairingError(rgba, rgb, options) ==
        "error: b.exr: has no channel A, which a.exr has\n  hint: name the layers to compare");
  Image elsewhere = rgb;
  elsewhere.data = {4, 0, 8, 3};
  CHECK(PairingError(elsewhere, rgb, options) == "error: a.exr: has no pixel in common with b.exr");
  options.layers = {""};
  CHECK(PairingError(rgba, rgb, options) == "no error");
  options.layers = {"diffuse"};
  CHECK(PairingError(rgba, rgb, options) == "error: b.exr: has no layer diffuse");
}

TEST_CASE("Samples that are not finite equal only themselves", "[compare]") {
  CHECK(SampleError(1.5f, 1) == 0.5);
  CHECK(SampleError(0.0f, -0.0f) == 0);
  CHECK(SampleError(3e38f, -3e38f) > 5e38);  // no overflow: double
  CHECK(SampleError(kNan, kNan) == 0);
  CHECK(SampleError(kInf, kInf) == 0);
  for (const auto& [got, reference] :
       {std::pair{kNan, 1.0f}, {1.0f, kNan}, {kInf, -kInf}, {kInf, 3e38f}, {kNan, kInf}}) {
    CHECK(std::isinf(SampleError(got, reference)));
  }
}

TEST_CASE("Relative errors are softened in the dark", "[compare]") {
  CHECK(RelativeError(0.5, 100) == 0.005);
  CHECK(RelativeError(0.001, -0.25f) == 0.004);
  CHECK(RelativeError(1e-6, 1e-6f) == Approx(1).epsilon(1e-7));  // however dark
  CHECK(RelativeError(0, 0) == 0);
  CHECK(RelativeError(0, kInf) == 0);
  CHECK(std::isinf(RelativeError(1e-30, 0)));
  CHECK(SoftenedError(0.5, 100) == Approx(0.005).epsilon(1e-7));
  CHECK(SoftenedError(0.001, 0) == Approx(0.1).epsilon(1e-15));
  CHECK(SoftenedError(0.01, -0.01f) == Approx(std::sqrt(0.5)).epsilon(1e-7));
  CHECK(SoftenedError(0, kInf) == 0);
}

}  // namespace
}  // namespace nacre
