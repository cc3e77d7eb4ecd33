// SPDX-License-Identifier: Apache-2.0
// tests/render/mesh_lights_test.cc: pictures under lights made of triangles, against the lights
// that they are the same as, or come near to.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <memory>

#include "pictures.h"
#include "render/frame_plan.h"
#include "render/render.h"
#include "scene/sphere_mesh.h"

namespace nacre {
namespace {

Light MeshLightOf(Mesh mesh, bool two_sided = false, bool visible = false) {
  return Named("lamp", MeshAreaLight{.mesh = std::make_shared<const Mesh>(std::move(mesh)),
                                     .radiance = Rgb(5),
                                     .two_sided = two_sided,
                                     .visible = visible});
}

RectangleAreaLight Window() {
  return {.center = Vec3d(2, 1.5, 2),
          .facing = Vec3d(-2, -1.5, -2),
          .up = Vec3d(0, 1, 0),
          .width = 2,
          .height = 1,
          .radiance = Rgb(5),
          .visible = false};
}

// Moved by `offset`.
Mesh TwoTriangles(const RectangleAreaLight& rectangle, const Vec3d& offset = Vec3d(0)) {
  const auto [corner, x, y] = CornersOf(rectangle);
  const Vec3d c = corner + offset;
  return {.positions = {c, c + x, c + x + y, c + y}, .triangles = {0, 1, 2, 0, 2, 3}};
}

void Append(const Mesh& more, Mesh* mesh) {
  const auto first = static_cast<uint32_t>(mesh->positions.size());
  mesh->positions.insert(mesh->positions.end(), more.positions.begin(), more.positions.end());
  for (const uint32_t i : more.triangles) mesh->triangles.push_back(first + i);
}

Image Render(Scene scene, const Light& light, bool closed_forms = true) {
  scene.lights = {light};
  return RenderImage(scene, {.closed_forms = closed_forms});
}

std::vector<decltype(Material::model)> Models() {
  MetallicRoughnessMaterial metal{.metallic = 1, .roughness = 0.3};
  MetallicRoughnessMaterial plastic{.roughness = 0.05};
  MetallicRoughnessMaterial mirror = metal;
  mirror.roughness = 0;
  return {LambertMaterial{Rgb(0.7)}, metal, plastic, mirror, PhongMaterial{}};
}

TEST_CASE("two triangles are a rectangle, in closed form") {
  const Scene scene = OneSphere(LambertMaterial{Rgb(0.7)}, 48, 64);
  const Image rectangle = Render(scene, Named("lamp", Window()));
  const Image mesh = Render(scene, MeshLightOf(TwoTriangles(Window())));
  size_t lit = 0;
  for (size_t i = 0; i < mesh.data.pixel_count(); ++i) {
    if (mesh.Find("A")->samples[i] < 1) continue;
    const double expected = rectangle.Find("R")->samples[i], got = mesh.Find("R")->samples[i];
    if (expected > 0) ++lit;
    // A few roundings of the largest irradiances: near the horizon both have lost digits.
    REQUIRE(std::abs(got - expected) <= 1e-6 * std::max(expected, 0.1));
  }
  CHECK(lit > 200);
}

TEST_CASE("two triangles are a rectangle, sampled, whatever they shine on") {
  for (const bool two_sided : {false, true}) {
    RectangleAreaLight window = Window();
    window.two_sided = two_sided;
    for (const auto& model : Models()) {
      CAPTURE(model.index(), two_sided);
      const Scene scene = OneSphere(model, 48, 64);
      const Image rectangle = Render(scene, Named("lamp", window), false);
      CheckSameMean(Render(scene, MeshLightOf(TwoTriangles(window), two_sided), false), rectangle);
    }
  }
}

TEST_CASE("a light of triangles has the same mean in closed form and sampled") {
  const Mesh die = MakeMesh(Icosphere{.center = {1, 2, 2}, .radius = 0.7, .subdivisions = 0});
  for (const auto& model : Models()) {
    CAPTURE(model.index());
    const Scene scene = OneSphere(model, 48, 64);
    CheckSameMean(Render(scene, MeshLightOf(die), true), Render(scene, MeshLightOf(die), false));
  }
}

TEST_CASE("an icosphere comes to the sphere light as it refines") {
  const Scene scene = OneSphere(LambertMaterial{Rgb(0.7)}, 48, 64);
  SphereAreaLight sphere{
      .center = Vec3d(1, 2, 2), .radius = 0.7, .radiance = Rgb(5), .visible = false};
  const Image truth = Render(scene, Named("lamp", sphere));
  const double mean = MeanRed(truth).value;
  double last = 1;
  for (const int subdivisions : {0, 1, 2}) {
    const Mesh mesh =
        MakeMesh(Icosphere{.center = sphere.center, .radius = 0.7, .subdivisions = subdivisions});
    const Mean difference = MeanDifference(Render(scene, MeshLightOf(mesh)), truth);
    const double share = -difference.value / mean;  // faces lie within the sphere: always too dark
    CAPTURE(subdivisions, share, difference.error / mean);
    // Their distance from it, and so what they lack, is a quarter each time.
    CHECK(share > 0.2 * last);
    CHECK(share < 0.35 * last);
    last = share;
  }
}

TEST_CASE("what the light hides of itself does not shine") {
  const Scene scene = OneSphere(LambertMaterial{Rgb(0.7)}, 48, 64);
  const Vec3d behind = Vec3d(2, 1.5, 2).normalized() * 0.1;
  RectangleAreaLight smaller = Window();
  smaller.width = 1;
  smaller.height = 0.5;
  Mesh both = TwoTriangles(Window());
  Append(TwoTriangles(smaller, behind), &both);
  CheckSameMean(Render(scene, MeshLightOf(both)), Render(scene, Named("lamp", Window())));
}

TEST_CASE("the back of a light is dark unless both sides shine") {
  const Scene scene = OneSphere(MetallicRoughnessMaterial{}, 48, 64);
  RectangleAreaLight away = Window();
  away.facing = -away.facing;
  for (const bool closed_forms : {true, false}) {
    const Image dark = Render(scene, MeshLightOf(TwoTriangles(away)), closed_forms);
    for (const float red : dark.Find("R")->samples) REQUIRE(red == 0);
    CheckSameMean(Render(scene, MeshLightOf(TwoTriangles(away), true), closed_forms),
                  Render(scene, Named("lamp", Window()), closed_forms));
  }
}

TEST_CASE("the camera sees a visible light, which blocks others") {
  Scene scene = OneSphere(LambertMaterial{Rgb(0.7)}, 48, 64);
  RectangleAreaLight before;  // between the camera and the sphere's middle
  before.center = Vec3d(0, 0, 3);
  before.facing = Vec3d(0, 0, 1);
  before.up = Vec3d(0, 1, 0);
  before.width = before.height = 0.5;
  scene.image.spp = 1;
  const size_t middle = 24 * 48 + 24;
  const Image shown = Render(scene, MeshLightOf(TwoTriangles(before), false, true));
  CHECK(shown.Find("R")->samples[middle] == 5);
  const Image hidden = Render(scene, MeshLightOf(TwoTriangles(before)));
  CHECK(hidden.Find("R")->samples[middle] == 0);  // it shines the other way

  Light sun = Named("sun", DirectionalLight{.direction_of_travel = {0, 0, -1}});
  RectangleAreaLight aside = before;
  aside.center = Vec3d(0, 0, 12);  // behind the camera
  aside.width = aside.height = 4;
  for (const bool visible : {true, false}) {
    scene.lights = {sun, MeshLightOf(TwoTriangles(aside), false, visible)};
    const Image image = RenderImage(scene, {});
    CHECK((image.Find("R")->samples[middle] > 0) == !visible);
  }
}

TEST_CASE("triangles without an area change no bit") {
  const Scene scene = OneSphere(PhongMaterial{}, 48, 64);
  Mesh mesh = TwoTriangles(Window());
  const Image without = Render(scene, MeshLightOf(mesh), false);
  mesh.triangles.insert(mesh.triangles.begin(), {0, 2, 0, 1, 1, 1});
  const Image with = Render(scene, MeshLightOf(mesh), false);
  const std::vector<float>& a = with.Find("R")->samples;
  CHECK(std::memcmp(a.data(), without.Find("R")->samples.data(), 4 * a.size()) == 0);
}

TEST_CASE("surfaces in the light's plane, on it and inside it are finite") {
  // Ground in the plane of a light that faces up, another one that stands on it, and a sphere
  // inside a third.
  Scene scene = OneSphere(MetallicRoughnessMaterial{}, 48, 64);
  Mesh ground{.positions = {{-3, 0, -3}, {-3, 0, 3}, {3, 0, 3}, {3, 0, -3}},
              .triangles = {0, 1, 2, 0, 2, 3},
              .material = {0}};
  scene.meshes = {ground};
  scene.camera.position = Vec3d(0, 4, 6);
  scene.camera.fov_y_deg = 50;
  RectangleAreaLight flat, standing;
  flat.center = Vec3d(1.5, 0, 1.5);
  flat.facing = Vec3d(0, 1, 0);
  standing.center = Vec3d(-1.5, 0.5, 0);
  standing.facing = Vec3d(1, 0, 0);
  standing.up = Vec3d(0, 1, 0);
  const Mesh around = MakeMesh(Icosphere{.center = {0, 0, 0}, .radius = 2, .subdivisions = 0});
  scene.image.spp = 16;
  for (const Mesh& mesh : {TwoTriangles(flat), TwoTriangles(standing), around}) {
    for (const bool two_sided : {false, true}) {
      for (const bool closed_forms : {false, true}) {
        const Image image = Render(scene, MeshLightOf(mesh, two_sided), closed_forms);
        double most = 0;
        for (const float red : image.Find("R")->samples) {
          REQUIRE(std::isfinite(red));
          REQUIRE(red >= 0);
          most = std::max(most, double{red});
        }
        CHECK(most > 0);
      }
    }
  }
}

TEST_CASE("pictures under lights of triangles do not depend on threads, tiles or crops") {
  Scene scene = OneSphere(MetallicRoughnessMaterial{}, 48, 64);
  scene.spheres.push_back({Vec3d(0.8, 0.9, 0.9), 0.3, {0}});  // in the way
  scene.image.spp = 4;
  for (const bool visible : {true, false}) {
    scene.lights = {
        MeshLightOf(MakeMesh(Icosphere{.center = {1, 2, 2}, .radius = 0.5, .subdivisions = 2}),
                    false, visible)};
    const Image whole = RenderImage(scene, {});
    const Image other = RenderImage(scene, {.threads = 1, .tile_size = 8, .general_path = true});
    for (const char* channel : {"R", "G", "B"}) {
      const std::vector<float>& a = whole.Find(channel)->samples;
      CHECK(std::memcmp(a.data(), other.Find(channel)->samples.data(), 4 * a.size()) == 0);
    }
  }
}

TEST_CASE(
    "where spheres alone are in the way of a light of triangles, lists find the same shadows") {
  Scene scene = OneSphere(MetallicRoughnessMaterial{}, 48, 64);
  scene.spheres.push_back({Vec3d(0.8, 0.9, 0.9), 0.3, {0}});  // in the way
  scene.camera.fov_y_deg = 100;                               // sees the light
  scene.image.spp = 4;
  scene.lights = {MeshLightOf(
      MakeMesh(Icosphere{.center = {1, 2, 2}, .radius = 0.5, .subdivisions = 2}), false, true)};
  RenderSettings settings{.layers = {"id.object"}};
  const FramePlan plan = MakePlan(scene, settings);
  CHECK(plan.direct.shadows.sampled.at(0).occluders != kAnyLight);
  const Image lists = RenderImage(plan, settings, nullptr);
  settings.intersector = IntersectorChoice::kEmbree;
  const FramePlan other = MakePlan(scene, settings);
  CHECK(other.direct.shadows.sampled.at(0).occluders == kAnyLight);
  const Image tree = RenderImage(other, settings, nullptr);
  for (const char* channel : {"R", "G", "B", "id.object"}) {
    CHECK(lists.Find(channel)->samples == tree.Find(channel)->samples);
  }
  const std::vector<float>& objects = lists.Find("id.object")->samples;
  CHECK(std::count(objects.begin(), objects.end(), 3.0f) > 0);  // the light itself
  // A triangle of something else may be in the way.
  scene.meshes.push_back(MakeMesh(Icosphere{.center = {0.5, 1, 1}, .radius = 0.2}));
  scene.meshes.back().material = {0};
  CHECK(MakePlan(scene, {}).direct.shadows.sampled.at(0).occluders == kAnyLight);
}

}  // namespace
}  // namespace nacre
