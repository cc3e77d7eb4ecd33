// SPDX-License-Identifier: Apache-2.0
#include "textbook/albedo.h"

#include <algorithm>
#include <cmath>

#include "textbook/shading.h"

namespace nacre {
namespace {

// Integrates f over [0, 1] by the midpoint rule with `count` points.
template <class Function>
double Midpoint(int count, const Function& f) {
  double sum = 0;
  for (int i = 0; i < count; ++i) sum += f((i + 0.5) / count);
  return sum / count;
}

Vec3d Direction(double cos_theta, double phi) {
  const double sin_theta = std::sqrt(std::max(1 - cos_theta * cos_theta, 0.0));
  return {sin_theta * std::cos(phi), sin_theta * std::sin(phi), cos_theta};
}

const Vec3d kUp(0, 0, 1);

constexpr int kRadialPoints = 400;
constexpr int kAzimuthPoints = 200;

}  // namespace

double LobeAlbedo(double n_dot_v, double roughness, const TextbookBrdf& f) {
  const double a2 = std::pow(roughness, 4);
  const Vec3d to_view = Direction(n_dot_v, 0);
  return Midpoint(kRadialPoints, [&](double t) {
    // Half vectors have the pdf D n.h (Walter et al. 2007, eq. 35). Points u are denser at both
    // ends, where the integrand varies fastest.
    const double u = t * t * (3 - 2 * t);
    const double du = 6 * t * (1 - t);
    const double cos2 = (1 - u) / (1 + (a2 - 1) * u);
    // 1 - cos2 without cancellation; D = a2 / (pi (a2 cos2 + sin2)^2).
    const double sin2 = a2 * u / (1 + (a2 - 1) * u);
    const double peak = a2 * cos2 + sin2;
    const double pdf = a2 * std::sqrt(cos2) / (M_PI * peak * peak);
    return du * Midpoint(kAzimuthPoints, [&](double turn) {
             const double phi = M_PI * turn;  // the other half is its mirror image
             const double sin_theta = std::sqrt(sin2);
             const Vec3d half(sin_theta * std::cos(phi), sin_theta * std::sin(phi),
                              std::sqrt(cos2));
             const double v_dot_h = to_view ^ half;
             const Vec3d to_light = half * (2 * v_dot_h) - to_view;
             if (v_dot_h <= 0 || to_light.z <= 0) return 0.0;
             return f(to_light, to_view) * to_light.z * 4 * v_dot_h / pdf;
           });
  });
}

double SmoothAlbedo(double n_dot_v, const TextbookBrdf& f) {
  const Vec3d to_view = Direction(n_dot_v, 0);
  return Midpoint(kRadialPoints, [&](double s) {
    return Midpoint(kAzimuthPoints, [&](double turn) {
      return M_PI * f(Direction(std::sqrt(s), M_PI * turn), to_view);  // pdf n.l / pi
    });
  });
}

double AverageAlbedo(const std::function<double(double)>& albedo) {
  constexpr int kPoints = 64;
  return Midpoint(kPoints, [&](double mu) { return 2 * mu * albedo(mu); });
}

double TextbookSpecularAlbedo(double n_dot_v, double roughness, double f0,
                              const TextbookFaults& faults) {
  return LobeAlbedo(n_dot_v, roughness, [&](const Vec3d& to_light, const Vec3d& to_view) {
    return TextbookSpecular(TextbookAnglesAt({kUp, to_light, to_view}, faults), roughness, f0,
                            faults);
  });
}

double TextbookDiffuseAlbedo(double n_dot_v, double f0, const TextbookFaults& faults) {
  return SmoothAlbedo(n_dot_v, [&](const Vec3d& to_light, const Vec3d& to_view) {
    const TextbookAngles a = TextbookAnglesAt({kUp, to_light, to_view}, faults);
    return (1 - TextbookFresnel(a.v_dot_h, f0)) / M_PI;
  });
}

}  // namespace nacre
