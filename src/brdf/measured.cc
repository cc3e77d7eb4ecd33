// SPDX-License-Identifier: Apache-2.0
#include "brdf/measured.h"

#include <cstdint>
#include <utility>

namespace nacre {
namespace {

constexpr double kLuminance[] = {0.2126, 0.7152, 0.0722};

Basis<double> Upright() { return {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}; }

Vec3d Direction(double theta, double phi) {
  return {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
}

// f n.l of the light that the viewer's direction gives at a half vector of the square, times the
// ratio of its solid angle and the area of the square.
Rgb ReflectedInSquare(const MeasuredBrdf& brdf, const Vec3d& v, double viewer_phi,
                      const SquarePoint& p) {
  const double theta = p.x * p.x * M_PI_2, phi = (2 * p.y - 1) * M_PI + viewer_phi;
  const Vec3d h = Direction(theta, phi);
  const double v_dot_h = v ^ h;
  const Vec3d l = Mirrored(v, h);
  if (!(v_dot_h > 0) || !(l.z > 0)) return Rgb(0, 0, 0);
  const double by_area = 2 * M_PI * M_PI * p.x * std::sin(theta) * 4 * v_dot_h;
  return EvaluateMeasured(brdf, MeasuredInterpolation::kLinear, Upright(), l, v) * by_area;
}

// Tabulates what the viewer sees by half vector. Nodes along theta_half are as dense as the table's
// cells; along the azimuth, and between viewers, what a highlight reflects changes little but for
// the horizon.
TabulatedWarp TabulateHalf(const MeasuredBrdf& brdf) {
  constexpr size_t kViewers = 17, kWidth = 2 * MerlTable::kThetaHalf + 1, kHeight = 25;
  SliceAngles angles{{0}, {}};
  std::vector<float> values;
  for (size_t t = 0; t < kViewers; ++t) {
    // A viewer at the horizon would see nothing.
    const double theta = std::min(static_cast<double>(t) / (kViewers - 1), 0.995) * M_PI_2;
    angles.theta.push_back(static_cast<float>(theta));
    const Vec3d v = Direction(theta, 0);
    for (size_t j = 0; j < kHeight; ++j) {
      for (size_t i = 0; i < kWidth; ++i) {
        const SquarePoint p{static_cast<double>(i) / (kWidth - 1),
                            static_cast<double>(j) / (kHeight - 1)};
        const Rgb reflected = ReflectedInSquare(brdf, v, 0, p);
        values.push_back(static_cast<float>(kLuminance[0] * reflected.x +
                                            kLuminance[1] * reflected.y +
                                            kLuminance[2] * reflected.z));
      }
    }
  }
  return MakeTabulatedWarp(std::move(angles), kWidth, kHeight, std::move(values));
}

// The mean over the square of what the viewer sees. Of an anisotropic BRDF, the mean over azimuths.
Rgb IntegrateAlbedo(const MeasuredBrdf& brdf, double theta) {
  constexpr size_t kColumns = 96, kRows = 24;
  const size_t azimuths = brdf.isotropic ? 1 : 4;
  Rgb sum(0, 0, 0);
  for (size_t a = 0; a < azimuths; ++a) {
    const double phi = (static_cast<double>(a) + 0.25) * M_PI_2;
    for (size_t j = 0; j < kRows; ++j) {
      for (size_t i = 0; i < kColumns; ++i) {
        const SquarePoint p{(static_cast<double>(i) + 0.5) / kColumns,
                            (static_cast<double>(j) + 0.5) / kRows};
        sum += ReflectedInSquare(brdf, Direction(theta, phi), phi, p);
      }
    }
  }
  return sum / static_cast<double>(azimuths * kRows * kColumns);
}

}  // namespace

void FinishMeasured(MeasuredBrdf* brdf) {
  if (std::holds_alternative<MerlTable>(brdf->table)) brdf->half = TabulateHalf(*brdf);
  brdf->mean_albedo = Rgb(0, 0, 0);
  double total = 0;
  for (size_t k = 0; k < kAlbedoAngles; ++k) {
    const double theta = std::min(static_cast<double>(k) / (kAlbedoAngles - 1), 0.999) * M_PI_2;
    brdf->albedo[k] = IntegrateAlbedo(*brdf, theta);
    const double weight = std::sin(theta) * std::cos(theta);
    brdf->mean_albedo += brdf->albedo[k] * weight;
    total += weight;
  }
  brdf->mean_albedo /= total;
}

}  // namespace nacre
