// SPDX-License-Identifier: Apache-2.0
// PLY files, good and bad: text, bytes of both orders, any order of properties.
#include <algorithm>
#include <cmath>
#include <random>

#include <fmt/format.h>

#include "catch.h"
#include "color/transfer.h"
#include "messages.h"
#include "scene_io/gltf_builder.h"
#include "scene_io/model_files.h"

namespace nacre {
namespace {

Scene LoadPly(const std::string& bytes, std::vector<std::string>* warnings = nullptr) {
  const ModelFolder folder;
  LoadOptions options;
  options.on_warning = [&](const std::string& text) {
    if (warnings != nullptr) warnings->push_back(text);
  };
  return LoadScene(folder.Write("model.ply", bytes), options);
}

bool Refused(const std::string& bytes, const std::string& part) {
  return Tells(ErrorOf([&] { LoadPly(bytes); }), part);
}

const std::string kVertices =
    "ply\nformat ascii 1.0\ncomment made by hand\nelement vertex 4\n"
    "property float x\nproperty float y\nproperty float z\n";
const std::string kFaces = "element face 1\nproperty list uchar int vertex_indices\nend_header\n";
const std::string kPoints = "0 0 0\n1 0 0\n1 1 0\n0 1 0\n";

template <typename T>
std::string Bytes(T value, bool big) {
  std::string bytes(reinterpret_cast<const char*>(&value), sizeof(T));
  if (big) std::reverse(bytes.begin(), bytes.end());
  return bytes;
}

TEST_CASE("headers are read however they are written") {
  const std::string text = kVertices + kFaces + kPoints + "4 0 1 2 3\n";
  const std::vector<Vec3d> positions = LoadPly(text).meshes.at(0).positions;
  const auto with_line_ends = [&](const std::string& ends) {
    std::string changed;
    for (const char c : text) changed += c == '\n' ? ends : std::string(1, c);
    return changed;
  };
  CHECK(LoadPly("\xef\xbb\xbf" + text).meshes.at(0).positions == positions);
  CHECK(LoadPly(with_line_ends("\r\n")).meshes.at(0).positions == positions);
  CHECK(LoadPly(with_line_ends("\r")).meshes.at(0).positions == positions);
  CHECK(Refused("\xff\xfep", "is text in UTF-16"));
  // Bytes after each line end; the first of them looks like one.
  for (const char* end : {"\n", "\r\n", "\r"}) {
    std::string header =
        "ply\nformat binary_little_endian 1.0\nelement vertex 3\n"
        "property float x\nproperty float y\nproperty uchar z\n"
        "element face 1\nproperty list uchar ushort vertex_index\nend_header\n";
    std::string bytes;
    for (const char c : header) bytes += c == '\n' ? std::string(end) : std::string(1, c);
    const float x = 0x1.00000ap-126f;  // its first byte is that of \n
    for (const float at : {x, 1.0f, 0.0f}) {
      bytes += Bytes(at, false) + Bytes(at == x ? 0.0f : 1.0f - at, false) + '\0';
    }
    bytes +=
        '\3' + Bytes(uint16_t{0}, false) + Bytes(uint16_t{1}, false) + Bytes(uint16_t{2}, false);
    CHECK(LoadPly(bytes).meshes.at(0).positions.at(1) == Vec3d(1, 0, 0));
  }
}

TEST_CASE("properties have several names, and numbers any form") {
  const Mesh mesh =
      LoadPly(
          "ply\nformat ascii 1.0\nobj_info a\nelement vertex 3\nproperty double x\n"
          "property double y\nproperty double z\nproperty float normal_x\n"
          "property float normal_y\nproperty float normal_z\nproperty float texture_s\n"
          "property float texture_t\nproperty float quality\nelement edge 1\n"
          "property int vertex1\nproperty list char float weights\nelement face 1\n"
          "property uchar flags\nproperty list int uint vertex_indexes\nend_header\n"
          "0. .0 1e-400 0 0 1 0 .25 nan\n+1 0 0 0 0 1 1 0 inf\n0 1e0 0 0 0 1 0 1 0\n"
          "7 2 0.5 1.5\n3 3 0 1 2\n")
          .meshes.at(0);
  CHECK(mesh.positions == std::vector<Vec3d>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
  CHECK(mesh.normals.size() == 3);
  CHECK(mesh.uvs == std::vector<Vec2d>{{0, 0.25}, {1, 0}, {0, 1}});
}

TEST_CASE("colours of vertices are shown on faces, those of faces are told") {
  std::vector<std::string> warnings;
  const Scene scene = LoadPly(
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
      "property float z\nproperty ushort red\nproperty ushort green\n"
      "property ushort blue\nelement face 1\nproperty list uchar int vertex_indices\n"
      "property uchar red\nproperty uchar green\nproperty uchar blue\n"
      "property list uchar float texcoord\nend_header\n0 0 0 65535 0 0\n"
      "1 0 0 0 65535 0\n0 1 0 0 0 13107\n3 0 1 2 1 2 3 6 0 0 1 0 0 1\n",
      &warnings);
  CHECK(warnings.size() == 2);
  const Mesh& mesh = scene.meshes.at(0);
  REQUIRE(mesh.colors.size() == 3);
  CHECK(mesh.colors[0] == Vec3f(1, 0, 0));
  CHECK(mesh.colors[1] == Vec3f(0, 1, 0));
  CHECK(mesh.colors[2].z == Approx(0.03310477).epsilon(1e-6));  // sRGB 0.2
  CHECK(scene.materials.at(mesh.material.index).vertex_colors == VertexColors::kBase);
}

TEST_CASE("a square as text") {
  const Scene scene = LoadPly(kVertices + kFaces + kPoints + "4 0 1 2 3\n");
  REQUIRE(scene.meshes.size() == 1);
  const Mesh& mesh = scene.meshes[0];
  CHECK(mesh.name == "model");
  CHECK(mesh.positions == std::vector<Vec3d>{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}});
  CHECK(mesh.triangles == std::vector<uint32_t>{0, 1, 2, 0, 2, 3});
  CHECK(mesh.normals == std::vector<Vec3d>(4, Vec3d(0, 0, 1)));
  CHECK(scene.lights.size() == 4);  // the studio's
}

TEST_CASE("bytes of both orders, properties in any order, of any type, and others between them") {
  for (const bool big : {false, true}) {
    std::string file = "ply\nformat binary_" + std::string(big ? "big" : "little") +
                       "_endian 1.0\nelement face 2\nproperty uchar flags\n"
                       "property list ushort uint vertex_index\n"
                       "property list uchar float extra\nelement camera 1\nproperty double f\n"
                       "element vertex 4\nproperty double z\nproperty list uchar short skip\n"
                       "property short y\nproperty int x\nproperty float nx\nproperty float ny\n"
                       "property float nz\nproperty float t\nproperty float s\nend_header\n";
    for (const auto& face : {std::vector<uint32_t>{0, 1, 2}, {0, 2, 3}}) {
      file += Bytes(uint8_t{7}, big) + Bytes(static_cast<uint16_t>(face.size()), big);
      for (const uint32_t index : face) file += Bytes(index, big);
      file += Bytes(uint8_t{1}, big) + Bytes(0.5f, big);
    }
    file += Bytes(1.5, big);
    for (const auto& [x, y] : {std::pair(0, 0), {300, 0}, {300, -2}, {0, -2}}) {
      file += Bytes(0.25, big) + Bytes(uint8_t{1}, big) + Bytes(int16_t{-1}, big);
      file += Bytes(static_cast<int16_t>(y), big) + Bytes(static_cast<int32_t>(x), big);
      file += Bytes(0.0f, big) + Bytes(0.0f, big) + Bytes(-2.0f, big);
      file += Bytes(0.75f, big) + Bytes(0.5f, big);
    }
    const Mesh mesh = LoadPly(file).meshes.at(0);
    CHECK(mesh.positions ==
          std::vector<Vec3d>{{0, 0, 0.25}, {300, 0, 0.25}, {300, -2, 0.25}, {0, -2, 0.25}});
    CHECK(mesh.triangles == std::vector<uint32_t>{0, 1, 2, 0, 2, 3});
    CHECK(mesh.normals == std::vector<Vec3d>(4, Vec3d(0, 0, -1)));
    CHECK(mesh.uvs == std::vector<Vec2d>(4, Vec2d(0.5, 0.75)));
    CHECK(Refused(file.substr(0, file.size() - 1), "ends too early"));
  }
}

TEST_CASE("triangle strips wind like faces") {
  const Scene scene = LoadPly(kVertices +
                              "element tristrips 1\nproperty list int int vertex_indices\n"
                              "end_header\n" +
                              kPoints + "8 0 1 3 2 -1 0 1 2\n");
  CHECK(scene.meshes.at(0).triangles == std::vector<uint32_t>{0, 1, 3, 3, 1, 2, 0, 1, 2});
  // After an odd number of triangles a new strip begins as the first did.
  const Scene odd = LoadPly(kVertices +
                            "element tristrips 1\nproperty list int int vertex_indices\n"
                            "end_header\n" +
                            kPoints + "7 0 1 3 -1 0 1 2\n");
  CHECK(odd.meshes.at(0).triangles == std::vector<uint32_t>{0, 1, 3, 0, 1, 2});
}

TEST_CASE("edges stay sharp where faces without normals meet at a right angle") {
  const std::string file =
      "ply\nformat ascii 1.0\nelement vertex 6\nproperty float x\nproperty float y\n"
      "property float z\nelement face 2\nproperty list uchar int vertex_indices\nend_header\n" +
      kPoints + "1 0 -1\n0 0 -1\n4 0 1 2 3\n4 0 5 4 1\n";
  CHECK(LoadPly(file).meshes.at(0).positions.size() == 8);
}

TEST_CASE("points become spheres, with their colours and radii") {
  const std::string points =
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
      "property float z\nproperty float radius\nproperty uchar red\nproperty uchar green\n"
      "property uchar blue\nend_header\n"
      "0 0 0 0.5 255 0 0\n2 0 0 0.25 0 128 0\n4 0 0 1 255 0 0\n";
  const Scene scene = LoadPly(points);
  REQUIRE(scene.spheres.size() == 3);
  CHECK(scene.spheres[1].center == Vec3d(2, 0, 0));
  CHECK(scene.spheres[1].radius == 0.25);
  REQUIRE(scene.materials.size() == 2);
  CHECK(scene.spheres[0].material == scene.spheres[2].material);
  const auto& green = std::get<MetallicRoughnessMaterial>(scene.materials[1].model);
  CHECK(green.base_color == Rgb(0, SrgbEotf(128 / 255.0), 0));
  CHECK(
      Refused("ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\n"
              "property float z\nproperty float radius\nend_header\n0 0 0 0\n",
              "vertex 0 has radius 0"));
  // Without radii: apart, and near enough to see a surface.
  const Scene grid = LoadPly(kVertices + "end_header\n" + kPoints);
  CHECK(grid.spheres.at(0).radius > 0.1);
  CHECK(grid.spheres.at(0).radius < 0.5);
}

TEST_CASE("a cloud of many colours has few materials") {
  std::string file =
      "ply\nformat ascii 1.0\nelement vertex 20000\nproperty float x\n"
      "property float y\nproperty float z\nproperty uchar red\n"
      "property uchar green\nproperty uchar blue\nend_header\n";
  std::mt19937 random(1);
  for (int i = 0; i < 20000; ++i) {
    file += fmt::format("{} {} 0 {} {} {}\n", i % 100, i / 100, random() % 256, random() % 256,
                        random() % 256);
  }
  std::vector<std::string> warnings;
  const Scene scene = LoadPly(file, &warnings);
  CHECK(scene.spheres.size() == 20000);
  CHECK(scene.materials.size() <= 4096);
  CHECK(scene.materials.size() > 3000);
  CHECK(warnings.size() == 1);
}

TEST_CASE("a PLY file can be a mesh of a scene") {
  const ModelFolder folder;
  folder.Write("square.ply", kVertices + kFaces + kPoints + "4 0 1 2 3\n");
  const auto path = folder.Write("scene.json", R"({"nacre": 1, "shapes": [{"type": "mesh",
      "file": "square.ply", "material": {"model": "lambert"}, "transform": {"scale": 2}}]})");
  CHECK(LoadScene(path).meshes.at(0).positions[2] == Vec3d(2, 2, 0));
}

TEST_CASE("what is wrong with a PLY file is said") {
  CHECK(Refused("", "is not a PLY file"));
  CHECK(Refused("plyx\n", "is not a PLY file"));
  CHECK(Refused("ply\nformat ascii 1.0\n", "ply:3: the header does not end"));
  CHECK(Refused("ply\nend_header\n", "the header names no format"));
  CHECK(Refused("ply\nformat ascii 2.0\nend_header\n", "ply:2: unknown format"));
  CHECK(Refused("ply\nformat ascii 1.0\nend_header\n", "has no vertices"));
  CHECK(Refused("ply\nformat ascii 1.0\nproperty float x\n", "ply:3: a property of no element"));
  CHECK(Refused("ply\nformat ascii 1.0\nelement vertex -1\n", "element NAME COUNT"));
  CHECK(Refused("ply\nformat ascii 1.0\nelement vertex 4x\n", "element NAME COUNT"));
  CHECK(Refused("ply\nformat ascii 1.0\nelement vertex 1\nproperty quad x\n",
                "unknown type \"quad\""));
  CHECK(Refused("ply\nformat ascii 1.0\nelement vertex 1\nproperty list float int x\n",
                "whole numbers"));
  CHECK(Refused(kVertices + "property float x\n", "a second property of this name"));
  CHECK(Refused(kVertices + "element vertex 3\n", "a second element of this name"));
  CHECK(
      Refused("ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\n"
              "end_header\n0 0\n",
              "its vertices have no x, y and z"));
  CHECK(
      Refused("ply\nformat ascii 1.0\nelement vertex 4000000000\nproperty float x\nend_header\n0\n",
              "4000000000 elements \"vertex\" are more than the file holds"));
  CHECK(Refused("ply\nformat ascii 1.0\nelement vertex 4000000000\nend_header\n",
                "are more than the file holds"));
  CHECK(Refused(kVertices + kFaces + kPoints + "4 0 1 2 4\n",
                "face 0 has vertex 4\n  hint: there are 4"));
  CHECK(Refused(kVertices + kFaces + kPoints + "4 0 1 2 -1\n", "face 0 has vertex -1"));
  // In text with the line, however lines end.
  CHECK(
      Refused("ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\n"
              "property float z\nend_header\n0 0\nx\n",
              "ply:9: \"x\" is not a number"));
  CHECK(
      Refused("ply\rformat ascii 1.0\relement vertex 1\rproperty float x\rproperty float y\r"
              "property float z\rend_header\r0 0\r1e99\r",
              "ply:9: vertex 0 is at"));
  CHECK(Refused(kVertices + kFaces + kPoints + "2 0 1\n", "has no face of three corners or more"));
  CHECK(Refused(kVertices + kFaces + kPoints + "200 0 1\n", "a list of 200 is more than"));
  CHECK(Refused(kVertices + kFaces + kPoints + "4 0 1 2\n", "ends too early"));
  CHECK(Refused(kVertices + kFaces + kPoints + "300 0 1 2\n", "300 is not a number of its type"));
  CHECK(Refused(kVertices + kFaces + "0 0 0\n1 x 0\n1 1 0\n0 1 0\n4 0 1 2 3\n",
                "\"x\" is not a number"));
  CHECK(Refused(kVertices + kFaces + "0 0 0\n1 nan 0\n1 1 0\n0 1 0\n4 0 1 2 3\n",
                "vertex 1 is at [1, nan, 0]"));
  CHECK(
      Refused(kVertices + kFaces + "0 0 0\n1 1e30 0\n1 1 0\n0 1 0\n4 0 1 2 3\n", "vertex 1 is at"));
  CHECK(Refused(kVertices + kFaces + "0 0 0\n0 0 0\n0 0 0\n0 0 0\n4 0 1 2 3\n",
                "has no face with an area"));
}

TEST_CASE("faces of fewer than three corners are left out, those of many are cut") {
  const std::string faces = "element face 4\nproperty list ushort int vertex_indices\nend_header\n";
  std::vector<std::string> warnings;
  const Scene scene =
      LoadPly(kVertices + faces + kPoints + "3 0 1 2\n2 0 1\n0\n3 0 2 3\n", &warnings);
  CHECK(scene.meshes.at(0).triangles.size() == 6);
  REQUIRE(warnings.size() == 1);
  CHECK(
      Contains(warnings[0], "faces of fewer than three corners are left out, the first is face 1"));
  std::string disc =
      "ply\nformat ascii 1.0\nelement vertex 300\nproperty float x\nproperty float y\n"
      "property float z\nelement face 1\nproperty list ushort int vertex_indices\nend_header\n";
  std::string face = "300";
  for (int i = 0; i < 300; ++i) {
    disc += fmt::format("{} {} 0\n", std::cos(i * 0.02), std::sin(i * 0.02));
    face += fmt::format(" {}", i);
  }
  CHECK(LoadPly(disc + face + "\n").meshes.at(0).triangles.size() == 3 * 298);
  const std::string five = disc.replace(disc.find("face 1"), 6, "face 5");
  std::string large = "16384";
  for (int i = 0; i < 16'384; ++i) large += fmt::format(" {}", i % 300);
  large += "\n";
  CHECK(Refused(five + large + large + large + large + large, "up to 16384 corners"));
}

TEST_CASE("spoilt PLY files never do worse than be refused") {
  const std::string text = kVertices + kFaces + kPoints + "4 0 1 2 3\n";
  std::string binary =
      "ply\nformat binary_little_endian 1.0\nelement vertex 4\nproperty float x\n"
      "property float y\nproperty float z\n" +
      kFaces;
  for (const float number : kSquare) binary += Bytes(number, false);
  binary += Bytes(uint8_t{4}, false);
  for (int i = 0; i < 4; ++i) binary += Bytes(i, false);
  CHECK(ErrorOf([&] { LoadPly(binary); }) == "no error");
  std::mt19937 random(2);
  int fine = 0;
  for (int i = 0; i < 4000; ++i) {
    std::string bytes = i % 2 == 0 ? text : binary;
    for (size_t k = 0; k <= random() % 3; ++k) {
      constexpr std::string_view kBytes = "0123456789-.e \n";
      bytes[random() % bytes.size()] =
          random() % 3 == 0 ? static_cast<char>(random()) : kBytes[random() % kBytes.size()];
    }
    if (random() % 8 == 0) bytes.resize(random() % bytes.size());
    fine += ErrorOf([&] { LoadPly(bytes); }) == "no error" ? 1 : 0;
  }
  CHECK(fine > 0);
  CHECK(fine < 4000);
}

}  // namespace
}  // namespace nacre
