// SPDX-License-Identifier: Apache-2.0
#include "scalar_baseline.h"

#include <algorithm>
#include <cmath>

namespace nacre::baseline {
namespace {

constexpr float kPi = 3.14159265f;

struct Vec {
  float x, y, z;
};

Vec operator+(Vec a, Vec b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
Vec operator-(Vec a, Vec b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
Vec operator*(Vec a, float s) { return {a.x * s, a.y * s, a.z * s}; }
float Dot(Vec a, Vec b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
Vec Normalize(Vec a) { return a * (1 / std::sqrt(Dot(a, a))); }

// What every model starts from at hit i.
struct Setup {
  Vec n, v, l;
  float n_dot_l, falloff;
};

Setup MakeSetup(const Hits& h, size_t i, const PointLight& light) {
  Setup s;
  s.n = {h.nx[i], h.ny[i], h.nz[i]};
  s.v = {h.vx[i], h.vy[i], h.vz[i]};
  const Vec offset = Vec{light.x, light.y, light.z} - Vec{h.px[i], h.py[i], h.pz[i]};
  s.l = Normalize(offset);
  s.n_dot_l = std::max(Dot(s.n, s.l), 0.0f);
  s.falloff = 1 / Dot(offset, offset);
  return s;
}

void Put(const Hits& h, size_t i, float r, float g, float b) {
  h.r[i] = r;
  h.g[i] = g;
  h.b[i] = b;
}

float DistributionGgx(float n_dot_h, float roughness) {
  const float alpha = roughness * roughness;
  const float a2 = alpha * alpha;
  const float denominator = n_dot_h * n_dot_h * (a2 - 1) + 1;
  return a2 / (kPi * denominator * denominator);
}

template <class Geometry>
void ShadeGgx(const Hits& h, size_t count, const PointLight& light, const MetallicRoughness& m,
              const Geometry& geometry) {
  for (size_t i = 0; i < count; ++i) {
    const Setup s = MakeSetup(h, i, light);
    const Vec half = Normalize(s.l + s.v);
    const float n_dot_v = std::max(Dot(s.n, s.v), 0.0f);
    const float n_dot_h = std::max(Dot(s.n, half), 0.0f);
    const float v_dot_h = std::max(Dot(s.v, half), 0.0f);
    const float d = DistributionGgx(n_dot_h, m.roughness);
    const float g = geometry(s.n_dot_l, n_dot_v);
    const float specular = d * g / std::max(4 * s.n_dot_l * n_dot_v, 1e-7f);
    const float x = 1 - v_dot_h;
    const float x5 = x * x * x * x * x;
    const float weight = s.n_dot_l * s.falloff;
    float out[3];
    const float color[3] = {light.r, light.g, light.b};
    for (int c = 0; c < 3; ++c) {
      const float f0 = 0.04f * (1 - m.metallic) + m.base_color[c] * m.metallic;
      const float fresnel = f0 + (1 - f0) * x5;
      const float diffuse = (1 - fresnel) * (1 - m.metallic) * m.base_color[c] / kPi;
      out[c] = (diffuse + fresnel * specular) * color[c] * weight;
    }
    Put(h, i, out[0], out[1], out[2]);
  }
}

}  // namespace

void ShadeLambert(const Hits& h, size_t count, const PointLight& light, const float albedo[3]) {
  for (size_t i = 0; i < count; ++i) {
    const Setup s = MakeSetup(h, i, light);
    const float weight = s.n_dot_l * s.falloff / kPi;
    Put(h, i, albedo[0] * light.r * weight, albedo[1] * light.g * weight,
        albedo[2] * light.b * weight);
  }
}

void ShadePhong(const Hits& h, size_t count, const PointLight& light, const float kd[3], float ks,
                float shininess) {
  for (size_t i = 0; i < count; ++i) {
    const Setup s = MakeSetup(h, i, light);
    const Vec r = s.n * (2 * Dot(s.n, s.l)) - s.l;
    const float lobe = s.n_dot_l > 0 ? std::pow(std::max(Dot(r, s.v), 0.0f), shininess) : 0.0f;
    const float diffuse = s.n_dot_l * s.falloff;
    const float specular = ks * lobe * s.falloff;
    Put(h, i, (kd[0] * diffuse + specular) * light.r, (kd[1] * diffuse + specular) * light.g,
        (kd[2] * diffuse + specular) * light.b);
  }
}

void ShadeBlinnPhong(const Hits& h, size_t count, const PointLight& light, const float kd[3],
                     float ks, float shininess) {
  for (size_t i = 0; i < count; ++i) {
    const Setup s = MakeSetup(h, i, light);
    const Vec half = Normalize(s.l + s.v);
    const float lobe = s.n_dot_l > 0 ? std::pow(std::max(Dot(s.n, half), 0.0f), shininess) : 0.0f;
    const float diffuse = s.n_dot_l * s.falloff;
    const float specular = ks * lobe * s.falloff;
    Put(h, i, (kd[0] * diffuse + specular) * light.r, (kd[1] * diffuse + specular) * light.g,
        (kd[2] * diffuse + specular) * light.b);
  }
}

void ShadeGgxSchlickDirect(const Hits& h, size_t count, const PointLight& light,
                           const MetallicRoughness& m) {
  const float k = (m.roughness + 1) * (m.roughness + 1) / 8;
  ShadeGgx(h, count, light, m, [k](float n_dot_l, float n_dot_v) {
    return n_dot_l / (n_dot_l * (1 - k) + k) * (n_dot_v / (n_dot_v * (1 - k) + k));
  });
}

void ShadeGgxHeightCorrelated(const Hits& h, size_t count, const PointLight& light,
                              const MetallicRoughness& m) {
  const float alpha = m.roughness * m.roughness;
  const float a2 = alpha * alpha;
  ShadeGgx(h, count, light, m, [a2](float n_dot_l, float n_dot_v) {
    const float l = n_dot_v * std::sqrt(n_dot_l * n_dot_l * (1 - a2) + a2);
    const float v = n_dot_l * std::sqrt(n_dot_v * n_dot_v * (1 - a2) + a2);
    return 2 * n_dot_l * n_dot_v / std::max(l + v, 1e-7f);
  });
}

}  // namespace nacre::baseline
