// SPDX-License-Identifier: Apache-2.0
// lesson/fault_entries.h: the faults of the founding documents, described in words, and with
// effects that are computed on demand.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "lesson/code_change.h"

namespace nacre {

// Lines of text about a fault's effect, measured on the lesson's pictures or from its formula.
using FaultAmount = std::vector<std::string> (*)(const LessonPictures& lesson);

struct FaultEntry {
  std::string_view id;      // "E4"
  std::string_view title;   // "+ 0.0001 in the specular denominator"
  std::string_view lesson;  // what the lesson or another founding document does
  std::string_view right;
  std::string_view nacre;  // what nacre does
  FaultAmount amount;
};

// E1 to E30.
std::span<const FaultEntry> FaultEntries();

}  // namespace nacre
