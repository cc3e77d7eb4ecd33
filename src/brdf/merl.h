// SPDX-License-Identifier: Apache-2.0
// brdf/merl.h: looks up a table of the MERL database. SIMD twin: merl-inl.h.
//
// Rusinkiewicz 1998, "A New Change of Variables for Efficient BRDF Representation": the angles of
// the half vector h from the normal n, and of the light l from h once h is turned to n. With
// u = l + v, which is along h and perpendicular to l - v, these angles are
//   theta_half  of the vector (n.u, |n x u|),
//   theta_diff  of (|u|, |l - v|), because l = (u + (l - v)) / 2,
//   phi_diff    of (|u| (n.v - n.l), 2 n.(v x l)): the components of l along (n.h) h - n, in the
//               plane of n and h, and along n x h, both times |u| sin(theta_half) and times 2.
// None of them loses precision where the others vanish. Light and viewer exchanged change the signs
// of both components of phi_diff: reciprocal tables have the period pi.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "brdf/angles.h"
#include "brdf/measured_table.h"

namespace nacre {

struct RusinkiewiczAngles {
  double theta_half, theta_diff;
  double phi_diff;  // in [0, pi]
};

inline RusinkiewiczAngles ComputeRusinkiewicz(const Vec3d& n, const Vec3d& l, const Vec3d& v) {
  const Angles<double> a = ComputeAngles(n, l, v);
  const double u = std::sqrt(a.u_squared);
  const double phi = std::atan2(2 * (n ^ (v % l)), u * (a.n_dot_v - a.n_dot_l));
  return {std::atan2(std::sqrt(a.nxu_squared), a.n_dot_u), std::atan2(std::sqrt(a.lv_squared), u),
          phi < 0 ? phi + M_PI : phi};
}

// Coordinates in units of cells. Those of theta_half grow as its square root, so that cells are
// small around the normal, where highlights are.
struct MerlCoordinates {
  double half, diff, phi;
};

inline MerlCoordinates CoordinatesOf(const RusinkiewiczAngles& a) {
  return {MerlTable::kThetaHalf * std::sqrt(a.theta_half / M_PI_2),
          MerlTable::kThetaDiff * (a.theta_diff / M_PI_2),
          MerlTable::kPhiDiff * (a.phi_diff / M_PI)};
}

inline size_t MerlCell(size_t half, size_t diff, size_t phi) {
  return phi + MerlTable::kPhiDiff * (diff + MerlTable::kThetaDiff * half);
}

inline Rgb MerlValue(const MerlTable& table, size_t cell) {
  const float* const rgb = table.rgb.data() + 3 * cell;
  return {rgb[0], rgb[1], rgb[2]};
}

// The cell that contains the directions.
inline size_t MerlNearestCell(const MerlCoordinates& at) {
  const auto index = [](double x, size_t count) {
    return std::min(static_cast<size_t>(std::max(x, 0.0)), count - 1);
  };
  return MerlCell(index(at.half, MerlTable::kThetaHalf), index(at.diff, MerlTable::kThetaDiff),
                  index(at.phi, MerlTable::kPhiDiff));
}

// Between the centres of the eight cells around. Beyond the outermost centres the table goes on as
// it is there; the azimuth is periodic.
inline Rgb MerlLinear(const MerlTable& table, const MerlCoordinates& at) {
  const auto between = [](double x, size_t count) {
    const double centered = std::clamp(x - 0.5, 0.0, static_cast<double>(count - 1));
    const size_t i = std::min(static_cast<size_t>(centered), count - 2);
    return BetweenNodes{i, centered - static_cast<double>(i)};
  };
  const BetweenNodes half = between(at.half, MerlTable::kThetaHalf);
  const BetweenNodes diff = between(at.diff, MerlTable::kThetaDiff);
  constexpr size_t kPhis = MerlTable::kPhiDiff;
  const double turned = at.phi + kPhis - 0.5;  // above 0
  const double whole = std::floor(turned);
  const size_t phi = static_cast<size_t>(whole) % kPhis;
  Rgb sum(0, 0, 0);
  for (size_t i = 0; i < 2; ++i) {
    for (size_t j = 0; j < 2; ++j) {
      const double weight = (i == 0 ? 1 - half.fraction : half.fraction) *
                            (j == 0 ? 1 - diff.fraction : diff.fraction);
      const auto value = [&](size_t k) {
        return MerlValue(table, MerlCell(half.index + i, diff.index + j, (phi + k) % kPhis));
      };
      sum += (value(0) * (1 - (turned - whole)) + value(1) * (turned - whole)) * weight;
    }
  }
  return sum;
}

// f(l, v) in 1/sr, for directions above the surface.
inline Rgb EvaluateMerl(const MerlTable& table, MeasuredInterpolation interpolation, const Vec3d& n,
                        const Vec3d& l, const Vec3d& v) {
  const MerlCoordinates at = CoordinatesOf(ComputeRusinkiewicz(n, l, v));
  return interpolation == MeasuredInterpolation::kNearest ? MerlValue(table, MerlNearestCell(at))
                                                          : MerlLinear(table, at);
}

}  // namespace nacre
