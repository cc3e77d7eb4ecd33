// SPDX-License-Identifier: Apache-2.0
// tests/stress/leaks_test.cc: a short run on every target; scripts/stress makes it long.
#include "stress/leaks.h"

#include "catch.h"
#include "targets.h"

namespace nacre {
namespace {

TEST_CASE("no ray gets out of a closed mesh") {
  ForEachTarget([](Target) {
    const LeakResult result = CountLeaks({.rays = 1'000'000});
    CHECK(result.rays >= 1'000'000);
    CHECK(result.leaks == 0);
  });
}

}  // namespace
}  // namespace nacre
