// shading/kernels.h: the SIMD kernels behind shade.h, one file per reflection model, and the
// uniforms that they take: products of material and light, computed in double, rounded once.
#pragma once

#include "light/punctual.h"
#include "shading/shade.h"

namespace nacre {

// A light's constants. Positions relative to the camera.
struct LightUniforms {
  enum class Kind { kDirectional, kPoint, kSpot };
  Kind kind = Kind::kPoint;
  double position[3] = {};  // point, spot
  double to_light[3] = {};  // directional: unit, towards the light
  float axis[3] = {};       // spot: unit, from the light into the cone
  AttenuationTerms<float> attenuation{0, 0, 1};
  ConeTerms<float> cone{-1, -1, 0};
};

struct LambertUniforms {
  float diffuse[3];  // albedo / pi * light
};

struct PhongUniforms {
  PhongModel model;
  float diffuse[3];  // LambertUniforms' and PhongFamilyModel's constants times light
  float specular[3];
  float shininess;
  const NarrowLobes* narrow;  // terms formed in double, or null
};

struct MicrofacetUniforms {
  const MicrofacetModel* model;
  float diffuse[3];     // MicrofacetModel::diffuse * light
  float specular[3];    // light; 0 for a delta lobe, which these lights cannot show
  float multiple[3];    // kKullaConty: F_ms * light
  const float* narrow;  // the distribution of each hit, formed in double, or null
};

// Hits [begin, end) of a batch and where their radiance goes.
struct ShadeRange {
  const Surface& surface;
  const LightBatch& light;
  size_t begin, end;
  ReflectedRadiance* radiance;
};

void EvaluateLightKernel(const LightUniforms& light, const HitBatch& hits, const Surface& surface,
                         LightBatch* result);
void PrepareMicrofacet(const MicrofacetModel& model, size_t begin, size_t end, Surface* surface);

// The terms of narrow lobes at hits [begin, end), formed in double and rounded to float.
// `first`: the GGX distribution.
void NarrowGgx(double alpha, const LitHits& lit, size_t begin, size_t end, NarrowLobes* lobes);
// `first`, `second`: 1 - c and c of the lobe's cosine c.
void NarrowPhong(PhongModel model, const LitHits& lit, size_t begin, size_t end,
                 NarrowLobes* lobes);

void ShadeLambert(const LambertUniforms& uniforms, const ShadeRange& range);
void ShadePhong(const PhongUniforms& uniforms, const ShadeRange& range);
// By the curve of the model's Fresnel term.
void ShadeSchlick(const MicrofacetUniforms& uniforms, const ShadeRange& range);
void ShadeF82(const MicrofacetUniforms& uniforms, const ShadeRange& range);
void ShadeDielectric(const MicrofacetUniforms& uniforms, const ShadeRange& range);
void ShadeConductor(const MicrofacetUniforms& uniforms, const ShadeRange& range);

}  // namespace nacre
