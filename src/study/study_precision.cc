// SPDX-License-Identifier: Apache-2.0
// study/study_precision.cc: the effect of rounding on distant spheres and on smooth surfaces.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "color/transfer.h"
#include "study/picture.h"
#include "study/rounding.h"
#include "study/study.h"

namespace nacre {
namespace {

struct Form {
  HitForm form;
  const char* name;
};
constexpr Form kHitForms[] = {{HitForm::kTextbookFloat, "textbook, float"},
                              {HitForm::kTextbookDouble, "textbook, double"},
                              {HitForm::kStableFloat, "nacre's form, float"},
                              {HitForm::kNacre, "nacre (double)"}};

Plot HitPlot(StudyResult* result) {
  Plot plot;
  plot.title = "normals of hits";
  plot.x = {.label = "distance of the sphere (radii)", .log = true};
  plot.y = {.label = "rms error (rad)", .log = true};
  for (const Form& form : kHitForms) {
    Curve& curve = plot.curves.emplace_back();
    curve.title = form.name;
    curve.style = CurveStyle::kMarkedLine;
    for (int power = 1; power <= 7; ++power) {
      const double distance = std::pow(10, power);
      const HitError error = MeasureHits(form.form, distance);
      curve.x.push_back(distance);
      curve.y.push_back(error.normal);
      const std::string where = fmt::format("{}, distance 1e{}", form.name, power);
      result->numbers.push_back({"rms error of normals, " + where, error.normal, "rad"});
      result->numbers.push_back({"wrong hits and misses, " + where, error.wrong, ""});
    }
  }
  return plot;
}

Plot GgxPlot(StudyResult* result) {
  Plot plot;
  plot.title = "GGX highlights";
  plot.x = {.label = "roughness", .log = true, .low = 0.005, .high = 1};
  plot.y = {.label = "largest relative error within three widths",
            .log = true,
            .low = 1e-16,
            .high = 100};
  for (const auto& [form, name] : {std::pair{GgxForm::kTextbookFloat, "textbook, float"},
                                   {GgxForm::kTextbookDouble, "textbook, double"},
                                   {GgxForm::kNacre, "nacre's kernel"}}) {
    Curve& curve = plot.curves.emplace_back();
    curve.title = name;
    curve.style = CurveStyle::kMarkedLine;
    curve.look = form == GgxForm::kNacre ? 3 : static_cast<int>(plot.curves.size()) - 1;
    for (const double roughness :
         {0.005, 0.01, 0.02, 0.03, 0.05, 0.07, 0.1, 0.15, 0.2, 0.3, 0.5, 0.7}) {
      const double error = MeasureGgx(form, roughness);
      curve.x.push_back(roughness);
      curve.y.push_back(error);  // an infinite error gets no mark
      result->numbers.push_back(
          {fmt::format("largest relative error of GGX, {}, roughness {}", name, roughness), error,
           ""});
    }
  }
  return plot;
}

// Renders a matt sphere at this distance, seen through a telescope.
Rgb8Picture FarSphere(HitForm form, double distance) {
  constexpr int kPixels = 170;
  Rgb8Picture pane = FilledPicture(kPixels, kPixels, {13, 13, 13});
  const Vec3d center = Vec3d(0.3, -0.2, -1).normalized() * distance;
  const Vec3d right = (center % Vec3d(0, 1, 0)).normalized();
  const Vec3d up = (right % center).normalized();
  const Vec3d light = (right * 0.4 + up * 0.6 - center.normalized() * 0.7).normalized();
  for (int i = 0; i < kPixels * kPixels; ++i) {
    const double x = 2.2 * ((i % kPixels) + 0.5) / kPixels - 1.1;
    const double y = 1.1 - 2.2 * ((i / kPixels) + 0.5) / kPixels;
    const std::optional<Vec3d> normal = HitNormal(form, center, center + right * x + up * y);
    if (!normal) continue;
    const double shade = 0.03 + 0.9 * std::clamp(normal->dot(light), 0.0, 1.0);
    std::fill_n(pane.rgb8.begin() + 3 * i, 3, static_cast<uint8_t>(255 * SrgbOetf(shade) + 0.5));
  }
  return pane;
}

StudyPicture FarSpheres() {
  PaneSheet sheet;
  sheet.rows = {"textbook, float", "nacre"};
  for (const HitForm form : {HitForm::kTextbookFloat, HitForm::kNacre}) {
    for (const double distance : {10.0, 100.0, 1e3, 1e4, 1e5}) {
      sheet.panes.push_back(FarSphere(form, distance));
    }
  }
  sheet.columns = {"10 radii away", "100", "1000", "10 000", "100 000"};
  return MakeStudyPicture("far_spheres", "The same sphere from farther and farther away.", sheet);
}

}  // namespace

StudyResult StudyPrecision(const StudyProgress& progress) {
  StudyResult result;
  Plot hits = HitPlot(&result);
  progress(0.5);
  Plot ggx = GgxPlot(&result);
  const HitError far = MeasureHits(HitForm::kTextbookFloat, 1e4);
  const HitError ours = MeasureHits(HitForm::kNacre, 1e4);
  const double textbook = MeasureGgx(GgxForm::kTextbookFloat, 0.05);
  const double kernel = MeasureGgx(GgxForm::kNacre, 0.05);
  const double worst = std::ranges::max(ggx.curves[2].y);
  result.figures.push_back({"precision",
                            "Errors of hits and of highlights. The textbook's highlights in float "
                            "are infinite where their line ends.",
                            MakeRow({std::move(hits), std::move(ggx)})});
  result.pictures.push_back(FarSpheres());
  result.answer = fmt::format(
      "The quadratic subtracts squares of the distance to find something of the size of the "
      "radius: in float, at 10 000 radii, {:.0f} % of the rays hit or miss wrongly and the normals "
      "are {:.2g} rad off (rms). nacre measures the centre's distance from the ray instead, forms "
      "its products exactly and corrects once: {:g} % wrong and {:.0e} rad in double.\n\n"
      "The textbook's GGX forms (n.h)^2 (alpha^2 - 1) + 1, which is alpha^2 at the peak and made "
      "of ones: in float its error at roughness 0.05 is {:.0f} %. nacre's kernels take the sine of "
      "the half angle from |n x (l + v)|, and form it in double for narrow lobes: {:.0e} there, "
      "and {:.0e} at worst over all roughnesses of the plot.",
      100 * far.wrong, far.normal, 100 * ours.wrong, ours.normal, 100 * textbook, kernel, worst);
  progress(1);
  return result;
}

}  // namespace nacre
