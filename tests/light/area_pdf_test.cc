// SPDX-License-Identifier: Apache-2.0
// tests/light/area_pdf_test.cc: pdfs of samples of area lights integrate to one over them.
#include <cmath>

#include "catch.h"
#include "light/area_shapes.h"

namespace nacre {
namespace {

// The integral of the pdf over a light of this area, by the midpoint rule in points given by
// two numbers from 0 to 1; `area` may vary with them.
template <class Light, class PointAt>
double IntegratePdf(const Light& light, const PointAt& point_at) {
  constexpr int kSteps = 1000;
  double sum = 0;
  for (int i = 0; i < kSteps; ++i) {
    for (int j = 0; j < kSteps; ++j) {
      double area = 0;
      Vec3d normal;
      const Vec3d point = point_at((i + 0.5) / kSteps, (j + 0.5) / kSteps, &normal, &area);
      const Vec3d direction = point.normalized();
      const double cos = std::abs(direction ^ normal);
      sum += LightPdf(light, direction) * cos * area / point.length2();
    }
  }
  return sum / (1.0 * kSteps * kSteps);
}

// What midpoint rules can integrate: not the lights that all but touch the point.
bool IsSmooth(double nearest, double size) { return nearest > 0.05 * size; }

TEST_CASE("pdfs integrate to 1 over their lights") {
  for (const RectangleLight<double>& light : RectangleLights()) {
    const RectangleView<double> view = ViewOf(light);
    if (!IsSmooth(std::abs(view.z), std::min(view.width, view.height))) continue;
    CAPTURE(light.corner, light.edge_x, light.edge_y);
    const double sum = IntegratePdf(light, [&](double s, double t, Vec3d* normal, double* area) {
      *normal = view.normal;
      *area = view.width * view.height;
      return light.corner + light.edge_x * s + light.edge_y * t;
    });
    CHECK(std::abs(sum - 1) <= 1e-4);
  }
  for (const TriangleLight<double>& light : TriangleLights()) {
    const Vec3d cross = light.edge_x % light.edge_y;
    const double z = std::abs(light.corner ^ cross.normalized());
    if (!IsSmooth(z, std::min(light.edge_x.length(), light.edge_y.length()))) continue;
    CAPTURE(light.corner, light.edge_x, light.edge_y);
    const double sum = IntegratePdf(light, [&](double s, double t, Vec3d* normal, double* area) {
      *normal = cross.normalized();
      *area = cross.length() * s;
      return light.corner + light.edge_x * (s * (1 - t)) + light.edge_y * (s * t);
    });
    CHECK(std::abs(sum - 1) <= 1e-4);
  }
  for (const DiskLight<double>& light : DiskLights()) {
    const DiskView<double> view = ViewOf(light);
    if (!IsSmooth(std::abs(view.z), light.radius)) continue;
    CAPTURE(light.centre, light.normal, light.radius);
    const double sum = IntegratePdf(light, [&](double s, double t, Vec3d* normal, double* area) {
      const double r = light.radius * s;
      *normal = light.normal;
      *area = 2 * M_PI * light.radius * r;
      return light.centre + view.x_axis * (r * std::cos(2 * M_PI * t)) +
             view.y_axis * (r * std::sin(2 * M_PI * t));
    });
    // A nearby disk's pdf counts the samples that miss it too.
    double hits = 1;
    if (IsNearby(view, light.radius)) {
      hits = 0;
      constexpr int kSteps = 1000;
      for (int i = 0; i < kSteps * kSteps; ++i) {
        const double u0 = (i / kSteps + 0.5) / kSteps, u1 = (i % kSteps + 0.5) / kSteps;
        hits += (SampleLight(light, u0, u1).inverse_pdf > 0) / (1.0 * kSteps * kSteps);
      }
      CHECK(hits > 0.5);
    }
    CHECK(std::abs(sum - hits) <= 1e-4);
  }
}

TEST_CASE("a sphere's cone integrates to 1 and knows what misses it") {
  for (const SphereLight<double>& light : SphereLights()) {
    CAPTURE(light.centre, light.radius);
    const Basis<double> basis = BasisAbout(light.centre.normalized());
    const SphereCone<double> cone = ConeOf(light);
    const double range = IsInside(light) ? 2 : std::min(2 * cone.one_minus_cos, 2.0);
    // Rings of a cone of twice the size; its pdf is 0 or the same all round.
    constexpr int kRings = 100000;
    double sum = 0;
    for (int i = 0; i < kRings; ++i) {
      const double x = range * (i + 0.5) / kRings;
      const double sin = std::sqrt(x * (2 - x));
      const Vec3d direction =
          basis.ToWorld({sin * std::cos(1.0 * i), sin * std::sin(1.0 * i), 1 - x});
      sum += LightPdf(light, direction) * 2 * M_PI * range / kRings;
    }
    CHECK(std::abs(sum - 1) <= 1e-4);
  }
}

TEST_CASE("a disk's solid angle is that on its axis, from afar, and the sum of its samples") {
  for (const double z : {1e-2, 0.1, 1.0, 10.0, 1e4}) {
    CAPTURE(z);
    const double root = std::hypot(1.0, z);
    const double exact = 2 * M_PI / (root * (root + z));
    CHECK(std::abs(SolidAngle(DiskLight<double>{{0, 0, z}, {0, 0, 1}, 1}) / exact - 1) <= 1e-9);
  }
  for (const DiskLight<double>& light : DiskLights()) {
    CAPTURE(light.centre, light.normal, light.radius);
    constexpr int kSteps = 600;
    double sum = 0;
    for (int i = 0; i < kSteps * kSteps; ++i) {
      const double u0 = (i / kSteps + 0.5) / kSteps, u1 = (i % kSteps + 0.5) / kSteps;
      sum += SampleLight(light, u0, u1).inverse_pdf / (1.0 * kSteps * kSteps);
    }
    CHECK(std::abs(sum / SolidAngle(light) - 1) <= 3e-4);
  }
}

}  // namespace
}  // namespace nacre
