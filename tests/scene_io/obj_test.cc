// SPDX-License-Identifier: Apache-2.0
// OBJ files, good and bad.
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
#include "scene_io/gltf_builder.h"
#include "scene_io/model_files.h"
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
    for (const uint16_t count : obj.corner_counts) all += fmt::format("face {}\n", count);
    for (const ObjCorner& c : obj.corners) {
      all += fmt::format("corner {} {} {}\n", c.position, c.uv, c.normal);
    }
    for (const ObjFile::Use& use : obj.uses) {
      all += fmt::format("use {} {}\n", use.first_face, use.name);
    }
    for (const ObjFile::Use& use : obj.smoothing) {
      all += fmt::format("smooth {} {}\n", use.first_face, use.name);
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
      faces + "usemtl blue\n#@\nusemtl red\nmtllib a b\nwhat 1\ns 1\nv 1 1 0 1 .5 0\nvt 1 1\n" +
      faces +
      "s 2\n#@\\\n#@\r\nv 2 2 2\np 1\nother 1\nl 1\nf \\\n 1 \\\n 2 \\\n 5\n#@\nusemtl new\n" +
      faces;
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

TEST_CASE("texture coordinates part vertices, and are read if a corner has them") {
  const std::string uvs = "vt 0 0\nvt 1 0.25\nvt 0.5\n";
  const Mesh mesh = Read(kTriangle + uvs + "f 1/1 2/2 3/3\nf 1/2 3/3 2/2\n");
  CHECK(mesh.positions.size() == 4);
  CHECK(mesh.uvs == std::vector<Vec2d>{{0, 0}, {1, 0.25}, {0.5, 0}, {1, 0.25}});
  CHECK(mesh.triangles == std::vector<uint32_t>{0, 1, 2, 3, 2, 1});
  // Others have (0, 0).
  const Mesh some = Read(kTriangle + uvs + "f 1/2 2/2 3/3\nf 1 3/2 2/9\n");
  CHECK(some.uvs == std::vector<Vec2d>{{1, 0.25}, {1, 0.25}, {0.5, 0}, {0, 0}, {1, 0.25}, {0, 0}});
  CHECK(Read(kTriangle + uvs + "f 1 2 3\n").uvs.empty());
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
  CHECK(mesh.triangles == std::vector<uint32_t>{0, 1, 2, 3, 4, 5});
  CHECK(mesh.positions[4] == Vec3d(0, 1, 0));
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

TEST_CASE("corners without a normal get the average of the faces, the others keep theirs") {
  const Mesh mesh = Read(kTriangle + "v 0 0 1\nvn 1 0 0\nf 1//1 2//1 3\nf 1 4 2\n");
  const Vec3d x(1, 0, 0), z(0, 0, 1), y(0, 1, 0);
  REQUIRE(mesh.triangles == std::vector<uint32_t>{0, 1, 2, 3, 4, 5});
  CHECK(mesh.normals[0] == x);
  CHECK(mesh.normals[1] == x);
  CHECK(mesh.normals[2] == z);
  CHECK((mesh.normals[3] - (y + z).normalized()).length() < 1e-15);
  CHECK(mesh.normals[4] == y);
  // Only where there is one, and not if others are asked for.
  CHECK(Read(kTriangle + "vn 1 0 0\nf 1 2 3\n").normals.empty());
}

// The normal of corner `corner` of the file's triangles.
Vec3d NormalAt(const Mesh& mesh, size_t corner) { return mesh.normals.at(mesh.triangles[corner]); }

TEST_CASE("normals are averages within smoothing groups") {
  // A roof: two rectangles that meet at x = 0, 60 degrees apart, the right one narrower.
  const std::string roof =
      "v -2 0 0\nv 0 0 1.1547005383792517\nv 0 1 1.1547005383792517\nv -2 1 0\n"
      "v 1 0 .57735026918962573\nv 1 1 .57735026918962573\n";
  const std::string left = "f 1 2 3 4\n", right = "f 2 5 6 3\n";
  const Vec3d up(0, 0, 1), l(-0.5, 0, std::sqrt(0.75)), r(0.5, 0, std::sqrt(0.75));
  // Of a file's two faces: the normals at the ridge, left and right of it.
  const auto check = [&](const std::string& text, const Vec3d& at_left, const Vec3d& at_right) {
    INFO(text);
    const Mesh mesh = Read(roof + text);
    REQUIRE(mesh.triangles.size() == 12);
    REQUIRE(mesh.normals.size() == mesh.positions.size());
    CHECK((NormalAt(mesh, 1) - at_left).length() < 1e-15);
    CHECK((NormalAt(mesh, 6) - at_right).length() < 1e-15);
    CHECK((NormalAt(mesh, 0) - l).length() < 1e-15);
    CHECK((NormalAt(mesh, 7) - r).length() < 1e-15);
  };
  for (const char* const group : {"s 1", "s 7", "S 1 # all", "s 4294967296", "s", "s on"}) {
    check(group + ("\n" + left) + right, up, up);
  }
  for (const char* const off : {"s off", "s 0", "s OFF", "s 00", "s none", "s null"}) {
    check(off + ("\n" + left) + right, l, r);
    check("s 1\n" + left + off + "\n" + right, l, r);
  }
  check("s 1\n" + left + "s 2\n" + right, l, r);
  check("s 1\n" + left + "s 01\n" + right, up, up);  // the same number
  check("s 01\n" + left + "s 10\n" + right, l, r);
  check("s 1\n" + left + "s 2\ns 1\n" + right, up, up);
  check("s 1\ng a\n" + left + "g b\nusemtl c\n" + right, up, up);
  check(left + "s 1\n" + right, l, r);  // off before the first
  // A face with normals of its own counts for others, and keeps them.
  const Mesh mixed = Read(roof + "vn 0 1 0\ns 1\nf 1//1 2//1 3//1 4//1\n" + right);
  CHECK(NormalAt(mixed, 1) == Vec3d(0, 1, 0));
  CHECK((NormalAt(mixed, 6) - up).length() < 1e-15);
  // Where the file says nothing there are none, and so where others are asked for.
  CHECK(Read(roof + left + right).normals.empty());
  const ModelFolder folder;
  const auto path = folder.Write("roof.obj", roof + "s 1\n" + left + right);
  CHECK(ReadObj(path, {.complete_normals = false}).normals.empty());
  CHECK(ReadObj(path).normals.size() == 6);
}

// An L of two rectangles, 1 by 1 and 1 by 2, whose inner corner has 270 degrees, and a wall that
// stands in it: the weights are angles, of polygons and not of the triangles they are cut into.
TEST_CASE("faces count by their angle, concave ones too") {
  const Mesh mesh = Read(
      "v 0 0 0\nv 2 0 0\nv 2 1 0\nv 1 1 0\nv 1 2 0\nv 0 2 0\nv 2 1 1\nv 1 1 1\ns 1\n"
      "f 1 2 3 4 5 6\nf 4 3 7 8\n");
  const Vec3d expected = (Vec3d(0, 0, 1) * 270 + Vec3d(0, -1, 0) * 90).normalized();
  const auto inner = std::find(mesh.positions.begin(), mesh.positions.end(), Vec3d(1, 1, 0));
  const auto vertex = static_cast<size_t>(inner - mesh.positions.begin());
  CHECK((mesh.normals.at(vertex) - expected).length() < 1e-15);
}

// A vertex of a polygon that is not flat has the polygon's normal where it is faceted.
TEST_CASE("a faceted polygon has one normal") {
  const Mesh mesh = Read("v 0 0 0\nv 1 0 0\nv 1 1 1\nv 0 1 0\ns off\nf 1 2 3 4\n");
  REQUIRE(mesh.normals.size() == 4);
  for (const Vec3d& normal : mesh.normals) CHECK(normal == mesh.normals[0]);
  CHECK((mesh.normals[0] - Vec3d(-1, -1, 2).normalized()).length() < 1e-15);
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
  CHECK(Refused(kTriangle + "f a b c\n", ".obj:4: \"a\" is no index"));
  CHECK(Refused(kTriangle + "f 1 2\n", "has no faces"));
  CHECK(Refused("v 0 0\n", ".obj:1: \"\" is not a finite number"));
  CHECK(Refused(kTriangle + "v 0 x 0\n", ".obj:4: \"x\" is not a finite number"));
  CHECK(Refused(kTriangle + "v 0 1e999 0\n", "\"1e999\" is not a finite number"));
  CHECK(Refused(kTriangle + "vn 0 1,5 0\n", "\"1,5\" is not a finite number"));
  CHECK(Refused(kTriangle + "vt\n",
                ".obj:4: \"\" is not a finite number\n  hint: \"vt\" is followed by one"));
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
  CHECK(Read(kTriangle + "vn 1 0 0\nf 1//0 2//1 3//1\n").normals ==
        std::vector<Vec3d>{{0, 0, 1}, {1, 0, 0}, {1, 0, 0}});
  CHECK(Read(kTriangle + "vt 1 1\nf 1/0 2/1 3/1\n").uvs ==
        std::vector<Vec2d>{{0, 0}, {1, 1}, {1, 1}});
  CHECK(Read(kTriangle + "vn 0 0 1\nf 1/0/1 2/0/1 3/0/1\n").normals.size() == 3);
}

TEST_CASE("tags are not read: nobody makes room for two thousand million of them") {
  CHECK(Read(kTriangle + " t x 2000000000/2000000000/2000000000\nf 1 2 3\n").positions.size() == 3);
}

TEST_CASE("faces of many corners are cut, those that would take minutes refused") {
  const auto star = [](int corners) {
    std::string text, face = "f";
    for (int i = 0; i < corners; ++i) {
      const double angle = 6.283185307179586 * i / corners, radius = i % 2 == 0 ? 2 : 1;
      text += fmt::format("v {} {} 0\n", radius * std::cos(angle), radius * std::sin(angle));
      face += fmt::format(" {}", i + 1);
    }
    return text + face;
  };
  for (const int corners : {256, 300, 5000}) {
    const Mesh mesh = Read(star(corners));
    REQUIRE(mesh.triangles.size() == 3 * (static_cast<size_t>(corners) - 2));
    double area = 0;
    for (size_t i = 0; i < mesh.triangles.size(); i += 3) {
      const Vec3d& a = mesh.positions[mesh.triangles[i]];
      const double twice = (mesh.positions[mesh.triangles[i + 1]] - a)
                               .cross(mesh.positions[mesh.triangles[i + 2]] - a)
                               .z;
      CHECK(twice >= 0);  // none is turned over
      area += twice / 2;
    }
    // As many triangles between radii of 1 and 2.
    CHECK(area == Approx(corners * std::sin(6.283185307179586 / corners)).epsilon(1e-9));
  }
  std::string face = "f";
  for (int i = 0; i < 32'768; ++i) face += i % 3 == 0 ? " 1" : i % 3 == 1 ? " 2" : " 3";
  CHECK(Refused(kTriangle + face, "more than 32767 corners"));
  face = "\nf";
  for (int i = 0; i < 16'384; ++i) face += i % 3 == 0 ? " 1" : i % 3 == 1 ? " 2" : " 3";
  CHECK(Refused(kTriangle + face + face + face + face + face, "up to 16384 corners take too long"));
}

// What other readers put up with, and how it is told.
TEST_CASE("what an OBJ file has too much or too little is left out, with one warning") {
  const auto warnings = [](const std::string& text) {
    const std::string all = AllOf(kTriangle + text);
    INFO(all);
    CHECK(all.find("face 3\n") != std::string::npos);
    return all.substr(0, all.find("v 0 0 0"));
  };
  const std::string good = "f 1 2 3\n";
  CHECK(warnings(good + "f 1//1 2//2 3//3\nf 1//1 2//2 3//3\n") ==
        "normals that the file does not have are taken for none, the first in line 5\n");
  CHECK(warnings("f 1/1 2/2 3/3\n") ==
        "texture coordinates that the file does not have are taken for none, the first in line "
        "4\n");
  CHECK(warnings("vt 0 0\nf 1/1 2/2 3/-2\n") ==
        "texture coordinates that the file does not have are taken for none, the first in line "
        "5\n");
  CHECK(warnings("f 1 2\nf 1\nf\n" + good) ==
        "faces of fewer than three corners are left out, the first in line 4\n");
  CHECK(warnings("vn nan 0 1\nf 1//1 2//1 3//1\n") ==
        "normals that are no numbers are taken for none, the first in line 4\n");
  CHECK(warnings("vt 0 -1.#IND\nf 1/1 2/1 3/1\n") ==
        "texture coordinates that are no numbers are taken for 0, the first in line 4\n");
  for (const char* const none : {"nan", "-NaN", "inf", "-Infinity", "1.#QNAN", "-1.#IND00",
                                 "+1.#INF", "nan(ind)", "-nan(0x8000000000000)"}) {
    CAPTURE(none);
    const std::string text = fmt::format("v {} 0 0\nf 1 2 4\nf 3 2 1\n", none);
    CHECK(warnings(text) ==
          "faces with a position that is no number are left out, and such "
          "positions, the first in line 4\n");
    CHECK(Read(kTriangle + text).triangles == std::vector<uint32_t>{0, 1, 2});
  }
  CHECK(Read(kTriangle + "vn nan 0 1\nvn 0 0 1\nf 1//1 2//2 3//2\n").normals.size() == 3);
}

}  // namespace
}  // namespace nacre
