// SPDX-License-Identifier: Apache-2.0
// tests/study/layers_test.cc: light followed between smooth layers against the sums of its paths,
// and what the study of layers says.
#include <cmath>

#include "brdf/open_pbr.h"
#include "catch.h"
#include "study/layer_walk.h"
#include "study/measures.h"

namespace nacre {
namespace {

constexpr int kWalks = 40000;
const double kNoise = 4 * 0.5 / std::sqrt(kWalks);  // four standard deviations, at most

double Walked(const OpenPbrMaterial& surface, double cosine,
              InsideColor color = InsideColor::kAlbedo) {
  return WalkedShare(surface, InsideAlbedo(surface, color), cosine, kWalks, 1).x;
}

double Interface(double cosine, double eta) { return FresnelDielectric(cosine, 1 - cosine, eta); }

OpenPbrMaterial UnderClearCoat(OpenPbrMaterial surface) {
  surface.coat_weight = 1;
  return surface;
}

TEST_CASE("a smooth coat over a diffuse base is the sum of what comes back") {
  for (const double albedo : {0.2, 0.8, 1.0}) {
    const OpenPbrMaterial surface =
        UnderClearCoat({.base_color = Rgb(albedo), .specular_weight = 0});
    const double k = InternalDiffuseReflectance(AverageDielectric(1.6), 1.6);
    for (const double cosine : {0.1, 0.5, 1.0}) {
      CAPTURE(albedo, cosine);
      const double f = Interface(cosine, 1.6);
      CHECK(Walked(surface, cosine) ==
            Approx(f + (1 - f) * albedo * (1 - k) / (1 - albedo * k)).margin(kNoise));
    }
  }
}

TEST_CASE(
    "a smooth coat over a smooth metal is the sum of what comes back, absorbed on its paths") {
  for (const double color : {0.3, 1.0}) {
    OpenPbrMaterial surface =
        UnderClearCoat({.base_color = Rgb(0.9), .base_metalness = 1, .specular_roughness = 0});
    surface.coat_color = Rgb(color);
    for (const double cosine : {0.1, 0.5, 1.0}) {
      CAPTURE(color, cosine);
      const double f = Interface(cosine, 1.6), inside = RefractedCosine(cosine, 1 / 1.6);
      const double crossing = CoatCrossing(color, inside);
      const double there_and_back =
          crossing * crossing * FresnelSchlick(0.9, 1.0, Power5(1 - inside));
      const double share = f + (1 - f) * (1 - f) * there_and_back / (1 - f * there_and_back);
      CHECK(Walked(surface, cosine) == Approx(share).margin(kNoise));
      OpenPbrMaterial half = surface;
      half.coat_weight = 0.5;
      const double bare = FresnelSchlick(0.9, 1.0, Power5(1 - cosine));
      CHECK(Walked(half, cosine) == Approx((share + bare) / 2).margin(kNoise));
    }
  }
}

TEST_CASE("a white surface under white rough layers reflects all light") {
  OpenPbrMaterial surface = UnderClearCoat({.base_color = Rgb(1), .specular_roughness = 0.5});
  surface.coat_roughness = 0.7;
  for (const double cosine : {0.05, 1.0}) CHECK(Walked(surface, cosine) == 1);
}

TEST_CASE("a colour as it is seen bare is what comes out over what enters") {
  const OpenPbrMaterial surface{.base_color = Rgb(0.6), .specular_roughness = 0};
  for (const double cosine : {0.2, 1.0}) {
    const double f = Interface(cosine, 1.5);
    CHECK(Walked(surface, cosine, InsideColor::kSeenBare) ==
          Approx(f + (1 - f) * 0.6).margin(kNoise));
  }
}

TEST_CASE("the study of layers ranks rules") {
  const StudyResult result =
      StudyLayers({.walks = 300, .roughnesses = 2, .angles = 2}, [](double) {});
  CHECK(result.figures.size() == 5);
  for (const StudyNumber& number : result.numbers) {
    CAPTURE(number.quantity);
    CHECK((number.value >= 0 && number.value <= 1));
  }
  const auto number = [&](const std::string& quantity) {
    for (const StudyNumber& n : result.numbers) {
      if (n.quantity == quantity) return n.value;
    }
    FAIL(quantity);
    return 0.0;
  };
  // A rough coat roughens what is below it.
  CHECK(number("highlights below a coat, none: mean error of the roughness") >
        number("highlights below a coat, fit261: mean error of the roughness"));
  CHECK(result.answer.find("per_crossing (0.") != std::string::npos);
}

TEST_CASE("studies of lobes have the figures of OpenPBR's open questions") {
  const auto value = [](const StudyResult& result, const std::string& quantity) {
    for (const StudyNumber& number : result.numbers) {
      if (number.quantity == quantity) return number.value;
    }
    FAIL(quantity);
    return 0.0;
  };
  const StudyResult brushed = StudyAnisotropy([](double) {});
  const std::string half = ", roughness 0.5, anisotropy 0.5: alpha along the tangent";
  CHECK(value(brushed, "OpenPBR" + half) == Approx(0.3162).margin(5e-5));
  CHECK(value(brushed, "glTF" + half) == Approx(0.4375).margin(5e-5));
  CHECK(value(brushed, "Standard Surface" + half) == Approx(0.3536).margin(5e-5));
  CHECK(value(brushed, "Disney, Cycles" + half) == Approx(0.3371).margin(5e-5));
  CHECK(value(brushed, "OpenPBR, anisotropy 0.25: roughness above which alpha exceeds 1") ==
        Approx(0.94).margin(5e-3));
  CHECK(value(brushed,
              "white metal, anisotropy 0.8, roughness 0.6, Kulla-Conty: largest error in "
              "the furnace") < 1e-3);
  // Belcour and Barla's terms are far nearer than glTF's formula, on metals above all.
  const StudyResult films = StudyThinFilm([](double) {});
  CHECK(value(films, "gold, belcour_barla: rms error of the reflectance") <
        value(films, "gold, glTF: rms error of the reflectance") / 3);
  CHECK(films.pictures.size() == 1);
  const StudyResult sheen = StudySheen([](double) {});
  CHECK(value(sheen, "roughness 0.1, Charlie: largest share") > 1);
  CHECK(value(sheen, "roughness 0.1, Zeltner et al.: largest share") < 1);
}

}  // namespace
}  // namespace nacre
