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
  float to_light[3] = {};   // directional: unit, towards the light
  float axis[3] = {};       // spot: unit, from the light into the cone
  AttenuationTerms<float> attenuation{0, 0, 1};
  ConeTerms<float> cone{-1, -1, 0};
};

struct LambertUniforms {
  float diffuse[3];  // albedo / pi * light
};

struct PhongUniforms {
  PhongModel model;
  float diffuse[3];   // kd colour * light, over pi if radiometric
  float specular[3];  // ks * light, times the lobe's normalisation if radiometric
  float shininess;
};

struct MetallicRoughnessUniforms {
  Shadowing shadowing;
  float diffuse[3];   // (1 - metallic) base_color / pi * light
  float specular[3];  // light; 0 for a delta lobe, which these lights cannot show
  float f0[3];
  float alpha;      // of the lobe; 1 for a delta lobe
  float schlick_k;  // (roughness + 1)^2 / 8
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
void ShadeLambert(const LambertUniforms& uniforms, const ShadeRange& range);
void ShadePhong(const PhongUniforms& uniforms, const ShadeRange& range);
void ShadeMetallicRoughness(const MetallicRoughnessUniforms& uniforms, const ShadeRange& range);

}  // namespace nacre
