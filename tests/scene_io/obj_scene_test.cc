// SPDX-License-Identifier: Apache-2.0
// OBJ files as scenes of their own, with their material libraries.
#include <random>

#include "catch.h"
#include "scene_io/gltf_builder.h"
#include "scene_io/obj.h"

namespace nacre {
namespace {

const std::string kCorner =
    "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nusemtl red\nf 1 3 4\n"
    "usemtl blue\nf 1 4 2\nusemtl red\nf 2 4 3\n";
const std::string kMtl =
    "newmtl red\nKa 0.1 0 0\nKd 0.8 0.1 0.1\nKs 0.5 0.5 0.5\nNs 50\nillum 2\n"
    "newmtl blue\nKd 0 0 1\nKs 1 1 1\nKe 0 0 2\nillum 1\n";

struct Loaded {
  Scene scene;
  std::vector<std::string> warnings;
};

Loaded Load(const std::string& obj, const std::string& mtl) {
  const ModelFolder folder;
  if (!mtl.empty()) folder.Write("a.mtl", mtl);
  Loaded loaded;
  LoadOptions options;
  options.on_warning = [&](const std::string& text) { loaded.warnings.push_back(text); };
  loaded.scene = LoadScene(folder.Write("model.obj", obj), options);
  return loaded;
}

std::string MessageOf(const std::string& obj, const std::string& mtl) {
  try {
    Load(obj, mtl);
  } catch (const Error& error) {
    CHECK(error.code() == ExitCode::kBadInput);
    return error.what();
  }
  return "fine";
}

bool Contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

TEST_CASE("a mesh for each material of an OBJ file, in the classic reading") {
  const auto [scene, warnings] = Load(kCorner, kMtl);
  CHECK(warnings.empty());
  REQUIRE(scene.meshes.size() == 3);
  const auto& red = scene.materials.at(scene.meshes[0].material.index);
  CHECK(red.name == "red");
  CHECK(scene.meshes[0].triangles.size() == 6);
  const auto& phong = std::get<PhongMaterial>(red.model);
  CHECK(phong.model == PhongModel::kBlinnPhong);
  CHECK(phong.convention == PhongConvention::kClassic);
  CHECK(phong.ka == Rgb(0.1, 0, 0));
  CHECK(phong.kd == Rgb(0.8, 0.1, 0.1));
  CHECK(phong.ks == Rgb(0.5, 0.5, 0.5));
  CHECK(phong.shininess == 50);
  const auto& blue = scene.materials.at(scene.meshes[1].material.index);
  CHECK(blue.emission == Rgb(0, 0, 2));
  CHECK(std::get<PhongMaterial>(blue.model).ks == Rgb(0));  // illum 1
  CHECK(scene.materials.at(scene.meshes[2].material.index).name == "default");
  CHECK(scene.lights.size() == 4);
}

TEST_CASE("models without normals get them, with sharp edges") {
  const Scene scene = Load(kCorner, kMtl).scene;
  CHECK(scene.meshes[0].normals.size() == scene.meshes[0].positions.size());
  CHECK(scene.meshes[0].positions.size() == 6);  // two faces that meet at over a right angle
}

TEST_CASE("what libraries say and nobody shows is told") {
  const std::string mtl = kMtl +
                          "map_Kd wood.png\nd 0.5\nnewmtl glass\nillum 7\nKd 1 1 1\n"
                          "newmtl sign\nillum 0\nKd 0.5 0.25 0\n";
  const auto [scene, warnings] = Load(kCorner, mtl);
  CHECK(warnings.size() == 3);
  CHECK(scene.materials.at(3).emission == Rgb(0.5, 0.25, 0));
  const auto missing = Load(kCorner, "");
  REQUIRE(missing.warnings.size() == 1);
  CHECK(Contains(missing.warnings[0], "there is no file \"a.mtl\""));
  CHECK(missing.scene.meshes.size() == 1);
}

TEST_CASE("what is wrong with a material library is said") {
  CHECK(Contains(MessageOf(kCorner, "newmtl red\nKd 1 x 0\n"), "a.mtl:2: \"x\" is not a finite"));
  CHECK(Contains(MessageOf(kCorner, "newmtl red\nNs inf\n"), "a.mtl:2: \"inf\" is not a finite"));
  CHECK(Contains(MessageOf(kCorner, "newmtl red\nKd spectral a.rfl\n"), "a color by \"spectral\""));
  CHECK(Contains(MessageOf(kCorner, "newmtl red\nKd 2 0 0\n"),
                 "/materials/red/kd: [2, 0, 0] is out"));
  CHECK(Contains(MessageOf("mtllib ../b.mtl\n" + kCorner, kMtl), "\"../b.mtl\" is outside"));
  CHECK(Contains(MessageOf("v 0 0 0\nf 1 1 1\n", kMtl), "has no face with an area"));
}

TEST_CASE("spoilt OBJ and MTL files never do worse than be refused") {
  std::mt19937 random(3);
  int fine = 0;
  for (int i = 0; i < 2000; ++i) {
    std::string obj = kCorner, mtl = kMtl + "map_Kd -s 1 1 1 wood.png\nbump -bm 2 b.png\nd 1\n";
    std::string& bytes = i % 2 == 0 ? obj : mtl;
    for (size_t k = 0; k <= random() % 3; ++k) {
      constexpr std::string_view kBytes = "0123456789-/. \nvfmKd";
      bytes[random() % bytes.size()] =
          random() % 3 == 0 ? static_cast<char>(random()) : kBytes[random() % kBytes.size()];
    }
    fine += MessageOf(obj, mtl) == "fine" ? 1 : 0;
  }
  CHECK(fine > 0);
  CHECK(fine < 2000);
}

}  // namespace
}  // namespace nacre
