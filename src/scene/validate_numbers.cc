// SPDX-License-Identifier: Apache-2.0
#include "scene/validate_numbers.h"

#include <fmt/format.h>

namespace nacre {
namespace {

std::string Text(const Vec3d& v) { return fmt::format("[{}, {}, {}]", v.x, v.y, v.z); }

// `each` says what the range holds for.
void CheckAll(const Vec3d& v, const Range& range, const char* each, const std::string& where,
              FaultList* faults) {
  if (range.Contains(v.x) && range.Contains(v.y) && range.Contains(v.z)) return;
  faults->Add(where, Text(v) + " is out of range", each + Describe(range));
}

}  // namespace

void CheckNumber(double value, const Range& range, const std::string& where, FaultList* faults) {
  if (range.Contains(value)) return;
  faults->Add(where, fmt::format("{} is out of range", value), "a number " + Describe(range));
}

void CheckColor(const Rgb& value, const Range& range, const std::string& where, FaultList* faults) {
  CheckAll(Vec3d(value), range, "each component ", where, faults);
}

void CheckPoint(const Vec3d& value, const std::string& where, FaultList* faults) {
  CheckAll(value, limits::kCoordinate, "each coordinate ", where, faults);
}

void CheckDirection(const Vec3d& value, const std::string& where, FaultList* faults) {
  const size_t before = faults->count();
  CheckPoint(value, where, faults);
  if (faults->count() == before && !limits::kLength.Contains(value.length())) {
    faults->Add(where, Text(value) + " has no direction",
                "a vector of any length " + Describe(limits::kLength));
  }
}

void CheckMaterial(MaterialId id, size_t material_count, const std::string& where,
                   FaultList* faults) {
  if (!id.valid()) {
    faults->Add(where, "no material", "set the handle of one of the scene's materials");
  } else if (id.index >= material_count) {
    faults->Add(where, fmt::format("there is no material {}", id.index),
                fmt::format("the scene has {}", material_count));
  }
}

}  // namespace nacre
