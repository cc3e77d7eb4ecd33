// SPDX-License-Identifier: Apache-2.0
// shading/light.h: lights as the kernels want them: relative to the camera, their numbers turned
// into the constants of each form, once per plan.
#pragma once

#include <cmath>
#include <span>
#include <vector>

#include "light/punctual.h"
#include "scene/camera.h"
#include "scene/light.h"
#include "scene/shapes.h"

namespace nacre {

// How a light's direction and fall-off are computed.
enum class LightForm : uint8_t {
  kDirectional,
  kInverseSquare,  // a point light's usual fall-off, 1 / d^2
  kPoint,          // with any attenuation
  kSpot,
  kGiven,  // direction and irradiance of each hit are in the LightBatch
};

// A light's position minus a sphere's centre, and the sphere's radius. A hit with the outward
// normal n is `radius` n from the centre, so the light is `offset` - `radius` n from the hit.
struct SphereOffset {
  Vec3f offset;
  float radius;
};

// A punctual light prepared for shading. Positions are relative to the camera.
struct ShadingLight {
  LightForm form = LightForm::kInverseSquare;
  // Irradiance of a directional light, intensity of the others: kInverseSquare's over `quadratic`.
  Rgb color{0, 0, 0};
  Vec3d position{0, 0, 0};  // of all but directional lights
  Vec3d to_light{0, 0, 0};  // directional: unit, towards the light
  Vec3d axis{0, 0, 0};      // spot: unit, from the light into the cone
  AttenuationTerms<float> attenuation{0, 0, 1};
  ConeTerms<double> cone{2, 2, 0};

  // One per sphere of the scene: where the light lies from hits is then found from their normals,
  // and neither their positions nor doubles are asked for. Empty: from their positions.
  std::vector<SphereOffset> from_spheres{};

  // Where a shadow ray ends: 1 for one that goes from a hit to `position`, infinity along
  // `to_light`.
  double TMax() const;
};

// `light` is punctual.
ShadingLight PrepareLight(const Light& light, const Vec3d& camera_position);

// Fills `from_spheres`, if the light is a point light and from each sphere's centre at least
// kFarRadii of its radii away; or returns false. The shaded hits must all lie on these spheres,
// their normals on the outside: Surface::unturned, where maps have turned them.
//
// The offset l = a - r n is then off by 3 u |l| at most, u = 2^-24, where what is formed in double
// and rounded is off by u |l|: |a| <= 4/3 |l| and r <= |l| / 3, so the roundings of a, r, n and of
// the result leave 4/3 u, 1/3 u, 1/3 u and u of |l|; targets without fused products round r n, too:
// 1/3 u more.
inline constexpr double kFarRadii = 4;
bool OffsetFromSpheres(std::span<const Sphere> spheres, const Vec3d& camera_position,
                       ShadingLight* light);

}  // namespace nacre
