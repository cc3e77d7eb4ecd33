// SPDX-License-Identifier: Apache-2.0
// Skins of glTF files: linear blend skinning in the pose of the file's nodes.
#include <string>
#include <vector>

#include "catch.h"
#include "messages.h"
#include "scene/mesh.h"
#include "scene_io/gltf_builder.h"

namespace nacre {
namespace {

constexpr int kUnsignedByte = 5121, kUnsignedShort = 5123, kFloat = 5126;

bool IsClose(const Vec3d& a, const Vec3d& b) {
  return (a - b).length() < 1e-6;  // of numbers about 1 that are floats in the file: 2^-24 each
}

Json& AttributesOf(GltfFile* file) {
  return file->json["meshes"][0]["primitives"][0]["attributes"];
}

// The square as node 0, moved far away by its node, with a skin of two joints, nodes 1 and 2, which
// come after it. All corners hang on the first joint.
GltfFile MakeSkinned() {
  GltfFile file = MakeSquare();
  file.json["nodes"][0]["skin"] = 0;
  file.json["nodes"][0]["translation"] = {50, 60, 70};
  file.json["nodes"].push_back({{"translation", {0, 0, 2}}});
  file.json["nodes"].push_back({{"translation", {4, 0, 0}}});
  file.json["scenes"][0]["nodes"] = {0, 1, 2};
  file.json["skins"] = Json::parse(R"([{"joints": [1, 2]}])");
  AttributesOf(&file)["JOINTS_0"] =
      file.Accessor(std::vector<uint8_t>(16, 0), kUnsignedByte, "VEC4", 4);
  AttributesOf(&file)["WEIGHTS_0"] = file.Accessor(
      std::vector<float>{1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}, kFloat, "VEC4", 4);
  return file;
}

void SetWeights(const std::vector<float>& one, GltfFile* file) {
  std::vector<float> all;
  for (int i = 0; i < 4; ++i) all.insert(all.end(), one.begin(), one.end());
  AttributesOf(file)["WEIGHTS_0"] = file->Accessor(all, kFloat, "VEC4", 4);
}

void SetJoints(const std::vector<uint8_t>& one, GltfFile* file) {
  std::vector<uint8_t> all;
  for (int i = 0; i < 4; ++i) all.insert(all.end(), one.begin(), one.end());
  AttributesOf(file)["JOINTS_0"] = file->Accessor(all, kUnsignedByte, "VEC4", 4);
}

Mesh SkinnedMesh(const GltfFile& file) {
  std::vector<std::string> warnings;
  const Scene scene = LoadFile(file, &warnings);
  CHECK(warnings.empty());
  REQUIRE(scene.meshes.size() == 1);
  return scene.meshes[0];
}

std::string FaultOf(const GltfFile& file) {
  return ErrorOf([&] { LoadFile(file); });
}

TEST_CASE("a skinned mesh is where its joints are, not where its node is") {
  const Mesh mesh = SkinnedMesh(MakeSkinned());
  CHECK(mesh.positions == std::vector<Vec3d>{{0, 0, 2}, {1, 0, 2}, {1, 1, 2}, {0, 1, 2}});
  CHECK(mesh.triangles == std::vector<uint32_t>{0, 1, 2, 0, 2, 3});
  // Nor does a parent of its node count.
  GltfFile file = MakeSkinned();
  file.json["nodes"].push_back({{"children", {0}}, {"scale", {-9, 3, 3}}});
  file.json["scenes"][0]["nodes"] = {3, 1, 2};
  CHECK(SkinnedMesh(file).positions == mesh.positions);
  CHECK(SkinnedMesh(file).triangles == mesh.triangles);
  // A joint's parents do.
  file = MakeSkinned();
  file.json["nodes"].push_back({{"children", {1}}, {"translation", {0, 3, 0}}});
  file.json["scenes"][0]["nodes"] = {0, 3, 2};
  CHECK(SkinnedMesh(file).positions.at(0) == Vec3d(0, 3, 2));
}

TEST_CASE("weights blend the joints, in any form and of any sum") {
  GltfFile file = MakeSkinned();
  SetJoints({0, 1, 0, 0}, &file);
  SetWeights({0.75f, 0.25f, 0, 0}, &file);
  CHECK(IsClose(SkinnedMesh(file).positions.at(0), {1, 0, 1.5}));
  SetWeights({1.5f, 0.5f, 0, 0}, &file);
  CHECK(IsClose(SkinnedMesh(file).positions.at(0), {1, 0, 1.5}));
  SetWeights({0, 0, 0, 0}, &file);  // then the first joint has it
  CHECK(IsClose(SkinnedMesh(file).positions.at(0), {0, 0, 2}));
  // Normalised bytes and joints as shorts; each corner has its own.
  const std::vector<uint8_t> weights = {255, 0, 0, 0, 0, 255, 0, 0, 0, 0, 255, 0, 51, 204, 0, 0};
  AttributesOf(&file)["WEIGHTS_0"] = file.Accessor(weights, kUnsignedByte, "VEC4", 4);
  file.json["accessors"].back()["normalized"] = true;
  const std::vector<uint16_t> joints = {0, 1, 1, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1, 1, 0};
  AttributesOf(&file)["JOINTS_0"] = file.Accessor(joints, kUnsignedShort, "VEC4", 4);
  const Mesh mesh = SkinnedMesh(file);
  CHECK(IsClose(mesh.positions.at(0), {0, 0, 2}));
  CHECK(IsClose(mesh.positions.at(1), {5, 0, 0}));
  CHECK(IsClose(mesh.positions.at(2), {5, 1, 0}));
  CHECK(IsClose(mesh.positions.at(3), {3.2, 1, 0.4}));
}

TEST_CASE("more than four joints a vertex") {
  GltfFile file = MakeSkinned();
  AttributesOf(&file)["JOINTS_1"] =
      file.Accessor(std::vector<uint8_t>(16, 1), kUnsignedByte, "VEC4", 4);
  AttributesOf(&file)["WEIGHTS_1"] = file.Accessor(
      std::vector<float>{0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0}, kFloat, "VEC4", 4);
  CHECK(IsClose(SkinnedMesh(file).positions.at(0), {2, 0, 1}));  // half of each
  for (int i = 2; i < 17; ++i) {
    AttributesOf(&file)["JOINTS_" + std::to_string(i)] = AttributesOf(&file)["JOINTS_1"];
    AttributesOf(&file)["WEIGHTS_" + std::to_string(i)] = AttributesOf(&file)["WEIGHTS_1"];
  }
  CHECK(Tells(FaultOf(file), "more than 16 sets of joints"));
}

TEST_CASE("an inverse bind matrix takes back where the joint was") {
  GltfFile file = MakeSkinned();
  // Joint 1 was bound at (0, 0, 2), turned by 90 degrees about x and twice as large; joint 2 as the
  // default is.
  file.json["nodes"][1] = {{"translation", {0, 0, 2}},
                           {"rotation", {0.70710678118654752, 0, 0, 0.70710678118654752}},
                           {"scale", {2, 2, 2}}};
  const std::vector<float> inverse = {0.5f, 0, 0, 0, 0, 0, -0.5f, 0, 0, 0.5f, 0,    0, 0, -1, 0, 1,
                                      1,    0, 0, 0, 0, 1, 0,     0, 0, 0,    1.0f, 0, 0, 0,  0, 1};
  file.json["skins"][0]["inverseBindMatrices"] = file.Accessor(inverse, kFloat, "MAT4", 16);
  const Mesh bound = SkinnedMesh(file);
  for (size_t i = 0; i < 4; ++i) {
    CHECK(
        IsClose(bound.positions[i], Vec3d(kSquare[3 * i], kSquare[3 * i + 1], kSquare[3 * i + 2])));
  }
  // The joint is posed: all of the square turns with it.
  file.json["nodes"][1]["translation"] = {7, 0, 2};
  CHECK(IsClose(SkinnedMesh(file).positions.at(2), {8, 1, 0}));
}

TEST_CASE("normals, tangents and the order of corners go by the joints, too") {
  GltfFile file = MakeSkinned();
  const std::vector<float> normals = {0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1};
  const std::vector<float> tangents = {1, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1};
  AttributesOf(&file)["NORMAL"] = file.Accessor(normals, kFloat, "VEC3", 3);
  AttributesOf(&file)["TANGENT"] = file.Accessor(tangents, kFloat, "VEC4", 4);
  // About y by 90 degrees: z goes to x, x to -z.
  file.json["nodes"][1] = {{"rotation", {0, 0.70710678118654752, 0, 0.70710678118654752}}};
  Mesh mesh = SkinnedMesh(file);
  REQUIRE(mesh.tangents.size() == 4);
  CHECK(IsClose(mesh.normals.at(0), {1, 0, 0}));
  CHECK(IsClose(mesh.tangents[0].direction, {0, 0, -1}));
  CHECK(mesh.tangents[0].sign == 1);
  // A joint that mirrors turns the mesh's triangles round; a node that does so does not.
  file.json["nodes"][1] = {{"scale", {-1, 1, 1}}};
  mesh = SkinnedMesh(file);
  REQUIRE(mesh.tangents.size() == 4);
  CHECK(mesh.triangles == std::vector<uint32_t>{0, 2, 1, 0, 3, 2});
  CHECK(IsClose(mesh.normals.at(0), {0, 0, 1}));
  CHECK(IsClose(mesh.tangents[0].direction, {-1, 0, 0}));
  CHECK(mesh.tangents[0].sign == -1);
}

TEST_CASE("a skin without joints in its mesh") {
  GltfFile file = MakeSkinned();
  AttributesOf(&file).erase("WEIGHTS_0");
  std::vector<std::string> warnings;
  CHECK(LoadFile(file, &warnings).meshes.at(0).positions.at(0) == Vec3d(50, 60, 70));
  REQUIRE(warnings.size() == 1);
  CHECK(Tells(warnings[0], "has no JOINTS_0 and WEIGHTS_0: its node moves it"));
}

TEST_CASE("a joint that no weight asks for may have any number") {
  GltfFile file = MakeSkinned();
  SetJoints({0, 255, 7, 9}, &file);
  CHECK(SkinnedMesh(file).positions.at(0) == Vec3d(0, 0, 2));
}

TEST_CASE("skins that cannot be") {
  GltfFile file = MakeSkinned();
  file.json["nodes"][0]["skin"] = 1;
  CHECK(Tells(FaultOf(file), "/skins/1: there is no such skin"));

  file = MakeSkinned();
  SetJoints({2, 0, 0, 0}, &file);
  CHECK(Tells(FaultOf(file), "joint 2 of element 0"));

  file = MakeSkinned();
  file.json["skins"][0]["joints"] = {1, 9};
  CHECK(Tells(FaultOf(file), "/skins/0/joints/1: node 9 is not in the scene"));
  file.json["skins"][0]["joints"] = {1, 2};
  file.json["scenes"][0]["nodes"] = {0, 1};
  CHECK(Tells(FaultOf(file), "/skins/0/joints/1: node 2 is not in the scene"));

  file = MakeSkinned();
  file.json["skins"][0]["joints"] = "all";
  CHECK(Tells(FaultOf(file), "/skins/0/joints"));

  file = MakeSkinned();
  SetWeights({1, -0.5f, 0, 0}, &file);
  CHECK(Tells(FaultOf(file), "weight -0.5 of element 0"));

  file = MakeSkinned();
  file.json["skins"][0]["inverseBindMatrices"] =
      file.Accessor(std::vector<float>(16, 1), kFloat, "MAT4", 16);
  CHECK(Tells(FaultOf(file), "1 matrices for 2 joints"));
  file.json["skins"][0]["inverseBindMatrices"] =
      file.Accessor(std::vector<uint8_t>(32, 1), kUnsignedByte, "MAT4", 16);
  CHECK(Tells(FaultOf(file), "matrices are of floats"));

  file = MakeSkinned();
  AttributesOf(&file)["JOINTS_0"] =
      file.Accessor(std::vector<uint8_t>(12, 0), kUnsignedByte, "VEC4", 4);
  CHECK(Tells(FaultOf(file), "3 elements for 4 positions"));

  file = MakeSkinned();
  AttributesOf(&file)["JOINTS_0"] = AttributesOf(&file)["WEIGHTS_0"];
  CHECK(Tells(FaultOf(file), "joints are of an unsigned type"));
}

}  // namespace
}  // namespace nacre
