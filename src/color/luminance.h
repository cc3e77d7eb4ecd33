// SPDX-License-Identifier: Apache-2.0
// color/luminance.h: relative luminance of linear Rec. 709 values.
#pragma once

#include <Imath/ImathColor.h>

namespace nacre {

// ITU-R BT.709-6, item 3.2: the Y row of its RGB to XYZ matrix, to the four digits it gives.
template <typename Real>
Real Luminance(const Imath::Color3<Real>& rgb) {
  return Real(0.2126) * rgb.x + Real(0.7152) * rgb.y + Real(0.0722) * rgb.z;
}

}  // namespace nacre
