// SPDX-License-Identifier: Apache-2.0
// tests/scene_io/hostile_test.cc: files that ask for more than anybody wants, and are told so.
#include <filesystem>
#include <fstream>
#include <functional>
#include <string>

#include <fmt/format.h>
#include <unistd.h>

#include "base/error.h"
#include "catch.h"
#include "messages.h"
#include "scene_io/flat_png.h"
#include "scene_io/gltf_builder.h"
#include "scene_io/load_scene.h"
#include "scene_io/text_file.h"
#include "scene_io/texture_image.h"

namespace nacre {
namespace {

struct HostileFolder {
  std::filesystem::path path =
      std::filesystem::temp_directory_path() / ("nacre_hostile_test_" + std::to_string(getpid()));
  HostileFolder() { std::filesystem::create_directories(path); }
  ~HostileFolder() { std::filesystem::remove_all(path); }
  std::filesystem::path Write(const std::string& name, const std::string& bytes) const {
    std::ofstream(path / name, std::ios::binary) << bytes;
    return path / name;
  }
};

// What is said of a scene with these shapes when it may have `max` spheres and triangles.
std::string MessageOfShapes(const std::string& shapes, uint64_t max,
                            const std::string& lights = "{}") {
  const HostileFolder folder;
  folder.Write("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  folder.Write("a.ppm", "P6\n1 1\n255\nabc");
  LoadOptions options{.max_primitives = max};
  return ErrorOf([&] {
    LoadSceneText(fmt::format(R"({{"nacre": 1, "materials": {{"a": {{"model": "lambert"}}}},
                                  "textures": {{"t": {{"file": "a.ppm"}}}},
                                  "lights": {}, "shapes": [{}]}})",
                              lights, shapes),
                  "test.json", folder.path, options);
  });
}

// One shape is allowed, and the second one is one too many.
TEST_CASE("what a file is made into has a bound, whatever it is made of") {
  struct Case {
    std::string shape;
    uint64_t count;
  };
  const Case cases[] = {
      {R"({"type": "sphere", "center": [0, 0, 0], "radius": 1, "material": "a"})", 1},
      {R"({"type": "cloud", "count": 50, "min": [0, 0, 0], "max": [1, 1, 1], "radius": 1,
           "materials": ["a"]})",
       50},
      {R"({"type": "grid", "material": "a", "rows": {"count": 2}, "columns": {"count": 3}})",
       6 * 16},
      {R"({"type": "pair", "a": {"material": "a", "count": 3}, "b": {"material": "a", "count": 3}})",
       6 * 16},
      {R"({"type": "icosphere", "center": [0, 0, 0], "radius": 1, "material": "a",
           "subdivisions": 2})",
       320},
      {R"({"type": "uv_sphere", "center": [0, 0, 0], "radius": 1, "material": "a",
           "segments": 8, "rings": 4})",
       64},
      {R"({"type": "mesh", "file": "a.obj", "material": "a"})", 1},
      {R"({"type": "sphere", "center": [0, 0, 0], "radius": 1, "material": "a",
           "displacement": {"texture": "t", "segments": 8}})",
       64},
  };
  for (const auto& [shape, count] : cases) {
    CAPTURE(shape);
    const std::string two = fmt::format("{},{}", shape, shape);
    CHECK(MessageOfShapes(two, 2 * count) == "no error");
    const std::string message = MessageOfShapes(two, 2 * count - 1);
    CHECK(Contains(message, "test.json: /shapes/1"));
    CHECK(Contains(message, fmt::format("the scene would have more than {} spheres and triangles",
                                        2 * count - 1)));
  }
}

TEST_CASE("lights made of triangles count, too") {
  const std::string lights = R"({"m": {"type": "mesh", "radiance": 1, "icosphere":
      {"center": [0, 0, 0], "radius": 1, "subdivisions": 1}}})";
  CHECK(MessageOfShapes("", 80, lights) == "no error");
  CHECK(Contains(MessageOfShapes("", 79, lights), "more than 79 spheres and triangles"));
}

TEST_CASE("a second environment's picture is not even read") {
  const std::string sky = R"({"type": "environment", "image": "none.exr"})";
  const std::string message =
      MessageOfShapes("", 100, fmt::format(R"({{"a": {}, "b": {}}})", sky, sky));
  CHECK(Contains(message, "/lights/a/image: there is no file"));
  CHECK(Contains(message, "/lights/b/image: a second environment"));
}

TEST_CASE("all textures of a scene share one bound") {
  const HostileFolder folder;
  const auto path = folder.Write("a.ppm", "P6\n4 2\n255\n" + std::string(24, 'x'));
  const auto read_after = [&](uint64_t file_bytes, uint64_t before, int64_t width, int64_t height) {
    return ErrorOf([&] {
      TexelBudget budget(file_bytes, before);
      if (width > 0) budget.Spend("first", width, height, 1);
      ReadTextureImage(path, "a", {}, &budget);
    });
  };
  // 2^30 values in all, those of images that were there before included.
  const uint64_t gibi = uint64_t{1} << 30;
  CHECK(read_after(gibi, gibi - 24, 0, 0) == "no error");
  CHECK(Contains(read_after(gibi, gibi - 23, 0, 0), "4 x 2 texels are too many for a texture"));
  // 2^27, and 64 for each byte of the files.
  CHECK(read_after(0, 0, (1 << 13) - 24, 1 << 14) == "no error");
  CHECK(Contains(read_after(0, 0, 1 << 13, 1 << 14), "too many for textures of files of 0 bytes"));
  CHECK(Contains(read_after(0, 0, 1 << 13, 1 << 14), "less compression"));
  CHECK(read_after(1, 0, 1 << 13, 1 << 14) == "no error");
  // Each file counts once.
  TexelBudget budget(0);
  budget.Spend("first", 1 << 13, 1 << 14, 1);
  for (int i = 0; i < 3; ++i) budget.AddFile(path);
  const int64_t allowed = 64 * static_cast<int64_t>(std::filesystem::file_size(path));
  CHECK_THROWS_AS(budget.Spend("second", allowed + 1, 1, 1), Error);
  CHECK_NOTHROW(budget.Spend("second", allowed, 1, 1));
  CHECK_THROWS_AS(TexelBudget(gibi).Spend("a", 65537, 1, 1), Error);
}

TEST_CASE("the images of a scene or a model share the bound of its bytes") {
  const HostileFolder folder;
  folder.Write("flat.png", FlatPng());
  folder.Write("large.png", LargePng());
  folder.Write("m.mtl", "newmtl m\nmap_Ke flat.png\nmap_Kd large.png\n");
  const auto obj = folder.Write(
      "m.obj", "mtllib m.mtl\nusemtl m\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nf 1/1 2/1 3/1\n");
  const std::string too_many = "16384 x 7936 texels are too many for textures of files of ";
  // Of an OBJ the image is left out, as one that cannot be read is.
  std::vector<std::string> warnings;
  LoadOptions options;
  options.on_warning = [&](const std::string& text) { warnings.push_back(text); };
  LoadScene(obj, options);
  REQUIRE(warnings.size() == 1);
  CHECK(Contains(warnings[0], "an image is left out"));
  CHECK(Contains(warnings[0], too_many));
  // Images of roughness and metallic that differ in size make no texture, and are not decoded
  // again: 20 times would be over 2^27 values.
  std::string mtl;
  for (int i = 0; i < 20; ++i) mtl += "newmtl m\nmap_Pr flat.png\nmap_Pm a.ppm\n";
  folder.Write("a.ppm", "P6\n1 1\n255\nabc");
  folder.Write("m.mtl", mtl);
  CHECK(ErrorOf([&] { LoadScene(obj); }) == "no error");
  const auto scene = folder.Write("s.json", R"({"nacre": 1,
      "textures": {"flat": {"file": "flat.png"}, "large": {"file": "large.png"}},
      "materials": {"a": {"model": "lambert", "albedo_map": "flat", "emission_map": "large"}}})");
  CHECK(Contains(ErrorOf([&] { LoadScene(scene); }), too_many));
  GltfFile gltf = MakeSquare();
  gltf.json["images"] = {{{"uri", "flat.png"}}, {{"uri", "large.png"}}};
  gltf.json["textures"] = {{{"source", 0}}, {{"source", 1}}};
  gltf.json["materials"] = {{{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 1}}}}},
                             {"emissiveTexture", {{"index", 0}}}}};
  const auto glb = folder.Write("m.glb", gltf.Binary());
  const std::string message = ErrorOf([&] { LoadScene(glb); });
  CHECK(Contains(message, "/images/1: " + too_many));
  // The way out is not another format.
  CHECK(Contains(message, "less compression"));
  CHECK_FALSE(Contains(message, "PNG or JPEG"));
}

// Edit distances of these would take hours; a test that never ends would be seen.
TEST_CASE("slips are looked for in short names, and for faults that are told") {
  const std::string mega_a(1'000'000, 'a'), mega_b = mega_a + 'b';
  const std::string sphere = fmt::format(
      R"({{"type": "sphere", "center": [0, 0, 0], "radius": 1, "material": "{}"}})", mega_b);
  const std::string message = ErrorOf([&] {
    LoadSceneText(fmt::format(R"({{"nacre": 1, "materials": {{"{}": {{"model": "lambert"}}}},
                                  "shapes": [{}]}})",
                              mega_a, sphere),
                  "test.json", {});
  });
  CHECK(Contains(message, "unknown material"));
  std::string materials = R"("m": {"model": "lambert"})", shapes = "{}";
  for (int i = 0; i < 20'000; ++i) {
    materials += fmt::format(R"(, "m{}": {{"model": "lambert"}})", i);
    shapes += R"(, {"type": "sphere", "center": [0, 0, 0], "radius": 1, "material": "n"})";
  }
  const std::string many = ErrorOf([&] {
    LoadSceneText(
        fmt::format(R"({{"nacre": 1, "materials": {{{}}}, "shapes": [{}]}})", materials, shapes),
        "test.json", {});
  });
  CHECK(Contains(many, "did you mean \"m\"?"));
  CHECK(Contains(many, "more faults"));
}

TEST_CASE("a material library is read once, however often a file names it") {
  const HostileFolder folder;
  std::string mtl = "newmtl a\nKd 1 1 1\n", obj;
  for (int i = 0; i < 20'000; ++i) mtl += "# a comment that takes its time\n";
  for (int i = 0; i < 20'000; ++i) obj += "mtllib a.mtl\n";
  folder.Write("a.mtl", mtl);
  const Scene scene =
      LoadScene(folder.Write("a.obj", obj + "usemtl a\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"));
  CHECK(scene.materials.size() == 2);  // with the one of faces without any
}

TEST_CASE("numbers of OBJ and MTL that no double holds are told") {
  const HostileFolder folder;
  const std::string faces = "v 1 0 0\nv 0 1 0\nvw 0 1 1e2147483649\nf 1 2 3\n";
  folder.Write("a.mtl", "newmtl a\nTf 1e2147483649\nNi 1e-2147483649\n");
  folder.Write("d.mtl", "newmtl a\nPr 1e2147483649\n");
  folder.Write("b.mtl", "newmtl b\nmap_Kd -o 1e2147483649 x.png\n");
  folder.Write("c.mtl", "newmtl c\nmap_Kd -s 2 2 1.5 3d picture.png\n");
  const auto message = [&](const std::string& first) {
    const auto path = folder.Write("a.obj", first + "\nv 0 0 0\n" + faces);
    return ErrorOf([&] { LoadScene(path); });
  };
  CHECK(message("mtllib a.mtl") == "no error");
  CHECK(Contains(message("mtllib d.mtl"), "d.mtl:2: \"1e2147483649\" is not a finite number"));
  CHECK(Contains(message("v 0 0 0 1e2147483649 1 1"), "a.obj:1: \"1e2147483649\" is not"));
  CHECK(Contains(message("mtllib b.mtl"), "b.mtl:2: \"1e2147483649\" is not a finite number"));
  CHECK(message("mtllib c.mtl") == "no error");
}

TEST_CASE("--set reaches as deep as a file does, and no deeper") {
  const auto set = [](const std::string& pointer, const std::string& value) {
    LoadOptions options;
    options.overrides.emplace_back(pointer, value);
    return ErrorOf([&] { LoadSceneText(R"({"nacre": 1})", "test.json", {}, options); },
                   ExitCode::kUsage);
  };
  std::string deep;
  for (int i = 0; i < 100'000; ++i) deep += "/a";
  CHECK(Contains(set(deep, "1"), "is deeper than 100 levels"));
  CHECK(Contains(set("/a", std::string(100'000, '[')), "is not JSON"));
}

TEST_CASE("names of files end where they end") {
  using namespace std::string_literals;
  const HostileFolder folder;
  folder.Write("a.obj", "");
  std::filesystem::create_directory(folder.path / "scene");
  for (const std::string& name : {"a\0b"s, "../a.obj\0"s, "\0"s}) {
    CHECK(Contains(ErrorOf([&] { ResolveReference(folder.path / "scene", name, {}); }),
                   "has a character 0 in it"));
  }
  CHECK(Contains(ErrorOf([&] { ResolveReference(folder.path, std::string(5000, 'x'), {}); }),
                 "is not a path"));
}

}  // namespace
}  // namespace nacre
