// SPDX-License-Identifier: Apache-2.0
// tests/render/fast_area_test.cc: area lights in their fast mode, linearly transformed cosines:
// off from samples by about what the plan tells, and only where they say.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <memory>

#include "catch.h"
#include "render/fast_pictures.h"
#include "render/render.h"
#include "scene/light_shapes.h"
#include "scene/sphere_mesh.h"
#include "targets.h"

namespace nacre {
namespace {

RectangleAreaLight Window() {
  RectangleAreaLight rectangle;
  rectangle.center = Vec3d(2, 1.5, 2);
  rectangle.facing = Vec3d(-2, -1.5, -2);
  rectangle.width = 2;
  rectangle.height = 1;
  rectangle.up = Vec3d(0, 1, 0);
  rectangle.radiance = Rgb(5, 4, 3);
  rectangle.visible = false;
  return rectangle;
}

MeshAreaLight MeshLight(Mesh mesh) {
  return {.mesh = std::make_shared<const Mesh>(std::move(mesh)),
          .radiance = Rgb(5, 4, 3),
          .visible = false};
}

MeshAreaLight TwoTriangles(const RectangleAreaLight& rectangle) {
  const auto [c, x, y] = CornersOf(rectangle);
  Mesh mesh;
  mesh.positions = {c, c + x, c + x + y, c + y};
  mesh.triangles = {0, 1, 2, 0, 2, 3};
  return MeshLight(std::move(mesh));
}

TEST_CASE("transformed cosines are off from samples by about what the plan tells") {
  const Mesh ball = MakeMesh(Icosphere{.center = {2, 1.5, 2}, .radius = 0.7, .subdivisions = 0});
  for (const LightKind& light : {LightKind(Window()), LightKind(MeshLight(ball))}) {
    for (const double roughness : {0.15, 0.4, 0.8}) {
      CheckTold(light, roughness);
    }
  }
}

TEST_CASE("a rectangle and its triangles are the same light to transformed cosines") {
  for (const double roughness : {0.2, 0.7}) {
    const Scene whole = FastSphere(roughness, Window());
    const Scene halves = FastSphere(roughness, TwoTriangles(Window()));
    ForEachTarget([&](Target) {
      const Image a = RenderFast(whole), b = RenderFast(halves);
      double largest = 0;
      for (size_t i = 0; i < a.data.pixel_count(); ++i) {
        largest = std::max(largest, At(a, "specular.R", i));
        // Sums of the same edges, and one more, which cancels, in float.
        CHECK(std::abs(At(a, "specular.R", i) - At(b, "specular.R", i)) <= 2e-5);
      }
      CHECK(largest > 0.05);
    });
  }
}

TEST_CASE("a solid's outline is the sum of its fronts to transformed cosines") {
  const Mesh solid = MakeMesh(Icosphere{.center = {2, 1, 1.5}, .radius = 0.7, .subdivisions = 0});
  // One face cut in two at the middle of an edge, where its neighbour is not: no closed surface.
  Mesh cut = solid;
  const uint32_t a = cut.triangles[0], b = cut.triangles[1], c = cut.triangles[2];
  const auto middle = static_cast<uint32_t>(cut.positions.size());
  cut.positions.push_back((cut.positions[a] + cut.positions[b]) / 2);
  cut.normals.clear();
  cut.uvs.clear();
  cut.triangles[1] = middle;
  for (const uint32_t i : {middle, b, c}) cut.triangles.push_back(i);
  for (const double roughness : {0.2, 0.7}) {
    const Scene whole = FastSphere(roughness, MeshLight(solid));
    const Scene pieces = FastSphere(roughness, MeshLight(cut));
    ForEachTarget([&](Target) {
      const Image x = RenderFast(whole), y = RenderFast(pieces);
      double largest = 0;
      for (size_t i = 0; i < x.data.pixel_count(); ++i) {
        largest = std::max(largest, At(x, "specular.R", i));
        // Ten fronts' edges instead of those of the outline, in float.
        CHECK(std::abs(At(x, "specular.R", i) - At(y, "specular.R", i)) <= 1e-4);
      }
      CHECK(largest > 0.5);
    });
  }
}

TEST_CASE("a light all around a surface fills all of its lobe") {
  // Inside a ball that shines inwards all is as under a constant sky.
  Mesh room = MakeMesh(Icosphere{.center = {0, 0, 0}, .radius = 30, .subdivisions = 0});
  for (size_t i = 0; i < room.triangles.size(); i += 3) {
    std::swap(room.triangles[i + 1], room.triangles[i + 2]);
  }
  const Scene scene = FastSphere(0.5, MeshLight(room));
  // Its fronts hide one another from points outside: it has no closed form, and so no fast mode.
  CHECK(MakePlan(scene, {}).fast_lights.empty());
  RectangleAreaLight wall = Window();
  wall.center = Vec3d(0, 0, 1.01);
  wall.facing = Vec3d(0, 0, -1);
  wall.width = wall.height = 4000;
  Scene before = FastSphere(0.3, wall);
  before.camera.position = Vec3d(0, 0, 1.005);  // between both
  before.camera.height = 0.02;
  before.image.width = before.image.height = 3;
  const Image image = RenderFast(before);
  // The sphere's top sees nothing but the wall, and F = 0.9 but for some thousandths.
  CHECK(std::abs(At(image, "specular.R", 4) / 5 - 0.9) < 0.01);
}

TEST_CASE("what may lie in shadow, and narrow lobes, are sampled") {
  Scene scene = FastSphere(0.5, Window());
  scene.spheres.push_back({Vec3d(0.8, 0.9, 0.9), 0.3, {0}});
  Scene sampled = scene;
  sampled.lights[0].fast = false;
  const auto same = [](const Image& a, const Image& b) {
    const auto& x = a.Find("R")->samples;
    return std::memcmp(x.data(), b.Find("R")->samples.data(), 4 * x.size()) == 0;
  };
  const std::string text = ExplainPlan(MakePlan(scene, {}), nullptr);
  CHECK(text.find("by linearly transformed cosines where all of the light is") !=
        std::string::npos);
  scene.lights[0].shadows = sampled.lights[0].shadows = false;
  CHECK_FALSE(same(RenderFast(scene), RenderFast(sampled)));
  Scene narrow = FastSphere(0.05, Window());
  CHECK(MakePlan(narrow, {}).fast_lights.empty());
  sampled = narrow;
  sampled.lights[0].fast = false;
  CHECK(same(RenderFast(narrow), RenderFast(sampled)));
}

}  // namespace
}  // namespace nacre
