// SPDX-License-Identifier: Apache-2.0
// scene/light.h: lights, from points to skies.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "base/huge_pages.h"
#include "base/vec.h"

namespace nacre {

// Fall-off with the distance d of a point or spot light: 1 / (constant + linear d + quadratic d^2).
struct Attenuation {
  double constant = 0;   // >= 0
  double linear = 0;     // >= 0
  double quadratic = 1;  // >= 0; not all three 0

  static Attenuation None() { return {1, 0, 0}; }
  static Attenuation InverseSquare() { return {0, 0, 1}; }
  bool operator==(const Attenuation&) const = default;
};

struct AmbientLight {
  Rgb radiance{0, 0, 0};
};

struct DirectionalLight {
  Vec3d direction_of_travel{0, -1, 0};  // any length > 0
  Rgb irradiance{1, 1, 1};              // on a surface facing the light
};

struct PointLight {
  Vec3d position{0, 0, 0};
  Rgb intensity{1, 1, 1};
  Attenuation attenuation{};
};

// The penumbra as a function of t, the cosine scaled to 0 at the cutoff angle and 1 at the inner
// angle.
enum class SpotEdge : uint8_t {
  kSmoothstep,  // t^2 (3 - 2 t)
  kSquare,      // t^2, as in glTF's KHR_lights_punctual
};

// The intensity is multiplied by cos(a)^exponent within the cone, where a is the angle from the
// axis. The light is dark at and beyond cutoff_deg, with a smooth penumbra between inner_deg and
// cutoff_deg; inner_deg == cutoff_deg gives a hard edge.
struct SpotLight {
  Vec3d position{0, 0, 0};
  Vec3d direction_of_travel{0, -1, 0};  // the axis, any length > 0
  Rgb intensity{1, 1, 1};
  Attenuation attenuation{};
  double cutoff_deg = 30;  // half-angle, in (0, 180]
  double inner_deg = 30;   // in [0, cutoff_deg]
  double exponent = 0;     // >= 0
  SpotEdge edge = SpotEdge::kSmoothstep;
};

// Area lights are surfaces that emit the same radiance everywhere and in all directions. If
// `visible`, the camera sees them, and they occlude other lights.

// Emits outwards.
struct SphereAreaLight {
  Vec3d center{0, 0, 0};
  double radius = 1;  // > 0
  Rgb radiance{1, 1, 1};
  bool visible = true;
};

struct RectangleAreaLight {
  Vec3d center{0, 0, 0};
  Vec3d facing{0, -1, 0};        // the side that emits, any length > 0
  Vec3d up{0, 0, -1};            // along its height, made perpendicular to `facing`
  double width = 1, height = 1;  // > 0
  Rgb radiance{1, 1, 1};
  bool two_sided = false;
  bool visible = true;
};

struct DiskAreaLight {
  Vec3d center{0, 0, 0};
  Vec3d facing{0, -1, 0};  // the side that emits, any length > 0
  double radius = 1;       // > 0
  Rgb radiance{1, 1, 1};
  bool two_sided = false;
  bool visible = true;
};

struct Mesh;

// Triangles that emit from the side on which their corners run counter-clockwise. Along any
// direction only the nearest triangle is seen, by the camera and by the surfaces that the light
// shines on.
struct MeshAreaLight {
  // Only its positions and triangles are used. Shared by copies of the scene, never changed.
  std::shared_ptr<const Mesh> mesh{};
  Rgb radiance{1, 1, 1};
  bool two_sided = false;
  bool visible = true;
};

// The radiance of an environment by direction is one of the four structs that follow. Directions
// are unit vectors, with +y up.
struct ConstantSky {
  Rgb radiance{1, 1, 1};
};

// The colour goes from the horizon's to the zenith's with the height y of the direction,
// mix(horizon, zenith, y), and below the horizon in the same way to the ground's, mix(horizon,
// ground, -y).
struct GradientSky {
  Rgb zenith{0.3, 0.5, 1}, horizon{1, 1, 1}, ground{0.2, 0.2, 0.2};
};

// The radiance is `radiance` (constant + linear c + quadratic c^2), where c is the cosine of the
// angle from `axis`; it must be >= 0 for every c in [-1, 1].
struct QuadraticSky {
  Rgb radiance{1, 1, 1};
  Vec3d axis{0, 1, 0};  // any length > 0
  double constant = 1, linear = 0, quadratic = 0;
};

// Linear radiance by direction, row by row from +y down to -y: the texel at (u, v) in [0, 1)^2 is
// seen in the direction (sin 2 pi u sin pi v, cos pi v, -cos 2 pi u sin pi v). Radiance is constant
// over each texel.
struct SkyPicture {
  int width = 0, height = 0;
  HugeVector<float> rgb;  // 3 width height, each >= 0
};

struct PictureSky {
  std::shared_ptr<const SkyPicture> picture;  // shared by copies of the scene, never changed
  Rgb scale{1, 1, 1};
};

// Light from infinitely far, all around.
struct EnvironmentLight {
  std::variant<ConstantSky, GradientSky, QuadraticSky, PictureSky> sky;
  double rotate_deg = 0;   // about +y, right-handed
  bool background = true;  // seen where nothing is hit, in place of Scene::background
};

struct Light {
  std::string name{};  // unique; names the layer light.<name>
  bool shadows = true;
  std::variant<AmbientLight, DirectionalLight, PointLight, SpotLight, SphereAreaLight,
               RectangleAreaLight, DiskAreaLight, EnvironmentLight, MeshAreaLight>
      kind{};
};

// True for lights without extent, which reach a point from one direction.
inline bool IsPunctual(const Light& light) {
  return std::holds_alternative<DirectionalLight>(light.kind) ||
         std::holds_alternative<PointLight>(light.kind) ||
         std::holds_alternative<SpotLight>(light.kind);
}

}  // namespace nacre
