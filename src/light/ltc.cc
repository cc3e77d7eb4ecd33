// SPDX-License-Identifier: Apache-2.0
#include "light/ltc.h"

namespace nacre {
namespace {

constexpr LtcRow kTable[kLtcRoughnesses] = {
#include "light/ltc_table.inc"
};

}  // namespace

LtcRow MakeLtcRow(double roughness) {
  const double at =
      std::clamp((roughness - kLeastLtcRoughness) / (1 - kLeastLtcRoughness), 0.0, 1.0) *
      (kLtcRoughnesses - 1);
  const size_t i = std::min(static_cast<size_t>(at), kLtcRoughnesses - 2);
  const auto t = static_cast<float>(at - static_cast<double>(i));
  LtcRow row;
  for (size_t k = 0; k < kLtcViews; ++k) row[k] = Blend(kTable[i][k], kTable[i + 1][k], t);
  return row;
}

}  // namespace nacre
