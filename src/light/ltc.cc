// SPDX-License-Identifier: Apache-2.0
#include "light/ltc.h"

#include "light/ltc_one.h"
#include "light/ltc_schlick.h"

namespace nacre {

LtcRows MakeLtcRows(double roughness) {
  const double at =
      std::clamp((roughness - kLeastLtcRoughness) / (1 - kLeastLtcRoughness), 0.0, 1.0) *
      (kLtcRoughnesses - 1);
  const size_t i = std::min(static_cast<size_t>(at), kLtcRoughnesses - 2);
  const auto t = static_cast<float>(at - static_cast<double>(i));
  LtcRows rows;
  for (size_t k = 0; k < kLtcViews; ++k) {
    rows.one[k] = Blend(kLtcOne[i][k], kLtcOne[i + 1][k], t);
    rows.schlick[k] = Blend(kLtcSchlick[i][k], kLtcSchlick[i + 1][k], t);
  }
  return rows;
}

}  // namespace nacre
