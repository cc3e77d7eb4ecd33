// shading/kernels.h: the SIMD kernels behind shade.h, one file per reflection model, and the
// uniforms that they take: products of material and light, computed in double, rounded once.
#pragma once

#include <span>

#include "shading/shade.h"

namespace nacre {

// Products of one light and the material's constants, for each light of a range.
struct LambertLight {
  float diffuse[3];  // albedo / pi * light
};

struct PhongLight {
  float diffuse[3], specular[3];  // PhongFamilyModel's constants times light
};

struct PhongUniforms {
  PhongModel model;
  float shininess;
  const PhongLight* lights;
  const NarrowLobes* narrow;  // terms formed in double, for a range under one light; or null
};

struct MicrofacetLight {
  float diffuse[3];   // MicrofacetModel::diffuse * light
  float specular[3];  // light; 0 for a delta lobe, which these lights cannot show
  // kSchlick, with the two ends of its curve multiplied in: F0 and 1 - F0.
  float specular_f0[3], specular_rest[3], diffuse_rest[3];
  float multiple[3];  // kKullaConty: F_ms * light
};

struct MicrofacetUniforms {
  const MicrofacetModel* model;
  const MicrofacetLight* lights;
  // The model's, rounded.
  float alpha, alpha2_over_pi, schlick_k;
  float f0[3], f82_slope[3], eta[3], k[3], f_multiple[3];
  const float* narrow;  // the distribution at each hit, formed in double, under one light; or null
};

// Hits [begin, end) of a batch, the lights on them and where their radiance goes.
struct ShadeRange {
  const HitBatch& hits;
  const Surface& surface;
  std::span<const LightOnBatch> lights;
  size_t begin, end;
  ReflectedRadiance* radiance;
  bool replace = false;  // LitHits'
};

void PrepareMicrofacet(const MicrofacetModel& model, size_t begin, size_t end, Surface* surface);

// The terms of narrow lobes under the first light of a range, formed in double and rounded to
// float. `first`: the GGX distribution.
void NarrowGgx(double alpha, const ShadeRange& range, NarrowLobes* lobes);
// `first`, `second`: 1 - c and c of the lobe's cosine c.
void NarrowPhong(PhongModel model, const ShadeRange& range, NarrowLobes* lobes);

void ShadeLambert(const LambertLight* lights, const ShadeRange& range);
void ShadePhong(const PhongUniforms& uniforms, const ShadeRange& range);
// By the curve of the model's Fresnel term.
void ShadeSchlick(const MicrofacetUniforms& uniforms, const ShadeRange& range);
void ShadeF82(const MicrofacetUniforms& uniforms, const ShadeRange& range);
void ShadeDielectric(const MicrofacetUniforms& uniforms, const ShadeRange& range);
void ShadeConductor(const MicrofacetUniforms& uniforms, const ShadeRange& range);

}  // namespace nacre
