// SPDX-License-Identifier: Apache-2.0
// tests/stress/surface_fuzz_test.cc: a short run of the fuzz of broken models.
#include "stress/surface_fuzz.h"

#include "catch.h"
#include "scene/validate.h"
#include "targets.h"

namespace nacre {
namespace {

TEST_CASE("models with shading normals from anywhere make finite pictures under every light") {
  for (uint64_t seed = 0; seed < 100; ++seed) {
    CAPTURE(seed);
    const std::vector<Fault> faults = Validate(MakeBrokenModel(seed));
    CAPTURE(faults.empty() ? std::string() : faults[0].where + ": " + faults[0].what);
    REQUIRE(faults.empty());
  }
  ForEachTarget([](Target) {
    const SurfaceFuzzResult result = FuzzSurfaces(600, {});
    CAPTURE(Describe(result));
    CHECK(result.Holds());
    // The scenes are there to be seen.
    CHECK(result.pixels > 10 * result.scenes);
  });
}

}  // namespace
}  // namespace nacre
