// SPDX-License-Identifier: Apache-2.0
// What tables say of a material, and that files keep it.
#include "table/brdf_table.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <vector>

#include "brdf/anisotropic_albedo_integral.h"
#include "brdf/fresnel.h"
#include "brdf/ggx_anisotropic.h"
#include "catch.h"
#include "scene/material_parameters.h"
#include "shading/scalar_bsdf.h"
#include "table/materials.h"
#include "table/read_table.h"
#include "table/variant.h"
#include "table/write_table.h"

namespace nacre {
namespace {

size_t ColumnOf(const BrdfTable& table, const std::string& name) {
  const auto at = std::find(table.columns.begin(), table.columns.end(), name);
  REQUIRE(at != table.columns.end());
  return static_cast<size_t>(at - table.columns.begin());
}

Vec3d VectorAt(const BrdfTable& table, size_t row, const std::string& name) {
  const size_t first = ColumnOf(table, name);
  return {table.At(row, first), table.At(row, first + 1), table.At(row, first + 2)};
}

std::vector<Material> Materials() {
  std::vector<Material> all = {FullOpenPbr(), PlasticOpenPbr(), BrushedOpenPbr(), RoughGold()};
  all.push_back({.model = LambertMaterial{Rgb(0.2, 0.4, 0.6)}});
  all.push_back({.model = PhongMaterial{.model = PhongModel::kBlinnPhong}});
  all.push_back({.model = ConductorMaterial{}});
  all.push_back({.model = DielectricMaterial{.roughness = 0.3}});
  MetallicRoughnessMaterial coated;
  coated.coat = 0.8;
  coated.coat_roughness = 0.3;
  coated.sheen_color = Rgb(0.5, 0.3, 0.1);
  coated.sheen_roughness = 0.4;
  all.push_back({.model = coated});
  return all;
}

}  // namespace

TEST_CASE("rows that are not finite are found, whatever their column") {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  BrdfTable table{.columns = {"f_r", "f_g"},
                  .values = {1, 2, std::nan(""), 0, 3, 4, 0, -kInfinity}};
  CHECK(RowsNotFinite(table) == std::vector<size_t>{1, 3});
  CHECK(RowsNotFinite(TabulateBrdf(FullOpenPbr(), PairsOf({}), {.albedo = false})).empty());
  CHECK(RowsNotFinite({}).empty());
}

TEST_CASE("tables of materials with maps are of the maps' factors, with their films and coats") {
  const std::vector<DirectionPair> pairs = PairsOf({});
  MetallicRoughnessMaterial film;
  film.base_color = Rgb(0.8, 0.5, 0.2);
  film.metallic = 0.5;
  film.iridescence = 1;
  film.coat = 0.5;
  auto open_pbr = std::get<OpenPbrMaterial>(FullOpenPbr().model);
  open_pbr.thin_film_weight = 1;
  open_pbr.base_metalness = 0.5;
  for (const Material& factors : {Material{.model = film}, Material{.model = open_pbr}}) {
    const MaterialModel& model = *ModelOf(factors);
    CAPTURE(model.name);
    const BrdfTable expected = TabulateBrdf(factors, pairs, {});
    Material all = factors;  // with every map at once
    const auto check = [&](Material mapped) {
      CHECK(TabulateBrdf(mapped, pairs, {}).values == expected.values);
    };
    for (const MaterialMap& map : model.maps) {
      CAPTURE(map.name);
      Material mapped = factors;
      map.set(mapped, TextureId{0});
      map.set(all, TextureId{0});
      check(mapped);
    }
    all.bump_map.texture = TextureId{0};
    all.vertex_colors = VertexColors::kBase;
    check(all);
  }
}

TEST_CASE("f is what the model reflects over n.l, and its lobes sum to it") {
  const std::vector<DirectionPair> pairs = PairsOf({});
  for (const Material& material : Materials()) {
    const BrdfTable table = TabulateBrdf(material, pairs, {.albedo = false});
    const ShadingMaterial prepared = PrepareMaterial(material);
    const std::vector<std::string> lobes = PreparedVariant({.material = material}).lobes();
    REQUIRE(table.rows() == pairs.size());
    for (size_t row = 0; row < table.rows(); ++row) {
      const auto& [l, v] = pairs[row];
      CHECK(VectorAt(table, row, "light_x") == l);
      CHECK(VectorAt(table, row, "view_x") == v);
      const Rgb reflected = Reflect(prepared, Vec3d(0, 0, 1), l, v).Sum();
      Vec3d sum(0, 0, 0);
      for (const std::string& lobe : lobes) sum += VectorAt(table, row, lobe + "_r");
      const Vec3d f = VectorAt(table, row, "f_r");
      for (int c = 0; c < 3; ++c) {
        // Roundings of the sums over the lobes, whose terms are all above 0.
        CHECK(std::abs(f[c] * l.z - reflected[c]) <= 1e-14 * reflected[c]);
        CHECK(std::abs(f[c] - sum[c]) <= 1e-14 * std::abs(f[c]));
      }
      CHECK(table.At(row, ColumnOf(table, "pdf")) ==
            ReflectionPdf(prepared, Vec3d(0, 0, 1), v, l, false));
    }
  }
}

TEST_CASE("tables of reciprocal models are reciprocal") {
  Material material = PlasticOpenPbr();
  std::get<OpenPbrMaterial>(material.model).options.layering = Layering::kReciprocal;
  std::vector<DirectionPair> pairs = PairsOf({}), swapped = pairs;
  for (DirectionPair& pair : swapped) std::swap(pair.to_light, pair.to_view);
  const BrdfTable a = TabulateBrdf(material, pairs, {.albedo = false});
  const BrdfTable b = TabulateBrdf(material, swapped, {.albedo = false});
  for (size_t row = 0; row < a.rows(); ++row) {
    const Vec3d f = VectorAt(a, row, "f_r"), other = VectorAt(b, row, "f_r");
    for (int c = 0; c < 3; ++c) CHECK(std::abs(f[c] - other[c]) <= 1e-12 * f[c]);
  }
}

TEST_CASE("the albedo is that of light from everywhere") {
  // Lambert's is its colour, and what a furnace shows of white metal is all light.
  const std::vector<DirectionPair> pairs = PairsOf({{30}, {0, 45, 80}, {90}, 30});
  const BrdfTable matte = TabulateBrdf({.model = LambertMaterial{Rgb(0.2, 0.4, 0.6)}}, pairs);
  const BrdfTable white = TabulateBrdf(
      {.model =
           MetallicRoughnessMaterial{.base_color = {1, 1, 1}, .metallic = 1, .roughness = 0.7}},
      pairs);
  for (size_t row = 0; row < pairs.size(); ++row) {
    CHECK((VectorAt(matte, row, "albedo_r") - Vec3d(0.2, 0.4, 0.6)).length() < 1e-14);
    // As right as the header says.
    CHECK((VectorAt(white, row, "albedo_r") - Vec3d(1)).length() < 1e-3 * std::sqrt(3.0));
  }
}

TEST_CASE("the albedo of a brushed metal is that of its azimuth") {
  MetallicRoughnessMaterial metal{.base_color = {0.9, 0.6, 0.3}, .metallic = 1, .roughness = 0.5};
  metal.anisotropy = 0.9;
  metal.anisotropy_rotation_deg = 30;
  metal.compensation = Compensation::kNone;
  std::vector<DirectionPair> pairs;
  for (const double phi : {30.0, 75.0, 120.0, 210.0}) {
    for (const DirectionPair& pair : PairsOf({{30}, {5, 45, 80}, {90}, phi})) pairs.push_back(pair);
  }
  const BrdfTable table = TabulateBrdf({.model = metal}, pairs);
  const GgxAlphas<double> alpha = GltfAlphas(0.5, 0.9);
  const auto schlick = [](double, double one_minus) {
    return FresnelSchlick(0.9, 1.0, Power5(one_minus));
  };
  for (size_t row = 0; row < pairs.size(); ++row) {
    // Seen along the lobe's own axes, which are turned by 30 degrees.
    const Vec3d& v = pairs[row].to_view;
    const double cos = std::cos(M_PI / 6), sin = std::sin(M_PI / 6);
    const Vec3d own(v.x * cos + v.y * sin, v.y * cos - v.x * sin, v.z);
    const double expected =
        IntegrateAlbedos(alpha, own, kFineAnisotropicQuadrature, schlick)[0].fresnel;
    CAPTURE(row, own, expected);
    CHECK(std::abs(VectorAt(table, row, "albedo_r").x - expected) < 1e-3);  // as the header says
  }
  CHECK(HeaderOf({.model = metal})["alpha"] == Json({alpha.x, alpha.y}));
}

TEST_CASE("nothing is reflected where light or view is below the surface") {
  const std::vector<DirectionPair> pairs = {
      {{0.6, 0, -0.8}, {0, 0, 1}}, {{0, 0, 1}, {0.6, 0, -0.8}}, {{1, 0, 0}, {0, 0, 1}}};
  const BrdfTable table = TabulateBrdf(FullOpenPbr(), pairs);
  for (size_t row = 0; row < pairs.size(); ++row) {
    CHECK(VectorAt(table, row, "f_r") == Vec3d(0));
    CHECK(VectorAt(table, row, "coat_r") == Vec3d(0));
    CHECK(table.At(row, ColumnOf(table, "pdf")) == 0);
  }
  CHECK(VectorAt(table, 1, "albedo_r") == Vec3d(0));
}

TEST_CASE("the header names every parameter and every option, and the rules") {
  Material material = FullOpenPbr();
  const Json header = HeaderOf(material);
  const Json& whole = header["material"];
  CHECK(whole["model"] == "open_pbr");
  CHECK(whole["coat_color"] == Json({0.9, 0.6, 0.4}));
  CHECK(whole["coat_partial"] == "exponent_then_lerp");
  CHECK(header["rules"] == "spec_1_1");
  CHECK(header["smith"] == "height_correlated");
  CHECK(header["compensation"] == "kulla_conty");
  CHECK(header["lobes"] == Json({"diffuse", "specular", "coat", "fuzz"}));
  CHECK(header["mirrors"].empty());
  auto& options = std::get<OpenPbrMaterial>(material.model).options;
  options = OptionsOf(OpenPbrRules::kAdobe);
  CHECK(HeaderOf(material)["rules"] == "adobe");
  options.layering = Layering::kView;
  CHECK(HeaderOf(material)["rules"].is_null());
  // Mirrors are named with what they reflect, (n - 1)^2 / (n + 1)^2 of glass.
  const Json mirror = HeaderOf({.model = DielectricMaterial{.ior = 1.5, .roughness = 0}});
  CHECK(mirror["mirrors"]["specular"][0].get<double>() == Approx(0.04));
}

TEST_CASE("files keep every number and the header") {
  const TemporaryFolder folder;
  const BrdfTable table =
      TabulateBrdf(FullOpenPbr(), PairsOf({{0, 45, 80}, {30, 70}, {0, 90}, 30}));
  for (const char* name : {"a.csv", "a.json", "a.npy"}) {
    WriteTable(table, folder.Path(name));
    const BrdfTable read = ReadTable(folder.Path(name));
    CHECK(read.columns == table.columns);
    CHECK(read.values == table.values);
  }
  CHECK(ReadTable(folder.Path("a.csv")).header["material"] == table.header["material"]);
  CHECK(ReadTable(folder.Path("a.json")).header == table.header);
  CHECK(std::filesystem::exists(folder.Path("a.npy.json")));
  CHECK_THROWS_AS(WriteTable(table, folder.Path("a.txt")), Error);
}

TEST_CASE(
    "a variant without mistakes is the material, and layers are left to it where it has them") {
  // Mistakes in formulas compute the lobe again: they must not change what they do not concern.
  const Material materials[] = {FullOpenPbr(), BrushedOpenPbr(), RoughGold()};
  for (const Material& material : materials) {
    const PreparedVariant right({.material = material});
    // White compensation of a model without compensation is none.
    Material uncompensated = material;
    if (auto* const gold = std::get_if<MetallicRoughnessMaterial>(&uncompensated.model)) {
      gold->compensation = Compensation::kNone;
    } else {
      std::get<OpenPbrMaterial>(uncompensated.model).options.compensation = Compensation::kNone;
    }
    const PreparedVariant none({.material = uncompensated});
    const PreparedVariant again({.material = uncompensated, .formula = kFullyCompensated});
    for (const auto& [l, v] : PairsOf({})) {
      const Rgb a = none.Evaluate(l, v), b = again.Evaluate(l, v);
      for (int c = 0; c < 3; ++c) CHECK(std::abs(a[c] - b[c]) <= 1e-13 * a[c]);
      CHECK(right.Evaluate(l, v).x > 0);
    }
  }
}

}  // namespace nacre
