// SPDX-License-Identifier: Apache-2.0
// study/study_layers.cc: how far OpenPBR's rules for layers are from light that is followed between
// the layers.
#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <span>

#include <fmt/format.h>

#include "base/parallel.h"
#include "brdf/microsurface_walk.h"
#include "report/plot.h"
#include "sampling/hash.h"
#include "scene/open_pbr.h"
#include "shading/open_pbr.h"
#include "shading/share.h"
#include "study/layer_walk.h"
#include "study/measures.h"
#include "study/picture.h"
#include "study/study.h"

namespace nacre {
namespace {

// A rule for layers: what it sets of the options.
struct LayerRule {
  const char* name;
  OpenPbrOptions options;
};

struct LayerBase {
  const char* name;
  OpenPbrMaterial material;
  InsideColor color = InsideColor::kAlbedo;
};

std::vector<LayerBase> LayerBases() {
  const OpenPbrMaterial glossy{.base_color = Rgb(0.8), .specular_roughness = 0.3};
  const auto metal = [](double roughness) {
    return OpenPbrMaterial{
        .base_color = Rgb(0.9), .base_metalness = 1, .specular_roughness = roughness};
  };
  return {{"diffuse", {.base_color = Rgb(0.8), .specular_weight = 0}},
          {"glossy", glossy, InsideColor::kAlbedo},
          {"glossy, colour as seen bare", glossy, InsideColor::kSeenBare},
          {"smooth metal", metal(0)},
          {"rough metal", metal(0.6)}};
}

double Radians(double degrees) { return degrees * M_PI / 180; }

// ---- Energy: reflected shares over the angle and a roughness
// -------------------------------------

// A map of errors has a row for each roughness, and a column for each angle.
std::vector<double> RoughnessesOf(const LayerEffort& effort) {
  return Steps(0, 1, effort.roughnesses - 1);
}
std::vector<double> AnglesOf(const LayerEffort& effort) { return Steps(5, 85, effort.angles - 1); }

// By how much each rule's share of reflected light differs from the truth, row by row.
struct LayerErrors {
  std::vector<std::vector<double>> by_rule;

  double Rms(size_t rule) const { return RmsOf(by_rule[rule]); }
  // Of the first row alone, that of roughness 0.
  double RmsOfSmooth(size_t rule, size_t angles) const {
    return RmsOf(std::span(by_rule[rule]).first(angles));
  }
  static double RmsOf(std::span<const double> errors) {
    return std::sqrt(std::inner_product(errors.begin(), errors.end(), errors.begin(), 0.0) /
                     static_cast<double>(errors.size()));
  }
  double Largest(size_t rule) const {
    const auto [least, greatest] = std::ranges::minmax(by_rule[rule]);
    return std::max(-least, greatest);
  }
};

// `surface_of(roughness)` is the surface of a row, without its rules.
LayerErrors MeasureLayers(const std::vector<LayerRule>& rules, InsideColor color,
                          const LayerEffort& effort,
                          const std::function<OpenPbrMaterial(double)>& surface_of) {
  const std::vector<double> roughnesses = RoughnessesOf(effort), angles = AnglesOf(effort);
  LayerErrors errors;
  errors.by_rule.assign(rules.size(), std::vector<double>(roughnesses.size() * angles.size()));
  ParallelFor(roughnesses.size(), 0, [&](size_t row) {
    OpenPbrMaterial surface = surface_of(roughnesses[row]);
    const Rgb inside = InsideAlbedo(surface, color);
    std::vector<double> truth;
    for (size_t i = 0; i < angles.size(); ++i) {
      const uint64_t seed = HashCombine(row, i);
      truth.push_back(
          WalkedShare(surface, inside, std::cos(Radians(angles[i])), effort.walks, seed).x);
    }
    for (size_t k = 0; k < rules.size(); ++k) {
      surface.options = rules[k].options;
      const ShadingMaterial prepared = PrepareMaterial(MaterialOf(surface));
      for (size_t i = 0; i < angles.size(); ++i) {
        const double cosine = std::cos(Radians(angles[i]));
        errors.by_rule[k][row * angles.size() + i] =
            ReflectedShare(prepared, ShareOf::kFurnace, cosine).x - truth[i];
      }
    }
  });
  return errors;
}

Plot ErrorMap(const std::string& title, const std::string& roughness_of, const LayerEffort& effort,
              const std::vector<double>& errors) {
  Plot plot;
  plot.title = title;
  plot.x = {.label = "angle (degrees)", .low = 0, .high = 90, .step = 30};
  plot.y = {.label = "roughness of the " + roughness_of, .low = -0.1, .high = 1.1, .step = 0.5};
  Field field{
      .label = "error of the share", .x = {}, .y = {}, .values = {}, .low = 1e-3, .high = 1};
  for (const double roughness : RoughnessesOf(effort)) {
    for (const double angle : AnglesOf(effort)) {
      field.x.push_back(angle);
      field.y.push_back(roughness);
      field.values.push_back(std::abs(errors[field.values.size()]));
    }
  }
  plot.field = std::move(field);
  return plot;
}

std::vector<LayerRule> RulesOfBundles() {
  return {{"spec_1_1", OptionsOf(OpenPbrRules::kSpec11)},
          {"spec_1_2", OptionsOf(OpenPbrRules::kSpec12)},
          {"materialx", OptionsOf(OpenPbrRules::kMaterialX)},
          {"adobe", OptionsOf(OpenPbrRules::kAdobe)}};
}

std::vector<LayerRule> DarkeningRules() {
  return {{"spec", {.coat_darkening_rule = CoatDarkening::kSpec}},
          {"spec12", {.coat_darkening_rule = CoatDarkening::kSpec12}},
          {"materialx", {.coat_darkening_rule = CoatDarkening::kMaterialX}},
          {"adobe", {.coat_darkening_rule = CoatDarkening::kAdobe}}};
}

std::vector<LayerRule> PartialRules() {
  std::vector<LayerRule> rules;
  for (const auto& [name, partial] :
       {std::pair{"exponent_then_lerp", CoatPartial::kExponentThenLerp},
        std::pair{"lerp_then_exponent", CoatPartial::kLerpThenExponent},
        std::pair{"per_crossing", CoatPartial::kPerCrossing},
        std::pair{"whole_product", CoatPartial::kWholeProduct}}) {
    rules.push_back({name, {.coat_partial = partial}});
  }
  return rules;
}

std::vector<LayerRule> LayeringRules() {
  return {{"view", {.layering = Layering::kView}},
          {"reciprocal", {.layering = Layering::kReciprocal}}};
}

// Rules from the nearest to the furthest: "a (0.01), b (0.02)".
std::string Ranking(const std::vector<LayerRule>& rules, const std::vector<double>& errors) {
  std::vector<size_t> order(rules.size());
  std::iota(order.begin(), order.end(), size_t{0});
  std::ranges::stable_sort(order, {}, [&](size_t k) { return errors[k]; });
  std::string text;
  for (const size_t k : order) {
    text += fmt::format("{}{} ({:.3f})", text.empty() ? "" : ", ", rules[k].name, errors[k]);
  }
  return text;
}

// What a group of rules was measured on: adds its numbers and maps, and returns a paragraph.
struct LayerTrial {
  std::string name, what;  // of the figure and of its numbers
  std::vector<LayerRule> rules;
  std::string roughness_of;
};

constexpr int kPanelWidth = 620, kPanelHeight = 480;

std::string TryRules(
    const LayerTrial& trial, const std::vector<LayerBase>& bases, const LayerEffort& effort,
    const std::function<OpenPbrMaterial(const OpenPbrMaterial&, double)>& surface_of,
    StudyResult* result) {
  Figure figure;
  figure.columns = static_cast<int>(trial.rules.size());
  figure.width = kPanelWidth * figure.columns;
  figure.height = kPanelHeight * static_cast<int>(bases.size());
  figure.title = trial.what;
  std::string text;
  for (const LayerBase& base : bases) {
    const LayerErrors errors =
        MeasureLayers(trial.rules, base.color, effort,
                      [&](double roughness) { return surface_of(base.material, roughness); });
    std::vector<double> rms, of_smooth;
    for (size_t k = 0; k < trial.rules.size(); ++k) {
      figure.panels.push_back(ErrorMap(fmt::format("{}: {}", base.name, trial.rules[k].name),
                                       trial.roughness_of, effort, errors.by_rule[k]));
      rms.push_back(errors.Rms(k));
      of_smooth.push_back(errors.RmsOfSmooth(k, static_cast<size_t>(effort.angles)));
      const std::string quantity =
          fmt::format("{}, {}, {}", trial.what, base.name, trial.rules[k].name);
      result->numbers.push_back({quantity + ": rms error of the reflected share", rms.back(), ""});
      result->numbers.push_back({quantity + ": rms error at roughness 0", of_smooth.back(), ""});
      result->numbers.push_back({quantity + ": largest error", errors.Largest(k), ""});
    }
    text += fmt::format("- {}: {}. At roughness 0: {}\n", base.name, Ranking(trial.rules, rms),
                        Ranking(trial.rules, of_smooth));
  }
  result->figures.push_back(
      {trial.name, "Dark: near to light that is followed between the layers.", std::move(figure)});
  return text;
}

// ---- Roughening: the width of highlights below a coat
// --------------------------------------------

constexpr double kLobeAngleDeg = 30;

// How much light leaves at each tilt of the half vector from the normal. The root of the tilt's
// tangent is about the roughness of a GGX lobe that is so wide.
using TiltHistogram = std::vector<double>;
constexpr size_t kTiltBins = 64;
constexpr double kWidestTilt = 2;

void AddTilt(const Vec3d& from, const Vec3d& to, TiltHistogram* histogram) {
  const Vec3d half = (from + to).normalized();
  const double root = std::sqrt(std::hypot(half.x, half.y) / half.z);
  const double bin = std::min(root / kWidestTilt, 1.0) * (kTiltBins - 1);
  (*histogram)[static_cast<size_t>(bin)] += 1;
}

// The fraction of light that one histogram has elsewhere than the other, from 0 to 1.
double TiltDistance(const TiltHistogram& a, const TiltHistogram& b) {
  const double sum_a = std::accumulate(a.begin(), a.end(), 0.0);
  const double sum_b = std::accumulate(b.begin(), b.end(), 0.0);
  double distance = 0;
  for (size_t i = 0; i < kTiltBins; ++i) distance += std::abs(a[i] / sum_a - b[i] / sum_b) / 2;
  return distance;
}

Vec3d LobeView() { return {std::sin(Radians(kLobeAngleDeg)), 0, std::cos(Radians(kLobeAngleDeg))}; }

// The lobe of a white metal of this roughness, seen through nothing.
TiltHistogram BareLobe(double roughness, int walks) {
  TiltHistogram histogram(kTiltBins);
  WalkRandom random(2);
  double weight = 1;
  for (int i = 0; i < walks; ++i) {
    const Vec3d to = WalkOpaque(
        -LobeView(), AlphaFromRoughness(roughness), [](double) { return 1.0; }, random, &weight);
    AddTilt(LobeView(), to, &histogram);
  }
  return histogram;
}

// The same below a coat, without what the coat itself reflects.
TiltHistogram CoatedLobe(const OpenPbrMaterial& surface, int walks, uint64_t seed) {
  TiltHistogram histogram(kTiltBins);
  WalkRandom random(seed);
  for (int i = 0; i < walks; ++i) {
    const LayerExit exit = WalkLayers(surface, Rgb(0), LobeView(), &random);
    if (exit.from_base) AddTilt(LobeView(), exit.direction, &histogram);
  }
  return histogram;
}

std::vector<LayerRule> RougheningRules() {
  return {{"spec", {.coat_roughening = CoatRoughening::kSpec}},
          {"adobe", {.coat_roughening = CoatRoughening::kAdobe}},
          {"fit261", {.coat_roughening = CoatRoughening::kFit261}},
          {"none", {.coat_roughening = CoatRoughening::kNone}}};
}

std::string TryRoughening(const LayerEffort& effort, StudyResult* result) {
  constexpr int kCandidates = 50;
  std::vector<TiltHistogram> bare(kCandidates + 1);
  ParallelFor(bare.size(), 0, [&](size_t i) {
    bare[i] = BareLobe(static_cast<double>(i) / kCandidates, 2 * effort.walks);
  });
  struct Cell {
    double r, c, seen;
    std::vector<double> by_rule, distance;
  };
  std::vector<Cell> cells;
  for (const double c : RoughnessesOf(effort)) {
    for (const double r : RoughnessesOf(effort)) cells.push_back({r, c, 0, {}, {}});
  }
  const std::vector<LayerRule> rules = RougheningRules();
  ParallelFor(cells.size(), 0, [&](size_t i) {
    Cell& cell = cells[i];
    OpenPbrMaterial surface{.base_color = Rgb(1),
                            .base_metalness = 1,
                            .specular_roughness = cell.r,
                            .coat_weight = 1,
                            .coat_roughness = cell.c};
    const TiltHistogram truth = CoatedLobe(surface, 2 * effort.walks, HashCombine(3, i));
    const auto distance = [&](const TiltHistogram& lobe) { return TiltDistance(truth, lobe); };
    const auto nearest = std::ranges::min_element(bare, {}, distance);
    cell.seen = static_cast<double>(nearest - bare.begin()) / kCandidates;
    for (const LayerRule& rule : rules) {
      surface.options = rule.options;
      const double roughness = RoughnessBelowCoat(surface);
      cell.by_rule.push_back(roughness);
      cell.distance.push_back(
          distance(bare[static_cast<size_t>(std::lround(roughness * kCandidates))]));
    }
  });
  const auto map = [&](const std::string& title, const std::string& label, double low,
                       const std::function<double(const Cell&)>& value) {
    Plot plot;
    plot.title = title;
    plot.x = {.label = "roughness of the base", .low = -0.1, .high = 1.1, .step = 0.5};
    plot.y = {.label = "roughness of the coat", .low = -0.1, .high = 1.1, .step = 0.5};
    Field field{.label = label, .x = {}, .y = {}, .values = {}, .low = low, .high = 1};
    for (const Cell& cell : cells) {
      field.x.push_back(cell.r);
      field.y.push_back(cell.c);
      field.values.push_back(value(cell));
    }
    plot.field = std::move(field);
    return plot;
  };
  Figure figure;
  figure.columns = 3;
  figure.width = 3 * kPanelWidth;
  figure.height = 2 * kPanelHeight;
  figure.title = "highlights of a metal below a coat of index 1.6";
  figure.panels.push_back(
      map("followed light", "roughness that is seen", 0.01, [](const Cell& c) { return c.seen; }));
  std::vector<double> errors;
  for (size_t k = 0; k < rules.size(); ++k) {
    figure.panels.push_back(map(rules[k].name, "error of the roughness", 0.01,
                                [&](const Cell& c) { return std::abs(c.by_rule[k] - c.seen); }));
    const auto mean = [&](const std::function<double(const Cell&)>& value) {
      double sum = 0;
      for (const Cell& cell : cells) sum += value(cell);
      return sum / static_cast<double>(cells.size());
    };
    const std::string name = fmt::format("highlights below a coat, {}", rules[k].name);
    errors.push_back(mean([&](const Cell& c) { return std::abs(c.by_rule[k] - c.seen); }));
    result->numbers.push_back({name + ": mean error of the roughness", errors.back(), ""});
    result->numbers.push_back({name + ": mean fraction of light elsewhere",
                               mean([&](const Cell& c) { return c.distance[k]; }), ""});
  }
  result->figures.push_back(
      {"roughening",
       "Light from 30 degrees. The roughness that is seen is that of the bare metal "
       "whose half vectors are distributed most alike.",
       std::move(figure)});
  return Ranking(rules, errors);
}

}  // namespace

StudyResult StudyLayers(const StudyProgress& progress) { return StudyLayers({}, progress); }

StudyResult StudyLayers(const LayerEffort& effort, const StudyProgress& progress) {
  StudyResult result;
  const std::vector<LayerBase> bases = LayerBases();
  const auto coated = [](const OpenPbrMaterial& base, double roughness) {
    OpenPbrMaterial surface = base;
    surface.coat_weight = 1;
    surface.coat_roughness = roughness;
    return surface;
  };
  const std::string by_bundle =
      TryRules({"rules", "a clear coat, by sets of rules", RulesOfBundles(), "coat"}, bases, effort,
               coated, &result);
  progress(0.3);
  const std::string by_darkening =
      TryRules({"darkening", "a clear coat, by darkening", DarkeningRules(), "coat"}, bases, effort,
               coated, &result);
  progress(0.5);
  const std::string by_partial = TryRules(
      {"partial", "half a grey coat, by its partial weight", PartialRules(), "coat"}, bases, effort,
      [&](const OpenPbrMaterial& base, double roughness) {
        OpenPbrMaterial surface = coated(base, roughness);
        surface.coat_weight = 0.5;
        surface.coat_color = Rgb(0.3);
        return surface;
      },
      &result);
  progress(0.7);
  const std::string by_layering = TryRules(
      {"layering", "a dielectric over its diffuse inside", LayeringRules(), "dielectric"},
      {bases[1], bases[2]}, effort,
      [](const OpenPbrMaterial& base, double roughness) {
        OpenPbrMaterial surface = base;
        surface.specular_roughness = roughness;
        return surface;
      },
      &result);
  progress(0.8);
  const std::string by_roughening = TryRoughening(effort, &result);
  result.answer = fmt::format(
      "The truth is light that is followed from layer to layer, and at rough interfaces from "
      "microfacet to microfacet (Heitz et al. 2016), {} times at each angle and roughness, so that "
      "a "
      "share is known within {:.4f} (one standard deviation at most).\n\n"
      "The bases: *diffuse* is Lambertian, of albedo 0.8, without an interface of its own. "
      "*Glossy* "
      "is a dielectric of roughness 0.3 over a diffuse inside of albedo 0.8. *Glossy, colour as "
      "seen bare* has a lighter inside, which looks as 0.8 through its interface, as OpenPBR's "
      "bare "
      "base does. The *metals* reflect 0.9 along the normal, with roughness 0 and 0.6. Coats have "
      "the index 1.6, dielectrics 1.5. Errors are rms differences of the share of light that is "
      "reflected, over angles of 5 to 85 degrees and over the roughness of the coat, or of the "
      "dielectric where there is no coat, from 0 to 1. The nearest rule comes first.\n\n"
      "**Sets of rules**, clear coat of weight 1 (where spec_1_2 absorbs nothing, it is "
      "spec_1_1):\n\n{}\n"
      "No rule can be right for both glossy bases. OpenPBR's bare base is the second: its "
      "interface "
      "darkens nothing. Its rules for coats darken it as if it were the first.\n\n"
      "**Darkening** (`coat_darkening_rule`), all else as spec_1_1:\n\n{}\n"
      "**Partial coats** (`coat_partial`), weight 0.5, colour 0.3:\n\n{}\n"
      "**Scaling by albedo itself** (`layering`), without a coat:\n\n{}\n"
      "**Roughening** (`coat_roughening`), mean error of the roughness of a white metal's "
      "highlight, "
      "over roughnesses of metal and coat from 0 to 1: {}.\n",
      effort.walks, 0.5 / std::sqrt(effort.walks), by_bundle, by_darkening, by_partial, by_layering,
      by_roughening);
  progress(1);
  return result;
}

}  // namespace nacre
