// SPDX-License-Identifier: Apache-2.0
// Rays through meshes with holes against the scalar test of every triangle and a checker's formula.
#include "visibility/cut_out.h"

#include <cmath>
#include <random>

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
  Texture texture;
  texture.image = {0};
  texture.sampling.filter = TextureFilter::kNearest;
  scene->textures.push_back(texture);
}

// Spheres, a mesh without holes and two with them, of random triangles in [-1, 1]^3.
Scene RandomScene(unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> in(-1, 1);
  Scene scene;
  AddChecker(&scene);
  scene.materials.resize(2);
  scene.materials[1].opacity_map = {0};
  for (int i = 0; i < 3; ++i) {
    scene.spheres.push_back({Vec3d(in(random), in(random), in(random)), 0.2, {0}});
  }
  for (const uint32_t material : {1u, 0u, 1u}) {
    Mesh mesh;
    mesh.material = {material};
    for (uint32_t i = 0; i < 60; ++i) {
      mesh.positions.emplace_back(in(random), in(random), in(random));
      mesh.uvs.emplace_back(in(random), in(random));
      mesh.triangles.push_back(i);
    }
    scene.meshes.push_back(mesh);
  }
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
  scene.materials[1].opacity_cutoff = 0;  // all is there
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

}  // namespace
}  // namespace nacre
