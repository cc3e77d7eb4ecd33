// SPDX-License-Identifier: Apache-2.0
// tests/light/irradiance_test.cc: closed-form irradiance of area lights against the table and,
// where the table does not go, against quadrature: in double and in float on every target.
#include <cmath>
#include <random>

#include "catch.h"
#include "light/area_kernel.h"
#include "light/area_rounding.h"
#include "light/area_shapes.h"
#include "light/polygon_irradiance.h"
#include "tables.h"
#include "targets.h"

namespace nacre {
namespace {

template <class Light>
double FloatIrradiance(const Light& light, const Vec3d& normal) {
  const auto rounded = ToFloat(light);
  return AskLights({{rounded, 0.5f, 0.5f, {0, 0, 1}, Vec3f(normal)}})[0].irradiance;
}

// Judges both precisions at a light and normal: tables/README asks for 1e-5.
template <class Light>
void CheckRow(const Light& light, const Vec3d& normal, double reference) {
  CHECK(std::abs(Irradiance(light, normal) - reference) <= 1e-11 * reference);
  ForEachTarget([&](Target) {
    CHECK(std::abs(FloatIrradiance(light, normal) - reference) <= 1e-5 * reference);
  });
}

TEST_CASE("irradiance matches the table", "[table]") {
  const nlohmann::json table = LoadTable("area_light_irradiance");
  size_t rows = 0;
  for (const auto& row : table.at("rows")) {
    const std::string id = row["id"], kind = row["kind"], horizon = row["horizon"];
    CAPTURE(id, kind, horizon);
    const Vec3d normal = TableVector(row["n"]).normalized(), point = TableVector(row["x"]);
    const double reference = TableNumber(row["E_over_L"]);
    if (kind == "sphere") {
      CheckRow(SphereLight<double>{TableVector(row["c"]) - point, row["r"].get<double>()}, normal,
               reference);
    } else if (kind == "rect") {
      const Vec3d u = TableVector(row["half_u"]), v = TableVector(row["half_v"]);
      const Vec3d corner = TableVector(row["center"]) - point - u - v;
      CheckRow(RectangleLight<double>{corner, u * 2, v * 2}, normal, reference);
      // As two triangles. Both may be cut, in double to the same.
      const double halves =
          Irradiance(TriangleLight<double>{corner, u * 2, u * 2 + v * 2}, normal) +
          Irradiance(TriangleLight<double>{corner, u * 2 + v * 2, v * 2}, normal);
      CHECK(std::abs(halves - reference) <= 1e-11 * reference);
    } else {
      CheckRow(
          DiskLight<double>{TableVector(row["center"]) - point,
                            TableVector(row["axis"]).normalized(), row["radius"].get<double>()},
          normal, reference);
    }
    ++rows;
  }
  CHECK(rows > 0);
}

// The mean of cos / pdf over samples on a grid: the same integral by sampling.
template <class Light>
double SampledIrradiance(const Light& light, const Vec3d& normal, int steps) {
  double sum = 0;
  for (int i = 0; i < steps; ++i) {
    for (int j = 0; j < steps; ++j) {
      const AreaSample<double> sample = SampleLight(light, (i + 0.5) / steps, (j + 0.5) / steps);
      sum += std::max(sample.to_light ^ normal, 0.0) * sample.inverse_pdf;
    }
  }
  return sum / (1.0 * steps * steps);
}

double SizeOf(const SphereLight<double>& light) { return light.radius; }
double SizeOf(const DiskLight<double>& light) { return light.radius; }
template <class Light>
double SizeOf(const Light& light) {
  return std::max(light.edge_x.length(), light.edge_y.length());
}
Vec3d SomePoint(const SphereLight<double>& light) { return light.centre; }
Vec3d SomePoint(const DiskLight<double>& light) { return light.centre; }
template <class Light>
Vec3d SomePoint(const Light& light) {
  return light.corner + (light.edge_x + light.edge_y) * 0.4;
}

// Normals: towards the light, aslant, and such that the horizon cuts it at several heights.
std::vector<Vec3d> NormalsFor(const Vec3d& towards, double size) {
  const Basis<double> basis = BasisAbout(towards.normalized());
  std::vector<Vec3d> normals = {basis.z, (basis.z + basis.x).normalized()};
  for (const double height : {-0.9, -0.4, 0.1, 0.6, 2.0}) {
    const double sin = std::clamp(height * size / towards.length(), -0.99, 0.99);
    const double turn = 7 * height;
    normals.push_back(basis.ToWorld({std::sqrt(1 - sin * sin) * std::cos(turn),
                                     std::sqrt(1 - sin * sin) * std::sin(turn), sin}));
  }
  return normals;
}

template <class Light>
void CheckSampled(const std::vector<Light>& lights) {
  for (const Light& light : lights) {
    const double size = SizeOf(light);
    const Vec3d towards = SomePoint(light);
    for (const Vec3d& normal : NormalsFor(towards, size)) {
      CAPTURE(towards, size, normal);
      // A grid of 160^2 points and an edge along the horizon, or around a disk that is a part of
      // what is sampled: errors of about 160^-1.5 = 5e-4.
      const double sampled = SampledIrradiance(light, normal, 160);
      const double scale = SampledIrradiance(light, towards.normalized(), 50);
      CHECK(std::abs(Irradiance(light, normal) - sampled) <= 1.5e-3 * scale);
    }
  }
}

TEST_CASE("irradiance is the mean of the samples' cosines over their pdfs") {
  CheckSampled(SphereLights());
  CheckSampled(RectangleLights());
  CheckSampled(TriangleLights());
  CheckSampled(DiskLights());
}

// The light moved by a vector.
SphereLight<double> Moved(SphereLight<double> light, const Vec3d& by) {
  light.centre += by;
  return light;
}
DiskLight<double> Moved(DiskLight<double> light, const Vec3d& by) {
  light.centre += by;
  return light;
}
template <class Light>
Light Moved(Light light, const Vec3d& by) {
  light.corner += by;
  return light;
}

// The change of the irradiance by one rounding of each component of the normal and of the light's
// position.
template <class Light>
double OneRounding(const Light& light, const Vec3d& normal) {
  const double u = 0x1p-24, far = SomePoint(light).length() + SizeOf(light);
  const double exact = Irradiance(light, normal);
  double sum = 0;
  for (const Vec3d& axis : {Vec3d(1, 0, 0), Vec3d(0, 1, 0), Vec3d(0, 0, 1)}) {
    sum += std::abs(Irradiance(light, normal + axis * u) - exact);
    sum += std::abs(Irradiance(Moved(light, axis * (u * far)), normal) - exact);
  }
  return sum;
}

// Length over width, by which the edges along a strip cancel.
double AspectOf(const SphereLight<double>&) { return 1; }
double AspectOf(const DiskLight<double>&) { return 1; }
template <class Light>
double AspectOf(const Light& light) {
  return SizeOf(light) * SizeOf(light) / (light.edge_x % light.edge_y).length();
}

// Whether the twins agree to 1e-5, or within the effect of 8 roundings of their inputs where that
// is more: just above the horizon, and next to a light; and 4 roundings times the length of a
// strip.
template <class Light>
void CheckTwins(const std::vector<Light>& lights) {
  for (const Light& light : lights) {
    for (const Vec3d& normal : NormalsFor(SomePoint(light), SizeOf(light))) {
      const Light rounded = ToDouble(ToFloat(light));
      const auto rounded_normal = Vec3d(Vec3f(normal));
      const double exact = Irradiance(rounded, rounded_normal);
      const double got = FloatIrradiance(light, normal);
      const double tolerance =
          (1e-5 + 4 * 0x1p-24 * AspectOf(light)) * exact + 8 * OneRounding(rounded, rounded_normal);
      CAPTURE(SomePoint(light), SizeOf(light), normal, got, exact, tolerance);
      CHECK(std::abs(got - exact) <= tolerance);
    }
  }
}

TEST_CASE("SIMD irradiance agrees with its double twin on every target") {
  ForEachTarget([](Target) {
    CheckTwins(SphereLights());
    CheckTwins(RectangleLights());
    CheckTwins(TriangleLights());
    CheckTwins(DiskLights());
  });
}

TEST_CASE("irradiance keeps its digits for tiny and distant lights in float") {
  const Vec3d normal = Vec3d(0.1, -0.2, 1).normalized();
  for (const double size : {1.0, 1e-2, 1e-4, 1e-6}) {
    CAPTURE(size);
    const Vec3d centre = Turn({30, -10, 40});
    const Vec3d axis = Turn(Vec3d(0.3, 0.2, -1).normalized());
    const Vec3d x = BasisAbout(axis).x * size, y = BasisAbout(axis).y * size;
    const auto check = [&](const auto& light) {
      const double exact = Irradiance(light, normal);
      CHECK(exact > 0);
      ForEachTarget(
          [&](Target) { CHECK(std::abs(FloatIrradiance(light, normal) / exact - 1) <= 3e-6); });
    };
    check(SphereLight<double>{centre, size});
    check(RectangleLight<double>{centre, x, y});
    check(TriangleLight<double>{centre, x, x + y});
    check(DiskLight<double>{centre, axis, size});
    // A flat light from far away: area cos cos / distance^2.
    const double flat =
        size * size * std::abs(axis ^ centre) * (normal ^ centre) / std::pow(centre.length(), 4);
    CHECK(std::abs(Irradiance(RectangleLight<double>{centre, x, y}, normal) / flat - 1) <=
          4 * size / centre.length());
  }
}

TEST_CASE("lights all round give pi, lights below and in their own plane nothing") {
  const Vec3d up(0, 0, 1);
  CHECK(Irradiance(SphereLight<double>{{1, 0, 0}, 3}, up) == M_PI);
  CHECK(Irradiance(SphereLight<double>{{0, 0, 1}, 1}, up) == Approx(M_PI).epsilon(1e-14));
  CHECK(Irradiance(SphereLight<double>{{1, 0, 0}, 1}, up) == Approx(M_PI / 2).epsilon(1e-14));
  CHECK(Irradiance(SphereLight<double>{{0, 0, -1.01}, 1}, up) == 0);
  const double wide = 1e6;
  CHECK(Irradiance(RectangleLight<double>{{-wide, -wide, 1}, {2 * wide, 0, 0}, {0, 2 * wide, 0}},
                   up) == Approx(M_PI).epsilon(1e-9));
  CHECK(Irradiance(DiskLight<double>{{0, 0, 1}, up, wide}, up) == Approx(M_PI).epsilon(1e-9));
  CHECK(Irradiance(DiskLight<double>{{0, 0, 1}, -up, wide}, up) == Approx(M_PI).epsilon(1e-9));
  // A vertical plane, from below the horizon to far above it: half of everything.
  CHECK(Irradiance(RectangleLight<double>{{-wide, 1, -wide}, {2 * wide, 0, 0}, {0, 0, 2 * wide}},
                   up) == Approx(M_PI / 2).epsilon(1e-5));
  CHECK(Irradiance(DiskLight<double>{{0, 1, 0}, {0, 1, 0}, wide}, up) ==
        Approx(M_PI / 2).epsilon(1e-5));
  ForEachTarget([&](Target) {
    CHECK(FloatIrradiance(SphereLight<double>{{1, 0, 0}, 3}, up) == Approx(M_PI));
    CHECK(FloatIrradiance(SphereLight<double>{{0, 0, -1.01}, 1}, up) == 0);
    CHECK(FloatIrradiance(SphereLight<double>{{0, 0, 1}, 0}, up) == 0);
    const RectangleLight<double> below{{-1, -1, -2}, {2, 0, 0}, {0, 2, 0}};
    CHECK(FloatIrradiance(below, up) == 0);
    CHECK(FloatIrradiance(below, -up) > 0);
    const RectangleLight<double> in_plane{{-1, -1, 0}, {2, 0, 0}, {0, 2, 0}};
    CHECK(FloatIrradiance(in_plane, up) == 0);
    CHECK(FloatIrradiance(in_plane, Vec3d(1, 0, 0)) == 0);
    CHECK(FloatIrradiance(TriangleLight<double>{{0, 0, 0}, {2, 0, 0}, {0, 2, 0}}, up) == 0);
    CHECK(FloatIrradiance(DiskLight<double>{{0.1, 0, 0}, up, 1}, up) == 0);
    CHECK(FloatIrradiance(DiskLight<double>{{0, 0, -2}, up, 1}, up) == 0);
  });
}

}  // namespace
}  // namespace nacre
