// SPDX-License-Identifier: Apache-2.0
// Scene files of every kind, what --set changes, and the scenes that ship.
#include "scene_io/load_scene.h"

#include <filesystem>
#include <fstream>
#include <functional>
#include <string>
#include <utility>

#include <sys/stat.h>
#include <unistd.h>

#include "base/error.h"
#include "catch.h"
#include "messages.h"
#include "scene/filter_width.h"
#include "scene_io/text_file.h"

namespace nacre {
namespace {

const std::filesystem::path kScenes = std::filesystem::path(NACRE_SOURCE_DIR) / "scenes";

Scene Load(const std::string& members, const LoadOptions& options = {}) {
  return LoadSceneText(R"({"nacre": 1)" + members + "}", "test.json", kScenes, options);
}

// A folder of its own, gone at the end.
struct TemporaryFolder {
  std::filesystem::path path = std::filesystem::temp_directory_path() /
                               ("nacre_load_scene_test_" + std::to_string(getpid()));
  TemporaryFolder() { std::filesystem::create_directories(path); }
  ~TemporaryFolder() { std::filesystem::remove_all(path); }
};

std::string MessageOf(const std::function<void()>& action) {
  try {
    action();
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

TEST_CASE("a scene that says nothing has the defaults") {
  const Scene scene = Load("");
  CHECK(scene.camera.fov_y_deg == Camera{}.fov_y_deg);
  CHECK(scene.image.width == ImageSettings{}.width);
  CHECK(scene.materials.empty());
  CHECK(scene.lights.empty());
  CHECK(scene.spheres.empty());
  CHECK(scene.background == Rgb(0, 0, 0));
}

TEST_CASE("cameras") {
  const Scene perspective = Load(R"(, "camera": {"position": [1, 2, 3], "look_at": [4, 5, 6],
      "up": [0, 2, 0.5], "fov_y_deg": 45.5})");
  CHECK(perspective.camera.projection == Projection::kPerspective);
  CHECK(perspective.camera.position == Vec3d(1, 2, 3));
  CHECK(perspective.camera.look_at == Vec3d(4, 5, 6));
  CHECK(perspective.camera.up == Vec3d(0, 2, 0.5));
  CHECK(perspective.camera.fov_y_deg == 45.5);

  const Scene orthographic = Load(R"(, "camera": {"type": "orthographic", "height": 3})");
  CHECK(orthographic.camera.projection == Projection::kOrthographic);
  CHECK(orthographic.camera.height == 3);
}

TEST_CASE("images and filters") {
  const Scene scene =
      Load(R"(, "image": {"width": 640, "height": 3.6e2, "spp": 1, "seed": 4294967295,
      "shadows": false, "filter": {"type": "mitchell", "width": 5}}, "background": [0.1, 0.2, 0.3])");
  CHECK(scene.image.width == 640);
  CHECK(scene.image.height == 360);  // a whole number, however it is written
  CHECK(scene.image.spp == 1);
  CHECK(scene.image.seed == 4294967295u);
  CHECK(!scene.image.shadows);
  CHECK(scene.image.filter.kind == FilterKind::kMitchell);
  CHECK(scene.image.filter.width == 5);
  CHECK(scene.background == Rgb(0.1, 0.2, 0.3));

  const std::pair<const char*, FilterKind> kinds[] = {
      {"box", FilterKind::kBox},
      {"gaussian", FilterKind::kGaussian},
      {"blackman_harris", FilterKind::kBlackmanHarris},
      {"mitchell", FilterKind::kMitchell}};
  for (const auto& [name, kind] : kinds) {
    const Scene with = Load(R"(, "image": {"filter": {"type": ")" + std::string(name) + "\"}}");
    CHECK(with.image.filter.kind == kind);
    CHECK(with.image.filter.width == DefaultFilterWidth(kind));
  }
}

TEST_CASE("materials keep the order of the file") {
  const Scene scene = Load(R"(, "materials": {
      "z": {"model": "lambert", "albedo": 0.25, "emission": [1, 2, 3]},
      "a": {"model": "modified_phong", "convention": "classic", "color": [0.1, 0.2, 0.3],
            "ka": 0.5, "kd": 0.6, "ks": [0.7, 0.8, 0.9], "shininess": 1e6},
      "m": {"model": "metallic_roughness", "base_color": [1, 0.5, 0], "metallic": 1, "roughness": 0,
            "shadowing": "schlick_direct"}})");
  REQUIRE(scene.materials.size() == 3);
  CHECK(scene.materials[0].name == "z");
  CHECK(scene.materials[0].emission == Rgb(1, 2, 3));
  CHECK(std::get<LambertMaterial>(scene.materials[0].model).albedo == Rgb(0.25, 0.25, 0.25));

  CHECK(scene.materials[1].name == "a");
  const auto& phong = std::get<PhongMaterial>(scene.materials[1].model);
  CHECK(phong.model == PhongModel::kModifiedPhong);
  CHECK(phong.convention == PhongConvention::kClassic);
  CHECK(phong.color == Rgb(0.1, 0.2, 0.3));
  CHECK(phong.ka == Rgb(0.5, 0.5, 0.5));
  CHECK(phong.kd == Rgb(0.6, 0.6, 0.6));
  CHECK(phong.ks == Rgb(0.7, 0.8, 0.9));
  CHECK(phong.shininess == 1e6);

  const auto& metal = std::get<MetallicRoughnessMaterial>(scene.materials[2].model);
  CHECK(metal.base_color == Rgb(1, 0.5, 0));
  CHECK(metal.metallic == 1);
  CHECK(metal.roughness == 0);
  CHECK(metal.shadowing == Shadowing::kSchlickDirect);
}

TEST_CASE("rough matte surfaces and bases") {
  const Scene scene = Load(R"(, "materials": {
      "a": {"model": "oren_nayar", "albedo": [0.25, 0.5, 1], "roughness": 0.75},
      "b": {"model": "burley", "albedo": 0.25, "roughness": 0.125},
      "c": {"model": "metallic_roughness", "diffuse": "oren_nayar"},
      "d": {"model": "dielectric", "diffuse": "burley", "diffuse_roughness": 0.25}})");
  const auto& rough = std::get<OrenNayarMaterial>(scene.materials.at(0).model);
  CHECK(rough.albedo == Rgb(0.25, 0.5, 1));
  CHECK(rough.roughness == 0.75);
  CHECK(std::get<BurleyMaterial>(scene.materials[1].model).roughness == 0.125);
  const auto& clay = std::get<MetallicRoughnessMaterial>(scene.materials[2].model);
  CHECK(clay.diffuse == DiffuseForm::kOrenNayar);
  CHECK(!clay.diffuse_roughness);
  const auto& cloth = std::get<DielectricMaterial>(scene.materials[3].model);
  CHECK(cloth.diffuse == DiffuseForm::kBurley);
  CHECK(cloth.diffuse_roughness == 0.25);
}

TEST_CASE("every model name makes its model") {
  const auto phong_model = [](const char* name) {
    const Scene scene = Load(R"(, "materials": {"m": {"model": ")" + std::string(name) + "\"}}");
    return std::get<PhongMaterial>(scene.materials.at(0).model).model;
  };
  CHECK(phong_model("phong") == PhongModel::kPhong);
  CHECK(phong_model("modified_phong") == PhongModel::kModifiedPhong);
  CHECK(phong_model("blinn_phong") == PhongModel::kBlinnPhong);
}

TEST_CASE("splits may name materials that come later, and materials may stand inline") {
  const Scene scene = Load(R"(, "materials": {
      "both": {"model": "split", "at": [0.25, 0.5], "materials": ["b", "a", {"model": "phong"}]},
      "a": {"model": "lambert"}, "b": {"model": "phong"}},
      "shapes": [{"type": "sphere", "center": [0, 0, 0], "radius": 1, "material": "both"},
                 {"type": "sphere", "center": [0, 3, 0], "radius": 2,
                  "material": {"model": "lambert", "albedo": 1}}])");
  REQUIRE(scene.materials.size() == 5);
  CHECK(scene.materials[3].name == "/materials/both/materials/2");
  CHECK(scene.materials[4].name == "/shapes/1/material");
  const auto& split = std::get<SplitMaterial>(scene.materials[0].model);
  CHECK(split.at == std::vector<double>{0.25, 0.5});
  REQUIRE(split.materials.size() == 3);
  CHECK(split.materials[0].index == 2);
  CHECK(split.materials[1].index == 1);
  CHECK(split.materials[2].index == 3);
  REQUIRE(scene.spheres.size() == 2);
  CHECK(scene.spheres[0].material.index == 0);
  CHECK(scene.spheres[1].material.index == 4);
  CHECK(scene.spheres[1].center == Vec3d(0, 3, 0));
  CHECK(scene.spheres[1].radius == 2);
}

TEST_CASE("lights of every kind") {
  const Scene scene = Load(R"(, "lights": {
      "sky": {"type": "ambient", "radiance": 0.5},
      "sun": {"type": "directional", "direction_of_travel": [1, -2, 0], "irradiance": [3, 2, 1]},
      "bulb": {"type": "point", "position": [1, 2, 3], "intensity": 10, "attenuation": "none",
               "shadows": false},
      "lamp": {"type": "spot", "position": [0, 1, 0], "direction_of_travel": [0, -1, 0],
               "intensity": 2, "attenuation": {"constant": 1, "quadratic": 0.1},
               "cutoff_deg": 12, "edge": "square", "exponent": 3}})");
  REQUIRE(scene.lights.size() == 4);
  CHECK(std::get<SpotLight>(scene.lights[3].kind).edge == SpotEdge::kSquare);
  CHECK(scene.lights[0].name == "sky");
  CHECK(std::get<AmbientLight>(scene.lights[0].kind).radiance == Rgb(0.5, 0.5, 0.5));

  CHECK(scene.lights[1].shadows);
  const auto& sun = std::get<DirectionalLight>(scene.lights[1].kind);
  CHECK(sun.direction_of_travel == Vec3d(1, -2, 0));
  CHECK(sun.irradiance == Rgb(3, 2, 1));

  CHECK(!scene.lights[2].shadows);
  const auto& bulb = std::get<PointLight>(scene.lights[2].kind);
  CHECK(bulb.position == Vec3d(1, 2, 3));
  CHECK(bulb.intensity == Rgb(10, 10, 10));
  CHECK(bulb.attenuation == Attenuation::None());

  const auto& lamp = std::get<SpotLight>(scene.lights[3].kind);
  CHECK(lamp.attenuation == Attenuation{1, 0, 0.1});
  CHECK(lamp.cutoff_deg == 12);
  CHECK(lamp.inner_deg == 12);  // a hard edge unless the file says otherwise
  CHECK(lamp.exponent == 3);
}

TEST_CASE("lights that are meshes") {
  const Scene scene = Load(R"(, "lights": {
      "a": {"type": "mesh", "icosphere": {"center": [1, 2, 3], "radius": 0.5, "subdivisions": 1},
            "radiance": [3, 2, 1], "two_sided": true, "visible": false},
      "b": {"type": "mesh", "uv_sphere": {"center": [0, 0, 0], "radius": 1, "segments": 4,
            "rings": 2}, "radiance": 2, "shadows": false}})");
  REQUIRE(scene.lights.size() == 2);
  const auto& lamp = std::get<MeshAreaLight>(scene.lights[0].kind);
  CHECK(lamp.mesh->triangles.size() == 3 * 80);
  CHECK((lamp.mesh->positions[0] - Vec3d(1, 2, 3)).length() == Approx(0.5));
  CHECK(lamp.radiance == Rgb(3, 2, 1));
  CHECK(lamp.two_sided);
  CHECK(!lamp.visible);
  CHECK(std::get<MeshAreaLight>(scene.lights[1].kind).mesh->triangles.size() == 3 * 8);
  CHECK(std::get<MeshAreaLight>(scene.lights[1].kind).visible);
  CHECK(!scene.lights[1].shadows);
}

TEST_CASE("lights with an extent and skies") {
  const Scene scene = Load(R"(, "lights": {
      "window": {"type": "rectangle", "center": [1, 2, 3], "facing": [0, -2, 0], "width": 2,
                 "height": 0.5, "radiance": [3, 2, 1], "two_sided": true, "mode": "sampled"},
      "panel": {"type": "disk", "center": [0, 1, 0], "facing": [0, 0, 1], "radius": 0.25,
                "radiance": 2, "visible": false, "shadows": false},
      "bulb": {"type": "sphere", "center": [0, 4, 0], "radius": 0.1, "radiance": 9},
      "sky": {"type": "environment", "rotate_deg": 45, "background": false, "mode": "sampled",
              "quadratic": {"radiance": [1, 2, 3], "axis": [1, 0, 0], "constant": 1, "linear": -1,
                            "quadratic": 0.5}}})");
  REQUIRE(scene.lights.size() == 4);
  const auto& bulb = std::get<SphereAreaLight>(scene.lights[2].kind);
  CHECK(bulb.radius == 0.1);
  CHECK(bulb.visible);
  const auto& panel = std::get<DiskAreaLight>(scene.lights[1].kind);
  CHECK(panel.facing == Vec3d(0, 0, 1));
  CHECK(!panel.visible);
  CHECK(!scene.lights[1].shadows);
  const auto& sky = std::get<EnvironmentLight>(scene.lights[3].kind);
  CHECK(sky.rotate_deg == 45);
  CHECK(!sky.background);
  CHECK(std::get<QuadraticSky>(sky.sky).linear == -1);
  const auto& window = std::get<RectangleAreaLight>(scene.lights[0].kind);
  CHECK(window.two_sided);
  CHECK(window.up == Vec3d(0, 0, -1));  // a light that faces down has no other
  CHECK(window.radiance == Rgb(3, 2, 1));
}

TEST_CASE("grids, pairs and clouds are made") {
  const Scene scene = Load(R"(, "materials": {"pbr": {"model": "metallic_roughness"}}, "shapes": [
      {"type": "grid", "material": "pbr", "spacing": [2, 1],
       "rows": {"parameter": "roughness", "from": 0.1, "to": 0.9, "count": 5},
       "columns": {"parameter": "base_color", "values": [0, [1, 0, 0]]}},
      {"type": "pair", "a": {"material": {"model": "phong"}, "label": "Phong", "count": 2},
       "b": {"material": "pbr", "count": 2}, "arrangement": "side_by_side"},
      {"type": "cloud", "count": 100, "min": [0, 0, 0], "max": [1, 1, 1], "radius": 0.5,
       "materials": ["pbr", {"model": "lambert"}]}])");
  CHECK(scene.spheres.size() == 10 + 4 + 100);
  CHECK(scene.materials.size() == 1 + 10 + 4 + 1);
  CHECK(scene.labels.size() == 5 + 2);
  CHECK(scene.spheres[1].center.x - scene.spheres[0].center.x == 2);
  CHECK(scene.labels[6].text == "base_color 1 0 0");
  CHECK(scene.spheres[113].radius == 0.5);
}

TEST_CASE("meshes are placed by their transforms") {
  const std::string shape = R"({"type": "mesh", "file": "meshes/torus_knot.obj",
      "material": {"model": "lambert"})";
  const Scene scene = Load(R"(, "shapes": [)" + shape + "}, " + shape +
                           R"(, "smooth": false, "transform": {"scale": 2, "rotate_deg": [0, 0, 90],
                                "translate": [10, 0, 0]}}])");
  REQUIRE(scene.meshes.size() == 2);
  const Mesh& plain = scene.meshes[0];
  const Mesh& moved = scene.meshes[1];
  CHECK(plain.name == "torus_knot");
  CHECK(plain.normals.size() == plain.positions.size());
  CHECK(moved.normals.empty());
  const Vec3d p = plain.positions[0];
  // A few roundings of numbers up to 12.
  CHECK((moved.positions[0] - Vec3d(10 - 2 * p.y, 2 * p.x, 2 * p.z)).length() < 1e-14);
}

TEST_CASE("a flat mesh has no normals, even if its file does") {
  const TemporaryFolder folder;
  std::ofstream(folder.path / "mesh.obj")
      << "v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 1\nf 1//1 2//1 3//1\n";
  for (const bool smooth : {true, false}) {
    std::ofstream(folder.path / "scene.json")
        << R"({"nacre": 1, "shapes": [{"type": "mesh", "file": "mesh.obj", "smooth": )"
        << (smooth ? "true" : "false") << R"(, "material": {"model": "lambert"}}]})";
    const Scene scene = LoadScene(folder.path / "scene.json");
    CHECK(scene.meshes.at(0).normals.size() == (smooth ? 3 : 0));
  }
}

TEST_CASE("normals come from where the mesh asks for them") {
  const TemporaryFolder folder;
  // Two faces of a roof, with normals and uvs of their own.
  std::ofstream(folder.path / "roof.obj")
      << "v 0 1 0\nv 0 1 1\nv -1 0 0\nv 1 0 0\nvn 0 1 0\nvt 0 0\nvt 1 0.5\n"
         "f 1/1/1 3/2/1 2/1/1\nf 1/1/1 2/2/1 4/1/1\n";
  const auto load = [&](const std::string& members) {
    return LoadSceneText(
               R"({"nacre": 1, "shapes": [{"type": "mesh", "file": "roof.obj",
                   "material": {"model": "lambert"})" +
                   members + "}]}",
               "test.json", folder.path)
        .meshes.at(0);
  };
  const Mesh file = load("");
  CHECK(file.normals == std::vector<Vec3d>(file.positions.size(), Vec3d(0, 1, 0)));
  CHECK(file.positions.size() == 5);  // the ridge's far end has two uvs
  CHECK(file.uvs.at(1) == Vec2d(1, 0.5));
  CHECK(file.interpolation == Interpolation::kPhong);
  CHECK(load(R"(, "normals": "none")").normals.empty());
  const Mesh faceted = load(R"(, "interpolation": "faceted")");
  CHECK(faceted.interpolation == Interpolation::kFaceted);
  CHECK(faceted.normals.size() == 5);
  for (const std::string weighting : {"angle", "area", "uniform"}) {
    const Mesh mesh = load(R"(, "normals": ")" + weighting + "\"");
    // The roof is symmetric, so its ridge's normals are vertical whatever the weights.
    CHECK((mesh.normals[0] - Vec3d(0, 1, 0)).length() < 1e-15);
    CHECK((mesh.normals[1] - Vec3d(-1, 1, 0).normalized()).length() < 1e-15);
  }
  const Mesh sharp = load(R"(, "normals": "angle", "crease_angle_deg": 80)");
  CHECK(sharp.positions.size() == 6);
  CHECK(sharp.uvs.size() == 6);
  CHECK(Contains(MessageOf([&] { load(R"(, "crease_angle_deg": 80)"); }),
                 "the file has its own; \"normals\": \"angle\" computes them"));
}

TEST_CASE("spheres of faces") {
  const Scene scene = Load(R"(, "shapes": [
      {"type": "icosphere", "center": [1, 2, 3], "radius": 2, "subdivisions": 1,
       "material": {"model": "lambert"}, "interpolation": "gouraud", "smooth_terminator": false},
      {"type": "uv_sphere", "center": [1, 2, 3], "radius": 2, "segments": 5, "rings": 3,
       "material": {"model": "lambert"}}])");
  REQUIRE(scene.meshes.size() == 2);
  CHECK(scene.meshes[0].triangles.size() == 3 * 80);
  CHECK(scene.meshes[0].interpolation == Interpolation::kGouraud);
  CHECK_FALSE(scene.meshes[0].smooth_terminator);
  CHECK(scene.meshes[1].smooth_terminator);
  CHECK(scene.meshes[1].triangles.size() == 3 * 20);
  CHECK(scene.meshes[1].uvs.size() == scene.meshes[1].positions.size());
}

TEST_CASE("--set changes values, adds them, and makes what is missing on the way") {
  const LoadOptions options{.overrides = {{"/image/spp", "64"},
                                          {"/camera/fov_y_deg", "20"},
                                          {"/materials/m/albedo", "[1, 0, 0]"},
                                          {"/shapes/0/radius", "3"},
                                          {"/image/filter", R"({"type": "box"})"}}};
  const std::string members =
      R"(, "camera": {"fov_y_deg": 45}, "materials": {"m": {"model": "lambert"}},
      "shapes": [{"type": "sphere", "center": [0, 0, 0], "radius": 1, "material": "m"}])";
  const Scene scene = Load(members, options);
  CHECK(scene.image.spp == 64);
  CHECK(scene.camera.fov_y_deg == 20);
  CHECK(std::get<LambertMaterial>(scene.materials.at(0).model).albedo == Rgb(1, 0, 0));
  CHECK(scene.spheres.at(0).radius == 3);
}

TEST_CASE("--set that cannot be done is a usage error") {
  const auto set = [](const std::string& pointer, const std::string& value) {
    try {
      Load(R"(, "shapes": [], "background": 0)",
           {.overrides = {{pointer, value}}, .allow_paths = false});
    } catch (const Error& error) {
      CHECK(error.code() == ExitCode::kUsage);
      CHECK(error.faults().at(0).where == pointer);
      return error.faults().at(0).what + " | " + error.faults().at(0).hint;
    }
    return std::string("no error");
  };
  CHECK(Contains(set("image/spp", "4"), "not a JSON pointer"));
  CHECK(Contains(set("/background", "red"), R"(red is not JSON | a string needs quotes)"));
  CHECK(Contains(set("/background", "1e999"), "is not JSON"));
  CHECK(Contains(set("/shapes/0/radius", "1"), "no element \"0\" | the array has 0"));
  CHECK(Contains(set("/shapes/-", "1"), "no element"));
  CHECK(Contains(set("/background/red", "1"), "no \"red\" in a value"));
}

TEST_CASE(
    "--set tells a name that the scene does not have, and a number that JSON writes otherwise") {
  const auto set = [](const std::string& pointer, const std::string& value) {
    return MessageOf([&] {
      Load(R"(, "materials": {"red": {"model": "lambert"}, "floor": {"model": "lambert"}},
              "lights": {"key": {"type": "point", "position": [0, 1, 0], "intensity": 1}},
              "shapes": [])",
           {.overrides = {{pointer, value}}, .allow_paths = false});
    });
  };
  std::string message = set("/materials/blue/roughness", "0.1");
  CHECK(Contains(message, "/materials/blue/roughness: there is no material \"blue\""));
  CHECK(Contains(message, "the scene has red, floor"));
  message = set("/lights/kye/intensity", "2");
  CHECK(Contains(message, "there is no light \"kye\""));
  CHECK(Contains(message, "the scene has key"));
  message = set("/lights/key/position/01", "2");
  CHECK(Contains(message, "no element \"01\""));
  message = set("/textures/earth/wrap", "\"repeat\"");
  CHECK(Contains(message, "there is no texture \"earth\""));
  CHECK(Contains(message, "the scene has no textures"));
  for (const auto& [text, number] :
       {std::pair(".1", "0.1"), {"-.5", "-0.5"}, {"2.", "2.0"}, {"+3", "3.0"}}) {
    CHECK(Contains(set("/camera/fov_y_deg", text), std::string("write ") + number));
  }
  CHECK(Contains(set("/camera/fov_y_deg", ".1.2"), "a string needs quotes"));
  // A whole new one can be made, at once or key by key.
  const Scene scene =
      Load(R"(, "shapes": [])", {.overrides = {{"/materials/a", R"({"model": "lambert"})"},
                                               {"/materials/b/albedo", "0.25"},
                                               {"/materials/b/model", R"("lambert")"}},
                                 .allow_paths = false});
  CHECK(scene.materials.size() == 2);
}

TEST_CASE("what --set puts in is checked like the file") {
  const std::string message = MessageOf([] { Load("", {.overrides = {{"/image/sppp", "64"}}}); });
  CHECK(Contains(message, "test.json: /image: unknown key \"sppp\""));
  CHECK(Contains(message, "did you mean \"spp\"?"));
}

TEST_CASE("files outside the scene's folder need leave") {
  const TemporaryFolder folder;
  std::filesystem::create_directories(folder.path / "scene");
  std::ofstream(folder.path / "mesh.obj") << "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
  std::filesystem::create_symlink("../mesh.obj", folder.path / "scene/link.obj");
  const auto write = [&](const std::string& file) {
    std::ofstream(folder.path / "scene/scene.json")
        << R"({"nacre": 1, "shapes": [{"type": "mesh", "material": {"model": "lambert"}, "file": ")"
        << file << "\"}]}";
  };
  for (const std::string file : {"../mesh.obj", "link.obj", "../scene/../mesh.obj"}) {
    write(file);
    CHECK(Contains(MessageOf([&] { LoadScene(folder.path / "scene/scene.json"); }),
                   "/shapes/0/file: \"" + file + "\" is outside the scene's folder"));
    const Scene scene =
        LoadScene(folder.path / "scene/scene.json", {.overrides = {}, .allow_paths = true});
    CHECK(scene.meshes.size() == 1);
  }
}

TEST_CASE("an environment that the caller chooses takes the place of all lights of a scene") {
  const TemporaryFolder folder;
  std::filesystem::create_directories(folder.path / "scene");
  const std::filesystem::path sky = folder.path / "sky.exr";
  std::filesystem::copy_file(kScenes / "textures/evening.exr", sky,
                             std::filesystem::copy_options::overwrite_existing);
  std::filesystem::create_symlink("sky.exr", folder.path / "link.exr");
  const auto scene_file = [&](const std::string& members) {
    const std::filesystem::path path = folder.path / "scene/scene.json";
    std::ofstream(path) << R"({"nacre": 1)" << members << "}";
    return path;
  };
  const auto load = [&](const std::string& members, const std::filesystem::path& environment,
                        std::vector<std::pair<std::string, std::string>> overrides = {}) {
    return LoadScene(scene_file(members),
                     {.overrides = std::move(overrides), .environment = environment});
  };
  // The environment's light, which must be the only one.
  const auto only = [](const Scene& scene) {
    REQUIRE(scene.lights.size() == 1);
    CHECK(scene.lights[0].name == "environment");
    const auto* const light = std::get_if<EnvironmentLight>(&scene.lights[0].kind);
    REQUIRE(light != nullptr);
    REQUIRE(std::get<PictureSky>(light->sky).picture != nullptr);
    return *light;
  };
  const std::string lamp =
      R"(, "lights": {"key": {"type": "point", "position": [0, 1, 0], "intensity": 5}})";
  const std::string faulty = R"(, "lights": {"key": {"type": "lantern"}})";
  for (const std::string& members : {std::string(), lamp, faulty}) {
    const EnvironmentLight light = only(load(members, sky));
    CHECK(light.background);
    CHECK(light.rotate_deg == 0);
    CHECK(std::get<PictureSky>(light.sky).picture->width == 96);
  }
  // From where the caller is, not the scene, and by a link.
  const std::filesystem::path here = std::filesystem::current_path();
  std::filesystem::current_path(folder.path);
  const std::string from_here = MessageOf([&] { only(load(lamp, "sky.exr")); });
  std::filesystem::current_path(here);
  CHECK(from_here == "no error");
  only(load(lamp, folder.path / "link.exr"));
  // --set comes after it: changes it, adds to it, takes its place.
  CHECK(only(load(lamp, sky, {{"/lights/environment/rotate_deg", "90"}})).rotate_deg == 90);
  const std::string sun = R"({"type": "directional", "direction_of_travel": [0, -1, 0],
                              "irradiance": 1})";
  CHECK(load(lamp, sky, {{"/lights/sun", sun}}).lights.size() == 2);
  const Scene replaced = load(lamp, sky, {{"/lights", "{\"sun\": " + sun + "}"}});
  REQUIRE(replaced.lights.size() == 1);
  CHECK(replaced.lights[0].name == "sun");
  // It alone is let in from outside the folder.
  std::filesystem::copy_file(sky, folder.path / "other.exr",
                             std::filesystem::copy_options::overwrite_existing);
  CHECK(Contains(MessageOf([&] { load(R"(, "textures": {"t": {"file": "../other.exr"}})", sky); }),
                 "/textures/t/file: \"../other.exr\" is outside the scene's folder"));
  CHECK(Contains(MessageOf([&] {
                   load("", sky, {{"/lights/environment/image", "\"../other.exr\""}});
                 }),
                 "/lights/environment/image: \"../other.exr\" is outside the scene's folder"));
}

TEST_CASE("an environment that the caller chooses takes the place of a model's studio") {
  const std::filesystem::path model = kScenes / "models/pawns.glb";
  LoadOptions options;
  options.environment = kScenes / "textures/evening.exr";  // outside the model's folder
  const auto names = [&](std::vector<std::pair<std::string, std::string>> overrides) {
    options.overrides = std::move(overrides);
    std::string all;
    for (const Light& light : LoadScene(model, options).lights) all += light.name + " ";
    return all;
  };
  CHECK(names({}) == "environment ");
  CHECK(names({{"/lights/environment/rotate_deg", "90"}}) == "environment ");
  CHECK(names({{"/lights/lamp", R"({"type": "point", "position": [0, 1, 0], "intensity": 1})"}}) ==
        "environment lamp ");
  CHECK(names({{"/lights",
                R"({"lamp": {"type": "point", "position": [0, 1, 0], "intensity": 1}})"}}) ==
        "lamp ");
}

TEST_CASE("an environment that is none is refused, of scenes and of models") {
  const TemporaryFolder folder;
  std::ofstream(folder.path / "scene.json") << R"({"nacre": 1})";
  std::ofstream(folder.path / "text.exr") << "no picture";
  const auto message = [&](const std::filesystem::path& file,
                           const std::filesystem::path& environment) {
    LoadOptions options{.environment = environment};
    try {
      LoadScene(file, options);
    } catch (const Error& error) {
      CHECK(error.code() == ExitCode::kBadInput);
      return std::string(error.what());
    }
    return std::string("no error");
  };
  for (const std::filesystem::path& file :
       {folder.path / "scene.json", kScenes / "models/pawns.glb"}) {
    const std::string place = file.string() + ": /lights/environment/image: ";
    CAPTURE(file.string());
    // What the command line names is the command line's fault, what is in it the file's.
    CHECK(Contains(message(file, folder.path / "missing.exr"), "--environment: there is no file"));
    CHECK(Contains(message(file, folder.path), "is not a regular file"));
    CHECK(Contains(message(file, folder.path / "text.exr"), place));
    // Codes of a display are no radiance.
    CHECK(Contains(message(file, kScenes / "textures/globe.png"), place));
  }
}

TEST_CASE("scenes that cannot be read") {
  CHECK(Contains(MessageOf([] { LoadScene("/no/such/scene.json"); }),
                 "/no/such/scene.json: cannot be opened: No such file or directory"));
  CHECK(Contains(MessageOf([] { LoadScene(kScenes); }), "is a folder"));
  CHECK(Contains(MessageOf([] { ReadTextFile("/dev/zero", 3 << 20); }),
                 "/dev/zero: is not a regular file"));
  const TemporaryFolder folder;
  const std::filesystem::path pipe = folder.path / "pipe.json", large = folder.path / "large.json";
  REQUIRE(mkfifo(pipe.c_str(), 0600) == 0);
  CHECK(Contains(MessageOf([&] { LoadScene(pipe); }), "pipe.json: is not a regular file"));
  std::ofstream(large) << "{}";
  for (const auto& [bytes, limit] :
       {std::pair<uint64_t, const char*>(1 << 20, "1 MiB"), {uint64_t{4} << 30, "4 GiB"}}) {
    std::filesystem::resize_file(large, bytes + 1);  // of which the disk holds two
    CHECK(Contains(MessageOf([&] { ReadTextFile(large, bytes); }),
                   std::string("longer than ") + limit));
    CHECK(
        Contains(MessageOf([&] { ReadBytes(large, bytes); }), std::string("longer than ") + limit));
  }
  std::ofstream(large) << "12345";
  CHECK(ReadTextFile(large, 5) == "12345");
  CHECK(ReadBytes(large, 5) == "12345");
  CHECK(ReadBytes(large, 3, [](std::string_view, uint64_t) { return uint64_t{3}; }) == "123");
  CHECK(Contains(MessageOf([&] { ReadTextFile(large, 4); }), "longer than"));
  CHECK(!ReadTextFile("/proc/self/status", 1 << 20).empty());  // says that it has no bytes
}

TEST_CASE("text ends with its file, not at a character 0") {
  using namespace std::string_literals;
  const TemporaryFolder folder;
  const auto message_of = [&](const std::string& name, const std::string& text) {
    std::ofstream(folder.path / name, std::ios::binary) << text;
    return MessageOf([&] { LoadScene(folder.path / name); });
  };
  const std::string scene = R"({"nacre": 1})";
  CHECK(message_of("a.json", scene) == "no error");
  CHECK(Contains(message_of("a.json", scene + "\n\0"s),
                 "a.json:2: is not text: there is a character 0"));
  CHECK(Contains(MessageOf([&] { LoadSceneText(scene + "\0}"s, "a.json", {}, {}); }),
                 "a.json:1: is not text"));
  CHECK(Contains(message_of("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n\0"s),
                 "a.obj:5: is not text"));
  // Far from the beginning, where a .gltf file is no longer judged by its first bytes.
  const std::string blanks(1 << 17, ' ');
  CHECK(Contains(message_of("a.gltf", R"({"asset": {"version": "2.0"}})" + blanks + "\0{}"s),
                 "a.gltf:1: is not text"));
  CHECK(Contains(message_of("a.obj", "v 0 0 0\n" + blanks + "\n\0"s), "a.obj:3: is not text"));
}

TEST_CASE("UTF-16 and UTF-32 with a byte-order mark and without") {
  const auto message_of = [](const std::string& text) {
    return MessageOf([&] { LoadSceneText(text, "a.json", {}, {}); });
  };
  for (const size_t width : {2, 4}) {
    for (const size_t place : {size_t{0}, width - 1}) {
      std::string text;
      for (const char c : std::string(R"({"nacre": 1})")) {
        std::string wide(width, '\0');
        wide[place] = c;
        text += wide;
      }
      CHECK(Contains(message_of(text), "a.json: is text in UTF-16 or UTF-32"));
    }
  }
}

TEST_CASE("a file is blamed for what no override can mend") {
  const auto message_of = [](const std::string& text, const std::string& pointer) {
    return MessageOf([&] { LoadSceneText(text, "a.json", {}, {.overrides = {{pointer, "1"}}}); });
  };
  CHECK(Contains(message_of("[]", "/image/width"), "a.json: not a scene: no object"));
  CHECK(Contains(message_of(R"({"nacre": 1, "image": []})", "/image/width"),
                 "a.json: /image: expected an object, got an array"));
  CHECK(Contains(message_of(R"({"nacre": 1, "image": {"width": 8}})", "/image/width/a"),
                 "/image/width/a: there is no \"a\" in a value"));
}

TEST_CASE("a pointer to a fault is whole whatever names are in it") {
  const auto message_of = [](const std::string& name) {
    const std::string text =
        R"({"nacre": 1, "materials": {")" + name + R"(": {"model": "lambert", "albedo": "red"}}})";
    return MessageOf([&] { LoadSceneText(text, "a.json", {}, {}); });
  };
  CHECK(Contains(message_of("a\\nb"), "/materials/a\\nb/albedo: expected"));
  CHECK(Contains(message_of(std::string(1000, 'x')), "xxx.../albedo: expected"));
  CHECK(Contains(message_of(""), "/materials//albedo: expected"));
  const std::string light = R"({"nacre": 1, "lights": {"": {"type": "ambient", "radiance": 1}}})";
  CHECK(Contains(MessageOf([&] { LoadSceneText(light, "a.json", {}, {}); }),
                 "a.json: /lights/: the name"));
}

TEST_CASE("the scenes that ship load") {
  size_t count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(kScenes)) {
    if (entry.path().extension() != ".json" || entry.path().stem().extension() == ".schema")
      continue;
    ++count;
    INFO(entry.path());
    Scene scene;
    CHECK_NOTHROW(scene = LoadScene(entry.path()));
    CHECK(!scene.lights.empty());
    CHECK(scene.spheres.size() + scene.meshes.size() > 0);
  }
  CHECK(count > 0);
}

TEST_CASE("the material grid is the founding lesson's") {
  const Scene scene = LoadScene(kScenes / "material_grid.json");
  REQUIRE(scene.spheres.size() == 25);
  for (size_t row = 0; row < 5; ++row) {
    for (size_t column = 0; column < 5; ++column) {
      const Sphere& sphere = scene.spheres[5 * row + column];
      const double x = static_cast<double>(column) - 2;
      const double y = 2 - static_cast<double>(row);
      CHECK(sphere.center == Vec3d(x, y, 0));
      const auto& material =
          std::get<MetallicRoughnessMaterial>(scene.materials[sphere.material.index].model);
      CHECK(material.roughness == Approx(0.1 + 0.2 * static_cast<double>(row)).epsilon(1e-15));
      CHECK(material.metallic == static_cast<double>(column) / 4);
      CHECK(material.base_color == Rgb(0.9, 0.6, 0.2));
    }
  }
}

TEST_CASE("the pairs' highlights match in width") {
  const Scene scene = LoadScene(kScenes / "phong_vs_pbr_pair.json");
  REQUIRE(scene.spheres.size() % 2 == 0);
  for (size_t i = 0; i < scene.spheres.size(); i += 2) {
    const auto& phong =
        std::get<PhongMaterial>(scene.materials[scene.spheres[i].material.index].model);
    const auto& pbr = std::get<MetallicRoughnessMaterial>(
        scene.materials[scene.spheres[i + 1].material.index].model);
    CHECK(phong.model == PhongModel::kBlinnPhong);  // the rule is for cos^n of the half angle
    const double alpha = pbr.roughness * pbr.roughness;
    // The file has seven digits.
    CHECK(phong.shininess == Approx(2 / (alpha * alpha) - 2).epsilon(1e-6));
    CHECK(scene.spheres[i].center.y > scene.spheres[i + 1].center.y);
  }
}

}  // namespace
}  // namespace nacre
