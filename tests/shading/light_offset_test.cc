// SPDX-License-Identifier: Apache-2.0
// tests/shading/light_offset_test.cc: lights that are found from the normals of hits on spheres.
#include <cmath>
#include <random>

#include "catch.h"
#include "scene/material.h"
#include "shading/light_batch.h"
#include "shading/shade.h"
#include "targets.h"

namespace nacre {
namespace {

constexpr size_t kHitsOnSpheres = 1000;  // not a multiple of any vector

Light PointAt(const Vec3d& position) {
  return {.kind = PointLight{.position = position, .intensity = {1, 1, 1}}};
}

Vec3d RandomUnit(std::mt19937* random) {
  std::normal_distribution<double> normal;
  return Vec3d{normal(*random), normal(*random), normal(*random)}.normalized();
}

// Hits with their outward normals, hit i on sphere i % spheres.size().
struct HitsOnSpheres {
  HitBatch batch;
  Surface surface;

  HitsOnSpheres(const std::vector<Sphere>& spheres, const Vec3d& camera, std::mt19937* random) {
    batch.count = kHitsOnSpheres;
    batch.one_primitive = spheres.size() == 1;
    for (size_t i = 0; i < kHitsOnSpheres; ++i) {
      const Sphere& sphere = spheres[i % spheres.size()];
      const Vec3d n = RandomUnit(random);
      const Vec3d position = (sphere.center - camera) + n * sphere.radius;
      batch.primitive[i] = static_cast<uint32_t>(i % spheres.size());
      batch.position.x[i] = position.x;
      batch.position.y[i] = position.y;
      batch.position.z[i] = position.z;
      batch.normal.x[i] = n.x;
      batch.normal.y[i] = n.y;
      batch.normal.z[i] = n.z;
      batch.to_view.z[i] = 1;
    }
    PrepareSurface(batch, &surface);
  }
};

// In units of 2^-24. The offset is off by 3 1/3 of its length (OffsetFromSpheres, targets without
// fused products). Its square is off by twice that and by 3 roundings, the reciprocal of the
// root, at 2 of its own, by half; the direction is a product with that, rounded; the irradiance,
// the product of two with the light's own scale, adds two roundings.
constexpr double kOffsetError = 10.0 / 3;
constexpr double kInverseError = kOffsetError + 1.5 + 2;
constexpr double kDirectionError = kOffsetError + kInverseError + 1;
constexpr double kIrradianceError = 2 * kInverseError + 2;

void CheckLight(const Vec3d& light, const HitsOnSpheres& hits, const LightBatch& got) {
  double direction_error = 0, irradiance_error = 0;
  for (size_t i = 0; i < kHitsOnSpheres; ++i) {
    const HitBatch& b = hits.batch;
    const Vec3d offset = light - Vec3d(b.position.x[i], b.position.y[i], b.position.z[i]);
    const Vec3d n(b.normal.x[i], b.normal.y[i], b.normal.z[i]);
    const Vec3d to_light = DirectionToLight(got, i);
    direction_error = std::max(direction_error, (to_light - offset.normalized()).length());
    if ((offset.normalized() ^ n) < 1e-6) continue;
    const double expected = 1 / offset.length2();
    irradiance_error = std::max(irradiance_error, std::abs(got.irradiance[i] / expected - 1));
  }
  CHECK(direction_error <= kDirectionError * 0x1p-24);
  CHECK(irradiance_error <= kIrradianceError * 0x1p-24);
}

TEST_CASE("lights found from normals are where the positions say, at all scales") {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> uniform(0, 1);
  int checked = 0;
  for (int round = 0; round < 60; ++round) {
    const double radius = std::pow(10.0, -6 + 12 * uniform(random));
    const double away = radius * std::pow(10.0, 6 * uniform(random));
    // The nearest that is allowed, at first.
    const double apart = radius * kFarRadii * (round < 20 ? 1 + 1e-9 : 1 + 1e3 * uniform(random));
    const Vec3d camera = RandomUnit(&random) * away;
    const Sphere sphere{
        .center = camera + RandomUnit(&random) * away, .radius = radius, .material = {}};
    const Vec3d position = sphere.center + RandomUnit(&random) * apart;
    ShadingLight light = PrepareLight(PointAt(position), camera);
    // Far from the origin its coordinates are rounded, and it may have come nearer.
    if (!OffsetFromSpheres({&sphere, 1}, camera, &light)) continue;
    ++checked;
    const HitsOnSpheres hits({sphere}, camera, &random);
    ForEachTarget([&](Target) {
      LightBatch got;
      EvaluateLight(light, hits.batch, hits.surface, &got);
      CheckLight(light.position, hits, got);
    });
  }
  CHECK(checked >= 40);  // all but those that begin at the limit
}

// What a material reflects of the light, in place or evaluated ahead.
ReflectedRadiance ReflectFromSpheres(const ShadingLight& light, HitsOnSpheres* hits,
                                     bool in_place) {
  const Material material{.model = MetallicRoughnessMaterial{}};
  const ShadingMaterial prepared = PrepareMaterial(material);
  LightBatch evaluated;
  EvaluateLight(light, hits->batch, hits->surface, &evaluated);
  ShadeScratch scratch;
  ReflectedRadiance radiance;
  PrepareRun(prepared, 0, kHitsOnSpheres, &hits->surface);
  ShadeRun({{prepared, hits->batch, hits->surface, 0, kHitsOnSpheres},
            light,
            in_place ? nullptr : &evaluated,
            &radiance},
           &scratch);
  return radiance;
}

bool SameBits(const Soa3<float>& a, const Soa3<float>& b) {
  return std::equal(a.x.begin(), a.x.begin() + kHitsOnSpheres, b.x.begin()) &&
         std::equal(a.y.begin(), a.y.begin() + kHitsOnSpheres, b.y.begin()) &&
         std::equal(a.z.begin(), a.z.begin() + kHitsOnSpheres, b.z.begin());
}

TEST_CASE("lights found from normals give the same bits whichever hits share a batch") {
  const std::vector<Sphere> spheres{{.center = {0, 0, -6}, .radius = 1, .material = {}},
                                    {.center = {2, 1, -7}, .radius = 0.5, .material = {}},
                                    {.center = {-3, 0, -5}, .radius = 1.25, .material = {}}};
  const Vec3d camera(0.1, 0.2, 0.3);
  ShadingLight light = PrepareLight(PointAt({3, 4, 2}), camera);
  REQUIRE(OffsetFromSpheres(spheres, camera, &light));
  ForEachTarget([&](Target) {
    std::mt19937 random(11);
    HitsOnSpheres mixed(spheres, camera, &random);
    const ReflectedRadiance ahead = ReflectFromSpheres(light, &mixed, false);
    const ReflectedRadiance here = ReflectFromSpheres(light, &mixed, true);
    CHECK(SameBits(ahead.diffuse, here.diffuse));
    CHECK(SameBits(ahead.specular, here.specular));
    // All hits on one of the spheres: as such, and as if they might not be.
    std::fill(mixed.batch.primitive.begin(), mixed.batch.primitive.end(), 2);
    const ReflectedRadiance unaware = ReflectFromSpheres(light, &mixed, true);
    CHECK_FALSE(SameBits(unaware.diffuse, here.diffuse));
    mixed.batch.one_primitive = true;
    for (const bool in_place : {false, true}) {
      const ReflectedRadiance one = ReflectFromSpheres(light, &mixed, in_place);
      CHECK(SameBits(one.diffuse, unaware.diffuse));
      CHECK(SameBits(one.specular, unaware.specular));
    }
  });
}

TEST_CASE("a directional light leaves the same bits in place and evaluated ahead") {
  Light sun{.kind = DirectionalLight{.direction_of_travel = {1, -2, -3}, .irradiance = {3, 2, 1}}};
  const ShadingLight light = PrepareLight(sun, {0, 0, 0});
  REQUIRE(EvaluatedInPlace(light));
  ForEachTarget([&](Target) {
    std::mt19937 random(12);
    HitsOnSpheres hits({{.center = {0, 0, -6}, .radius = 1, .material = {}}}, {0, 0, 0}, &random);
    const ReflectedRadiance ahead = ReflectFromSpheres(light, &hits, false);
    const ReflectedRadiance here = ReflectFromSpheres(light, &hits, true);
    CHECK(SameBits(ahead.sum, here.sum));
    CHECK(SameBits(ahead.diffuse, here.diffuse));
    CHECK(SameBits(ahead.specular, here.specular));
  });
}

TEST_CASE("positions are asked of lights that are near a sphere, or have no place") {
  const Sphere sphere{.center = {1, 2, 3}, .radius = 2, .material = {}};
  const auto from_normals = [&](const Light& light) {
    ShadingLight prepared = PrepareLight(light, {5, 5, 5});
    const bool filled = OffsetFromSpheres({&sphere, 1}, {5, 5, 5}, &prepared);
    CHECK(filled == !prepared.from_spheres.empty());
    return filled;
  };
  CHECK(from_normals(PointAt({1, 2, 3 + 8.001})));
  CHECK_FALSE(from_normals(PointAt({1, 2, 3 + 7.999})));
  CHECK_FALSE(from_normals(PointAt({1, 2, 3})));
  CHECK_FALSE(from_normals(Light{.kind = DirectionalLight{}}));
  ShadingLight none = PrepareLight(PointAt({9, 9, 9}), {0, 0, 0});
  CHECK_FALSE(OffsetFromSpheres({}, {0, 0, 0}, &none));
}

}  // namespace
}  // namespace nacre
