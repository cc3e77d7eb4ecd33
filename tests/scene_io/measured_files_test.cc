// SPDX-License-Identifier: Apache-2.0
// tests/scene_io/measured_files_test.cc: files of measured BRDFs, good and bad, and the materials
// of scenes that name them.
#include <chrono>
#include <limits>
#include <thread>

#include <fmt/format.h>

#include "catch.h"
#include "measured_tables.h"
#include "messages.h"
#include "scene/hash.h"
#include "scene_io/gltf_builder.h"
#include "scene_io/live_scene.h"
#include "scene_io/measured_file.h"
#include "scene_io/scene_json.h"

namespace nacre {
namespace {

// A file of MERL's whose cells are numbered, but for a black one.
const std::string& MerlFile() {
  static const std::string bytes = [] {
    MerlTable table;
    for (size_t i = 0; i < 3 * MerlTable::kCells; ++i) {
      table.rgb.push_back(1 + static_cast<float>(i % 1000));
    }
    std::fill_n(table.rgb.begin() + 3 * 12345, 3, 0.0f);
    return MerlBytes(table);
  }();
  return bytes;
}

template <class Number>
std::string With(std::string bytes, size_t at, Number number) {
  std::memcpy(bytes.data() + at, &number, sizeof(number));
  return bytes;
}

std::string ErrorOfBytes(const std::string& bytes) {
  return ErrorOf([&] { ReadMeasured(bytes, "a.file"); });
}
bool Refuses(const std::string& bytes, const std::string& part) {
  return Tells(ErrorOfBytes(bytes), "a.file: ") && Tells(ErrorOfBytes(bytes), part);
}

bool Same(const TabulatedWarp& a, const TabulatedWarp& b) {
  return a.angles.phi == b.angles.phi && a.angles.theta == b.angles.theta && a.width == b.width &&
         a.height == b.height && a.density == b.density && a.along_row == b.along_row &&
         a.up_to_row == b.up_to_row;
}

TEST_CASE("MERL files are scaled to 1/sr, and cells without data are black") {
  const auto brdf = ReadMeasured(MerlFile(), "a.binary");
  const auto& table = std::get<MerlTable>(brdf->table);
  for (size_t i = 0; i < table.rgb.size(); i += 997) {
    const float expected = i / 3 == 12345 ? 0 : 1 + static_cast<float>(i % 1000);
    CHECK(std::abs(table.rgb[i] - expected) <= 1e-6f * expected);
  }
  // One negative channel is enough.
  const std::string one = With(MerlFile(), 12 + 8 * (MerlTable::kCells + 777), -0.5);
  const auto marked = ReadMeasured(one, "a.binary");
  CHECK(MerlValue(std::get<MerlTable>(marked->table), 777) == Rgb(0));
  CHECK(marked->hash != brdf->hash);
}

TEST_CASE("damaged MERL files are refused in one line") {
  const std::string& whole = MerlFile();
  Refuses("", "ends after 0 bytes");
  Refuses(whole.substr(0, 11), "ends after 11 bytes, in its header");
  Refuses(whole.substr(0, whole.size() - 1), "has 34992011 bytes instead of 34992012");
  Refuses(whole + "x", "longer than its table");
  Refuses(With(whole, 8, int32_t{360}), "has 90 x 90 x 360 cells");
  Refuses(With(whole, 8, int32_t{360}), "keep the first 180 azimuths");
  Refuses(With(whole, 0, int32_t{-90}), "has -90 x 90 x 180 cells");
  Refuses(std::string("\0\0\0\x5a\0\0\0\x5a\0\0\0\xb4", 12), "is big-endian");
  Refuses(std::string(64, 'x'), "is it a MERL .binary?");
  const size_t cell = MerlCell(3, 4, 5);
  const auto at = [&](size_t c) { return 12 + 8 * (c * MerlTable::kCells + cell); };
  Refuses(With(whole, at(0), std::numeric_limits<double>::quiet_NaN()),
          "red of cell (3, 4, 5) of theta_half, theta_diff and phi_diff is nan");
  Refuses(With(whole, at(1), std::numeric_limits<double>::infinity()), "green of cell (3, 4, 5)");
  Refuses(With(whole, at(2), 1e300), "blue of cell (3, 4, 5)");
  Refuses(With(whole, at(2), -std::numeric_limits<double>::infinity()), "is -inf");
}

TEST_CASE("EPFL's files are read as they are") {
  for (const auto& [phis, reduction] : {std::pair{1, 1}, {5, 1}, {4, 2}, {3, 4}}) {
    CAPTURE(phis, reduction);
    const RandomRgl file(7, static_cast<size_t>(phis), reduction);
    const MeasuredBrdf expected = MakeRglBrdf(file, reduction);
    const auto brdf = ReadMeasured(TensorBytes(file.fields), "a.bsdf");
    CHECK(brdf->isotropic == expected.isotropic);
    CHECK(brdf->reduction == reduction);
    CHECK(Same(brdf->half, expected.half));
    CHECK(Same(brdf->luminance, expected.luminance));
    const auto &read = std::get<RglTable>(brdf->table), &made = std::get<RglTable>(expected.table);
    CHECK(read.rgb == made.rgb);
    CHECK(read.ndf.values == made.ndf.values);
    CHECK(read.ndf.width == made.ndf.width);
    CHECK(read.sigma.values == made.sigma.values);
    CHECK(brdf->mean_albedo == expected.mean_albedo);
  }
  // Two azimuths are those of an isotropic material: they are the same.
  RandomRgl two(7, 2, 1);
  const auto brdf = ReadMeasured(TensorBytes(two.fields), "a.bsdf");
  CHECK(brdf->isotropic);
  CHECK(brdf->half.angles.phi.size() == 1);
}

TEST_CASE("spectra become Rec. 709 under D65") {
  RandomRgl file(8);
  const std::vector<float> rgb = file.At("rgb").values;
  const uint64_t thetas = file.theta.size();
  // All wavelengths alike, then all but the red ones black.
  for (const bool flat : {true, false}) {
    RandomRgl spectral = file;
    std::vector<float> nm, values;
    for (int k = 0; k < 40; ++k) nm.push_back(360 + 12 * static_cast<float>(k));
    for (size_t s = 0; s < thetas; ++s) {
      for (const float wavelength : nm) {
        for (size_t k = 0; k < 49; ++k) {
          values.push_back(flat || wavelength > 610 ? rgb[s * 147 + k] : 0);
        }
      }
    }
    spectral.At("rgb") = {"spectra", {1, thetas, nm.size(), 7, 7}, values};
    spectral.Add("wavelengths", {nm.size()}, nm);
    const auto brdf = ReadMeasured(TensorBytes(spectral.fields), "a.bsdf");
    const auto& table = std::get<RglTable>(brdf->table);
    for (size_t k = 0; k < 49; ++k) {
      for (size_t c = 0; c < 3; ++c) {
        const float value = table.rgb[c * 49 + k];
        if (flat) {
          CHECK(std::abs(value - rgb[k]) < 1e-5f);
        } else {
          CHECK((c == 0 ? value > 0.5f * rgb[k] : value < 0.05f * rgb[k]));
        }
      }
    }
  }
}

TEST_CASE("damaged files of EPFL's are refused in one line") {
  const RandomRgl good(9, 3, 4);
  const std::string whole = TensorBytes(good.fields);
  ReadMeasured(whole, "a.bsdf");
  for (size_t length = 0; length < whole.size(); length += length < 400 ? 1 : 997) {
    CHECK(ErrorOfBytes(whole.substr(0, length)) != "no error");
  }
  const auto refuses = [&](const std::string& part, const auto& change) {
    RandomRgl file = good;
    change(&file);
    Refuses(TensorBytes(file.fields), part);
  };
  const auto set = [&](const char* name, size_t i, float value) {
    return [=](RandomRgl* file) { file->At(name).values[i] = value; };
  };
  const auto rename = [&](const char* name, const char* to) {
    return [=](RandomRgl* file) { file->At(name).name = to; };
  };
  const float nan = std::numeric_limits<float>::quiet_NaN();
  refuses("\"vndf\" has the number nan at [0, 0, 1, 2]", set("vndf", 10, nan));
  refuses("\"rgb\" has the number inf at [0, 0, 0, 0, 3]",
          set("rgb", 3, std::numeric_limits<float>::infinity()));
  refuses("\"ndf\" has the number -1 at [0, 5]", set("ndf", 5, -1));
  refuses("\"sigma\" has the number 1.99", set("sigma", 0, 2e18f));
  refuses("\"luminance\" has the number -0.5", set("luminance", 1, -0.5f));
  refuses("\"theta_i\" has the angle 3 at [1]", set("theta_i", 1, 3));
  refuses("\"theta_i\" has the angle 0.1 at [2]", set("theta_i", 2, 0.1f));
  refuses("\"phi_i\" has the angle -4", set("phi_i", 0, -4));
  refuses("\"phi_i\" covers 2.", set("phi_i", 2, -1));
  refuses("has no array \"vndf\"", rename("vndf", "x"));
  refuses("has no array \"ndf\"", rename("ndf", "x"));
  refuses("has neither an array \"rgb\" nor \"spectra\"", rename("rgb", "x"));
  refuses("has two arrays \"ndf\"", rename("sigma", "ndf"));
  refuses("\"spectra\" has 3 wavelengths", [](RandomRgl* file) {
    file->At("rgb").name = "spectra";
    file->Add("wavelengths", {2}, {500, 600});
  });
  refuses("\"ndf\" has 1 dimensions, not 2", [](RandomRgl* file) { file->At("ndf").shape = {36}; });
  refuses("\"ndf\" has 1 x 36 nodes", [](RandomRgl* file) { file->At("ndf").shape = {1, 36}; });
  refuses("\"rgb\" has 7 x 21 nodes", [](RandomRgl* file) {
    file->At("rgb").shape = {3, 4, 1, 7, 21};
  });
  refuses("\"vndf\" is of 4 x 3 directions", [](RandomRgl* file) {
    file->At("vndf").shape = {4, 3, 6, 8};
  });
  refuses("\"rgb\" has 1 channels, not 3", [](RandomRgl* file) {
    file->At("rgb") = {"rgb", {3, 4, 1, 2, 2}, std::vector<float>(48, 1.0f)};
  });
  refuses("is empty", [](RandomRgl* file) { file->At("ndf").shape = {0, 9}; });
  refuses("is larger than the file", [](RandomRgl* file) {
    file->At("ndf").shape = {uint64_t{1} << 33, uint64_t{1} << 33};
  });
  refuses("\"ndf\" has 9 dimensions",
          [](RandomRgl* file) { file->At("ndf").shape = {1, 1, 1, 1, 1, 1, 1, 4, 9}; });
  refuses("\"jacobian\" is not one number of uint8",
          [](RandomRgl* file) { file->Add("jacobian", {1}, {1}); });
  Refuses(With(whole, 12, uint8_t{2}), "is of version 2.0");
  Refuses(With(whole, 14, uint32_t{65}), "has 65 arrays");
  // The first array: its name has 7 letters, then come dimensions, type and offset.
  Refuses(With(whole, 18 + 2 + 7 + 2, uint8_t{12}), "is of the unknown type 12");
  Refuses(With(whole, 18 + 2 + 7 + 2, uint8_t{5}), "\"theta_i\" is of uint32");
  Refuses(With(whole, 18 + 2 + 7 + 3, std::numeric_limits<uint64_t>::max()),
          "reaches beyond the end of the file");
}

std::string SceneWithMaterials(const std::string& materials) {
  return R"({"nacre": 1, "materials": {)" + materials + "}}";
}

TEST_CASE("materials name measured files in the scene's folder") {
  const ModelFolder folder;
  folder.Write("a.bsdf", TensorBytes(RandomRgl(1).fields));
  folder.Write("b.bsdf", TensorBytes(RandomRgl(2).fields));
  folder.Write("gold.binary", MerlFile());
  const auto load = [&](const std::string& materials) {
    return LoadSceneText(SceneWithMaterials(materials), "scene.json", folder.path);
  };
  const Scene scene = load(R"("p": {"model": "measured", "file": "a.bsdf"},
      "q": {"model": "measured", "file": "a.bsdf", "interpolation": "nearest", "emission": 1},
      "r": {"model": "measured", "file": "gold.binary"})");
  const auto of = [&](size_t i) { return std::get<MeasuredMaterial>(scene.materials[i].model); };
  CHECK(of(0).brdf == of(1).brdf);
  CHECK(of(0).interpolation == MeasuredInterpolation::kLinear);
  CHECK(of(1).interpolation == MeasuredInterpolation::kNearest);
  CHECK(scene.materials[1].emission == Rgb(1));
  CHECK(std::holds_alternative<MerlTable>(of(2).brdf->table));
  CHECK(MaterialJson(scene.materials[1])["file"] == "a.bsdf");
  CHECK(MaterialJson(scene.materials[1])["interpolation"] == "nearest");
  const auto hash = [&](const std::string& members) {
    return HashScene(load(R"("p": {"model": "measured", )" + members + "}"));
  };
  CHECK(hash(R"("file": "a.bsdf")") != hash(R"("file": "b.bsdf")"));
  CHECK(hash(R"("file": "a.bsdf")") != hash(R"("file": "a.bsdf", "interpolation": "nearest")"));

  const auto refuses = [&](const std::string& members, const std::string& part) {
    return Tells(ErrorOf([&] { load(R"("p": {"model": "measured")" + members + "}"); }), part);
  };
  refuses("", "/materials/p: missing key \"file\"");
  refuses(R"(, "file": 3)", "/materials/p/file");
  refuses(R"(, "file": "none.binary")", "there is no file \"none.binary\"");
  refuses(R"(, "file": "../a.bsdf")", "is outside the scene's folder");
  refuses(R"(, "file": "a.bsdf", "roughness": 0.5)", "unknown key \"roughness\"");
  refuses(R"(, "file": "a.bsdf", "interpolation": "cubic")", "interpolation");
  folder.Write("bad.binary", MerlFile().substr(0, 1000));
  refuses(R"(, "file": "bad.binary")", "has 1000 bytes instead of 34992012");
  folder.Write("bad.bsdf", MerlFile().substr(0, 1000));
  refuses(R"(, "file": "bad.bsdf")", "is not a list of arrays");
}

TEST_CASE("a measured file that is written again is read again") {
  const ModelFolder folder;
  folder.Write("a.bsdf", TensorBytes(RandomRgl(1).fields));
  const std::string text = SceneWithMaterials(R"("p": {"model": "measured", "file": "a.bsdf"})");
  LiveScene live(folder.Write("scene.json", text), {});
  const auto of = [&] { return std::get<MeasuredMaterial>(live.scene().materials[0].model); };
  const auto first = of().brdf;
  live.Set("/materials/p/interpolation", "\"nearest\"");
  CHECK(of().brdf == first);
  CHECK(of().interpolation == MeasuredInterpolation::kNearest);
  folder.Write("a.bsdf", TensorBytes(RandomRgl(2).fields));
  bool changed = false;  // noticed once no writer may be at it any more
  for (int i = 0; i < 500 && !changed; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
    changed = live.FilesChanged();
  }
  REQUIRE(changed);
  CHECK(live.ReadChangedFiles().Has(ScenePart::kMaterials));
  CHECK(of().brdf->hash != first->hash);
}

}  // namespace
}  // namespace nacre
