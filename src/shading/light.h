// SPDX-License-Identifier: Apache-2.0
// shading/light.h: punctual lights in the form that kernels need: relative to the camera, with the
// constants of each form computed once per plan.
#pragma once

#include <cmath>
#include <span>
#include <vector>

#include "light/punctual.h"
#include "scene/camera.h"
#include "scene/light.h"
#include "scene/shapes.h"
#include "shading/surface.h"

namespace nacre {

// How a light's direction and fall-off are computed.
enum class LightForm : uint8_t {
  kDirectional,
  kInverseSquare,  // a point light with the usual fall-off, 1 / d^2
  kPoint,          // a point light with any attenuation
  kSpot,
  kGiven,  // direction and irradiance at each hit are given in the LightBatch
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
  // The irradiance of a directional light, or the intensity of others; for kInverseSquare, the
  // intensity over the quadratic attenuation.
  Rgb color{0, 0, 0};
  Vec3d position{0, 0, 0};  // not for directional lights
  Vec3d to_light{0, 0, 0};  // directional lights: unit vector towards the light
  Vec3d axis{0, 0, 0};      // spot lights: unit vector from the light into the cone
  AttenuationTerms<float> attenuation{0, 0, 1};
  ConeTerms<double> cone{2, 2, 0};

  // One entry per sphere of the scene, or empty. If not empty, offsets from hits to the light are
  // computed from the hits' normals, which needs neither positions nor doubles; else from the hits'
  // positions.
  std::vector<SphereOffset> from_spheres{};

  // The end of shadow rays to the light: 1 for a ray from a hit to `position`, infinity for a ray
  // along `to_light`.
  double TMax() const;
};

// `light` must be punctual.
ShadingLight PrepareLight(const Light& light, const Vec3d& camera_position);

// Fills `from_spheres` if the light is a point light that is at least kFarRadii radii away from the
// centre of each sphere; else returns false. All shaded hits must lie on these spheres, with their
// normals on the outside. Normals are taken before normal mapping (Surface::interpolated_normal).
//
// The error of the offset l = a - r n is then 3 u |l| at most, u = 2^-24, where an offset that is
// computed in double and rounded has an error of u |l|: |a| <= 4/3 |l| and r <= |l| / 3, so
// rounding a, r, n and the result contributes 4/3 u, 1/3 u, 1/3 u and u of |l|; targets without
// fused multiply-add round r n, too, which adds 1/3 u.
inline constexpr double kFarRadii = 4;
bool OffsetFromSpheres(std::span<const Sphere> spheres, const Vec3d& camera_position,
                       ShadingLight* light);

// Whether ShadeRun can evaluate the light by itself: true for directional lights, and for point
// lights far from all spheres that fall off with the square of the distance
// (ShadingLight::from_spheres).
bool EvaluatedInPlace(const ShadingLight& light);

// Stores the direction and irradiance of the light at every hit. The light must not be
// LightForm::kGiven.
void EvaluateLight(const ShadingLight& light, const HitBatch& hits, const Surface& surface,
                   LightBatch* result);

}  // namespace nacre
