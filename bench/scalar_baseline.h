// SPDX-License-Identifier: Apache-2.0
// bench/scalar_baseline.h: what the SIMD kernels are measured against: plain per-hit float C++ in
// the textbook's form. Not for use in the renderer: its forms are neither stable nor exact.
#pragma once

#include <cstddef>

namespace nacre::baseline {

struct Hits {
  const float *px, *py, *pz;  // positions
  const float *nx, *ny, *nz;  // normals
  const float *vx, *vy, *vz;  // to the viewer
  float *r, *g, *b;           // radiance
};

struct PointLight {
  float x, y, z, r, g, b;
};

// Each stores what hits [0, count) reflect of one point light.
void ShadeLambert(const Hits& hits, size_t count, const PointLight& light, const float albedo[3]);
void ShadePhong(const Hits& hits, size_t count, const PointLight& light, const float kd[3],
                float ks, float shininess);
void ShadeBlinnPhong(const Hits& hits, size_t count, const PointLight& light, const float kd[3],
                     float ks, float shininess);

struct MetallicRoughness {
  float base_color[3];
  float metallic, roughness;
};
void ShadeGgxSchlickDirect(const Hits& hits, size_t count, const PointLight& light,
                           const MetallicRoughness& material);
void ShadeGgxHeightCorrelated(const Hits& hits, size_t count, const PointLight& light,
                              const MetallicRoughness& material);

}  // namespace nacre::baseline
