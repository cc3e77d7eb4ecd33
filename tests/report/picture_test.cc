// SPDX-License-Identifier: Apache-2.0
// tests/report/picture_test.cc: what of an image goes into a page, and how small it is made.
#include "report/picture.h"

#include <nlohmann/json.hpp>

#include "catch.h"
#include "compare/test_images.h"

namespace nacre {
namespace {

Image Halves(const Window& window, float value) {
  Image image = MakeImage(window, {"A", "B", "G", "R", "N.X", "N.Y", "N.Z"}, value);
  for (Channel& channel : image.channels) channel.type = PixelType::kHalf;
  return image;
}

TEST_CASE("Layers are colours, normals, numbers, in an order that people expect", "[report]") {
  Page page;
  const auto json = PackImage(Halves({0, 0, 4, 2}, 0.5f), "a", {}, &page);
  REQUIRE(json["layers"].size() == 3);
  CHECK(json["layers"][0]["name"] == "");
  CHECK(json["layers"][0]["kind"] == "color");
  CHECK(json["layers"][0]["channels"][0]["name"] == "R");
  CHECK(json["layers"][0]["channels"][2]["name"] == "B");
  CHECK(json["layers"][1]["kind"] == "data");
  CHECK(json["layers"][2]["kind"] == "normal");
  CHECK(json["layers"][0]["channels"][0]["type"] == "half");
  CHECK((json["width"] == 4 && json["height"] == 2));
}

TEST_CASE("Samples that halves cannot hold stay floats", "[report]") {
  Page page;
  Image image = Halves({0, 0, 2, 2}, 1);
  SampleAt(image, "G", 1, 1) = 70000;
  const auto channels = PackImage(image, "a", {}, &page)["layers"][0]["channels"];
  CHECK(channels[0]["type"] == "half");
  CHECK(channels[1]["type"] == "float");
}

TEST_CASE("What does not fit becomes half, then smaller", "[report]") {
  const Image image = MakeImage({0, 0, 100, 80}, {"R", "G", "B"}, 1);
  const std::vector<const Image*> images = {&image};
  constexpr size_t kFloats = size_t{100} * 80 * 3 * 4;
  Packing packing = ChoosePacking(images, kFloats);
  CHECK((!packing.half && packing.factor == 1 && packing.InWords().empty()));
  packing = ChoosePacking(images, kFloats - 1);
  CHECK((packing.half && packing.factor == 1));
  packing = ChoosePacking(images, kFloats / 2 - 1);
  CHECK((packing.half && packing.factor == 2));
  CHECK(packing.InWords().find("2x2") != std::string::npos);
  CHECK(ChoosePacking({}, 0).factor == 1);
}

TEST_CASE("A crop lies where it does in its frame, also when it is shrunk", "[report]") {
  Page page;
  Image image = MakeImage({13, 7, 20, 12}, {"R", "G", "B"}, 1);
  image.display = {10, 5, 42, 37};
  auto json = PackImage(image, "a", {}, &page);
  CHECK((json["x0"] == 3 && json["y0"] == 2 && json["width"] == 7 && json["height"] == 5));
  json = PackImage(image, "a", {true, 4}, &page);
  CHECK((json["x0"] == 0 && json["y0"] == 0 && json["width"] == 3 && json["height"] == 2));
}

}  // namespace
}  // namespace nacre
