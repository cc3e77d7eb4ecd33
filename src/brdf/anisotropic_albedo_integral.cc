// SPDX-License-Identifier: Apache-2.0
// brdf/anisotropic_albedo_integral.cc: the integral is taken over the normals that the view sees of
// a surface that is squeezed by both alphas, where they are those of a hemisphere, in proportion to
// their cosine to the squeezed view q. What is left of the integrand is G2 / G1(v) F, which is
// between 0 and 1 and has no peak, however narrow the lobe is.
//
// (X, Y, 1) is a normal of that surface and (ax X, ay Y, 1) the half vector. Its light comes from
// above the surface where (ax X - v.x / v.z)^2 + (ay Y - v.y / v.z)^2 < 1 / v.z^2: in an ellipse,
// to whose inside the quadrature is confined, so that it meets no kink at the horizon. Rows are
// lines of constant Y.
#include "brdf/anisotropic_albedo_integral.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "brdf/quadrature.h"

namespace nacre {
namespace {

constexpr double kPanelGrowth = 4;      // size of a panel over that of the one before
constexpr double kLeastCosine = 1e-12;  // of the view: the ellipse is bounded

struct Setup {
  GgxAlphas<double> alpha;
  Vec3d view;
  double view_root;
  Vec3d q;
  const FresnelFunction* fresnel;  // null without a function
};

// The axes are named so that rows cross the horizon rather than run along it: the horizon's normal
// has components of about alpha times the view's cosines. By symmetry the view's components count
// as positive.
Setup MakeSetup(GgxAlphas<double> alpha, const Vec3d& view, const FresnelFunction* fresnel) {
  Vec3d v(std::abs(view.x), std::abs(view.y), std::max(view.z, kLeastCosine));
  if (alpha.x * std::hypot(v.x, v.z) < alpha.y * std::hypot(v.y, v.z)) {
    std::swap(alpha.x, alpha.y);
    std::swap(v.x, v.y);
  }
  const double root = SmithRoot(v.z, v.x, v.y, alpha);
  return {alpha, v, root, Vec3d(alpha.x * v.x, alpha.y * v.y, v.z) / root, fresnel};
}

struct Light {
  double v_dot_h, one_minus_vh;
  std::array<double, 2> kept, lost;  // G2 / G1(v), and what it is short of 1
};
Light LightOf(const Setup& setup, const Vec3d& h) {
  const Vec3d half = h.normalized();
  const double v_dot_h = setup.view ^ half;
  const Vec3d l = half * (2 * v_dot_h) - setup.view;
  const double n_dot_l = std::max(l.z, 0.0), n_dot_v = setup.view.z;
  const double x = setup.alpha.x * l.x, y = setup.alpha.y * l.y;
  const double spread = x * x + y * y;
  const double root = std::sqrt(n_dot_l * n_dot_l + spread);
  const double sum_l = n_dot_l + root;
  const double both = n_dot_l * setup.view_root + n_dot_v * root;
  // What G2 / G1(v) is short of 1: root - n.l is spread / sum_l.
  return {v_dot_h,
          (setup.view % half).length2() / (1 + v_dot_h),
          {n_dot_l * (n_dot_v + setup.view_root) / both, 2 * n_dot_l / sum_l},
          {n_dot_v * spread / (sum_l * both), spread / (sum_l * sum_l)}};
}

void AddLight(const Setup& setup, const Vec3d& h, double weight,
              std::array<AnisotropicAlbedo, 2>* sum) {
  const Light light = LightOf(setup, h);
  const double fresnel =
      setup.fresnel != nullptr ? (*setup.fresnel)(light.v_dot_h, light.one_minus_vh) : 0;
  for (size_t form = 0; form < 2; ++form) {
    (*sum)[form].loss += weight * light.lost[form];
    (*sum)[form].fresnel += weight * light.kept[form] * fresnel;
    double term = weight * light.kept[form];
    for (double& power : (*sum)[form].powers) power += term *= light.one_minus_vh;
  }
}

// The solutions of a x^2 - 2 b x - c = 0, in order, for a > 0.
struct Roots {
  double low, high;
};
Roots Solve(double a, double b, double c) {
  // Without cancellation: the product of the roots is -c / a.
  const double far = b + std::copysign(std::sqrt(std::max(b * b + a * c, 0.0)), b);
  const double first = far / a, second = far != 0 ? -c / far : 0;
  return {std::min(first, second), std::max(first, second)};
}

// Calls add(x, weight) for the points of Gauss-Legendre panels from `start` to `end` that grow from
// `first` on.
template <class Add>
void ForPanels(double start, double end, double first, const QuadratureRule& rule, const Add& add) {
  const double sign = end > start ? 1 : -1;
  const double whole = std::abs(end - start);
  double size = first;
  for (double at = 0; at < whole;) {
    const double length = at + 1.5 * size < whole ? size : whole - at;  // no sliver at the end
    for (size_t k = 0; k < rule.x.size(); ++k) {
      add(start + sign * (at + length * rule.x[k]), rule.w[k] * length);
    }
    at += length;
    size *= kPanelGrowth;
  }
}

const QuadratureRule& UnlitRule() { return GaussLegendre(10); }

// Integrals of a row's density, cos(xi) (sin(xi) q.x + cos(xi) across), over its ends. By the angle
// a from xi = -pi/2 the density is radius sin(a) sin(a - visible), and is seen from `visible` on.
struct Density {
  double along, across;  // along: q.x
  double radius, visible;

  // Over angles from `visible` to `end`.
  double Below(double end) const {
    const QuadratureRule& rule = UnlitRule();
    double sum = 0;
    for (size_t k = 0; k < rule.x.size(); ++k) {
      const double more = (end - visible) * rule.x[k];
      sum += rule.w[k] * std::sin(visible + more) * std::sin(more);
    }
    return radius * (end - visible) * sum;
  }
  // Over angles up to `end` from xi = pi/2.
  double Above(double end) const {
    const QuadratureRule& rule = UnlitRule();
    double sum = 0;
    for (size_t k = 0; k < rule.x.size(); ++k) {
      const double sin = std::sin(end * rule.x[k]), cos = std::cos(end * rule.x[k]);
      sum += rule.w[k] * sin * (cos * along + sin * across);
    }
    return end * sum;
  }
  double Whole() const {
    return radius / 2 * (std::cos(visible) * (M_PI - visible) + std::sin(visible));
  }
};
Density MakeDensity(double along, double across) {
  const Vec2d both(along, across);
  return {along, across, both.length(), std::atan2(both.x, both.y)};
}

// Adds the row of Y = tan(eta): what its light loses and keeps, and what is below the horizon.
void AddRow(const Setup& setup, double eta, double row_weight, const AnisotropicQuadrature& rule,
            std::array<AnisotropicAlbedo, 2>* sum, double* unlit) {
  const Vec3d &v = setup.view, &q = setup.q;
  const double a_x = setup.alpha.x, a_y = setup.alpha.y;
  const double y = std::tan(eta), secant = std::sqrt(1 + y * y);
  const double half_y = a_y * y;
  const Roots x = Solve(v.z * a_x * a_x, a_x * v.x, v.z + (2 * v.y - v.z * half_y) * half_y);
  // With X = secant tan(xi) the density is cos(xi) (sin(xi) q.x + cos(xi) across).
  const double across = std::sin(eta) * q.y + std::cos(eta) * q.z;
  const auto add = [&](double xi, double length) {
    const double sin = std::sin(xi), cos = std::cos(xi);
    const double weight = row_weight * length * cos * (sin * q.x + cos * across);
    AddLight(setup, {a_x * (secant * sin / cos), half_y, 1}, weight, sum);
  };
  const Density density = MakeDensity(q.x, across);
  *unlit += row_weight *
            (density.Below(std::atan2(secant, -x.low)) + density.Above(std::atan2(secant, x.high)));
  // Panels grow from both horizons, above which shadowing bends, and from X = 0, where light that
  // grazes the surface far along the row crosses the plane of the normal.
  const QuadratureRule& gauss = GaussLegendre(rule.points);
  const double low = std::atan(x.low / secant), high = std::atan(x.high / secant);
  // Where n.l is about n.v, height-correlated shadowing changes fastest.
  const double finest = std::min(rule.finest * (high - low) / 2, std::max(q.z / 2, 1e-9));
  if (low < 0 && high > 0) {
    const double bend = std::min(a_y / a_x, 1.0) / 2;
    ForPanels(low, low / 2, finest, gauss, add);
    // Fine where a horizon is near, on the other side of 0.
    ForPanels(0, low / 2, std::min(bend, std::max(high, finest)), gauss, add);
    ForPanels(0, high / 2, std::min(bend, std::max(-low, finest)), gauss, add);
    ForPanels(high, high / 2, finest, gauss, add);
  } else {
    ForPanels(low, (low + high) / 2, finest, gauss, add);
    ForPanels(high, (low + high) / 2, finest, gauss, add);
  }
}

// The integral over the rows beyond the ellipse, by their angle from the horizontal. On the far
// side from the view they are hardly seen up to the angle at which the plane of seen normals meets
// them.
double UnlitBeyond(const Vec3d& q, const Roots& ends) {
  const QuadratureRule& rule = UnlitRule();
  double sum = 0;
  const auto add_rows = [&](double side, double begin, double end) {
    for (size_t k = 0; k < rule.x.size(); ++k) {
      const double angle = begin + (end - begin) * rule.x[k];
      const double across = side * std::cos(angle) * q.y + std::sin(angle) * q.z;
      sum += (end - begin) * rule.w[k] * MakeDensity(q.x, across).Whole();
    }
  };
  const double near_end = std::atan2(1.0, ends.high), far_end = std::atan2(1.0, -ends.low);
  const double seen = std::min(std::atan2(q.y, q.z), far_end);
  add_rows(1, 0, near_end);
  add_rows(-1, 0, seen);
  add_rows(-1, seen, far_end);
  return sum;
}

}  // namespace

std::array<AnisotropicAlbedo, 2> IntegrateAlbedos(const GgxAlphas<double>& alpha, const Vec3d& view,
                                                  const AnisotropicQuadrature& rule,
                                                  const FresnelFunction& fresnel) {
  const Setup setup = MakeSetup(alpha, view, fresnel ? &fresnel : nullptr);
  const Vec3d& v = setup.view;
  // The density of normals, (X q.x + Y q.y + q.z) / (1 + X^2 + Y^2)^2, integrates to this.
  const double norm = M_PI_2 * (1 + setup.q.z);
  const double width = v.z * setup.alpha.y;
  const Roots ends = Solve(width * width, width * v.y, v.x * v.x + v.z * v.z);
  const double begin = std::atan(ends.low), end = std::atan(ends.high);
  const QuadratureRule& rows = GaussLegendre(rule.rows);
  const double span = M_PI / rule.panels;
  std::array<AnisotropicAlbedo, 2> sum;
  double unlit = 0;  // summed for itself: of smooth surfaces it is far below rounding errors of 1
  for (int panel = 0; panel < rule.panels; ++panel) {
    for (size_t j = 0; j < rows.x.size(); ++j) {
      // Rows are denser towards the ends, where their lengths fall as roots, twice over, because of
      // grazing views the ends are narrow.
      const double turn = span * (panel + rows.x[j]) - M_PI_2;
      const double inner = M_PI_2 * std::sin(turn);
      const double eta = (begin + end) / 2 + (end - begin) / 2 * std::sin(inner);
      const double slope = (end - begin) / 2 * std::cos(inner) * M_PI_2 * std::cos(turn);
      AddRow(setup, eta, rows.w[j] * span * slope / norm, rule, &sum, &unlit);
    }
  }
  unlit += UnlitBeyond(setup.q, ends) / norm;
  for (AnisotropicAlbedo& albedo : sum) albedo.loss += unlit;
  return sum;
}

// The density of normals, integrated over Y, is (X q.x + q.z) / (1 + X^2)^(3/2), in xi = atan(X)
// the cosine to q.
std::vector<StreakPoint> StreakQuadrature(double alpha_x, double kappa) {
  const double n = 1 / std::hypot(1.0, kappa / alpha_x);
  const Setup setup = MakeSetup({alpha_x, 0}, {kappa / alpha_x * n, 0, n}, nullptr);
  const Vec3d &v = setup.view, &q = setup.q;
  std::vector<StreakPoint> points;
  const auto add = [&](double xi, double length) {
    const double sin = std::sin(xi), cos = std::cos(xi);
    const Light light = LightOf(setup, {alpha_x * sin, 0, cos});
    const double weight = length * (sin * q.x + cos * q.z) / (1 + q.z);
    points.push_back(
        {light.v_dot_h, light.one_minus_vh, {weight * light.kept[0], weight * light.kept[1]}});
  };
  const QuadratureRule& gauss = GaussLegendre(8);
  const Roots x = Solve(v.z * alpha_x * alpha_x, alpha_x * v.x, v.z);
  const double low = std::atan(x.low), high = std::atan(x.high);
  const double finest = std::min(1e-3 * (high - low) / 2, std::max(q.z / 2, 1e-9));
  // As the middle row of IntegrateAlbedos: panels grow from both horizons and from X = 0, which is
  // between them.
  ForPanels(low, low / 2, finest, gauss, add);
  ForPanels(0, low / 2, finest, gauss, add);
  ForPanels(0, high / 2, finest, gauss, add);
  ForPanels(high, high / 2, finest, gauss, add);
  return points;
}

}  // namespace nacre
