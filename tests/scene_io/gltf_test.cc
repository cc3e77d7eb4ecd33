// SPDX-License-Identifier: Apache-2.0
// What glTF files say: nodes, meshes, materials, cameras and lights.
#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "catch.h"
#include "messages.h"
#include "scene/mesh.h"
#include "scene_io/gltf_builder.h"

namespace nacre {
namespace {

// The area times the normal of the mesh's triangles, summed.
Vec3d VectorArea(const Mesh& mesh) {
  Vec3d sum(0, 0, 0);
  for (size_t i = 0; i < mesh.triangles.size(); i += 3) {
    const Vec3d& a = mesh.positions[mesh.triangles[i]];
    sum += (mesh.positions[mesh.triangles[i + 1]] - a)
               .cross(mesh.positions[mesh.triangles[i + 2]] - a) /
           2;
  }
  return sum;
}

Mesh MeshOf(const GltfFile& file) {
  const Scene scene = LoadFile(file);
  REQUIRE(scene.meshes.size() == 1);
  return scene.meshes[0];
}

// The square with this node in the place of its own.
Mesh MeshWithNode(const std::string& node) {
  GltfFile file = MakeSquare();
  file.json["nodes"][0] = Json::parse(node);
  return MeshOf(file);
}

bool Near(const Vec3d& a, const Vec3d& b) { return (a - b).length() < 1e-12; }  // unit sizes

TEST_CASE("a square") {
  const Mesh mesh = MeshOf(MakeSquare());
  CHECK(mesh.name == "square");
  CHECK(mesh.positions == std::vector<Vec3d>{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}});
  CHECK(mesh.triangles == std::vector<uint32_t>{0, 1, 2, 0, 2, 3});
  CHECK(mesh.normals.empty());  // the specification asks for flat ones then
  CHECK(mesh.uvs.empty());
}

TEST_CASE("a file of text with a file of bytes, or with the bytes in it") {
  const ModelFolder folder;
  GltfFile file = MakeSquare();
  folder.Write("data file.bin", file.bytes + "more");  // may be longer than it is said to be
  file.json["buffers"][0]["uri"] = "data%20file.bin";
  CHECK(LoadScene(folder.Write("model.gltf", file.json.dump())).meshes.size() == 1);

  GltfFile inside;
  inside.json = Json::parse(R"({"asset": {"version": "2.0"}, "nodes": [{"mesh": 0}],
      "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
      "accessors": [{"bufferView": 0, "componentType": 5121, "type": "VEC3", "count": 3}],
      "bufferViews": [{"buffer": 0, "byteLength": 9}],
      "buffers": [{"byteLength": 9, "uri": "data:application/octet-stream;base64,AAAAAQAAAAEA"}]})");
  const Scene scene = LoadScene(folder.Write("inside.gltf", inside.json.dump()));
  CHECK(scene.meshes.at(0).positions == std::vector<Vec3d>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
}

TEST_CASE("nodes scale, rotate and translate, parents after their children") {
  const double s = std::sqrt(0.5);
  CHECK(MeshWithNode(R"({"mesh": 0, "translation": [1, 2, 3], "scale": [2, 3, 4]})").positions[2] ==
        Vec3d(3, 5, 3));
  // A quarter turn about z: x to y.
  Json turned = {{"mesh", 0}, {"rotation", {0, 0, s, s}}, {"scale", {2, 1, 1}}};
  CHECK(Near(MeshWithNode(turned.dump()).positions[1], {0, 2, 0}));
  // And about x: y to z. About y: z to x.
  CHECK(Near(MeshWithNode(Json{{"mesh", 0}, {"rotation", {s, 0, 0, s}}}.dump()).positions[3],
             {0, 0, 1}));
  CHECK(Near(MeshWithNode(Json{{"mesh", 0}, {"rotation", {0, s, 0, s}}}.dump()).positions[1],
             {0, 0, -1}));
  // Stored by columns.
  CHECK(MeshWithNode(R"({"mesh": 0, "matrix": [0,1,0,0, -1,0,0,0, 0,0,1,0, 5,6,7,1]})")
            .positions[1] == Vec3d(5, 7, 7));

  GltfFile file = MakeSquare();
  file.json["nodes"] = Json::parse(R"([{"children": [1], "translation": [10, 0, 0]},
      {"mesh": 0, "scale": [2, 2, 2], "children": [2]}, {"mesh": 0, "translation": [1, 0, 0]}])");
  const Scene scene = LoadFile(file);
  REQUIRE(scene.meshes.size() == 2);
  CHECK(scene.meshes[0].positions[1] == Vec3d(12, 0, 0));
  CHECK(scene.meshes[1].positions[1] == Vec3d(14, 0, 0));
}

TEST_CASE("a mirrored mesh keeps its outside outside") {
  GltfFile file = MakeSquare();
  file.json["meshes"][0]["primitives"][0]["attributes"]["NORMAL"] =
      file.Accessor(std::vector<float>{0, 0, 1, 0, 0, 1, 0, 0.6f, 0.8f, 0, 0, 1}, 5126, "VEC3", 3);
  for (const std::array<int, 3> scale : {std::array{1, 1, 1}, {-1, 1, 1}, {1, -2, 1}, {1, 1, -3}}) {
    file.json["nodes"][0]["scale"] = scale;
    const Mesh mesh = MeshOf(file);
    const double side = scale[2] < 0 ? -1 : 1;
    CHECK(VectorArea(mesh).z * side > 0);
    CHECK(mesh.normals[0] == Vec3d(0, 0, side));
    // Perpendicular to (0, 4, -3) made (0, 4 sy, -3 sz).
    CHECK(std::abs(mesh.normals[2].dot(Vec3d(0, 4.0 * scale[1], -3.0 * scale[2]))) < 1e-6);
    CHECK(mesh.normals[2].z * side > 0);
  }
}

TEST_CASE("strips and fans wind like lists, points and lines are left out") {
  GltfFile file = MakeSquare();
  Json& primitive = file.json["meshes"][0]["primitives"][0];
  primitive["mode"] = 5;
  primitive["indices"] = file.Accessor(std::vector<uint8_t>{0, 1, 3, 2}, 5121, "SCALAR", 1);
  CHECK(MeshOf(file).triangles == std::vector<uint32_t>{0, 1, 3, 1, 2, 3});
  CHECK(VectorArea(MeshOf(file)) == Vec3d(0, 0, 1));
  primitive["mode"] = 6;
  primitive["indices"] = file.Accessor(std::vector<uint32_t>{0, 1, 2, 3}, 5125, "SCALAR", 1);
  CHECK(VectorArea(MeshOf(file)) == Vec3d(0, 0, 1));
  primitive.erase("indices");
  CHECK(VectorArea(MeshOf(file)) == Vec3d(0, 0, 1));
  for (const int mode : {0, 1, 2, 3}) {
    GltfFile both = MakeSquare();
    Json points = both.json["meshes"][0]["primitives"][0];
    points["mode"] = mode;
    both.json["meshes"][0]["primitives"].push_back(points);
    both.json["meshes"][0]["primitives"].push_back(points);
    std::vector<std::string> warnings;
    CHECK(LoadFile(both, &warnings).meshes.size() == 1);
    REQUIRE(warnings.size() == 1);
    CHECK(warnings[0].find("points and lines are not shown") != std::string::npos);
  }
}

TEST_CASE("accessors: strides, offsets, normalised integers and sparse ones") {
  GltfFile file = MakeSquare();
  Json& attributes = file.json["meshes"][0]["primitives"][0]["attributes"];
  // Positions of shorts among other numbers, normalised: 32767 is 1.
  const std::vector<int16_t> shorts = {9, 0,     0,     0, 9, 32767, 0,     0,
                                       9, 32767, 32767, 0, 9, 0,     32767, 0};
  attributes["POSITION"] = file.Accessor(shorts, 5122, "VEC3", 4);
  Json& accessor = file.json["accessors"].back();
  accessor["byteOffset"] = 2;
  accessor["normalized"] = true;
  file.json["bufferViews"].back()["byteStride"] = 8;
  CHECK(VectorArea(MeshOf(file)) == Vec3d(0, 0, 1));
  CHECK(MeshOf(file).positions[1] == Vec3d(1, 0, 0));
  accessor["normalized"] = false;
  CHECK(MeshOf(file).positions[1] == Vec3d(32767, 0, 0));

  // Bytes: -128 and -127 are both -1.
  attributes["POSITION"] = file.Accessor(
      std::vector<int8_t>{-128, -127, 0, 127, -127, 0, 127, 127, 0, -127, 127, 0}, 5120, "VEC3", 3);
  file.json["accessors"].back()["normalized"] = true;
  CHECK(VectorArea(MeshOf(file)) == Vec3d(0, 0, 4));

  // All zeros but two elements.
  const size_t index_bytes = file.Append(std::vector<uint16_t>{1, 2});
  const size_t value_bytes = file.Append(std::vector<float>{3, 0, 0, 3, 3, 0});
  for (const auto& [offset, length] : {std::pair(index_bytes, 4), std::pair(value_bytes, 24)}) {
    file.json["bufferViews"].push_back(
        {{"buffer", 0}, {"byteOffset", offset}, {"byteLength", length}});
  }
  const size_t views = file.json["bufferViews"].size();
  attributes["POSITION"] = file.json["accessors"].size();
  file.json["accessors"].push_back(
      {{"componentType", 5126},
       {"type", "VEC3"},
       {"count", 4},
       {"sparse",
        {{"count", 2},
         {"indices", {{"bufferView", views - 2}, {"componentType", 5123}}},
         {"values", {{"bufferView", views - 1}}}}}});
  CHECK(MeshOf(file).positions == std::vector<Vec3d>{{0, 0, 0}, {3, 0, 0}, {3, 3, 0}, {0, 0, 0}});
}

TEST_CASE("texture coordinates have v up, normals without direction are mended") {
  GltfFile file = MakeSquare();
  Json& attributes = file.json["meshes"][0]["primitives"][0]["attributes"];
  attributes["TEXCOORD_0"] =
      file.Accessor(std::vector<uint8_t>{0, 255, 255, 255, 255, 0, 0, 0}, 5121, "VEC2", 2);
  file.json["accessors"].back()["normalized"] = true;
  attributes["NORMAL"] =
      file.Accessor(std::vector<float>{0, 0, 2, 0, 0, 0, 1, 0, 0, 0, 0, 0}, 5126, "VEC3", 3);
  const Mesh mesh = MeshOf(file);
  CHECK(mesh.uvs == std::vector<Vec2d>{{0, 0}, {1, 0}, {1, 1}, {0, 1}});
  CHECK(mesh.normals == std::vector<Vec3d>{{0, 0, 1}, {0, 0, 1}, {1, 0, 0}, {0, 0, 1}});
}

TEST_CASE("tangents go by the matrix, and mirroring turns their sense round") {
  GltfFile file = MakeSquare();
  Json& attributes = file.json["meshes"][0]["primitives"][0]["attributes"];
  std::vector<float> tangents;
  for (int i = 0; i < 4; ++i)
    tangents.insert(tangents.end(), {0.6f, 0.8f, 0, i < 2 ? 1.0f : -1.0f});
  attributes["TANGENT"] = file.Accessor(tangents, 5126, "VEC4", 4);
  std::vector<std::string> warnings;
  CHECK(LoadFile(file, &warnings).meshes.at(0).tangents.empty());  // no normals: to be ignored
  attributes["NORMAL"] =
      file.Accessor(std::vector<float>{0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1}, 5126, "VEC3", 3);
  std::vector<Tangent> read = LoadFile(file, &warnings).meshes.at(0).tangents;
  REQUIRE(read.size() == 4);
  CHECK((read[0].direction - Vec3d(0.6, 0.8, 0)).length() < 1e-7);  // of floats
  CHECK(read[0].direction.length() == Approx(1).epsilon(1e-15));
  CHECK(read[1].sign == 1);
  CHECK(read[2].sign == -1);
  file.json["nodes"][0]["scale"] = {-3, 1, 1};
  read = LoadFile(file, &warnings).meshes.at(0).tangents;
  CHECK((read[0].direction - Vec3d(-1.8, 0.8, 0).normalized()).length() < 1e-7);
  CHECK(read[1].sign == -1);
  CHECK(read[2].sign == 1);
  CHECK(warnings.empty());
}

TEST_CASE("tangents that are none are left out and told") {
  // Of length 0, far from unit length, not a number, and without a sign.
  const std::vector<std::vector<float>> bad = {
      {0, 0, 0, 1}, {0.5f, 0, 0, 1}, {NAN, 0, 0, 1}, {1, 0, 0, 0}, {1, 0, 0, 0.5f}};
  for (const std::vector<float>& tangent : bad) {
    GltfFile file = MakeSquare();
    Json& attributes = file.json["meshes"][0]["primitives"][0]["attributes"];
    std::vector<float> tangents = {1, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1};
    tangents.insert(tangents.end(), tangent.begin(), tangent.end());
    attributes["TANGENT"] = file.Accessor(tangents, 5126, "VEC4", 4);
    attributes["NORMAL"] =
        file.Accessor(std::vector<float>{0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1}, 5126, "VEC3", 3);
    std::vector<std::string> warnings;
    CHECK(LoadFile(file, &warnings).meshes.at(0).tangents.empty());
    REQUIRE(warnings.size() == 1);
    CHECK(warnings[0].find("tangents") != std::string::npos);
  }
}

TEST_CASE("colours of vertices") {
  GltfFile file = MakeSquare();
  Json& attributes = file.json["meshes"][0]["primitives"][0]["attributes"];
  const auto material_of = [](const Scene& scene) {
    return scene.materials.at(scene.meshes.at(0).material.index);
  };
  attributes["COLOR_0"] =
      file.Accessor(std::vector<float>{1, 0.5, 0, 0, 0, 1, 2, 0.25, -1, 1, 1, 1}, 5126, "VEC3", 3);
  std::vector<std::string> warnings;
  const Scene scene = LoadFile(file, &warnings);
  CHECK(warnings.empty());
  // Out of [0, 1] there is none.
  CHECK(scene.meshes.at(0).colors ==
        std::vector<Vec3f>{{1, 0.5, 0}, {0, 0, 1}, {1, 0.25, 0}, {1, 1, 1}});
  CHECK(material_of(scene).vertex_colors == VertexColors::kBase);
  CHECK(material_of(scene).name == "default with vertex colours");
  CHECK(scene.materials.at(0).vertex_colors == VertexColors::kNone);
  // Normalised bytes with alpha.
  attributes["COLOR_0"] = file.Accessor(
      std::vector<uint8_t>{255, 51, 0, 9, 0, 0, 0, 9, 0, 0, 0, 9, 0, 0, 0, 9}, 5121, "VEC4", 4);
  file.json["accessors"].back()["normalized"] = true;
  CHECK(LoadFile(file).meshes.at(0).colors.at(0) == Vec3f(1, 51 / 255.0f, 0));
  // Without light they are what is shown.
  const auto color = [&]() -> Json& {
    return file.json["meshes"][0]["primitives"][0]["attributes"]["COLOR_0"];
  };
  file.json["materials"].push_back({{"extensions", {{"KHR_materials_unlit", Json::object()}}}});
  file.json["meshes"][0]["primitives"][0]["material"] = 0;
  CHECK(material_of(LoadFile(file)).vertex_colors == VertexColors::kEmission);
  // White changes nothing.
  color() = file.Accessor(std::vector<float>(12, 1.0f), 5126, "VEC3", 3);
  CHECK(LoadFile(file).meshes.at(0).colors.empty());
  CHECK(material_of(LoadFile(file)).vertex_colors == VertexColors::kNone);
  color() = file.Accessor(std::vector<float>(9, 0.5f), 5126, "VEC3", 3);
  CHECK_THROWS_AS(LoadFile(file), Error);
}

TEST_CASE("primitives that share long accessors take what they use") {
  GltfFile file = MakeSquare();
  std::vector<float> many(3 * 10000);
  for (size_t i = 0; i < many.size(); ++i) many[i] = static_cast<float>(i * i % 97);
  Json& primitive = file.json["meshes"][0]["primitives"][0];
  primitive["attributes"]["POSITION"] = file.Accessor(many, 5126, "VEC3", 3);
  primitive["indices"] = file.Accessor(std::vector<uint16_t>{9000, 17, 4000}, 5123, "SCALAR", 1);
  const Mesh mesh = MeshOf(file);
  REQUIRE(mesh.positions.size() == 3);
  CHECK(mesh.positions[0].x == many[51]);
  CHECK(mesh.triangles == std::vector<uint32_t>{2, 0, 1});
}

// The material of a square whose material has these members.
Material MaterialOf(const std::string& members, std::vector<std::string>* warnings = nullptr) {
  GltfFile file = MakeSquare();
  file.json["materials"].push_back(Json::parse(members));
  file.json["meshes"][0]["primitives"][0]["material"] = 0;
  const Scene scene = LoadFile(file, warnings);
  return scene.materials.at(scene.meshes.at(0).material.index);
}

TEST_CASE("metallic-roughness materials") {
  const Material gold = MaterialOf(R"({"name": "gold", "emissiveFactor": [0, 0.5, 1],
      "pbrMetallicRoughness": {"baseColorFactor": [1, 0.75, 0.25, 1], "roughnessFactor": 0.25},
      "extensions": {"KHR_materials_emissive_strength": {"emissiveStrength": 4}}})");
  CHECK(gold.name == "gold");
  CHECK(gold.emission == Rgb(0, 2, 4));
  const auto& model = std::get<MetallicRoughnessMaterial>(gold.model);
  CHECK(model.base_color == Rgb(1, 0.75, 0.25));
  CHECK(model.metallic == 1);
  CHECK(model.roughness == 0.25);
  // None at all: white, metallic and rough, by the specification.
  const Scene scene = LoadFile(MakeSquare());
  const auto& none =
      std::get<MetallicRoughnessMaterial>(scene.materials.at(scene.meshes[0].material.index).model);
  CHECK((none.base_color == Rgb(1) && none.metallic == 1 && none.roughness == 1));
}

TEST_CASE("extensions of materials") {
  const auto plastic = [](const std::string& extensions, std::vector<std::string>* warnings) {
    return MaterialOf(R"({"pbrMetallicRoughness": {"metallicFactor": 0, "roughnessFactor": 0.5},
                          "extensions": {)" +
                          extensions + "}}",
                      warnings);
  };
  std::vector<std::string> warnings;
  const Material unlit = plastic(R"("KHR_materials_unlit": {})", &warnings);
  CHECK(unlit.emission == Rgb(1));
  CHECK(std::get<LambertMaterial>(unlit.model).albedo == Rgb(0));
  const auto reflectance = [&](const std::string& extension) {
    return std::get<MetallicRoughnessMaterial>(plastic(extension, &warnings).model);
  };
  const MetallicRoughnessMaterial coat = reflectance(R"("KHR_materials_ior": {"ior": 1.8})");
  CHECK(coat.dielectric_f0.y == Approx(0.64 / (2.8 * 2.8)).epsilon(1e-14));
  CHECK(coat.specular == 1);
  // The specification's mirror, for materials that were specular-glossiness.
  CHECK(reflectance(R"("KHR_materials_ior": {"ior": 0})").dielectric_f0 == Rgb(1));
  const MetallicRoughnessMaterial matte =
      reflectance(R"("KHR_materials_specular": {"specularFactor": 0.25})");
  CHECK(matte.specular == 0.25);
  CHECK(matte.dielectric_f0.x == Approx(0.04).epsilon(1e-14));
  const Rgb f0 = reflectance(R"("KHR_materials_specular": {"specularColorFactor": [1, 0.5, 0.25]})")
                     .dielectric_f0;
  CHECK(f0.x == Approx(0.04).epsilon(1e-14));
  CHECK(f0.y == Approx(0.02).epsilon(1e-14));
  CHECK(f0.z == Approx(0.01).epsilon(1e-14));
  CHECK(warnings.empty());
  // White paint without gloss, and gold.
  const Material paint = plastic(R"("KHR_materials_pbrSpecularGlossiness": {
      "diffuseFactor": [0.5, 0.5, 0.5, 1], "specularFactor": [0.04, 0.04, 0.04],
      "glossinessFactor": 0.25})",
                                 &warnings);
  const auto& painted = std::get<MetallicRoughnessMaterial>(paint.model);
  CHECK(painted.metallic == 0);
  CHECK(painted.roughness == 0.75);
  CHECK(painted.base_color == Rgb(0.5));
  CHECK(painted.dielectric_f0 == Rgb(0.04));
  const Material metal = plastic(R"("KHR_materials_pbrSpecularGlossiness": {
      "diffuseFactor": [0, 0, 0, 1], "specularFactor": [1, 0.75, 0.3]})",
                                 &warnings);
  const auto& gilded = std::get<MetallicRoughnessMaterial>(metal.model);
  CHECK((gilded.metallic == 0 && gilded.roughness == 0 && gilded.base_color == Rgb(0)));
  CHECK(gilded.dielectric_f0 == Rgb(1, 0.75, 0.3));
  CHECK(warnings.empty());
}

TEST_CASE("materials are single-sided unless they are doubleSided, and mirrors keep their fronts") {
  CHECK(MaterialOf("{}").single_sided);
  CHECK(MaterialOf(R"({"doubleSided": false})").single_sided);
  CHECK_FALSE(MaterialOf(R"({"doubleSided": true})").single_sided);
  CHECK_FALSE(MaterialOf(R"({"doubleSided": true, "extensions": {"KHR_materials_unlit": {}}})")
                  .single_sided);
  CHECK(LoadFile(MakeSquare()).materials.back().single_sided);  // the default one
  for (const char* scale : {"[1, 1, 1]", "[-1, 1, 1]", "[1, -1, 1]", "[-1, -1, 1]"}) {
    CAPTURE(scale);
    CHECK(VectorArea(MeshWithNode(std::string(R"({"mesh": 0, "scale": )") + scale + "}")).z == 1);
  }
  // Mirrored in depth, the side that was behind is in front.
  CHECK(VectorArea(MeshWithNode(R"({"mesh": 0, "scale": [1, 1, -1]})")).z == -1);
}

TEST_CASE("nodes scaled to nothing leave lights and cameras without direction out, not the model") {
  GltfFile file = MakeSquare();
  file.json["cameras"] = Json::parse(R"([{"type": "perspective", "perspective": {"yfov": 1}}])");
  file.json["extensions"]["KHR_lights_punctual"]["lights"] =
      Json::parse(R"([{"type": "directional"}, {"type": "spot", "spot": {}}, {"type": "point"}])");
  const auto scene_of = [&](const Json& node, std::vector<std::string>* warnings) {
    GltfFile with = file;
    with.json["scenes"][0]["nodes"].push_back(1);
    with.json["nodes"].push_back(node);
    for (int light = 0; light < 3; ++light) {
      with.json["nodes"][1]["children"].push_back(light + 2);
      with.json["nodes"].push_back({{"extensions", {{"KHR_lights_punctual", {{"light", light}}}}}});
    }
    return LoadFile(with, warnings);
  };
  std::vector<std::string> warnings;
  const Scene scene =
      scene_of({{"camera", 0}, {"scale", {0, 0, 0}}, {"translation", {1, 2, 3}}}, &warnings);
  REQUIRE(scene.lights.size() == 1);
  CHECK(std::get<PointLight>(scene.lights[0].kind).position == Vec3d(1, 2, 3));
  REQUIRE(warnings.size() == 2);
  CHECK(warnings[0].find("a camera that its node leaves no direction") != std::string::npos);
  CHECK(warnings[1].find("a light that its node leaves no direction") != std::string::npos);
  CHECK(scene.camera.fov_y_deg == Camera().fov_y_deg);  // the one that is added
  // Tiny and huge scales leave it, whatever their squares are.
  for (const double scale : {1e-200, 1e-5, 3.0, 1e200}) {
    CAPTURE(scale);
    warnings.clear();
    const Json turned = {{"scale", {scale, scale, scale}}, {"rotation", {0, 0.6, 0, 0.8}}};
    const Scene lit = scene_of(turned, &warnings);
    CHECK(warnings.empty());
    REQUIRE(lit.lights.size() == 3);
    CHECK(Near(std::get<DirectionalLight>(lit.lights[0].kind).direction_of_travel,
               {-0.96, 0, -0.28}));
  }
  Tells(ErrorOf([&] {
          scene_of({{"translation", {1e300, 0, 0}}}, &warnings);
        }),
        "/nodes/3: [1e+300, 0, 0] is out of range");
  Tells(ErrorOf([&] {
          scene_of({{"camera", 0}, {"translation", {1e300, 0, 0}}}, &warnings);
        }),
        "/nodes/1: [1e+300, 0, 0] is out of range");
}

TEST_CASE("extensions are told whether or not the file lists them, and geometry in them refused") {
  GltfFile file = MakeSquare();
  file.json["extensionsUsed"] = {"EXT_listed", "KHR_materials_ior"};
  file.json["nodes"][0]["extensions"]["EXT_of_node"] = Json::object();
  file.json["meshes"][0]["primitives"][0]["extensions"]["EXT_listed"] = Json::object();
  file.json["materials"] = Json::parse(R"([{"extensions": {"EXT_of_material": {"textures":
      [{"extensions": {"EXT_within": {}}}]}}, "extras": {"extensions": {"EXT_in_extras": {}}}}])");
  std::vector<std::string> warnings;
  LoadFile(file, &warnings);
  std::vector<std::string> expected;
  for (const char* name : {"EXT_listed", "EXT_of_material", "EXT_of_node", "EXT_within"}) {
    expected.push_back(fmt::format("the extension {} is not known here and left out", name));
  }
  REQUIRE(warnings.size() == expected.size());
  for (size_t i = 0; i < warnings.size(); ++i) {
    CHECK(warnings[i].ends_with(": " + expected[i]));
  }
  // Draco's and meshopt's, which need not be listed as required.
  GltfFile draco = MakeSquare();
  draco.json["accessors"][0].erase("bufferView");
  draco.json["meshes"][0]["primitives"][0]["extensions"] = Json::parse(
      R"({"KHR_materials_variants": {"mappings": []},
          "KHR_draco_mesh_compression": {"bufferView": 0, "attributes": {"POSITION": 0}}})");
  Tells(ErrorOf([&] { LoadFile(draco); }),
        "/meshes/0/primitives/0/extensions/KHR_draco_mesh_compression: the extension "
        "KHR_draco_mesh_compression alone has its data");
  draco.json["accessors"][0]["bufferView"] = 0;  // what is there for readers that do not know it
  CHECK(LoadFile(draco).meshes.size() == 1);
  draco.json["accessors"][1].erase("bufferView");
  Tells(ErrorOf([&] { LoadFile(draco); }), "KHR_draco_mesh_compression alone has");
  GltfFile meshopt = MakeSquare();
  meshopt.json["buffers"].push_back({{"byteLength", 99}});
  meshopt.json["bufferViews"][0]["extensions"]["EXT_meshopt_compression"] = {{"buffer", 0}};
  CHECK(LoadFile(meshopt).meshes.size() == 1);
  meshopt.json["bufferViews"][0]["buffer"] = 1;
  Tells(ErrorOf([&] { LoadFile(meshopt); }),
        "/bufferViews/0/extensions/EXT_meshopt_compression: the extension "
        "EXT_meshopt_compression alone has its data");
}

TEST_CASE("numbers out of range are told in the file's own words") {
  const auto refuses = [](const char* pointer, const char* value, const char* message) {
    CAPTURE(pointer);
    GltfFile file = MakeSquare();
    file.json["materials"] = Json::parse(R"([{}])");
    file.json[Json::json_pointer(pointer)] = Json::parse(value);
    Tells(ErrorOf([&] { LoadFile(file); }), std::string(pointer) + ": " + message);
  };
  const std::string pbr = "/materials/0/pbrMetallicRoughness/";
  refuses((pbr + "baseColorFactor").c_str(), "[2, 1, 1, 1]", "[2, 1, 1] is out of range");
  refuses((pbr + "metallicFactor").c_str(), "-1", "-1 is out of range");
  refuses((pbr + "roughnessFactor").c_str(), "1.5", "1.5 is out of range");
  refuses("/materials/0/emissiveFactor", "[0, 0, -1]", "[0, 0, -1] is out of range");
}

TEST_CASE("cameras: the first one in the scene is taken") {
  GltfFile file = MakeSquare();
  file.json["cameras"] = Json::parse(R"([
      {"type": "perspective", "perspective": {"yfov": 1, "znear": 0.1}},
      {"type": "orthographic", "orthographic": {"xmag": 3, "ymag": 2, "znear": 0, "zfar": 9}}])");
  const double s = std::sqrt(0.5);
  file.json["nodes"].push_back(
      {{"camera", 0}, {"translation", {5, 0, 0}}, {"rotation", {0, s, 0, s}}});
  file.json["scenes"][0]["nodes"] = {0, 1};
  const Camera camera = LoadFile(file).camera;
  CHECK(camera.projection == Projection::kPerspective);
  CHECK(camera.fov_y_deg == Approx(180 / std::numbers::pi));
  CHECK(camera.position == Vec3d(5, 0, 0));
  CHECK(Near((camera.look_at - camera.position).normalized(), {-1, 0, 0}));  // -z turned about y
  CHECK(Near(camera.up, {0, 1, 0}));
  file.json["nodes"][1]["camera"] = 1;
  CHECK(LoadFile(file).camera.projection == Projection::kOrthographic);
  CHECK(LoadFile(file).camera.height == 4);
}

TEST_CASE("lights") {
  GltfFile file = MakeSquare();
  file.json["extensionsUsed"] = {"KHR_lights_punctual"};
  file.json["extensions"]["KHR_lights_punctual"]["lights"] = Json::parse(R"([
      {"type": "directional", "intensity": 3, "color": [1, 0.5, 0.25]},
      {"type": "point", "intensity": 40, "name": "bulb"},
      {"type": "spot", "intensity": 2, "name": "bulb",
       "spot": {"innerConeAngle": 0.25, "outerConeAngle": 0.5}}])");
  for (int i = 0; i < 3; ++i) {
    file.json["nodes"].push_back(
        {{"translation", {0, i, 1}}, {"extensions", {{"KHR_lights_punctual", {{"light", i}}}}}});
  }
  file.json["scenes"][0]["nodes"] = {0, 1, 2, 3};
  std::vector<std::string> warnings;
  const Scene scene = LoadFile(file, &warnings);
  REQUIRE(scene.lights.size() == 3);
  const auto& sun = std::get<DirectionalLight>(scene.lights[0].kind);
  CHECK(sun.direction_of_travel == Vec3d(0, 0, -1));
  CHECK(sun.irradiance == Rgb(3, 1.5, 0.75));
  CHECK(std::get<PointLight>(scene.lights[1].kind).position == Vec3d(0, 1, 1));
  CHECK(std::get<PointLight>(scene.lights[1].kind).intensity == Rgb(40));
  CHECK(scene.lights[1].name == "bulb");
  CHECK(scene.lights[2].name == "bulb 2");
  const auto& spot = std::get<SpotLight>(scene.lights[2].kind);
  CHECK(spot.cutoff_deg == Approx(90 / std::numbers::pi));
  CHECK(spot.inner_deg == Approx(45 / std::numbers::pi));
  CHECK(spot.edge == SpotEdge::kSquare);
  CHECK(warnings.empty());
}

TEST_CASE("names that a file has several times become different ones, whatever else it names") {
  GltfFile file = MakeSquare();
  file.json["extensionsUsed"] = {"KHR_lights_punctual"};
  Json& lights = file.json["extensions"]["KHR_lights_punctual"]["lights"];
  file.json["materials"] = Json::array();
  const char* const kNames[] = {"x 2", "x", "x", "x#4", "x", "x", "", "default", "light"};
  int count = 0;
  for (const char* name : kNames) {
    file.json["materials"].push_back({{"name", name}});
    lights.push_back({{"type", "point"}, {"name", name}});
    file.json["nodes"].push_back({{"extensions", {{"KHR_lights_punctual", {{"light", count}}}}}});
    file.json["scenes"][0]["nodes"].push_back(++count);
  }
  const Scene scene = LoadFile(file);  // Validate refuses names that are there twice
  std::vector<std::string> names;
  for (const Light& light : scene.lights) names.push_back(light.name);
  CHECK(names == std::vector<std::string>{"x 2", "x", "x 3", "x_4", "x 4", "x 5", "light",
                                          "default", "light 8"});
  names.clear();
  for (const Material& material : scene.materials) names.push_back(material.name);
  CHECK(names == std::vector<std::string>{"x 2", "x", "x#2", "x#4", "x#5", "x#6", "#6", "default",
                                          "light", "default#9"});
}

TEST_CASE("a model without camera and lights gets both") {
  GltfFile file = MakeSquare();
  file.json["nodes"][0]["scale"] = {40, 20, 1};
  const Scene scene = LoadFile(file);
  CHECK(scene.lights.size() == 4);
  CHECK(scene.camera.look_at == Vec3d(20, 10, 0));
  // All of it is in the view, and it fills one side.
  const Vec3d back = (scene.camera.position - scene.camera.look_at).normalized();
  const Vec3d right = scene.camera.up.cross(back).normalized();
  CHECK(back.z > 0.5);
  const double half = std::tan(scene.camera.fov_y_deg * std::numbers::pi / 360);
  double across = 0, up = 0;
  for (const Vec3d& position : scene.meshes[0].positions) {
    const Vec3d p = position - scene.camera.position;
    across = std::max(across, std::abs(p.dot(right)) / -p.dot(back) / (half * 1280 / 720));
    up = std::max(up, std::abs(p.dot(back.cross(right))) / -p.dot(back) / half);
  }
  CHECK(std::max(across, up) < 0.95);
  CHECK(std::max(across, up) > 0.85);
}

TEST_CASE("whole numbers are whole however they are written") {
  GltfFile file = MakeSquare();
  file.json["scene"] = 0.0;
  file.json["accessors"][0]["count"] = 4.0;
  file.json["accessors"][0]["componentType"] = 5126.0;
  file.json["bufferViews"][1]["byteOffset"] = 48.0;
  file.json["meshes"][0]["primitives"][0]["attributes"]["POSITION"] = 0.0;
  file.json["scenes"][0]["nodes"] = {0.0};
  CHECK(LoadFile(file).meshes.at(0).triangles.size() == 6);
  // And as text: 3e0 is what the parser makes a float of.
  const ModelFolder folder;
  std::string text = file.json.dump();
  const size_t count = text.find("\"count\":4.0");
  REQUIRE(count != std::string::npos);
  text.replace(count, 11, "\"count\":4e0");
  folder.Write("b.bin", file.bytes);
  text.insert(text.find("\"byteLength\"", text.find("\"buffers\"")), "\"uri\":\"b.bin\",");
  CHECK(LoadScene(folder.Write("model.gltf", text)).meshes.at(0).triangles.size() == 6);
}

TEST_CASE("buffers come as files and data URIs of every form") {
  const GltfFile file = MakeSquare();
  std::string percent;
  for (const char c : file.bytes) {
    percent += fmt::format("%{:02x}", static_cast<unsigned>(static_cast<unsigned char>(c)));
  }
  const auto base64 = [&](bool padded) {
    constexpr std::string_view kDigits =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text, bytes = file.bytes;
    const size_t rest = (3 - bytes.size() % 3) % 3;
    bytes.append(rest, '\0');
    for (size_t i = 0; i < bytes.size(); i += 3) {
      unsigned word = 0;
      for (size_t k = 0; k < 3; ++k) word = word << 8 | static_cast<unsigned char>(bytes[i + k]);
      for (int shift = 18; shift >= 0; shift -= 6) text += kDigits[word >> shift & 63];
    }
    for (size_t i = 0; i < rest; ++i) text.pop_back();
    return padded ? text + std::string(rest, '=') : text;
  };
  const ModelFolder folder;
  folder.Write("my mat\xc3\xa9.bin", file.bytes);
  folder.Write("100%25.bin", file.bytes);
  folder.Write("long.bin", file.bytes + "and more");
  const std::string uris[] = {"data:application/octet-stream;base64," + base64(true),
                              "data:application/gltf-buffer;base64," + base64(false),
                              "data:;base64," + base64(true),
                              "DATA:Application/X;charset=utf-8;BASE64," + base64(true),
                              "data:application/octet-stream," + percent,
                              "data:," + percent,
                              "my%20mat%C3%A9.bin",
                              "my mat\xc3\xa9.bin",
                              "./my%20mat%c3%a9.bin",
                              "100%25.bin",
                              "long.bin"};
  for (const std::string& uri : uris) {
    INFO(uri);
    Json json = file.json;
    json["buffers"][0]["uri"] = uri;
    const Scene scene = LoadScene(folder.Write("model.gltf", json.dump()));
    CHECK(scene.meshes.at(0).positions.at(2) == Vec3d(1, 1, 0));
  }
}

TEST_CASE("a node with a matrix and a translation goes by the matrix, and a warning says so") {
  GltfFile file = MakeSquare();
  file.json["nodes"][0]["matrix"] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 5, 6, 7, 1};
  std::vector<std::string> warnings;
  LoadFile(file, &warnings);
  CHECK(warnings.empty());
  for (const char* member : {"translation", "scale", "rotation"}) {
    GltfFile both = file;
    both.json["nodes"][0][member] = {2, 2, 2};
    if (member == std::string("rotation")) both.json["nodes"][0][member].push_back(1);
    warnings.clear();
    CHECK(LoadFile(both, &warnings).meshes.at(0).positions.at(0) == Vec3d(5, 6, 7));
    REQUIRE(warnings.size() == 1);
    CHECK(warnings[0].find("the matrix counts") != std::string::npos);
  }
}

TEST_CASE("what is left out may be anything, and is told once") {
  GltfFile file = MakeSquare();
  file.json["nodes"].push_back({{"mesh", 0}});
  file.json["scenes"][0]["nodes"] = {0, 1};
  file.json["skins"] = Json::parse(R"([{"joints": [70], "skeleton": "x"}])");  // of no mesh
  file.json["animations"] = Json::parse(R"([{"channels": [{"sampler": 0, "target":
      {"path": "pointer", "extensions": {"KHR_animation_pointer": {"pointer": "/nodes/0"}}}}],
      "samplers": [{"input": 1.0, "output": null}]}])");
  file.json["extras"] = Json::parse(R"({"a": [[[1]]]})");
  file.json["meshes"][0]["extras"] = 3;
  file.json["extensionsUsed"] = {"EXT_a", "EXT_a", "EXT_b"};
  file.json["cameras"] = Json::array();
  std::vector<std::string> warnings;
  CHECK(LoadFile(file, &warnings).meshes.size() == 2);
  CHECK(warnings.size() == 3);  // animations, two extensions
  // An accessor without a buffer view is zeros, indices too.
  file = MakeSquare();
  Json& primitives = file.json["meshes"][0]["primitives"];
  primitives.push_back(primitives[0]);
  const size_t zeros = file.json["accessors"].size();
  file.json["accessors"].push_back({{"componentType", 5123}, {"type", "SCALAR"}, {"count", 3}});
  primitives[1]["indices"] = zeros;
  warnings.clear();
  CHECK(LoadFile(file, &warnings).meshes.size() == 1);
  CHECK(warnings.size() == 1);  // a mesh without an area
}

TEST_CASE("a variant of the materials is shown by its name, also where the extension is required") {
  GltfFile file = MakeSquare();
  file.json["materials"] = Json::parse(R"([{"name": "a"}, {"name": "b"}, {"name": "c"}])");
  file.json["extensionsRequired"] = {"KHR_materials_variants"};
  file.json["extensions"]["KHR_materials_variants"] = Json::parse(
      R"({"variants": [{"name": "beach"}, {"name": "street \u00e9"}, {"name": "bare"}]})");
  Json& primitive = file.json["meshes"][0]["primitives"][0];
  primitive["material"] = 0;
  primitive["extensions"]["KHR_materials_variants"] = Json::parse(
      R"({"mappings": [{"variants": [0], "material": 1}, {"variants": [1.0], "material": 2}]})");
  const ModelFolder folder;
  std::vector<std::string> warnings;
  const auto shown = [&](const std::optional<std::string>& variant) {
    LoadOptions options{.variant = variant};
    options.on_warning = [&](const std::string& text) { warnings.push_back(text); };
    const Scene scene = LoadScene(folder.Write("model.glb", file.Binary()), options);
    return scene.materials[scene.meshes.at(0).material.index].name;
  };
  CHECK(shown("beach") == "b");
  CHECK(shown("street \u00e9") == "c");
  CHECK(shown("bare") == "a");  // which this primitive does not know
  CHECK(warnings.empty());
  CHECK(shown(std::nullopt) == "a");
  REQUIRE(warnings.size() == 1);
  Tells(warnings[0], "--variant names one: \"beach\"");
  const std::string sea = ErrorOf([&] { shown("sea"); }, ExitCode::kUsage);
  Tells(sea, "has no variant \"sea\"");
  Tells(sea, "one of \"beach\"");
  // Any name may be one, also none, and one may be there twice.
  Json& names = file.json["extensions"]["KHR_materials_variants"]["variants"];
  const Json few = names;
  names[1]["name"] = "";
  CHECK(shown("") == "c");
  names[1]["name"] = "a\nb";
  CHECK(shown("a\nb") == "c");
  Tells(ErrorOf([&] { shown(""); }, ExitCode::kUsage), R"("a\nb")");
  names[1]["name"] = "beach";
  warnings.clear();
  CHECK(shown("beach") == "b");
  REQUIRE(warnings.size() == 1);
  Tells(warnings[0], "several variants are called \"beach\"");
  for (int k = 3; k < 1000; ++k) names.push_back({{"name", std::to_string(k)}});
  Tells(ErrorOf([&] { shown("sea"); }, ExitCode::kUsage), "\"7\" and 992 more");
  names = few;
  Json& mappings = primitive["extensions"]["KHR_materials_variants"]["mappings"];
  mappings[0]["material"] = 3;
  Tells(ErrorOf([&] { shown("beach"); }), "/mappings/0/material: there is no material 3");
  Tells(ErrorOf([&] { shown("bare"); }), "there is no material 3");  // whichever is shown
  mappings[0]["material"] = 1;
  mappings[0]["variants"][0] = 3;
  Tells(ErrorOf([&] { shown(std::nullopt); }), "/mappings/0/variants: there is no variant 3");
  mappings[0]["material"] = "b";
  Tells(ErrorOf([&] { shown(std::nullopt); }), "/mappings/0/material");
  mappings = 3;
  Tells(ErrorOf([&] { shown(std::nullopt); }), "/mappings");
  primitive.erase("extensions");
  file.json["extensions"]["KHR_materials_variants"]["variants"][1].erase("name");
  Tells(ErrorOf([&] { shown(std::nullopt); }), "/variants/1: has no \"name\"");
  file.json.erase("extensions");
  file.json.erase("extensionsRequired");
  Tells(ErrorOf([&] { shown("beach"); }, ExitCode::kUsage), "it has none");
  const auto ply = folder.Write("model.ply", "ply\n");
  Tells(ErrorOf([&] { LoadScene(ply, {.variant = "beach"}); }, ExitCode::kUsage),
        "only glTF models");
  const auto json = folder.Write("scene.json", "{}");
  Tells(ErrorOf([&] { LoadScene(json, {.variant = "beach"}); }, ExitCode::kUsage),
        "only glTF models");
}

TEST_CASE("--set replaces a material of a model whole, and takes its maps away") {
  GltfFile file = MakeSquare();
  file.json["materials"] = Json::parse(R"([{"name": "a", "pbrMetallicRoughness":
      {"baseColorTexture": {"index": 0}}, "normalTexture": {"index": 0}}])");
  file.json["textures"] = Json::parse(R"([{"source": 0}])");
  file.json["images"] = Json::parse(R"([{"uri": "data:image/x;base64,UDYKMSAxCjI1NQphYmM="}])");
  file.json["meshes"][0]["primitives"][0]["material"] = 0;
  const ModelFolder folder;
  const auto path = folder.Write("model.glb", file.Binary());
  const auto material = [&](std::vector<std::pair<std::string, std::string>> overrides) {
    return LoadScene(path, {.overrides = std::move(overrides)}).materials.at(0);
  };
  const Material before = material({});
  CHECK(std::get<MetallicRoughnessMaterial>(before.model).base_color_map.valid());
  CHECK(before.normal_map.texture.valid());
  const Material bare =
      material({{"/materials/a/base_color_map", "null"}, {"/materials/a/normal_map", "null"}});
  CHECK(!std::get<MetallicRoughnessMaterial>(bare.model).base_color_map.valid());
  CHECK(!bare.normal_map.texture.valid());
  const Material gold =
      material({{"/materials/a", R"({"model": "conductor", "preset": "gold", "roughness": 0.2})"}});
  CHECK(gold.name == "a");
  CHECK(std::get<ConductorMaterial>(gold.model).roughness == 0.2);
  CHECK(!gold.normal_map.texture.valid());
}

TEST_CASE("models of other kinds are named, with what to do") {
  const ModelFolder folder;
  const auto message = [&](const std::string& name) -> std::string {
    try {
      LoadScene(folder.Write(name, "anything"));
    } catch (const Error& error) {
      CHECK(error.code() == ExitCode::kBadInput);
      return error.what();
    }
    return "fine";
  };
  for (const char* name :
       {"a.fbx", "a.STL", "a.blend", "a.usdz", "a.abc", "a.dae", "a.3ds", "a.x3d", "a.step"}) {
    INFO(name);
    CHECK(message(name).find("which is not read\n  hint: save it as glTF") != std::string::npos);
  }
  CHECK(message("a.mtl").find("hint: name the .obj file") != std::string::npos);
  CHECK(message("a.gltf.zip").find("hint: unpack it") != std::string::npos);
  const std::string scene = R"({"nacre": 1, "shapes": [{"type": "mesh", "file": "NAME",
      "material": {"model": "lambert"}}]})";
  for (const char* name : {"a.stl", "b.glb"}) {
    folder.Write(name, "");
    std::string text = scene;
    text.replace(text.find("NAME"), 4, name);
    try {
      LoadSceneText(text, "scene.json", folder.path);
      CHECK(false);
    } catch (const Error& error) {
      INFO(error.what());
      CHECK(std::string(error.what()).find("OBJ") != std::string::npos);
    }
  }
}

TEST_CASE("--set reaches the camera, the image, the lights and the materials of a model") {
  const ModelFolder folder;
  GltfFile file = MakeSquare();
  file.json["materials"] = Json::parse(R"([{"name": "m"}])");
  const auto path = folder.Write("model.glb", file.Binary());
  const auto load = [&](std::vector<std::pair<std::string, std::string>> overrides) {
    return LoadScene(path, {.overrides = std::move(overrides)});
  };
  const auto message = [&](const std::string& pointer, const std::string& value) -> std::string {
    try {
      load({{pointer, value}});
    } catch (const Error& error) {
      return error.what();
    }
    return "no error";
  };
  const Scene wide = load({{"/camera/fov_y_deg", "60"},
                           {"/image/width", "100"},
                           {"/image/height", "400"},
                           {"/background", "0"}});
  CHECK(wide.camera.fov_y_deg == 60);
  CHECK(wide.image.width == 100);
  CHECK(wide.background == Rgb(0));
  const Scene narrow = load({{"/camera/fov_y_deg", "20"}});
  CHECK((narrow.camera.position - narrow.camera.look_at).length() >
        (load({}).camera.position - narrow.camera.look_at).length());
  CHECK(load({{"/camera/position", "[1, 2, 30]"}}).camera.position == Vec3d(1, 2, 30));
  const Scene rough = load({{"/materials/m/roughness", "0.25"}});
  CHECK(std::get<MetallicRoughnessMaterial>(rough.materials[0].model).roughness == 0.25);
  const Scene lit = load({{"/lights/key", R"({"type": "ambient", "radiance": 1})"},
                          {"/lights/more", R"({"type": "ambient", "radiance": 1})"}});
  CHECK(lit.lights.size() == 5);
  CHECK(std::holds_alternative<AmbientLight>(lit.lights[0].kind));
  const Scene alone = load({{"/lights", R"({"only": {"type": "ambient", "radiance": 1}})"}});
  REQUIRE(alone.lights.size() == 1);
  CHECK(alone.lights[0].name == "only");
  // Of a file that has lights of its own as well.
  file.json["extensionsUsed"] = {"KHR_lights_punctual"};
  file.json["extensions"] = Json::parse(
      R"({"KHR_lights_punctual": {"lights": [{"type": "directional", "name": "own"}]}})");
  file.json["nodes"][0]["extensions"] = Json::parse(R"({"KHR_lights_punctual": {"light": 0}})");
  folder.Write("model.glb", file.Binary());
  CHECK(load({}).lights.size() == 1);
  CHECK(load({{"/lights/only", R"({"type": "ambient", "radiance": 1})"}}).lights.size() == 2);
  const Scene replaced = load({{"/lights", R"({"only": {"type": "ambient", "radiance": 1}})"}});
  REQUIRE(replaced.lights.size() == 1);
  CHECK(replaced.lights[0].name == "only");
  CHECK(message("/materials/n/roughness", "1").find("unknown material \"n\"") != std::string::npos);
  CHECK(message("/materials/m/rough", "1").find("unknown key \"rough\"") != std::string::npos);
  CHECK(message("/image/spp", "0").find("/image/spp: 0 is out of range") != std::string::npos);
  CHECK(message("/shapes/0", "1").find("unknown key \"shapes\"") != std::string::npos);
}

TEST_CASE("the model that ships") {
  const Scene scene = LoadScene(std::string(NACRE_SOURCE_DIR) + "/scenes/models/pawns.glb");
  CHECK(scene.meshes.size() == 1 + 25 + 9);
  for (const Mesh& mesh : scene.meshes) {
    const Vec3d area = VectorArea(mesh);
    CHECK(area.length() < 1e-5);  // closed, to the float positions' rounding
    double volume = 0;
    for (size_t i = 0; i < mesh.triangles.size(); i += 3) {
      volume += mesh.positions[mesh.triangles[i]].dot(
          mesh.positions[mesh.triangles[i + 1]].cross(mesh.positions[mesh.triangles[i + 2]]));
    }
    CHECK(volume > 0);  // right side out
  }
}

}  // namespace
}  // namespace nacre
