// SPDX-License-Identifier: Apache-2.0
// Rays through meshes with holes against the scalar test of every triangle and a checker's formula.
#include "visibility/cut_out.h"

#include <array>
#include <cmath>
#include <optional>
#include <random>
#include <vector>

#include "catch.h"
#include "rays.h"
#include "targets.h"

namespace nacre {
namespace {

constexpr int kTexels = 8;

bool IsSolid(const Vec2d& uv) {
  const auto texel = [](double x) { return static_cast<int>(std::floor(x * kTexels)); };
  return ((texel(uv.x) + texel(uv.y)) & 1) == 0;
}

// A checker of kTexels x kTexels texels, repeated.
void AddChecker(Scene* scene) {
  std::vector<float> values;
  for (int y = 0; y < kTexels; ++y) {
    for (int x = 0; x < kTexels; ++x) values.push_back((x + y) % 2 == 0 ? 1.0f : 0.0f);
  }
  scene->images.push_back({"checker", std::make_shared<const MipChain>(
                                          MakeMipChain(kTexels, kTexels, 1, std::move(values)))});
  Texture texture{.image = {0}};
  texture.sampling.filter = TextureFilter::kNearest;
  scene->textures.push_back(texture);
}

// The first and the last mesh with holes.
Scene RandomScene(unsigned seed) {
  Scene scene = RandomShapes(seed);
  AddChecker(&scene);
  scene.materials[1].opacity_map = {0};
  return scene;
}

// All hits of the ray, in holes or not, by the scalar tests.
template <class Body>
void ForEachHit(const Scene& scene, const Ray& ray, const Body& body) {
  uint32_t primitive = 0;
  for (const Sphere& sphere : scene.spheres) {
    const auto hit =
        TestSphere(sphere.center - ray.origin, ray.direction, sphere.radius, TargetProducts());
    if (hit.hit) body(primitive, hit.t, true);
    ++primitive;
  }
  for (const Mesh& mesh : scene.meshes) {
    for (size_t i = 0; i < mesh.triangles.size(); i += 3, ++primitive) {
      const auto at = [&](size_t k) { return mesh.positions[mesh.triangles[i + k]] - ray.origin; };
      const auto hit = TestTriangle(at(0), at(1), at(2), ray.direction, MakeShear(ray.direction),
                                    TargetProducts());
      if (!hit.hit) continue;
      const Vec2d uv = mesh.uvs[mesh.triangles[i]] * hit.weights.x +
                       mesh.uvs[mesh.triangles[i + 1]] * hit.weights.y +
                       mesh.uvs[mesh.triangles[i + 2]] * hit.weights.z;
      body(primitive, hit.t, mesh.material == MaterialId{0} || IsSolid(uv));
    }
  }
}

TEST_CASE("rays pass through holes to what is behind, and shadow rays to their light") {
  for (const unsigned seed : {1u, 2u}) {
    const Scene scene = RandomScene(seed);
    std::mt19937 random(seed + 10);
    std::uniform_real_distribution<double> in(-1, 1);
    std::vector<Ray> rays(3000);
    std::vector<ShadowRay> shadows;
    for (Ray& ray : rays) {
      ray.origin = Vec3d(in(random), in(random), in(random)) * 0.8;
      ray.direction = Vec3d(in(random), in(random), in(random));
      shadows.push_back({ray, 1.0, kNoPrimitive});
    }
    ForEachTarget([&](Target) {
      const Intersector intersector(scene, Vec3d(0));
      std::vector<Hit> expected(rays.size());
      std::vector<bool> occluded(rays.size());
      size_t passed = 0;
      for (size_t i = 0; i < rays.size(); ++i) {
        double nearest = std::numeric_limits<double>::infinity();
        ForEachHit(scene, rays[i], [&](uint32_t primitive, double t, bool is_there) {
          nearest = std::min(nearest, t);
          if (!is_there) return;
          if (t < expected[i].t) expected[i] = {primitive, t};
          if (t < 1) occluded[i] = true;
        });
        passed += nearest < expected[i].t ? 1 : 0;
      }
      CHECK(passed > rays.size() / 5);
      CHECK(Trace(intersector, rays) == expected);
      CHECK(Trace(intersector, rays, 7) == expected);  // other packets
      CHECK(TraceShadows(intersector, shadows) == occluded);
    });
  }
}

TEST_CASE("what cuts nothing away costs nothing") {
  Scene scene = RandomScene(3);
  const auto count = [&] { return MakeTraceGeometry(scene, Vec3d(0)).cut_outs.size(); };
  CHECK(count() == 2);
  scene.materials[1].opacity_cutoff = 0;  // no holes
  CHECK(count() == 0);
  scene.materials[1].opacity_map = {};
  scene.materials[1].opacity_cutoff = 0.5;
  CHECK(count() == 0);
  scene.meshes[1].opacities.assign(scene.meshes[1].positions.size(), 0.5f);
  CHECK(count() == 0);
  scene.meshes[1].opacities[7] = 0.25f;
  const TraceGeometry geometry = MakeTraceGeometry(scene, Vec3d(0));
  REQUIRE(geometry.cut_outs.size() == 1);
  CHECK(FindCutOut(geometry.cut_outs, 19) == nullptr);
  CHECK(FindCutOut(geometry.cut_outs, 20) == &geometry.cut_outs[0]);
  CHECK(FindCutOut(geometry.cut_outs, 39) == &geometry.cut_outs[0]);
  CHECK(FindCutOut(geometry.cut_outs, 40) == nullptr);
}

// Weights as triangle tests compute them: in [0, 1], with a sum of 1 up to rounding.
std::vector<std::array<double, 3>> RoundedWeights(unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> in(0, 1);
  std::vector<std::array<double, 3>> weights = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  for (int i = 0; i < 2000; ++i) {
    const Vec3d w = Vec3d(in(random), in(random), in(random));
    const double scale = 1 / (w.x + w.y + w.z);
    weights.push_back({w.x * scale, w.y * scale, w.z * scale});
  }
  return weights;
}

// Two triangles, (0, 1, 2) with the given opacities and (3, 4, 5) without.
std::optional<CutOut> CutByVertices(const std::array<float, 3>& opacities, double cutoff) {
  Scene scene = RandomScene(4);
  scene.materials[1].opacity_map = {};
  scene.materials[1].opacity_cutoff = cutoff;
  Mesh& mesh = scene.meshes[0];
  mesh.positions.resize(6);
  mesh.uvs.resize(6);
  mesh.triangles.resize(6);
  mesh.opacities = {opacities[0], opacities[1], opacities[2], 0, 0, 0};
  std::optional<CutOut> made = MakeCutOut(scene, mesh);
  if (made) MoveCutOut(Vec3d(0), &*made);
  return made;
}

TEST_CASE("a triangle whose corners have the cutoff's opacity has no holes") {
  for (const float opacity : {1.0f, 0.8f, 0.7f, 0.3f, 1.0f / 255, 254.0f / 255}) {
    const auto made = CutByVertices({opacity, opacity, opacity}, double{opacity});
    REQUIRE(made.has_value());
    size_t holes = 0;
    for (const auto& weights : RoundedWeights(1)) {
      holes += IsSolidAt(*made, {}, {0, 1, 2}, weights) ? 0 : 1;
    }
    CAPTURE(opacity);
    CHECK(holes == 0);
  }
}

TEST_CASE("a triangle whose corners are below the cutoff, by the least, is not there") {
  for (const float opacity : {1.0f, 0.8f, 0.7f, 0.3f, 1.0f / 255, 254.0f / 255}) {
    const double cutoff = std::nextafter(double{opacity}, 2.0);
    const auto made = CutByVertices({opacity, opacity, opacity}, cutoff);
    REQUIRE(made.has_value());
    size_t there = 0;
    for (const auto& weights : RoundedWeights(2)) {
      there += IsSolidAt(*made, {}, {0, 1, 2}, weights) ? 1 : 0;
    }
    CAPTURE(opacity);
    CHECK(there == 0);
  }
}

TEST_CASE("between corners above and below the cutoff holes begin where the opacity falls to it") {
  // Each corner in turn is opaque, so that every weight counts.
  for (size_t k = 0; k < 3; ++k) {
    std::array<float, 3> opacities = {0.25f, 0.25f, 0.25f};
    opacities[k] = 1;
    const auto made = CutByVertices(opacities, 0.5);
    REQUIRE(made.has_value());
    for (const auto& weights : RoundedWeights(3)) {
      const double opacity = 0.25 + 0.75 * weights[k];
      if (std::abs(opacity - 0.5) < 1e-15) continue;  // roundings of products and sums
      CHECK(IsSolidAt(*made, {}, {0, 1, 2}, weights) == (opacity > 0.5));
    }
  }
}

}  // namespace
}  // namespace nacre
