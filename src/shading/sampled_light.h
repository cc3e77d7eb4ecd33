// SPDX-License-Identifier: Apache-2.0
// shading/sampled_light.h: area lights and environments, prepared for sampling (light_sampling.h).
#pragma once

#include <array>
#include <memory>

#include "light/environment.h"
#include "light/mesh_light.h"
#include "light/sky.h"
#include "scene/light.h"
#include "shading/kept_tables.h"

namespace nacre {

enum class SampledForm : uint8_t {
  kSphere,
  kRectangle,
  kDisk,
  kMesh,
  kConstantSky,
  kGradientSky,
  kQuadraticSky,
  kPictureSky,
};

// The radiance of a sky. The member that belongs to its SampledForm is set.
struct ShadingSky {
  std::array<GradientSkyTerms<float>, 3> gradient{};  // red, green, blue
  QuadraticSkyTerms<float> quadratic{};
  std::shared_ptr<const EnvironmentMap> picture;
  double cos_rotation = 1, sin_rotation = 0;  // rotation of the picture about +y
};

// A light prepared for sampling. Positions are relative to the camera.
struct SampledLight {
  SampledForm form = SampledForm::kSphere;
  Rgb color{0, 0, 0};     // radiance; if IsColored, the factor of the sky's radiance
  Vec3d place{0, 0, 0};   // the centre, or a rectangle's corner
  Vec3d edge_x{0, 0, 0};  // a rectangle's edges from its corner
  Vec3d edge_y{0, 0, 0};
  Vec3d normal{0, 0, 0};  // rectangles and disks: unit vector on the side that emits
  double radius = 0;
  bool two_sided = false;
  std::shared_ptr<const MeshLight> mesh;  // relative to `place`
  ShadingSky sky;
};

// `light` must be neither ambient nor punctual. Its tables are taken from `kept`, or made and added
// to it, on up to `threads` threads.
SampledLight PrepareSampledLight(const Light& light, const Vec3d& camera_position, KeptTables* kept,
                                 int threads = 1);

inline bool IsSky(const SampledLight& light) { return light.form >= SampledForm::kConstantSky; }

// Whether SampleLight applies to the light. Skies without a sampler are so smooth that sampling the
// surface's lobes is as good.
inline bool HasSampler(const SampledLight& light) {
  return !IsSky(light) || light.form == SampledForm::kPictureSky;
}

// Whether the light's radiance depends on the direction.
inline bool IsColored(const SampledLight& light) { return light.form > SampledForm::kConstantSky; }

// Whether LightIrradiance applies to the light: not to picture skies, nor to meshes that hide parts
// of themselves or have many triangles (kMaxClosedFormTriangles).
inline bool HasIrradiance(const SampledLight& light) {
  if (light.form == SampledForm::kMesh) {
    return light.two_sided ? light.mesh->is_flat : light.mesh->is_convex;
  }
  return light.form != SampledForm::kPictureSky;
}

}  // namespace nacre
