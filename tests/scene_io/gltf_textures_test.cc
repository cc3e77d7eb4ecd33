// SPDX-License-Identifier: Apache-2.0
// The textures of glTF files: images inside and beside them, samplers, transforms.
#include <algorithm>
#include <cmath>
#include <vector>

#include "base/error.h"
#include "catch.h"
#include "image_io/png_bytes.h"
#include "messages.h"
#include "scene/texture_mapping.h"
#include "scene_io/gltf_builder.h"

namespace nacre {
namespace {

// A PNG file of 2 x 2 texels: red and green above blue and white.
const std::vector<unsigned char> kPng = {
    137, 80,  78,  71,  13,  10,  26,  10,  0,   0,   0,   13,  73,  72,  68,  82, 0,  0,  0,
    2,   0,   0,   0,   2,   8,   2,   0,   0,   0,   253, 212, 154, 115, 0,   0,  0,  18, 73,
    68,  65,  84,  120, 218, 99,  248, 207, 192, 192, 0,   194, 12,  255, 129, 0,  0,  31, 238,
    5,   251, 241, 171, 186, 119, 0,   0,   0,   0,   73,  69,  78,  68,  174, 66, 96, 130};

// The same as a lossless WebP file.
const std::vector<unsigned char> kWebp = {
    82, 73,  70, 70,  44,  0,  0,   0,  87,  69, 66, 80,  86,  80, 56,  76,  31, 0,
    0,  0,   47, 1,   64,  0,  0,   31, 32,  16, 72, 222, 31,  58, 141, 249, 23, 16,
    20, 252, 31, 221, 252, 71, 100, 15, 224, 6,  12, 17,  253, 15, 1,   0};

// The same with the alphas 1 and 0 above 51/255 and 128/255.
const std::vector<unsigned char> kPngWithAlpha = {
    137, 80,  78,  71,  13,  10,  26,  10,  0,  0,   0,   13,  73,  72,  68,  82,  0,   0,  0,  2,
    0,   0,   0,   2,   8,   6,   0,   0,   0,  114, 182, 13,  36,  0,   0,   0,   22,  73, 68, 65,
    84,  120, 218, 99,  248, 207, 192, 240, 31, 8,   65,  224, 191, 241, 255, 255, 255, 27, 0,  59,
    87,  7,   173, 204, 109, 246, 251, 0,   0,  0,   0,   73,  69,  78,  68,  174, 66,  96, 130};

// The square with texture coordinates, and a material that the base colour's texture belongs to.
GltfFile MakeTexturedSquare(const std::vector<unsigned char>& png = kPng) {
  GltfFile file = MakeSquare();
  const size_t offset = file.Append(png);
  file.json["bufferViews"].push_back(
      {{"buffer", 0}, {"byteOffset", offset}, {"byteLength", png.size()}});
  const size_t view = file.json["bufferViews"].size() - 1;
  file.json["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_0"] =
      file.Accessor(std::vector<float>{0, 1, 1, 1, 1, 0, 0, 0}, 5126, "VEC2", 2);
  file.json["meshes"][0]["primitives"][0]["material"] = 0;
  file.json["images"] = {{{"bufferView", view}, {"mimeType", "image/png"}}};
  file.json["textures"] = {{{"source", 0}}};
  file.json["materials"] = {{{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}}};
  return file;
}

const MetallicRoughnessMaterial& MaterialOf(const Scene& scene) {
  return std::get<MetallicRoughnessMaterial>(scene.materials.at(0).model);
}

bool Mentions(const std::vector<std::string>& warnings, const std::string& what) {
  return std::any_of(warnings.begin(), warnings.end(), [&](const std::string& warning) {
    return warning.find(what) != std::string::npos;
  });
}

TEST_CASE("a texture's image may be WebP, where the extension alone names it") {
  GltfFile file = MakeTexturedSquare(kWebp);
  file.json["images"][0]["mimeType"] = "image/webp";
  file.json["extensionsRequired"] = {"EXT_texture_webp"};
  Json& texture = file.json["textures"][0];
  texture = {{"extensions", {{"EXT_texture_webp", {{"source", 0}}}}}};
  const auto texels_of = [](const GltfFile& of) {
    std::vector<std::string> warnings;
    const Scene scene = LoadFile(of, &warnings);
    CHECK(warnings.empty());
    std::vector<float> values(12);
    scene.images.at(0).texels->Level(0).Read(0, values);
    return values;
  };
  CHECK(texels_of(file) == texels_of(MakeTexturedSquare()));
  // The core's is for programs that do not read WebP.
  file.json["images"].push_back({{"uri", "missing.png"}});
  texture["source"] = 1;
  CHECK(texels_of(file) == texels_of(MakeTexturedSquare()));
  texture["extensions"]["EXT_texture_webp"]["source"] = 7;
  CHECK_THROWS_AS(LoadFile(file), Error);
  texture["extensions"]["EXT_texture_webp"]["source"] = "a";
  CHECK_THROWS_AS(LoadFile(file), Error);
}

TEST_CASE("an image inside the file") {
  std::vector<std::string> warnings;
  const Scene scene = LoadFile(MakeTexturedSquare(), &warnings);
  CHECK(warnings.empty());
  REQUIRE(scene.images.size() == 1);
  const MipChain& texels = *scene.images[0].texels;
  CHECK(texels.levels.at(0).width == 2);
  CHECK(texels.levels.at(0).height == 2);
  // Rows from the bottom, decoded from sRGB: blue first.
  std::vector<float> values(12);
  texels.Level(0).Read(0, values);
  CHECK(values == std::vector<float>{0, 0, 1, 1, 1, 1, 1, 0, 0, 0, 1, 0});
  REQUIRE(scene.textures.size() == 1);
  CHECK(MaterialOf(scene).base_color_map == TextureId{0});
  CHECK(scene.textures[0].sampling.filter == TextureFilter::kTrilinear);
  CHECK(scene.textures[0].sampling.wrap_u == Wrap::kRepeat);
  // The square's first corner is the image's lower left.
  CHECK(scene.meshes.at(0).uvs.at(0) == Vec2d(0, 0));
}

TEST_CASE("an image beside the file, for two uses of two encodings") {
  const ModelFolder folder;
  GltfFile file = MakeTexturedSquare();
  folder.Write("a b.png", std::string(kPng.begin(), kPng.end()));
  file.json["images"] = {{{"uri", "a%20b.png"}}};
  file.json["materials"][0]["emissiveTexture"] = {{"index", 0}};
  file.json["materials"][0]["emissiveFactor"] = {1, 1, 1};
  file.json["materials"][0]["normalTexture"] = {{"index", 0}, {"scale", 0.5}};
  const Scene scene = LoadScene(folder.Write("model.glb", file.Binary()));
  CHECK(scene.images.size() == 2);
  CHECK(scene.textures.size() == 3);
  const Material& material = scene.materials.at(0);
  CHECK(material.normal_map.scale == 0.5);
  const auto image_of = [&](TextureId id) { return scene.textures.at(id.index).image; };
  CHECK(image_of(material.emission_map) == image_of(MaterialOf(scene).base_color_map));
  CHECK(image_of(material.normal_map.texture) != image_of(material.emission_map));
}

TEST_CASE("--set puts a texture of its own in the place of the file's") {
  const ModelFolder folder;
  folder.Write("mine.png", std::string(kPng.begin(), kPng.end()));
  GltfFile plain = MakeTexturedSquare();
  plain.json["materials"][0]["pbrMetallicRoughness"] = Json::object();
  plain.json["materials"][0]["name"] = "m";
  LoadOptions options{
      .overrides = {{"/textures/mine", R"({"file": "mine.png", "filter": "nearest"})"},
                    {"/materials/m/base_color_map", R"("mine")"}}};
  const auto path = folder.Write("model.glb", plain.Binary());
  CHECK_FALSE(MaterialOf(LoadScene(path)).base_color_map.valid());
  const Scene scene = LoadScene(path, options);
  const TextureId map = MaterialOf(scene).base_color_map;
  REQUIRE(map.index < scene.textures.size());
  CHECK(scene.textures[map.index].name == "mine");
  CHECK(scene.textures[map.index].sampling.filter == TextureFilter::kNearest);
  CHECK(scene.meshes.at(0).uvs.size() == scene.meshes[0].positions.size());
  options.overrides[1].second = R"("yours")";
  CHECK_THROWS_AS(LoadScene(path, options), Error);
}

TEST_CASE("samplers and transforms") {
  GltfFile file = MakeTexturedSquare();
  file.json["samplers"] = {{{"magFilter", 9728}, {"wrapS", 33071}, {"wrapT", 33648}}};
  file.json["textures"][0]["sampler"] = 0;
  file.json["extensionsUsed"] = {"KHR_texture_transform"};
  file.json["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"]["extensions"] = {
      {"KHR_texture_transform", {{"offset", {0.25, -0.5}}, {"rotation", 0.3}, {"scale", {2, 3}}}}};
  const Scene scene = LoadFile(file);
  const Texture& texture = scene.textures.at(0);
  CHECK(texture.sampling.filter == TextureFilter::kNearest);
  CHECK(texture.sampling.wrap_u == Wrap::kClamp);
  CHECK(texture.sampling.wrap_v == Wrap::kMirror);
  // The extension's matrices translation x rotation x scale, on (u, v) with v down.
  for (const Vec2d& uv : {Vec2d(0, 0), Vec2d(1, 0), Vec2d(0.3, 0.8)}) {
    const double u = 2 * uv.x, v = 3 * uv.y;
    const Vec2d expected(0.25 + std::cos(0.3) * u + std::sin(0.3) * v,
                         -0.5 - std::sin(0.3) * u + std::cos(0.3) * v);
    const Vec2d got = TransformOf(texture).Apply(Vec2d(uv.x, 1 - uv.y));
    CHECK(std::abs(got.x - expected.x) < 1e-12);
    CHECK(std::abs(1 - got.y - expected.y) < 1e-12);
  }
}

// The message of the one fault that the file is refused for, from its pointer on.
std::string MessageOfTextures(const GltfFile& file) {
  const std::string message = ErrorOf([&] { LoadFile(file); });
  const std::string file_name = "model.glb: ";
  const size_t found = message.find(file_name);
  return found == std::string::npos ? message : message.substr(found + file_name.size());
}

TEST_CASE("transforms out of range are refused in the file's own words") {
  const auto fault = [](const char* transform) {
    GltfFile file = MakeTexturedSquare();
    file.json["materials"][0]["extensions"]["KHR_materials_clearcoat"] = {
        {"clearcoatFactor", 1},
        {"clearcoatTexture",
         {{"index", 0}, {"extensions", {{"KHR_texture_transform", Json::parse(transform)}}}}}};
    return MessageOfTextures(file);
  };
  const std::string place =
      "/materials/0/extensions/KHR_materials_clearcoat/clearcoatTexture/extensions/"
      "KHR_texture_transform/";
  CHECK(fault(R"({"scale": [1e30, 1e30]})") == place +
                                                   "scale: [1e+30, 1e+30] is out of range\n"
                                                   "  hint: each number from -1000000 to 1000000");
  CHECK(fault(R"({"rotation": 1e30})") ==
        place + "rotation: 1e+30 is out of range\n  hint: radians, 100 turns at most");
  CHECK(fault(R"({"rotation": -629})").starts_with(place + "rotation: -629 is out of range\n"));
  CHECK(fault(R"({"offset": [0, -2e6]})").starts_with(place + "offset: [0, -2000000] is out of"));
  // What the scale adds: 1 - 1e6 - 1e6.
  CHECK(fault(R"({"offset": [0, 1e6], "scale": [1, 1e6]})").starts_with(place + "offset: "));
  CHECK(fault(R"({"texCoord": -1})").starts_with(place + "texCoord: is not a whole number from 0"));
  CHECK(fault(R"({"offset": [5, -1e5], "scale": [1e6, 2], "rotation": 628})") == "no error");
}

TEST_CASE("references to textures are checked even where they are not followed") {
  for (const char* texture :
       {"occlusionTexture", "extensions/KHR_materials_clearcoat/clearcoatTexture",
        "extensions/KHR_materials_clearcoat/clearcoatRoughnessTexture",
        "extensions/KHR_materials_clearcoat/clearcoatNormalTexture",
        "extensions/KHR_materials_pbrSpecularGlossiness/diffuseTexture",
        "extensions/KHR_materials_pbrSpecularGlossiness/specularGlossinessTexture",
        "extensions/KHR_materials_sheen/sheenColorTexture",
        "extensions/KHR_materials_sheen/sheenRoughnessTexture",
        "extensions/KHR_materials_specular/specularTexture",
        "extensions/KHR_materials_specular/specularColorTexture"}) {
    CAPTURE(texture);
    const std::string place = std::string("/materials/0/") + texture;
    const auto fault = [&](const Json& info) {
      GltfFile file = MakeTexturedSquare();
      file.json[Json::json_pointer(place)] = info;
      return MessageOfTextures(file);
    };
    CHECK(fault({{"index", 0}}) == "no error");
    CHECK(fault({{"index", 99}}) == place + ": there is no texture 99\n  hint: the file has 1");
    CHECK(fault({{"index", -1}}).starts_with(place + "/index: is not a whole number from 0 on"));
    CHECK(fault({{"index", 0}, {"texCoord", -1}})
              .starts_with(place + "/texCoord: is not a whole number from 0 on"));
    CHECK(fault({{"texCoord", 0}}).starts_with(place + ": has no \"index\""));
    CHECK(fault(3).starts_with(place + ": is not an object"));
  }
  GltfFile unlit = MakeTexturedSquare();
  unlit.json["materials"][0]["extensions"]["KHR_materials_unlit"] = Json::object();
  unlit.json["materials"][0]["normalTexture"] = {{"index", 1}};
  CHECK(MessageOfTextures(unlit).starts_with("/materials/0/normalTexture: there is no texture 1"));
  // Of names that nothing is known of, nothing is asked.
  GltfFile other = MakeTexturedSquare();
  other.json["materials"][0]["extensions"]["EXT_a"]["aTexture"] = {{"index", 99}};
  other.json["materials"][0]["aTexture"] = "a";
  CHECK(MessageOfTextures(other) == "no error");
}

TEST_CASE("what cannot be shown is told, and the rest is shown") {
  std::vector<std::string> warnings;
  GltfFile file = MakeTexturedSquare();
  file.json["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"]["texCoord"] = 2;
  CHECK(!MaterialOf(LoadFile(file, &warnings)).base_color_map.valid());
  CHECK(Mentions(warnings, "other coordinates than TEXCOORD_0 and TEXCOORD_1"));

  warnings.clear();
  file = MakeTexturedSquare();
  file.json["meshes"][0]["primitives"][0]["attributes"].erase("TEXCOORD_0");
  const Scene scene = LoadFile(file, &warnings);
  CHECK(Mentions(warnings, "no texture coordinates"));
  CHECK(scene.meshes.at(0).uvs.size() == scene.meshes[0].positions.size());
}

TEST_CASE("textures on second coordinates") {
  GltfFile file = MakeTexturedSquare();
  Json& attributes = file.json["meshes"][0]["primitives"][0]["attributes"];
  attributes["TEXCOORD_1"] =
      file.Accessor(std::vector<float>{0.5, 1, 1, 1, 1, 0, 0, 0}, 5126, "VEC2", 2);
  CHECK(LoadFile(file).meshes.at(0).second_uvs.empty());  // nothing asks for them
  CHECK(!LoadFile(file).textures.at(0).second_uvs);
  file.json["materials"][0]["emissiveTexture"] = {{"index", 0}, {"texCoord", 1}};
  file.json["materials"][0]["emissiveFactor"] = {1, 1, 1};
  std::vector<std::string> warnings;
  const Scene scene = LoadFile(file, &warnings);
  CHECK(warnings.empty());
  CHECK(scene.meshes.at(0).second_uvs == std::vector<Vec2d>{{0.5, 0}, {1, 0}, {1, 1}, {0, 1}});
  CHECK(scene.meshes[0].uvs.at(0) == Vec2d(0, 0));
  const auto second = [&](TextureId id) { return scene.textures.at(id.index).second_uvs; };
  CHECK(second(scene.materials.at(0).emission_map));
  CHECK(!second(MaterialOf(scene).base_color_map));
  attributes.erase("TEXCOORD_1");
  CHECK(LoadFile(file, &warnings).meshes.at(0).second_uvs.empty());
  CHECK(Mentions(warnings, "a mesh without TEXCOORD_1"));
}

TEST_CASE("an index of refraction beside images, and specular colours") {
  GltfFile file = MakeTexturedSquare();
  Json& material = file.json["materials"][0];
  material["pbrMetallicRoughness"]["metallicFactor"] = 0.25;
  material["extensions"] = {{"KHR_materials_ior", {{"ior", 2.0}}},
                            {"KHR_materials_specular", {{"specularColorFactor", {1, 0.5, 12}}}}};
  std::vector<std::string> warnings;
  const Rgb f0 = MaterialOf(LoadFile(file, &warnings)).dielectric_f0;
  CHECK(warnings.empty());
  CHECK(f0.x == Approx(1.0 / 9).epsilon(1e-14));
  CHECK(f0.y == Approx(0.5 / 9).epsilon(1e-14));
  CHECK(f0.z == 1);  // no more than all
  const auto refused = [&](const char* extension, const char* member, const Json& value,
                           const std::string& where) {
    GltfFile bad = file;
    bad.json["materials"][0]["extensions"][extension][member] = value;
    try {
      LoadFile(bad);
    } catch (const Error& error) {
      return error.faults().front().where.find(where) != std::string::npos;
    }
    return false;
  };
  const char* const specular = "KHR_materials_specular";
  CHECK(refused(specular, "specularFactor", 2, "/materials/0/extensions/KHR_materials_specular/"));
  CHECK(refused(specular, "specularFactor", -0.5, "specularFactor"));
  CHECK(refused(specular, "specularColorFactor", {1, -1, 1}, "specularColorFactor"));
  const char* const glossy = "KHR_materials_pbrSpecularGlossiness";
  CHECK(refused(glossy, "specularFactor", {2, 0, 0}, "Glossiness/specularFactor"));
  CHECK(refused(glossy, "diffuseFactor", {1, -1, 0, 1}, "Glossiness/diffuseFactor"));
  CHECK(refused(glossy, "glossinessFactor", -1, "Glossiness/glossinessFactor"));
  for (const double ior : {-1.0, -0.5, 0.5}) {
    CHECK(refused("KHR_materials_ior", "ior", ior, "KHR_materials_ior/ior"));
  }
  material["extensions"]["KHR_materials_ior"]["ior"] = 1e200;
  CHECK(MaterialOf(LoadFile(file)).dielectric_f0.x == 1);
}

TEST_CASE("what a mask is cut by is in range") {
  GltfFile file = MakeTexturedSquare();
  Json& material = file.json["materials"][0];
  material["alphaMode"] = "MASK";
  const auto place = [&] {
    try {
      LoadFile(file);
    } catch (const Error& error) {
      const std::string& where = error.faults().front().where;
      return where.substr(where.find("/materials"));
    }
    return std::string();
  };
  CHECK(place().empty());
  material["alphaCutoff"] = -1;
  CHECK(place() == "/materials/0/alphaCutoff");
  material["alphaCutoff"] = 2;  // nothing is left
  CHECK(place().empty());
  material["pbrMetallicRoughness"]["baseColorFactor"] = {1, 1, 1, 1.5};
  CHECK(place() == "/materials/0/pbrMetallicRoughness/baseColorFactor/3");
  material["extensions"]["KHR_materials_pbrSpecularGlossiness"]["diffuseFactor"] = {1, 1, 1, -1};
  CHECK(place() == "/materials/0/extensions/KHR_materials_pbrSpecularGlossiness/diffuseFactor/3");
}

TEST_CASE("images of specular weights and colours") {
  GltfFile file = MakeTexturedSquare();
  // 2 x 1 texels of red, with an alpha of 51 and of 255.
  const std::vector<unsigned char> png = {
      137, 80, 78,  71, 13,  10,  26,  10, 0,   0,   0,   13,  73, 72,  68,  82, 0,  0,
      0,   2,  0,   0,  0,   1,   8,   6,  0,   0,   0,   244, 34, 127, 138, 0,  0,  0,
      15,  73, 68,  65, 84,  120, 218, 99, 248, 207, 192, 96,  12, 196, 255, 1,  13, 251,
      3,   49, 225, 16, 159, 16,  0,   0,  0,   0,   73,  69,  78, 68,  174, 66, 96, 130};
  const size_t offset = file.Append(png);
  file.json["bufferViews"].push_back(
      {{"buffer", 0}, {"byteOffset", offset}, {"byteLength", png.size()}});
  file.json["images"].push_back(
      {{"bufferView", file.json["bufferViews"].size() - 1}, {"mimeType", "image/png"}});
  file.json["textures"].push_back({{"source", 1}});
  Json& material = file.json["materials"][0];
  material["pbrMetallicRoughness"]["metallicFactor"] = 0;
  const Json moved = {{"KHR_texture_transform", {{"scale", {2, 3}}}}};
  material["extensions"]["KHR_materials_specular"] = {
      {"specularColorFactor", {1, 0.5, 0.25}},
      {"specularFactor", 0.5},
      {"specularTexture", {{"index", 1}}},
      {"specularColorTexture", {{"index", 0}, {"extensions", moved}}}};
  std::vector<std::string> warnings;
  const Scene scene = LoadFile(file, &warnings);
  CHECK(warnings.empty());
  const MetallicRoughnessMaterial& model = MaterialOf(scene);
  CHECK(model.specular == 0.5);
  REQUIRE(model.specular_map.valid());
  REQUIRE(model.specular_color_map.valid());
  const auto image_of = [&](TextureId id) { return scene.textures.at(id.index).image; };
  // The weight is alpha, never encoded.
  const MipChain& weight = *scene.images.at(image_of(model.specular_map).index).texels;
  CHECK(weight.channels == 1);
  CHECK(weight.Value(0, 0, 0, 0) == 0.2f);
  CHECK(weight.Value(0, 1, 0, 0) == 1);
  // The colour is that of the base, decoded once.
  CHECK(image_of(model.specular_color_map) == image_of(model.base_color_map));
  CHECK(scene.textures.at(model.specular_color_map.index).scale == Vec2d(2, 3));
  // Factors that reflect more than all are cut, with a warning where an image would follow.
  material["extensions"]["KHR_materials_specular"]["specularColorFactor"] = {30, 1, 1};
  CHECK(MaterialOf(LoadFile(file, &warnings)).dielectric_f0.x == 1);
  CHECK(Mentions(warnings, "are cut before their images"));
  // An image without alpha takes nothing away.
  material["extensions"]["KHR_materials_specular"]["specularTexture"]["index"] = 0;
  CHECK(!MaterialOf(LoadFile(file)).specular_map.valid());
  // Nor does any from a metal.
  material["pbrMetallicRoughness"]["metallicFactor"] = 1;
  CHECK(!MaterialOf(LoadFile(file)).specular_color_map.valid());
  material["pbrMetallicRoughness"]["metallicFactor"] = 0;
  material["extensions"]["KHR_materials_specular"]["specularTexture"] = {{"index", "none"}};
  CHECK_THROWS_AS(LoadFile(file), Error);
}

TEST_CASE("clear coats and sheen, with their images") {
  GltfFile file = MakeTexturedSquare();
  Json& extensions = file.json["materials"][0]["extensions"];
  const Json image = {{"index", 0}};
  Json normal = image;
  normal["scale"] = 0.5;
  extensions["KHR_materials_clearcoat"] = {{"clearcoatFactor", 0.75},
                                           {"clearcoatTexture", image},
                                           {"clearcoatRoughnessFactor", 0.25},
                                           {"clearcoatRoughnessTexture", image},
                                           {"clearcoatNormalTexture", normal}};
  extensions["KHR_materials_sheen"] = {{"sheenColorFactor", {0.5, 0.25, 1}},
                                       {"sheenColorTexture", image},
                                       {"sheenRoughnessFactor", 0.5},
                                       {"sheenRoughnessTexture", image}};
  std::vector<std::string> warnings;
  const Scene scene = LoadFile(file, &warnings);
  CHECK(warnings.empty());
  const MetallicRoughnessMaterial& model = MaterialOf(scene);
  CHECK(model.coat == 0.75);
  CHECK(model.coat_roughness == 0.25);
  CHECK(model.coat_ior == 1.5);
  CHECK(model.coat_normal_map.scale == 0.5);
  CHECK(model.coat_normal_map.convention == NormalMap::Convention::kLiteral);
  CHECK(model.sheen_color == Rgb(0.5, 0.25, 1));
  CHECK(model.sheen_roughness == 0.5);
  const auto image_of = [&](TextureId id) {
    REQUIRE(id.valid());
    return scene.textures.at(id.index).image;
  };
  // Numbers are numbers, colours are sRGB; an image without alpha takes nothing of the roughness.
  CHECK(image_of(model.coat_map) == image_of(model.coat_roughness_map));
  CHECK(image_of(model.coat_map) == image_of(model.coat_normal_map.texture));
  CHECK(image_of(model.sheen_color_map) == image_of(model.base_color_map));
  CHECK(image_of(model.sheen_color_map) != image_of(model.coat_map));
  CHECK(!model.sheen_roughness_map.valid());
  const auto refused = [&](const char* extension, const char* member, const Json& value) {
    GltfFile bad = file;
    bad.json["materials"][0]["extensions"][extension][member] = value;
    try {
      LoadFile(bad);
    } catch (const Error& error) {
      const std::string& where = error.faults().front().where;
      return where.find(std::string(extension) + "/" + member) != std::string::npos;
    }
    return false;
  };
  CHECK(refused("KHR_materials_clearcoat", "clearcoatFactor", 1.5));
  CHECK(refused("KHR_materials_clearcoat", "clearcoatRoughnessFactor", -1));
  CHECK(refused("KHR_materials_clearcoat", "clearcoatTexture", {{"index", "none"}}));
  CHECK(refused("KHR_materials_sheen", "sheenColorFactor", {0.5, 2, 0}));
  CHECK(refused("KHR_materials_sheen", "sheenRoughnessFactor", 7));
  // Without colour or roughness there is none, and without a coat its images are not asked for.
  extensions["KHR_materials_clearcoat"]["clearcoatFactor"] = 0;
  extensions["KHR_materials_sheen"]["sheenRoughnessFactor"] = 0;
  const MetallicRoughnessMaterial bare = MaterialOf(LoadFile(file));
  CHECK(!bare.coat_map.valid());
  CHECK(bare.sheen_color == Rgb(0));
}

TEST_CASE("anisotropy, with its image") {
  GltfFile file = MakeTexturedSquare();
  Json& extension = file.json["materials"][0]["extensions"]["KHR_materials_anisotropy"];
  extension = {{"anisotropyStrength", 0.6},
               {"anisotropyRotation", M_PI / 6},
               {"anisotropyTexture", {{"index", 0}}}};
  std::vector<std::string> warnings;
  const Scene scene = LoadFile(file, &warnings);
  CHECK(warnings.empty());
  const MetallicRoughnessMaterial& model = MaterialOf(scene);
  CHECK(model.anisotropy == 0.6);
  CHECK(std::abs(model.anisotropy_rotation_deg - 30) < 1e-13);
  REQUIRE(model.anisotropy_map.valid());
  CHECK(scene.textures.at(model.anisotropy_map.index).image !=
        scene.textures.at(model.base_color_map.index).image);  // numbers, not sRGB
  const auto refused = [&](const char* member, const Json& value) {
    GltfFile bad = file;
    bad.json["materials"][0]["extensions"]["KHR_materials_anisotropy"][member] = value;
    try {
      LoadFile(bad);
    } catch (const Error& error) {
      return error.faults().front().where.find(member) != std::string::npos;
    }
    return false;
  };
  CHECK(refused("anisotropyStrength", 1.5));
  CHECK(refused("anisotropyStrength", "much"));
  CHECK(refused("anisotropyRotation", 1e9));
  CHECK(refused("anisotropyTexture", {{"index", "none"}}));
  // Without strength nothing is turned, and no image is asked for.
  extension["anisotropyStrength"] = 0;
  const MetallicRoughnessMaterial isotropic = MaterialOf(LoadFile(file));
  CHECK(isotropic.anisotropy == 0);
  CHECK(!isotropic.anisotropy_map.valid());
}

TEST_CASE("iridescence") {
  GltfFile file = MakeTexturedSquare();
  Json& extension = file.json["materials"][0]["extensions"]["KHR_materials_iridescence"];
  extension = {{"iridescenceFactor", 0.6}, {"iridescenceThicknessMaximum", 350}};
  const MetallicRoughnessMaterial model = MaterialOf(LoadFile(file));
  CHECK(model.iridescence == 0.6);
  CHECK(model.iridescence_ior == 1.3);  // the extension's default
  CHECK(model.iridescence_thickness_nm == 350);
  CHECK(model.iridescence_model == ThinFilmForm::kGltf);
  const auto refused = [&](const char* member, const Json& value) {
    GltfFile bad = file;
    bad.json["materials"][0]["extensions"]["KHR_materials_iridescence"][member] = value;
    try {
      LoadFile(bad);
    } catch (const Error& error) {
      return error.faults().front().where.find(member) != std::string::npos;
    }
    return false;
  };
  CHECK(refused("iridescenceFactor", 1.5));
  CHECK(refused("iridescenceIor", 0.5));
  CHECK(refused("iridescenceThicknessMinimum", -1));
  CHECK(refused("iridescenceThicknessMaximum", "thick"));
  extension["iridescenceThicknessMinimum"] = 150;
  extension["iridescenceThicknessTexture"] = {{"index", 0}};
  std::vector<std::string> warnings;
  MetallicRoughnessMaterial mapped = MaterialOf(LoadFile(file, &warnings));
  CHECK(warnings.empty());
  CHECK(mapped.iridescence_thickness_map.valid());
  CHECK(!mapped.iridescence_map.valid());
  CHECK(mapped.iridescence_thickness_minimum_nm == 150);
  CHECK(mapped.iridescence_thickness_nm == 350);
  extension["iridescenceTexture"] = {{"index", 0}};
  mapped = MaterialOf(LoadFile(file, &warnings));
  CHECK(mapped.iridescence_map.valid());
  extension["iridescenceFactor"] = 0;  // no film, whatever its textures
  mapped = MaterialOf(LoadFile(file, &warnings));
  CHECK(!mapped.iridescence_map.valid());
  CHECK(!mapped.iridescence_thickness_map.valid());
}

// One row of texels as a PNG file: 8 or 16 bits a channel, of a colour type of PNG (0 grey, 2 RGB,
// 4 grey and alpha, 6 RGB and alpha).
std::vector<unsigned char> RowPng(uint8_t bits, uint8_t type, const std::vector<uint16_t>& values) {
  const size_t channels = type == 0 ? 1 : type == 2 ? 3 : type == 4 ? 2 : 4;
  std::vector<uint8_t> file =
      PngHead(static_cast<uint32_t>(values.size() / channels), 1, bits, type);
  std::vector<uint8_t> row = {0};  // no filter
  for (const uint16_t value : values) {
    if (bits == 16) row.push_back(static_cast<uint8_t>(value >> 8));
    row.push_back(static_cast<uint8_t>(value));
  }
  AppendPixels(row, &file);
  return file;
}

const MipChain& TexelsOf(const Scene& scene, TextureId id) {
  REQUIRE(id.valid());
  return *scene.images.at(scene.textures.at(id.index).image.index).texels;
}

TEST_CASE("specular-glossiness: reflectance by the texture's colour, roughness by its alpha") {
  // The colours 56 and 255, with glossinesses of 128/255 and 51/255.
  GltfFile file = MakeTexturedSquare(RowPng(8, 6, {56, 56, 255, 128, 255, 56, 56, 51}));
  const Json image = {{"index", 0}};
  const Json moved = {{"index", 0},
                      {"texCoord", 0},
                      {"extensions", {{"KHR_texture_transform", {{"scale", {2, 3}}}}}}};
  file.json["materials"] = Json::parse(R"([{}, {}])");
  Json& of_first = file.json["materials"][0]["extensions"]["KHR_materials_pbrSpecularGlossiness"];
  of_first = {{"diffuseFactor", {0.5, 0.25, 1, 1}},
              {"specularFactor", {1, 0.5, 0.25}},
              {"glossinessFactor", 0.75},
              {"diffuseTexture", image},
              {"specularGlossinessTexture", moved}};
  Json& of_second = file.json["materials"][1]["extensions"];
  of_second["KHR_materials_pbrSpecularGlossiness"] = {{"specularGlossinessTexture", image}};
  of_second["KHR_materials_clearcoat"] = {{"clearcoatFactor", 0.5}};
  of_second["KHR_materials_sheen"] = {{"sheenColorFactor", {1, 1, 1}},
                                      {"sheenRoughnessFactor", 0.5}};
  std::vector<std::string> warnings;
  const Scene scene = LoadFile(file, &warnings);
  CHECK(warnings.empty());
  const MetallicRoughnessMaterial& model = MaterialOf(scene);
  CHECK(model.metallic == 0);
  CHECK(model.base_color == Rgb(0.5, 0.25, 1));
  CHECK(model.dielectric_f0 == Rgb(1, 0.5, 0.25));
  CHECK(model.specular == 1);
  CHECK(model.roughness == 1);  // all of it is in the map
  const MipChain& f0 = TexelsOf(scene, model.specular_color_map);
  REQUIRE(f0.channels == 3);
  CHECK(f0.Value(0, 0, 0, 0) == Approx(0.0395462).epsilon(1e-5));  // sRGB's 56, to six digits
  CHECK(f0.Value(0, 0, 0, 2) == 1);
  CHECK(&f0 == &TexelsOf(scene, model.base_color_map));  // decoded once
  // 1 - 0.75 g in float, of g in float.
  const MipChain& roughness = TexelsOf(scene, model.metallic_roughness_map);
  REQUIRE(roughness.channels == 1);
  CHECK(roughness.Value(0, 0, 0, 0) == 1 - 0.75f * (128.0f / 255));
  CHECK(roughness.Value(0, 1, 0, 0) == 1 - 0.75f * (51.0f / 255));
  // The mean of roughnesses is the roughness of the mean of glossinesses.
  CHECK(roughness.Value(1, 0, 0, 0) == Approx(1 - 0.75 * (128 + 51) / 510.0).epsilon(1e-6));
  for (const TextureId id : {model.specular_color_map, model.metallic_roughness_map}) {
    CHECK(scene.textures.at(id.index).scale == Vec2d(2, 3));
  }
  CHECK(scene.textures.at(model.base_color_map.index).scale == Vec2d(1, 1));
  // Another factor is another roughness of the same image.
  const auto& other = std::get<MetallicRoughnessMaterial>(scene.materials.at(1).model);
  CHECK(TexelsOf(scene, other.metallic_roughness_map).Value(0, 0, 0, 0) == 1 - 128.0f / 255);
  CHECK(&TexelsOf(scene, other.specular_color_map) == &f0);
  CHECK(other.dielectric_f0 == Rgb(1));
  CHECK(other.coat == 0.5);
  CHECK(other.sheen_color == Rgb(1));
  // Without glossiness there is none that a texture could multiply.
  of_first["glossinessFactor"] = 0;
  const MetallicRoughnessMaterial matte = MaterialOf(LoadFile(file));
  CHECK(matte.roughness == 1);
  CHECK(!matte.metallic_roughness_map.valid());
  // Where it cannot be shown, the factors are.
  of_first["glossinessFactor"] = 0.75;
  of_first["specularGlossinessTexture"]["texCoord"] = 2;
  const MetallicRoughnessMaterial plain = MaterialOf(LoadFile(file, &warnings));
  CHECK(plain.roughness == 0.25);
  CHECK(!plain.specular_color_map.valid());
  CHECK(Mentions(warnings, "other coordinates"));
}

TEST_CASE("a grey image is one of three equal channels, whatever it is for") {
  const auto load = [](const std::vector<unsigned char>& png) {
    GltfFile file = MakeTexturedSquare(png);
    const Json image = {{"index", 0}};
    Json& material = file.json["materials"][0];
    material = {{"normalTexture", image}};
    material["pbrMetallicRoughness"]["metallicRoughnessTexture"] = image;
    material["extensions"]["KHR_materials_clearcoat"] = {{"clearcoatFactor", 1},
                                                         {"clearcoatTexture", image},
                                                         {"clearcoatRoughnessFactor", 1},
                                                         {"clearcoatRoughnessTexture", image},
                                                         {"clearcoatNormalTexture", image}};
    material["extensions"]["KHR_materials_sheen"] = {
        {"sheenColorFactor", {1, 1, 1}}, {"sheenRoughnessFactor", 1}, {"sheenColorTexture", image}};
    std::vector<std::string> warnings;
    const Scene scene = LoadFile(file, &warnings);
    CHECK(warnings.empty());
    const MetallicRoughnessMaterial& model = MaterialOf(scene);
    std::vector<float> values;
    for (const TextureId id :
         {model.metallic_roughness_map, scene.materials.at(0).normal_map.texture, model.coat_map,
          model.coat_roughness_map, model.coat_normal_map.texture, model.sheen_color_map}) {
      const MipChain& texels = TexelsOf(scene, id);
      for (int c = 0; c < 3; ++c) {  // as look-ups take channels that an image lacks
        values.push_back(texels.Value(0, 1, 0, std::min(c, texels.channels - 1)));
      }
    }
    return values;
  };
  const std::vector<float> expected = load(RowPng(8, 2, {9, 9, 9, 200, 200, 200}));
  CHECK(load(RowPng(8, 0, {9, 200})) == expected);
  CHECK(load(RowPng(8, 4, {9, 255, 200, 77})) == expected);
  CHECK(load(RowPng(8, 6, {9, 9, 9, 255, 200, 200, 200, 77})) == expected);
  // 200 / 255 in 16 bits.
  CHECK(load(RowPng(16, 0, {9 * 257, 200 * 257})) == expected);
  CHECK(load(RowPng(16, 4, {9 * 257, 65535, 200 * 257, 77})) == expected);
}

TEST_CASE("coats, sheen and emission that are known to show nothing are left out") {
  const auto load = [](const std::vector<unsigned char>& png, double factor) {
    GltfFile file = MakeTexturedSquare(png);
    const Json image = {{"index", 0}};
    Json& material = file.json["materials"][0];
    material["emissiveFactor"] = {factor, factor, factor};
    material["emissiveTexture"] = image;
    material["extensions"]["KHR_materials_clearcoat"] = {{"clearcoatFactor", factor},
                                                         {"clearcoatTexture", image},
                                                         {"clearcoatNormalTexture", image}};
    material["extensions"]["KHR_materials_sheen"] = {{"sheenColorFactor", {factor, factor, factor}},
                                                     {"sheenRoughnessFactor", 0.5},
                                                     {"sheenColorTexture", image}};
    return LoadFile(file).materials.at(0);
  };
  const Material shown = load(RowPng(8, 2, {0, 0, 0, 0, 1, 0}), 0.5);
  const auto& layers = std::get<MetallicRoughnessMaterial>(shown.model);
  CHECK((layers.coat == 0.5 && layers.coat_map.valid()));
  CHECK((layers.sheen_color == Rgb(0.5) && layers.sheen_color_map.valid()));
  CHECK((shown.emission == Rgb(0.5) && shown.emission_map.valid()));
  for (const Material& idle :
       {load(RowPng(8, 2, {0, 0, 0, 0, 0, 0}), 0.5), load(RowPng(8, 2, {1, 2, 3, 4, 5, 6}), 0)}) {
    const auto& model = std::get<MetallicRoughnessMaterial>(idle.model);
    CHECK((model.coat == 0 && !model.coat_map.valid() && !model.coat_normal_map.texture.valid()));
    CHECK((model.sheen_color == Rgb(0) && !model.sheen_color_map.valid()));
    CHECK((idle.emission == Rgb(0) && !idle.emission_map.valid()));
  }
  // What roughness leaves of sheen: the map's alpha is 0.
  GltfFile file = MakeTexturedSquare(RowPng(8, 6, {9, 9, 9, 0, 9, 9, 9, 0}));
  file.json["materials"][0]["extensions"]["KHR_materials_sheen"] = {
      {"sheenColorFactor", {1, 1, 1}},
      {"sheenRoughnessFactor", 1},
      {"sheenRoughnessTexture", {{"index", 0}}}};
  const MetallicRoughnessMaterial without_sheen = MaterialOf(LoadFile(file));
  CHECK((without_sheen.sheen_roughness == 0 && !without_sheen.sheen_roughness_map.valid()));
}

TEST_CASE("images that are not there, or are none, are refused") {
  const auto message = [](const GltfFile& file) -> std::string {
    try {
      LoadFile(file);
    } catch (const Error& error) {
      return error.faults().front().where + " " + error.faults().front().what;
    }
    return "accepted";
  };
  GltfFile file = MakeTexturedSquare();
  file.json["images"] = {{{"uri", "none.png"}}};
  CHECK(message(file).find("/images/0") != std::string::npos);
  file = MakeTexturedSquare();
  file.json["textures"][0]["source"] = 7;
  CHECK(message(file).find("there is no such image") != std::string::npos);
  file = MakeTexturedSquare();
  file.json["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"]["index"] = 3;
  CHECK(message(file).find("there is no texture 3") != std::string::npos);
  file = MakeTexturedSquare();
  const size_t start = file.bytes.find("IHDR");
  REQUIRE(start != std::string::npos);
  for (size_t i = 0; i < 30; ++i) file.bytes[start + i] = 'x';  // no PNG file any more
  CHECK(message(file).find("/images/0") != std::string::npos);
}

TEST_CASE("images that are the same bytes or file are decoded once for each encoding") {
  GltfFile file = MakeTexturedSquare();
  Json& views = file.json["bufferViews"];
  const Json view = views[file.json["images"][0]["bufferView"].get<size_t>()];
  file.json["images"] = Json::array();
  file.json["textures"] = Json::array();
  file.json["materials"] = Json::array();
  const auto add = [&](const Json& image) {
    const size_t i = file.json["images"].size();
    file.json["images"].push_back(image);
    file.json["textures"].push_back({{"source", i}});
    file.json["materials"].push_back(
        {{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", i}}}}},
         {"normalTexture", {{"index", i}}}});
  };
  for (int i = 0; i < 4; ++i) {
    add({{"bufferView", views.size()}, {"mimeType", "image/png"}});
    views.push_back(view);
  }
  CHECK(LoadFile(file).images.size() == 2);
  CHECK(LoadFile(file).textures.size() == 8);
  const ModelFolder folder;
  folder.Write("a b.png", std::string(kPng.begin(), kPng.end()));
  for (const char* uri : {"a%20b.png", "a b.png", "./a%20b.png"}) add({{"uri", uri}});
  CHECK(LoadScene(folder.Write("model.glb", file.Binary())).images.size() == 4);
}

TEST_CASE("normal textures are decoded as glTF has it, occlusion textures are told") {
  GltfFile file = MakeTexturedSquare();
  std::vector<std::string> warnings;
  file.json["materials"][0]["normalTexture"] = {{"index", 0}, {"scale", 0.5}};
  CHECK(LoadFile(file, &warnings).materials.at(0).normal_map.convention ==
        NormalMap::Convention::kLiteral);
  CHECK(warnings.empty());
  file.json["materials"][0]["occlusionTexture"] = {{"index", 0}, {"strength", 0.5}};
  file.json["materials"].push_back(file.json["materials"][0]);
  const Scene scene = LoadFile(file, &warnings);
  REQUIRE(warnings.size() == 1);
  CHECK(Mentions(warnings, "occlusion"));
  CHECK(scene.images.size() == 2);  // the base colour's and the normals'
}

TEST_CASE("an alphaMode that there is not") {
  for (const char* mode : {"blend", "ADD", ""}) {
    GltfFile file = MakeSquare();
    file.json["materials"] = {{{"alphaMode", mode}}};
    std::string message;
    try {
      LoadFile(file);
    } catch (const Error& error) {
      message = error.what();
    }
    CHECK(message.find(std::string("/materials/0/alphaMode: \"") + mode + "\" is none") !=
          std::string::npos);
  }
}

TEST_CASE("alphaMode MASK cuts holes by the base colour's alpha") {
  GltfFile file = MakeTexturedSquare(kPngWithAlpha);
  Json& material = file.json["materials"][0];
  std::vector<std::string> warnings;
  CHECK_FALSE(LoadFile(file, &warnings).materials.at(0).opacity_map.valid());  // OPAQUE
  material["alphaMode"] = "MASK";
  Scene scene = LoadFile(file, &warnings);
  CHECK(warnings.empty());
  CHECK(scene.materials.at(0).opacity == 1);
  CHECK(scene.materials[0].opacity_cutoff == 0.5);
  const TextureId map = scene.materials[0].opacity_map;
  REQUIRE(map.valid());
  const MipChain& texels = *scene.images.at(scene.textures.at(map.index).image.index).texels;
  CHECK(texels.channels == 1);
  std::vector<float> values(4);
  texels.Level(0).Read(0, values);
  CHECK(values == std::vector<float>{51.0f / 255, 128.0f / 255, 1, 0});  // from the bottom

  material["alphaCutoff"] = 0.25;
  material["pbrMetallicRoughness"]["baseColorFactor"] = {1, 1, 1, 0.75};
  scene = LoadFile(file);
  CHECK(scene.materials.at(0).opacity == 0.75);
  CHECK(scene.materials[0].opacity_cutoff == 0.25);
  material["alphaCutoff"] = 2;  // nothing is left
  CHECK(LoadFile(file).materials.at(0).opacity_cutoff == 2);
  material["extensions"] = {{"KHR_materials_unlit", Json::object()}};
  CHECK(LoadFile(file).materials.at(0).opacity_map.valid());
  material["extensions"] = {
      {"KHR_materials_pbrSpecularGlossiness",
       {{"diffuseTexture", {{"index", 0}}}, {"diffuseFactor", {1, 1, 1, 0.5}}}}};
  CHECK(LoadFile(file).materials.at(0).opacity_map.valid());
  CHECK(LoadFile(file).materials.at(0).opacity == 0.5);

  material.erase("extensions");
  material["alphaMode"] = "BLEND";
  warnings.clear();
  CHECK_FALSE(LoadFile(file, &warnings).materials.at(0).opacity_map.valid());
  CHECK(LoadFile(file).materials.at(0).opacity == 1);
  CHECK(warnings.size() == 1);
  CHECK(Mentions(warnings, "BLEND"));
}

TEST_CASE("an image without alpha cuts no holes, and the alpha of vertices does") {
  GltfFile file = MakeTexturedSquare();
  file.json["materials"][0]["alphaMode"] = "MASK";
  CHECK_FALSE(LoadFile(file).materials.at(0).opacity_map.valid());
  const std::vector<float> colors = {1, 1, 1, 0, 1, 1, 1, 0.25, 1, 1, 1, 1, 1, 1, 1, 0.5};
  file.json["meshes"][0]["primitives"][0]["attributes"]["COLOR_0"] =
      file.Accessor(colors, 5126, "VEC4", 4);
  const Scene scene = LoadFile(file);
  CHECK(scene.meshes.at(0).opacities == std::vector<float>{0, 0.25f, 1, 0.5f});
  CHECK(scene.meshes[0].colors.empty());  // all are white
  file.json["materials"][0]["alphaMode"] = "OPAQUE";
  CHECK(LoadFile(file).meshes.at(0).opacities.empty());
}

}  // namespace
}  // namespace nacre
