// SPDX-License-Identifier: Apache-2.0
// study/study_blinn_exponent.cc: exercise 2: the exponent that makes Blinn's highlight like
// Phong's.
#include <cmath>

#include <fmt/format.h>

#include "study/blinn_exponent.h"
#include "study/picture.h"
#include "study/reflection.h"
#include "study/study.h"

namespace nacre {
namespace {

constexpr double kPhong = 64;
const Vec3d kToSun(2, 3, 3);

Rgb8Picture RenderLobe(PhongModel model, double shininess) {
  const PhongMaterial phong{.model = model,
                            .convention = PhongConvention::kClassic,
                            .color = Rgb(0.8, 0.2, 0.2),
                            .ks = Rgb(0.5),
                            .shininess = shininess};
  return ShowImage(RenderLayers(SphereScene(phong, 260, {SunTowards(kToSun, Rgb(1))})), kClipped);
}

Plot LobePlot(double in_plane) {
  Plot plot;
  plot.title = "the lobes in the plane of incidence";
  plot.x = {
      .label = "viewer from the mirror direction (degrees)", .low = 0, .high = 60, .step = 10};
  plot.y = {.label = "lobe (1: its peak)", .low = 0, .high = 1};
  const auto add = [&](const std::string& title, double exponent, double turn) {
    plot.curves.push_back(MakeCurve(title, Steps(0, 60, 240), [&](double degrees) {
      return std::pow(DirectionAt(degrees * turn).z, exponent);
    }));
  };
  add(fmt::format("Phong, n = {}", kPhong), kPhong, 1);
  add(fmt::format("Blinn, n = {}", kPhong), kPhong, 0.5);
  add(fmt::format("Blinn, n = {:.2f}", in_plane), in_plane, 0.5);
  return plot;
}

Plot AnglePlot(const StudyProgress& progress) {
  Plot plot;
  plot.title = "over all viewers";
  plot.x = {.label = "angle of the light (degrees)", .low = 0, .high = 90, .step = 15};
  plot.y = {.label = "best exponent, in Phong's", .low = 0, .high = 4.5, .step = 0.5};
  for (const double n : {16.0, kPhong, 256.0}) {
    Curve curve = MakeCurve(fmt::format("n = {}", n), Steps(0, 85, 17), [&](double degrees) {
      progress(0.3 + 0.2 * static_cast<double>(plot.curves.size()) + 0.2 * degrees / 85);
      return MatchOnHemisphere(n, degrees).exponent / n;
    });
    curve.style = CurveStyle::kMarkedLine;
    plot.curves.push_back(std::move(curve));
  }
  plot.rules.push_back({Rule::Across::kY, 4, "4, the rule of thumb"});
  return plot;
}

StudyPicture Spheres(double best) {
  PaneSheet sheet;
  sheet.panes = {
      RenderLobe(PhongModel::kPhong, kPhong), RenderLobe(PhongModel::kBlinnPhong, kPhong),
      RenderLobe(PhongModel::kBlinnPhong, best), RenderLobe(PhongModel::kBlinnPhong, 4 * kPhong)};
  sheet.columns = {fmt::format("Phong, {}", kPhong), fmt::format("Blinn, {}", kPhong),
                   fmt::format("Blinn, {:.1f}", best), fmt::format("Blinn, {}", 4 * kPhong)};
  return MakeStudyPicture("spheres", "At the same exponent Blinn's highlight is the larger one.",
                          sheet);
}

}  // namespace

StudyResult StudyBlinnExponent(const StudyProgress& progress) {
  const BlinnMatch plane = MatchInPlane(kPhong);
  const double half = MatchHalfMaximum(kPhong);
  const BlinnMatch sphere = MatchOnSphere(kPhong, kToSun);
  progress(0.1);
  const BlinnMatch facing = MatchOnHemisphere(kPhong, 0);
  const BlinnMatch grazing = MatchOnHemisphere(kPhong, 85);
  progress(0.3);
  StudyResult result;
  result.numbers = {
      {"best exponent in the plane of incidence", plane.exponent, ""},
      {"its rms difference from Phong's lobe", plane.rms_residual, ""},
      {"exponent of equal half width", half, ""},
      {"best exponent over the picture of a sphere, light (2, 3, 3)", sphere.exponent, ""},
      {"best exponent over all viewers, light at 0 degrees", facing.exponent, ""},
      {"best exponent over all viewers, light at 85 degrees", grazing.exponent, ""},
  };
  result.pictures.push_back(Spheres(sphere.exponent));
  result.figures.push_back({"exponent", "What matches depends on what is compared.",
                            MakeRow({LobePlot(plane.exponent), AnglePlot(progress)})});
  result.answer = fmt::format(
      "In the plane of incidence {:.2f}, {:.3f} times Phong's {}: the half vector turns half as "
      "fast as the viewer, and cos^n is about a Gaussian, so four times the exponent is as wide. "
      "(That is the best fit in least squares, with a residual of {:.1e} rms; equal widths at half "
      "the peak ask for {:.2f}.)\n\n"
      "Out of that plane the half vector turns faster, and Blinn's highlight is narrower across "
      "than along it. Over the picture of a sphere lit from (2, 3, 3) the best exponent is {:.1f}, "
      "{:.2f} times Phong's. Over all viewers of a flat surface it is {:.1f} with the light "
      "overhead and falls to {:.1f} with the light at 85°. So \"about four times\" is right where "
      "light and viewer are near the normal, and too much elsewhere.",
      plane.exponent, plane.exponent / kPhong, kPhong, plane.rms_residual, half, sphere.exponent,
      sphere.exponent / kPhong, facing.exponent, grazing.exponent);
  progress(1);
  return result;
}

}  // namespace nacre
