// SPDX-License-Identifier: Apache-2.0
// Validate() on scenes built in code: each fault alone, and many at once.
#include "scene/validate.h"

#include <cmath>
#include <functional>
#include <limits>
#include <string>

#include "catch.h"

namespace nacre {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

const Rgb kBlack(0, 0, 0);

Scene GoodScene() {
  Scene scene;
  Material red{.name = "red", .emission = kBlack, .model = LambertMaterial{}};
  Material phong{.name = "a/b", .emission = kBlack, .model = PhongMaterial{}};
  Material pbr{.name = "", .emission = kBlack, .model = MetallicRoughnessMaterial{}};
  SplitMaterial split{.at = {0.5}, .materials = {MaterialId{0}, MaterialId{1}}};
  Material half{.name = "half", .emission = kBlack, .model = split};
  scene.materials = {red, phong, pbr, half};
  scene.lights = {{"sky", true, AmbientLight{}},
                  {"sun", true, DirectionalLight{}},
                  {"key", true, PointLight{}},
                  {"lamp", true, SpotLight{}}};
  scene.spheres = {{Vec3d(0, 0, 0), 1, MaterialId{0}}, {Vec3d(0, 0, 0), 1, MaterialId{3}}};
  Mesh mesh{.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}},
            .triangles = {0, 1, 2},
            .material = MaterialId{2}};
  scene.meshes = {mesh};
  return scene;
}

template <typename Kind>
Kind& LightOf(Scene& scene, size_t i) {
  return std::get<Kind>(scene.lights[i].kind);
}

template <typename Model>
Model& ModelOf(Scene& scene, size_t i) {
  return std::get<Model>(scene.materials[i].model);
}

struct BadScene {
  std::string where;
  std::string what;  // part of it
  std::function<void(Scene&)> spoil;
};

void CheckAll(const std::vector<BadScene>& cases) {
  for (const BadScene& bad : cases) {
    Scene scene = GoodScene();
    bad.spoil(scene);
    const std::vector<Fault> faults = Validate(scene);
    INFO(bad.where << ": " << bad.what);
    REQUIRE(faults.size() == 1);
    CHECK(faults[0].where == bad.where);
    INFO("told: " << faults[0].what);
    CHECK(faults[0].what.find(bad.what) != std::string::npos);
  }
}

TEST_CASE("a good scene has no faults") {
  CHECK(Validate(GoodScene()).empty());
  CHECK(Validate(Scene{}).empty());
}

TEST_CASE("camera and image faults") {
  CheckAll({
      {"/camera/position", "nan", [](Scene& s) { s.camera.position.x = kNan; }},
      {"/camera/look_at", "inf", [](Scene& s) { s.camera.look_at.y = kInfinity; }},
      {"/camera/look_at", "is the camera's position",
       [](Scene& s) { s.camera.look_at = s.camera.position; }},
      {"/camera/up", "has no direction", [](Scene& s) { s.camera.up = Vec3d(0, 0, 0); }},
      {"/camera/up", "parallel", [](Scene& s) { s.camera.up = Vec3d(0, 0, -7); }},
      {"/camera/up", "parallel",
       [](Scene& s) {
         s.camera.position = Vec3d(1, 2, 3);
         s.camera.look_at = Vec3d(4, 6, 8);
         s.camera.up = Vec3d(3, 4, 5) * 0.1;
       }},
      {"/camera/fov_y_deg", "180", [](Scene& s) { s.camera.fov_y_deg = 180; }},
      {"/camera/fov_y_deg", "nan", [](Scene& s) { s.camera.fov_y_deg = kNan; }},
      {"/camera/height", "0",
       [](Scene& s) {
         s.camera.projection = Projection::kOrthographic;
         s.camera.fov_y_deg = -1;  // not used, so no fault
         s.camera.height = 0;
       }},
      {"/image/width", "0", [](Scene& s) { s.image.width = 0; }},
      {"/image/height", "65537", [](Scene& s) { s.image.height = 65537; }},
      {"/image/spp", "-1", [](Scene& s) { s.image.spp = -1; }},
      {"/image/filter/width", "17", [](Scene& s) { s.image.filter.width = 17; }},
      {"/image", "samples", [](Scene& s) { s.image = {65536, 65536, 65536, {}, 0, true}; }},
      {"/background", "-1", [](Scene& s) { s.background.z = -1; }},
  });
}

TEST_CASE("a camera that almost looks along its up vector is fine") {
  Scene scene = GoodScene();
  scene.camera.up = Vec3d(0, 1e-9, 1);
  CHECK(Validate(scene).empty());
}

TEST_CASE("material faults") {
  CheckAll({
      {"/materials/red/albedo", "[2, ",
       [](Scene& s) { ModelOf<LambertMaterial>(s, 0).albedo.x = 2; }},
      {"/materials/red/emission", "nan", [](Scene& s) { s.materials[0].emission.y = kNan; }},
      {"/materials/a~1b/shininess", "-1",
       [](Scene& s) { ModelOf<PhongMaterial>(s, 1).shininess = -1; }},
      {"/materials/a~1b/ks", "inf",
       [](Scene& s) { ModelOf<PhongMaterial>(s, 1).ks.z = kInfinity; }},
      {"/materials/2/roughness", "1.5",
       [](Scene& s) { ModelOf<MetallicRoughnessMaterial>(s, 2).roughness = 1.5; }},
      {"/materials/2/metallic", "-0.5",
       [](Scene& s) { ModelOf<MetallicRoughnessMaterial>(s, 2).metallic = -0.5; }},
      {"/materials/half/materials", "2 materials for 0",
       [](Scene& s) { ModelOf<SplitMaterial>(s, 3).at.clear(); }},
      {"/materials/half/at/0", "1", [](Scene& s) { ModelOf<SplitMaterial>(s, 3).at[0] = 1; }},
      {"/materials/half/at/1", "0.25 after 0.5",
       [](Scene& s) {
         ModelOf<SplitMaterial>(s, 3) = {{0.5, 0.25},
                                         {MaterialId{0}, MaterialId{1}, MaterialId{2}}};
       }},
      {"/materials/half/materials", "65 materials",
       [](Scene& s) {
         SplitMaterial& split = ModelOf<SplitMaterial>(s, 3);
         split.materials.assign(65, MaterialId{0});
         split.at.clear();
         for (int i = 1; i <= 64; ++i) split.at.push_back(i / 65.0);
       }},
      {"/materials/half/materials/1", "is a split itself",
       [](Scene& s) { ModelOf<SplitMaterial>(s, 3).materials[1] = MaterialId{3}; }},
      {"/materials/half/materials/0", "there is no material 9",
       [](Scene& s) { ModelOf<SplitMaterial>(s, 3).materials[0] = MaterialId{9}; }},
      {"/materials/half/materials/0", "no material",
       [](Scene& s) { ModelOf<SplitMaterial>(s, 3).materials[0] = MaterialId{}; }},
      {"/materials/half/emission", "no emission",
       [](Scene& s) { s.materials[3].emission = Rgb(1, 1, 1); }},
  });
}

TEST_CASE("light faults") {
  CheckAll({
      {"/lights/sky/radiance", "-1", [](Scene& s) { LightOf<AmbientLight>(s, 0).radiance.x = -1; }},
      {"/lights/sun/direction_of_travel", "has no direction",
       [](Scene& s) { LightOf<DirectionalLight>(s, 1).direction_of_travel = Vec3d(0, 0, 0); }},
      {"/lights/sun/irradiance", "nan",
       [](Scene& s) { LightOf<DirectionalLight>(s, 1).irradiance.x = kNan; }},
      {"/lights/key/position", "inf",
       [](Scene& s) { LightOf<PointLight>(s, 2).position.x = -kInfinity; }},
      {"/lights/key/intensity", "1e+31",
       [](Scene& s) { LightOf<PointLight>(s, 2).intensity.x = 1e31; }},
      {"/lights/key/attenuation", "all three",
       [](Scene& s) {
         LightOf<PointLight>(s, 2).attenuation = {0, 0, 0};
       }},
      {"/lights/key/attenuation/linear", "-1",
       [](Scene& s) { LightOf<PointLight>(s, 2).attenuation.linear = -1; }},
      {"/lights/lamp/cutoff_deg", "181",
       [](Scene& s) { LightOf<SpotLight>(s, 3).cutoff_deg = 181; }},
      {"/lights/lamp/inner_deg", "31 is beyond",
       [](Scene& s) { LightOf<SpotLight>(s, 3).inner_deg = 31; }},
      {"/lights/lamp/exponent", "-1", [](Scene& s) { LightOf<SpotLight>(s, 3).exponent = -1; }},
      {"/lights/sky", "second light", [](Scene& s) { s.lights[1].name = "sky"; }},
      {"/lights/", "layer", [](Scene& s) { s.lights[1].name = ""; }},
      {"/lights/a.b", "layer", [](Scene& s) { s.lights[1].name = "a.b"; }},
  });
}

TEST_CASE("shape faults") {
  CheckAll({
      {"/spheres/1/radius", "0", [](Scene& s) { s.spheres[1].radius = 0; }},
      {"/spheres/1/radius", "-1", [](Scene& s) { s.spheres[1].radius = -1; }},
      {"/spheres/1/radius", "nan", [](Scene& s) { s.spheres[1].radius = kNan; }},
      {"/spheres/0/center", "nan", [](Scene& s) { s.spheres[0].center.z = kNan; }},
      {"/spheres/0/material", "no material", [](Scene& s) { s.spheres[0].material = {}; }},
      {"/spheres/0/material", "no material 4",
       [](Scene& s) { s.spheres[0].material = MaterialId{4}; }},
      {"/meshes/0/triangles/0", "no position 3", [](Scene& s) { s.meshes[0].triangles[1] = 3; }},
      {"/meshes/0/triangles/1", "no position 3",
       [](Scene& s) {
         s.meshes[0].triangles.insert(s.meshes[0].triangles.end(), {0, 1, 3});
       }},
      {"/meshes/0/triangles", "2 indices", [](Scene& s) { s.meshes[0].triangles.pop_back(); }},
      {"/meshes/0/triangles", "no triangles", [](Scene& s) { s.meshes[0].triangles.clear(); }},
      {"/meshes/0/positions/2", "inf", [](Scene& s) { s.meshes[0].positions[2].x = kInfinity; }},
      {"/meshes/0/normals", "1 normals for 3",
       [](Scene& s) { s.meshes[0].normals = {Vec3d(0, 0, 1)}; }},
      {"/meshes/0/normals/1", "length 2",
       [](Scene& s) {
         s.meshes[0].normals = {{0, 0, 1}, {0, 0, 2}, {0, 0, 1}};
       }},
      {"/meshes/0/normals/0", "nan",
       [](Scene& s) {
         s.meshes[0].normals = {{0, 0, kNan}, {0, 0, 1}, {0, 0, 1}};
       }},
      {"/meshes/0/uvs", "2 uvs for 3",
       [](Scene& s) {
         s.meshes[0].uvs = {{0, 0}, {1, 1}};
       }},
      {"/meshes/0/uvs/1", "nan",
       [](Scene& s) {
         s.meshes[0].uvs = {{0, 0}, {0, kNan}, {1, 1}};
       }},
      {"/meshes/0/second_uvs/2", "inf",
       [](Scene& s) {
         s.meshes[0].second_uvs = {{0, 0}, {1, 1}, {kInfinity, 0}};
       }},
      {"/meshes/0", "2 coordinates, colours or opacities for 3",
       [](Scene& s) {
         s.meshes[0].opacities = {1, 1};
       }},
      {"/meshes/0/opacities/1", "nan",
       [](Scene& s) {
         s.meshes[0].opacities = {1, static_cast<float>(kNan), 1};
       }},
      {"/meshes/0/opacities/0", "-0.5",
       [](Scene& s) {
         s.meshes[0].opacities = {-0.5f, 0, 1};
       }},
      {"/meshes/0/opacities/2", "1.5",
       [](Scene& s) {
         s.meshes[0].opacities = {1, 0, 1.5f};
       }},
      {"/meshes/0/colors/1", "2",
       [](Scene& s) {
         s.meshes[0].colors = {{0, 0, 0}, {1, 2, 1}, {1, 1, 1}};
       }},
      {"/meshes/0/interpolation", "needs a normal",
       [](Scene& s) { s.meshes[0].interpolation = Interpolation::kGouraud; }},
      {"/meshes/0", "no triangle has an area",
       [](Scene& s) {
         s.meshes[0].triangles = {0, 1, 1};
       }},
      {"/meshes/0/material", "no material", [](Scene& s) { s.meshes[0].material = {}; }},
  });
}

TEST_CASE("small meshes and meshes with some degenerate triangles are fine") {
  Scene scene = GoodScene();
  // An absolute threshold of 1e-6 on the cross product would call this one degenerate.
  scene.meshes[0].positions = {{0, 0, 0}, {1e-6, 0, 0}, {0, 1e-6, 0}};
  scene.meshes[0].triangles = {0, 1, 1, 0, 1, 2};
  CHECK(Validate(scene).empty());
}

TEST_CASE("faults are told together, and a million of them in short") {
  Scene scene = GoodScene();
  scene.image.width = 0;
  scene.spheres.assign(1000000, Sphere{});  // no material
  const std::vector<Fault> faults = Validate(scene);
  REQUIRE(faults.size() == FaultList::kMaxKept + 1);
  CHECK(faults[0].where == "/image/width");
  CHECK(faults[1].where == "/spheres/0/material");
  CHECK(faults.back().what == "and 999981 more faults");
}

}  // namespace
}  // namespace nacre
