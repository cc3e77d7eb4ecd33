// SPDX-License-Identifier: Apache-2.0
// OBJ files as scenes of their own, with their material libraries.
#include <algorithm>
#include <cmath>
#include <random>

#include <fmt/format.h>

#include "catch.h"
#include "image_io/png_writer.h"
#include "messages.h"
#include "scene/limits.h"
#include "scene_io/gltf_builder.h"
#include "scene_io/model_files.h"

namespace nacre {
namespace {

const std::string kCorner =
    "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nusemtl red\nf 1 3 4\n"
    "usemtl blue\nf 1 4 2\nusemtl red\nf 2 4 3\n";
const std::string kMtl =
    "newmtl red\nKa 0.1 0 0\nKd 0.8 0.1 0.1\nKs 0.5 0.5 0.5\nNs 50\nillum 2\n"
    "newmtl blue\nKd 0 0 1\nKs 1 1 1\nKe 0 0 2\nillum 1\n";

const std::string kOneRed =
    "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nusemtl red\nf 1/1 2/1 3/1\n";

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
  return ErrorOf([&] { Load(obj, mtl); });
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

TEST_CASE("every image of a material library is shown, or told once") {
  const ModelFolder folder;
  folder.Write("t.ppm", "P6\n1 1\n255\nabc");
  const std::string obj =
      "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nusemtl m\nf 1/1 2/1 3/1\n";
  const auto load = [&](const std::string& mtl) {
    Loaded loaded;
    LoadOptions options;
    options.on_warning = [&](const std::string& text) { loaded.warnings.push_back(text); };
    folder.Write("a.mtl", "newmtl m\nKd .5 .5 .5\n" + mtl);
    loaded.scene = LoadScene(folder.Write("m.obj", obj), options);
    for (const std::string& warning : loaded.warnings) UNSCOPED_INFO(warning);
    return loaded;
  };
  for (const std::string shown : {"map_Kd", "map_Ks", "map_Ns", "map_Ke", "map_emissive", "norm",
                                  "map_Kn", "map_Pr", "map_Pm", "MAP_PR"}) {
    for (const std::string reading : {"", "Pr .5\n"}) {
      CAPTURE(shown, reading);
      const auto [scene, warnings] = load(reading + shown + " t.ppm\n");
      const bool classic_alone = shown == "map_Ks" || shown == "map_Ns";
      if (reading.empty() || !classic_alone) {
        CHECK(warnings.empty());
        CHECK(scene.textures.size() == 1);
      } else {
        CHECK(warnings.size() == 1);
      }
    }
  }
  for (const std::string told : {"bump", "map_Bump", "map_bump -bm 0.3", "disp", "map_disp", "refl",
                                 "refl -type sphere -mm 0 1", "map_refl", "decal", "map_d",
                                 "map_Tr", "map_Ka", "map_RMA", "map_ORM", "map_opacity"}) {
    for (const std::string reading : {"", "Pr .5\n", "illum 0\n"}) {
      CAPTURE(told, reading);
      const auto [scene, warnings] = load(reading + told + " t.ppm\n" + told + " t.ppm\nd .5\n");
      const bool transparent = told == "map_d" || told == "map_Tr";
      CHECK(warnings.size() == (transparent ? 1 : 2));  // d is told as well
    }
  }
  for (const std::string layer : {"map_Ps", "map_Pc", "Pc .5\nmap_Pcr"}) {
    CAPTURE(layer);
    const std::string statement = layer + " t.ppm\n";
    const auto [scene, warnings] = load("Pr .5\n" + statement);
    CHECK(warnings.empty());
    CHECK(scene.textures.size() == 1);
    for (const std::string reading : {"", "Pr .5\nillum 0\n"}) {
      const auto [classic, told] = load(reading + statement + statement);
      REQUIRE(told.size() == 1);
      CHECK(Contains(told[0], "sheen and clear coats (Ps, Pc) are shown only of"));
      CHECK(classic.textures.empty());
    }
  }
  CHECK(load("map_Ns -imfchan g t.ppm\n").warnings.size() == 1);
  CHECK(load("map_Ns -imfchan l t.ppm\n").warnings.empty());
  const Scene raised = load("norm -bm 0.25 t.ppm\n").scene;
  CHECK(raised.materials.at(0).normal_map.scale == 0.25);
}

TEST_CASE("material libraries are read however they are written") {
  const auto kd = [](const std::string& obj, const std::string& mtl) {
    const auto [scene, warnings] = Load(obj, mtl);
    for (const std::string& warning : warnings) UNSCOPED_INFO(warning);
    CHECK(warnings.empty());
    const auto* phong =
        std::get_if<PhongMaterial>(&scene.materials.at(scene.meshes.at(0).material.index).model);
    return phong == nullptr ? Rgb(-1) : phong->kd;
  };
  const std::string faces = "v 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl red thing\nf 1 2 3\n";
  const std::string obj = "mtllib a.mtl\n" + faces;
  CHECK(kd(obj, "newmtl red thing\nKd 1 0 0\n") == Rgb(1, 0, 0));
  CHECK(kd(obj, "\xef\xbb\xbfnewmtl red thing\nKd 1 0 0\n") == Rgb(1, 0, 0));
  CHECK(kd(obj, "newmtl red thing\rKd 1 0 0\r") == Rgb(1, 0, 0));
  CHECK(kd(obj, "NEWMTL red thing \r\n\tKD 1. \\\r\n 0 .0\r\n") == Rgb(1, 0, 0));
  CHECK(kd(obj, "newmtl red thing\nKd .5\n") == Rgb(0.5));
  CHECK(kd("mtllib \"a.mtl\"\n" + faces, "newmtl red thing\nKd 1 0 0\n") == Rgb(1, 0, 0));
  CHECK(kd("mtllib ./a.mtl\nmtllib a.mtl\n" + faces, "newmtl red thing\nKd 1 0 0\n") ==
        Rgb(1, 0, 0));
  CHECK(kd("mtllib .\\a.mtl\n" + faces, "newmtl red thing\nKd 1 0 0\n") == Rgb(1, 0, 0));
  // A name with blanks, and several names.
  const ModelFolder folder;
  folder.Write("my mat.mtl", "newmtl red thing\nKd 1 0 0\n");
  folder.Write("b.mtl", "newmtl other\nKd 0 1 0\n");
  for (const char* names : {"my mat.mtl", "\"my mat.mtl\""}) {
    const Scene scene =
        LoadScene(folder.Write("m.obj", std::string("mtllib ") + names + "\n" + faces));
    CHECK(std::get<PhongMaterial>(scene.materials.at(0).model).kd == Rgb(1, 0, 0));
  }
  folder.Write("c.mtl", "newmtl red thing\nKd 1 0 0\n");
  const Scene two = LoadScene(folder.Write("m.obj", "mtllib b.mtl c.mtl\n" + faces));
  CHECK(two.materials.size() == 3);
  CHECK(two.meshes.at(0).material.index == 1);
}

TEST_CASE("images of material libraries are found by Windows' paths, with their options") {
  const ModelFolder folder;
  std::filesystem::create_directory(folder.path / "sub");
  folder.Write("sub/my tex.ppm", "P6\n1 1\n255\nabc");
  folder.Write("tex.ppm", "P6\n1 1\n255\nabc");
  const std::string obj =
      "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nusemtl m\nf 1/1 2/1 3/1\n";
  for (const char* name :
       {"sub\\my tex.ppm", "sub/my tex.ppm", "\"sub/my tex.ppm\"", "D:\\art\\tex.ppm",
        "-s 2 2 1 -o 0.5 0 -clamp on -bm 3 tex.ppm", "tex.ppm -bm 0.3"}) {
    INFO(name);
    folder.Write("a.mtl", std::string("newmtl m\nmap_Kd ") + name + "\n");
    std::vector<std::string> warnings;
    LoadOptions options;
    options.on_warning = [&](const std::string& text) { warnings.push_back(text); };
    const Scene scene = LoadScene(folder.Write("m.obj", obj), options);
    CHECK(warnings.empty());
    REQUIRE(scene.textures.size() == 1);
    const bool has_options = std::string(name).starts_with("-s");
    CHECK(scene.textures[0].scale == (has_options ? Vec2d(2, 2) : Vec2d(1, 1)));
    CHECK(scene.textures[0].offset == (has_options ? Vec2d(0.5, 0) : Vec2d(0, 0)));
    CHECK(scene.textures[0].sampling.wrap_u == (has_options ? Wrap::kClamp : Wrap::kRepeat));
  }
}

TEST_CASE("materials with a roughness or a metallic are metallic-roughness") {
  const std::string mtl =
      "newmtl red\nKd 0.5 0.25 1\nPr 0.3\nPm 0.75\nNi 1.5\nKe 0 1 0\n"
      "newmtl blue\nKd 1 1 1\nNs 6\nPm 1\nPs 0.5\nPc 1\nPcr 0.2\n";
  const auto [scene, warnings] = Load(kCorner, mtl);
  CHECK(warnings.empty());
  const auto& red = std::get<MetallicRoughnessMaterial>(scene.materials.at(0).model);
  CHECK(red.base_color == Rgb(0.5, 0.25, 1));
  CHECK(red.roughness == 0.3);
  CHECK(red.metallic == 0.75);
  CHECK(red.dielectric_f0.x == Approx(0.04).epsilon(1e-15));
  CHECK(scene.materials.at(0).emission == Rgb(0, 1, 0));
  // alpha^2 = 2 / (6 + 2), and roughness^2 = alpha.
  const auto& blue = std::get<MetallicRoughnessMaterial>(scene.materials.at(1).model);
  CHECK(blue.roughness == Approx(std::sqrt(0.5)).epsilon(1e-15));
  // Their images, as green and blue of one.
  const ModelFolder folder;
  folder.Write("r.ppm", "P6\n1 1\n255\n" + std::string(3, '\x33'));
  folder.Write("m.ppm", "P6\n1 1\n255\n" + std::string(3, '\x66'));
  folder.Write("a.mtl", "newmtl red\nmap_Pr r.ppm\nmap_Pm m.ppm\nnewmtl blue\nmap_Pr r.ppm\n");
  const Scene mapped = LoadScene(folder.Write("m.obj", kCorner));
  const auto texel = [&](size_t material, int channel) {
    const auto& model = std::get<MetallicRoughnessMaterial>(mapped.materials.at(material).model);
    const Texture& texture = mapped.textures.at(model.metallic_roughness_map.index);
    return mapped.images.at(texture.image.index).texels->Value(0, 0, 0, channel);
  };
  CHECK(texel(0, 1) == 0.2f);
  CHECK(texel(0, 2) == 0.4f);
  CHECK(texel(1, 1) == 0.2f);
  CHECK(texel(1, 2) == 1);
  const auto& both = std::get<MetallicRoughnessMaterial>(mapped.materials.at(0).model);
  CHECK(both.roughness == 1);
  CHECK(both.metallic == 1);
}

TEST_CASE("sheen and clear coats of material libraries are those of metallic-roughness") {
  const auto [scene, warnings] =
      Load(kCorner,
           "newmtl red\nPr 0.4\nPs 0.5\nnewmtl blue\nPm 0\nPc 0.75\nPcr 0.2\nnewmtl none\nPr 1\n");
  CHECK(warnings.empty());
  const auto model = [](const Scene& of, size_t material) {
    return std::get<MetallicRoughnessMaterial>(of.materials.at(material).model);
  };
  CHECK(model(scene, 0).sheen_color == Rgb(0.5));
  CHECK(model(scene, 0).sheen_roughness == 0.5);
  CHECK(model(scene, 0).coat == 0);
  CHECK(model(scene, 1).coat == 0.75);
  CHECK(model(scene, 1).coat_roughness == 0.2);
  CHECK(model(scene, 1).sheen_color == Rgb(0));
  CHECK(model(scene, 2).coat == 0);
  CHECK(model(scene, 2).sheen_color == Rgb(0));
  // Of the Phong family, and where colours are constant, they are told.
  for (const char* mtl :
       {"newmtl red\nPs 0.5\n", "newmtl red\nPc 0.5\n", "newmtl red\nillum 0\nPr 0.5\nPc 0.5\n"}) {
    CAPTURE(mtl);
    const std::vector<std::string> told = Load(kOneRed, mtl).warnings;
    REQUIRE(told.size() == 1);
    CHECK(Contains(told[0], "sheen and clear coats (Ps, Pc) are shown only of"));
  }
  CHECK(Load(kOneRed, "newmtl red\nPs 0\nPc 0\nPcr 0.03\n").warnings.empty());
  // Images multiply the numbers, of which 0 counts as none; they are data.
  const ModelFolder folder;
  folder.Write("grey.ppm", "P6\n1 1\n255\n" + std::string(3, '\x33'));
  const std::string maps = "map_Ps grey.ppm\nmap_Pc grey.ppm\nmap_Pcr grey.ppm\n";
  folder.Write("a.mtl", "newmtl red\nPr 1\nPs 0\n" + maps +
                            "newmtl blue\nPr 1\nPs 0.5\nPc 0.25\nPcr 0.75\n" + maps);
  const Scene mapped = LoadScene(folder.Write("m.obj", kCorner));
  const auto texel = [&](TextureId texture) {
    const ImageId image = mapped.textures.at(texture.index).image;
    return mapped.images.at(image.index).texels->Value(0, 0, 0, 0);
  };
  const MetallicRoughnessMaterial red = model(mapped, 0), blue = model(mapped, 1);
  CHECK(red.sheen_color == Rgb(1));
  CHECK(red.coat == 1);
  CHECK(red.coat_roughness == 1);
  CHECK(blue.sheen_color == Rgb(0.5));
  CHECK(blue.coat == 0.25);
  CHECK(blue.coat_roughness == 0.75);
  CHECK(texel(red.sheen_color_map) == 0.2f);
  CHECK(texel(red.coat_map) == 0.2f);
  CHECK(texel(blue.coat_roughness_map) == 0.2f);
}

TEST_CASE("a grey image of normals is left out, with a warning") {
  const ModelFolder folder;
  folder.Write("grey.pgm", "P5\n2 1\n255\n\x10\xff");
  folder.Write("a.mtl", "newmtl red\nKd 1 0 0\nnorm grey.pgm\n");
  LoadOptions options;
  std::vector<std::string> warnings;
  options.on_warning = [&](const std::string& text) { warnings.push_back(text); };
  const Scene scene = LoadScene(folder.Write("m.obj", kCorner), options);
  for (const Material& material : scene.materials) CHECK(!material.normal_map.texture.valid());
  CHECK(std::any_of(warnings.begin(), warnings.end(), [](const std::string& text) {
    return Contains(text, "an image of normals (norm) is left out: it is grey");
  }));
}

TEST_CASE("colours of vertices are shown") {
  const Scene scene = Load("v 0 0 0 1 0 0\nv 1 0 0 0 0.5 1\nv 0 1 0\nf 1 2 3\n", "").scene;
  REQUIRE(scene.meshes.size() == 1);
  const Mesh& mesh = scene.meshes[0];
  REQUIRE(mesh.colors.size() == 3);
  CHECK(mesh.colors[0] == Vec3f(1, 0, 0));
  CHECK(mesh.colors[1].y == Approx(0.21404114).epsilon(1e-6));  // sRGB 0.5, IEC 61966-2-1
  CHECK(mesh.colors[2] == Vec3f(1));
  CHECK(scene.materials.at(mesh.material.index).vertex_colors == VertexColors::kBase);
  // Codes of bytes.
  const Scene codes = Load("v 0 0 0 255 0 0\nv 1 0 0 0 51 0\nv 0 1 0 0 0 0\nf 1 2 3\n", "").scene;
  CHECK(codes.meshes.at(0).colors.at(0) == Vec3f(1, 0, 0));
  CHECK(codes.meshes.at(0).colors.at(1).y == Approx(0.03310477).epsilon(1e-6));  // sRGB 0.2
}

TEST_CASE("an image that cannot be read is left out, and told once") {
  const ModelFolder folder;
  folder.Write("t.bmp", "BM" + std::string(60, '\0'));
  folder.Write("good.ppm", "P6\n1 1\n255\nabc");
  for (const char* map : {"map_Kd", "map_Ks", "map_Ns", "map_Ke", "map_Pr", "map_Pm", "norm"}) {
    INFO(map);
    const std::string broken = std::string(map) + " t.bmp\n";
    folder.Write("a.mtl", "newmtl a\n" + broken + "newmtl b\n" + broken + "newmtl c\n" + map +
                              " good.ppm\n");
    std::vector<std::string> warnings;
    LoadOptions options;
    options.on_warning = [&](const std::string& text) { warnings.push_back(text); };
    const Scene scene =
        LoadScene(folder.Write("m.obj",
                               "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl a\nf 1 2 3\n"
                               "usemtl b\nf 1 2 3\nusemtl c\nf 1 2 3\n"),
                  options);
    CHECK(scene.meshes.size() == 3);
    CHECK(scene.textures.size() == 1);
    const auto broken_ones = std::count_if(warnings.begin(), warnings.end(), [](const auto& text) {
      return Contains(text, "an image is left out: ") && Contains(text, "a.mtl:2: \"t.bmp\": ");
    });
    CHECK(broken_ones == 1);
  }
}

TEST_CASE("only an index 0 that is written is told") {
  const std::string head = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvn 0 0 1\n";
  for (const char* face : {"f 1 2 3", "f 1/ 2/ 3/", "f 1// 2// 3//", "f 1//1 2//1 3//1",
                           "f 1/1 2/1 3/1", "f 1/1/ 2/1/ 3/1/"}) {
    INFO(face);
    CHECK(Load(head + face + "\n", "").warnings.empty());
  }
  for (const char* face : {"f 1/0 2/0 3/0", "f 1/0/1 2/0/1 3/0/1", "f 1/0/ 2/0/ 3/0/"}) {
    INFO(face);
    const std::vector<std::string> warnings = Load(head + face + "\n", "").warnings;
    REQUIRE(warnings.size() == 1);
    CHECK(Contains(warnings[0], "texture coordinates of index 0"));
  }
  const std::vector<std::string> warnings = Load(head + "f 1//0 2//0 3//0\n", "").warnings;
  REQUIRE(warnings.size() == 1);
  CHECK(Contains(warnings[0], "normals of index 0"));
}

TEST_CASE("what is left out of an OBJ file is told once") {
  std::string obj = "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\n";
  for (int i = 0; i < 3; ++i) obj += "l 1 2\np 1\ncurv 0 1 1 2\nsurf 0 1 0 1 1\nhello 1\nworld\n";
  for (int i = 0; i < 30; ++i) obj += "usemtl n" + std::to_string(i) + "\nf 1 2 3\n";
  const std::vector<std::string> warnings = Load(obj, kMtl).warnings;
  const auto count = [&](const std::string& part) {
    return std::count_if(warnings.begin(), warnings.end(),
                         [&](const std::string& text) { return Contains(text, part); });
  };
  CHECK(count("lines are not shown") == 1);
  CHECK(count("points are not shown") == 1);
  CHECK(count("free-form") == 1);
  CHECK(count("the first is \"hello\"") == 1);
  CHECK(count("no material library has \"n0\"") == 1);
  CHECK(count("no material library has") == 8);
  CHECK(count("and 22 more materials") == 1);
  CHECK(warnings.size() == 13);
}

TEST_CASE("what is wrong with a material library is said") {
  CHECK(Contains(MessageOf(kCorner, "newmtl red\nKd 1 x 0\n"), "a.mtl:2: \"x\" is not a finite"));
  CHECK(Contains(MessageOf(kCorner, "newmtl red\nPr 0,5\n"), "a.mtl:2: \"0,5\" is not a finite"));
  CHECK(Contains(MessageOf("mtllib ../b.mtl\n" + kCorner, kMtl), "\"../b.mtl\" is outside"));
  CHECK(Contains(MessageOf("v 0 0 0\nf 1 1 1\n", kMtl), "has no face with an area"));
}

TEST_CASE("numbers out of range are clamped, with one warning that names the first") {
  const auto [scene, warnings] =
      Load(kCorner,
           "newmtl red\nKd 0.5 1.2 -1\nKs 5 0 0\nNs -1\nKe -2 3 0\nnewmtl blue\nPr 1.2\nPm -0.5\n"
           "newmtl hot\nNs 1e20\nPr -3\nPm 2\nKa 7\nKe 1e40\n");
  REQUIRE(warnings.size() == 1);
  CHECK(Contains(warnings[0],
                 "model.obj: numbers out of range are clamped, the first is kd 1.2 in "));
  CHECK(Contains(warnings[0], "a.mtl:2 (from 0 to 1)"));
  const auto& red = std::get<PhongMaterial>(scene.materials.at(0).model);
  CHECK(red.kd == Rgb(0.5, 1, 0));
  CHECK(red.ks == Rgb(1, 0, 0));
  CHECK(red.shininess == 0);
  CHECK(scene.materials.at(0).emission == Rgb(0, 3, 0));
  const auto& blue = std::get<MetallicRoughnessMaterial>(scene.materials.at(1).model);
  CHECK(blue.roughness == 1);
  CHECK(blue.metallic == 0);
  CHECK(scene.materials.at(2).emission == Rgb(limits::kRadiance.max));
  CHECK(Load(kOneRed, "newmtl red\nKd 0 1 0.5\nNs 1e9\n").warnings.empty());
}

TEST_CASE("numbers that are none are left out, with one warning that names the first") {
  const auto [scene, warnings] = Load(
      kOneRed, "newmtl red\nKd .5 .5 .5\nKs .25\nNs 1.#QNAN\nKd nan 0 0\nKs 0 -inf 1\nd\nPr # x\n");
  REQUIRE(warnings.size() == 1);
  CHECK(Contains(warnings[0], "numbers that are none are left out, the first is ns in "));
  CHECK(Contains(warnings[0], "a.mtl:4"));
  const auto& red = std::get<PhongMaterial>(scene.materials.at(0).model);
  CHECK(red.kd == Rgb(0.5));
  CHECK(red.ks == Rgb(0.25));
  CHECK(red.shininess == 1);
}

TEST_CASE("opacity is d, or what Tr leaves where there is no d") {
  const auto is_told = [](const std::string& mtl) {
    return !Load(kOneRed, "newmtl red\n" + mtl).warnings.empty();
  };
  CHECK(is_told("d 0.5\n"));
  CHECK(is_told("Tr 0.5\n"));
  CHECK(is_told("Tr 0\nd 0.5\n"));
  CHECK_FALSE(is_told("d 1\nTr 1\n"));
  CHECK_FALSE(is_told("Tr 1\nd 1\n"));
}

TEST_CASE("comments behind names are none of them, and names may have the sign") {
  // The material of the only face: its name and its red.
  const auto shown = [](const std::string& use, const std::string& mtl) {
    const auto [scene, warnings] = Load(
        "mtllib a.mtl # of the set\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl " + use + "\nf 1 2 3\n", mtl);
    for (const std::string& warning : warnings) UNSCOPED_INFO(warning);
    CHECK(warnings.empty());
    const Material& material = scene.materials.at(scene.meshes.at(0).material.index);
    const auto* phong = std::get_if<PhongMaterial>(&material.model);
    return std::make_pair(material.name, phong == nullptr ? -1 : phong->kd.x);
  };
  using Shown = std::pair<std::string, double>;
  for (const char* const use : {"Red", "Red # front", "Red #", "Red #front", "Red\t# a # b"}) {
    INFO(use);
    CHECK(shown(use, "newmtl Blue\nnewmtl Red # the front\nKd 1 0 0 # red\n") == Shown("Red", 1));
    CHECK(shown(use, "newmtl Blue\nnewmtl Red\nKd 1 0 0\n") == Shown("Red", 1));
  }
  CHECK(shown("Red", "newmtl Red #front\nKd 1\n") == Shown("Red #front", 1));
  const std::string numbered = "newmtl Material #25\nKd .25\nnewmtl Material #26\nKd .5\n";
  CHECK(shown("Material #26", numbered) == Shown("Material #26", 0.5));
  CHECK(shown("Material #25 # x", numbered).second == 0.25);
  CHECK(shown("a # b", "newmtl a\nKd .25\nnewmtl a # b\nKd .5\n").second == 0.5);
  CHECK(shown("", "newmtl x\n").first == "default");
  const auto [scene, warnings] =
      Load("mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl Material #3\nf 1 2 3\n",
           "newmtl Material #2\n");
  REQUIRE(warnings.size() == 1);
  CHECK(Contains(warnings[0], "no material library has \"Material #3\""));
}

TEST_CASE("several libraries are found, however their names are written, and missing ones told") {
  const std::string faces = "v 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl red\nf 1 2 3\n";
  const ModelFolder folder;
  const std::string red = "newmtl red\nKd 1 0 0\n";
  const auto warnings_of = [&](const std::string& libraries, bool is_red) {
    CAPTURE(libraries);
    std::vector<std::string> warnings;
    LoadOptions options;
    options.on_warning = [&](const std::string& text) { warnings.push_back(text); };
    const Scene scene = LoadScene(folder.Write("model.obj", libraries + faces), options);
    const Material& material = scene.materials.at(scene.meshes.at(0).material.index);
    const auto* phong = std::get_if<PhongMaterial>(&material.model);
    CHECK((phong != nullptr && phong->kd == Rgb(1, 0, 0)) == is_red);
    std::string all;
    for (const std::string& warning : warnings) all += warning.substr(warning.find(": ")) + "|";
    return all;
  };
  folder.Write("red.mtl", red);
  folder.Write("my red.mtl", red);
  folder.Write("other.mtl", "newmtl blue\n");
  for (const char* const line :
       {"red.mtl", "other.mtl red.mtl", "red.mtl other.mtl", "my red.mtl", "other.mtl my red.mtl",
        "my red.mtl other.mtl", "\"my red.mtl\" # x", "my\\ red.mtl", "red.mtl #x",
        "RED\\..\\red.mtl", "other.mtl\nmtllib red.mtl", "C:\\art\\my red.mtl",
        "/home/a/red.mtl"}) {
    CHECK(warnings_of("mtllib " + std::string(line) + "\n", true).empty());
  }
  const std::string left_out = ": a material library is left out: there is no file ";
  CHECK(warnings_of("mtllib missing.mtl red.mtl\n", true) == left_out + "\"missing.mtl\"|");
  CHECK(warnings_of("mtllib no.mtl\nmtllib red.mtl no such.mtl\n", true) ==
        left_out + "\"no.mtl\"|" + left_out + "\"no such.mtl\"|");
  CHECK(warnings_of("mtllib no.mtl\n", false) ==
        ": its materials are left out: there is no file \"no.mtl\"|");
  // Of the machine that the model was made on: nothing outside of the folder is opened.
  CHECK(warnings_of("mtllib /home/artist/no.mtl\n", false) ==
        ": its materials are left out: \"/home/artist/no.mtl\" is outside the model's folder|");
  folder.Write("red.mtl", "newmtl red\nKd 1 0 0\nmap_Kd /home/artist/wood.png\n");
  CHECK(warnings_of("mtllib red.mtl\n", true) ==
        ": an image is left out: \"/home/artist/wood.png\" is outside the model's folder|");
  folder.Write("red.mtl", red);
  // What is called as the model is.
  folder.Write("model.mtl", red);
  const std::string namesake =
      ": its materials are read from \"model.mtl\", which it does not name|";
  CHECK(warnings_of("", true) == namesake);
  CHECK(warnings_of("mtllib no.mtl\n", true) == namesake + left_out + "\"no.mtl\"|");
  CHECK(warnings_of("mtllib /home/artist/no.mtl\n", true) ==
        namesake +
            ": a material library is left out: \"/home/artist/no.mtl\" is outside the "
            "model's folder|");
  CHECK(warnings_of("mtllib red.mtl\n", true).empty());
}

TEST_CASE("images are found beside their library, too") {
  const ModelFolder folder;
  std::filesystem::create_directories(folder.path / "sub/maps");
  folder.Write("sub/maps/tex.ppm", "P6\n1 1\n255\nabc");
  folder.Write("sub/a.mtl", "newmtl red\nmap_Kd maps\\tex.ppm # wood\n");
  const Scene scene = LoadScene(folder.Write(
      "m.obj", "mtllib sub/a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nusemtl red\nf 1/1 2/1 3/1\n"));
  CHECK(scene.textures.size() == 1);
}

TEST_CASE("averages of smoothing groups go over the borders of materials") {
  const Scene scene =
      Load(
          "v -1 0 0\nv 0 0 1\nv 0 1 1\nv 1 0 0\ns 1\nusemtl a\nf 1 2 3\nusemtl b\nf 2 4 3\n"
          "mtllib a.mtl\n",
          "newmtl a\nnewmtl b\n")
          .scene;
  REQUIRE(scene.meshes.size() == 2);
  for (const Mesh& mesh : scene.meshes) {
    for (size_t i = 0; i < mesh.positions.size(); ++i) {
      if (mesh.positions[i].x == 0) CHECK(std::abs(mesh.normals.at(i).x) < 1e-15);
    }
  }
}

TEST_CASE("colours as spectra or XYZ are left out, with one warning") {
  const auto [scene, warnings] =
      Load(kOneRed, "newmtl red\nKa spectral a.rfl 1\nKd xyz 0.1 0.2 0.3\nKs 0.5\n");
  REQUIRE(warnings.size() == 1);
  CHECK(Contains(warnings[0], "the first is ka spectral in "));
  CHECK(Contains(warnings[0], "a.mtl:2"));
  CHECK(std::get<PhongMaterial>(scene.materials.at(0).model).ks == Rgb(0.5));
}

TEST_CASE("a comment ends with its line, a backslash at its end or not") {
  const auto triangles = [](const std::string& faces) {
    size_t count = 0;
    for (const Mesh& mesh : Load("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n" + faces, "").scene.meshes) {
      count += mesh.triangles.size() / 3;
    }
    return count;
  };
  CHECK(triangles("f 1 2 3 # x \\\nf 2 4 3\n") == 2);
  CHECK(triangles("# x \\\nf 2 4 3\n") == 1);
  CHECK(triangles("f 1 2 3 #\\\r\nf 2 4 3\n") == 2);
  CHECK(triangles("f 1 2 \\\n3 # x \\\nf 2 4 3\n") == 2);  // in a line that was continued
  CHECK(triangles("f 1 \\\n 2 \\\n4 3\n") == 2);
  CHECK(triangles("usemtl a#1 \\\nf 2 4 3\nf 1 2 3\n") == 1);  // a # within a word is none
  const auto [scene, warnings] = Load(kCorner, "newmtl red # x \\\nKd 0 1 0 # y \\\nKs 1 # z\\");
  CHECK(std::get<PhongMaterial>(scene.materials.at(0).model).kd == Rgb(0, 1, 0));
  CHECK(std::get<PhongMaterial>(scene.materials.at(0).model).ks == Rgb(1));
}

TEST_CASE("constant colours (illum 0) have images, too") {
  const ModelFolder folder;
  folder.Write("a.ppm", "P6\n1 1\n255\nabc");
  folder.Write("b.ppm", "P6\n1 1\n255\nabc");
  std::vector<std::string> warnings;
  LoadOptions options;
  options.on_warning = [&](const std::string& text) { warnings.push_back(text); };
  const auto load = [&](const std::string& mtl) {
    warnings.clear();
    folder.Write("a.mtl", "newmtl red\nillum 0\n" + mtl);
    const Scene scene = LoadScene(folder.Write("m.obj", kOneRed), options);
    const Material& material = scene.materials.at(0);
    CHECK(std::get<PhongMaterial>(material.model).kd == Rgb(0));
    CHECK_FALSE(material.normal_map.texture.valid());
    const TextureId map = material.emission_map;
    return std::make_pair(material.emission,
                          map.valid() ? scene.textures.at(map.index).name : std::string());
  };
  using Shown = std::pair<Rgb, std::string>;
  CHECK(load("Kd 0.5 0.25 0\n") == Shown(Rgb(0.5, 0.25, 0), ""));
  CHECK(load("Kd 0.5 0.25 0\nKe 1 1 1\n") == Shown(Rgb(1.5, 1.25, 1), ""));
  CHECK(load("Kd 0.5 0.25 0\nmap_Kd a.ppm\nnorm b.ppm\n") == Shown(Rgb(0.5, 0.25, 0), "a.ppm"));
  CHECK(load("map_Kd a.ppm\n") == Shown(Rgb(1), "a.ppm"));
  CHECK(load("map_Ke b.ppm\nKe 2 2 2\n") == Shown(Rgb(2), "b.ppm"));
  CHECK(warnings.empty());
  // Two colours of which one has an image.
  for (const char* mtl :
       {"Kd 1 0 0\nmap_Kd a.ppm\nKe 1 1 1\n", "Kd 1 0 0\nmap_Kd a.ppm\nmap_Ke b.ppm\n"}) {
    CHECK(load(mtl) == Shown(Rgb(1, 0, 0), "a.ppm"));
    CHECK(warnings.size() == 1);
  }
  CHECK(load("Kd 1 0 0\nmap_Ke b.ppm\n") == Shown(Rgb(1, 0, 0), ""));
  CHECK(warnings.size() == 1);
  load("map_Kd a.ppm\nmap_d b.ppm\n");
  CHECK(warnings.size() == 1);
}

TEST_CASE("an image is decoded once, however its name is spelled") {
  const ModelFolder folder;
  std::filesystem::create_directory(folder.path / "sub");
  folder.Write("r.ppm", "P6\n1 1\n255\nabc");
  folder.Write("wide.ppm", "P6\n2 1\n255\nabcdef");
  std::string mtl;
  int count = 0;
  for (const char* name : {"r.ppm", "./r.ppm", "sub/../r.ppm", ".\\r.ppm", "\"r.ppm\""}) {
    mtl += fmt::format("newmtl m{0}\nmap_Kd {1}\nnewmtl p{0}\nmap_Pr {1}\nmap_Pm {1}\n", count++,
                       name);
  }
  // A pair that does not fit.
  for (int i = 0; i < 3; ++i) mtl += "newmtl x\nmap_Pr r.ppm\nmap_Pm wide.ppm\n";
  folder.Write("a.mtl", mtl);
  std::vector<std::string> warnings;
  LoadOptions options;
  options.on_warning = [&](const std::string& text) { warnings.push_back(text); };
  const Scene scene = LoadScene(folder.Write("m.obj", kCorner), options);
  CHECK(scene.images.size() == 2);  // as sRGB, and as roughness and metallic
  CHECK(std::count_if(warnings.begin(), warnings.end(), [](const std::string& text) {
          return Contains(text, "differ in size");
        }) == 1);
}

// 32 times its values would be more than the images of a model may have (TexelBudget).
TEST_CASE("a pair of images that does not fit is decoded once, too") {
  const ModelFolder folder;
  WritePng((folder.path / "r.png").string(), FilledPicture(1024, 1024, {9, 9, 9}));
  WritePng((folder.path / "m.png").string(), FilledPicture(1024, 1023, {9, 9, 9}));
  std::string mtl;
  for (int i = 0; i < 32; ++i) mtl += fmt::format("newmtl m{}\nmap_Pr r.png\nmap_Pm m.png\n", i);
  folder.Write("a.mtl", mtl);
  std::vector<std::string> warnings;
  LoadOptions options;
  options.on_warning = [&](const std::string& text) { warnings.push_back(text); };
  LoadScene(folder.Write("m.obj", kCorner), options);
  const auto count = [&](const char* text) {
    return std::count_if(warnings.begin(), warnings.end(),
                         [&](const std::string& warning) { return Contains(warning, text); });
  };
  CHECK(count("differ in size") == 1);
  CHECK(count("too many") == 0);
}

TEST_CASE("materials of one name become different ones") {
  const Scene scene = Load(kCorner, "newmtl a#2\nnewmtl a\nnewmtl a\nnewmtl default\n").scene;
  std::vector<std::string> names;
  for (const Material& material : scene.materials) names.push_back(material.name);
  CHECK(names == std::vector<std::string>{"a#2", "a", "a#3", "default", "default#4"});
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
    fine += MessageOf(obj, mtl) == "no error" ? 1 : 0;
  }
  CHECK(fine > 0);
  CHECK(fine < 2000);
}

}  // namespace
}  // namespace nacre
