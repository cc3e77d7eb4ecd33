// SPDX-License-Identifier: Apache-2.0
#include "study/phong_share.h"

#include <cmath>

#include "brdf/phong.h"
#include "shading/share.h"

namespace nacre {

double PhongShare(const PhongCoefficients& phong, PhongUnits units, double cosine) {
  const double lobe = PhongLobeIntegral(phong.shininess, cosine);
  switch (units) {
    case PhongUnits::kLiteral:
      return M_PI * phong.kd + phong.ks * lobe / cosine;
    case PhongUnits::kOverPi:
      return phong.kd + phong.ks * lobe / cosine / M_PI;
    case PhongUnits::kModified:
      return M_PI * phong.kd + phong.ks * lobe;
    case PhongUnits::kModifiedOverPi:
      return phong.kd + phong.ks * lobe / M_PI;
    case PhongUnits::kModifiedNormalised:
      break;
  }
  return phong.kd + phong.ks * PhongNormalization(phong.shininess) * lobe;
}

}  // namespace nacre
