// SPDX-License-Identifier: Apache-2.0
#include "lesson/fault_entries.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "brdf/fresnel.h"
#include "brdf/ggx.h"
#include "scene/material.h"
#include "shading/material.h"
#include "shading/scalar_bsdf.h"
#include "textbook/albedo.h"
#include "textbook/conventions.h"

namespace nacre {
namespace {

using F = TextbookFaults;
using AmountLines = std::vector<std::string>;

const char kNotShown[] = "not shown by these pictures; ";

AmountLines JoinLines(AmountLines first, const AmountLines& second) {
  first.insert(first.end(), second.begin(), second.end());
  return first;
}

// The change of the comparison picture if it is rendered with these faults instead.
CodeChange ComparisonChange(const LessonPictures& lesson, const TextbookFaults& faults) {
  return MeasureChange(lesson.comparison, RenderComparison({.faults = faults}));
}

// nacre's own model of white surfaces: dielectric (metallic 0), metal (1), or a mix.
MicrofacetModel NacreModel(double roughness, double metallic) {
  Material material;
  material.model = MetallicRoughnessMaterial{
      .base_color = Rgb(1, 1, 1), .metallic = metallic, .roughness = roughness};
  return std::get<MicrofacetModel>(PrepareMaterial(material).model);
}

// The total albedo of that model: the lobe by quadrature of its terms, with the compensation used
// in rendering, and the base.
double NacreAlbedo(double n_dot_v, double roughness, double metallic) {
  const MicrofacetModel model = NacreModel(roughness, metallic);
  const double more = 1 / AlbedoOne(model.albedo.lobe, n_dot_v) - 1;
  const double lobe =
      LobeAlbedo(n_dot_v, roughness, [&](const Vec3d& to_light, const Vec3d& to_view) {
        const Angles<double> a = ComputeAngles(Vec3d(0, 0, 1), to_light, to_view);
        const double compensated = FresnelOf(model, VDotH(a), OneMinusVDotH(a)).x +
                                   more * TurquinTerm(model, VDotH(a), OneMinusVDotH(a)).x;
        return GgxDistribution(a, model.alpha) * compensated *
               VisibilityHeightCorrelated(a.n_dot_l, a.n_dot_v, model.alpha);
      });
  const double base = M_PI * model.diffuse.x * (1 - CoverAlbedo(model, n_dot_v, 0));
  return lobe + base;
}

AmountLines AmountOfAlpha(const LessonPictures& lesson) {
  return JoinLines({fmt::format("k at r = 0.4: {:.3f} in words, {:.3f} in the program",
                                DirectKOfWords(0.4), DirectKOfProgram(0.4)),
                    "had the program followed the words:"},
                   ChangeLines(lesson, {.k_from_words = true}));
}

AmountLines AmountOfDirectK(const LessonPictures& lesson) {
  const TextbookFaults faults;
  const TextbookFaults smith = Without(&F::schlick_geometry);
  const double ratio =
      TextbookGeometry(0.1, 0.1, 0.1, faults) / TextbookGeometry(0.1, 0.1, 0.1, smith);
  return JoinLines(ChangeLines(lesson, smith),
                   {fmt::format("G at r = 0.1, n.l = n.v = 0.1: {:.2f} times Smith's", ratio)});
}

AmountLines AmountOfAmbientK(const LessonPictures&) {
  return {fmt::format("{}k at r = 0.5: {:.3f} in words, {:.3f} in the source", kNotShown,
                      AmbientKOfWords(0.5), AmbientKOfSource(0.5))};
}

AmountLines AmountOfEpsilon(const LessonPictures& lesson) {
  return JoinLines(
      ChangeLines(lesson, Without(&F::denominator_epsilon)),
      {fmt::format("highlight lost at n.l = n.v = 0.1, 0.02, 0.005: {:.2f} %, {:.1f} %, {:.0f} %",
                   100 * EpsilonLoss(0.1, 0.1), 100 * EpsilonLoss(0.02, 0.02),
                   100 * EpsilonLoss(0.005, 0.005))});
}

AmountLines AmountOfFloors(const LessonPictures& lesson) {
  const TextbookAngles peak{.n_dot_l = 1, .n_dot_v = 1, .n_dot_h = 1, .v_dot_h = 1, .sin2_h = 0};
  return JoinLines(
      ChangeLines(lesson, {.distribution_floor = false, .v_dot_h_floor = false}),
      {fmt::format("D's floor: at work below r = {:.4f}; at r = 0.04 the peak is {:.1f} times too "
                   "low, at r = 0 it is {:g}",
                   FloorRoughness(), FloorFactor(0.04), TextbookDistribution(peak, 0, {})),
       fmt::format("v.h's floor: F = {:.3f} instead of 1 at exactly grazing light",
                   TextbookFresnel(0.001, 0.04))});
}

AmountLines AmountOfMetalF0(const LessonPictures&) {
  const Rgb gold(1, 0.765, 0.336);
  return {fmt::format("{}gold's reflectance too high by {:.3g}, {:.3g}, {:.3g}", kNotShown,
                      1 - gold.x, 1 - gold.y, 1 - gold.z)};
}

AmountLines AmountOfEnergy(const LessonPictures&) {
  const TextbookFaults lesson{// without faults E4 and E5
                              .denominator_epsilon = false,
                              .distribution_floor = false,
                              .v_dot_h_floor = false};
  constexpr double kMirror = 1e-5;  // roughness; the limit is reached within 2e-5
  const auto mirror = [&](double n_dot_v) {
    return 100 * (1 - TextbookSpecularAlbedo(n_dot_v, kMirror, 1, lesson));
  };
  const double lesson_white =
      TextbookSpecularAlbedo(0.18, 0.02, 0.04, lesson) + TextbookDiffuseAlbedo(0.18, 0.04, lesson);
  const double nacre_white = NacreAlbedo(0.18, 0.02, 0);
  constexpr double kHalfF0 = (0.04 + 1) / 2;
  const double lesson_half = TextbookSpecularAlbedo(1, 0.5, kHalfF0, lesson) +
                             0.5 * TextbookDiffuseAlbedo(1, kHalfF0, lesson);
  const auto metal = [&](double r) {
    return fmt::format("r = {}: {:.3f} (nacre {:.3f})", r, TextbookSpecularAlbedo(1, r, 1, lesson),
                       NacreAlbedo(1, r, 1));
  };
  return {
      "not shown by these pictures (one light); of light from everywhere, 1 would be all:",
      fmt::format("perfect mirror, r -> 0: loses {:.1f} % at n.v = 0.2, {:.1f} % at n.v = 0.1",
                  mirror(0.2), mirror(0.1)),
      fmt::format(
          "white metal, r = 0.05, all directions: {:.4f} (nacre {:.4f})",
          AverageAlbedo([&](double mu) { return TextbookSpecularAlbedo(mu, 0.05, 1, lesson); }),
          AverageAlbedo([](double mu) { return NacreAlbedo(mu, 0.05, 1); })),
      fmt::format("white metal, n.v = 1, {}; {}", metal(0.5), metal(1)),
      fmt::format("white dielectric, r = 0.02, n.v = 0.18: {:.3f} (nacre {:.3f})", lesson_white,
                  nacre_white),
      fmt::format("white half metal, r = 0.5, n.v = 1: {:.3f} (nacre {:.3f}): metallic mixes what "
                  "two surfaces reflect; the lesson mixes F0 and takes the metal's from the base",
                  lesson_half, NacreAlbedo(1, 0.5, 0.5)),
  };
}

AmountLines AmountOfEncoding(const LessonPictures& lesson) {
  const TextbookFaults at_end = Without(&F::encode_per_light);
  double brightest = 0;
  for (const Rgb& color : RenderTextbookGrid({.faults = at_end}).film) {
    brightest = std::max({brightest, color.x, color.y, color.z});
  }
  return {
      "one light, encoded at the end: " + ChangeText(ComparisonChange(lesson, at_end)),
      "the same light as two of half the power: " +
          ChangeText(MeasureChange(RenderComparison({.light_count = 2}),
                                   RenderComparison({.light_count = 2, .faults = at_end}))),
      fmt::format("grid: radiance reaches {:.1f}, and its float image at most 1", brightest),
  };
}

AmountLines AmountOfHalves(const LessonPictures& lesson) {
  const TextbookFaults none{
      .phong_without_pi = false, .pbr_without_ambient = false, .raw_left_half = false};
  const auto line = [&](const char* what, const TextbookFaults& faults) {
    return fmt::format("{}: {}", what, ChangeText(ComparisonChange(lesson, faults)));
  };
  return {line("left half encoded", Without(&F::raw_left_half)),
          line("Phong over pi", Without(&F::phong_without_pi)),
          line("ambient on both", Without(&F::pbr_without_ambient)), line("all three", none)};
}

AmountLines AmountOfClip(const LessonPictures&) {
  const TextbookComparison unclipped{.faults = Without(&F::clip_in_shading)};
  int clipped = 0;
  double brightest = 0;
  for (const Rgb& color : RenderTextbookComparison(unclipped).film) {
    const double largest = std::max({color.x, color.y, color.z});
    clipped += largest > 1;
    brightest = std::max(brightest, largest);
  }
  return {
      fmt::format("comparison: {} pixels clipped, from up to {:.3f}; 8 bits clip as well, so no "
                  "code changes",
                  clipped, brightest)};
}

AmountLines AmountOfBlinnCost(const LessonPictures&) {
  const auto line = [](const char* name, const OperationCount& n) {
    return fmt::format("{}: additions {}, multiplications {}, divisions {}, roots {}", name,
                       n.additions, n.multiplications, n.divisions, n.roots);
  };
  return {std::string(kNotShown) + "counted, from unit N, L and V:",
          line("R.V", CountPhongCosine()), line("N.H", CountBlinnCosine())};
}

AmountLines AmountOfUngated(const LessonPictures& lesson) {
  const auto line = [](double n) {
    const Vec3d rim(2, 1, -6);
    const TextbookLeak phong = MeasureLeak(rim, n, false);
    const TextbookLeak blinn = MeasureLeak(rim, n, true);
    return fmt::format(
        "light behind, (2, 1, -6), n = {}: on {:.2f} % of the sphere, up to {:.2f} "
        "(Blinn {:.2f} %, {:.2f})",
        n, 100 * phong.share, phong.largest, 100 * blinn.share, blinn.largest);
  };
  return JoinLines(ChangeLines(lesson, Without(&F::ungated_specular)), {line(8), line(64)});
}

AmountLines AmountOfGrid(const LessonPictures& lesson) {
  const auto change = [&](const TextbookFaults& faults) {
    return ChangeText(MeasureChange(lesson.grid, RenderGrid({.faults = faults})));
  };
  const TextbookFaults both{.shared_grid_point = false, .perspective_view = false};
  return {fmt::format("{:.1f} % of each disc is seen from behind, n.v <= 0: no highlight there",
                      100 * GridShareSeenFromBehind({})),
          "a place for each: " + change(Without(&F::shared_grid_point)),
          "seen from infinity: " + change(Without(&F::perspective_view)), "both: " + change(both)};
}

AmountLines AmountOfSmallVectors(const LessonPictures& lesson) {
  return JoinLines(ChangeLines(lesson, Without(&F::normalize_epsilon)),
                   {fmt::format("an equilateral triangle is degenerate below an edge of {:.2g} "
                                "(doc1: {:.2g})",
                                ShortestTriangleEdge(1e-10), ShortestTriangleEdge(1e-6))});
}

AmountLines AmountOfAttenuation(const LessonPictures&) {
  return {fmt::format(
      "{}irradiance too low by {:.2g} % at d = 1, {:.2g} % at 0.1, {:.2g} % at 0.01", kNotShown,
      100 * AttenuationLoss(1), 100 * AttenuationLoss(0.1), 100 * AttenuationLoss(0.01))};
}

AmountLines AmountOfLightDirection(const LessonPictures&) {
  return {fmt::format("{}(1, -1, 1) makes n.l {:.3f} times too large", kNotShown,
                      UnnormalizedLightLength())};
}

AmountLines AmountOfNotesShader(const LessonPictures&) {
  const Rgb color = TextbookComparison{}.phong.color;
  const double d = 10;
  const double k_quadratic = 0.1;  // of doc2
  return {
      fmt::format("{}on the comparison's colour the highlight is {:.2g}, {:.2g}, {:.2g} of "
                  "itself; ambient at d = {} is {:.3f} of itself",
                  kNotShown, color.x, color.y, color.z, d, 1 / (1 + k_quadratic * d * d))};
}

AmountLines AmountOfTexels(const LessonPictures&) {
  return {fmt::format(
      "{}up to {:.2f} texels off; repeated, {:.2f} % of the period is missing at "
      "W = 256, {:.0f} % at W = 4",
      kNotShown, TexelShift(256), 100 * TexelPeriodLoss(256), 100 * TexelPeriodLoss(4))};
}

AmountLines AmountOfSphereUv(const LessonPictures&) {
  const double v_of_top = std::acos(1.0) / M_PI;
  const double u_behind = std::atan2(-1.0, 0.0) / (2 * M_PI);
  return {
      fmt::format("{}v = {:g} at the north pole, where the image's top is v = 1; u = {:g} for "
                  "phi = 270 degrees",
                  kNotShown, v_of_top, u_behind)};
}

AmountLines AmountOfNormalMap(const LessonPictures&) {
  return {fmt::format("{}(128, 128, 255) tilts the normal by {:.3f} degrees an axis, {:.3f} in all",
                      kNotShown, FlatMapTiltPerAxisDeg(), FlatMapTiltDeg())};
}

AmountLines AmountOfDisplacement(const LessonPictures&) {
  return {fmt::format("{}waves of height 0.01 and length 0.1: normals up to {:.0f} degrees off",
                      kNotShown, DisplacedNormalErrorDeg(0.01, 0.1))};
}

AmountLines AmountOfCurves(const LessonPictures& lesson) {
  const GammaError error = LargestGammaError();
  // Narkowicz's curve x (a x + b) / (x (c x + d) + e) reaches 1 where (a - c) x^2 + (b - d) x = e.
  const double a = 2.51, b = 0.03, c = 2.43, d = 0.59, e = 0.14;
  const double reaches_one =
      ((d - b) + std::sqrt((d - b) * (d - b) + 4 * (a - c) * e)) / (2 * (a - c));
  const double overflow = std::sqrt(static_cast<double>(std::numeric_limits<float>::max()) / a);
  return JoinLines(
      ChangeLines(lesson, Without(&F::gamma22)),
      {fmt::format("largest difference of the curves: {:.4f} ({:.1f} codes) at linear {:.5f}",
                   error.difference, 255 * error.difference, error.at_linear),
       fmt::format(
           "ACES curve of the words: limit {:.4f}, reaches 1 at {:.4f}, NaN in float beyond {:.2g}",
           a / c, reaches_one, overflow)});
}

AmountLines AmountOfMetalDiffuse(const LessonPictures&) {
  const TextbookPoint p{{0, 0, 1}, {0.6, 0, 0.8}, {0, 0, 1}, {1, 1, 1}};
  // A rough metal viewed far from its highlight; without the highlight, what is left is diffuse.
  const TextbookPbr metal{.albedo = {1, 1, 1}, .metallic = 1, .roughness = 0.3};
  const TextbookAngles angles = TextbookAnglesAt(p, {});
  const double highlight = TextbookSpecular(angles, metal.roughness, 1, {}) * angles.n_dot_l;
  return {fmt::format("{}diffuse radiance of a metal in the lesson's own program: {:g}", kNotShown,
                      TextbookPbrRadiance(p, metal, {}).x - highlight)};
}

AmountLines AmountOfAmbientColor(const LessonPictures& lesson) {
  return {"comparison, had the program followed the words: " +
          ChangeText(ComparisonChange(lesson, {.ambient_from_words = true}))};
}

AmountLines AmountOfEdges(const LessonPictures&) {
  constexpr int kSide = 100;
  return {fmt::format("{}a square of {} x {} pixels, as two triangles: {} pixels drawn twice",
                      kNotShown, kSide, kSide, PixelsDrawnTwice(kSide))};
}

AmountLines AmountOfInside(const LessonPictures& lesson) {
  const auto from_center = [](const TextbookFaults& faults) {
    return TextbookIntersectSphere({0, 0, 0}, {0, 0, -1}, {0, 0, 0}, 1, faults);
  };
  return JoinLines(
      ChangeLines(lesson, Without(&F::no_far_root)),
      {fmt::format("from a unit sphere's centre: t = {:g}, the background; right: t = {:g}",
                   from_center({}), from_center(Without(&F::no_far_root)))});
}

// For faults whose only effect is on the lesson's pictures.
template <bool F::*kFault>
AmountLines AmountOfSwitch(const LessonPictures& lesson) {
  return ChangeLines(lesson, Without(kFault));
}

AmountLines NothingToMeasure(const LessonPictures&) { return {"nothing to measure"}; }

// "doc1" and so on name the other founding documents, as the command's first lines do.
constexpr FaultEntry kEntries[] = {
    {"E1", "alpha in k", "the words take alpha = r^2 for k = (alpha + 1)^2 / 8",
     "k's source (Karis 2013) means the roughness r, as the lesson's program does",
     "one alpha = r^2 in D and G; schlick_direct has k from r", AmountOfAlpha},
    {"E2", "G with k for direct light", "Schlick's G1 with k = (r + 1)^2 / 8, from L and from V",
     "Smith's G of the same GGX; k is a fit made to look well",
     "height-correlated Smith (Heitz 2014); the lesson's G is named schlick_direct",
     AmountOfDirectK},
    {"E3", "k for light from everywhere", "k = alpha^2 / 2 = r^4 / 2, in words only",
     "the source has r^2 / 2; and a surface has one G for all lights",
     "one G for all lights; the source's k is named schlick_ibl", AmountOfAmbientK},
    {"E4", "+ 0.0001 in the denominator", "D F G / (4 n.l n.v + 0.0001)",
     "G contains n.l n.v: divided out on paper, nothing can be 0",
     "visibility terms V = G / (4 n.l n.v) without a singularity", AmountOfEpsilon},
    {"E5", "floors in D and F", "D's denominator is at least 1e-10, v.h at least 0.001",
     "D from |n x h|^2, which does not cancel; v.h >= 0 by itself",
     "no floors; a delta lobe (r < 1e-6) shows no point light", AmountOfFloors},
    {"E6", "F0 of metals", "doc2: F0 = 1 for metals; the lesson: gold (1, .765, .336)",
     "metals are coloured", "F0 of a metal is its base colour", AmountOfMetalF0},
    {"E7", "\"energy conserving: yes\"",
     "kd = 1 - F(v.h), of a mixed F0, single scattering, and G from k; called conserving",
     "1 for a white furnace: multiple scattering, and a base under both passes of the gloss",
     "Smith's G, Turquin's compensation, and a base that gets what the gloss leaves",
     AmountOfEnergy},
    {"E8", "tone map and gamma in the BRDF", "Reinhard and x^(1/2.2) for each light",
     "light adds up linearly; one display transform at the end",
     "linear film and EXR; the tone operator is for PNG only", AmountOfEncoding},
    {"E9", "halves that cannot be compared",
     "the Phong half is not encoded, has no 1/pi, and alone has ambient light",
     "the same light, units and display transform on both",
     "convention radiometric, one transform for the picture", AmountOfHalves},
    {"E10", "clip in the shading", "Phong's colour is clipped to [0, 1]",
     "radiance has no upper bound", "no clip before the film", AmountOfClip},
    {"E11", "\"Blinn is cheaper\"", "doc3 counts 5 operations for Phong, 4 for Blinn",
     "count the normalisation of H: a root and divisions",
     "neither normalises: |n x u|^2 / |u|^2 for Blinn, |R - V|^2 for Phong", AmountOfBlinnCost},
    {"E12", "highlights on the unlit side", "max(R.V, 0)^n whether or not n.l > 0",
     "gated by n.l > 0; times n.l where that should be continuous",
     "gated; modified_phong has the factor n.l", AmountOfUngated},
    {"E13", "pixel corners", "rays through x / W: half a pixel off, and lopsided by one",
     "pixel centres, or a filter over the pixel", "one sample: the centre; more: the filter",
     AmountOfSwitch<&F::pixel_corners>},
    {"E14", "spheres of the grid",
     "normals as seen from infinity, view from the origin, one point for all 25",
     "25 spheres in 25 places, seen by one camera", "real spheres, exact hits", AmountOfGrid},
    {"E15", "no fall-off", "an attenuation function that is never called",
     "irradiance I / d^2 (compared at equal irradiance at the middle sphere)",
     "inverse_square unless the scene says none", AmountOfSwitch<&F::no_falloff>},
    {"E16", "absolute epsilons", "vectors below 1e-10, doc1's normals below 1e-6, count as 0",
     "degenerate is only what has no area at any scale",
     "normals of any scale; degenerate is exactly 0", AmountOfSmallVectors},
    {"E17", "1 / (d^2 + 0.0001)", "an epsilon against d = 0, in world units",
     "1 / d^2; d = 0 is the light itself", "1 / d^2, and 0 at the light itself",
     AmountOfAttenuation},
    {"E18", "sign and length of a light's direction",
     "doc3: L = -D; doc1: L = direction, and (1, -1, 1) not unit",
     "one name that says it, and normalise", "direction_of_travel, of any length",
     AmountOfLightDirection},
    {"E19", "slips of the notes' shader",
     "doc2: highlight times object colour, ambient attenuated, reflect(L, N)",
     "a highlight has the light's colour, ambient no distance; reflect(-L, N)",
     "ks has its own colour; ambient lights have no distance", AmountOfNotesShader},
    {"E20", "texel convention", "doc3: texel u (W - 1)", "texel centres: u W - 1/2",
     "no textures yet", AmountOfTexels},
    {"E21", "which way v points", "doc3: (0, 0) bottom left, but v = theta / pi from the top",
     "one convention; phi wrapped to [0, 2 pi)", "no textures yet", AmountOfSphereUv},
    {"E22", "a flat normal map is not flat", "doc3: N = 2 T - 1, and 8 bits have no 1/2",
     "(255 T - 128) / 127, then normalise", "no textures yet", AmountOfNormalMap},
    {"E23", "displacement keeps the normal", "doc3: P' = P + h N, shaded with N",
     "the normal of the displaced surface", "no textures yet", AmountOfDisplacement},
    {"E24", "gamma 2.2 for sRGB", "x^(1/2.2)", "the exact sRGB curve",
     "exact to the code; ACES clamped, and finite for all of float", AmountOfCurves},
    {"E25", "\"diffuse surfaces: metal and glass\"", "doc3, on a slide",
     "neither has a diffuse part", "metals have none: kd has the factor 1 - metallic",
     AmountOfMetalDiffuse},
    {"E26", "colour of ambient light", "the words: the light's colour; the program: white",
     "ambient light is a light of its own", "lights of type ambient, with their radiance",
     AmountOfAmbientColor},
    {"E27", "edges of triangles",
     "doc1: edges belong to both triangles, and clockwise triangles to none",
     "each pixel once, both windings", "rays hit either side, watertight, the nearest counts",
     AmountOfEdges},
    {"E28", "inside a sphere", "t < 0 is the background; the far root is not tried",
     "the first root in front", "the far root from inside", AmountOfInside},
    {"E29", "\"Gouraud: early GPUs\"", "a remark in a table", "-", "-", NothingToMeasure},
    {"E30", "8 bits by truncation", "(x * 255) cut off", "rounded to the nearest code",
     "rounded, exact for every float", AmountOfSwitch<&F::png_truncation>},
};

}  // namespace

std::span<const FaultEntry> FaultEntries() { return kEntries; }

}  // namespace nacre
