// SPDX-License-Identifier: Apache-2.0
// tests/base/base_test.cc: errors, arrays, parallel loops, SIMD targets.
#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <limits>
#include <numeric>
#include <thread>

#include "base/aligned.h"
#include "base/error.h"
#include "base/memo.h"
#include "base/parallel.h"
#include "base/pool.h"
#include "base/target.h"
#include "catch.h"

namespace nacre {
namespace {

void Sleep() { std::this_thread::sleep_for(std::chrono::milliseconds(1)); }

TEST_CASE("an error's message has a line for each fault and its hint") {
  const Error error(ExitCode::kBadInput, {{"a.json: /x", "is wrong", "mend it"}, {"b", "too", ""}});
  CHECK(std::string(error.what()) == "error: a.json: /x: is wrong\n  hint: mend it\nerror: b: too");
  CHECK(error.code() == ExitCode::kBadInput);
}

TEST_CASE("the nearest name is a likely slip or nothing") {
  const std::vector<std::string> names = {"roughness", "metallic", "base_color"};
  CHECK(NearestName("roughnes", names) == "roughness");
  CHECK(NearestName("metalic", names) == "metallic");
  CHECK(NearestName("basecolor", names) == "base_color");
  CHECK(NearestName("shininess", names).empty());
  CHECK(NearestName("", names).empty());
}

TEST_CASE("a pool lends what was given back, and never one object twice") {
  Pool<std::vector<int>> pool;
  const std::vector<int>* first = nullptr;
  {
    const auto borrowed = pool.Borrow();
    first = borrowed.get();
    borrowed->push_back(7);
  }
  const auto again = pool.Borrow();
  CHECK(again.get() == first);
  CHECK(*again == std::vector<int>{7});  // as it was left
  const auto other = pool.Borrow();
  CHECK(other.get() != first);
  CHECK(other->empty());
}

TEST_CASE("a pool serves many threads") {
  Pool<std::array<size_t, 64>> pool;
  std::atomic<int> torn = 0;
  ParallelFor(2000, 4, [&](size_t i) {
    const auto borrowed = pool.Borrow();
    borrowed->fill(i);
    for (const size_t value : *borrowed) torn += value == i ? 0 : 1;
  });
  CHECK(torn == 0);
}

TEST_CASE("a memo computes once what it is asked for again, and forgets the oldest") {
  Memo<int, int> memo;
  int made = 0;
  const auto square = [&](int x) {
    return *memo.Get(x, [&] {
      ++made;
      return x * x;
    });
  };
  CHECK(square(3) == 9);
  CHECK(square(3) == 9);
  CHECK(made == 1);
  for (int x = 10; x < 73; ++x) CHECK(square(x) == x * x);  // 63 others
  CHECK(square(3) == 9);
  CHECK(made == 64);
  for (int x = 100; x < 164; ++x) CHECK(square(x) == x * x);
  CHECK(square(3) == 9);
  CHECK(made == 129);
}

TEST_CASE("aligned arrays start on a vector, zeroed, with room for a vector at the last entry") {
  AlignedArray<float> array(5);
  CHECK(reinterpret_cast<uintptr_t>(array.data()) % kVectorBytes == 0);
  for (const float value : array) CHECK(value == 0);
  for (size_t i = 0; i < kBatchPadding; ++i) array.data()[4 + i] = 1;  // checked by asan
}

TEST_CASE("a parallel loop visits every index once and passes exceptions on") {
  for (const int threads : {0, 1, 2, 7}) {
    std::vector<std::atomic<int>> visits(1000);
    ParallelFor(visits.size(), threads, [&](size_t i) { ++visits[i]; });
    for (const auto& count : visits) REQUIRE(count == 1);
    CHECK_THROWS_AS(ParallelFor(100, threads,
                                [](size_t i) {
                                  if (i == 57) throw Error(ExitCode::kInternal, "", "stop");
                                }),
                    Error);
  }
}

TEST_CASE("a parallel loop begins its indices in ascending order") {
  std::vector<size_t> order;
  ParallelFor(50, 1, [&](size_t i) { order.push_back(i); });
  std::vector<size_t> ascending(50);
  std::iota(ascending.begin(), ascending.end(), size_t{0});
  CHECK(order == ascending);
}

TEST_CASE("a parallel loop stops at an exception") {
  constexpr int kCount = 200;
  std::atomic<int> begun{0};
  const auto body = [&](size_t i) {
    ++begun;
    if (i == 0) {
      // Waits until another worker has started, which then must be stopped. There may be no other
      // worker.
      for (int wait = 0; begun < 2 && wait < 200; ++wait) Sleep();
      throw Error(ExitCode::kInternal, "", "stop");
    }
    Sleep();
  };
  CHECK_THROWS_AS(ParallelFor(kCount, 2, body), Error);
  CHECK(begun < kCount);
}

TEST_CASE("parallel loops may be within one another, and have several callers") {
  std::vector<std::atomic<int>> visits(40 * 50);
  const auto loops = [&] {
    ParallelFor(40, 3,
                [&](size_t i) { ParallelFor(50, 3, [&](size_t j) { ++visits[i * 50 + j]; }); });
  };
  std::thread other(loops);
  loops();
  other.join();
  for (const auto& count : visits) REQUIRE(count == 2);
}

TEST_CASE("a parallel loop takes no more threads than it is given, and ends after its last body") {
  // More threads are there, and come free while the loop runs: none of them may join it.
  std::atomic<bool> others_work{false};
  std::thread other([&] {
    ParallelFor(8, 8, [&](size_t) {
      others_work = true;
      for (int i = 0; i < 10; ++i) Sleep();
    });
  });
  while (!others_work) Sleep();
  std::atomic<int> working{0}, ended{0};
  std::atomic<bool> too_many{false};
  ParallelFor(60, 3, [&](size_t) {
    if (++working > 3) too_many = true;
    Sleep();
    --working;
    ++ended;
  });
  CHECK(ended == 60);
  CHECK_FALSE(too_many);
  other.join();
}

TEST_CASE("denormals are flushed in workers and only there") {
  volatile double tiny = 1e-300;
  std::atomic<int> flushed{0};
  ParallelFor(64, 2, [&](size_t) {
    volatile double small = 1e-300;
    if (small * 1e-10 == 0) ++flushed;
  });
  CHECK(flushed == 64);
  CHECK(tiny * 1e-10 != 0);
  // Denormal operands count as 0, too.
  volatile double denormal = std::numeric_limits<double>::denorm_min();
  std::atomic<int> read_as_zero{0};
  ParallelFor(64, 2, [&](size_t) {
    if (denormal * 1e300 == 0) ++read_as_zero;
  });
  CHECK(read_as_zero == 64);
  CHECK(denormal * 1e300 != 0);
}

TEST_CASE("targets pin and report") {
  const std::vector<Target> targets = SupportedTargets();
  REQUIRE(!targets.empty());
  CHECK(std::is_sorted(targets.begin(), targets.end()));
  CHECK(ActiveTarget() == targets.back());  // nothing is pinned yet
  for (const Target target : targets) {
    PinTarget(target);
    CHECK(ActiveTarget() == target);
  }
  CHECK(SupportedTargets() == targets);
}

}  // namespace
}  // namespace nacre
