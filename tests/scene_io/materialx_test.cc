// SPDX-License-Identifier: Apache-2.0
// MaterialX documents: colour spaces, nodes, what is inherited and included, the three shaders, and
// what is wrong with a document. Values were computed by hand from MaterialX's definitions.
#include "scene_io/materialx.h"

#include <filesystem>
#include <fstream>
#include <functional>
#include <string>

#include <unistd.h>

#include "base/error.h"
#include "catch.h"
#include "scene_io/live_scene.h"
#include "scene_io/load_scene.h"
#include "scene_io/materialx_color.h"
#include "scene_io/materialx_value.h"
#include "scene_io/sheet_axis.h"

namespace nacre {
namespace {

// A folder of its own, gone at the end.
struct MtlxFolder {
  std::filesystem::path path =
      std::filesystem::temp_directory_path() / ("nacre_materialx_test_" + std::to_string(getpid()));
  MtlxFolder() { std::filesystem::create_directories(path / "sub"); }
  ~MtlxFolder() { std::filesystem::remove_all(path); }
  void Write(const std::string& name, const std::string& text) const {
    std::ofstream(path / name, std::ios::binary) << text;
  }
};

std::string MtlxText(const std::string& elements, const std::string& root = "") {
  return R"(<?xml version="1.0"?><materialx version="1.39" )" + root + ">\n" + elements +
         "\n</materialx>";
}

// A document of one material with this shader.
std::string OneMtlx(const std::string& shader, const std::string& inputs,
                    const std::string& nodes = "", const std::string& root = "") {
  return MtlxText(nodes + "<" + shader + R"( name="s" type="surfaceshader">)" + inputs + "</" +
                      shader + R"(><surfacematerial name="m" type="material">)" +
                      R"(<input name="surfaceshader" type="surfaceshader" nodename="s"/>)" +
                      "</surfacematerial>",
                  root);
}

std::string MtlxIn(const std::string& name, const std::string& type, const std::string& value,
                   const std::string& more = "") {
  return "<input name=\"" + name + "\" type=\"" + type + "\" value=\"" + value + "\" " + more +
         "/>";
}
std::string MtlxFrom(const std::string& name, const std::string& type, const std::string& node,
                     const std::string& more = "") {
  return "<input name=\"" + name + "\" type=\"" + type + "\" nodename=\"" + node + "\" " + more +
         "/>";
}

MaterialXMaterial ReadMtlx(const std::string& text, const std::string& name = "") {
  const MtlxFolder folder;
  folder.Write("a.mtlx", text);
  return ReadMaterialX(folder.path, "a.mtlx", name, {});
}

// The parameter of an OpenPBR material whose base colour is the node "n".
Json MtlxBaseColor(const std::string& nodes, const std::string& root = "") {
  const MaterialXMaterial material =
      ReadMtlx(OneMtlx("open_pbr_surface", MtlxFrom("base_color", "color3", "n"), nodes, root));
  return material.material.value("base_color", Json());
}
// The same of a number.
double MtlxWeight(const std::string& nodes) {
  const MaterialXMaterial material =
      ReadMtlx(OneMtlx("open_pbr_surface", MtlxFrom("specular_weight", "float", "n"), nodes));
  INFO((material.notes.empty() ? std::string() : material.notes.front()));
  CHECK(material.notes.empty());
  return material.material.value("specular_weight", 1.0);
}

bool HasMtlxNote(const MaterialXMaterial& material, const std::string& part) {
  for (const std::string& note : material.notes) {
    if (note.find(part) != std::string::npos) return true;
  }
  return false;
}

// The message of the error, which must be one of bad input with a place.
std::string MtlxRefusal(const std::function<void()>& action) {
  try {
    action();
  } catch (const Error& error) {
    CHECK(error.code() == ExitCode::kBadInput);
    CHECK(error.faults().size() == 1);
    return error.what();
  }
  return "no error";
}
std::string MtlxRefusalOf(const std::string& text) {
  return MtlxRefusal([&] { ReadMtlx(text); });
}

void CheckMtlxColor(const Json& color, double r, double g, double b, double margin = 1e-9) {
  INFO(color.dump());
  REQUIRE(color.is_array());
  CHECK(color[0].get<double>() == Approx(r).margin(margin));
  CHECK(color[1].get<double>() == Approx(g).margin(margin));
  CHECK(color[2].get<double>() == Approx(b).margin(margin));
}

std::string MtlxColorNode(const std::string& value, const std::string& more = "") {
  return "<constant name=\"n\" type=\"color3\">" + MtlxIn("value", "color3", value, more) +
         "</constant>";
}

// ---- Colour spaces ------------------------------------------------------------------------------

TEST_CASE("each colour space keeps white, and has its own red in Rec. 709") {
  const auto red = [](const char* name) {
    const MaterialXColorSpace* const space = FindMaterialXColorSpace(name);
    REQUIRE(space != nullptr);
    return ToRec709(*space, Rgb(0.5, 0, 0));
  };
  for (const std::string& name : MaterialXColorSpaceNames()) {
    INFO(name);
    const Rgb white = ToRec709(*FindMaterialXColorSpace(name), Rgb(1));
    for (int c = 0; c < 3; ++c) CHECK(white[c] == Approx(1).margin(2e-4));
  }
  // MaterialX's matrices of ACEScg, Display P3 and Adobe RGB (libraries/cmlib), column by column.
  const auto check = [&](const char* name, double scale, double r, double g, double b) {
    const Rgb color = red(name);
    INFO(name);
    CHECK(color.x == Approx(scale * r).margin(2e-4));
    CHECK(color.y == Approx(scale * g).margin(2e-4));
    CHECK(color.z == Approx(scale * b).margin(2e-4));
  };
  const double srgb = std::pow((0.5 + 0.055) / 1.055, 2.4), g22 = std::pow(0.5, 2.2);
  for (const char* name : {"acescg", "lin_ap1", "lin_ap1_scene"}) {
    check(name, 0.5, 1.705051, -0.130256, -0.024003);
  }
  check("g22_ap1", g22, 1.705051, -0.130256, -0.024003);
  check("lin_displayp3", 0.5, 1.224930, -0.042059, -0.019641);
  check("srgb_displayp3", srgb, 1.224930, -0.042059, -0.019641);
  check("lin_adobergb", 0.5, 1.398356, 0, 0);
  check("adobergb", std::pow(0.5, 563.0 / 256), 1.398356, 0, 0);
  check("lin_rec709", 0.5, 1, 0, 0);
  check("srgb_texture", srgb, 1, 0, 0);
  check("g22_rec709", g22, 1, 0, 0);
  check("g18_rec709", std::pow(0.5, 1.8), 1, 0, 0);
  check("rec709_display", std::pow(0.5, 2.4), 1, 0, 0);
  check("none", 0.5, 1, 0, 0);
  CHECK(FindMaterialXColorSpace("acess") == nullptr);
  // Curves go on below 0.
  CHECK(ToRec709(*FindMaterialXColorSpace("srgb_texture"), Rgb(-0.5, 0, 0)).x == Approx(-srgb));
}

TEST_CASE("colours have the colour space in force, numbers and vectors have none") {
  const double srgb = std::pow((0.5 + 0.055) / 1.055, 2.4);
  CheckMtlxColor(MtlxBaseColor(MtlxColorNode("0.5, 0.5, 0.5"), R"(colorspace="srgb_texture")"),
                 srgb, srgb, srgb);
  // The nearest element has it.
  CheckMtlxColor(MtlxBaseColor(MtlxColorNode("0.5, 0.5, 0.5", R"(colorspace="lin_rec709")"),
                               R"(colorspace="srgb_texture")"),
                 0.5, 0.5, 0.5);
  CheckMtlxColor(MtlxBaseColor(MtlxColorNode("0.5, 0.5, 0.5")), 0.5, 0.5, 0.5);
  CheckMtlxColor(MtlxBaseColor(R"(<convert name="n" type="color3">)" +
                                   MtlxIn("in", "vector3", "0.5, 0.25, 0") + "</convert>",
                               R"(colorspace="srgb_texture")"),
                 0.5, 0.25, 0);
  const MaterialXMaterial material =
      ReadMtlx(OneMtlx("open_pbr_surface", MtlxIn("specular_roughness", "float", "0.5"), "",
                       R"(colorspace="srgb_texture")"));
  CHECK(material.material["specular_roughness"] == 0.5);
}

TEST_CASE("a colour outside of the gamut is clamped and told, rounding is not told") {
  // Car paint of the OpenPBR examples.
  const MaterialXMaterial paint =
      ReadMtlx(OneMtlx("open_pbr_surface", MtlxIn("base_color", "color3", "0.1, 0.6, 0.9"), "",
                       R"(colorspace="acescg")"));
  CheckMtlxColor(paint.material["base_color"], 0, 0.6620, 0.9580, 1e-3);
  REQUIRE(paint.notes.size() == 1);
  CHECK(HasMtlxNote(paint, "base_color: -0.2775 0.662"));
  CHECK(HasMtlxNote(paint, "a.mtlx:2: m: "));
  CHECK(HasMtlxNote(paint, "clamped to 0 "));
  const MaterialXMaterial white = ReadMtlx(OneMtlx(
      "open_pbr_surface", MtlxIn("base_color", "color3", "1, 1, 1"), "", R"(colorspace="acescg")"));
  CHECK(white.notes.empty());
  const MaterialXMaterial dense =
      ReadMtlx(OneMtlx("open_pbr_surface", MtlxIn("specular_ior", "float", "0")));
  CHECK(dense.material["specular_ior"] == 0.015625);
  CHECK(HasMtlxNote(dense, "specular_ior: 0 is out of range"));
}

// ---- Nodes --------------------------------------------------------------------------------------

std::string MtlxFloatNode(const std::string& kind, const std::string& inputs) {
  return "<" + kind + R"( name="n" type="float">)" + inputs + "</" + kind + ">";
}

TEST_CASE("constant parts of a graph are folded") {
  const auto two = [](const char* kind, const char* a, const char* b) {
    return MtlxWeight(MtlxFloatNode(kind, MtlxIn("in1", "float", a) + MtlxIn("in2", "float", b)));
  };
  CHECK(two("multiply", "0.5", "3") == 1.5);
  CHECK(two("add", "0.5", "0.25") == 0.75);
  CHECK(two("subtract", "0.5", "0.125") == 0.375);
  CHECK(two("divide", "1", "8") == 0.125);
  CHECK(two("power", "0.5", "3") == 0.125);
  CHECK(two("max", "0.5", "0.75") == 0.75);
  CHECK(two("min", "0.5", "0.75") == 0.5);
  CHECK(MtlxWeight(MtlxFloatNode("constant", MtlxIn("value", "float", "0.3"))) == 0.3);
  CHECK(MtlxWeight(MtlxFloatNode("dot", MtlxIn("in", "float", "0.3"))) == 0.3);
  CHECK(MtlxWeight(MtlxFloatNode("invert", MtlxIn("in", "float", "0.25"))) == 0.75);
  CHECK(MtlxWeight(MtlxFloatNode("sqrt", MtlxIn("in", "float", "0.25"))) == 0.5);
  CHECK(MtlxWeight(MtlxFloatNode("clamp", MtlxIn("in", "float", "0.2") +
                                              MtlxIn("low", "float", "0.4") +
                                              MtlxIn("high", "float", "0.6"))) == 0.4);
  CHECK(MtlxWeight(MtlxFloatNode("clamp", MtlxIn("in", "float", "7"))) == 1);
  CHECK(MtlxWeight(MtlxFloatNode("mix", MtlxIn("fg", "float", "1") + MtlxIn("bg", "float", "0.5") +
                                            MtlxIn("mix", "float", "0.25"))) == 0.625);
  CHECK(MtlxWeight(MtlxFloatNode("extract", MtlxIn("in", "color3", "0.1, 0.2, 0.3") +
                                                MtlxIn("index", "integer", "2"))) == 0.3);
  // Inputs that are left out have MaterialX's defaults.
  CHECK(MtlxWeight(MtlxFloatNode("multiply", MtlxIn("in1", "float", "0.5"))) == 0.5);
  CHECK(MtlxWeight(MtlxFloatNode("divide", MtlxIn("in1", "float", "0.5"))) == 0.5);
  CHECK(MtlxWeight(MtlxFloatNode("power", MtlxIn("in1", "float", "0.5"))) == 0.5);
  CHECK(MtlxWeight(MtlxFloatNode(
            "mix", MtlxIn("bg", "float", "0.5") + MtlxIn("fg", "float", "0.7"))) == 0.5);
  CheckMtlxColor(MtlxBaseColor(R"(<multiply name="n" type="color3">)" +
                               MtlxIn("in1", "color3", "0.2, 0.4, 0.6") +
                               MtlxIn("in2", "float", "0.5") + "</multiply>"),
                 0.1, 0.2, 0.3);
  CheckMtlxColor(
      MtlxBaseColor(R"(<combine3 name="n" type="color3">)" + MtlxIn("in1", "float", "0.1") +
                    MtlxIn("in3", "float", "0.3") + "</combine3>"),
      0.1, 0, 0.3);
  CheckMtlxColor(MtlxBaseColor(R"(<convert name="n" type="color3">)" +
                               MtlxIn("in", "float", "0.3") + "</convert>"),
                 0.3, 0.3, 0.3);
  const std::string separate = R"(<separate3 name="p" type="multioutput">)" +
                               MtlxIn("in", "color3", "0.1, 0.2, 0.3") + "</separate3>";
  CHECK(MtlxWeight(separate +
                   MtlxFloatNode("dot", MtlxFrom("in", "float", "p", R"(output="outg")"))) == 0.2);
  CHECK(MtlxWeight(separate +
                   MtlxFloatNode("dot", MtlxFrom("in", "float", "p", R"(output="outz")"))) == 0.3);
}

TEST_CASE("node graphs have inputs and outputs") {
  const std::string graph = R"(<nodegraph name="g">)" + MtlxIn("gain", "float", "3") +
                            R"(<multiply name="p" type="float">)" + MtlxIn("in1", "float", "0.25") +
                            R"(<input name="in2" type="float" interfacename="gain"/></multiply>)"
                            R"(<output name="a" type="float" nodename="p"/>)"
                            R"(<output name="b" type="float" nodename="q"/>)"
                            R"(<constant name="q" type="float">)" +
                            MtlxIn("value", "float", "0.5") + "</constant></nodegraph>";
  const auto weight = [&](const std::string& connection) {
    const MaterialXMaterial material = ReadMtlx(
        OneMtlx("open_pbr_surface",
                R"(<input name="specular_weight" type="float" )" + connection + "/>", graph));
    return material.material["specular_weight"].get<double>();
  };
  CHECK(weight(R"(nodegraph="g" output="a")") == 0.75);
  CHECK(weight(R"(nodegraph="g" output="b")") == 0.5);
  CHECK(weight(R"(nodegraph="g")") == 0.75);  // the first
  CHECK(MtlxRefusalOf(OneMtlx("open_pbr_surface",
                              R"(<input name="specular_weight" type="float" nodegraph="g" )"
                              R"(output="c"/>)",
                              graph))
            .find("an output \"c\"") != std::string::npos);
}

TEST_CASE("what cannot be followed gives its input the default, and is told") {
  const MaterialXMaterial noise = ReadMtlx(
      OneMtlx("open_pbr_surface",
              MtlxFrom("specular_roughness", "float", "n") + MtlxFrom("base_color", "color3", "p"),
              R"(<fractal3d name="n" type="float"/><mix name="p" type="color3">)" +
                  MtlxIn("bg", "color3", "1, 0, 0") + MtlxFrom("fg", "color3", "q") +
                  MtlxFrom("mix", "float", "n") + R"(</mix><convert name="q" type="color3">)" +
                  MtlxFrom("in", "float", "n") + "</convert>"));
  CHECK_FALSE(noise.material.contains("specular_roughness"));
  CHECK(noise.notes.size() == 2);
  CHECK(HasMtlxNote(noise,
                    "specular_roughness: its graph is not followed: a node that is not read at "
                    "<fractal3d> \"n\" (line 2); it is 0.3"));
  CHECK(HasMtlxNote(noise, "base_color: its graph is not followed"));
  // A mix or product that does not need it is followed.
  CHECK(
      MtlxWeight(MtlxFloatNode("mix", MtlxIn("bg", "float", "0.5") + MtlxFrom("fg", "float", "x") +
                                          MtlxIn("mix", "float", "0")) +
                 R"(<fractal3d name="x" type="float"/>)") == 0.5);
  CHECK(MtlxWeight(
            MtlxFloatNode("multiply", MtlxFrom("in1", "float", "x") + MtlxIn("in2", "float", "0")) +
            R"(<fractal3d name="x" type="float"/>)") == 0);
}

// ---- Images -------------------------------------------------------------------------------------

std::string MtlxImageNode(const std::string& kind, const std::string& type, const std::string& more,
                          const std::string& name = "n") {
  return "<" + kind + " name=\"" + name + "\" type=\"" + type + "\">" + more + "</" + kind + ">";
}

const std::string kMtlxSrgbFile =
    MtlxIn("file", "filename", "a.png", R"(colorspace="srgb_texture")");

Json MtlxTextureOf(const MaterialXMaterial& material, const std::string& map) {
  const std::string name = material.material.value(map, Json()).is_object()
                               ? material.material[map]["texture"].get<std::string>()
                               : material.material.value(map, std::string());
  for (const auto& [own, texture] : material.textures) {
    if (own == name) return texture;
  }
  return {};
}

MaterialXMaterial WithMtlxColorImage(const std::string& nodes, const std::string& root = "") {
  return ReadMtlx(OneMtlx("open_pbr_surface", MtlxFrom("base_color", "color3", "n"), nodes, root));
}

TEST_CASE("images are textures of maps, with their factors") {
  const MaterialXMaterial color = WithMtlxColorImage(
      R"(<multiply name="n" type="color3">)" + MtlxIn("in1", "color3", "0.5, 0.25, 1") +
          MtlxFrom("in2", "color3", "i") + "</multiply>" +
          MtlxImageNode("image", "color3", kMtlxSrgbFile, "i"),
      R"(fileprefix="pictures/")");
  CHECK(color.notes.empty());
  CHECK(color.material["base_color"] == Json({0.5, 0.25, 1.0}));
  CHECK(MtlxTextureOf(color, "base_color_map") ==
        Json({{"file", "pictures/a.png"}, {"encoding", "srgb"}}));
  const std::string data = MtlxIn("file", "filename", "r.png");
  const MaterialXMaterial number = ReadMtlx(OneMtlx(
      "open_pbr_surface",
      MtlxFrom("specular_roughness", "float", "n") + MtlxFrom("base_metalness", "float", "e"),
      MtlxImageNode("image", "float", data) + R"(<extract name="e" type="float">)" +
          MtlxFrom("in", "vector3", "v") + MtlxIn("index", "integer", "1") + "</extract>" +
          MtlxImageNode("image", "vector3", data, "v")));
  CHECK(number.material["specular_roughness"] == 1);
  CHECK(MtlxTextureOf(number, "specular_roughness_map") ==
        Json({{"file", "r.png"}, {"encoding", "linear"}}));
  CHECK_FALSE(number.material.contains("base_metalness_map"));
  CHECK(HasMtlxNote(number, "base_metalness: channel 1 of an image is not shown"));
  // Bounds that do not cut leave it, others do not.
  const auto clamped = [&](const char* low) {
    return WithMtlxColorImage(R"(<clamp name="n" type="color3">)" + MtlxFrom("in", "color3", "i") +
                              MtlxIn("low", "float", low) + "</clamp>" +
                              MtlxImageNode("image", "color3", kMtlxSrgbFile, "i"));
  };
  CHECK(clamped("0").material.contains("base_color_map"));
  CHECK_FALSE(clamped("0.1").material.contains("base_color_map"));
  CHECK(HasMtlxNote(clamped("0.1"), "the larger of an image and numbers at <clamp>"));
  // No file: the default.
  CheckMtlxColor(MtlxBaseColor(MtlxImageNode(
                     "image", "color3",
                     MtlxIn("file", "filename", "") + MtlxIn("default", "color3", "1, 0, 0.5"))),
                 1, 0, 0.5);
}

TEST_CASE("images of colour spaces that textures have not are told") {
  const auto read = [](const std::string& space) {
    return WithMtlxColorImage(MtlxImageNode(
        "image", "color3", MtlxIn("file", "filename", "a.exr", "colorspace=\"" + space + "\"")));
  };
  CHECK(MtlxTextureOf(read("lin_rec709"), "base_color_map")["encoding"] == "linear");
  CHECK(read("none").notes.empty());
  CHECK(MtlxTextureOf(read("acescg"), "base_color_map")["encoding"] == "linear");
  CHECK(HasMtlxNote(read("acescg"), "its image is in acescg, and read as lin_rec709"));
  CHECK(MtlxTextureOf(read("g22_rec709"), "base_color_map")["encoding"] == "srgb");
  CHECK(HasMtlxNote(read("g22_rec709"), "read as srgb_texture"));
  CHECK(HasMtlxNote(read("xyz"), "the colour space \"xyz\" of its image is not known"));
}

TEST_CASE("coordinates are placed as MaterialX places them") {
  const auto placed = [](const std::string& kind, const std::string& more,
                         const std::string& nodes = "") {
    const MaterialXMaterial material =
        WithMtlxColorImage(MtlxImageNode(kind, "color3", kMtlxSrgbFile + more) + nodes);
    INFO((material.notes.empty() ? std::string() : material.notes.front()));
    CHECK(material.notes.empty());
    return MtlxTextureOf(material, "base_color_map");
  };
  Json tiled = placed("tiledimage", MtlxIn("uvtiling", "vector2", "4, 2") +
                                        MtlxIn("uvoffset", "vector2", "0.5, 0.25"));
  CHECK(tiled["scale"] == Json({4.0, 2.0}));
  CHECK(tiled["offset"] == Json({-0.5, -0.25}));
  tiled = placed("tiledimage", MtlxIn("realworldimagesize", "vector2", "2, 2") +
                                   MtlxIn("realworldtilesize", "vector2", "1, 4"));
  CHECK(tiled["scale"] == Json({0.5, 2.0}));
  // (uv - 0.5) / 0.25 - (-1, 2) + 0.5
  const std::string texcoord = R"(<texcoord name="t" type="vector2"/>)";
  Json at = placed("image", MtlxFrom("texcoord", "vector2", "p"),
                   texcoord + R"(<place2d name="p" type="vector2">)" +
                       MtlxFrom("texcoord", "vector2", "t") + MtlxIn("offset", "vector2", "-1, 2") +
                       MtlxIn("scale", "vector2", "0.25, 0.25") +
                       MtlxIn("pivot", "vector2", "0.5, 0.5") + "</place2d>");
  CHECK(at["scale"] == Json({4.0, 4.0}));
  CHECK(at["offset"] == Json({-0.5, -3.5}));
  CHECK_FALSE(at.contains("rotate_deg"));
  // A quarter turn, clockwise: (u, v) -> (v, -u), that is, -90 degrees.
  at = placed("image", MtlxFrom("texcoord", "vector2", "p"),
              texcoord + R"(<place2d name="p" type="vector2">)" +
                  MtlxFrom("texcoord", "vector2", "t") + MtlxIn("rotate", "float", "90") +
                  "</place2d>");
  CHECK(at["rotate_deg"].get<double>() == Approx(-90));
  at = placed("image", MtlxFrom("texcoord", "vector2", "p"),
              texcoord + R"(<multiply name="p" type="vector2">)" + MtlxFrom("in1", "vector2", "t") +
                  MtlxIn("in2", "float", "3") + "</multiply>");
  CHECK(at["scale"] == Json({3.0, 3.0}));
  at = placed("image", MtlxIn("uaddressmode", "string", "clamp") +
                           MtlxIn("vaddressmode", "string", "mirror") +
                           MtlxIn("filtertype", "string", "closest"));
  CHECK(at["wrap_u"] == "clamp");
  CHECK(at["wrap_v"] == "mirror");
  CHECK(at["filter"] == "nearest");
  // KHR_texture_transform, whose v points down: an offset of 0.25 there is -0.25 here.
  at = placed("gltf_image",
              MtlxIn("scale", "vector2", "2, 2") + MtlxIn("offset", "vector2", "0.5, 0.25"));
  CHECK(at["scale"] == Json({2.0, 2.0}));
  CHECK(at["offset"] == Json({0.5, -1.25}));
}

TEST_CASE("scaling after turning is a shear, which textures have not") {
  const MaterialXMaterial material = WithMtlxColorImage(
      MtlxImageNode("image", "color3", kMtlxSrgbFile + MtlxFrom("texcoord", "vector2", "p")) +
      R"(<place2d name="p" type="vector2">)" + MtlxFrom("texcoord", "vector2", "t") +
      MtlxIn("rotate", "float", "30") + MtlxIn("scale", "vector2", "1, 2") +
      MtlxIn("operationorder", "integer", "1") +
      R"(</place2d><texcoord name="t" type="vector2"/>)");
  CHECK_FALSE(material.material.contains("base_color_map"));
  CHECK(HasMtlxNote(material, "an image that is sheared"));
}

TEST_CASE("rotated placements are the coordinates themselves") {
  for (const double degrees : {-130.0, -90.0, 0.0, 20.0, 75.0, 180.0}) {
    MaterialXValue value{.kind = MaterialXValue::Kind::kCoordinates, .size = 2};
    value.coordinates.rows = {Vec3d(2, 0, 0), Vec3d(0, -3, 0)};
    const MaterialXValue turned = TurnedClockwise(value, degrees);
    const auto placement = PlacementOf(turned.coordinates);
    REQUIRE(placement);
    const double angle = placement->rotate_deg * (M_PI / 180), u = 0.3, v = 0.9;
    const double x = placement->scale.x * u, y = placement->scale.y * v;
    const auto& [first, second] = turned.coordinates.rows;
    CHECK(std::cos(angle) * x - std::sin(angle) * y == Approx(first.dot(Vec3d(u, v, 1))));
    CHECK(std::sin(angle) * x + std::cos(angle) * y == Approx(second.dot(Vec3d(u, v, 1))));
  }
}

TEST_CASE("normal maps") {
  const auto read = [](const std::string& more, const std::string& type = "vector3") {
    return ReadMtlx(
        OneMtlx("open_pbr_surface", MtlxFrom("geometry_normal", "vector3", "n"),
                R"(<normalmap name="n" type="vector3">)" + MtlxFrom("in", type, "i") + more +
                    "</normalmap>" +
                    MtlxImageNode("image", type, MtlxIn("file", "filename", "n.png"), "i")));
  };
  const MaterialXMaterial plain = read("");
  CHECK(plain.notes.empty());
  CHECK(plain.material["normal_map"]["convention"] == "literal");
  CHECK(MtlxTextureOf(plain, "normal_map") == Json({{"file", "n.png"}, {"encoding", "linear"}}));
  CHECK(read(MtlxIn("scale", "float", "0.5")).material["normal_map"]["scale"] == 0.5);
  CHECK(HasMtlxNote(read(MtlxIn("scale", "vector2", "0.5, 1")), "two scales"));
  CHECK(HasMtlxNote(read(MtlxIn("space", "string", "object")), "not in tangent space"));
}

// ---- Shaders ------------------------------------------------------------------------------------

TEST_CASE("open_pbr_surface is open_pbr, with what it has not told") {
  const MaterialXMaterial nothing = ReadMtlx(OneMtlx("open_pbr_surface", ""));
  CHECK(nothing.material == Json({{"model", "open_pbr"}}));
  CHECK(nothing.notes.empty());
  CHECK(nothing.name == "m");
  const MaterialXMaterial all = ReadMtlx(OneMtlx(
      "open_pbr_surface",
      MtlxIn("base_weight", "float", "0.9") + MtlxIn("base_color", "color3", "0.1, 0.2, 0.3") +
          MtlxIn("base_metalness", "float", "0.25") +
          MtlxIn("base_diffuse_roughness", "float", "0.1") +
          MtlxIn("specular_weight", "float", "0.7") +
          MtlxIn("specular_color", "color3", "1, 0.5, 0") +
          MtlxIn("specular_roughness", "float", "0.4") + MtlxIn("specular_ior", "float", "1.6") +
          MtlxIn("specular_roughness_anisotropy", "float", "0.2") +
          MtlxIn("coat_weight", "float", "0.5") + MtlxIn("coat_color", "color3", "1, 0.9, 0.8") +
          MtlxIn("coat_roughness", "float", "0.15") + MtlxIn("coat_ior", "float", "1.7") +
          MtlxIn("coat_darkening", "float", "0.6") + MtlxIn("fuzz_weight", "float", "0.35") +
          MtlxIn("fuzz_color", "color3", "0.5, 0.6, 0.7") +
          MtlxIn("fuzz_roughness", "float", "0.45") + MtlxIn("emission_luminance", "float", "2") +
          MtlxIn("emission_color", "color3", "1, 0.5, 0.25") +
          MtlxIn("subsurface_color", "color3", "1, 0, 0") +
          MtlxIn("transmission_color", "color3", "1, 0, 0") +
          MtlxIn("thin_film_ior", "float", "2")));
  CHECK(all.notes.empty());
  const Json expected = {{"model", "open_pbr"},
                         {"base_weight", 0.9},
                         {"base_color", {0.1, 0.2, 0.3}},
                         {"base_metalness", 0.25},
                         {"base_diffuse_roughness", 0.1},
                         {"specular_weight", 0.7},
                         {"specular_color", {1.0, 0.5, 0.0}},
                         {"specular_roughness", 0.4},
                         {"specular_ior", 1.6},
                         {"specular_roughness_anisotropy", 0.2},
                         {"coat_weight", 0.5},
                         {"coat_color", {1.0, 0.9, 0.8}},
                         {"coat_roughness", 0.15},
                         {"coat_ior", 1.7},
                         {"coat_darkening", 0.6},
                         {"fuzz_weight", 0.35},
                         {"fuzz_color", {0.5, 0.6, 0.7}},
                         {"fuzz_roughness", 0.45},
                         {"emission", {2.0, 1.0, 0.5}}};
  CHECK(all.material.size() == expected.size());
  for (const auto& [key, value] : expected.items()) {
    INFO(key);
    CHECK(all.material.value(key, Json()) == value);
  }
}

TEST_CASE("MaterialX: what is read as something else is told") {
  const auto note_of = [](const std::string& shader, const std::string& inputs) {
    const MaterialXMaterial material = ReadMtlx(OneMtlx(shader, inputs));
    return material.notes.size() == 1 ? material.notes[0] : std::string();
  };
  CHECK(note_of("open_pbr_surface", MtlxIn("geometry_thin_walled", "boolean", "true"))
            .find("geometry_thin_walled: what passes through") != std::string::npos);
  CHECK(note_of("open_pbr_surface", MtlxIn("geometry_thin_walled", "boolean", "false")).empty());
  CHECK(note_of("standard_surface", MtlxIn("thin_walled", "boolean", "true"))
            .find("thin_walled: what passes through") != std::string::npos);
  CHECK(note_of("gltf_pbr", MtlxIn("ior", "float", "0.5")).find("ior: 0.5 is below 1") !=
        std::string::npos);
  CHECK(note_of("gltf_pbr", MtlxIn("ior", "float", "0")).empty());  // an infinite index
  CHECK(note_of("gltf_pbr", MtlxIn("alpha_mode", "integer", "7"))
            .find("alpha_mode: 7 is none of 0") != std::string::npos);
  CHECK(note_of("gltf_pbr", MtlxIn("alpha_mode", "integer", "2")).empty());
}

TEST_CASE("MaterialX: an open_pbr_surface of version 1.2 has emission by weight") {
  const std::string emission = MtlxIn("emission_luminance", "float", "100");
  CHECK_FALSE(ReadMtlx(OneMtlx("open_pbr_surface", emission)).material.contains("version"));
  const MaterialXMaterial half =
      ReadMtlx(OneMtlx("open_pbr_surface", emission + MtlxIn("emission_weight", "float", "0.5") +
                                               MtlxIn("specular_haze", "float", "0.25")));
  CHECK(half.notes.empty());
  CHECK(half.material["version"] == "1.2");
  CHECK(half.material["specular_haze"] == 0.25);
  CheckMtlxColor(half.material["emission"], 50, 50, 50);
  // By its attribute alone: no weight is 0.
  std::string text = OneMtlx("open_pbr_surface", emission);
  text.replace(text.find("<open_pbr_surface "), 18, "<open_pbr_surface version=\"1.2\" ");
  const MaterialXMaterial none = ReadMtlx(text);
  CHECK(none.material["version"] == "1.2");
  CHECK_FALSE(none.material.contains("emission"));
  REQUIRE(none.notes.size() == 1);
  CHECK(none.notes[0].find("emission_luminance: emits nothing") != std::string::npos);
}

TEST_CASE("subsurfaces and films are read, transmission is read and told") {
  const MaterialXMaterial wax = ReadMtlx(
      OneMtlx("open_pbr_surface", MtlxIn("base_weight", "float", "0.5") +
                                      MtlxIn("base_color", "color3", "0.4, 0.4, 0.4") +
                                      MtlxIn("subsurface_weight", "float", "0.75") +
                                      MtlxIn("subsurface_color", "color3", "1, 0.8, 0.6")));
  CheckMtlxColor(wax.material["subsurface_color"], 1, 0.8, 0.6);
  CHECK(wax.material["subsurface_weight"] == 0.75);
  CHECK(wax.material["base_weight"] == 0.5);
  CHECK(HasMtlxNote(wax, "subsurface_weight: 0.75: shown as diffuse"));
  CHECK(wax.notes.size() == 1);
  const MaterialXMaterial glass =
      ReadMtlx(OneMtlx("open_pbr_surface", MtlxIn("transmission_weight", "float", "1") +
                                               MtlxIn("thin_film_weight", "float", "0.5") +
                                               MtlxIn("geometry_opacity", "float", "0.5") +
                                               MtlxIn("specular_roughnes", "float", "0.5")));
  CHECK(HasMtlxNote(glass, "transmission_weight: 1: transmission is not rendered"));
  CHECK(HasMtlxNote(glass, "geometry_opacity: 0.5: not shown: the material is opaque"));
  CHECK(HasMtlxNote(glass, "has no such input; did you mean \"specular_roughness\"?"));
  CHECK(glass.notes.size() == 3);
  CHECK(glass.material ==
        Json({{"model", "open_pbr"}, {"transmission_weight", 1.0}, {"thin_film_weight", 0.5}}));
  const MaterialXMaterial film =
      ReadMtlx(OneMtlx("standard_surface", MtlxIn("thin_film_thickness", "float", "550")));
  CHECK(film.material["thin_film_weight"] == 1.0);
  CHECK(film.material["thin_film_thickness"].get<double>() == Approx(0.55));
  CHECK(film.material["thin_film_ior"] == 1.5);
}

TEST_CASE("standard_surface becomes open_pbr as MaterialX translates it") {
  const MaterialXMaterial plain = ReadMtlx(OneMtlx("standard_surface", ""));
  CHECK(plain.notes.empty());
  CHECK(plain.material == Json({{"model", "open_pbr"}, {"specular_roughness", 0.2}}));
  const std::string old = OneMtlx("standard_surface", "");
  std::string version = old;
  version.replace(version.find("type=\"surfaceshader\""), 0, "version=\"1.0.0\" ");
  CHECK(ReadMtlx(version).material["base_weight"] == 0.8);
  CheckMtlxColor(ReadMtlx(version).material["base_color"], 1, 1, 1);

  const MaterialXMaterial paint =
      ReadMtlx(OneMtlx("standard_surface", MtlxIn("base_color", "color3", "0.5, 0.5, 0.5") +
                                               MtlxIn("coat", "float", "0.5") +
                                               MtlxIn("coat_color", "color3", "1, 0.5, 0") +
                                               MtlxIn("coat_affect_roughness", "float", "0.25")));
  CheckMtlxColor(paint.material["base_color"], 0.5, 0.375, 0.25);
  CHECK(paint.material["coat_weight"] == 0.5);
  CHECK(paint.material["coat_ior"] == 1.5);
  CHECK(paint.material["coat_roughness"] == 0.1);
  CHECK(paint.material["coat_darkening"] == 0.25);
  CHECK(HasMtlxNote(paint, "coat_color: it tints the base as well"));
  const MaterialXMaterial metal = ReadMtlx(
      OneMtlx("standard_surface",
              MtlxIn("metalness", "float", "1") + MtlxIn("specular", "float", "0") +
                  MtlxIn("base_color", "color3", "1, 1, 1") + MtlxIn("coat", "float", "1") +
                  MtlxIn("coat_color", "color3", "1, 0.5, 0") + MtlxIn("sheen", "float", "0.5") +
                  MtlxIn("sheen_roughness", "float", "0.3") +
                  MtlxIn("sheen_color", "color3", "0.5, 0.5, 0.5")));
  CheckMtlxColor(metal.material["base_color"], 1, 0.5, 0);
  CHECK_FALSE(metal.material.contains("coat_weight"));
  CHECK_FALSE(metal.material.contains("specular_weight"));
  CHECK(metal.material["fuzz_weight"] == 0.5);
  CHECK(metal.material["fuzz_roughness"].get<double>() == Approx(std::pow(0.3, 0.4)));
  CHECK(HasMtlxNote(metal, "coat: 1: it tints the metal"));
}

TEST_CASE("the alphas of standard_surface's anisotropy are kept") {
  const double r = 0.3, a = 0.6;
  const MaterialXMaterial brushed =
      ReadMtlx(OneMtlx("standard_surface", MtlxIn("specular_roughness", "float", "0.3") +
                                               MtlxIn("specular_anisotropy", "float", "0.6") +
                                               MtlxIn("specular_rotation", "float", "0.25")));
  CHECK(brushed.notes.empty());
  const double roughness = brushed.material["specular_roughness"];
  const double own = brushed.material["specular_roughness_anisotropy"];
  CHECK(brushed.material["geometry_tangent_deg"] == 90);
  const double along = roughness * roughness * std::sqrt(2 / (1 + (1 - own) * (1 - own)));
  CHECK(along == Approx(r * r / std::sqrt(1 - a)));
  CHECK((1 - own) * along == Approx(r * r * std::sqrt(1 - a)));
}

TEST_CASE("gltf_pbr becomes metallic_roughness as a glTF file does") {
  const MaterialXMaterial plain = ReadMtlx(OneMtlx("gltf_pbr", ""));
  CHECK(plain.notes.empty());
  const Json white = {{"model", "metallic_roughness"},
                      {"base_color", {1.0, 1.0, 1.0}},
                      {"roughness", 1.0},
                      {"metallic", 1.0}};
  CHECK(plain.material["metallic"] == 1.0);
  CHECK(plain.material["roughness"] == 1.0);
  CheckMtlxColor(plain.material["base_color"], 1, 1, 1);
  const MaterialXMaterial all = ReadMtlx(OneMtlx(
      "gltf_pbr",
      MtlxIn("metallic", "float", "0") + MtlxIn("roughness", "float", "0.5") +
          MtlxIn("ior", "float", "2") + MtlxIn("specular", "float", "0.7") +
          MtlxIn("specular_color", "color3", "1, 0.5, 20") + MtlxIn("clearcoat", "float", "0.4") +
          MtlxIn("clearcoat_roughness", "float", "0.3") +
          MtlxIn("sheen_color", "color3", "0.1, 0.2, 0.3") +
          MtlxIn("sheen_roughness", "float", "0.6") + MtlxIn("emissive", "color3", "1, 0.5, 0") +
          MtlxIn("emissive_strength", "float", "3") +
          MtlxIn("anisotropy_strength", "float", "0.5") +
          MtlxIn("anisotropy_rotation", "float", "3.141592653589793") +
          MtlxIn("alpha_mode", "integer", "1") + MtlxIn("alpha", "float", "0.75") +
          MtlxIn("alpha_cutoff", "float", "0.25") + MtlxIn("occlusion", "float", "0.5") +
          MtlxIn("transmission", "float", "1") + MtlxIn("iridescence", "float", "1")));
  CheckMtlxColor(all.material["dielectric_f0"], 1 / 9.0, 1 / 18.0, 1);
  CHECK(all.material["specular"] == 0.7);
  CHECK(all.material["coat"] == 0.4);
  CHECK(all.material["coat_roughness"] == 0.3);
  CheckMtlxColor(all.material["sheen_color"], 0.1, 0.2, 0.3);
  CHECK(all.material["sheen_roughness"] == 0.6);
  CheckMtlxColor(all.material["emission"], 3, 1.5, 0);
  CHECK(all.material["anisotropy"] == 0.5);
  CHECK(all.material["anisotropy_rotation_deg"].get<double>() == Approx(180));
  CHECK(all.material["opacity"] == 0.75);
  CHECK(all.material["opacity_cutoff"] == 0.25);
  CHECK(
      HasMtlxNote(all, "specular_color: 0.1111 0.05556 2.222 in linear Rec. 709 is out of range"));
  CHECK(HasMtlxNote(all, "occlusion: left out"));
  CHECK(HasMtlxNote(all, "transmission: 1: transmission is not rendered"));
  CHECK(all.material["iridescence"] == 1.0);
  CHECK(all.material["iridescence_thickness_nm"] == 100.0);  // gltf_pbr's default, not glTF's
  CHECK(all.notes.size() == 3);
}

TEST_CASE("opacities of images are holes") {
  const auto read = [](const std::string& channel) {
    return ReadMtlx(OneMtlx("open_pbr_surface", MtlxFrom("geometry_opacity", "float", "n"),
                            MtlxImageNode("image", "color4", kMtlxSrgbFile, "i") +
                                R"(<extract name="n" type="float">)" +
                                MtlxFrom("in", "color4", "i") +
                                MtlxIn("index", "integer", channel) + "</extract>"));
  };
  CHECK(MtlxTextureOf(read("0"), "opacity_map")["encoding"] == "linear");
  CHECK(MtlxTextureOf(read("3"), "opacity_map")["encoding"] == "alpha");
  CHECK(HasMtlxNote(read("3"), "geometry_opacity: shown as holes, where it is below 0.5"));
  CHECK_FALSE(read("1").material.contains("opacity_map"));
  CHECK(HasMtlxNote(read("1"), "channel 1 of an image is not shown"));
}

TEST_CASE("what cannot be followed leaves neither light nor a mirror") {
  const std::string noise = R"(<noise3d name="n" type="color3"/>)";
  const MaterialXMaterial lamp = ReadMtlx(OneMtlx(
      "open_pbr_surface",
      MtlxFrom("emission_color", "color3", "n") + MtlxIn("emission_luminance", "float", "2"),
      noise));
  CheckMtlxColor(lamp.material["emission"], 2, 2, 2);
  CHECK(HasMtlxNote(lamp, "emission_color: its graph is not followed"));
  CHECK(ReadMtlx(OneMtlx("open_pbr_surface", MtlxFrom("emission_color", "color3", "n"), noise))
            .notes.empty());
  const MaterialXMaterial gloss = ReadMtlx(OneMtlx(
      "gltf_pbr", MtlxFrom("specular_color", "color3", "n") + MtlxIn("ior", "float", "2"), noise));
  CheckMtlxColor(gloss.material["dielectric_f0"], 1 / 9.0, 1 / 9.0, 1 / 9.0);
  CHECK(HasMtlxNote(ReadMtlx(OneMtlx("open_pbr_surface",
                                     MtlxIn("specular_weight", "float", "1", R"(unit="inch")"))),
                    "a number in the unit \"inch\""));
}

TEST_CASE("glTF's images: packed channels, colour and alpha, normals") {
  const std::string orm =
      MtlxImageNode("gltf_image", "vector3", MtlxIn("file", "filename", "orm.png"), "i");
  const std::string separate = R"(<separate3 name="c" type="multioutput">)" +
                               MtlxFrom("in", "vector3", "i") + "</separate3>";
  const MaterialXMaterial packed = ReadMtlx(OneMtlx(
      "gltf_pbr",
      MtlxFrom("metallic", "float", "c", R"(output="outz")") +
          MtlxFrom("roughness", "float", "c", R"(output="outy")") +
          MtlxFrom("base_color", "color3", "b", R"(output="outcolor")") +
          MtlxFrom("alpha", "float", "b", R"(output="outa")") +
          MtlxIn("alpha_mode", "integer", "1") + MtlxFrom("normal", "vector3", "k"),
      orm + separate +
          MtlxImageNode("gltf_colorimage", "multioutput",
                        kMtlxSrgbFile + MtlxIn("color", "color4", "0.5, 1, 1, 0.5"), "b") +
          MtlxImageNode("gltf_normalmap", "vector3", MtlxIn("file", "filename", "n.png"), "k")));
  CHECK(MtlxTextureOf(packed, "metallic_roughness_map")["file"] == "orm.png");
  CHECK(MtlxTextureOf(packed, "metallic_roughness_map")["encoding"] == "linear");
  CHECK(MtlxTextureOf(packed, "base_color_map")["encoding"] == "srgb");
  CHECK(packed.material["base_color"] == Json({0.5, 1.0, 1.0}));
  CHECK(MtlxTextureOf(packed, "opacity_map")["encoding"] == "alpha");
  CHECK(packed.material["opacity"] == 0.5);
  CHECK(MtlxTextureOf(packed, "normal_map")["file"] == "n.png");
  CHECK(packed.notes.empty());
  const MaterialXMaterial crossed = ReadMtlx(
      OneMtlx("gltf_pbr", MtlxFrom("roughness", "float", "c", R"(output="outz")"), orm + separate));
  CHECK_FALSE(crossed.material.contains("metallic_roughness_map"));
  CHECK(HasMtlxNote(crossed, "roughness: an image of it is shown only"));
}

// ---- Documents ----------------------------------------------------------------------------------

TEST_CASE("documents include others, whose roots their elements inherit from") {
  const MtlxFolder folder;
  folder.Write("a.mtlx", R"(<materialx version="1.39" colorspace="acescg">
      <xi:include href="sub/b.mtlx"/><xi:include href="sub/b.mtlx"/>
      <look name="l"><materialassign name="x" geom="/ball" material="m"/></look></materialx>)");
  folder.Write("sub/b.mtlx", OneMtlx("open_pbr_surface",
                                     MtlxIn("specular_color", "color3", "0.5, 0.5, 0.5") +
                                         MtlxFrom("base_color", "color3", "n"),
                                     MtlxImageNode("image", "color3", kMtlxSrgbFile),
                                     R"(colorspace="srgb_texture" fileprefix="images/")"));
  for (const char* const name : {"", "m", "/ball", "x"}) {
    const MaterialXMaterial material = ReadMaterialX(folder.path, "a.mtlx", name, {});
    const double srgb = std::pow((0.5 + 0.055) / 1.055, 2.4);
    CheckMtlxColor(material.material["specular_color"], srgb, srgb, srgb);
    CHECK(MtlxTextureOf(material, "base_color_map")["file"] == "sub/images/a.png");
    CHECK(material.notes.empty());
  }
  // What the root of the including document says is not inherited.
  folder.Write("sub/b.mtlx",
               OneMtlx("open_pbr_surface", MtlxIn("base_color", "color3", "0.1, 0.6, 0.9")));
  CheckMtlxColor(ReadMaterialX(folder.path, "a.mtlx", "", {}).material["base_color"], 0.1, 0.6,
                 0.9);
  const auto including = [&](const std::string& href) {
    folder.Write("a.mtlx", MtlxText("<xi:include href=\"" + href + "\"/>"));
    return MtlxRefusal([&] { ReadMaterialX(folder.path, "a.mtlx", "", {}); });
  };
  CHECK(including("missing.mtlx").find("a.mtlx:2: there is no file") != std::string::npos);
  CHECK(including("../x.mtlx").find("is outside") != std::string::npos);
  CHECK(including("/etc/passwd").find("is outside") != std::string::npos);
  CHECK(including("").find("has no \"href\"") != std::string::npos);
  CHECK(including("a.mtlx").find("includes itself") != std::string::npos);
  folder.Write("sub/b.mtlx", MtlxText(R"(<xi:include href="../a.mtlx"/>)"));
  CHECK(including("sub/b.mtlx").find("includes itself") != std::string::npos);
  // A chain of documents, and one that doubles at each step: each is read once.
  for (int i = 0; i < 70; ++i) {
    const std::string next = "c" + std::to_string(i + 1) + ".mtlx";
    folder.Write(
        "c" + std::to_string(i) + ".mtlx",
        MtlxText("<xi:include href=\"" + next + "\"/><xi:include href=\"" + next + "\"/>"));
  }
  CHECK(including("c0.mtlx").find("more than 64 documents") != std::string::npos);
}

TEST_CASE("one material of several is named") {
  const std::string two = MtlxText(
      R"(<open_pbr_surface name="s" type="surfaceshader"/>
      <usd_preview_surface name="u" type="surfaceshader"/>
      <surfacematerial name="gold" type="material">)" +
      MtlxFrom("surfaceshader", "surfaceshader", "s") + MtlxFrom("displacementshader", "x", "s") +
      R"(</surfacematerial><surfacematerial name="silver" type="material">)" +
      MtlxFrom("surfaceshader", "surfaceshader", "u") + "</surfacematerial>");
  CHECK(ReadMtlx(two, "gold").name == "gold");
  CHECK(HasMtlxNote(ReadMtlx(two, "gold"), "the displacementshader is left out"));
  const std::string unnamed = MtlxRefusalOf(two);
  CHECK(unnamed.find("has 2 materials, of which none is named") != std::string::npos);
  CHECK(unnamed.find("a.mtlx#gold: it has gold, silver") != std::string::npos);
  CHECK(MtlxRefusal([&] { ReadMtlx(two, "gokd"); }).find("did you mean \"gold\"?") !=
        std::string::npos);
  CHECK(MtlxRefusal([&] { ReadMtlx(two, "x"); }).find("it has gold, silver") != std::string::npos);
  CHECK(MtlxRefusal([&] { ReadMtlx(two, "silver"); }).find("is a shader that is not read") !=
        std::string::npos);
  // A shader without a material is one.
  CHECK(ReadMtlx(MtlxText(R"(<gltf_pbr name="s" type="surfaceshader"/>)")).name == "s");
}

TEST_CASE("what is wrong with a document is told in one line, with its place") {
  const auto has = [](const std::string& text, const std::string& part) {
    const std::string refusal = MtlxRefusalOf(text);
    INFO(refusal);
    CHECK(refusal.find(part) != std::string::npos);
  };
  const auto shader = [](const std::string& inputs, const std::string& nodes = "") {
    return OneMtlx("open_pbr_surface", inputs, nodes);
  };
  has("", "is not XML");
  has("<materialx version=\"1.39\">\n<a>", "a.mtlx:2: is not XML");
  has("<scene/>", "is not MaterialX: its root is <scene>");
  has("<!DOCTYPE x [<!ENTITY a \"b\">]><materialx version=\"1.39\"/>", "has a document type");
  has("<materialx/>", "has no version");
  has("<materialx version=\"1.36\"/>", "is version 1.36");
  has("<materialx version=\"1.39\"/>", "has no material");
  has(MtlxText(R"(<surfacematerial name="m" type="material"/>)"), "has no surface shader");
  has(shader(MtlxIn("base_weight", "float", "many")),
      "a.mtlx:2: <input> \"base_weight\" is \"many\"");
  for (const char* number : {"nan", "inf", "1e999", "", "1 2", "0x10"}) {
    has(shader(MtlxIn("base_weight", "float", number)), "a float is one finite number");
  }
  has(shader(MtlxIn("base_color", "color3", "1, 2")), "is \"1, 2\"");
  has(shader(MtlxIn("base_color", "color3", "1e308, -1e308, 1e308", R"(colorspace="acescg")")),
      "too large");
  has(shader(MtlxIn("geometry_thin_walled", "boolean", "yes") +
             MtlxIn("base_color", "color4", "1,1,1,1")),
      "is of the type \"color4\"");
  has(shader(MtlxIn("base_color", "color3", "1,1,1", R"(colorspace="acescgg")")),
      "did you mean \"acescg\"?");
  has(shader(MtlxFrom("base_color", "color3", "x")), "is connected to \"x\", which does not exist");
  has(shader(R"(<input name="base_color" type="color3" interfacename="x"/>)"), "the input \"x\"");
  has(shader(MtlxFrom("base_color", "color3", "a"), R"(<dot name="a" type="color3">)" +
                                                        MtlxFrom("in", "color3", "b") +
                                                        R"(</dot><dot name="b" type="color3">)" +
                                                        MtlxFrom("in", "color3", "a") + "</dot>"),
      "in a cycle");
  has(shader(MtlxFrom("base_color", "color3", "a"),
             R"(<constant name="a" type="float">)" + MtlxIn("value", "float", "1") + "</constant>"),
      "has 1 component");
  std::string deep, chain;
  for (int i = 0; i < 1000; ++i) deep += "<a>";
  for (int i = 0; i < 1000; ++i) deep += "</a>";
  has(MtlxText(deep), "is nested deeper than");
  for (int i = 0; i < 5000; ++i) {
    chain += "<dot name=\"n" + std::to_string(i) + "\" type=\"color3\">" +
             MtlxFrom("in", "color3", "n" + std::to_string(i + 1)) + "</dot>";
  }
  has(shader(MtlxFrom("base_color", "color3", "n0"), chain), "more than 400 levels");
  std::string many;
  for (int i = 0; i < 500'000; ++i) many += "<a/>";
  has(MtlxText(many), "more elements than any material");
  for (const char* character : {"&#0;", "&#8;", "&#xD800;", "&#x110000;", "&#x10FFFFFFFF;"}) {
    const std::string name = "a" + std::string(character);
    has(MtlxText("\n<a name=\"" + name + "\"/>"),
        "a.mtlx:3: \"" + std::string(character).substr(0, 3));
    has(MtlxText("<a name=\"" + name + "\"/>"), "is not a character");
  }
  MtlxRefusalOf(MtlxText("<a name=\"&#65;&#x1F600;&#; &#x;\"/>"));
}

// ---- Scenes and the command line ----------------------------------------------------------------

TEST_CASE("materials of scenes are those of documents, and change them") {
  const MtlxFolder folder;
  folder.Write("sub/gold.mtlx",
               OneMtlx("open_pbr_surface", MtlxIn("base_metalness", "float", "1") +
                                               MtlxIn("specular_roughness", "float", "0.4") +
                                               MtlxIn("transmission_weight", "float", "1")));
  std::vector<std::string> notes, files;
  LoadOptions options;
  options.on_warning = [&](const std::string& note) { notes.push_back(note); };
  options.on_file = [&](const std::filesystem::path& file) { files.push_back(file.string()); };
  const auto load = [&](const std::string& material) {
    return LoadSceneText(R"({"nacre": 1, "materials": {"a": )" + material +
                             R"(, "b": {"file": "sub/gold.mtlx", "material": "m"}}})",
                         "scene.json", folder.path, options);
  };
  const Scene scene =
      load(R"({"file": "sub/gold.mtlx", "material": "m", "specular_roughness": 0.1})");
  const auto& a = std::get<OpenPbrMaterial>(scene.materials[0].model);
  CHECK(a.base_metalness == 1);
  CHECK(a.specular_roughness == 0.1);
  CHECK(std::get<OpenPbrMaterial>(scene.materials[1].model).specular_roughness == 0.4);
  CHECK(scene.materials[0].name == "a");
  CHECK(notes.size() == 1);  // once for each material of a document
  CHECK_FALSE(files.empty());
  CHECK(MtlxRefusal([&] {
          load(R"({"file": "sub/gold.mtlx", "roughness": 0.1})");
        }).find("/materials/a") != std::string::npos);
  CHECK(MtlxRefusal([&] {
          load(R"({"file": "sub/gold.mtlx", "model": "phong"})");
        }).find("is of the model open_pbr") != std::string::npos);
  CHECK(MtlxRefusal([&] { load(R"({"file": "gold.png"})"); }).find("is no MaterialX document") !=
        std::string::npos);
  CHECK(MtlxRefusal([&] { load(R"({"file": "../gold.mtlx"})"); }).find("is outside") !=
        std::string::npos);
  CHECK(MtlxRefusal([&] {
          load(R"({"file": "sub/gold.mtlx", "material": "silver"})");
        }).find("has no material \"silver\"") != std::string::npos);
}

TEST_CASE("a document that changes changes the scene") {
  const MtlxFolder folder;
  const auto write = [&](const char* roughness) {
    folder.Write("a.mtlx",
                 OneMtlx("open_pbr_surface", MtlxIn("specular_roughness", "float", roughness)));
  };
  write("0.4");
  LiveScene scene(R"({"nacre": 1, "materials": {"a": {"file": "a.mtlx"}}, "shapes": [{"type":
      "sphere", "center": [0, 0, 0], "radius": 1, "material": "a"}]})",
                  "scene.json", folder.path, {});
  const auto material = [&] { return std::get<OpenPbrMaterial>(scene.scene().materials[0].model); };
  CHECK(material().specular_roughness == 0.4);
  scene.Set("/materials/a/base_metalness", "1");
  CHECK(material().specular_roughness == 0.4);
  CHECK(material().base_metalness == 1);
  write("0.55");
  scene.ReadNamedFiles();
  CHECK(material().specular_roughness == 0.55);
  CHECK(material().base_metalness == 1);
}

TEST_CASE("the command line names a document and a material in it") {
  const MtlxFolder folder;
  folder.Write("gold.mtlx", OneMtlx("gltf_pbr", ""));
  const std::string path = (folder.path / "gold.mtlx").string();
  const Json json = ParseMaterialText("--material", path);
  CHECK(json ==
        Json({{"name", "m"}, {"model", "metallic_roughness"}, {"file", path}, {"material", "m"}}));
  CHECK(ParseMaterialText("--material", path + "#m") == json);
  CHECK(MaterialLabel(json) == "m");
  CHECK(MaterialXFilesIn({{"materials", {{"a", json}}}}).size() == 1);
  CHECK(ParseMaterialText("--material", "phong") == Json{{"model", "phong"}});
  CHECK(MtlxRefusal([&] {
          ParseMaterialText("--material", path + "#x");
        }).find("has no material") != std::string::npos);
  CHECK(MtlxRefusal([&] { ParseMaterialText("--material", "/no/such.mtlx"); }).find("no file") !=
        std::string::npos);
  // Names may have any characters, those that separate names and begin JSON, too.
  folder.Write("odd.mtlx", MtlxText(R"(<gltf_pbr name="s" type="surfaceshader"/>
<surfacematerial name="a#2 {&quot;" type="material">
  <input name="surfaceshader" type="surfaceshader" nodename="s"/></surfacematerial>)"));
  const std::string odd = (folder.path / "odd.mtlx").string();
  CHECK(ParseMaterialText("--material", odd + "#a#2 {\"").at("material") == "a#2 {\"");
  CHECK(ParseMaterialText("--material", R"( {"model": "phong", "name": "a.mtlx#b"})")["model"] ==
        "phong");
  // Such a file may be anywhere, once it is trusted.
  Json material = json;
  material.erase("name");
  LoadOptions trusting;
  trusting.trusted_files = MaterialXFilesIn(material);
  const Material read = LoadMaterialText(material.dump(), "MATERIAL", trusting);
  CHECK(std::get<MetallicRoughnessMaterial>(read.model).metallic == 1);
  CHECK(MtlxRefusal([&] { LoadMaterialText(material.dump(), "MATERIAL"); }).find("is outside") !=
        std::string::npos);
}

}  // namespace
}  // namespace nacre
