// SPDX-License-Identifier: Apache-2.0
// study/study_fresnel.cc: exercise 5: Schlick's curve, the exact one, and the angles at which half
// is reflected.
#include <cmath>

#include <fmt/format.h>

#include "brdf/fresnel.h"
#include "brdf/presets.h"
#include "study/measures.h"
#include "study/picture.h"
#include "study/study.h"

namespace nacre {

namespace {

FresnelAngle AngleOf(double cosine) { return {cosine, std::acos(cosine) * 180 / M_PI}; }

}  // namespace

FresnelAngle SchlickAngle(double f0, double reflectance) {
  return AngleOf(1 - std::pow((reflectance - f0) / (1 - f0), 0.2));
}

FresnelAngle DielectricAngle(double eta, double reflectance) {
  double low = 0;
  double high = 1;
  for (int i = 0; i < 60; ++i) {
    const double middle = (low + high) / 2;
    (FresnelDielectric(middle, 1 - middle, eta) > reflectance ? low : high) = middle;
  }
  return AngleOf(low);
}

FresnelGap LargestSchlickError(double eta, double k) {
  constexpr int kSteps = 2000;
  const double f0 = FresnelF0(eta, k);
  FresnelGap gap;
  for (int i = 0; i <= kSteps; ++i) {
    const double cosine = static_cast<double>(i) / kSteps;
    const double exact = k > 0 ? FresnelConductor(cosine, 1 - cosine, eta, k)
                               : FresnelDielectric(cosine, 1 - cosine, eta);
    const double difference = std::abs(FresnelSchlick(f0, Power5(1 - cosine)) - exact);
    if (difference > gap.difference) gap = {difference, cosine};
  }
  return gap;
}

namespace {

template <class Function>
Curve CurveOver(const std::string& title, bool degrees, const Function& f) {
  Curve curve;
  curve.title = title;
  for (int i = 0; i <= 600; ++i) {
    const double t = i / 600.0;
    const double cosine = degrees ? std::cos(t * M_PI / 2) : t;
    curve.x.push_back(degrees ? 90 * t : t);
    curve.y.push_back(f(cosine));
  }
  return curve;
}

Plot CurvePlot(bool degrees) {
  Plot plot;
  plot.title = degrees ? "over the angle" : "over its cosine";
  plot.x = degrees ? Axis{.label = "angle of incidence (degrees)", .low = 0, .high = 90, .step = 15}
                   : Axis{.label = "cosine of the angle of incidence", .low = 0, .high = 1};
  plot.y = {.label = "reflectance (1: all)", .low = 0, .high = 1};
  const auto schlick = [](double f0) {
    return [f0](double cosine) { return FresnelSchlick(f0, Power5(1 - cosine)); };
  };
  plot.curves = {
      CurveOver("Schlick, F0 = 0.04", degrees, schlick(0.04)),
      CurveOver("exact, index 1.5", degrees,
                [](double cosine) { return FresnelDielectric(cosine, 1 - cosine, 1.5); }),
      CurveOver("Schlick, F0 = 0.9", degrees, schlick(0.9)),
  };
  const FresnelAngle half = SchlickAngle(0.04, 0.5);
  plot.rules = {
      {Rule::Across::kY, 0.5, "half"},
      {Rule::Across::kX, degrees ? half.degrees : half.cosine,
       degrees ? fmt::format("{:.3f}°", half.degrees) : fmt::format("{:.6f}", half.cosine)}};
  return plot;
}

// A mirror under a uniform radiance of 1, so that it shows its reflectance.
Rgb8Picture MirrorPane(const MaterialKind& material) {
  const Light white{.name = "white",
                    .kind = EnvironmentLight{.sky = ConstantSky{Rgb(1)}, .background = false}};
  return ShowImage(RenderLayers(SphereScene(material, 240, {white})), kClipped);
}

StudyPicture Mirrors() {
  PaneSheet sheet;
  const DielectricMaterial schlick{
      .base_color = Rgb(0), .roughness = 0, .fresnel = DielectricFresnel::kSchlick};
  const DielectricMaterial exact{.base_color = Rgb(0), .roughness = 0};
  const auto metal = [](const char* name) {
    const IndexPreset& preset = *FindIndexPreset(name);
    return ConductorMaterial{.eta = Rgb(preset.eta[0], preset.eta[1], preset.eta[2]),
                             .k = Rgb(preset.k[0], preset.k[1], preset.k[2]),
                             .roughness = 0};
  };
  sheet.panes = {MirrorPane(schlick), MirrorPane(exact), MirrorPane(metal("iron")),
                 MirrorPane(metal("gold"))};
  sheet.columns = {"glass, Schlick", "glass, exact", "iron", "gold"};
  return MakeStudyPicture(
      "mirrors", "Black glass and metals under equal light from everywhere: what is seen is F.",
      sheet);
}

// A table of the largest errors of Schlick's curve, for each preset's green.
std::string GapTable(StudyResult* result) {
  std::string table =
      "| interface | F0 | largest error of Schlick's curve | at |\n|---|---|---|---|\n";
  for (const IndexPreset& preset : IndexPresets()) {
    const FresnelGap gap = LargestSchlickError(preset.eta[1], preset.k[1]);
    const double degrees = std::acos(gap.cosine) * 180 / M_PI;
    table += fmt::format("| {} | {:.4f} | {:.4f} | {:.1f}° |\n", preset.name,
                         FresnelF0(preset.eta[1], preset.k[1]), gap.difference, degrees);
    result->numbers.push_back(
        {fmt::format("largest error of Schlick's curve, {}", preset.name), gap.difference, ""});
  }
  return table;
}

}  // namespace

StudyResult StudyFresnel(const StudyProgress& progress) {
  StudyResult result;
  const FresnelAngle schlick = SchlickAngle(0.04, 0.5);
  const FresnelAngle exact = DielectricAngle(1.5, 0.5);
  result.numbers = {{"Schlick, F0 = 0.04, reaches 0.5 at cosine", schlick.cosine, ""},
                    {"the angle", schlick.degrees, "deg"},
                    {"exact, index 1.5, reaches 0.5 at cosine", exact.cosine, ""},
                    {"the angle", exact.degrees, "deg"}};
  result.figures.push_back({"fresnel", "Schlick's curve and the exact one.",
                            MakeRow({CurvePlot(false), CurvePlot(true)})});
  result.pictures.push_back(Mirrors());
  progress(0.8);
  const std::string table = GapTable(&result);
  result.answer = fmt::format(
      "At {:.3f}° by Schlick's curve (its cosine is 1 - (0.46 / 0.96)^(1/5) = {:.6f}); by "
      "Fresnel's own equations for the index 1.5 at {:.3f}° (cosine {:.6f}). A metal of F0 = 0.9 "
      "reflects more than that at every angle. Nearly all of the change lies beyond 60°, which is "
      "the rim of a sphere.\n\n{}",
      schlick.degrees, schlick.cosine, exact.degrees, exact.cosine, table);
  progress(1);
  return result;
}

}  // namespace nacre
