// SPDX-License-Identifier: Apache-2.0
// brdf/albedo_integral.h: directional albedos of the GGX lobe by quadrature, in double: the
// reference to which the run-time fits (brdf/albedo.h) are fitted, and against which they are
// tested. No Monte Carlo.
//
// albedo(n.v) = int D V F n.l dl over the upper hemisphere, for any Fresnel curve F(v.h).
#pragma once

#include <cmath>
#include <vector>

#include "brdf/ggx.h"

namespace nacre {

// The resolution of the quadrature. Compared with a finer rule, for a dielectric of index 1.5,
// albedos of the default have errors of 2e-7, those of the fast rule 4e-6.
struct AlbedoQuadrature {
  int points = 12;     // Gauss-Legendre points in each panel of the light's elevation
  double step = 0.42;  // step of the azimuth's warped variable
  double tail = 1e-9;  // end of the azimuth's range that is left out
  // The cosine v.h at which the Fresnel curve has a corner, where rules converge slowly: panels of
  // the elevation end where the plane of incidence meets it. 0: there is none.
  double corner = 0;
};
inline constexpr AlbedoQuadrature kFastAlbedoQuadrature{7, 0.5, 1e-6};

// The nodes of the integral over the light's elevation, in panels that are fine where the integrand
// has fine detail. Each node is one elevation, given by the quantities that the azimuth's integrand
// depends on; angles are halved sums and differences of the light's and the viewer's elevation.
struct AlbedoNode {
  double weight;  // quadrature weight, including the cosines of solid angle and projection
  double n_dot_l;
  double sin_sum2, cos_sum2;                // sin_sum2 is (v.h)^2 opposite the viewer
  double sin_difference2, cos_difference2;  // cos_difference2 is (v.h)^2 on the viewer's side
  double p, q;  // sqrt(alpha^2 / (pi D)) opposite the viewer, and on the viewer's side
};

// The nodes of one n.v in [0, 1]. alpha must not be a delta lobe's. `points` and `corner` as in
// AlbedoQuadrature.
std::vector<AlbedoNode> MakeAlbedoNodes(double alpha, double n_dot_v, int points,
                                        double corner = 0);

// The visibility term of a shadowing form.
double Visibility(Shadowing shadowing, double n_dot_l, double n_dot_v, double roughness);

// The albedo for F = 1. The azimuth integral of D has a closed form, which leaves one sum.
double AlbedoOfOne(Shadowing shadowing, double roughness, double n_dot_v,
                   int points = AlbedoQuadrature().points);

// int_0^2pi D F dphi at one node.
//
// In t = tan(phi/2), phi measured from the plane opposite the viewer, D is (1/pi alpha^2 ...) times
// ((1 + (p/q) T^2) / (1 + T^2))^2 with T = t / t1: the integrand varies between t1 and 1 only,
// which may be decades apart. T = sinh(y) makes every decade equally smooth, and the trapezoidal
// rule, whose error falls as exp(-pi^2 / step), then needs a few dozen points for any alpha.
template <class Fresnel>
double AzimuthIntegral(const AlbedoNode& node, double alpha, const AlbedoQuadrature& rule,
                       const Fresnel& fresnel) {
  const double p_over_q = node.p / node.q;
  const double t1 = std::sqrt(node.sin_sum2 / node.cos_difference2 * p_over_q);
  const double growth = std::exp(rule.step);
  const double end = 1 / (rule.tail * t1);  // end of T: the rest of phi falls as 1 / t
  double sum = 0;
  double e = 1;  // exp(y)
  while (e < 2 * end) {
    const double sinh = (e - 1 / e) / 2;
    const double cosh = (e + 1 / e) / 2;
    const double t = t1 * sinh;
    const double scale = 1 / (1 + t * t);
    const double vh2 = (node.sin_sum2 + node.cos_difference2 * t * t) * scale;
    const double vh = std::sqrt(vh2);
    const double one_minus_vh = (node.cos_sum2 + node.sin_difference2 * t * t) * scale / (1 + vh);
    const double shape = (1 + p_over_q * sinh * sinh) / (cosh * cosh);
    const double term = shape * shape * cosh * scale * fresnel(vh, one_minus_vh);
    sum += e == 1 ? term / 2 : term;  // y = 0 is the middle of an even integrand
    e *= growth;
  }
  const double peak = alpha / node.p;
  return 4 / M_PI * peak * peak * t1 * rule.step * sum;
}

// The albedo for F(v.h), called as fresnel(v.h, 1 - v.h).
template <class Fresnel>
double AlbedoOf(Shadowing shadowing, double roughness, double n_dot_v, const Fresnel& fresnel,
                const AlbedoQuadrature& rule = {}) {
  const double alpha = AlphaFromRoughness(roughness);
  if (IsDeltaLobe(alpha)) {  // a mirror: v.h = n.v
    return AlbedoOfOne(shadowing, roughness, n_dot_v) * fresnel(n_dot_v, 1 - n_dot_v);
  }
  double sum = 0;
  for (const AlbedoNode& node : MakeAlbedoNodes(alpha, n_dot_v, rule.points, rule.corner)) {
    sum += node.weight * Visibility(shadowing, node.n_dot_l, n_dot_v, roughness) *
           AzimuthIntegral(node, alpha, rule, fresnel);
  }
  return sum;
}

// B, the albedo of Schlick's weight: int D V (1 - v.h)^5 n.l dl.
double AlbedoOfSchlick(Shadowing shadowing, double roughness, double n_dot_v);

}  // namespace nacre
