// SPDX-License-Identifier: Apache-2.0
// brdf/microsurface_walk.h: light at a rough GGX interface, followed from microfacet to microfacet
// until it leaves: Heitz et al. 2016, "Multiple-Scattering Microfacet BSDFs with the Smith Model".
// No light is lost, so that models of a single reflection, and what compensates for the others, can
// be measured by it. In double, without SIMD twin.
//
// Directions are unit vectors along the light's travel; the normal of the interface is +z. `Random`
// is called without arguments and returns numbers in [0, 1).
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/vec.h"
#include "brdf/fresnel.h"
#include "brdf/ggx.h"

namespace nacre {

// Smith's Lambda of a direction with this z, which may be below 0 (ibid., section 3.2).
inline double SmithLambda(double z, double alpha) {
  const double slope2 = (1 - z) * (1 + z) / (z * z);
  return (std::copysign(std::sqrt(1 + alpha * alpha * slope2), z) - 1) / 2;
}

// Where light that travels among the microfacets meets the next one (ibid., eq. 20, 22). Heights
// are given as the fraction of microfacets that lie below. Infinite if the light leaves upwards.
inline double NextMicrofacet(double z, double height, double alpha, double u) {
  const double lambda = SmithLambda(z, alpha);
  if (z > 0 && u >= 1 - std::pow(height, lambda)) return std::numeric_limits<double>::infinity();
  return height * std::pow(1 - u, -1 / lambda);
}

// Samples the normals of the microfacets that are visible from `to_view` (Dupuy and Benyoub 2023).
// Unlike in SampleGgxHalf, the viewer may be among them and look up from below the horizon.
inline Vec3d SampleMicrofacet(const Vec3d& to_view, double alpha, double u0, double u1) {
  const Vec3d squeezed = Vec3d(alpha * to_view.x, alpha * to_view.y, to_view.z).normalized();
  const double half_z = (1 - u1) * (1 + squeezed.z);
  const double z = half_z - squeezed.z;
  const double sin = std::sqrt(std::max((1 - z) * (1 + z), 0.0)), phi = 2 * M_PI * u0;
  return Vec3d(alpha * (sin * std::cos(phi) + squeezed.x),
               alpha * (sin * std::sin(phi) + squeezed.y), half_z)
      .normalized();
}

// The light's direction after it was refracted by a microfacet, of which `cosine` is
// normal . to_view, both on the side from which it came.
inline Vec3d RefractedAt(const Vec3d& normal, const Vec3d& to_view, double cosine, double eta) {
  const double cosine_beyond =
      std::sqrt(std::max(1 - (1 - cosine) * (1 + cosine) / (eta * eta), 0.0));
  return (normal * (cosine / eta - cosine_beyond) - to_view / eta).normalized();
}

struct MicrosurfaceExit {
  Vec3d direction;
  bool above;  // the side of the interface on which the light leaves
};

// Follows light that meets a dielectric interface from above or from below. `eta` is the index
// below over the index above.
template <class Random>
MicrosurfaceExit WalkDielectric(Vec3d direction, bool above, double eta, double alpha,
                                Random& random) {
  // Seen from below, an interface is the same one upside down.
  const auto upright = [&](const Vec3d& v) { return above ? v : -v; };
  // Reflects or refracts the light at a microfacet.
  const auto meet = [&](const Vec3d& to_view, const Vec3d& normal) {
    const double cosine = std::min(normal ^ to_view, 1.0);
    const double index = above ? eta : 1 / eta;
    const bool is_reflected = random() < FresnelDielectric(cosine, 1 - cosine, index);
    direction = upright(is_reflected ? Mirrored(to_view, normal)
                                     : RefractedAt(normal, to_view, cosine, index));
    if (!is_reflected) above = !above;
    return is_reflected;
  };
  if (IsDeltaLobe(alpha)) {
    meet(upright(-direction), Vec3d(0, 0, 1));
    return {direction, above};
  }
  double height = 1;
  for (;;) {
    const Vec3d to_view = upright(-direction);
    height = NextMicrofacet(-to_view.z, height, alpha, random());
    if (height > 1) return {direction, above};
    const double u0 = random(), u1 = random();
    if (!meet(to_view, SampleMicrofacet(to_view, alpha, u0, u1))) height = 1 - height;
  }
}

// Follows light that meets an opaque interface from above. Each microfacet multiplies `weight` by
// reflectance(cosine). Returns the direction in which it leaves.
template <class Random, class Reflectance, class Weight>
Vec3d WalkOpaque(Vec3d direction, double alpha, const Reflectance& reflectance, Random& random,
                 Weight* weight) {
  const auto meet = [&](const Vec3d& to_view, const Vec3d& normal) {
    *weight *= reflectance(std::min(normal ^ to_view, 1.0));
    direction = Mirrored(to_view, normal);
  };
  if (IsDeltaLobe(alpha)) {
    meet(-direction, Vec3d(0, 0, 1));
    return direction;
  }
  double height = 1;
  for (;;) {
    const Vec3d to_view = -direction;
    height = NextMicrofacet(direction.z, height, alpha, random());
    if (height > 1) return direction;
    const double u0 = random(), u1 = random();
    meet(to_view, SampleMicrofacet(to_view, alpha, u0, u1));
  }
}

}  // namespace nacre
