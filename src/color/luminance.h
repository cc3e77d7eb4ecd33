// SPDX-License-Identifier: Apache-2.0
// color/luminance.h: relative luminance of linear Rec. 709 values.
#pragma once

#include <Imath/ImathColor.h>

namespace nacre {

// ITU-R BT.709-6, item 3.2: the Y row of its RGB to XYZ matrix, to the four digits it gives.
inline constexpr double kLuminanceWeights[] = {0.2126, 0.7152, 0.0722};

template <typename Real>
Real Luminance(const Imath::Color3<Real>& rgb) {
  return Real(kLuminanceWeights[0]) * rgb.x + Real(kLuminanceWeights[1]) * rgb.y +
         Real(kLuminanceWeights[2]) * rgb.z;
}

}  // namespace nacre
