// SPDX-License-Identifier: Apache-2.0
// shading/light.h: lights as the kernels want them: relative to the camera, their numbers turned
// into the constants of each form, once per plan.
#pragma once

#include "light/punctual.h"
#include "scene/light.h"

namespace nacre {

// How a light's direction and fall-off are computed.
enum class LightForm : uint8_t {
  kDirectional,
  kInverseSquare,  // a point light's usual fall-off, 1 / (quadratic d^2)
  kPoint,          // with any attenuation
  kSpot,
  kGiven,  // LightBatch says it all
};

// A punctual light prepared for shading. Positions are relative to the camera.
struct ShadingLight {
  LightForm form = LightForm::kInverseSquare;
  Rgb color{0, 0, 0};       // irradiance of a directional light, intensity of the others
  Vec3d position{0, 0, 0};  // of all but directional lights
  Vec3d to_light{0, 0, 0};  // directional: unit, towards the light
  Vec3f axis{0, 0, 0};      // spot: unit, from the light into the cone
  AttenuationTerms<float> attenuation{0, 0, 1};
  float inverse_quadratic = 1;  // kInverseSquare: 1 / quadratic
  ConeTerms<float> cone{-1, -1, 0};

  // Where a shadow ray ends: 1 for one that goes from a hit to `position`, infinity along
  // `to_light`.
  double TMax() const;
};

// `light` is punctual.
ShadingLight PrepareLight(const Light& light, const Vec3d& camera_position);

}  // namespace nacre
