// SPDX-License-Identifier: Apache-2.0
#include "scene/validate_numbers.h"

#include <cmath>

#include <fmt/format.h>

namespace nacre {
namespace {

bool AllIn(const Range& range, double x, double y, double z) {
  return range.Contains(x) && range.Contains(y) && range.Contains(z);
}

std::string Text(double x, double y, double z) { return fmt::format("[{}, {}, {}]", x, y, z); }

}  // namespace

void CheckNumber(double value, const Range& range, const std::string& where, FaultList* faults) {
  if (range.Contains(value)) return;
  faults->Add(where, fmt::format("{} is out of range", value), "a number " + Describe(range));
}

void CheckColor(const Rgb& value, const Range& range, const std::string& where, FaultList* faults) {
  if (AllIn(range, value.x, value.y, value.z)) return;
  faults->Add(where, Text(value.x, value.y, value.z) + " is out of range",
              "each component " + Describe(range));
}

void CheckPoint(const Vec3d& value, const std::string& where, FaultList* faults) {
  if (AllIn(limits::kCoordinate, value.x, value.y, value.z)) return;
  faults->Add(where, Text(value.x, value.y, value.z) + " is out of range",
              "each coordinate " + Describe(limits::kCoordinate));
}

void CheckDirection(const Vec3d& value, const std::string& where, FaultList* faults) {
  const size_t before = faults->count();
  CheckPoint(value, where, faults);
  if (faults->count() == before && !limits::kLength.Contains(value.length())) {
    faults->Add(where, Text(value.x, value.y, value.z) + " has no direction",
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
