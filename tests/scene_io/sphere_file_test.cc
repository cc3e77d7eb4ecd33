// SPDX-License-Identifier: Apache-2.0
// Files of spheres, good and bad: .csv, .npy and .ply say the same, and what is wrong is told by
// line.
#include "scene_io/sphere_file.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <random>

#include <fmt/format.h>

#include "catch.h"
#include "messages.h"
#include "scene/hash.h"
#include "scene_io/gltf_builder.h"
#include "scene_io/live_scene.h"

namespace nacre {
namespace {

constexpr const char* kAll = R"("radius": 2, "material": "grey", "materials": ["red", "grey"])";

std::string SceneWithFile(const std::string& file, const std::string& members) {
  return R"({"nacre": 1, "materials": {"grey": {"model": "lambert"}, "red": {"model": "phong"}}, )"
         R"("shapes": [{"type": "spheres", "file": ")" +
         file + "\"" + (members.empty() ? "" : ", " + members) + "}]}";
}

std::vector<Sphere> SpheresOf(const std::string& file, const std::string& bytes,
                              const std::string& members = kAll, const LoadOptions& options = {}) {
  const ModelFolder folder;
  folder.Write(file, bytes);
  return LoadSceneText(SceneWithFile(file, members), "scene.json", folder.path, options).spheres;
}

bool RefusesTable(const std::string& bytes, const std::string& part,
                  const std::string& members = kAll, const std::string& file = "a.csv") {
  return Tells(ErrorOf([&] { SpheresOf(file, bytes, members); }), part);
}

bool Is(const Sphere& sphere, const Vec3d& center, double radius, uint32_t material) {
  return sphere.center == center && sphere.radius == radius && sphere.material.index == material;
}

// "'<f4'", "False", "(2, 5)" and the bytes that follow.
std::string Npy(const std::string& type, const std::string& fortran, const std::string& shape,
                const std::string& bytes, char version = 1) {
  const std::string header = fmt::format(
      "{{'descr': {}, 'fortran_order': {}, 'shape': {}, }}          \n", type, fortran, shape);
  std::string file = "\x93NUMPY" + std::string(1, version) + '\0';
  file += static_cast<char>(header.size());
  file += std::string(version == 1 ? 1 : 3, '\0');
  return file + header + bytes;
}

template <typename T>
std::string NumberBytes(const std::vector<double>& numbers, bool big) {
  std::string bytes;
  for (const double number : numbers) {
    const auto value = static_cast<T>(number);
    std::array<char, sizeof(T)> raw;
    std::memcpy(raw.data(), &value, sizeof(T));
    if (big) std::reverse(raw.begin(), raw.end());
    bytes.append(raw.data(), raw.size());
  }
  return bytes;
}

TEST_CASE("tables of spheres are read however they are written") {
  const auto is_right = [](const std::string& text) {
    const std::vector<Sphere> spheres = SpheresOf("a.csv", text);
    CAPTURE(text);
    REQUIRE(spheres.size() == 2);
    return Is(spheres[0], {1, 2, 3}, 0.5, 1) && Is(spheres[1], {-4, 5e3, 0.25}, 2, 0);
  };
  CHECK(is_right("1,2,3,0.5,red\n-4,5e3,.25,,\n"));
  CHECK(is_right("1,2,3,0.5,0\n-4,5e3,.25,2,1"));
  CHECK(is_right(
      "\xef\xbb\xbf\n# made by hand\n \r\n1 ; +2 ; 3. ; .5 ; \"red\"\r\n-4;5000;.25;;grey\r\n"));
  CHECK(is_right("1 2 3 0.5 0\n  -4\t5e3   .25 2 1 \n"));
  CHECK(is_right("1\t2\t3\t0.5\tred\n-4\t5e3\t.25\t\t\n"));
  CHECK(is_right("material,Y,x,id,z,RADIUS\nred,2,1,17,3,.5\n,5e3,-4,abc,.25,\n"));
  CHECK(SpheresOf("a.csv", "1,2,3").size() == 1);
}

TEST_CASE("lines of any blanks in a table of spheres are empty") {
  for (const std::string& blank :
       std::vector<std::string>{"\v", "\f", " \t\v\f\r", "\v# of a comment"}) {
    for (const char* before : {"", "x y z radius material\n"}) {
      const std::string row = "1 2 3 .5 0\n";
      const std::vector<Sphere> spheres =
          SpheresOf("a.csv", blank + '\n' + before + row + blank + '\n' + row + blank);
      REQUIRE(spheres.size() == 2);
      CHECK((Is(spheres[0], {1, 2, 3}, 0.5, 1) && Is(spheres[1], {1, 2, 3}, 0.5, 1)));
    }
    CHECK(RefusesTable(blank, "a.csv: has no rows"));
  }
}

TEST_CASE("matrices of NumPy are read in both orders and sizes") {
  const std::vector<double> rows = {1, 2, 3, 0.5, 0, -4, 5e3, 0.25, 2, 1};
  const std::vector<double> columns = {1, -4, 2, 5e3, 3, 0.25, 0.5, 2, 0, 1};
  const auto is_right = [](const std::string& bytes) {
    const std::vector<Sphere> spheres = SpheresOf("a.npy", bytes);
    REQUIRE(spheres.size() == 2);
    return Is(spheres[0], {1, 2, 3}, 0.5, 1) && Is(spheres[1], {-4, 5e3, 0.25}, 2, 0);
  };
  CHECK(is_right(Npy("'<f4'", "False", "(2, 5)", NumberBytes<float>(rows, false))));
  CHECK(is_right(Npy("'>f4'", "False", "(2,5,)", NumberBytes<float>(rows, true), 2)));
  CHECK(is_right(Npy("'=f8'", "False", "( 2 , 5 )", NumberBytes<double>(rows, false), 3)));
  CHECK(is_right(Npy("'<f8'", "True", "(2, 5)", NumberBytes<double>(columns, false))));
  CHECK(is_right(Npy("'>f8'", "True", "(2, 5)", NumberBytes<double>(columns, true))));
  const std::string points = Npy("'<f8'", "False", "(1, 3)", NumberBytes<double>({7, 8, 9}, false));
  CHECK(Is(SpheresOf("a.npy", points).at(0), {7, 8, 9}, 2, 0));
}

TEST_CASE("vertices of a PLY file are spheres") {
  const std::string head =
      "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty double y\n"
      "property float z\n";
  const std::vector<Sphere> spheres =
      SpheresOf("a.ply", head +
                             "property uchar material\nproperty float radius\nend_header\n"
                             "1 2 3 0 0.5\n-4 5e3 .25 1 2\n");
  REQUIRE(spheres.size() == 2);
  CHECK(Is(spheres[0], {1, 2, 3}, 0.5, 1));
  CHECK(Is(spheres[1], {-4, 5e3, 0.25}, 2, 0));
  CHECK(Is(SpheresOf("a.ply", head + "end_header\n1 2 3\n4 5 6\n").at(1), {4, 5, 6}, 2, 0));
  CHECK(RefusesTable(head + "property float radius\nend_header\n1 2 3 1\n1 2 3 0\n",
                     "a.ply: vertex 1: the radius 0 is out of range", kAll, "a.ply"));
  CHECK(RefusesTable(head + "element face 1\nproperty list uchar int vertex_indices\nend_header\n"
                            "0 0 0\n1 0 0\n3 0 1 0\n",
                     "has faces", kAll, "a.ply"));
}

TEST_CASE("what is wrong with a table of spheres is told with its line") {
  CHECK(RefusesTable("", "a.csv: has no rows"));
  CHECK(RefusesTable("x,y,z\n# nothing\n", "a.csv: has no rows"));
  CHECK(RefusesTable("1,2\n", "a.csv:1: has 2 columns"));
  CHECK(RefusesTable("1,2,3,4,5,6\n", "a.csv:1: has 6 columns"));
  CHECK(RefusesTable("1,2,3\n\n#\n1,2\n", "a.csv:4: has 2 columns\n  hint: the first row has 3"));
  CHECK(RefusesTable("x,y,radius\n", "a.csv:1: names no column \"z\""));
  CHECK(RefusesTable("x,y,z,x\n", "a.csv:1: names two columns \"x\""));
  CHECK(RefusesTable("x,y,z,Raduis\n1,2,3,4\n",
                     "a.csv:1: unknown column \"Raduis\"\n  hint: did you mean \"radius\"?"));
  CHECK(RefusesTable("1,2,three\n", "a.csv:1: \"three\" is not a number"));
  CHECK(RefusesTable("1,,3\n", "a.csv:1: \"\" is not a number"));
  CHECK(RefusesTable("1,2,nan\n", "a.csv:1: \"nan\" is not a number"));
  CHECK(RefusesTable("1,2,3\n1,2,1e16\n", "a.csv:2: [1, 2, 1e+16] is out of range"));
  CHECK(RefusesTable("1,2,3,-1\n", "a.csv:1: the radius -1 is out of range"));
  CHECK(RefusesTable("1,2,3,1,2\n", "a.csv:1: has material 2\n  hint: \"materials\" has 2"));
  CHECK(RefusesTable("1,2,3,1,-1\n", "a.csv:1: has material -1"));
  CHECK(RefusesTable("1,2,3,1,0.5\n", "a.csv:1: has material 0.5"));
  CHECK(RefusesTable("1,2,3,1,rod\n",
                     "a.csv:1: unknown material \"rod\"\n  hint: did you mean \"red\"?"));
  CHECK(RefusesTable("1,2,3,1,1\n", "has materials by number", R"("material": "red")"));
  CHECK(RefusesTable("1,2,3,1,\n", "a.csv:1: has no material", ""));
  CHECK(RefusesTable("1,2,3,1\n", "a.csv: has no materials", ""));
  CHECK(RefusesTable("1,2,3,,red\n", "a.csv:1: has no radius", ""));
  CHECK(RefusesTable("1,2,3\n", "a.csv: has no radii", R"("material": "red")"));
  CHECK(RefusesTable("1,2,3\n", "unknown key \"raduis\"",
                     R"("raduis": 1, "radius": 1, "material": "red")"));
  CHECK(RefusesTable(std::string("1,2,3\n\0", 7), "a.csv:2: is not text"));
  CHECK(
      RefusesTable("\xff\xfe"
                   "1",
                   "UTF-16"));
  CHECK(RefusesTable(std::string(5000, ','), "has more than 1000 columns"));
  CHECK(RefusesTable("1,2,3\n", "is no table of spheres", kAll, "a.txt"));
}

TEST_CASE("what is wrong with a matrix of NumPy is told") {
  const std::string numbers(24, '\0');
  const auto refused = [&](const std::string& bytes, const std::string& part) {
    return RefusesTable(bytes, "a.npy: " + part, kAll, "a.npy");
  };
  CHECK(refused("", "is not a NumPy file"));
  CHECK(refused("\x93NUMPY", "is not a NumPy file"));
  CHECK(refused("\x93NUMPY\x04" + numbers, "is of an unknown version"));
  CHECK(refused("\x93NUMPY\x01\x02\xff\x10", "ends in its header"));
  CHECK(refused(std::string("\x93NUMPY\x02\0\xff\xff\xff\xff", 12) + numbers, "has too long"));
  CHECK(refused(Npy("'<i4'", "False", "(2, 3)", numbers), "its numbers are \"<i4\""));
  CHECK(refused(Npy("'|f4'", "False", "(2, 3)", numbers), "its numbers are"));
  CHECK(refused(Npy("[('x', '<f4')]", "False", "(2,)", numbers), "its rows are records"));
  CHECK(refused(Npy("'<f4", "False", "(2, 3)", numbers), "its numbers are"));
  CHECK(refused(Npy("'<f4'", "0", "(2, 3)", numbers), "its 'fortran_order' is neither"));
  CHECK(refused(Npy("'<f4'", "False", "(6,)", numbers), "its array has not two dimensions"));
  CHECK(refused(Npy("'<f4'", "False", "(1, 2, 3)", numbers), "its array has not two dimensions"));
  CHECK(refused(Npy("'<f4'", "False", "(-2, 3)", numbers), "its array has not two dimensions"));
  CHECK(refused(Npy("'<f4'", "False", "(3, 2)", numbers), "has 2 columns"));
  CHECK(refused(Npy("'<f4'", "False", "(1, 6)", numbers), "has 6 columns"));
  CHECK(refused(Npy("'<f4'", "False", "(3, 3)", numbers), "its 3 rows are not 24 bytes"));
  CHECK(refused(Npy("'<f4'", "False", "(6148914691236517206, 3)", numbers), "its 61489146912365"));
  CHECK(refused(Npy("'<f4'", "False", "(99999999999999999999, 3)", numbers), "its array has not"));
  CHECK(refused(Npy("'<f4'", "False", "(0, 3)", ""), "has no rows"));
  CHECK(refused(Npy("'<f4'", "False", "(1, 3)", NumberBytes<float>({1, NAN, 2}, false)),
                "row 0: [1, nan, 2] is out of range"));
  std::string text = Npy("'<f4'", "False", "(2, 3)", numbers);
  text.replace(text.find("descr"), 5, "desk:");
  CHECK(refused(text, "its header has no 'descr'"));
}

TEST_CASE("files of spheres have no more rows than may be made") {
  LoadOptions options{.max_primitives = 2};
  CHECK(SpheresOf("a.csv", "1,2,3\n4,5,6\n", kAll, options).size() == 2);
  const auto refused = [&](const std::string& file, const std::string& bytes) {
    return Tells(ErrorOf([&] { SpheresOf(file, bytes, kAll, options); }),
                 "more than 2 spheres and triangles");
  };
  CHECK(refused("a.csv", "1,2,3\n4,5,6\n7,8,9\n"));
  CHECK(refused("a.npy", Npy("'<f4'", "False", "(3, 3)", std::string(36, '\0'))));
}

TEST_CASE("spoilt files of spheres are never worse than refused") {
  std::mt19937 random(3);
  const std::vector<std::pair<std::string, std::string>> files = {
      {"a.csv", "x,y,z,radius,material\n1,2,3,.5,red\n4,5,6,,1\n"},
      {"a.npy", Npy("'<f8'", "True", "(2, 3)", NumberBytes<double>({1, 2, 3, 4, 5, 6}, false))}};
  const ModelFolder folder;
  for (int i = 0; i < 2000; ++i) {
    auto [name, bytes] = files[random() % files.size()];
    for (int k = 0; k < 2; ++k) {
      bytes[random() % bytes.size()] = static_cast<char>(random());
      if (random() % 8 == 0) bytes.resize(1 + random() % bytes.size());
    }
    folder.Write(name, bytes);
    try {
      LoadSceneText(SceneWithFile(name, kAll), "scene.json", folder.path);
    } catch (const Error& error) {
      REQUIRE(error.code() == ExitCode::kBadInput);
    }
  }
}

TEST_CASE("a file of spheres that has changed is read again with its shapes") {
  const ModelFolder folder;
  folder.Write("a.csv", "1,2,3\n");
  LiveScene live(SceneWithFile("a.csv", kAll), "scene.json", folder.path, {});
  REQUIRE(live.scene().spheres.size() == 1);
  folder.Write("a.csv", "1,2,3\n4,5,6\n");
  CHECK(live.Set("/shapes/0/radius", "3").parts.Has(ScenePart::kShapes));
  REQUIRE(live.scene().spheres.size() == 2);
  CHECK(Is(live.scene().spheres[1], {4, 5, 6}, 3, 0));
  CHECK(ErrorOf([&] { live.Set("/shapes/0/file", "\"b.csv\""); }).find("there is no file") !=
        std::string::npos);
  CHECK(live.scene().spheres.size() == 2);
}

}  // namespace
}  // namespace nacre
