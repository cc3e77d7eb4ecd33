// SPDX-License-Identifier: Apache-2.0
// shading/sampled_light.h: lights with an extent, and environments: directions to them, how densely
// these were chosen, and what is seen along a direction. Pdfs are per solid angle.
//
// An estimate of what a hit reflects of such a light is the mean of (reflected radiance of a unit
// light in direction l) x radiance(l) / pdf(l) over directions chosen with that pdf, with
// shadow rays in between. Where two ways of choosing are combined, as Veach and Guibas 1995 do by
// the balance heuristic, pdf(l) is the sum of both.
#pragma once

#include <array>
#include <memory>

#include "hit/batch.h"
#include "light/environment.h"
#include "light/mesh_light.h"
#include "light/sky.h"
#include "sampling/pair_sampler.h"
#include "scene/light.h"
#include "shading/kept_tables.h"
#include "shading/shade.h"

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

// What a sky shows: of its form, one of these.
struct ShadingSky {
  std::array<GradientSkyTerms<float>, 3> gradient{};  // red, green, blue
  QuadraticSkyTerms<float> quadratic{};
  std::shared_ptr<const EnvironmentMap> picture;
  double cos_rotation = 1, sin_rotation = 0;  // of the picture, about +y
};

// A light prepared for sampling. Positions are relative to the camera.
struct SampledLight {
  SampledForm form = SampledForm::kSphere;
  Rgb color{0, 0, 0};     // radiance; of a sky what its value is multiplied by
  Vec3d place{0, 0, 0};   // the centre, or a rectangle's corner
  Vec3d edge_x{0, 0, 0};  // a rectangle's edges from there
  Vec3d edge_y{0, 0, 0};
  Vec3d normal{0, 0, 0};  // of rectangles and disks: unit, to the side that emits
  double radius = 0;
  bool two_sided = false;
  std::shared_ptr<const MeshLight> mesh;  // relative to `place`
  ShadingSky sky;
};

// `light` is neither ambient nor punctual. Its tables are looked for in `kept`, and left there.
SampledLight PrepareSampledLight(const Light& light, const Vec3d& camera_position, KeptTables* kept,
                                 int threads = 1);

inline bool IsSky(const SampledLight& light) { return light.form >= SampledForm::kConstantSky; }

// Whether SampleLight is for it. Other skies are so smooth that directions chosen by what the
// surface reflects serve as well.
inline bool HasSampler(const SampledLight& light) {
  return !IsSky(light) || light.form == SampledForm::kPictureSky;
}

// Whether its radiance depends on the direction.
inline bool IsColored(const SampledLight& light) { return light.form > SampledForm::kConstantSky; }

// Whether LightIrradiance is for it: not for pictures, nor for meshes that hide parts of themselves
// or are of many triangles.
inline bool HasIrradiance(const SampledLight& light) {
  if (light.form == SampledForm::kMesh) {
    return light.two_sided ? light.mesh->is_flat : light.mesh->is_convex;
  }
  return light.form != SampledForm::kPictureSky;
}

struct MeshLightScratch;

// One direction from each hit of a batch, and what of the light is seen there.
struct LightDirections {
  Soa3<float> to_light;                          // unit
  AlignedArray<float> distance{kBatchCapacity};  // infinity: a sky; 0: the light is missed
  AlignedArray<float> pdf{kBatchCapacity};       // with which SampleLight chooses it; 0: never
  Soa3<float> radiance;  // of coloured lights, as multiples of SampledLight::color
  std::shared_ptr<MeshLightScratch> mesh;  // made for the first light of triangles
};

// Chooses directions by the points. A hit that cannot see the light misses it.
void SampleLight(const SampledLight& light, const HitBatch& hits, const UnitPoints& points,
                 LightDirections* directions);

// Fills in all but to_light, which is given.
void FindLight(const SampledLight& light, const HitBatch& hits, LightDirections* directions);

// Where shadow rays along the directions meet the light, in double, as multiples of them. `t_max`
// is changed only where it is positive and finite: the distance of LightDirections then, which is
// off by some 2^-24. `directions` are those of the last SampleLight or FindLight from these hits.
//
// A flat light's is offset.n / direction.n: the products and sums put the end no further from the
// light's plane than 10 2^-53 of the coordinates, at any angle.
void FindEnds(const SampledLight& light, const HitBatch& hits, const LightDirections& directions,
              AlignedArray<double>* t_max);

// The light's irradiance per unit of its colour on each hit that sees all of it, exactly. Of
// coloured lights `irradiance` gives three values, of others one, in x.
void LightIrradiance(const SampledLight& light, const HitBatch& hits, const Surface& surface,
                     Soa3<float>* irradiance);

// What a sky that has colours shows along directions, which need not be unit vectors.
void SkyRadiance(const SampledLight& light, const Soa3<double>& directions, size_t count,
                 Soa3<float>* radiance);

}  // namespace nacre
