// SPDX-License-Identifier: Apache-2.0
// tests/light/ellipse_irradiance_test.cc: the irradiance under ellipses against its contour
// integral by quadrature, against that of disks and spheres, and on every target against its double
// twin.
#include "light/ellipse_irradiance.h"

#include <cmath>
#include <random>

#include "catch.h"
#include "light/area_shapes.h"
#include "light/ellipse_kernel.h"
#include "light/irradiance.h"
#include "targets.h"

namespace nacre {
namespace {

Vec3d RimOf(const EllipseLight& e, double t) {
  return e.centre + e.x * std::cos(t) + e.y * std::sin(t);
}

// Half of the integral of normal.(r x dr) / r^2 over the rim above the horizon, by Simpson's rule,
// and the angle along the horizon between its ends.
double ByQuadrature(const EllipseLight& e, const Vec3d& normal) {
  const double along_x = e.x ^ normal, along_y = e.y ^ normal, height = e.centre ^ normal;
  const double rim = std::hypot(along_x, along_y);
  if (height <= -rim) return 0;
  const double half = height < rim ? std::acos(-height / rim) : M_PI;
  const double highest = std::atan2(along_y, along_x);
  constexpr int kSteps = 20000;
  double sum = 0;
  for (int i = 0; i <= kSteps; ++i) {
    const double t = highest + half * (2.0 * i / kSteps - 1);
    const double weight = i == 0 || i == kSteps ? 1 : 2 + 2 * (i % 2);
    const Vec3d r = RimOf(e, t), way = e.y * std::cos(t) - e.x * std::sin(t);
    sum += weight * (normal ^ (r % way)) / r.length2() * 2 * half / (3 * kSteps);
  }
  if (height < rim) {
    const Vec3d from = RimOf(e, highest - half), to = RimOf(e, highest + half);
    sum += std::atan2(normal ^ (to % from), to ^ from);
  }
  return std::abs(sum) / 2;
}

// Wide, narrow, tiny and nearby ellipses on all sides of a surface; every other one across its
// horizon, and of those some next to its edge.
std::vector<EllipseQuery> Ellipses(size_t count) {
  std::mt19937 random(7);
  std::normal_distribution<double> gauss;
  std::uniform_real_distribution<double> side(-1, 1);
  const auto vector = [&] { return Vec3d(gauss(random), gauss(random), gauss(random)); };
  std::vector<EllipseQuery> queries;
  queries.reserve(count);
  for (size_t i = 0; i < count; ++i) {
    EllipseLight e{vector(), vector(), vector()};
    if (i % 5 == 1) e.y *= 1e-3;
    if (i % 5 == 2) e.centre *= 1e4;
    if (i % 5 == 3) e.centre *= 1e7;
    if (i % 5 == 4) e.centre = e.x * 0.3 + e.y * 0.2 + vector() * 0.01;
    Vec3d normal = vector().normalized();
    if (i % 2 == 1) {
      const Vec3d way = e.centre.normalized();
      normal = (normal - way * (normal ^ way)).normalized();
      normal += way * (RimHeight(e, normal) / e.centre.length() * side(random));
      normal.normalize();
    }
    queries.push_back({e, normal});
  }
  return queries;
}

TEST_CASE("the irradiance of ellipses is their contour integral") {
  size_t cut = 0, whole = 0;
  for (const EllipseQuery& q : Ellipses(400)) {
    const double got = Irradiance(q.light, q.normal), expected = ByQuadrature(q.light, q.normal);
    const double most = Irradiance(q.light, ConeOf(q.light).axis);
    CAPTURE(q.light.centre, q.light.x, q.light.y, q.normal, got, expected, most);
    // The rule has 1e-8 left where a wide ellipse passes the point by; and of its sum some 1e-16 of
    // pi, which is much of a speck.
    CHECK(std::abs(got - expected) <= 1e-8 * most + 1e-15);
    if (IsCut(q.light, q.normal)) {
      ++cut;
    } else if (got > 0) {
      ++whole;
    }
  }
  CHECK(cut > 150);
  CHECK(whole > 50);
}

TEST_CASE("circles have the irradiance of disks and spheres") {
  const auto check = [](const auto& light) {
    const Vec3d way = light.centre.normalized();
    const Basis<double> around = BasisAbout(way);
    for (const double height : {-2.0, -0.9, -0.5, 0.0, 0.3, 0.8, 0.99, 1.5, 4.0}) {
      const double sin = std::clamp(height * light.radius / light.centre.length(), -0.999, 0.999);
      const double turn = 5 * height, cos = std::sqrt((1 - sin) * (1 + sin));
      const Vec3d normal = around.ToWorld({cos * std::cos(turn), cos * std::sin(turn), sin});
      const double expected = Irradiance(light, normal);
      const double got = Irradiance(EllipseOf(light), normal);
      const double most = Irradiance(light, way);
      CAPTURE(light.centre, light.radius, height, got, expected);
      // Both cancel from the angular size to its cube where the horizon cuts specks.
      CHECK(std::abs(got - expected) <= 1e-9 * most + 1e-15);
    }
  };
  for (const SphereLight<double>& light : SphereLights()) {
    if (!IsInside(light)) check(light);
  }
  for (const DiskLight<double>& light : DiskLights()) check(light);
}

TEST_CASE("conjugate radii of one ellipse are the same light") {
  for (const EllipseQuery& q : Ellipses(100)) {
    const double c = std::cos(0.7), s = std::sin(0.7);
    const EllipseLight turned{q.light.centre * 3, (q.light.x * c + q.light.y * s) * 3,
                              (q.light.x * s - q.light.y * c) * 3};
    const double most = Irradiance(q.light, ConeOf(q.light).axis);
    CHECK(std::abs(Irradiance(turned, q.normal) - Irradiance(q.light, q.normal)) <=
          1e-8 * most + 1e-15);
  }
}

TEST_CASE("what lies below the horizon or in the ellipse's plane gets no light") {
  const Vec3d up(0, 0, 1);
  CHECK(Irradiance(EllipseLight{{0, 0, -1}, {1, 0, 0.5}, {0, 1, 0.5}}, up) == 0);
  CHECK(Irradiance(EllipseLight{{0.2, 0.1, 0}, {1, 0, 0}, {0, 1, 0}}, Vec3d(1, 0, 0)) == 0);
  CHECK(Irradiance(EllipseLight{{3, 0, 1}, {1, 0, 0}, {0, 0, 0}}, up) == 0);
  // All round: the half-space above.
  CHECK(Irradiance(EllipseLight{{0, 0, 1}, {1e7, 0, 0}, {0, 1e7, 0}}, up) == Approx(M_PI));
  CHECK(Irradiance(EllipseLight{{0, 0, 1}, {1e7, 0, 0}, {0, 1e7, 0}}, Vec3d(1, 0, 0)) ==
        Approx(M_PI / 2));
}

TEST_CASE("SIMD irradiance of ellipses agrees with its double twin on every target") {
  const std::vector<EllipseQuery> queries = Ellipses(2000);
  ForEachTarget([&](Target) {
    const std::vector<double> answers = AskEllipses(queries);
    for (size_t i = 0; i < queries.size(); ++i) {
      const double exact = Irradiance(queries[i].light, queries[i].normal);
      const double most = Irradiance(queries[i].light, ConeOf(queries[i].light).axis);
      CAPTURE(i, exact, answers[i], most);
      // The same algebra in another order: roundings, and what nearness makes of them.
      CHECK(std::abs(answers[i] - exact) <= 1e-11 * most);
    }
  });
}

}  // namespace
}  // namespace nacre
