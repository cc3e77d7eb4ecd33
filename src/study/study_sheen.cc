// SPDX-License-Identifier: Apache-2.0
// study/study_sheen.cc: the two models of fuzz: Charlie, as glTF names it, and Zeltner et al. 2022,
// as OpenPBR does.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "brdf/fuzz.h"
#include "brdf/sheen.h"
#include "report/plot.h"
#include "shading/share.h"
#include "study/picture.h"
#include "study/study.h"

namespace nacre {
namespace {

constexpr double kRoughnesses[] = {0.1, 0.3, 0.5, 0.8, 1};

double CharlieShare(double roughness, double cosine) {
  return CharlieAlbedo(MakeCharlie(roughness), cosine);
}
double FuzzShare(double roughness, double cosine) {
  return FuzzAlbedo(MakeFuzz(roughness), cosine);
}

using FuzzyShare = double (*)(double roughness, double cosine);

Plot SharePlot(const char* title, FuzzyShare share) {
  Plot plot;
  plot.title = title;
  plot.x = {.label = "angle from the normal (degrees)", .low = 0, .high = 90, .step = 15};
  plot.y = {.label = "reflected share", .low = 0, .high = 1.5, .step = 0.25};
  for (const double roughness : kRoughnesses) {
    plot.curves.push_back(MakeCurve(
        fmt::format("roughness {}", roughness), Steps(0, 89.5, 179),
        [&](double degrees) { return share(roughness, std::cos(degrees * M_PI / 180)); }));
  }
  plot.rules.push_back({Rule::Across::kY, 1, "all of the light"});
  return plot;
}

// The largest share over the cosines, grazing ones included.
double LargestShare(FuzzyShare share, double roughness) {
  double largest = 0;
  for (const double degrees : Steps(0, 89.9, 899)) {
    largest = std::max(largest, share(roughness, std::cos(degrees * M_PI / 180)));
  }
  return largest;
}

// The roughness of fuzz whose share is nearest to that of Charlie's sheen, rms over the angle.
struct NearestFuzz {
  double roughness = 0, rms = 0;
};
NearestFuzz FindNearestFuzz(double sheen_roughness) {
  NearestFuzz nearest{0, INFINITY};
  for (const double roughness : Steps(0.01, 1, 198)) {
    double squares = 0;
    for (const double degrees : Steps(0, 85, 34)) {
      const double cosine = std::cos(degrees * M_PI / 180);
      const double difference =
          FuzzShare(roughness, cosine) - CharlieShare(sheen_roughness, cosine);
      squares += difference * difference;
    }
    const double rms = std::sqrt(squares / 35);
    if (rms < nearest.rms) nearest = {roughness, rms};
  }
  return nearest;
}

MaterialKind SheenOf(double roughness) {
  MetallicRoughnessMaterial cloth{.base_color = Rgb(0.05, 0.01, 0.02), .roughness = 0.9};
  cloth.sheen_color = Rgb(0.9, 0.5, 0.55);
  cloth.sheen_roughness = roughness;
  return cloth;
}

MaterialKind FuzzOf(double roughness) {
  OpenPbrMaterial cloth{.base_color = Rgb(0.05, 0.01, 0.02), .specular_roughness = 0.9};
  cloth.fuzz_weight = 1;
  cloth.fuzz_color = Rgb(0.9, 0.5, 0.55);
  cloth.fuzz_roughness = roughness;
  return cloth;
}

StudyPicture Velvet(const StudyProgress& progress) {
  PaneSheet sheet;
  sheet.rows = {"Charlie", "Zeltner et al."};
  for (const double roughness : kRoughnesses) {
    sheet.columns.push_back(fmt::format("roughness {}", roughness));
  }
  for (const auto& cloth_of : {SheenOf, FuzzOf}) {
    for (const double roughness : kRoughnesses) {
      Scene scene = SphereScene(
          cloth_of(roughness), 160,
          {SunTowards(Vec3d(0.5, 0.8, 0.6).normalized(), Rgb(2)),
           {.name = "sky",
            .kind = EnvironmentLight{.sky = ConstantSky{Rgb(0.35)}, .background = false}}});
      scene.image.spp = 64;
      sheet.panes.push_back(ShowImage(RenderLayers(scene), {.tone = ToneOperator::kNeutral}));
      progress(0.7 * static_cast<double>(sheet.panes.size()) / 10);
    }
  }
  return MakeStudyPicture("velvet", "Dark cloth under light fuzz, lit by a sun and an even sky.",
                          sheet);
}

// What a white surface under white sheen reflects in the furnace, at worst.
double WorstSheenError(SheenScaling scaling) {
  double worst = 0;
  for (const double roughness : kRoughnesses) {
    MetallicRoughnessMaterial white{.base_color = Rgb(1)};
    white.sheen_color = Rgb(1);
    white.sheen_roughness = roughness;
    white.sheen_scaling = scaling;
    const ShadingMaterial prepared = PrepareMaterial(MaterialOf(white));
    for (const double cosine : {0.05, 0.2, 0.5, 1.0}) {
      const double share = ReflectedShare(prepared, ShareOf::kFurnace, cosine).x;
      if (std::abs(share - 1) > std::abs(worst)) worst = share - 1;
    }
  }
  return worst;
}

}  // namespace

StudyResult StudySheen(const StudyProgress& progress) {
  StudyResult result;
  result.pictures.push_back(Velvet(progress));
  result.figures.push_back({"shares",
                            "The share of light that white fuzz reflects itself, before what is "
                            "below it.",
                            MakeRow({SharePlot("Charlie (glTF)", CharlieShare),
                                     SharePlot("Zeltner et al. 2022 (OpenPBR)", FuzzShare)})});
  progress(0.8);
  std::string most, matches;
  for (const double roughness : kRoughnesses) {
    const double charlie = LargestShare(CharlieShare, roughness);
    const double fuzz = LargestShare(FuzzShare, roughness);
    const NearestFuzz nearest = FindNearestFuzz(roughness);
    const std::string name = fmt::format("roughness {}", roughness);
    result.numbers.push_back({name + ", Charlie: largest share", charlie, ""});
    result.numbers.push_back({name + ", Zeltner et al.: largest share", fuzz, ""});
    result.numbers.push_back(
        {name + " of Charlie: nearest roughness of fuzz", nearest.roughness, ""});
    result.numbers.push_back({name + " of Charlie: rms difference there", nearest.rms, ""});
    most += fmt::format("{}{:.2f} and {:.2f} at {}", most.empty() ? "" : ", ", charlie, fuzz,
                        roughness);
    matches += fmt::format("{}{:.2f} for {} (rms {:.3f})", matches.empty() ? "" : ", ",
                           nearest.roughness, roughness, nearest.rms);
  }
  const double reciprocal = WorstSheenError(SheenScaling::kReciprocal);
  const double conserving = WorstSheenError(SheenScaling::kConserving);
  result.numbers.push_back({"furnace, white under white sheen, reciprocal", reciprocal, ""});
  result.numbers.push_back({"furnace, white under white sheen, conserving", conserving, ""});
  result.answer = fmt::format(
      "Both models are fuzz, but the same roughness means different fuzz in each. The largest "
      "share of light that they reflect, over angles of up to 89.9 degrees, Charlie's and "
      "Zeltner's: {}. Where Charlie's exceeds 1, next to the horizon, glTF does not say what to "
      "do: "
      "nacre divides by it.\n\n"
      "The roughness of fuzz that reflects most like Charlie's sheen, with the rms difference of "
      "the shares over angles of 0 to 85 degrees: {}.\n\n"
      "White under white sheen, in the furnace: {:+.3f} at worst where what is below is scaled by "
      "the smaller of both directions' rests, which is reciprocal and what glTF asks for; {:+.0e} "
      "where it is scaled by the viewer's rest, which is not.\n",
      most, matches, reciprocal, conserving);
  progress(1);
  return result;
}

}  // namespace nacre
