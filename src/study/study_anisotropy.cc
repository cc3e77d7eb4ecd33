// SPDX-License-Identifier: Apache-2.0
// study/study_anisotropy.cc: what formats mean by anisotropy, and what it does to highlights and to
// energy.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "brdf/ggx_anisotropic.h"
#include "report/plot.h"
#include "shading/share.h"
#include "study/picture.h"
#include "study/study.h"

namespace nacre {
namespace {

struct AlphaMapping {
  const char* name;
  GgxAlphas<double> (*alphas)(double roughness, double anisotropy);
};

constexpr AlphaMapping kMappings[] = {
    {"OpenPBR", [](double r, double a) { return OpenPbrAlphas(r, a, AlphaLimit::kNone); }},
    {"glTF", [](double r, double a) { return GltfAlphas(r, a); }},
    {"Standard Surface",
     [](double r, double a) { return StandardSurfaceAlphas(r, a, AlphaLimit::kNone); }},
    {"Disney, Cycles", [](double r, double a) { return DisneyAlphas(r, a); }},
};

constexpr double kMiddleRoughness = 0.5;

Plot AlphaPlot(const char* title, double GgxAlphas<double>::*alpha) {
  Plot plot;
  plot.title = title;
  plot.x = {.label = "anisotropy", .low = 0, .high = 1, .step = 0.25};
  plot.y = {.label = "alpha", .low = 0, .high = 1, .step = 0.25};
  for (const AlphaMapping& mapping : kMappings) {
    plot.curves.push_back(MakeCurve(mapping.name, Steps(0, 1, 100), [&](double anisotropy) {
      return mapping.alphas(kMiddleRoughness, anisotropy).*alpha;
    }));
  }
  return plot;
}

OpenPbrMaterial Brushed(double roughness, double anisotropy) {
  OpenPbrMaterial metal{.base_color = Rgb(0.95, 0.79, 0.55), .base_metalness = 1};
  metal.specular_roughness = roughness;
  metal.specular_roughness_anisotropy = anisotropy;
  return metal;
}

StudyPicture BrushedSpheres(const StudyProgress& progress) {
  PaneSheet sheet;
  const double roughnesses[] = {0.2, 0.4, 0.6}, anisotropies[] = {0, 0.3, 0.6, 0.9, 1};
  for (const double anisotropy : anisotropies) {
    sheet.columns.push_back(fmt::format("anisotropy {}", anisotropy));
  }
  const std::vector<Light> lights = {
      SunTowards(Vec3d(0.4, 0.7, 1).normalized(), Rgb(2)),
      {.name = "sky",
       .kind = EnvironmentLight{
           .sky =
               GradientSky{.zenith = Rgb(0.25, 0.4, 0.7), .horizon = Rgb(0.7), .ground = Rgb(0.08)},
           .background = false}}};
  for (const double roughness : roughnesses) {
    sheet.rows.push_back(fmt::format("roughness {}", roughness));
    for (const double anisotropy : anisotropies) {
      Scene scene = SphereScene(Brushed(roughness, anisotropy), 160, lights);
      scene.image.spp = 64;
      sheet.panes.push_back(ShowImage(RenderLayers(scene), {.tone = ToneOperator::kNeutral}));
      progress(0.5 * static_cast<double>(sheet.panes.size()) / 15);
    }
  }
  return MakeStudyPicture("brushed",
                          "OpenPBR's brushed metal, its tangents along the parallels: highlights "
                          "are long across the scratches, and keep their mean slope.",
                          sheet);
}

// The largest difference from 1 of what a white metal reflects, over angles and azimuths.
double WorstLoss(double roughness, double anisotropy, Compensation compensation) {
  OpenPbrMaterial metal = Brushed(roughness, anisotropy);
  metal.base_color = Rgb(1);
  metal.options.compensation = compensation;
  const ShadingMaterial prepared = PrepareMaterial(MaterialOf(metal));
  double worst = 0;
  for (const double cosine : {0.05, 0.3, 0.7, 1.0}) {
    for (const double azimuth : {0.0, M_PI / 4, M_PI / 2}) {
      const double share = ReflectedShare(prepared, ShareOf::kFurnace, cosine, azimuth).x;
      worst = std::max(worst, std::abs(share - 1));
    }
  }
  return worst;
}

}  // namespace

StudyResult StudyAnisotropy(const StudyProgress& progress) {
  StudyResult result;
  result.pictures.push_back(BrushedSpheres(progress));
  result.figures.push_back({"alphas", fmt::format("Roughness {}.", kMiddleRoughness),
                            MakeRow({AlphaPlot("along the tangent", &GgxAlphas<double>::x),
                                     AlphaPlot("across the tangent", &GgxAlphas<double>::y)})});
  std::string halves, beyond, losses;
  for (const AlphaMapping& mapping : kMappings) {
    const GgxAlphas<double> alpha = mapping.alphas(kMiddleRoughness, 0.5);
    const std::string name =
        fmt::format("{}, roughness {}, anisotropy 0.5", mapping.name, kMiddleRoughness);
    result.numbers.push_back({name + ": alpha along the tangent", alpha.x, ""});
    result.numbers.push_back({name + ": alpha across the tangent", alpha.y, ""});
    halves += fmt::format("{}{} {:.3f} and {:.3f}", halves.empty() ? "" : ", ", mapping.name,
                          alpha.x, alpha.y);
  }
  for (const double anisotropy : {0.25, 0.5, 0.75, 1.0}) {
    // alpha.x is proportional to roughness^2.
    const double limit = 1 / std::sqrt(OpenPbrAlphas(1.0, anisotropy, AlphaLimit::kNone).x);
    result.numbers.push_back(
        {fmt::format("OpenPBR, anisotropy {}: roughness above which alpha exceeds 1", anisotropy),
         limit, ""});
    beyond += fmt::format("{}{:.2f} at {}", beyond.empty() ? "" : ", ", limit, anisotropy);
  }
  progress(0.6);
  for (const double roughness : {0.3, 0.6, 0.9}) {
    const double isotropic = WorstLoss(roughness, 0, Compensation::kNone);
    const double none = WorstLoss(roughness, 0.8, Compensation::kNone);
    const double kulla = WorstLoss(roughness, 0.8, Compensation::kKullaConty);
    const std::string name = fmt::format("white metal, anisotropy 0.8, roughness {}", roughness);
    result.numbers.push_back(
        {fmt::format("white isotropic metal, roughness {}, one bounce: largest loss in the furnace",
                     roughness),
         isotropic, ""});
    result.numbers.push_back({name + ", one bounce: largest loss in the furnace", none, ""});
    result.numbers.push_back({name + ", Kulla-Conty: largest error in the furnace", kulla, ""});
    losses += fmt::format("- roughness {}: {:.3f}, {:.3f} and {:.4f}\n", roughness, isotropic, none,
                          kulla);
    progress(0.6 + 0.4 * roughness);
  }
  result.answer = fmt::format(
      "An anisotropy is a number of its format: the lobe's two alphas are what formats share. At "
      "roughness {} and anisotropy 0.5, the alphas along and across the tangent are {}. OpenPBR "
      "keeps the mean of the squared alphas, Standard Surface and Disney their product, glTF the "
      "alpha across. Compare and convert alphas, never strengths.\n\n"
      "OpenPBR's formula leaves the range of alpha that its text states: above a roughness of {}. "
      "Implementations clamp or do not (`alpha_max`).\n\n"
      "With one bounce, rough metal loses light in the furnace, and compensation needs albedos by "
      "azimuth. Largest loss of white metal, isotropic and of anisotropy 0.8, and largest error of "
      "the latter with Kulla and Conty's compensation:\n\n{}",
      kMiddleRoughness, halves, beyond, losses);
  progress(1);
  return result;
}

}  // namespace nacre
