// SPDX-License-Identifier: Apache-2.0
// tests/shading/mesh_light_test.cc: directions to lights made of triangles, and their pdfs, on
// every target.
#include "light/mesh_light.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <random>
#include <utility>
#include <vector>

#include "light/disk_light.h"
#include "light/polygon_irradiance.h"
#include "light/sphere_light.h"
#include "scene/sphere_mesh.h"
#include "shading/light_sampling.h"
#include "targets.h"

namespace nacre {
namespace {

SampledLight Prepare(const Mesh& mesh, bool two_sided = false) {
  Light light{.kind = MeshAreaLight{.mesh = std::make_shared<const Mesh>(mesh),
                                    .radiance = Rgb(1),
                                    .two_sided = two_sided}};
  KeptTables none;
  return PrepareSampledLight(light, Vec3d(0, 0, 0), &none);
}

// Hits in one place.
HitBatch Hits(const Vec3d& position) {
  HitBatch hits;
  hits.count = kBatchCapacity;
  for (size_t i = 0; i < hits.count; ++i) {
    hits.position.x[i] = position.x;
    hits.position.y[i] = position.y;
    hits.position.z[i] = position.z;
  }
  return hits;
}

UnitPoints Points() {
  const PairSampler sampler = MakePairSampler(kBatchCapacity, 1, 3);
  SampleNumbers numbers(kBatchCapacity);
  AlignedArray<uint32_t> entries(kBatchCapacity);
  for (uint32_t i = 0; i < kBatchCapacity; ++i) entries[i] = numbers.number[i] = i;
  numbers.pixel_count = 1;
  UnitPoints points(kBatchCapacity);
  SamplePair(sampler, 0, numbers, entries.data(), kBatchCapacity, &points);
  return points;
}

// The solid angle of the triangles that face the point, of a convex mesh: that of the mesh.
double FrontSolidAngle(const SampledLight& light, const Vec3d& point) {
  double sum = 0;
  for (TriangleLight<double> triangle : light.mesh->triangles) {
    triangle.corner += light.place - point;
    if ((triangle.corner ^ (triangle.edge_x % triangle.edge_y)) < 0) sum += SolidAngle(triangle);
  }
  return sum;
}

TEST_CASE("directions to a mesh have the pdfs that it finds along them") {
  const SampledLight light =
      Prepare(MakeMesh(Icosphere{.center = {1, 2, -3}, .radius = 0.8, .subdivisions = 2}));
  const UnitPoints points = Points();
  ForEachTarget([&](Target) {
    for (const Vec3d& point : {Vec3d(0, 0, 0), Vec3d(1, 1.1, -3), Vec3d(-40, 3, 20)}) {
      const HitBatch hits = Hits(point);
      LightDirections sampled, found;
      SampleLight(light, hits, points, &sampled);
      for (size_t i = 0; i < hits.count; ++i) {
        found.to_light.x[i] = sampled.to_light.x[i];
        found.to_light.y[i] = sampled.to_light.y[i];
        found.to_light.z[i] = sampled.to_light.z[i];
      }
      FindLight(light, hits, &found);
      double sum = 0, squares = 0;
      size_t lost = 0;
      for (size_t i = 0; i < hits.count; ++i) {
        REQUIRE(sampled.pdf[i] == found.pdf[i]);
        REQUIRE(sampled.distance[i] == found.distance[i]);
        if (!(sampled.pdf[i] > 0)) {
          ++lost;  // at the silhouette, by the rounding of the direction to float
          continue;
        }
        const Vec3d end =
            point + Vec3d(sampled.to_light.x[i], sampled.to_light.y[i], sampled.to_light.z[i]) *
                        double{sampled.distance[i]};
        // On a face, which is up to 1 - cos of the sphere's radius below the sphere.
        const double height = (end - Vec3d(1, 2, -3)).length() / 0.8;
        REQUIRE(height <= 1 + 1e-5);
        REQUIRE(height >= 0.95);
        const double inverse = 1 / double{sampled.pdf[i]};
        sum += inverse;
        squares += inverse * inverse;
      }
      CHECK(lost <= 2);
      // The mean of 1 / pdf is the solid angle that is seen.
      const double count = static_cast<double>(hits.count), mean = sum / count;
      const double error = std::sqrt(std::max(squares / count - mean * mean, 0.0) / count);
      const double expected = FrontSolidAngle(light, point);
      CAPTURE(point.x, mean, error, expected);
      CHECK(std::abs(mean - expected) <= 4 * error + 1e-5 * expected);
      CHECK(error <= 0.05 * expected);  // the check above could fail
    }
  });
}

TEST_CASE("what hides behind the nearest triangle is not seen, and counts for its pdf") {
  // Two squares behind one another, both facing +z; the first is seen from its back from z < 0.
  Mesh mesh;
  for (const double z : {0.0, 1.0}) {
    const auto first = static_cast<uint32_t>(mesh.positions.size());
    for (const Vec3d& corner :
         {Vec3d(-1, -1, z), Vec3d(1, -1, z), Vec3d(1, 1, z), Vec3d(-1, 1, z)}) {
      mesh.positions.push_back(corner);
    }
    for (const uint32_t i : {0u, 1u, 2u, 0u, 2u, 3u}) mesh.triangles.push_back(first + i);
  }
  const auto find = [&](bool two_sided, const Vec3d& point, const Vec3d& to_light) {
    const SampledLight light = Prepare(mesh, two_sided);
    HitBatch hits = Hits(point);
    hits.count = 1;
    LightDirections directions;
    directions.to_light.x[0] = static_cast<float>(to_light.x);
    directions.to_light.y[0] = static_cast<float>(to_light.y);
    directions.to_light.z[0] = static_cast<float>(to_light.z);
    FindLight(light, hits, &directions);
    return std::pair(directions.distance[0], directions.pdf[0]);
  };
  const auto pdf = [](double distance) {  // of the triangle through (0.3, 0.2, z), half of it
    const TriangleLight<double> half{{-1.3, -1.2, distance}, {2, 0, 0}, {2, 2, 0}};
    return 0.25 / SolidAngle(half);
  };
  const Vec3d before(0.3, 0.2, 4), behind(0.3, 0.2, -2), between(0.3, 0.2, 0.5);
  const double both = pdf(3) + pdf(4);
  CHECK(find(false, before, {0, 0, -1}).first == 3);
  CHECK(find(false, before, {0, 0, -1}).second == Approx(both).epsilon(1e-6));
  CHECK(find(false, behind, {0, 0, 1}) == std::pair(0.0f, 0.0f));
  CHECK(find(true, behind, {0, 0, 1}).first == 2);
  CHECK(find(false, between, {0, 0, -1}).first == 0.5);
  CHECK(find(false, between, {0, 0, 1}).first == 0);
  // In the plane of a square, and past both.
  CHECK(find(true, {3, 0.2, 1}, {-1, 0, 0}) == std::pair(0.0f, 0.0f));
  CHECK(find(true, {3, 0.2, 4}, {0, 0, -1}) == std::pair(0.0f, 0.0f));
}

// A square of n x n squares in the plane z = 0, and as many beside it at random.
Mesh SquareAndHeap(uint32_t n) {
  Mesh mesh;
  for (uint32_t i = 0; i <= n; ++i) {
    for (uint32_t k = 0; k <= n; ++k) mesh.positions.emplace_back(i, k, 0);
  }
  for (uint32_t i = 0; i < n; ++i) {
    for (uint32_t k = 0; k < n; ++k) {
      const uint32_t a = i * (n + 1) + k, b = a + n + 1;
      mesh.triangles.insert(mesh.triangles.end(), {a, b, b + 1, a, b + 1, a + 1});
    }
  }
  std::mt19937 random(4);
  std::uniform_real_distribution<double> uniform(0, n);
  for (uint32_t i = 0; i < 6 * n * n; ++i) {
    mesh.triangles.push_back(static_cast<uint32_t>(mesh.positions.size()));
    mesh.positions.emplace_back(uniform(random), uniform(random) - n, uniform(random));
  }
  return mesh;
}

// Directions from points as near as the light and as far as its sight allows, to points of
// triangles and, half of them, to their edges, where boxes end as well.
TEST_CASE("a ray finds the triangles of a mesh that are tested one by one") {
  const double kSizes[] = {1, 3e-6, 2e5};
  for (const double size : kSizes) {
    for (const uint32_t n : {1u, 2u, 9u}) {
      Mesh mesh = SquareAndHeap(n);
      for (Vec3d& p : mesh.positions) p = (p + Vec3d(7, 3, -4)) * size;
      const SampledLight light = Prepare(mesh, true);
      const MeshLight& triangles = *light.mesh;
      std::mt19937 random(n);
      std::uniform_real_distribution<double> uniform(0, 1);
      std::normal_distribution<double> gauss;
      HitBatch hits;
      hits.count = kBatchCapacity - 3;
      LightDirections found;
      for (size_t i = 0; i < hits.count; ++i) {
        const auto& t = triangles.triangles[random() % triangles.triangles.size()];
        const double u = uniform(random), v = (i % 2 == 0) ? 0 : uniform(random) * (1 - u);
        Vec3d target = light.place + t.corner + t.edge_x * u + t.edge_y * v;
        if (i % 5 == 0) target += (target - light.place) * 0.3 * uniform(random);
        Vec3d away(gauss(random), gauss(random), gauss(random));
        if (i % 7 == 0) away = Vec3d(0, 0, gauss(random));
        const double distance = light.radius * std::pow(10.0, 6 * uniform(random) - 2);
        const Vec3d point = target + away.normalized() * distance;
        const Vec3d to_light = (target - point).normalized();
        for (int c = 0; c < 3; ++c) {
          (c == 0 ? hits.position.x : c == 1 ? hits.position.y : hits.position.z)[i] = point[c];
          (c == 0   ? found.to_light.x
           : c == 1 ? found.to_light.y
                    : found.to_light.z)[i] = static_cast<float>(to_light[c]);
        }
      }
      ForEachTarget([&](Target) {
        FindLight(light, hits, &found);
        std::vector<MeshLightHit> expected;
        size_t met = 0, several = 0;
        for (size_t i = 0; i < hits.count; ++i) {
          const Vec3d point(hits.position.x[i], hits.position.y[i], hits.position.z[i]);
          const Vec3d l(found.to_light.x[i], found.to_light.y[i], found.to_light.z[i]);
          FindMeshLightHits(triangles, point - light.place, l, &expected);
          double distance = std::numeric_limits<double>::infinity(), pdf = 0;
          for (const MeshLightHit& hit : expected) {
            distance = std::min(distance, hit.t * l.length());
            TriangleLight<double> triangle = triangles.triangles[hit.triangle];
            triangle.corner += light.place - point;
            pdf += triangles.probabilities[hit.triangle] * LightPdf(triangle, l);
          }
          met += expected.empty() ? 0 : 1;
          several += expected.size() > 1 ? 1 : 0;
          CAPTURE(size, n, i, expected.size());
          REQUIRE((found.distance[i] > 0) == !expected.empty());
          if (expected.empty()) continue;
          REQUIRE(std::abs(double{found.distance[i]} / distance - 1) <= 1e-7);
          // Of triangles that are seen edge-on floats keep two digits. One that was lost counts
          // more than that.
          REQUIRE(std::abs(double{found.pdf[i]} / pdf - 1) <= 0.02);
        }
        CHECK(met > hits.count / 2);
        CHECK((several > hits.count / 20 || n == 1));
      });
    }
  }
}

TEST_CASE("closed forms are for meshes that hide nothing of themselves") {
  Mesh quad{.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}},
            .triangles = {0, 1, 2, 0, 2, 3}};
  CHECK(HasIrradiance(Prepare(quad)));
  CHECK(HasIrradiance(Prepare(quad, true)));
  const Mesh ball = MakeMesh(Icosphere{.subdivisions = 0});
  CHECK(HasIrradiance(Prepare(ball)));
  CHECK(!HasIrradiance(Prepare(ball, true)));  // its far inside would shine through
  CHECK(!HasIrradiance(Prepare(MakeMesh(Icosphere{.subdivisions = 1}))));  // 80 triangles
}

// A cube without its bottom: convex, but no closed solid.
Mesh OpenCube() {
  Mesh cube;
  for (uint32_t i = 0; i < 8; ++i) {
    cube.positions.emplace_back(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1);
  }
  cube.triangles = {0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5, 2, 6, 7,
                    2, 7, 3, 0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6};
  return cube;
}

Mesh Hexagon() {
  Mesh mesh;
  mesh.positions.emplace_back(0, 0, 0);
  for (uint32_t i = 0; i < 6; ++i) {
    const double angle = M_PI / 3 * i;
    mesh.positions.emplace_back(std::cos(angle), 0.6 * std::sin(angle), 0);
    for (const uint32_t corner : {0u, 1 + i, 1 + (i + 1) % 6}) mesh.triangles.push_back(corner);
  }
  return mesh;
}

// The truth: the sum of the fronts, in double, and how large they are together.
struct Fronts {
  double irradiance = 0, solid_angle = 0;
};

Fronts SumFronts(const SampledLight& light, const Vec3d& point, const Vec3d& normal) {
  Fronts sum;
  for (TriangleLight<double> triangle : light.mesh->triangles) {
    triangle.corner += light.place - point;
    const bool front = (triangle.corner ^ (triangle.edge_x % triangle.edge_y)) < 0;
    if (!front && !light.two_sided) continue;
    sum.irradiance += std::max(Irradiance(triangle, normal), 0.0);
    sum.solid_angle += SolidAngle(triangle);
  }
  return sum;
}

TEST_CASE("the irradiance of a convex mesh is the sum of its fronts'") {
  const Mesh ball = MakeMesh(Icosphere{.center = {0.1, -0.2, 0.3}, .subdivisions = 0});
  const std::pair<SampledLight, bool> lights[] = {{Prepare(ball), true},
                                                  {Prepare(Hexagon()), true},
                                                  {Prepare(Hexagon(), true), true},
                                                  {Prepare(OpenCube()), false}};
  std::mt19937 random(8);
  std::normal_distribution<double> gauss;
  const auto draw = [&] { return Vec3d(gauss(random), gauss(random), gauss(random)); };
  for (const auto& item : lights) {
    const SampledLight& light = item.first;
    CHECK(!light.mesh->outline.edges.empty() == item.second);
    HitBatch hits;
    Surface surface;
    std::vector<Fronts> expected;
    hits.count = kBatchCapacity;
    for (size_t i = 0; i < hits.count; ++i) {
      // From inside to far away, and surfaces that turn towards the light, or anywhere.
      const Vec3d point = draw() * std::pow(10.0, static_cast<double>(i % 32) / 16 - 0.5);
      const Vec3d normal = (i % 2 == 0 ? draw() : draw() * 0.5 - point.normalized()).normalized();
      const Vec3f rounded(normal);
      for (int c = 0; c < 3; ++c) {
        (c == 0 ? hits.position.x : c == 1 ? hits.position.y : hits.position.z)[i] = point[c];
        (c == 0 ? surface.normal.x : c == 1 ? surface.normal.y : surface.normal.z)[i] = rounded[c];
      }
      expected.push_back(SumFronts(light, point, Vec3d(rounded)));
    }
    ForEachTarget([&](Target) {
      Soa3<float> irradiance;
      LightIrradiance(light, hits, surface, &irradiance);
      for (size_t i = 0; i < hits.count; ++i) {
        const Vec3d point(hits.position.x[i], hits.position.y[i], hits.position.z[i]);
        const double size = light.radius / std::max((light.place - point).length(), light.radius);
        const double off = std::abs(double{irradiance.x[i]} - expected[i].irradiance);
        CAPTURE(i, irradiance.x[i], expected[i].irradiance, expected[i].solid_angle);
        // Float places a corner within 1e-7 of its distance, which an edge-on polygon magnifies:
        // measured up to 1.3e-5.
        REQUIRE(off <= 2e-5 * (expected[i].solid_angle + size * size));
      }
    });
  }
}

SampledLight Prepared(decltype(Light::kind) kind) {
  Light light{.kind = std::move(kind)};
  KeptTables none;
  return PrepareSampledLight(light, Vec3d(0, 0, 0), &none);
}

// Of shadow rays, whose directions are rounded to float: they end on the light nevertheless, and
// where there is no end to be refined none is made.
TEST_CASE("shadow rays end on their lights to the roundings of double") {
  const Vec3d at(1.1, 2.3, -3.7), facing = Vec3d(-0.3, -0.8, 1).normalized();
  RectangleAreaLight rectangle{.center = at, .facing = facing, .width = 3};
  DiskAreaLight disk{.center = at, .facing = facing};
  SphereAreaLight sphere{.center = at, .radius = 0.7};
  Mesh triangle{
      .positions = {at, at + facing.cross(Vec3d(1, 0, 0)), at + facing.cross(Vec3d(0, 1, 0))},
      .triangles = {0, 1, 2}};
  MeshAreaLight mesh{.mesh = std::make_shared<const Mesh>(triangle), .two_sided = true};
  const UnitPoints points = Points();
  ForEachTarget([&](Target) {
    for (const decltype(Light::kind)& kind :
         {decltype(Light::kind)(rectangle), decltype(Light::kind)(disk),
          decltype(Light::kind)(sphere), decltype(Light::kind)(mesh)}) {
      const SampledLight light = Prepared(kind);
      // In front, far away, and edge-on.
      for (const Vec3d& point : {Vec3d(0.2, 0.1, 0.3), at + facing * 1e5 + Vec3d(3, 1, 2),
                                 at + facing * 0.01 + facing.cross(Vec3d(1, 0, 0)) * 5}) {
        CAPTURE(kind.index(), (point - at).length());
        const HitBatch hits = Hits(point);
        LightDirections directions;
        SampleLight(light, hits, points, &directions);
        AlignedArray<double> ends(kBatchCapacity);
        for (size_t i = 0; i < hits.count; ++i) ends[i] = i % 7 == 0 ? 0 : directions.distance[i];
        FindEnds(light, hits, directions, &ends);
        const Soa3<float>& l = directions.to_light;
        // A few roundings of the coordinates, of the point and of the offset.
        const double bound = 16 * 0x1p-53 * (point.length() + at.length() + (point - at).length());
        size_t found = 0;
        for (size_t i = 0; i < hits.count; ++i) {
          if (i % 7 == 0 || !(directions.distance[i] > 0)) {
            REQUIRE(ends[i] == 0);
            continue;
          }
          ++found;
          const Vec3d end = point + Vec3d(l.x[i], l.y[i], l.z[i]) * ends[i];
          const bool is_sphere = light.form == SampledForm::kSphere;
          // Where a float direction passes by the sphere the nearest point of its line counts.
          const double off = is_sphere ? (end - at).length() - 0.7 : (end - at).dot(facing);
          const double beside = is_sphere ? 1e-6 * (point - at).length() : 0;
          REQUIRE(off >= -bound - beside);
          REQUIRE(off <= bound + beside);
          // The same end, but for the rounding of the distance.
          const double towards = std::abs(Vec3d(l.x[i], l.y[i], l.z[i]).dot(facing));
          const double scale = is_sphere ? 1e-2 : 1e-5 / std::min(towards, 1.0);
          REQUIRE(std::abs(ends[i] / double{directions.distance[i]} - 1) <= scale);
        }
        CHECK(found > 300);
      }
    }
  });
}

}  // namespace
}  // namespace nacre
