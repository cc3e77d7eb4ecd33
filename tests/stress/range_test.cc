// SPDX-License-Identifier: Apache-2.0
// tests/stress/range_test.cc: single points at the ends of the number range that the fuzz found,
// each by itself.
#include <cmath>

#include "catch.h"
#include "scene/material.h"
#include "shading/shade.h"
#include "targets.h"

namespace nacre {
namespace {

struct Point {
  Vec3d normal, to_light, to_view;
  double distance;  // of the light, whose intensity falls off with its square
};

// What one hit reflects of a light.
Vec3d Reflect(const Material& material, const Rgb& color, const Point& point, bool specular) {
  HitBatch hits;
  hits.count = 1;
  const auto set = [](const Vec3d& v, Soa3<double>* to) {
    to->x[0] = v.x;
    to->y[0] = v.y;
    to->z[0] = v.z;
  };
  set(point.to_light * -point.distance, &hits.position);
  set(point.normal, &hits.normal);
  set(point.to_view, &hits.to_view);
  const ShadingLight light{.color = color};
  Surface surface;
  LightBatch batch;
  ReflectedRadiance radiance;
  PrepareSurface(hits, &surface);
  EvaluateLight(light, hits, surface, &batch);
  REQUIRE(batch.irradiance[0] > 0);
  ShadeScratch scratch;
  const ShadingMaterial prepared = PrepareMaterial(material);
  PrepareRun(prepared, 0, 1, &surface);
  ShadeRun({{prepared, hits, surface, 0, 1}, light, &batch, &radiance}, &scratch);
  const Soa3<float>& part = specular ? radiance.specular : radiance.diffuse;
  return {part.x[0], part.y[0], part.z[0]};
}

Material MetallicRoughness(const Rgb& color, double metallic, double roughness) {
  Material material;
  material.model =
      MetallicRoughnessMaterial{.base_color = color, .metallic = metallic, .roughness = roughness};
  return material;
}

TEST_CASE("light from behind a limb is not negative") {
  // Opposed light and viewer: 1 - v.h is 1, and rounds to more.
  const Vec3d to_light = Vec3d(1e-4, 0.876, -0.482).normalized();
  const Material material = MetallicRoughness(Rgb(1, 1, 1), 0, 0.5);
  ForEachTarget([&](Target) {
    for (int i = 0; i < 1000; ++i) {
      const Vec3d l = (to_light + Vec3d(0, 1e-4 * i, 0)).normalized();
      const Vec3d diffuse = Reflect(material, Rgb(1, 1, 1), {{1, 0, 0}, l, -l, 1}, false);
      REQUIRE(diffuse.x >= 0);
    }
  });
}

TEST_CASE("what float cannot hold is not NaN") {
  const double smoothest = 0x1.001p-20;  // just above the limit of delta lobes
  const Vec3d n(0, 1, 0);
  ForEachTarget([&](Target) {
    // A masking term beyond float's range, where the lobe itself is 0: h lies below the surface.
    const Vec3d low(std::sqrt(1 - 1e-16), 1e-8, 0);
    const Vec3d below = Vec3d(-0.6, -0.8, 0);
    const Vec3d dark = Reflect(MetallicRoughness(Rgb(1, 1, 1), 0, smoothest), Rgb(1, 1, 1),
                               {n, low, below, 1e-18}, true);
    CHECK(dark == Vec3d(0, 0, 0));
    // A lobe beyond float's range under a light that has no green, and of a metal without blue.
    const Vec3d red = Reflect(MetallicRoughness(Rgb(1, 1, 0), 1, smoothest), Rgb(1, 0, 1),
                              {n, n, n, 1e-15}, true);
    CHECK(red.x > 1e38);
    CHECK(red.y == 0);
    CHECK(red.z == 0);
  });
}

}  // namespace
}  // namespace nacre
