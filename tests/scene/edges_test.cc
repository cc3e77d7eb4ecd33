// SPDX-License-Identifier: Apache-2.0
// tests/scene/edges_test.cc: numbers exactly at a limit, and defaults.
#include <string>

#include "catch.h"
#include "scene/filter_width.h"
#include "scene/validate.h"

namespace nacre {
namespace {

TEST_CASE("names of layers have 1 to 64 characters") {
  CHECK_FALSE(IsLayerName(""));
  CHECK(IsLayerName("a"));
  CHECK(IsLayerName(std::string(64, 'a')));
  CHECK_FALSE(IsLayerName(std::string(65, 'a')));
}

TEST_CASE("a split's places are all different") {
  Scene scene;
  const LambertMaterial white{{1, 1, 1}};
  Material band, split;
  band.model = white;
  const MaterialId id{0};
  const auto count_faults = [&](const std::vector<double>& at) {
    split.model = SplitMaterial{at, {id, id, id}};
    scene.materials = {band, split};
    return Validate(scene).size();
  };
  CHECK(count_faults({0.25, 0.75}) == 0);
  CHECK(count_faults({0.5, 0.5}) == 1);
  CHECK(count_faults({0.75, 0.25}) == 1);
}

TEST_CASE("filters have widths of their own") {
  CHECK(DefaultFilterWidth(FilterKind::kBox) == 1);
  CHECK(DefaultFilterWidth(FilterKind::kGaussian) == 3);
  CHECK(DefaultFilterWidth(FilterKind::kBlackmanHarris) == 3.3);
  CHECK(DefaultFilterWidth(FilterKind::kMitchell) == 4);
}

}  // namespace
}  // namespace nacre
