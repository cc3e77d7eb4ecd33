// SPDX-License-Identifier: Apache-2.0
// glTF files that must be refused, in one clear line, whatever is wrong with them.
#include <limits>
#include <numeric>
#include <random>

#include <fmt/format.h>

#include "catch.h"
#include "messages.h"
#include "scene_io/gltf_builder.h"

namespace nacre {
namespace {

// The one line that the file is refused with; "no error" if it is not.
std::string MessageOf(const std::string& name, const std::string& bytes) {
  const ModelFolder folder;
  return ErrorOf([&] { LoadScene(folder.Write(name, bytes)); });
}

// A square with everything that can be spoilt.
GltfFile MakeRichFile() {
  GltfFile file = MakeSquare();
  file.json["materials"] = Json::parse(R"([{"pbrMetallicRoughness": {"metallicFactor": 0},
      "extensions": {"KHR_materials_ior": {"ior": 1.4}}}])");
  file.json["cameras"] = Json::parse(R"([{"type": "perspective", "perspective":
      {"yfov": 1, "znear": 0.1}}])");
  file.json["nodes"][0]["camera"] = 0;
  file.json["nodes"][0]["extensions"]["KHR_lights_punctual"]["light"] = 0;
  file.json["nodes"][0]["translation"] = {0, 0, 1};
  file.json["extensions"]["KHR_lights_punctual"]["lights"] = Json::parse(R"([{"type": "spot",
      "spot": {"outerConeAngle": 0.5}}])");
  Json& primitive = file.json["meshes"][0]["primitives"][0];
  primitive["material"] = 0;
  primitive["attributes"]["NORMAL"] = file.Accessor(kSquare, 5126, "VEC3", 3);
  primitive["attributes"]["TEXCOORD_0"] =
      file.Accessor(std::vector<float>{0, 0, 1, 0, 1, 1, 0, 1}, 5126, "VEC2", 2);
  const int sparse = file.Accessor(kSquare, 5126, "VEC3", 3);
  file.Accessor(std::vector<uint16_t>{1, 2}, 5123, "SCALAR", 1);
  file.Accessor(std::vector<float>{1, 0, 0, 1, 1, 0}, 5126, "VEC3", 3);
  file.json["accessors"][static_cast<size_t>(sparse)]["sparse"] = Json::parse(
      R"({"count": 2, "indices": {"bufferView": 5, "componentType": 5123},
          "values": {"bufferView": 6}})");
  primitive["attributes"]["POSITION"] = sparse;
  return file;
}

struct Case {
  std::string pointer;
  std::string value;  // JSON; empty: removed
  std::string message;
};

TEST_CASE("the file that is spoilt below is fine") {
  CHECK(MessageOf("a.glb", MakeRichFile().Binary()) == "no error");
}

TEST_CASE("what is wrong in a glTF file is told in its place") {
  const Case cases[] = {
      {"/asset/version", "\"1.0\"", "/asset/version: glTF 1.0"},
      {"/asset/version", "2", "/asset/version: is not a string"},
      {"/extensionsRequired", "[\"KHR_draco_mesh_compression\"]",
       "/extensionsRequired: the extension KHR_draco_mesh_compression is required"},
      {"/extensionsRequired", "[4]", "/extensionsRequired: is not an array of strings"},
      {"/scene", "1", "/scene: there is no scene 1"},
      {"/scene", "-1", "/scene: is not a whole number from 0 on"},
      {"/scenes/0/nodes", "[7]", "/nodes/7: there is no such node"},
      {"/scenes/0/nodes", "[0, 0]", "/nodes/0: is in the scene twice"},
      {"/scenes/0/nodes", "[]", "has no triangles in its scene"},
      {"/scenes", "5", "/scenes: is not an array of objects"},
      {"/nodes/0/children", "[0]", "/nodes/0: is in the scene twice, or below itself"},
      {"/nodes/0/children", "[-1]", "/nodes/0/children: is not an array of whole numbers"},
      {"/nodes/0/mesh", "1", "/meshes/1: there is no such mesh"},
      {"/nodes/0/mesh", "0.5", "/nodes/0/mesh: is not a whole number"},
      {"/nodes/0/matrix", "[1, 2]", "/nodes/0/matrix: is not an array of 16 numbers"},
      {"/nodes/0/matrix", "[1,0,0,1, 0,1,0,0, 0,0,1,0, 0,0,0,1]", "is no matrix of translation"},
      {"/nodes/0/rotation", "[0, 0, 0, 0]", "/nodes/0/rotation: is no rotation"},
      {"/nodes/0/scale", "[1, 1, \"x\"]", "/nodes/0/scale: is not an array of 3 numbers"},
      {"/nodes/0/scale", "[1e300, 1, 1]", "position 1 is out of range"},
      {"/nodes/0/camera", "1", "/cameras/1: there is no such camera"},
      {"/nodes/0/extensions/KHR_lights_punctual", "{}", "KHR_lights_punctual"},
      {"/nodes/0/extensions/KHR_lights_punctual/light", "3", "lights/3: there is no such light"},
      {"/nodes/0/extensions", "3", "/nodes/0/extensions: is not an object"},
      {"/extensions/KHR_lights_punctual/lights/0/type", "\"laser\"", "unknown type \"laser\""},
      {"/extensions/KHR_lights_punctual/lights/0/spot/outerConeAngle", "9", "its cone is from 0"},
      {"/extensions/KHR_lights_punctual/lights/0/color", "[1]", "is not an array of 3 numbers"},
      {"/extensions/KHR_lights_punctual/lights/0/intensity", "-1", "out of range"},
      {"/cameras/0/perspective/yfov", "4", "/cameras/0/perspective/yfov: 4"},
      {"/cameras/0/perspective/yfov", "\"1\"", "/cameras/0/perspective/yfov: is not a number"},
      {"/materials/0/pbrMetallicRoughness/metallicFactor", "2",
       "/metallicFactor: 2 is out of range"},
      {"/materials/0/pbrMetallicRoughness/metallicFactor", "\"0\"", "is not a number"},
      {"/materials/0/pbrMetallicRoughness/baseColorFactor", "[1, 1]", "array of 4 numbers"},
      {"/materials/0/extensions/KHR_materials_ior/ior", "\"x\"", "KHR_materials_ior/ior: is not"},
      {"/meshes/0/primitives/0/material", "1", "/primitives/0/material: there is no material 1"},
      {"/meshes/0/primitives/0/mode", "7", "/meshes/0/primitives/0/mode: 7 is none"},
      {"/meshes/0/primitives/0/indices", "9", "/accessors/9: there is no such"},
      {"/meshes/0/primitives/0/indices", "0", "accessors/0/type: is not the type"},
      {"/meshes/0/primitives/0/attributes/POSITION", "9", "/accessors/9: there is no such"},
      {"/meshes/0/primitives/0/attributes/POSITION", "1", "/accessors/1/type: is not the type"},
      {"/meshes/0/primitives/0/attributes/POSITION", "\"0\"", "POSITION: is not a whole number"},
      {"/meshes/0/primitives/0/attributes/NORMAL", "6", "6/count: 2 elements for 4 positions"},
      {"/accessors/1/count", "5", "5 corners are no whole triangles"},
      {"/accessors/1/count", "0", "/accessors/1/count: is 0"},
      {"/accessors/1/count", "7", "/accessors/1: 7 elements reach beyond buffer view 1"},
      {"/accessors/1/count", "4611686018427387904", "/accessors/1/count: is not a whole number"},
      {"/accessors/1/count", "9007199254740991", "elements reach beyond buffer view 1"},
      {"/accessors/1/componentType", "5126", "6 elements reach beyond buffer view 1"},
      {"/accessors/1/componentType", "5124", "5124 is none"},
      {"/accessors/2/byteOffset", "-4", "/accessors/2/byteOffset: is not a whole number"},
      {"/accessors/2/byteOffset", "4", "/accessors/2: 4 elements reach beyond buffer view 2"},
      {"/accessors/2/byteOffset", "9007199254740992", "elements reach beyond buffer view 2"},
      {"/accessors/2/bufferView", "77", "/accessors/2: there is no buffer view 77"},
      {"/accessors/2/type", "\"VEC9\"", "/accessors/2/type: is not the type"},
      {"/accessors/4/sparse/count", "5", "/accessors/4/sparse/count: 5 of 4 elements"},
      {"/accessors/4/sparse/count", "0", "/accessors/4/sparse/count: 0 of 4"},
      {"/accessors/4/sparse/indices/bufferView", "66", "there is no buffer view 66"},
      {"/accessors/4/sparse/indices/componentType", "5126", "is not an unsigned type"},
      {"/accessors/4/sparse/values/byteOffset", "8", "2 elements reach beyond buffer view 6"},
      {"/accessors/4/sparse/values/byteOffset", "-8", "is not a whole number"},
      {"/accessors/4/count", "2", "index 2 of element 1: not ascending below 2"},
      {"/bufferViews/2/byteOffset", "9007199254740992", "/bufferViews/2: 48 bytes from byte"},
      {"/bufferViews/2/byteLength", "9007199254740992", "/bufferViews/2: 9007199254740992 bytes"},
      {"/bufferViews/2/byteStride", "4", "/bufferViews/2/byteStride: 4 is less than an element"},
      {"/bufferViews/2/byteStride", "252", "4 elements reach beyond buffer view 2"},
      {"/bufferViews/2/buffer", "1", "/bufferViews/2/buffer: there is no buffer 1"},
      {"/buffers/0/byteLength", "100000", "byteLength"},
      {"/buffers/0/byteLength", "9007199254740992", "byteLength"},
      {"/buffers/0/uri", "\"missing.bin\"", "/buffers/0/uri: there is no file \"missing.bin\""},
      {"/buffers/0/uri", "\"../secret.bin\"", "/buffers/0/uri: \"../secret.bin\" is outside"},
      {"/buffers/0/uri", "\"/etc/passwd\"", "/buffers/0/uri: \"/etc/passwd\" is outside"},
      {"/buffers/0/uri", "\"https://example.com/a.bin\"", "only files are read, no URLs"},
      {"/buffers/0/uri", "\"data:application/octet-stream;base64,AAAA\"",
       "/buffers/0: has 3 bytes, not"},
  };
  for (const Case& test : cases) {
    GltfFile file = MakeRichFile();
    file.json[Json::json_pointer(test.pointer)] = Json::parse(test.value);
    const std::string message = MessageOf("a.glb", file.Binary());
    INFO(test.pointer << " = " << test.value << "\n" << message);
    CHECK(Contains(message, test.message));
    CHECK(Contains(message, "a.glb: "));
  }
}

TEST_CASE("numbers in buffers are looked at, too") {
  GltfFile file = MakeSquare();
  Json& primitive = file.json["meshes"][0]["primitives"][0];
  primitive["indices"] = file.Accessor(std::vector<uint16_t>{0, 1, 4}, 5123, "SCALAR", 1);
  CHECK(Contains(MessageOf("a.glb", file.Binary()),
                 "/accessors/2: index 4 at 2\n  hint: there are 4"));
  primitive["indices"] = file.Accessor(std::vector<float>{0, 1, 2}, 5126, "SCALAR", 1);
  CHECK(Contains(MessageOf("a.glb", file.Binary()), "indices are of an unsigned type"));
  const float nan = std::numeric_limits<float>::quiet_NaN();
  for (const float bad : {nan, std::numeric_limits<float>::infinity(), 1e30f}) {
    file = MakeSquare();
    std::vector<float> positions = kSquare;
    positions[7] = bad;
    file.json["meshes"][0]["primitives"][0]["attributes"]["POSITION"] =
        file.Accessor(positions, 5126, "VEC3", 3);
    CHECK(Contains(MessageOf("a.glb", file.Binary()), "position 2 is out of range"));
  }
  file = MakeSquare();
  file.json["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_0"] =
      file.Accessor(std::vector<float>{0, 0, nan, 0, 1, 1, 0, 1}, 5126, "VEC2", 2);
  CHECK(Contains(MessageOf("a.glb", file.Binary()), "texture coordinate 1 is out of range"));
  // A normal that is no number is mended like one without a direction.
  file.json["meshes"][0]["primitives"][0]["attributes"] = {
      {"POSITION", 0}, {"NORMAL", file.Accessor(std::vector<float>(12, nan), 5126, "VEC3", 3)}};
  CHECK(MessageOf("a.glb", file.Binary()) == "no error");
}

// Pieces of 2^14 vertices are read at the same time: each is wrong at its end, so that others have
// begun when the first is found to be, and are found to be so after it.
TEST_CASE("of wrong vertices the first is told, however many threads read them") {
  std::vector<float> positions(3 * 65535);
  for (const size_t vertex : {16383u, 32767u, 49151u, 65534u}) {
    positions[3 * vertex] = std::numeric_limits<float>::quiet_NaN();
  }
  std::vector<uint32_t> indices(65535);
  std::iota(indices.begin(), indices.end(), 0u);
  GltfFile file = MakeSquare();
  Json& primitive = file.json["meshes"][0]["primitives"][0];
  primitive["attributes"]["POSITION"] = file.Accessor(positions, 5126, "VEC3", 3);
  primitive["indices"] = file.Accessor(indices, 5125, "SCALAR", 1);
  const std::string bytes = file.Binary();
  for (int i = 0; i < 40; ++i) {
    CHECK(Contains(MessageOf("a.glb", bytes), "position 16383 is out of range"));
  }
}

TEST_CASE("binary files that are cut or lie about their lengths") {
  const std::string good = MakeRichFile().Binary();
  for (size_t length = 0; length < good.size(); length += 7) {
    CHECK(MessageOf("a.glb", good.substr(0, length)) != "no error");
  }
  const auto with_word = [&](size_t offset, uint32_t word) {
    std::string bytes = good;
    std::memcpy(bytes.data() + offset, &word, 4);
    return MessageOf("a.glb", bytes);
  };
  CHECK(MessageOf("a.glb", good + "xyz") == "no error");  // behind the length that it states
  for (const char* other :
       {"<!DOCTYPE html>\n<html></html>", "version https://git-lfs", "", "glT"}) {
    CHECK(
        MessageOf("a.glb", other)
            .ends_with("a.glb: does not begin with \"glTF\", as .glb files do\n  hint: is it a web "
                       "page that a download left, or another kind of file?"));
  }
  CHECK(Contains(MessageOf("a.glb", "\n{\"a\": 1}"), "has no \"asset\""));  // .gltf by another name
  CHECK(Contains(with_word(4, 1), "is glTF 1"));
  CHECK(Contains(with_word(8, 0xffffffff), "says that it has 4294967295"));
  CHECK(Contains(with_word(8, 12), "its first chunk is not JSON"));
  CHECK(Contains(with_word(12, 0xfffffff0), "is longer than the file"));
  CHECK(Contains(with_word(16, 0), "its first chunk is not JSON"));
  const uint32_t json_length = [&] {
    uint32_t word = 0;
    std::memcpy(&word, good.data() + 12, 4);
    return word;
  }();
  CHECK(Contains(with_word(20 + json_length, static_cast<uint32_t>(good.size())), "longer than"));
  CHECK(Contains(MessageOf("a.gltf", ""), "not JSON"));
  CHECK(Contains(MessageOf("a.gltf", "[]"), "is not a glTF file"));
  for (const char* old : {R"({"asset": {"version": "1.0"}, "meshes": {}})",
                          R"({"asset": {"version": 1.0}})", R"({"accessors": {"a": {}}})"}) {
    CHECK(MessageOf("a.gltf", old)
              .ends_with("a.gltf: /asset/version: glTF 1.0\n  hint: this program reads glTF 2.0"));
  }
  // A buffer that nothing is shown of needs no data.
  GltfFile without = MakeSquare();
  without.json["buffers"].push_back({{"byteLength", 8}});
  CHECK(MessageOf("a.glb", without.Binary()) == "no error");
  CHECK(Contains(MessageOf("a.gltf", without.json.dump()), "/buffers/0: has no \"uri\" and no"));
  CHECK(Contains(MessageOf("a.gltf", "{\"a\": 1}"), "has no \"asset\""));
  CHECK(Contains(MessageOf("a.gltf", std::string(300000, '[')), "nested deeper than 100"));
}

TEST_CASE("few bytes cannot ask for much memory") {
  // A billion elements that no buffer holds.
  GltfFile file = MakeSquare();
  Json& accessor = file.json["accessors"][0];
  accessor.erase("bufferView");
  accessor["count"] = 1000000000;
  CHECK(Contains(MessageOf("a.glb", file.Binary()), "elements without a buffer view"));
  // Sixteen million triangles of no bytes at all.
  accessor["count"] = 1 << 24;
  file.json["meshes"][0]["primitives"][0].erase("indices");
  file.json["meshes"][0]["primitives"][0]["mode"] = 5;
  const std::string bound = "would have more than 10";  // 1 million and one for each 4 bytes
  CHECK(Contains(MessageOf("a.glb", file.Binary()), bound));
  // A mesh of 50 000, shown twenty-five times.
  accessor["count"] = 50'002;
  Json children = Json::array();
  for (int i = 1; i <= 25; ++i) {
    children.push_back(i);
    file.json["nodes"].push_back({{"mesh", 0}});
  }
  file.json["nodes"][0] = {{"children", children}};
  CHECK(Contains(MessageOf("a.glb", file.Binary()), bound));
  // The same in as many primitives as there are accessors for: their views overlap.
  file = MakeSquare();
  const int indices = file.Accessor(std::vector<unsigned char>(60'000, 1), 5121, "SCALAR", 1);
  Json primitive = file.json["meshes"][0]["primitives"][0];
  primitive["indices"] = indices;
  for (int i = 0; i < 60; ++i) file.json["meshes"][0]["primitives"].push_back(primitive);
  CHECK(Contains(MessageOf("a.glb", file.Binary()), bound));
  // Primitives that make nothing: each visit of a node takes time.
  for (const char* nothing : {R"({"attributes": {}})", R"({"attributes": {}, "mode": 0})"}) {
    GltfFile empty = MakeSquare();
    Json& primitives = empty.json["meshes"][0]["primitives"];
    for (int i = 0; i < 1200; ++i) primitives.push_back(Json::parse(nothing));
    for (int i = 1; i <= 1200; ++i) empty.json["nodes"].push_back({{"mesh", 0}});
    empty.json.erase("scenes");
    empty.json.erase("scene");
    CHECK(Contains(MessageOf("a.glb", empty.Binary()), bound));
  }
  // One triangle of sparse positions, all of which are read whenever it is shown.
  constexpr uint16_t kSparse = 40'000;
  GltfFile sparse = MakeSquare();
  std::vector<uint16_t> elements;
  std::vector<float> values;
  for (uint16_t i = 0; i < kSparse; ++i) {
    elements.push_back(i);
    for (const int modulus : {4, 2, 3}) values.push_back(static_cast<float>(i % modulus));
  }
  sparse.Accessor(elements, 5123, "SCALAR", 1);
  sparse.Accessor(values, 5126, "VEC3", 3);
  sparse.json["accessors"][1]["count"] = 3;
  sparse.json["accessors"][0] = {{"componentType", 5126},
                                 {"type", "VEC3"},
                                 {"count", kSparse},
                                 {"sparse",
                                  {{"count", kSparse},
                                   {"indices", {{"bufferView", 2}, {"componentType", 5123}}},
                                   {"values", {{"bufferView", 3}}}}}};
  CHECK(MessageOf("a.glb", sparse.Binary()) == "no error");
  for (int i = 1; i <= 40; ++i) sparse.json["nodes"].push_back({{"mesh", 0}});
  sparse.json.erase("scenes");
  sparse.json.erase("scene");
  CHECK(Contains(MessageOf("a.glb", sparse.Binary()), "would have more than 11"));
  // Who asks for it gets it.
  const ModelFolder folder;
  CHECK(LoadScene(folder.Write("b.glb", file.Binary()), {.max_primitives = 3'000'000})
            .meshes.size() == 1);
}

TEST_CASE("few bytes of OBJ and PLY cannot ask for much memory, and lists of objects end") {
  std::string face = "f";
  for (int i = 0; i < 255; ++i) face += " 1";
  std::string obj = "v 0 0 0\n";
  for (int i = 0; i < 12000; ++i) obj += face + "\n";
  CHECK(Contains(MessageOf("a.obj", obj), "a.obj: the scene would have more than"));
  std::string ply =
      "ply\nformat binary_little_endian 1.0\nelement vertex 1\nproperty float x\n"
      "property float y\nproperty float z\n";
  const std::string points(12, '\0'), bytes(2'000'000, '\0');
  const uint32_t count = 2'000'000;
  const std::string length(reinterpret_cast<const char*>(&count), 4);
  CHECK(Contains(MessageOf("a.ply", ply +
                                        "element tristrips 1\nproperty list uint uchar "
                                        "vertex_indices\nend_header\n" +
                                        points + length + bytes),
                 "a.ply: the scene would have more than"));
  std::string faces;
  for (int i = 0; i < 8000; ++i) faces += '\xff' + std::string(255, '\0');
  CHECK(Contains(MessageOf("a.ply", ply +
                                        "element face 8000\nproperty list uchar uchar "
                                        "vertex_indices\nend_header\n" +
                                        points + faces),
                 "a.ply: the scene would have more than"));
  // Materials of OBJ: in one library, and in two.
  const std::string triangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
  std::string library;
  for (int i = 0; i < 1 << 15; ++i) library += "newmtl a\n";
  const ModelFolder folder;
  folder.Write("half.mtl", library);
  folder.Write("more.mtl", library + "newmtl a\n");
  folder.Write("whole.mtl", library + library + "newmtl a\n");
  const auto load = [&](const std::string& libraries) -> std::string {
    try {
      LoadScene(folder.Write("a.obj", "mtllib " + libraries + "\n" + triangle));
    } catch (const Error& error) {
      return error.what();
    }
    return "no error";
  };
  CHECK(load("half.mtl") == "no error");
  CHECK(Contains(load("whole.mtl"), "whole.mtl:65537: a model has more than 65536 materials"));
  CHECK(Contains(load("half.mtl more.mtl"), "more.mtl:32769: a model has more than 65536"));
  std::string materials = R"({"asset": {"version": "2.0"}, "materials": [{})";
  for (int i = 0; i < 1 << 16; ++i) materials += ",{}";
  CHECK(Contains(MessageOf("a.gltf", materials + "]}"),
                 "/materials: is not an array of objects, 65536 at most"));
}

TEST_CASE("files whose names hold a % are refused in their place") {
  const ModelFolder folder;
  std::filesystem::create_directory(folder.path / "a%41x");
  GltfFile file = MakeSquare();
  for (const char* kind : {"buffers", "images"}) {
    file.json[kind] = Json::array({{{"uri", "a%41x"}, {"byteLength", 48}}});
    if (std::string(kind) == "images") {
      file = MakeSquare();
      file.json["images"] = {{{"uri", "a%41x"}}};
      file.json["textures"] = {{{"source", 0}}};
      file.json["materials"] = {{{"emissiveTexture", {{"index", 0}}}}};
    }
    std::string message = "no error";
    try {
      LoadScene(folder.Write("a.gltf", file.json.dump()));
    } catch (const Error& error) {
      message = error.what();
    }
    INFO(message);
    CHECK(Contains(message, std::string("a.gltf: /") + kind + "/0"));
    CHECK(Contains(message, "\"a%41x\" is not a regular file"));
  }
}

TEST_CASE("a chain of a hundred thousand nodes is no deep recursion") {
  GltfFile file = MakeSquare();
  Json nodes = Json::array();
  constexpr int kNodes = 100000;
  for (int i = 0; i < kNodes; ++i) nodes.push_back({{"children", {i + 1}}});
  nodes.push_back({{"mesh", 0}});
  file.json["nodes"] = nodes;
  CHECK(MessageOf("a.glb", file.Binary()) == "no error");
}

TEST_CASE("members that the specification requires are missed by name") {
  const std::pair<const char*, const char*> cases[] = {
      {"/asset/version", "/asset: has no \"version\""},
      {"/accessors/0/count", "/accessors/0: has no \"count\""},
      {"/accessors/0/type", "/accessors/0: has no \"type\""},
      {"/bufferViews/0/buffer", "/bufferViews/0: has no \"buffer\""},
      {"/buffers/0/byteLength", "/buffers/0: has no \"byteLength\""},
      {"/meshes/0/primitives/0/attributes", "/meshes/0/primitives/0: has no \"attributes\""},
      {"/cameras/0/perspective/yfov", "/cameras/0/perspective: has no \"yfov\""},
      {"/extensions/KHR_lights_punctual/lights/0/type", "lights/0: has no \"type\""},
      {"/nodes/0/extensions/KHR_lights_punctual/light", "KHR_lights_punctual: has no \"light\""},
  };
  for (const auto& [pointer, expected] : cases) {
    GltfFile file = MakeRichFile();
    const Json::json_pointer place(pointer);
    file.json[place.parent_pointer()].erase(place.back());
    const std::string message = MessageOf("a.glb", file.Binary());
    INFO(message);
    CHECK(Contains(message, expected));
  }
}

TEST_CASE("a version that is not read is told, and 2.x is read") {
  const auto message = [](const char* version, const char* least) {
    GltfFile file = MakeSquare();
    file.json["asset"]["version"] = version;
    if (least != nullptr) file.json["asset"]["minVersion"] = least;
    return MessageOf("a.glb", file.Binary());
  };
  CHECK(message("2.9", nullptr) == "no error");
  CHECK(message("2.1", "2.0") == "no error");
  CHECK(Contains(message("2.0", "2.1"), "/asset/minVersion: glTF 2.1 is required"));
  CHECK(Contains(message("2.0", "3.0"), "/asset/minVersion: glTF 3.0 is required"));
  CHECK(Contains(message("2.0", "x"), "/asset/minVersion: glTF x is required"));
  CHECK(Contains(message("2.x", nullptr), "/asset/version: glTF 2.x"));
  CHECK(Contains(message("2", nullptr), "/asset/version: glTF 2"));
  CHECK(Contains(message("3.0", nullptr), "/asset/version: glTF 3.0"));
}

TEST_CASE("a message holds a line of a file's text at most") {
  const std::string mega(1 << 20, 'x');
  const auto of_length = [](const std::string& message) {
    INFO(message.substr(0, 1000));
    CHECK(message != "no error");
    CHECK(message.size() < 1000);
  };
  GltfFile file = MakeSquare();
  for (const char* uri : {"data:application/octet-stream;base64,*", "data:nothing", "", "../"}) {
    file.json["buffers"][0]["uri"] = uri + mega;
    of_length(MessageOf("a.glb", file.Binary()));
  }
  file = MakeSquare();
  file.json["asset"]["version"] = mega;
  of_length(MessageOf("a.glb", file.Binary()));
  file = MakeSquare();
  file.json["extensionsRequired"] = {mega};
  of_length(MessageOf("a.glb", file.Binary()));
  file = MakeSquare();
  file.json["nodes"][0]["extensions"][mega] = 1;
  of_length(MessageOf("a.glb", file.Binary()));
  of_length(MessageOf("a.gltf", "{\"" + mega));
  of_length(MessageOf("a.gltf", "{\"a\": \"" + mega + "\" 1}"));
  of_length(MessageOf("a.gltf", "{\"a\": 1e" + std::string(1 << 20, '9') + "}"));
  of_length(MessageOf("a.json", "{\"nacre\": 1, \"" + mega + "\": 1}"));
  of_length(MessageOf("a.json", "{\"nacre\": 1, \"materials\": {\"" + mega + "\": 1}}"));
  of_length(MessageOf("a.obj", "v " + mega));
  of_length(MessageOf("a.obj", "v 0 0 0\nf " + mega));
  of_length(MessageOf("a.ply",
                      "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\n"
                      "property float y\nproperty float z\nend_header\n" +
                          mega));
}

// Whatever bytes are changed, a file is read or refused.
TEST_CASE("spoilt bytes never do worse than be refused") {
  const std::string good = MakeRichFile().Binary();
  std::mt19937 random(1);
  const ModelFolder folder;
  int read = 0;
  for (int i = 0; i < 4000; ++i) {
    std::string bytes = good;
    const size_t changes = 1 + random() % 3;
    for (size_t k = 0; k < changes; ++k) {
      // Digits and brackets find the weak places of JSON, any byte those of the rest.
      constexpr std::string_view kBytes = "0123456789-.e[]{},:\" \xff";
      bytes[random() % bytes.size()] =
          random() % 4 == 0 ? static_cast<char>(random()) : kBytes[random() % kBytes.size()];
    }
    if (random() % 8 == 0) bytes.resize(random() % bytes.size());
    try {
      LoadScene(folder.Write("a.glb", bytes));
      ++read;
    } catch (const Error& error) {
      CHECK(error.code() == ExitCode::kBadInput);
    }
  }
  CHECK(read > 0);
  CHECK(read < 4000);
}

}  // namespace
}  // namespace nacre
