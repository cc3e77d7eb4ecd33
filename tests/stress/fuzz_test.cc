// SPDX-License-Identifier: Apache-2.0
// tests/stress/fuzz_test.cc: a short run of the fuzz on every target; scripts/stress makes it long.
#include "stress/fuzz.h"

#include "catch.h"
#include "targets.h"

namespace nacre {
namespace {

TEST_CASE("no model gives NaN, negative light or a bit that depends on its place") {
  ForEachTarget([](Target) {
    FuzzSettings settings;
    settings.draws = 2'600'000;
    const FuzzResult result = FuzzModels(settings);
    INFO(Describe(result));
    CHECK(result.draws >= settings.draws);
    CHECK(result.lit > result.draws / 4);
    CHECK(result.Holds());
  });
}

TEST_CASE("the fuzz gives the same bits again, on any number of threads") {
  ForEachTarget([](Target) {
    FuzzSettings settings;
    settings.draws = 100'000;
    settings.threads = 1;
    const uint64_t hash = FuzzModels(settings).hash;
    CHECK(FuzzModels(settings).hash == hash);
    settings.threads = 3;
    CHECK(FuzzModels(settings).hash == hash);
    settings.seed = 2;
    CHECK(FuzzModels(settings).hash != hash);
  });
}

TEST_CASE("the fuzz holds with denormals kept, too") {
  ForEachTarget([](Target) {
    FuzzSettings settings;
    settings.draws = 100'000;
    settings.flush_denormals = false;
    const FuzzResult result = FuzzModels(settings);
    INFO(Describe(result));
    CHECK(result.Holds());
  });
}

}  // namespace
}  // namespace nacre
