// SPDX-License-Identifier: Apache-2.0
// tests/light/area_sample_test.cc: samples of area lights in double: solid angles against the
// table, uniformity by chi-squared against the solid angles of parts, pdfs that match the samples,
// and positions where there is nothing to sample.
#include "light/area_sample.h"

#include <cmath>
#include <random>

#include "catch.h"
#include "chi_squared.h"
#include "light/area_shapes.h"
#include "tables.h"

namespace nacre {
namespace {

constexpr int kSamples = 40000;

TEST_CASE("solid angles match the table", "[table]") {
  size_t rows = 0;
  const nlohmann::json table = LoadTable("solid_angle");
  for (const auto& row : table.at("rows")) {
    const std::string kind = row["kind"];
    const double reference = TableNumber(row["solid_angle"]);
    CAPTURE(kind, reference, rows);
    double got = 0;
    if (kind == "sphere") {
      const SphereLight<double> light{{0, 0, row["distance"].get<double>()},
                                      row["radius"].get<double>()};
      got = SolidAngle(light);
      CHECK(std::abs(ConeOf(light).one_minus_cos / TableNumber(row["one_minus_cos_max"]) - 1) <=
            1e-14);
    } else if (kind == "triangle") {
      const Vec3d a = TableVector(row["v"][0]);
      got = SolidAngle(
          TriangleLight<double>{a, TableVector(row["v"][1]) - a, TableVector(row["v"][2]) - a});
    } else {
      const Vec3d u = TableVector(row["half_u"]), v = TableVector(row["half_v"]);
      got = SolidAngle(RectangleLight<double>{TableVector(row["center"]) - u - v, u * 2, v * 2});
    }
    // tables/README: 1e-5. Rows of float corners are parallelograms that are off rectangles by
    // float's rounding.
    CHECK(std::abs(got / reference - 1) <= (kind == "rect" ? 1e-5 : 1e-9));
    ++rows;
  }
  CHECK(rows > 0);
}

// A partition of a light: the part that a point lies in, and the probability of each part by its
// solid angle. Spheres are divided equally in cosine and azimuth.
constexpr int kGrid = 6;

struct Parts {
  std::vector<double> probabilities, counts;
  void Count(size_t part) { counts[part] += 1; }
};

int Cell(double part_of_one) {
  return std::clamp(static_cast<int>(part_of_one * kGrid), 0, kGrid - 1);
}

RectangleLight<double> CellOf(const RectangleLight<double>& light, int x, int y) {
  return {light.corner + light.edge_x * (1.0 * x / kGrid) + light.edge_y * (1.0 * y / kGrid),
          light.edge_x / kGrid, light.edge_y / kGrid};
}

// Samples a light and counts those in each part, which `part_of` gives for a point of it (-1:
// none); no sample counts as the last part.
template <class Light, class PartOf>
void CountSamples(const Light& light, const PartOf& part_of, Parts* parts) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> unit(0, 1);
  parts->counts.assign(parts->probabilities.size(), 0);
  for (int i = 0; i < kSamples; ++i) {
    const double u0 = unit(random);
    const double u1 = unit(random);
    const AreaSample<double> sample = SampleLight(light, u0, u1);
    if (sample.inverse_pdf == 0) {
      parts->Count(parts->counts.size() - 1);
      continue;
    }
    REQUIRE(std::abs(sample.to_light.length() - 1) <= 1e-14);
    const double pdf = LightPdf(light, sample.to_light);
    if (pdf == 0) FAIL("no pdf where there is a sample: " << u0 << ' ' << u1);
    // The pdf of area sampling is as steep as distance^2 / cosine: 1e-11 leaves room for
    // nearly edge-on lights.
    if (std::abs(pdf * sample.inverse_pdf - 1) > 1e-10) {
      FAIL("pdf " << pdf << " but inverse " << sample.inverse_pdf);
    }
    parts->Count(part_of(sample.to_light * sample.distance));
  }
}

TEST_CASE("samples of spheres are uniform over their cone") {
  for (const SphereLight<double>& light : SphereLights()) {
    CAPTURE(light.centre, light.radius);
    const bool inside = IsInside(light);
    const SphereCone<double> cone = ConeOf(light);
    const Basis<double> basis = BasisAbout(light.centre.normalized());
    Parts parts;
    parts.probabilities.assign(kGrid * kGrid + 1, 1.0 / (kGrid * kGrid));
    parts.probabilities.back() = 0;
    CountSamples(
        light,
        [&](const Vec3d& point) {
          CHECK(std::abs((point - light.centre).length() / light.radius - 1) <= 1e-9);
          const Vec3d local = basis.ToLocal(point.normalized());
          // 1 - cos = sin^2 / (1 + cos), as small as it gets.
          const double across2 = local.x * local.x + local.y * local.y;
          const double one_minus_cos = local.z > 0 ? across2 / (1 + local.z) : 1 - local.z;
          const double turn = std::atan2(local.y, local.x) / (2 * M_PI) + 0.5;
          const double range = inside ? 2 : cone.one_minus_cos;
          return static_cast<size_t>(Cell(one_minus_cos / range) * kGrid + Cell(turn));
        },
        &parts);
    CHECK(FollowsProbabilities(parts.counts, kSamples, parts.probabilities));
  }
}

TEST_CASE("samples of rectangles are uniform in solid angle") {
  for (const RectangleLight<double>& light : RectangleLights()) {
    CAPTURE(light.corner, light.edge_x, light.edge_y);
    Parts parts;
    const double whole = SolidAngle(light);
    const bool by_area = whole < kSmallSolidAngle<double>;
    double sum = 0;
    for (int y = 0; y < kGrid; ++y) {
      for (int x = 0; x < kGrid; ++x) {
        const double part = SolidAngle(CellOf(light, x, y));
        sum += part;
        parts.probabilities.push_back(by_area ? 1.0 / (kGrid * kGrid) : part / whole);
      }
    }
    CHECK(std::abs(sum / whole - 1) <= 1e-9);
    parts.probabilities.push_back(0);
    CountSamples(
        light,
        [&](const Vec3d& point) {
          const Vec3d from_corner = point - light.corner;
          const double x = (from_corner ^ light.edge_x) / light.edge_x.length2();
          const double y = (from_corner ^ light.edge_y) / light.edge_y.length2();
          return static_cast<size_t>(Cell(y) * kGrid + Cell(x));
        },
        &parts);
    CHECK(FollowsProbabilities(parts.counts, kSamples, parts.probabilities));
  }
}

// Strips between lines through a triangle's corner, each cut by lines parallel to the far edge.
TEST_CASE("samples of triangles are uniform in solid angle") {
  for (const TriangleLight<double>& light : TriangleLights()) {
    CAPTURE(light.corner, light.edge_x, light.edge_y);
    Parts parts;
    const double whole = SolidAngle(light);
    const bool by_area = whole < kSmallSolidAngle<double>;
    const auto part_below = [&](int strip, int cut) {
      const double s0 = 1.0 * strip / kGrid, s1 = 1.0 * (strip + 1) / kGrid;
      const double c = 1.0 * cut / kGrid;
      const TriangleLight<double> part{light.corner,
                                       (light.edge_x * (1 - s0) + light.edge_y * s0) * c,
                                       (light.edge_x * (1 - s1) + light.edge_y * s1) * c};
      const double area = c * c / kGrid;
      return cut == 0 ? 0 : by_area ? area : SolidAngle(part) / whole;
    };
    for (int strip = 0; strip < kGrid; ++strip) {
      for (int cut = 0; cut < kGrid; ++cut) {
        parts.probabilities.push_back(part_below(strip, cut + 1) - part_below(strip, cut));
      }
    }
    parts.probabilities.push_back(0);
    const Vec3d normal = light.edge_x % light.edge_y;
    CountSamples(
        light,
        [&](const Vec3d& point) {
          const Vec3d from_corner = point - light.corner;
          const double x = ((from_corner % light.edge_y) ^ normal) / normal.length2();
          const double y = ((light.edge_x % from_corner) ^ normal) / normal.length2();
          return static_cast<size_t>(Cell(y / (x + y)) * kGrid + Cell(x + y));
        },
        &parts);
    CHECK(FollowsProbabilities(parts.counts, kSamples, parts.probabilities));
  }
}

// Rings and sectors of equal area from afar. Nearby: the cells of the square that lie wholly in
// the disk, and all the rest together.
TEST_CASE("samples of disks are uniform in area from afar and in solid angle nearby") {
  for (const DiskLight<double>& light : DiskLights()) {
    CAPTURE(light.centre, light.normal, light.radius);
    const DiskView<double> view = ViewOf(light);
    const RectangleLight<double> square = SquareAround(light, view);
    Parts parts;
    const auto rest = static_cast<size_t>(kGrid * kGrid);
    parts.probabilities.assign(rest + 1, 1.0 / (kGrid * kGrid));
    parts.probabilities.back() = 0;
    const bool nearby = IsNearby(view, light.radius);
    if (nearby) {
      double sum = 0;
      for (size_t i = 0; i < rest; ++i) {
        const int x = static_cast<int>(i) % kGrid, y = static_cast<int>(i) / kGrid;
        const double far_x = std::max(std::abs(x - kGrid / 2), std::abs(x + 1 - kGrid / 2));
        const double far_y = std::max(std::abs(y - kGrid / 2), std::abs(y + 1 - kGrid / 2));
        const bool whole = std::hypot(far_x, far_y) <= kGrid / 2;
        parts.probabilities[i] = whole ? SolidAngle(CellOf(square, x, y)) / SolidAngle(square) : 0;
        sum += parts.probabilities[i];
      }
      parts.probabilities[rest] = 1 - sum;
    }
    CountSamples(
        light,
        [&](const Vec3d& point) {
          const Vec3d from_centre = point - light.centre;
          const double x = (from_centre ^ view.x_axis) / light.radius;
          const double y = (from_centre ^ view.y_axis) / light.radius;
          const auto in_square = static_cast<size_t>(Cell(y / 2 + 0.5) * kGrid + Cell(x / 2 + 0.5));
          if (nearby) return parts.probabilities[in_square] > 0 ? in_square : rest;
          const double turn = std::atan2(y, x) / (2 * M_PI) + 0.5;
          return static_cast<size_t>(Cell(x * x + y * y) * kGrid + Cell(turn));
        },
        &parts);
    CHECK(FollowsProbabilities(parts.counts, kSamples, parts.probabilities));
  }
}

TEST_CASE(
    "the cosine at the light tells its sides, and there is no sample where there is no light") {
  // Toward the side that edge_x cross edge_y points to, and from behind.
  CHECK(
      SampleLight(RectangleLight<double>{{-1, -1, -2}, {2, 0, 0}, {0, 2, 0}}, 0.3, 0.6).cos_light >
      0);
  CHECK(SampleLight(RectangleLight<double>{{-1, -1, 2}, {2, 0, 0}, {0, 2, 0}}, 0.3, 0.6).cos_light <
        0);
  const TriangleLight<double> below{{-1, -1, -2}, {2, 0, 0}, {0, 2, 0}};
  CHECK(SampleLight(below, 0.3, 0.6).cos_light > 0);
  CHECK(SampleLight(TriangleLight<double>{{-1, -1, 2}, {2, 0, 0}, {0, 2, 0}}, 0.3, 0.6).cos_light <
        0);
  CHECK(SampleLight(DiskLight<double>{{0, 0, -2}, {0, 0, 1}, 1}, 0.3, 0.6).cos_light > 0);
  CHECK(SampleLight(DiskLight<double>{{0, 0, 2}, {0, 0, 1}, 1}, 0.3, 0.6).cos_light < 0);
  CHECK(SampleLight(SphereLight<double>{{0, 0, 2}, 1}, 0.3, 0.6).cos_light > 0);
  CHECK(SampleLight(SphereLight<double>{{0, 0, 0.5}, 1}, 0.3, 0.6).cos_light < 0);
  // In the plane, inside and outside of the light; a light of no size; the point itself.
  CHECK(SampleLight(RectangleLight<double>{{-1, -1, 0}, {2, 0, 0}, {0, 2, 0}}, 0.3, 0.6)
            .inverse_pdf == 0);
  CHECK(
      SampleLight(RectangleLight<double>{{3, 4, 0}, {2, 0, 0}, {0, 2, 0}}, 0.3, 0.6).inverse_pdf ==
      0);
  CHECK(
      SampleLight(RectangleLight<double>{{3, 4, 5}, {0, 0, 0}, {0, 2, 0}}, 0.3, 0.6).inverse_pdf ==
      0);
  CHECK(
      SampleLight(TriangleLight<double>{{-1, -1, 0}, {2, 0, 0}, {0, 9, 0}}, 0.3, 0.6).inverse_pdf ==
      0);
  CHECK(SampleLight(TriangleLight<double>{{0, 0, 0}, {2, 0, 0}, {0, 9, 0}}, 0.3, 0.6).inverse_pdf ==
        0);
  CHECK(SampleLight(DiskLight<double>{{0.5, 0, 0}, {0, 0, 1}, 1}, 0.3, 0.6).inverse_pdf == 0);
  CHECK(SampleLight(DiskLight<double>{{0, 0, 1}, {0, 0, 1}, 0}, 0.3, 0.6).inverse_pdf == 0);
  CHECK(SampleLight(SphereLight<double>{{0, 0, 1}, 0}, 0.3, 0.6).inverse_pdf == 0);
  CHECK(SampleLight(SphereLight<double>{{0, 0, 0}, 0}, 0.3, 0.6).inverse_pdf == 0);
  // On the sphere: the half-space towards its centre.
  const AreaSample<double> touching = SampleLight(SphereLight<double>{{0, 0, 1}, 1}, 0.3, 0.6);
  CHECK(touching.inverse_pdf == 2 * M_PI);
  CHECK(touching.distance == 0);
  // Directions away from the light, and next to it.
  CHECK(LightPdf(SphereLight<double>{{0, 0, 2}, 1}, {0, 0, -1}) == 0);
  CHECK(LightPdf(DiskLight<double>{{0, 0, 2}, {0, 0, 1}, 1}, Vec3d(1.01, 0, 2).normalized()) == 0);
  CHECK(LightPdf(DiskLight<double>{{0, 0, 2}, {0, 0, 1}, 1}, {0, 0, -1}) == 0);
  CHECK(LightPdf(below, {0, 0, 1}) == 0);
  CHECK(LightPdf(below, {0, 0, -1}) > 0);
}

}  // namespace
}  // namespace nacre
