// SPDX-License-Identifier: Apache-2.0
// tests/lesson/preset_test.cc: which of the lesson's pictures a scene asks for, and at which size.
#include "lesson/preset.h"

#include "base/error.h"
#include "catch.h"
#include "lesson/scenes.h"

namespace nacre {
namespace {

TEST_CASE("the lesson's own scenes choose its pictures") {
  CHECK(ChooseTextbookSubject(TextbookComparisonScene(), "") == TextbookSubject::kComparison);
  CHECK(ChooseTextbookSubject(TextbookGridScene(), "") == TextbookSubject::kGrid);
}

TEST_CASE("scenes that resemble neither are refused by name") {
  Scene halves_swapped = TextbookComparisonScene();
  auto& material = halves_swapped.materials[halves_swapped.spheres[0].material.index].model;
  std::swap(std::get<SplitMaterial>(material).materials[0],
            std::get<SplitMaterial>(material).materials[1]);
  Scene hole_in_grid = TextbookGridScene();
  hole_in_grid.spheres.pop_back();
  Scene with_mesh = TextbookGridScene();
  with_mesh.meshes.emplace_back();
  for (const Scene& scene : {halves_swapped, hole_in_grid, with_mesh, Scene()}) {
    try {
      ChooseTextbookSubject(scene, "that.json");
      FAIL_CHECK("not refused");
    } catch (const Error& error) {
      CHECK(error.code() == ExitCode::kUsage);
      CHECK(error.faults().front().where == "that.json");
    }
  }
}

TEST_CASE("sides that are not given are the lesson's") {
  const TextbookPicture own = RenderTextbookSubject(TextbookSubject::kComparison, 0, 0);
  CHECK(own.width == 400);
  CHECK(own.height == 200);
  const TextbookPicture small = RenderTextbookSubject(TextbookSubject::kGrid, 60, 40);
  CHECK(small.width == 60);
  CHECK(small.pixel_count() == 60 * 40);
}

}  // namespace
}  // namespace nacre
