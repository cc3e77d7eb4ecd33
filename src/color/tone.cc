// SPDX-License-Identifier: Apache-2.0
#include "color/tone.h"

#include <utility>

#include "base/error.h"

namespace nacre {
namespace {

constexpr std::pair<ToneOperator, const char*> kToneNames[] = {
    {ToneOperator::kNeutral, "neutral"},
    {ToneOperator::kReinhard, "reinhard"},
    {ToneOperator::kReinhardExtended, "reinhard_extended"},
    {ToneOperator::kAces, "aces"},
    {ToneOperator::kAgx, "agx"},
    {ToneOperator::kNone, "none"},
};

}  // namespace

std::string ToneOperatorName(ToneOperator tone) {
  for (const auto& [value, name] : kToneNames) {
    if (value == tone) return name;
  }
  return {};
}

std::vector<std::string> ToneOperatorNames() {
  std::vector<std::string> names;
  for (const auto& [value, name] : kToneNames) names.emplace_back(name);
  return names;
}

ToneOperator ParseToneOperator(const std::string& name) {
  for (const auto& [value, known] : kToneNames) {
    if (name == known) return value;
  }
  throw Error(ExitCode::kUsage, {}, "unknown tone operator \"" + name + "\"",
              NearestHint(name, ToneOperatorNames(),
                          "one of neutral, reinhard, reinhard_extended, aces, agx, none"));
}

}  // namespace nacre
