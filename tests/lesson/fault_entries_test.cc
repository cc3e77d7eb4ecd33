// SPDX-License-Identifier: Apache-2.0
// tests/lesson/fault_entries_test.cc: every fault of the lesson has words and a measured amount.
#include "lesson/fault_entries.h"

#include <set>

#include "catch.h"

namespace nacre {
namespace {

TEST_CASE("faults are numbered without a gap, and each says all that is asked of it") {
  const LessonPictures lesson = RenderLesson({});
  int number = 0;
  for (const FaultEntry& entry : FaultEntries()) {
    CAPTURE(entry.id);
    CHECK(entry.id == "E" + std::to_string(++number));
    for (const std::string_view words : {entry.title, entry.lesson, entry.right, entry.nacre}) {
      CHECK_FALSE(words.empty());
    }
    const std::vector<std::string> amount = entry.amount(lesson);
    REQUIRE_FALSE(amount.empty());
    for (const std::string& line : amount) {
      CHECK_FALSE(line.empty());
      CHECK(line.find("nan") == std::string::npos);
    }
  }
  CHECK(number == 30);
}

TEST_CASE("every switch of the lesson's program is a fault with an entry") {
  std::set<std::string_view> ids;
  for (const FaultEntry& entry : FaultEntries()) ids.insert(entry.id);
  for (const FaultSwitch& fault : FaultSwitches()) {
    CAPTURE(fault.name);
    CHECK(ids.contains(fault.fault));
  }
}

TEST_CASE("the change between pictures is counted where either shows a sphere") {
  // Pixels: background in both, a sphere in one, a sphere in both.
  const std::vector<uint8_t> a = {9, 9, 9, 10, 10, 10, 20, 20, 20};
  const std::vector<uint8_t> b = {0, 0, 0, 10, 10, 13, 20, 20, 20};
  const CodeChange change = MeasureChange(a, b, {0, 0, 1}, {0, 1, 1});
  CHECK(change.largest == 3);
  CHECK(change.mean == 3.0 / 6);
  CHECK(change.share == 0.5);
  CHECK(ChangeText(MeasureChange(a, a, {1, 1, 1}, {1, 1, 1})) == "no change");
}

}  // namespace
}  // namespace nacre
