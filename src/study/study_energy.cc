// SPDX-License-Identifier: Apache-2.0
// study/study_energy.cc: exercise 6: which models create energy, which lose it, and what restores
// it.
#include <cmath>

#include <fmt/format.h>

#include "brdf/phong.h"
#include "study/material_curves.h"
#include "study/measures.h"
#include "study/picture.h"
#include "study/study.h"

namespace nacre {

double PhongShare(const PhongCoefficients& phong, PhongUnits units, double cosine) {
  const double lobe = PhongLobeIntegral(phong.shininess, cosine);
  switch (units) {
    case PhongUnits::kLiteral:
      return M_PI * phong.kd + phong.ks * lobe / cosine;
    case PhongUnits::kOverPi:
      return phong.kd + phong.ks * lobe / cosine / M_PI;
    case PhongUnits::kModified:
      return M_PI * phong.kd + phong.ks * lobe;
    case PhongUnits::kModifiedOverPi:
      return phong.kd + phong.ks * lobe / M_PI;
    case PhongUnits::kModifiedNormalised:
      break;
  }
  return phong.kd + phong.ks * PhongNormalization(phong.shininess) * lobe;
}

namespace {

constexpr double kKd = 0.8, kKs = 0.5;  // from the exercise

Plot PhongPlot() {
  Plot plot;
  plot.title = "Phong, kd = 0.8, ks = 0.5: of light from one angle";
  plot.x = {.label = "angle of the light (degrees)", .low = 0, .high = 90, .step = 15};
  plot.y = {.label = "share that is reflected (1: all)", .low = 0, .high = 3.5, .step = 0.5};
  const auto add = [&](const std::string& title, PhongUnits units, double n) {
    plot.curves.push_back(MakeCurve(title, Steps(0, 89, 89), [&](double degrees) {
      return PhongShare({kKd, kKs, n}, units, std::cos(degrees * M_PI / 180));
    }));
  };
  add("as lessons write it, n = 64", PhongUnits::kLiteral, 64);
  add("both over pi, n = 64", PhongUnits::kOverPi, 64);
  add("both over pi, n = 8", PhongUnits::kOverPi, 8);
  add("modified and normalised, n = 64", PhongUnits::kModifiedNormalised, 64);
  plot.rules.push_back({Rule::Across::kY, 1, "all of the light"});
  return plot;
}

ShadingMaterial White(double metallic, double roughness, DiffuseCoupling coupling,
                      Compensation compensation) {
  return PrepareMaterial(MaterialOf(MetallicRoughnessMaterial{.base_color = Rgb(1),
                                                              .metallic = metallic,
                                                              .roughness = roughness,
                                                              .compensation = compensation,
                                                              .diffuse_coupling = coupling}));
}

ShadingMaterial Metal(double roughness, Compensation compensation) {
  return White(1, roughness, DiffuseCoupling::kAlbedoScaled, compensation);
}

ShadingMaterial Dielectric(double roughness, DiffuseCoupling coupling, Compensation compensation) {
  return White(0, roughness, coupling, compensation);
}

Plot PbrPlot() {
  const Compensation none = Compensation::kNone;
  Plot plot = AlbedoPlot(
      {{"metal, roughness 0.4, one bounce", Metal(0.4, none)},
       {"metal, roughness 0.7, one bounce", Metal(0.7, none)},
       {"metal, roughness 1, one bounce", Metal(1, none)},
       {"metal, roughness 1, compensated", Metal(1, Compensation::kTurquin)},
       {"dielectric, base times 1 - F", Dielectric(0.1, DiffuseCoupling::kOneMinusFresnel, none)},
       {"dielectric, base by albedo",
        Dielectric(0.1, DiffuseCoupling::kAlbedoScaled, Compensation::kTurquin)}},
      ShareOf::kFurnace, ColorChannel::kLuminance);
  plot.title = "white GGX surfaces: what is seen in a furnace";
  plot.y.high = 1.75;
  plot.y.step = 0.25;
  return plot;
}

Rgb8Picture FurnacePane(const MaterialKind& material) {
  Scene scene = SphereScene(
      material, 150, {{.name = "furnace", .kind = EnvironmentLight{.sky = ConstantSky{Rgb(0.5)}}}});
  scene.image.spp = 64;
  return ShowImage(RenderLayers(scene), kClipped);
}

StudyPicture Furnace(const StudyProgress& progress) {
  PaneSheet sheet;
  sheet.rows = {"Phong, as lessons write it", "GGX metal, one bounce", "Turquin", "Kulla-Conty"};
  const double roughnesses[] = {0.1, 0.4, 0.7, 1};
  for (const std::string& row : sheet.rows) {
    for (const double roughness : roughnesses) {
      MaterialKind material;
      const double alpha = roughness * roughness;
      if (row == sheet.rows[0]) {
        material = PhongMaterial{.convention = PhongConvention::kClassic,
                                 .kd = Rgb(kKd),
                                 .ks = Rgb(kKs),
                                 .shininess = 2 / (alpha * alpha) - 2};
      } else {
        material = MetallicRoughnessMaterial{
            .base_color = Rgb(1),
            .metallic = 1,
            .roughness = roughness,
            .compensation = row == sheet.rows[1]   ? Compensation::kNone
                            : row == sheet.rows[2] ? Compensation::kTurquin
                                                   : Compensation::kKullaConty};
      }
      sheet.panes.push_back(FurnacePane(material));
      progress(0.5 + 0.45 * static_cast<double>(sheet.panes.size()) / 16);
    }
  }
  for (const double roughness : roughnesses) {
    sheet.columns.push_back(fmt::format("roughness {}", roughness));
  }
  return MakeStudyPicture("furnace",
                          "White spheres under equal light from everywhere, before it: one that "
                          "keeps all light cannot be seen. Phong's exponent is 2 / alpha^2 - 2.",
                          sheet);
}

// The largest |reflected fraction - 1| of white surfaces in the furnace.
double WorstFurnaceError(double metallic, Compensation compensation) {
  double worst = 0;
  for (const double roughness : {0.05, 0.1, 0.2, 0.4, 0.6, 0.8, 1.0}) {
    const ShadingMaterial material =
        White(metallic, roughness, DiffuseCoupling::kAlbedoScaled, compensation);
    for (const double cosine : {0.01, 0.1, 0.3, 0.6, 1.0}) {
      const double share = ReflectedShare(material, ShareOf::kFurnace, cosine).x;
      worst = std::max(worst, std::abs(share - 1));
    }
  }
  return worst;
}

// The numbers that the answer mentions.
struct Shares {
  double literal, over_pi, grazing, normalised;  // for Phong
  double rough;                                  // a white metal of roughness 1, averaged
  double coupled;                                // a dielectric whose base gets 1 - F(v.h)
  double half_coupled;                           // a half metal whose base gets 1 - F(v.h)
  double turquin, kulla, dielectric, half;       // errors in the furnace
  double one_light, one_light_kulla;             // a dielectric, under light from n.l = 0.02
};

Shares Measure() {
  const auto phong = [](double n, PhongUnits units, double degrees) {
    return PhongShare({kKd, kKs, n}, units, std::cos(degrees * M_PI / 180));
  };
  const auto dielectric = [](double roughness, DiffuseCoupling coupling, Compensation compensation,
                             ShareOf what) {
    return ReflectedShare(Dielectric(roughness, coupling, compensation), what, 0.02).x;
  };
  const DiffuseCoupling by_albedo = DiffuseCoupling::kAlbedoScaled;
  return {
      .literal = phong(64, PhongUnits::kLiteral, 0),
      .over_pi = phong(64, PhongUnits::kOverPi, 0),
      .grazing = phong(8, PhongUnits::kOverPi, 89),
      .normalised = phong(64, PhongUnits::kModifiedNormalised, 0),
      .rough = MakeAlbedoFit(Shadowing::kHeightCorrelated, 1).e_average,
      .coupled = dielectric(0.02, DiffuseCoupling::kOneMinusFresnel, Compensation::kNone,
                            ShareOf::kFurnace),
      .half_coupled =
          ReflectedShare(White(0.5, 0.5, DiffuseCoupling::kOneMinusFresnel, Compensation::kNone),
                         ShareOf::kFurnace, 1)
              .x,
      .turquin = WorstFurnaceError(1, Compensation::kTurquin),
      .kulla = WorstFurnaceError(1, Compensation::kKullaConty),
      .dielectric = WorstFurnaceError(0, Compensation::kTurquin),
      .half = WorstFurnaceError(0.5, Compensation::kTurquin),
      .one_light = dielectric(0.5, by_albedo, Compensation::kTurquin, ShareOf::kOneLight),
      .one_light_kulla = dielectric(0.5, by_albedo, Compensation::kKullaConty, ShareOf::kOneLight),
  };
}

std::vector<StudyNumber> NumbersOf(const Shares& s) {
  return {
      {"Phong as lessons write it, n = 64, light at 0 degrees: share reflected", s.literal, ""},
      {"both terms over pi, n = 64, light at 0 degrees", s.over_pi, ""},
      {"both terms over pi, n = 8, light at 89 degrees", s.grazing, ""},
      {"modified and normalised, n = 64, light at 0 degrees", s.normalised, ""},
      {"white GGX metal, roughness 1, one bounce: average share", s.rough, ""},
      {"white dielectric, base times 1 - F, roughness 0.02, n.v = 0.02", s.coupled, ""},
      {"white half metal, base times 1 - F of the mixed F0, roughness 0.5, n.v = 1", s.half_coupled,
       ""},
      {"furnace, white metal, Turquin: largest error", s.turquin, ""},
      {"furnace, white metal, Kulla-Conty: largest error", s.kulla, ""},
      {"furnace, white dielectric, Turquin: largest error", s.dielectric, ""},
      {"furnace, white half metal, Turquin: largest error", s.half, ""},
      {"one light, n.l = 0.02, white dielectric, roughness 0.5, Turquin", s.one_light, ""},
      {"one light, n.l = 0.02, white dielectric, roughness 0.5, Kulla-Conty", s.one_light_kulla,
       ""},
  };
}

std::string EnergyAnswer(const Shares& s) {
  return fmt::format(
      "Phong with kd = {} and ks = {}: as lessons write it, without 1/pi, {:.2f} times the light "
      "of the normal direction is reflected (n = 64). With both terms over pi it is {:.3f} there, "
      "but {:.3f} at 89° for n = 8: the lobe is not multiplied by the light's cosine, so its share "
      "grows without bound towards grazing light. Modified Phong with its lobe normalised is "
      "bounded by kd + ks = {:.2f}, which is still more than 1: kd + ks <= 1 is the condition, and "
      "the exercise's choice breaks it.\n\n"
      "That the PBR model has no such problem is not true of the model as the lesson writes it. "
      "GGX with one bounce loses light: a white metal of roughness 1 gives back {:.1f} %. A white "
      "dielectric whose base is scaled by 1 - F(v.h) makes light: {:.2f} times of it at n.v = 0.02 "
      "and roughness 0.02. Between the two, the lesson mixes F0 by metallic and scales the base by "
      "both 1 - metallic and 1 - F, so that the metal's reflectance is taken from it twice: a "
      "white half metal of roughness 0.5, seen along its normal, gives back {:.1f} %. Metallic "
      "mixes two surfaces (glTF 2.0), and only the dielectric has a base to take from. With "
      "compensation and a base scaled by what the dielectric's albedo leaves, white stays white in "
      "the furnace: within {:.0e} (metal, Turquin), {:.0e} (metal, Kulla-Conty), {:.0e} "
      "(dielectric) and {:.0e} (half metal).\n\n"
      "A furnace lights from everywhere. Of light from one grazing direction (n.l = 0.02) a white "
      "dielectric of roughness 0.5 reflects {:.2f} with Turquin's compensation, which is not "
      "reciprocal, and {:.4f} with Kulla and Conty's, which is.",
      kKd, kKs, s.literal, s.over_pi, s.grazing, s.normalised, 100 * s.rough, s.coupled,
      100 * s.half_coupled, s.turquin, s.kulla, s.dielectric, s.half, s.one_light,
      s.one_light_kulla);
}

}  // namespace

StudyResult StudyEnergy(const StudyProgress& progress) {
  StudyResult result;
  const Shares shares = Measure();
  result.numbers = NumbersOf(shares);
  result.answer = EnergyAnswer(shares);
  progress(0.2);
  result.figures.push_back(
      {"energy", "Above 1, light is made from nothing.", MakeRow({PhongPlot(), PbrPlot()})});
  progress(0.5);
  result.pictures.push_back(Furnace(progress));
  progress(1);
  return result;
}

}  // namespace nacre
