// SPDX-License-Identifier: Apache-2.0
// tests/image_io/in_order_test.cc: the reorder buffer.
#include "image_io/in_order.h"

#include <stdexcept>
#include <vector>

#include "files.h"

namespace nacre {
namespace {

TEST_CASE("items from several threads are written in order, one at a time") {
  constexpr size_t kCount = 5000;
  std::vector<size_t> written;
  std::atomic<int> writers = 0;
  bool alone = true;
  InOrder<size_t> in_order([&](size_t index, const size_t& item) {
    alone = alone && ++writers == 1;
    if (item == 10 * index) written.push_back(index);
    --writers;
  });
  ShuffledInThreads(kCount, [&](size_t i) { in_order.Add(i, 10 * i); });
  CHECK(in_order.count() == kCount);
  CHECK(alone);
  REQUIRE(written.size() == kCount);
  for (size_t i = 0; i < kCount; ++i) REQUIRE(written[i] == i);
}

TEST_CASE("an item that waits for another is not written") {
  size_t written = 0;
  InOrder<int> in_order([&](size_t, int) { ++written; });
  in_order.Add(0, 0);
  in_order.Add(2, 0);
  CHECK(in_order.count() == 1);
  CHECK(written == 1);
  CHECK(Catching([&] { in_order.Add(0, 0); }).code == ExitCode::kInternal);
  CHECK(Catching([&] { in_order.Add(2, 0); }).code == ExitCode::kInternal);
}

TEST_CASE("nothing is written after a failure") {
  size_t calls = 0;
  InOrder<int> in_order([&](size_t, int) {
    ++calls;
    throw std::runtime_error("disk full");
  });
  CHECK_THROWS_AS(in_order.Add(0, 0), std::runtime_error);
  in_order.Add(1, 0);
  CHECK(calls == 1);
  CHECK(in_order.count() == 0);
}

}  // namespace
}  // namespace nacre
