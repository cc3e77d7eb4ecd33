// SPDX-License-Identifier: Apache-2.0
// tests/scene_io/textures_test.cc: textures of scene files, from images written here (PPM, which
// OpenImageIO reads).
#include <filesystem>
#include <fstream>
#include <limits>
#include <string>
#include <vector>

#include <unistd.h>

#include "base/error.h"
#include "catch.h"
#include "color/transfer.h"
#include "messages.h"
#include "scene/hash.h"
#include "scene/validate.h"
#include "scene_io/load_scene.h"
#include "scene_io/texture_image.h"

namespace nacre {
namespace {

// A folder of its own that is gone afterwards.
class Folder {
 public:
  Folder()
      : path_(std::filesystem::temp_directory_path() /
              ("nacre_textures_" + std::to_string(::getpid()))) {
    std::filesystem::create_directories(path_);
  }
  ~Folder() { std::filesystem::remove_all(path_); }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  const std::filesystem::path& path() const { return path_; }

  // `kind` is 6 for colours and 5 for greys.
  void WritePnm(const std::string& name, int kind, int width, int height,
                const std::vector<uint8_t>& bytes, int most = 255) const {
    std::ofstream file(path_ / name, std::ios::binary);
    file << 'P' << kind << '\n' << width << ' ' << height << '\n' << most << '\n';
    file.write(reinterpret_cast<const char*>(bytes.data()),
               static_cast<std::streamsize>(bytes.size()));
  }

 private:
  std::filesystem::path path_;
};

Scene Load(const Folder& folder, const std::string& textures, const std::string& material) {
  return LoadSceneText(R"({"nacre": 1, "textures": )" + textures + R"(, "materials": {"m": )" +
                           material + R"(}, "shapes": [
      {"type": "sphere", "center": [0, 0, 0], "radius": 1, "material": "m"}]})",
                       "t.json", folder.path());
}

TEST_CASE("an 8-bit image decodes exactly, row 0 at the bottom") {
  const Folder folder;
  // 2x2: the upper row first.
  folder.WritePnm("a.ppm", 6, 2, 2, {0, 1, 2, 10, 11, 12, 100, 128, 255, 253, 254, 255});
  TexelBudget budget(0);
  const SceneImage srgb = ReadTextureImage(folder.path() / "a.ppm", "a.ppm", {}, &budget);
  const SceneImage linear =
      ReadTextureImage(folder.path() / "a.ppm", "a.ppm",
                       {.encoding = TextureEncoding::kLinear, .part = {}}, &budget);
  REQUIRE(srgb.texels->channels == 3);
  REQUIRE(srgb.texels->levels.size() == 2);
  CHECK(srgb.texels->Value(0, 0, 0, 1) == static_cast<float>(SrgbEotf(128 / 255.0)));
  CHECK(srgb.texels->Value(0, 1, 1, 0) == static_cast<float>(SrgbEotf(10 / 255.0)));
  CHECK(srgb.texels->Value(0, 1, 0, 2) == 1);
  CHECK(linear.texels->Value(0, 0, 0, 0) == static_cast<float>(100 / 255.0));
  CHECK(linear.middle == 128.0f / 255);
}

TEST_CASE("a texture is decoded by its use, or as it says") {
  const Folder folder;
  folder.WritePnm("a.ppm", 6, 1, 1, {188, 100, 50});
  const double srgb = double{static_cast<float>(SrgbEotf(100 / 255.0))};
  const double linear = double{static_cast<float>(100 / 255.0)};
  const auto green = [](const Scene& scene, TextureId id) {
    REQUIRE(id.index < scene.textures.size());
    const Texture& texture = scene.textures[id.index];
    return double{scene.images[texture.image.index].texels->Value(0, 0, 0, 1)};
  };
  const std::string material = R"({"model": "metallic_roughness", "base_color_map": "a",
                                   "metallic_roughness_map": "a", "normal_map": "a"})";
  const Scene scene = Load(folder, R"({"a": {"file": "a.ppm"}})", material);
  const auto& model = std::get<MetallicRoughnessMaterial>(scene.materials[0].model);
  CHECK(green(scene, model.base_color_map) == srgb);
  CHECK(green(scene, model.metallic_roughness_map) == linear);
  CHECK(scene.materials[0].normal_map.texture == model.metallic_roughness_map);
  CHECK(scene.images.size() == 2);

  const Scene raw = Load(folder, R"({"a": {"file": "a.ppm", "encoding": "linear"}})", material);
  CHECK(green(raw, std::get<MetallicRoughnessMaterial>(raw.materials[0].model).base_color_map) ==
        linear);
  CHECK(raw.images.size() == 1);
}

// Bytes without a pattern.
std::vector<uint8_t> Noise(size_t count) {
  std::vector<uint8_t> bytes(count);
  uint32_t state = 1;
  for (uint8_t& byte : bytes)
    byte = static_cast<uint8_t>((state = state * 1664525 + 1013904223) >> 24);
  return bytes;
}

TEST_CASE("textures are the same however many threads decode them") {
  const Folder folder;
  // More than one piece of each loop over texels, an odd size, and a grey image.
  folder.WritePnm("a.ppm", 6, 512, 256, Noise(3 * 512 * 256));
  folder.WritePnm("b.ppm", 6, 333, 301, Noise(3 * 333 * 301));
  folder.WritePnm("c.pgm", 5, 640, 480, Noise(640 * 480));
  const std::string textures = R"({"a": {"file": "a.ppm"}, "b": {"file": "b.ppm"},
                                   "c": {"file": "c.pgm", "encoding": "linear"}})";
  const std::string material = R"({"model": "metallic_roughness", "base_color_map": "a",
      "normal_map": {"texture": "b", "scale": 2}, "emission_map": "b", "opacity_map": "c"})";
  const auto load = [&](int threads, const std::string& maps) {
    LoadOptions options{.threads = threads};
    return LoadSceneText(
        R"({"nacre": 1, "textures": )" + textures + R"(, "materials": {"m": )" + maps + "}}",
        "t.json", folder.path(), options);
  };
  const Scene one = load(1, material), two = load(2, material);
  REQUIRE(one.images.size() == 4);  // b as colours and as numbers
  REQUIRE(two.images.size() == 4);
  for (size_t i = 0; i < 4; ++i) {
    CAPTURE(i);
    CHECK(one.images[i].file == two.images[i].file);
    CHECK(one.images[i].middle == two.images[i].middle);
    const TexelView first = one.images[i].texels->Level(0), second = two.images[i].texels->Level(0);
    REQUIRE(first.size() == second.size());
    for (size_t k = 0; k < first.size(); ++k) REQUIRE(first[k] == second[k]);
  }
  // Faults are those of the first map, whoever meets one first.
  folder.WritePnm("b.ppm", 6, 333, 301, Noise(100));
  folder.WritePnm("c.pgm", 5, 640, 480, Noise(100));
  const auto error_of = [&](int threads) -> std::string {
    try {
      load(threads, material);
    } catch (const Error& error) {
      return error.what();
    }
    return {};
  };
  CHECK(error_of(1).find("b.ppm") != std::string::npos);
  CHECK(error_of(1) == error_of(2));
}

TEST_CASE("texels take no more memory than their file's samples") {
  const Folder folder;
  const auto read = [&](const std::filesystem::path& path, const TextureReading& reading) {
    TexelBudget budget(0);
    return ReadTextureImage(path, "file", reading, &budget).texels;
  };
  const TextureReading srgb, linear{.encoding = TextureEncoding::kLinear, .part = {}},
      alpha{.encoding = TextureEncoding::kAlpha, .part = {}},
      gloss{.encoding = TextureEncoding::kLinear, .glossiness = 0.7, .part = {}};
  std::vector<uint8_t> all(256);
  for (size_t i = 0; i < all.size(); ++i) all[i] = static_cast<uint8_t>(i);
  folder.WritePnm("bytes.pgm", 5, 16, 16, all);
  folder.WritePnm("bytes.ppm", 6, 16, 16, Noise(3 * 256));
  folder.WritePnm("words.pgm", 5, 16, 16, Noise(2 * 256), 65535);
  for (const TextureReading& reading : {srgb, linear, gloss}) {
    CHECK(read(folder.path() / "bytes.pgm", reading)->ImageBytes() == 256 + 3);
    CHECK(read(folder.path() / "bytes.ppm", reading)->ImageBytes() == 3 * 256 + 3);
    CHECK(read(folder.path() / "words.pgm", reading)->ImageBytes() == 2 * 256 + 3);
  }
  CHECK(read(folder.path() / "bytes.ppm", alpha)->ImageBytes() == 256 + 3);  // opaque
  // Halves.
  const auto sky =
      read(std::filesystem::path(NACRE_SOURCE_DIR) / "scenes/textures/evening.exr", srgb);
  CHECK(sky->ImageBytes() == 2 * sky->Level(0).size() + 3);

  // To the bit what each code stands for, computed in double; row 0 is the file's last.
  const auto at = [](const std::shared_ptr<const MipChain>& texels, int i) {
    return texels->Value(0, i % 16, 15 - i / 16, 0);
  };
  const auto as_srgb = read(folder.path() / "bytes.pgm", srgb);
  const auto as_linear = read(folder.path() / "bytes.pgm", linear);
  const auto as_gloss = read(folder.path() / "bytes.pgm", gloss);
  const auto words = Noise(2 * 256);
  const auto of_words = read(folder.path() / "words.pgm", srgb);
  for (int i = 0; i < 256; ++i) {
    REQUIRE(at(as_srgb, i) == static_cast<float>(SrgbEotf(i / 255.0)));
    REQUIRE(at(as_linear, i) == static_cast<float>(i / 255.0));
    REQUIRE(at(as_gloss, i) == 1 - 0.7f * static_cast<float>(i / 255.0));
    const auto byte = [&](int k) { return int{words[static_cast<size_t>(2 * i + k)]}; };
    REQUIRE(at(of_words, i) == static_cast<float>(SrgbEotf((256 * byte(0) + byte(1)) / 65535.0)));
  }
}

TEST_CASE("a texture's settings are read") {
  const Folder folder;
  folder.WritePnm("a.pgm", 5, 2, 1, {7, 9});
  const Scene scene = Load(folder, R"({"a": {"file": "a.pgm", "filter": "bilinear",
      "wrap_u": "mirror", "scale": [2, 3], "rotate_deg": 90, "offset": 0.5,
      "mapping": {"kind": "cylindrical", "axis": [1, 0, 0], "rotate_deg": 30, "size": 4}}})",
                           R"({"model": "phong", "shininess_map": "a", "bump_map":
      {"texture": "a", "distance": 0.25}})");
  REQUIRE(scene.textures.size() == 1);
  const Texture& texture = scene.textures[0];
  CHECK(texture.sampling.filter == TextureFilter::kBilinear);
  CHECK(texture.sampling.wrap_u == Wrap::kMirror);
  CHECK(texture.sampling.wrap_v == Wrap::kClamp);  // of a cylinder
  CHECK(texture.mapping == MappingKind::kCylindrical);
  CHECK(texture.axis == Vec3d(1, 0, 0));
  CHECK(texture.rotate_deg == 30);
  CHECK(texture.size == 4);
  CHECK(texture.scale == Vec2d(2, 3));
  CHECK(texture.uv_rotate_deg == 90);
  CHECK(texture.offset == Vec2d(0.5, 0.5));
  CHECK(scene.images[0].texels->channels == 1);
  CHECK(scene.materials[0].bump_map.distance == 0.25);
}

TEST_CASE("the contents of an image are part of the scene's hash, its name is not") {
  const Folder folder;
  folder.WritePnm("a.pgm", 5, 2, 1, {7, 9});
  folder.WritePnm("same.pgm", 5, 2, 1, {7, 9});
  folder.WritePnm("other.pgm", 5, 2, 1, {7, 10});
  const auto hash = [&](const std::string& file) {
    return HashScene(Load(folder, R"({"a": {"file": ")" + file + R"("}})",
                          R"({"model": "lambert", "albedo_map": "a"})"));
  };
  CHECK(hash("a.pgm") == hash("same.pgm"));
  CHECK(hash("a.pgm") != hash("other.pgm"));
}

TEST_CASE("a grey image holds metallic and roughness alike, and no normals") {
  const Folder folder;
  folder.WritePnm("a.pgm", 5, 1, 1, {128});
  const std::string textures = R"({"a": {"file": "a.pgm"}})";
  const Scene scene =
      Load(folder, textures, R"({"model": "metallic_roughness", "metallic_roughness_map": "a"})");
  CHECK(scene.images.at(0).texels->channels == 1);  // look-ups repeat the last channel
  for (const std::string map : {"normal_map", "coat_normal_map"}) {
    for (const std::string value : {R"("a")", R"({"texture": "a", "scale": 0.5})"}) {
      CAPTURE(map, value);
      const std::string message = ErrorOf([&] {
        Load(folder, textures, R"({"model": "metallic_roughness", ")" + map + "\": " + value + "}");
      });
      Tells(message, "/materials/m/" + map + ": \"a.pgm\" is grey, and holds no normals");
      Tells(message, "bump_map");
    }
  }
}

TEST_CASE("an opacity map without alpha says what it is, and its holes are for meshes") {
  const Folder folder;
  folder.WritePnm("mask.pgm", 5, 2, 1, {0, 255});
  const auto load = [&](const std::string& texture, const std::string& shape) {
    return LoadSceneText(R"({"nacre": 1, "textures": {"t": {"file": "mask.pgm")" + texture +
                             R"(}}, "materials": {"m": {"model": "lambert", "opacity": 0.75,
      "opacity_cutoff": 0.25, "opacity_map": "t"}}, "shapes": [{"type": ")" +
                             shape + R"(", "center": [0, 0, 0], "radius": 1, "material": "m"}]})",
                         "t.json", folder.path());
  };
  const Scene scene = load(R"(, "encoding": "linear")", "uv_sphere");
  const Material& material = scene.materials.at(0);
  CHECK(material.opacity == 0.75);
  CHECK(material.opacity_cutoff == 0.25);
  REQUIRE(material.opacity_map.valid());
  CHECK(scene.images.at(0).texels->Level(0)[1] == 1);
  const auto fault = [&](const std::string& texture, const std::string& shape) -> std::string {
    try {
      load(texture, shape);
    } catch (const Error& error) {
      return error.faults().front().what;
    }
    return {};
  };
  CHECK(fault("", "uv_sphere").find("has no alpha") != std::string::npos);
  CHECK(fault(R"(, "encoding": "linear")", "sphere").find("holes") != std::string::npos);
}

TEST_CASE("a mesh without texture coordinates needs a mapping") {
  Scene scene;
  scene.images.push_back({"a", std::make_shared<MipChain>(MakeMipChain(1, 1, 1, {0.5f})), 0.5f});
  scene.textures.emplace_back().image = ImageId{0};
  Material material{.model = LambertMaterial{.albedo_map = TextureId{0}}};
  scene.materials.push_back(material);
  Mesh mesh{.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}},
            .triangles = {0, 1, 2},
            .material = MaterialId{0}};
  scene.meshes = {mesh};
  REQUIRE(Validate(scene).size() == 1);
  CHECK(Validate(scene)[0].where == "/meshes/0");
  scene.meshes[0].uvs = {{0, 0}, {1, 0}, {0, 1}};
  CHECK(Validate(scene).empty());
  scene.meshes[0].uvs.pop_back();
  CHECK(Validate(scene).size() == 1);
  scene.meshes[0].uvs = {{0, 0}, {1, 0}, {0, std::numeric_limits<double>::infinity()}};
  CHECK(Validate(scene).size() == 1);
  scene.meshes[0].uvs.clear();
  scene.textures[0].mapping = MappingKind::kPlanar;
  CHECK(Validate(scene).empty());
  scene.textures[0].image = ImageId{7};
  CHECK(Validate(scene).size() == 1);
}

}  // namespace
}  // namespace nacre
