// SPDX-License-Identifier: Apache-2.0
// OBJ files, good and bad.
#include "scene_io/obj.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>

#include <fmt/format.h>
#include <unistd.h>

#include "base/error.h"
#include "catch.h"
#include "messages.h"
#include "scene/mesh.h"
#include "scene_io/obj_file.h"

namespace nacre {
namespace {

// Reads `text` as an OBJ file.
Mesh Read(const std::string& text) {
  const std::filesystem::path path =
      std::filesystem::temp_directory_path() / ("nacre_" + std::to_string(getpid()) + ".obj");
  std::ofstream(path, std::ios::binary) << text;
  try {
    Mesh mesh = ReadObj(path);
    std::filesystem::remove(path);
    return mesh;
  } catch (...) {
    std::filesystem::remove(path);
    throw;
  }
}

std::string MessageOf(const std::string& text) {
  return ErrorOf([&] { Read(text); });
}

bool Refused(const std::string& text, const std::string& part) {
  return Tells(MessageOf(text), part);
}

double Volume(const Mesh& mesh) {
  double volume = 0;
  for (size_t i = 0; i < mesh.triangles.size(); i += 3) {
    volume += mesh.positions[mesh.triangles[i]].dot(
        mesh.positions[mesh.triangles[i + 1]].cross(mesh.positions[mesh.triangles[i + 2]]));
  }
  return volume / 6;
}

const std::string kTriangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";

TEST_CASE("a triangle") {
  const Mesh mesh = Read("# comment\r\n" + kTriangle + "f 1 2 3\n");
  CHECK(mesh.positions == std::vector<Vec3d>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
  CHECK(mesh.triangles == std::vector<uint32_t>{0, 1, 2});
  CHECK(mesh.normals.empty());
}

// Everything that ReadObjFile says of a text: what it holds, or what is wrong, and its warnings.
std::string AllOf(const std::string& text) {
  const std::filesystem::path path =
      std::filesystem::temp_directory_path() / ("nacre_all_" + std::to_string(getpid()) + ".obj");
  std::ofstream(path, std::ios::binary) << text;
  std::string all;
  const auto warn = [&](const std::string& warning) { all += warning + "\n"; };
  try {
    const ObjFile obj = ReadObjFile(path, 3, warn);
    for (const Vec3d& p : obj.positions) all += fmt::format("v {} {} {}\n", p.x, p.y, p.z);
    for (const Vec3f& c : obj.colors) all += fmt::format("color {} {} {}\n", c.x, c.y, c.z);
    for (const Vec3d& n : obj.normals) all += fmt::format("vn {} {} {}\n", n.x, n.y, n.z);
    for (const Vec2d& uv : obj.uvs) all += fmt::format("vt {} {}\n", uv.x, uv.y);
    for (const unsigned char count : obj.corner_counts) all += fmt::format("face {}\n", count);
    for (const ObjCorner& c : obj.corners) {
      all += fmt::format("corner {} {} {}\n", c.position, c.uv, c.normal);
    }
    for (const ObjFile::Use& use : obj.uses) {
      all += fmt::format("use {} {}\n", use.first_face, use.name);
    }
    for (const std::string& name : obj.material_names) all += "material " + name + "\n";
    for (const std::string& name : obj.libraries) all += "library " + name + "\n";
  } catch (const Error& error) {
    all += error.what();
  }
  std::filesystem::remove(path);
  return all;
}

// With such blanks in the place of @, statements are in different pieces, which are read at the
// same time.
const std::string kPadding(size_t{5} << 18, ' ');

void CheckPieces(std::string text) {
  std::string padded = text;
  for (size_t at = padded.find('@'); at != std::string::npos;
       at = padded.find('@', at + kPadding.size())) {
    padded.replace(at, 1, kPadding);
  }
  std::replace(text.begin(), text.end(), '@', ' ');
  INFO(text);
  CHECK(AllOf(padded) == AllOf(text));
}

TEST_CASE("a file in pieces is read as a whole is") {
  const std::string faces = "f -1 -2 -3\nf 1/1/1 2/2/-1 3/-1/1 4//\n";
  const std::string parts =
      "usemtl early\nmtllib a b\nv 0 0 0\nv 1 0 0\n#@\nv 0 1 0\nvn 0 0 1\nvt 0 0\nusemtl red\nl 1 "
      "2\n" +
      faces + "usemtl blue\n#@\nusemtl red\nmtllib a b\nwhat 1\nv 1 1 0 1 .5 0\nvt 1 1\n" + faces +
      "#@\\\n#@\r\nv 2 2 2\np 1\nother 1\nl 1\nf \\\n 1 \\\n 2 \\\n 5\n#@\nusemtl new\n" + faces;
  CheckPieces(parts);
  CheckPieces(parts + "#@\nv 1 1 1 255 9 0\n");
  // Of two mistakes the first is told, but for indices beyond all elements: those are told last.
  CheckPieces(parts + "#@\nf 1 2 9\n#@\nf 1 2 8\n");
  CheckPieces(parts + "#@\nf 1 2 9\n#@\nv 1 2\n#@\nv 1\n");
  CheckPieces(parts + "#@\nf -1 -2 -6\n#@\nf -1 -2 -5\n");
  CheckPieces("v 0 0 0\n#@\nvn 0 0 1\n#@");
  // A line that goes on is not cut.
  CheckPieces(kTriangle + "f 1 @\\\n 2 3\n");
  CheckPieces(kTriangle + "f 1 2 3 #@\\\nf 1 2 4\n");
  CheckPieces(kTriangle + "f 1 \\\r\n\\\r\n@\\\r\n2 3\r\n");
}

TEST_CASE("texture coordinates part vertices, and are read if every corner has them") {
  const std::string uvs = "vt 0 0\nvt 1 0.25\nvt 0.5\n";
  const Mesh mesh = Read(kTriangle + uvs + "f 1/1 2/2 3/3\nf 1/2 3/3 2/2\n");
  CHECK(mesh.positions.size() == 4);
  CHECK(mesh.uvs == std::vector<Vec2d>{{0, 0}, {1, 0.25}, {0.5, 0}, {1, 0.25}});
  CHECK(mesh.triangles == std::vector<uint32_t>{0, 1, 2, 3, 2, 1});
  CHECK(Read(kTriangle + uvs + "f 1/1 2/2 3/3\nf 1 3 2\n").uvs.empty());
}

TEST_CASE("positions are read in double") {
  const Mesh mesh = Read("v 0.123456789012 0 1e6\nv +1 0 0\nv 0 1 0\nf 1 2 3");
  CHECK(mesh.positions[0].x == 0.123456789012);
  CHECK(mesh.positions[0].z == 1e6);
}

TEST_CASE("relative indices, groups, materials and texture coordinates") {
  const Mesh mesh = Read("mtllib no.mtl\no one\n" + kTriangle +
                         "vt 0 0\nusemtl red\nf -3/1 -2/1 -1/1\ng two\nusemtl blue\nf 1 3 2\n"
                         "l 1 2\n");
  CHECK(mesh.triangles == std::vector<uint32_t>{0, 1, 2, 0, 2, 1});
  CHECK(mesh.positions.size() == 3);
}

TEST_CASE("a position with two normals becomes two vertices, normals become unit") {
  const Mesh mesh = Read(kTriangle + "vn 0 0 2\nvn 0 0 -1\nf 1//1 2//1 3//1\nf 1//2 3//2 2//2\n");
  CHECK(mesh.positions.size() == 6);
  REQUIRE(mesh.normals.size() == 6);
  CHECK(mesh.normals[0] == Vec3d(0, 0, 1));
  CHECK(mesh.normals[3] == Vec3d(0, 0, -1));
}

TEST_CASE("a normal of length 0 is taken for the average of its faces") {
  const Mesh mesh = Read(kTriangle + "vn 0 0 0\nvn 0 1 0\nf 1//1 2//1 3//2\n");
  CHECK(mesh.normals == std::vector<Vec3d>{{0, 0, 1}, {0, 0, 1}, {0, 1, 0}});
}

TEST_CASE("normals count only if every corner has one") {
  CHECK(Read(kTriangle + "vn 0 0 1\nf 1//1 2//1 3\n").normals.empty());
}

TEST_CASE("polygons are cut into as many triangles as they need") {
  std::string text;
  std::string face = "f";
  for (int i = 0; i < 200; ++i) {
    text += fmt::format("v {} {} 0\n", std::cos(i * 0.0314159), std::sin(i * 0.0314159));
    face += fmt::format(" {}", i + 1);
  }
  CHECK(Read(text + face).triangles.size() == 3 * 198);
}

TEST_CASE("the torus knot that ships is closed and inside out it is not") {
  const Mesh mesh =
      ReadObj(std::filesystem::path(NACRE_SOURCE_DIR) / "scenes/meshes/torus_knot.obj");
  CHECK(mesh.positions.size() == 220 * 20);
  CHECK(mesh.triangles.size() == 3 * 2 * mesh.positions.size());  // Euler: of a torus, F = 2 V
  // The tube: its length (of the curve 0.46 (2 + cos 3t, ...)) times the area of a 20-gon. The
  // length is summed here; bends change the volume by the tube's offset only, a few percent.
  double length = 0;
  const auto curve = [](double t) {
    const double r = 0.46 * (2 + std::cos(3 * t));
    return Vec3d(r * std::cos(2 * t), r * std::sin(2 * t), -0.46 * std::sin(3 * t));
  };
  constexpr int kSteps = 10000;
  constexpr double kTurn = 6.283185307179586;
  for (int i = 0; i < kSteps; ++i) {
    length += (curve(kTurn * (i + 1) / kSteps) - curve(kTurn * i / kSteps)).length();
  }
  const double section = 10 * 0.2 * 0.2 * std::sin(kTurn / 20);
  CHECK(Volume(mesh) == Approx(length * section).epsilon(0.03));
}

TEST_CASE("what is wrong with an OBJ file is said") {
  CHECK(Refused("", "has no faces"));
  CHECK(Refused(kTriangle, "has no faces"));
  CHECK(Refused(kTriangle + "f 1 2 4\n", ".obj:4: a face has position 4\n  hint: there are 3"));
  CHECK(Refused(kTriangle + "f 1 2 0\n", ".obj:4: a face has position 0\n  hint: indices are"));
  CHECK(Refused(kTriangle + "f 1 2 //1\n", ".obj:4: a face has position 0"));
  CHECK(Refused(kTriangle + "f 1 2 -4\n", ".obj:4: a face has position -4\n  hint: there are 3"));
  CHECK(Refused(kTriangle + "f 1 2 -400\n", "a face has position -400"));
  CHECK(Refused(kTriangle + "f 1 2 99999999999\n", "a face has position"));
  CHECK(Refused(kTriangle + "f 1 2 99999999999999999999\n", "is no index"));
  CHECK(Refused(kTriangle + "f 1//1 2//1 3//1\n", "a face has normal 1\n  hint: there are 0"));
  CHECK(Refused(kTriangle + "f 1/1/-1 2 3\n", "a face has normal -1\n  hint: there are 0"));
  CHECK(Refused(kTriangle + "f a b c\n", ".obj:4: \"a\" is no index"));
  CHECK(Refused(kTriangle + "f 1 2\n", ".obj:4: a face has fewer than three corners"));
  CHECK(Refused("v 0 0\n", ".obj:1: \"\" is not a finite number"));
  CHECK(Refused(kTriangle + "v 0 x 0\n", ".obj:4: \"x\" is not a finite number"));
  CHECK(Refused(kTriangle + "v 0 nan 0\n", "\"nan\" is not a finite number"));
  CHECK(Refused(kTriangle + "v 0 inf 0\n", "\"inf\" is not a finite number"));
  CHECK(Refused(kTriangle + "v 0 1e999 0\n", "\"1e999\" is not a finite number"));
  CHECK(Refused(kTriangle + "vn 0 1,5 0\n", "\"1,5\" is not a finite number"));
  CHECK(Refused(kTriangle + "vt\n",
                ".obj:4: \"\" is not a finite number\n  hint: \"vt\" is followed by one"));
  CHECK(Refused(kTriangle + "vt 0 nan\n", "\"nan\" is not a finite number"));
  CHECK(Refused(kTriangle + "vt 0 0\nf 1/1 2/2 3/1\n", "a face has uv 2\n  hint: there are 1"));
}

TEST_CASE("text is read however editors and exporters write it") {
  const Mesh plain = Read(kTriangle + "v 1 1 0\nf 1 2 4 3\n");
  REQUIRE(plain.triangles.size() == 6);
  const auto same = [&](const std::string& text) {
    INFO(text);
    const Mesh mesh = Read(text);
    CHECK(mesh.positions == plain.positions);
    CHECK(mesh.triangles == plain.triangles);
  };
  same("\xef\xbb\xbf" + kTriangle + "v 1 1 0\nf 1 2 4 3\n");
  same("v 0 0 0\r\nv 1 0 0\r\nv 0 1 0\r\nv 1 1 0\r\nf 1 2 4 3\r\n");
  same("v 0 0 0\rv 1 0 0\rv 0 1 0\rv 1 1 0\rf 1 2 4 3");
  same(kTriangle + "v 1 1 0\nf 1 2 \\\n4 3\n");
  same(kTriangle + "v 1 1 0\nf 1 2\\\r\n 4\\\r\n 3");
  same("# C:\\models\\\n" + kTriangle + "v 1 \\\n1 0\nf 1 2 4 3\n");
  same("V 0 0 0\nV 1 0 0\nV 0 1 0\nV 1 1 0\nF 1 2 4 3\n");
  same(" v\t0. .0 0\n\tv 1e0 0 0 \t\nv 0 +1 1e-400\nv 1. 1 -0 # a corner\nf 1 2 4 3 # all\n");
  same(kTriangle + "v 1 1 0 1\nf -4 -3 -1 -2\n");
  same(kTriangle + "v 1 1 0\nf 1/ 2/ 4// 3\n");
  same("fo 1 2 4 3\n" + kTriangle + "v 1 1 0\n");
  CHECK(Refused("\xff\xfev\0 \0", "is text in UTF-16"));
}

TEST_CASE("an index 0 of a normal or a uv is none") {
  CHECK(Read(kTriangle + "vn 0 0 1\nf 1//0 2//1 3//1\n").normals.empty());
  CHECK(Read(kTriangle + "vt 0 0\nf 1/0 2/1 3/1\n").uvs.empty());
  CHECK(Read(kTriangle + "vn 0 0 1\nf 1/0/1 2/0/1 3/0/1\n").normals.size() == 3);
}

TEST_CASE("tags are not read: nobody makes room for two thousand million of them") {
  CHECK(Read(kTriangle + " t x 2000000000/2000000000/2000000000\nf 1 2 3\n").positions.size() == 3);
}

TEST_CASE("a face of 256 corners is refused, not wrapped around") {
  std::string face = "f";
  for (int i = 0; i < 256; ++i) face += fmt::format(" {}", i % 3 + 1);
  CHECK(Refused(kTriangle + face, "more than 255 corners"));
}

}  // namespace
}  // namespace nacre
