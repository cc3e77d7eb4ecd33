// SPDX-License-Identifier: Apache-2.0
// scene/validate_numbers.h: the checks of single values that Validate() is made of.
#pragma once

#include <string>

#include "base/vec.h"
#include "scene/fault_list.h"
#include "scene/handle.h"
#include "scene/limits.h"

namespace nacre {

// Below this sine of the angle between them two directions span no plane: a basis made of them
// would be rounding errors, as coordinates carry 53 bits.
constexpr double kMinSineOfUp = 1e-12;

void CheckNumber(double value, const Range& range, const std::string& where, FaultList* faults);
void CheckColor(const Rgb& value, const Range& range, const std::string& where, FaultList* faults);
void CheckPoint(const Vec3d& value, const std::string& where, FaultList* faults);

// A vector whose length counts for nothing but must not be zero.
void CheckDirection(const Vec3d& value, const std::string& where, FaultList* faults);

void CheckMaterial(MaterialId id, size_t material_count, const std::string& where,
                   FaultList* faults);

}  // namespace nacre
