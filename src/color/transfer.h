// SPDX-License-Identifier: Apache-2.0
// color/transfer.h: the sRGB transfer curves, exact. 8-bit codes are made by color/srgb8.h.
#pragma once

#include <cmath>

namespace nacre {

// Maps linear light in [0, 1] to the encoded value in [0, 1] (IEC 61966-2-1:1999, 5.2). The
// standard's rounded constants leave a step of 2.9e-8 where the pieces meet.
template <typename Real>
Real SrgbOetf(Real linear) {
  return linear <= Real(0.0031308) ? Real(12.92) * linear
                                   : Real(1.055) * std::pow(linear, Real(1 / 2.4)) - Real(0.055);
}

// Maps the encoded value in [0, 1] to linear light in [0, 1] (IEC 61966-2-1:1999, 5.3).
template <typename Real>
Real SrgbEotf(Real encoded) {
  return encoded <= Real(0.04045) ? encoded / Real(12.92)
                                  : std::pow((encoded + Real(0.055)) / Real(1.055), Real(2.4));
}

}  // namespace nacre
