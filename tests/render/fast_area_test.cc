// SPDX-License-Identifier: Apache-2.0
// tests/render/fast_area_test.cc: area lights in their fast mode, linearly transformed cosines:
// off from samples by about what the plan tells, and only where they say.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <memory>

#include "catch.h"
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

Scene OneSphere(double roughness, decltype(Light::kind) light, bool fast = true) {
  Scene scene;
  scene.materials.emplace_back().model = MetallicRoughnessMaterial{
      .base_color = Rgb(0.9, 0.6, 0.3), .metallic = 1, .roughness = roughness};
  scene.spheres.push_back({Vec3d(0, 0, 0), 1, {0}});
  scene.camera.projection = Projection::kOrthographic;
  scene.camera.height = 2.2;
  scene.image.width = scene.image.height = 32;
  scene.image.spp = 1;
  Light& added = scene.lights.emplace_back();
  added.name = "lamp";
  added.fast = fast;
  added.kind = std::move(light);
  return scene;
}

Image Render(const Scene& scene) {
  RenderSettings settings;
  settings.layers = {"specular", "diffuse"};
  return RenderImage(scene, settings);
}

double At(const Image& image, const char* channel, size_t i) {
  return image.Find(channel)->samples[i];
}

// Of the specular layer's red, over its mean, where `b` shows the highlight.
double RmsBetween(const Image& a, const Image& b) {
  const std::vector<float>& red = b.Find("specular.R")->samples;
  const double most = *std::max_element(red.begin(), red.end());
  double squares = 0, mean = 0, count = 0;
  for (size_t i = 0; i < a.data.pixel_count(); ++i) {
    if (At(a, "A", i) < 1 || At(b, "specular.R", i) < most / 4) continue;
    squares += std::pow(At(a, "specular.R", i) - At(b, "specular.R", i), 2);
    mean += At(b, "specular.R", i);
    count += 1;
  }
  return std::sqrt(squares / count) / (mean / count);
}

TEST_CASE("transformed cosines are off from samples by about what the plan tells") {
  const Mesh ball = MakeMesh(Icosphere{.center = {2, 1.5, 2}, .radius = 0.7, .subdivisions = 0});
  for (const decltype(Light::kind)& light :
       {decltype(Light::kind)(Window()), decltype(Light::kind)(MeshLight(ball))}) {
    for (const double roughness : {0.15, 0.4, 0.8}) {
      const RenderPlan plan = MakePlan(OneSphere(roughness, light), {});
      REQUIRE(plan.fast_lights.size() == 1);
      const FastLight& told = plan.fast_lights[0];
      CHECK(told.light == "lamp");
      CHECK(told.method == "linearly transformed cosines");
      CHECK(told.points == 48);
      CHECK(told.rms > 1e-3);  // it is an approximation
      CHECK(told.rms < 0.25);
      Scene fast = OneSphere(roughness, light), sampled = OneSphere(roughness, light, false);
      CHECK(MakePlan(sampled, {}).fast_lights.empty());
      fast.image.spp = sampled.image.spp = 256;
      const double rms = RmsBetween(Render(fast), Render(sampled));
      CAPTURE(roughness, rms, told.rms, told.worst);
      // The picture has other points, all of one distance, and some noise.
      CHECK(rms <= 2 * told.rms + 0.02);
      CHECK(rms > 1e-4);
    }
  }
}

TEST_CASE("a rectangle and its triangles are the same light to transformed cosines") {
  for (const double roughness : {0.2, 0.7}) {
    const Scene whole = OneSphere(roughness, Window());
    const Scene halves = OneSphere(roughness, TwoTriangles(Window()));
    ForEachTarget([&](Target) {
      const Image a = Render(whole), b = Render(halves);
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
    const Scene whole = OneSphere(roughness, MeshLight(solid));
    const Scene pieces = OneSphere(roughness, MeshLight(cut));
    ForEachTarget([&](Target) {
      const Image x = Render(whole), y = Render(pieces);
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
  const Scene scene = OneSphere(0.5, MeshLight(room));
  // Its fronts hide one another from points outside: it has no closed form, and so no fast mode.
  CHECK(MakePlan(scene, {}).fast_lights.empty());
  RectangleAreaLight wall = Window();
  wall.center = Vec3d(0, 0, 1.01);
  wall.facing = Vec3d(0, 0, -1);
  wall.width = wall.height = 4000;
  Scene before = OneSphere(0.3, wall);
  before.camera.position = Vec3d(0, 0, 1.005);  // between both
  before.camera.height = 0.02;
  before.image.width = before.image.height = 3;
  const Image image = Render(before);
  // The sphere's top sees nothing but the wall, and F = 0.9 but for some thousandths.
  CHECK(std::abs(At(image, "specular.R", 4) / 5 - 0.9) < 0.01);
}

TEST_CASE("what may lie in shadow, and narrow lobes, are sampled") {
  Scene scene = OneSphere(0.5, Window());
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
  CHECK_FALSE(same(Render(scene), Render(sampled)));
  Scene narrow = OneSphere(0.05, Window());
  CHECK(MakePlan(narrow, {}).fast_lights.empty());
  sampled = narrow;
  sampled.lights[0].fast = false;
  CHECK(same(Render(narrow), Render(sampled)));
}

}  // namespace
}  // namespace nacre
