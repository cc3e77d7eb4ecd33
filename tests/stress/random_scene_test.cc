// SPDX-License-Identifier: Apache-2.0
// tests/stress/random_scene_test.cc: many small random scenes against the truth.
#include "stress/random_scene.h"

#include "catch.h"
#include "render/render.h"
#include "scene/validate.h"
#include "stress/gallery.h"
#include "stress/truth_reflect.h"
#include "targets.h"

namespace nacre {
namespace {

TEST_CASE("random scenes are right") {
  size_t judged = 0, doubtful = 0;
  for (uint64_t seed = 0; seed < 1000; ++seed) {
    CAPTURE(seed);
    Scene scene = MakeRandomScene(seed);
    UsePlainForms(&scene);
    REQUIRE(Validate(scene).empty());
    const Comparison c =
        Compare(scene, RenderImage(scene, {.threads = 1, .layers = {"N", "Z", "id.object"}}),
                RenderTruth(scene, 1));
    CAPTURE(c.false_hits, c.false_misses, c.wrong_objects, c.not_finite, c.normal_error);
    CHECK(c.GeometryHolds());
    CAPTURE(c.of_bound, c.worst_material, c.radiance_error);
    CHECK(c.of_bound <= kRandomSceneSlack);
    judged += c.pixels - c.doubtful;
    doubtful += c.doubtful;
  }
  CHECK(doubtful < judged / 20);
}

}  // namespace
}  // namespace nacre
