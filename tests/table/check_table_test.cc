// SPDX-License-Identifier: Apache-2.0
// Mistakes that are planted into tables are recognised.
#include "table/check_table.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>

#include "brdf/fresnel.h"
#include "catch.h"
#include "shading/scalar_bsdf.h"
#include "table/hypotheses.h"
#include "table/materials.h"
#include "table/read_table.h"

namespace nacre {
namespace {

// f of a row, of the light's and the view's direction.
using Function = std::function<Rgb(const Vec3d&, const Vec3d&)>;

BrdfTable TableOf(const Function& f, const std::vector<DirectionPair>& pairs = PairsOf({})) {
  BrdfTable table = TabulateDirections(pairs);
  const std::vector<double> directions = table.values;
  for (const char* column : {"f_r", "f_g", "f_b"}) table.columns.emplace_back(column);
  table.values.clear();
  for (size_t i = 0; i < pairs.size(); ++i) {
    table.values.insert(table.values.end(), directions.begin() + static_cast<std::ptrdiff_t>(6 * i),
                        directions.begin() + static_cast<std::ptrdiff_t>(6 * i + 6));
    const Rgb value = f(pairs[i].to_light, pairs[i].to_view);
    table.values.insert(table.values.end(), {value.x, value.y, value.z});
  }
  return table;
}

// nacre's own f.
Function Right(const Material& material) {
  const auto prepared = std::make_shared<const ShadingMaterial>(PrepareMaterial(material));
  return [prepared](const Vec3d& l, const Vec3d& v) {
    if (!(l.z > 0)) return Rgb(0);
    return Reflect(*prepared, Vec3d(0, 0, 1), l, v).Sum() / l.z;
  };
}

TableCheck CheckOf(const Material& material, const Function& f, double tolerance = 1e-3) {
  return CheckTable(material, TableOf(f), "theirs", tolerance);
}

// Whether the only step of the explanation, or one that leaves as little, has the words.
bool IsExplainedBy(const TableCheck& check, const std::string& words) {
  const auto has = [&](const std::string& text) { return text.find(words) != std::string::npos; };
  if (check.explanation.size() != 1) return false;
  return has(check.explanation[0]) ||
         std::any_of(check.also.begin(), check.also.end(),
                     [&](const RankedHypothesis& also) { return has(also.text); });
}

Material With(Material material, const std::function<void(OpenPbrMaterial*)>& change) {
  change(&std::get<OpenPbrMaterial>(material.model));
  return material;
}

}  // namespace

TEST_CASE("a right table agrees, in single precision too") {
  for (const Material& material :
       {FullOpenPbr(), PlasticOpenPbr(), BrushedOpenPbr(), RoughGold()}) {
    const Function right = Right(material);
    const TableCheck exact = CheckOf(material, right);
    CHECK(exact.ok);
    CHECK(exact.f.largest < 1e-13);
    CHECK(exact.explanation.empty());
    const TableCheck rounded = CheckOf(material, [&](const Vec3d& l, const Vec3d& v) {
      const Rgb f = right(Vec3d(Vec3f(l)), Vec3d(Vec3f(v)));
      return MakeRgb([&](int c) { return static_cast<double>(static_cast<float>(f[c])); });
    });
    CHECK(rounded.ok);
    CHECK(PageOf(rounded).find("they agree") != std::string::npos);
  }
}

TEST_CASE("factors and cosines are recognised, and told by how much") {
  const Material material = FullOpenPbr();
  const Function f = Right(material);
  const auto times = [&](const std::function<double(const Vec3d&, const Vec3d&)>& factor) {
    return CheckOf(material,
                   [&](const Vec3d& l, const Vec3d& v) { return f(l, v) * factor(l, v); });
  };
  const TableCheck pi = times([](const Vec3d&, const Vec3d&) { return M_PI; });
  CHECK_FALSE(pi.ok);
  CHECK(IsExplainedBy(pi, "all of f is times pi"));
  CHECK(pi.explained_rms < 1e-13);
  CHECK(pi.f.rms == Approx(1 - 1 / M_PI));  // of the larger of both
  CHECK(pi.f.theirs[0] == Approx(M_PI * pi.f.ours[0]));
  CHECK(IsExplainedBy(times([](const Vec3d&, const Vec3d&) { return M_1_PI; }),
                      "all of f is divided by pi once too often"));
  CHECK(IsExplainedBy(times([](const Vec3d&, const Vec3d&) { return 4; }), "all of f is times 4"));
  CHECK(IsExplainedBy(times([](const Vec3d&, const Vec3d&) { return 1.25; }),
                      "all of f is times 1.25"));
  CHECK(IsExplainedBy(times([](const Vec3d& l, const Vec3d&) { return l.z; }), "n.l is part of f"));
  CHECK(IsExplainedBy(times([](const Vec3d&, const Vec3d& v) { return 1 / v.z; }),
                      "divided by n.v once too often"));
}

TEST_CASE("wrong directions are recognised") {
  const Material material = PlasticOpenPbr();
  const Function f = Right(material);
  CHECK(IsExplainedBy(CheckOf(material, [&](const Vec3d& l, const Vec3d& v) { return f(v, l); }),
                      "light and view have changed places"));
  CHECK(IsExplainedBy(CheckOf(material,
                              [&](const Vec3d& l, const Vec3d& v) {
                                const Vec3d up_l(l.x, l.z, l.y), up_v(v.x, v.z, v.y);
                                return up_l.z > 0 && up_v.z > 0 ? f(up_l, up_v) : Rgb(0);
                              }),
                      "y is taken for the normal"));
  const Material brushed = BrushedOpenPbr();
  const Function f_brushed = Right(brushed);
  CHECK(IsExplainedBy(CheckOf(brushed,
                              [&](const Vec3d& l, const Vec3d& v) {
                                return f_brushed({l.y, l.x, l.z}, {v.y, v.x, v.z});
                              }),
                      "tangent and bitangent have changed places"));
  // A file whose light travels downwards.
  std::vector<DirectionPair> pairs = PairsOf({});
  for (DirectionPair& pair : pairs) pair.to_light = -pair.to_light;
  const TableCheck reversed =
      CheckTable(material, TableOf([&](const Vec3d& l, const Vec3d& v) { return f(-l, v); }, pairs),
                 "theirs", 1e-3);
  CHECK(IsExplainedBy(reversed, "the one in which light travels"));
}

TEST_CASE("brushed metals without anisotropy, or turned the wrong way, are recognised") {
  const Material material = BrushedOpenPbr();
  const struct {
    std::function<void(OpenPbrMaterial*)> change;
    const char* words;
  } cases[] = {
      {[](OpenPbrMaterial* m) { m->specular_roughness_anisotropy = 0; },
       "specular_roughness_anisotropy is left at its default"},
      {[](OpenPbrMaterial* m) { m->coat_roughness_anisotropy = 0; },
       "coat_roughness_anisotropy is left at its default"},
      {[](OpenPbrMaterial* m) { m->geometry_tangent_deg *= -1; },
       "geometry_tangent_deg is turned the other way"},
      {[](OpenPbrMaterial* m) { m->geometry_coat_tangent_deg = 0; },
       "geometry_coat_tangent_deg is left at its default"},
  };
  for (const auto& [change, words] : cases) {
    const TableCheck check = CheckOf(material, Right(With(material, change)));
    CAPTURE(words, check.explanation);
    CHECK_FALSE(check.ok);
    CHECK(IsExplainedBy(check, words));
  }
}

TEST_CASE("wrong parameters are recognised") {
  const Material material = FullOpenPbr();
  const struct {
    std::function<void(OpenPbrMaterial*)> change;
    const char* words;
  } cases[] = {
      {[](OpenPbrMaterial* m) { m->specular_roughness = std::sqrt(m->specular_roughness); },
       "specular_roughness is taken for alpha"},
      {[](OpenPbrMaterial* m) { m->coat_roughness *= m->coat_roughness; },
       "coat_roughness is squared once too often"},
      {[](OpenPbrMaterial* m) { m->specular_ior = 1 / m->specular_ior; },
       "specular_ior is inverted"},
      {[](OpenPbrMaterial* m) { m->coat_ior = 1 / m->coat_ior; }, "coat_ior is inverted"},
      {[](OpenPbrMaterial* m) { m->specular_color *= m->specular_color; },
       "specular_color is squared"},
      {[](OpenPbrMaterial* m) { m->coat_color *= m->coat_color; }, "coat_color is squared"},
      {[](OpenPbrMaterial* m) {
         // The sRGB curve above 0.0031308.
         m->base_color =
             MakeRgb([&](int c) { return 1.055 * std::pow(m->base_color[c], 1 / 2.4) - 0.055; });
       },
       "base_color is gamma-encoded"},
      {[](OpenPbrMaterial* m) { std::swap(m->fuzz_color.x, m->fuzz_color.z); },
       "fuzz_color has red and blue changed places"},
      {[](OpenPbrMaterial* m) { m->coat_darkening = 1; }, "coat_darkening is left at its default"},
      {[](OpenPbrMaterial* m) { m->fuzz_weight = 0; }, "fuzz_weight is left at its default"},
  };
  for (const auto& [change, words] : cases) {
    CAPTURE(words);
    const TableCheck check = CheckOf(material, Right(With(material, change)));
    CHECK_FALSE(check.ok);
    CHECK(IsExplainedBy(check, words));
    CHECK(check.explained_rms < 1e-12);
  }
}

TEST_CASE("the options and rules of others are recognised") {
  const Material material = FullOpenPbr();
  const struct {
    std::function<void(OpenPbrOptions*)> change;
    const char* words;
  } cases[] = {
      {[](OpenPbrOptions* o) { o->smith = Shadowing::kSeparable; }, "smith: separable"},
      {[](OpenPbrOptions* o) { o->compensation = Compensation::kNone; }, "compensation: none"},
      {[](OpenPbrOptions* o) { o->coat_fresnel = CoatFresnel::kInvertRatio; },
       "coat_fresnel: invert_ratio"},
      {[](OpenPbrOptions* o) { o->coat_partial = CoatPartial::kPerCrossing; },
       "coat_partial: per_crossing"},
      {[](OpenPbrOptions* o) { *o = OptionsOf(OpenPbrRules::kMaterialX); }, "rules: materialx"},
      {[](OpenPbrOptions* o) { *o = OptionsOf(OpenPbrRules::kAdobe); }, "rules: adobe"},
  };
  for (const auto& a_case : cases) {
    const char* const words = a_case.words;
    CAPTURE(words);
    const TableCheck check = CheckOf(
        material, Right(With(material, [&](OpenPbrMaterial* m) { a_case.change(&m->options); })));
    CHECK(IsExplainedBy(check, words));
    REQUIRE_FALSE(check.choices.empty());
    CHECK(check.choices[0].text.find(words) != std::string::npos);
    CHECK(check.choices[0].rms < 1e-12);
    // All rules are in the ranking, whichever is the best.
    CHECK(std::count_if(check.choices.begin(), check.choices.end(), [](const auto& choice) {
            return choice.kind == HypothesisKind::kRules;
          }) >= 3);
  }
}

TEST_CASE("two mistakes at once are told one after the other") {
  const Material material = FullOpenPbr();
  const Function other = Right(With(material, [](OpenPbrMaterial* m) {
    m->options = OptionsOf(OpenPbrRules::kMaterialX);
    m->options.smith = Shadowing::kSeparable;
  }));
  const TableCheck choices = CheckOf(material, other);
  REQUIRE(choices.explanation.size() == 2);
  CHECK(choices.explained_rms < 1e-12);
  CHECK(choices.explanation[0] + choices.explanation[1] == "rules: materialxsmith: separable");
  const Function alpha =
      Right(With(material, [](OpenPbrMaterial* m) { m->specular_roughness = std::sqrt(0.35); }));
  const TableCheck both =
      CheckOf(material, [&](const Vec3d& l, const Vec3d& v) { return alpha(l, v) * M_PI; });
  CHECK(both.explanation.size() == 2);
  CHECK(both.explained_rms < 1e-12);
}

TEST_CASE("wrong lobes are recognised, and fitted") {
  const Material material = FullOpenPbr();
  const PreparedVariant ours({.material = material});
  const auto with_factor = [&](size_t lobe, double factor) {
    return CheckOf(material, [&ours, lobe, factor](const Vec3d& l, const Vec3d& v) {
      std::vector<Rgb> lobes(ours.lobes().size());
      ours.Evaluate(l, v, lobes);
      lobes[lobe] *= factor;
      Rgb sum(0, 0, 0);
      for (const Rgb& value : lobes) sum += value;
      return sum;
    });
  };
  CHECK(IsExplainedBy(with_factor(0, M_1_PI), "the lobe \"diffuse\" is divided by pi"));
  CHECK(IsExplainedBy(with_factor(2, 0), "the lobe \"coat\" is missing"));
  const TableCheck third = with_factor(1, 3);
  REQUIRE(third.fit.size() == 4);
  CHECK(third.fit[1].lobe == "specular");
  CHECK(third.fit[1].factor == Approx(3));
  CHECK(third.fit[0].factor == Approx(1));
  CHECK(third.fit_rms < 1e-10);
}

TEST_CASE("F82's missing clamp is recognised") {
  // A metal whose curve falls below 0: F0 = 0.2, tint 0.
  const Material material{.model = OpenPbrMaterial{.base_color = Rgb(0.2),
                                                   .base_metalness = 1,
                                                   .specular_color = Rgb(0),
                                                   .specular_roughness = 0.5}};
  const ShadingMaterial prepared = PrepareMaterial(material);
  const auto& model = std::get<MicrofacetModel>(prepared.model);
  const Function right = Right(material);
  const TableCheck check = CheckOf(material, [&](const Vec3d& l, const Vec3d& v) {
    const Angles<double> a = ComputeAngles(Vec3d(0, 0, 1), l, v);
    const double c = VDotH(a), w = std::pow(1 - c, 5);
    const double schlick = 0.2 + 0.8 * w;
    const double seventh = std::pow(6.0 / 7, 5);
    // Kutz et al. 2021, eq. 6, with the tint of 0.
    const double b = (0.2 + 0.8 * seventh) / (seventh * 6 / 49);
    const double f = schlick - b * c * (1 - c) * w;
    const double lobe = GgxDistribution(a, model.alpha) * VisibilityOf(model, l.z, v.z);
    return right(l, v) + Rgb((f - std::clamp(f, 0.0, 1.0)) * lobe);
  });
  CHECK_FALSE(check.ok);
  CHECK(IsExplainedBy(check, "F82's curve is not clamped"));
}

TEST_CASE("F0 for Fresnel's average in the compensation is recognised") {
  Material material = RoughGold();
  std::get<MetallicRoughnessMaterial>(material.model).compensation = Compensation::kKullaConty;
  std::get<MetallicRoughnessMaterial>(material.model).roughness = 0.9;
  const ShadingMaterial prepared = PrepareMaterial(material);
  const auto& model = std::get<MicrofacetModel>(prepared.model);
  const Function right = Right(material);
  const double e = model.albedo.lobe.e_average;
  const TableCheck check = CheckOf(material, [&](const Vec3d& l, const Vec3d& v) {
    const double losses = AlbedoLoss(model.albedo.lobe, l.z) * AlbedoLoss(model.albedo.lobe, v.z);
    return right(l, v) + MakeRgb([&](int c) {
             // Kulla and Conty 2017: F^2 E / (1 - F (1 - E)) by F0 and by the average of F.
             const double f0 = model.metal_f0[c], average = f0 + (1 - f0) / 21;
             const auto color = [&](double f) { return f * f * e / (1 - f * (1 - e)); };
             return (color(f0) - color(average)) * losses / (M_PI * (1 - e));
           });
  });
  CHECK_FALSE(check.ok);
  CHECK(IsExplainedBy(check, "F0 for the average"));
}

TEST_CASE("the view's cosine both ways is recognised") {
  const Material material = FullOpenPbr();
  const ShadingMaterial prepared = PrepareMaterial(material);
  const ShadingMaterial& coat = *prepared.coats[0];
  const TableCheck check = CheckOf(material, [&](const Vec3d& l, const Vec3d& v) {
    Rgb sum(0, 0, 0);
    for (const StackLevel& level : ReflectByLevel(prepared, Vec3d(0, 0, 1), l, v)) {
      const Rgb below = level.name == "coat" ? TransmittedByCoat(coat, v.z, v.z) : level.below;
      sum = sum * below + level.own.Sum() / l.z;
    }
    return sum;
  });
  CHECK_FALSE(check.ok);
  CHECK(IsExplainedBy(check, "the view's cosine is taken for the light's"));
}

TEST_CASE("every hypothesis is recognised as itself, or as one that leaves as little") {
  MetallicRoughnessMaterial cloth;
  cloth.base_color = Rgb(0.6, 0.3, 0.2);
  cloth.metallic = 0.3;
  cloth.roughness = 0.45;
  cloth.specular = 0.7;
  cloth.dielectric_f0 = Rgb(0.05, 0.06, 0.08);
  cloth.coat = 0.6;
  cloth.coat_roughness = 0.3;
  cloth.sheen_color = Rgb(0.5, 0.3, 0.1);
  cloth.sheen_roughness = 0.4;
  const Material materials[] = {
      FullOpenPbr(),
      {.model = cloth},
      {.model = PhongMaterial{
           .color = {0.5, 0.6, 0.7}, .kd = Rgb(0.5), .ks = Rgb(0.2), .shininess = 40}}};
  const std::vector<DirectionPair> pairs =
      PairsOf({{10, 40, 70, 85}, {0, 35, 60, 80}, {0, 100, 180}, 30});
  for (const Material& material : materials) {
    // Some of them, for time: each is judged beside all others.
    const std::vector<Hypothesis> hypotheses = HypothesesOf(material);
    for (size_t i = static_cast<size_t>(&material - materials); i < hypotheses.size(); i += 6) {
      const Hypothesis& hypothesis = hypotheses[i];
      Variant variant{.material = material};
      hypothesis.apply(&variant);
      const PreparedVariant wrong(variant);
      const Function f = [&](const Vec3d& l, const Vec3d& v) { return wrong.Evaluate(l, v); };
      const TableCheck check = CheckTable(material, TableOf(f, pairs), "theirs", 1e-3);
      if (check.ok) continue;  // no difference that counts
      CAPTURE(hypothesis.text, PageOf(check));
      CHECK(IsExplainedBy(check, hypothesis.text));
    }
  }
}

TEST_CASE("nothing is made up for what no mistake explains") {
  const Material material = PlasticOpenPbr();
  const Function right = Right(material);
  std::mt19937 random(1);
  std::uniform_real_distribution<double> factor(0.5, 2);
  const TableCheck noise = CheckOf(
      material, [&](const Vec3d& l, const Vec3d& v) { return right(l, v) * factor(random); });
  CHECK_FALSE(noise.ok);
  CHECK(noise.explanation.empty());
  CHECK(PageOf(noise).find("no mistake that is known explains it") != std::string::npos);
  // What is turned below the surface, in one of several ways, or was not evaluated.
  const TableCheck zeros = CheckOf(material, [](const Vec3d&, const Vec3d&) { return Rgb(0); });
  CHECK_FALSE(zeros.ok);
  CHECK(PageOf(zeros).find("f is 0 in all rows") != std::string::npos);
}

TEST_CASE("values that are not finite are found and named, and the rest is judged") {
  const Material material = PlasticOpenPbr();
  BrdfTable table = TableOf(Right(material));
  table.values[9 * 7 + 6] = std::nan("");
  table.values[9 * 12 + 8] = -HUGE_VAL;
  const TableCheck check = CheckTable(material, table, "theirs", 1e-3);
  CHECK_FALSE(check.ok);
  CHECK(check.not_finite == 2);
  CHECK(check.not_finite_at == std::vector<std::string>{"row 8", "row 13"});
  CHECK(check.f.largest < 1e-13);
  CHECK(PageOf(check).find("row 8, row 13") != std::string::npos);
  // All of them, and huge ones.
  for (size_t i = 6; i < table.values.size(); i += 9) table.values[i] = std::nan("");
  CHECK(CheckTable(material, table, "theirs", 1e-3).f.rows == 0);
  for (size_t i = 6; i < table.values.size(); i += 9) table.values[i] = 1e308;
  const TableCheck huge = CheckTable(material, table, "theirs", 1e-3);
  CHECK_FALSE(huge.ok);
  CHECK_FALSE(PageOf(huge).empty());
}

TEST_CASE("parts are compared, and headers of other materials are noticed") {
  const Material material = FullOpenPbr();
  BrdfTable own = TabulateBrdf(material, PairsOf({{20, 50}, {10, 70}, {0, 120}, 30}));
  const TableCheck same = CheckTable(material, own, "own", 1e-3);
  CHECK(same.ok);
  CHECK(same.notes.empty());
  REQUIRE(same.parts.size() == 6);  // four lobes, pdf and albedo
  for (const PartErrors& part : same.parts) CHECK(part.largest < 1e-12);
  // Another albedo, and lobes that do not sum to f.
  for (size_t row = 0; row < own.rows(); ++row) {
    own.values[row * own.columns.size() + own.columns.size() - 1] *= 1.1;
    own.values[row * own.columns.size() + 9] *= 2;
  }
  const TableCheck other = CheckTable(material, own, "own", 1e-3);
  CHECK(other.ok);
  CHECK(other.parts[0].largest == Approx(0.5));
  CHECK(other.parts[5].name == "albedo");
  CHECK(other.parts[5].largest == Approx(1 - 1 / 1.1));
  REQUIRE(other.notes.size() == 1);
  CHECK(other.notes[0].find("do not sum to its f") != std::string::npos);
  const TableCheck mixed_up =
      CheckTable(With(material, [](OpenPbrMaterial* m) { m->coat_ior = 1.7; }), own, "own", 1e-3);
  CHECK(mixed_up.notes[0].find("another material: coat_ior 1.45, here 1.7") != std::string::npos);
}

TEST_CASE("long tables are diagnosed by some of their rows") {
  const Material material = PlasticOpenPbr();
  DirectionGrid grid;
  grid.phi_deg.clear();
  for (int i = 0; i < 60; ++i) grid.phi_deg.push_back(3.0 * i);
  const Function right = Right(material);
  const TableCheck check = CheckTable(
      material,
      TableOf([&](const Vec3d& l, const Vec3d& v) { return right(l, v) * M_PI; }, PairsOf(grid)),
      "theirs", 1e-3);
  CHECK(check.rows > kDiagnosedRows);
  CHECK(check.diagnosed_rows == kDiagnosedRows);
  CHECK(IsExplainedBy(check, "times pi"));
  const Json json = CheckJson(check);
  CHECK(json["explanation"].size() == 1);
  CHECK(json["angles"]["errors"].size() == 8);
}

}  // namespace nacre
