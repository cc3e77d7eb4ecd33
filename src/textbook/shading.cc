// SPDX-License-Identifier: Apache-2.0
#include "textbook/shading.h"

#include <algorithm>
#include <cmath>

namespace nacre {

Vec3d TextbookNormalize(const Vec3d& v, const TextbookFaults& faults) {
  const double length = std::sqrt(v.length2());
  const double shortest = faults.normalize_epsilon ? 1e-10 : 0;
  return length > shortest ? v / length : v;
}

// ---- Phong --------------------------------------------------------------------------------------

double TextbookPhongLobe(const TextbookPoint& p, double shininess) {
  const Vec3d reflected = p.normal * (2 * (p.normal ^ p.to_light)) - p.to_light;
  return std::pow(std::max(reflected ^ p.to_view, 0.0), shininess);
}

double TextbookBlinnLobe(const TextbookPoint& p, double shininess, const TextbookFaults& faults) {
  const Vec3d half = TextbookNormalize(p.to_light + p.to_view, faults);
  return std::pow(std::max(p.normal ^ half, 0.0), shininess);
}

Rgb TextbookPhongShading(const TextbookPoint& p, const TextbookPhong& material,
                         const TextbookFaults& faults) {
  const double n_dot_l = std::max(p.normal ^ p.to_light, 0.0);
  double diffuse = material.kd * n_dot_l;
  double specular = material.ks * TextbookPhongLobe(p, material.shininess);
  if (!faults.ungated_specular && n_dot_l <= 0) specular = 0;
  if (!faults.phong_without_pi) {
    diffuse *= M_1_PI;
    specular *= (material.shininess + 2) * 0.5 * M_1_PI;
  }
  const Rgb ambient = faults.ambient_from_words ? p.light : Rgb(1, 1, 1);
  Rgb color = material.color * ambient * material.ka + p.light * material.color * diffuse +
              p.light * specular;
  if (faults.clip_in_shading) {
    for (int c = 0; c < 3; ++c) color[c] = std::clamp(color[c], 0.0, 1.0);
  }
  return color;
}

// ---- Cook-Torrance ------------------------------------------------------------------------------

TextbookAngles TextbookAnglesAt(const TextbookPoint& p, const TextbookFaults& faults) {
  const Vec3d half = TextbookNormalize(p.to_view + p.to_light, faults);
  const Vec3d cross = p.normal % half;
  return {.n_dot_l = std::max(p.normal ^ p.to_light, 0.0),
          .n_dot_v = std::max(p.normal ^ p.to_view, 0.0),
          .n_dot_h = std::max(p.normal ^ half, 0.0),
          .v_dot_h = std::max(p.to_view ^ half, faults.v_dot_h_floor ? 0.001 : 0.0),
          .sin2_h = cross.length2()};
}

double TextbookDistribution(const TextbookAngles& a, double roughness,
                            const TextbookFaults& faults) {
  const double alpha = roughness * roughness;
  const double a2 = alpha * alpha;
  if (faults.distribution_floor) {
    const double denominator = a.n_dot_h * a.n_dot_h * (a2 - 1) + 1;
    return a2 / std::max(M_PI * denominator * denominator, 1e-10);
  }
  // n.h^2 (a2 - 1) + 1 without cancellation. A perfect mirror's D is a delta function, for which a
  // point light shows nothing.
  const double denominator = a.n_dot_h * a.n_dot_h * a2 + a.sin2_h;
  return a2 > 0 ? a2 / (M_PI * denominator * denominator) : 0;
}

double TextbookFresnel(double cos_theta, double f0) {
  return f0 + (1 - f0) * std::pow(1 - cos_theta, 5);
}

namespace {

double SchlickG1(double n_dot_x, double k) { return n_dot_x / (n_dot_x * (1 - k) + k); }

// Height-correlated Smith (Heitz 2014, eq. 99).
double SmithG(double n_dot_v, double n_dot_l, double alpha) {
  const auto root = [alpha](double c) {
    return std::sqrt(alpha * alpha + (1 - alpha * alpha) * c * c);
  };
  return 2 * n_dot_l * n_dot_v / (n_dot_l * root(n_dot_v) + n_dot_v * root(n_dot_l));
}

}  // namespace

double TextbookGeometry(double n_dot_v, double n_dot_l, double roughness,
                        const TextbookFaults& faults) {
  if (!faults.schlick_geometry) {
    return n_dot_v > 0 && n_dot_l > 0 ? SmithG(n_dot_v, n_dot_l, roughness * roughness) : 0;
  }
  const double r = (faults.k_from_words ? roughness * roughness : roughness) + 1;
  const double k = r * r / 8;
  return SchlickG1(n_dot_v, k) * SchlickG1(n_dot_l, k);
}

double TextbookSpecular(const TextbookAngles& a, double roughness, double f0,
                        const TextbookFaults& faults) {
  const double numerator = TextbookDistribution(a, roughness, faults) *
                           TextbookFresnel(a.v_dot_h, f0) *
                           TextbookGeometry(a.n_dot_v, a.n_dot_l, roughness, faults);
  const double denominator = 4 * a.n_dot_v * a.n_dot_l;
  if (faults.denominator_epsilon) return numerator / (denominator + 0.0001);
  return denominator > 0 ? numerator / denominator : 0;
}

Rgb TextbookPbrRadiance(const TextbookPoint& p, const TextbookPbr& material,
                        const TextbookFaults& faults) {
  const TextbookAngles a = TextbookAnglesAt(p, faults);
  Rgb radiance;
  for (int c = 0; c < 3; ++c) {
    const double f0 = 0.04 * (1 - material.metallic) + material.albedo[c] * material.metallic;
    const double specular = TextbookSpecular(a, material.roughness, f0, faults);
    const double kd = (1 - TextbookFresnel(a.v_dot_h, f0)) * (1 - material.metallic);
    const double diffuse = kd * material.albedo[c] / M_PI;
    radiance[c] = (diffuse + specular) * p.light[c] * a.n_dot_l;
  }
  return radiance;
}

double TextbookEncode(double radiance, const TextbookFaults& faults) {
  const double mapped = std::clamp(radiance / (radiance + 1), 0.0, 1.0);
  if (faults.gamma22) return std::pow(mapped, 1 / 2.2);
  // IEC 61966-2-1.
  return mapped <= 0.0031308 ? 12.92 * mapped : 1.055 * std::pow(mapped, 1 / 2.4) - 0.055;
}

Rgb TextbookEncode(const Rgb& radiance, const TextbookFaults& faults) {
  return {TextbookEncode(radiance.x, faults), TextbookEncode(radiance.y, faults),
          TextbookEncode(radiance.z, faults)};
}

// ---- Beside the pictures ------------------------------------------------------------------------

double TextbookAttenuation(double distance) { return 1 / (distance * distance + 0.0001); }

double TextbookIntersectSphere(const Vec3d& origin, const Vec3d& direction, const Vec3d& center,
                               double radius, const TextbookFaults& faults) {
  const Vec3d oc = origin - center;
  const double a = direction.length2();
  const double b = 2 * (oc ^ direction);
  const double c = oc.length2() - radius * radius;
  const double discriminant = b * b - 4 * a * c;
  if (discriminant < 0) return -1;
  const double near = (-b - std::sqrt(discriminant)) / (2 * a);
  if (near >= 0 || faults.no_far_root) return near;
  return (-b + std::sqrt(discriminant)) / (2 * a);
}

}  // namespace nacre
