// SPDX-License-Identifier: Apache-2.0
#include "color/tone.h"

#include <algorithm>
#include <array>
#include <string_view>

#include "base/error.h"

namespace nacre {
namespace {

// Indexed by ToneOperator.
constexpr std::array<std::string_view, 6> kToneNames = {"neutral", "reinhard", "reinhard_extended",
                                                        "aces",    "agx",      "none"};

}  // namespace

std::string ToneOperatorName(ToneOperator tone) {
  return std::string(kToneNames[static_cast<size_t>(tone)]);
}

std::vector<std::string> ToneOperatorNames() { return {kToneNames.begin(), kToneNames.end()}; }

ToneOperator ParseToneOperator(const std::string& name) {
  const auto found = std::ranges::find(kToneNames, name);
  if (found != kToneNames.end()) return static_cast<ToneOperator>(found - kToneNames.begin());
  throw Error(ExitCode::kUsage, {}, "unknown tone operator \"" + name + "\"",
              NearestHint(name, ToneOperatorNames(),
                          "one of neutral, reinhard, reinhard_extended, aces, agx, none"));
}

}  // namespace nacre
