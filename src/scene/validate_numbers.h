// SPDX-License-Identifier: Apache-2.0
// scene/validate_numbers.h: the checks of single values that Validate() is made of.
#pragma once

#include <string>

#include "base/vec.h"
#include "scene/fault_list.h"
#include "scene/handle.h"
#include "scene/keys.h"
#include "scene/limits.h"

namespace nacre {

// If the sine of the angle between two directions is below this, they span no plane: a basis made
// of them would consist of rounding errors, as coordinates carry 53 bits.
constexpr double kMinSineOfUp = 1e-12;

void CheckNumber(double value, const Range& range, const std::string& where, FaultList* faults);
void CheckColor(const Rgb& value, const Range& range, const std::string& where, FaultList* faults);
void CheckPoint(const Vec3d& value, const std::string& where, FaultList* faults);

// Checks a vector whose length does not matter but must not be zero.
void CheckDirection(const Vec3d& value, const std::string& where, FaultList* faults);

// Checks all keys of a struct (scene/keys.h), which is at `where` in the scene.
template <class Owner>
void CheckKeys(const Owner& owner, const std::string& where, FaultList* faults) {
  for (const SceneKey<Owner>& key : KeysFor(owner)) {
    const Vec3d value = key.get(owner);
    const std::string place = where + "/" + std::string(key.name);
    switch (key.form) {
      case KeyForm::kNumber:
      case KeyForm::kWhole:
        CheckNumber(value.x, key.range, place, faults);
        break;
      case KeyForm::kColor:
        CheckColor(Rgb(value), key.range, place, faults);
        break;
      case KeyForm::kPoint:
        CheckPoint(value, place, faults);
        break;
      case KeyForm::kDirection:
        CheckDirection(value, place, faults);
        break;
      case KeyForm::kBoolean:
      case KeyForm::kChoice:
        break;
    }
  }
}

void CheckMaterial(MaterialId id, size_t material_count, const std::string& where,
                   FaultList* faults);

}  // namespace nacre
