// SPDX-License-Identifier: Apache-2.0
// study/study_grid.cc: exercise 4: roughness and metallic over their range, under a lamp and a sky.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "scene/generators.h"
#include "study/picture.h"
#include "study/reflection.h"
#include "study/study.h"

namespace nacre {
namespace {

const Rgb kGold(1, 0.765, 0.336);  // the lesson's F0

MetallicRoughnessMaterial GoldOf(double roughness, double metallic) {
  return {.base_color = kGold, .metallic = metallic, .roughness = roughness};
}

Light Sky() {
  return {.name = "sky",
          .shadows = false,  // spheres do not hide the sky from each other, as if each were alone
          .kind = EnvironmentLight{.sky = GradientSky{.zenith = Rgb(0.25, 0.45, 0.9),
                                                      .horizon = Rgb(1.1, 1.05, 1),
                                                      .ground = Rgb(0.12, 0.09, 0.07)},
                                   .background = false}};
}

// Five by five spheres, with roughness 0 at the top.
Scene GridScene() {
  Grid grid;
  grid.material = MaterialOf(GoldOf(0, 0));
  grid.radius = 0.45;
  grid.rows = LinearAxis("roughness", Rgb(0), Rgb(1), 5);
  grid.columns = LinearAxis("metallic", Rgb(0), Rgb(1), 5);
  Scene scene;
  scene.camera.projection = Projection::kOrthographic;
  scene.camera.height = 5.1;
  scene.image.width = scene.image.height = 520;
  scene.image.spp = 128;
  scene.background = Rgb(0.02);
  AddGrid(grid, &scene);
  return scene;
}

Rgb8Picture RenderGrid(const Light& light) {
  Scene scene = GridScene();
  scene.lights = {light};
  return ShowImage(RenderLayers(scene), {.tone = ToneOperator::kNeutral});
}

// The largest specular radiance of the smooth and fully metallic sphere.
double SmoothMetalPeak(const Light& light) {
  const Image image = RenderLayers(SphereScene(GoldOf(0, 1), 128, {light}), {"specular"});
  return double{std::ranges::max(image.Find("specular.R")->samples)};
}

// The largest relative difference between a smooth white metal and its expected radiance, that of
// the sky in the mirror direction, over all pixels, with one sample each.
double MirrorError() {
  constexpr int kPixels = 128;
  Scene scene =
      SphereScene(MetallicRoughnessMaterial{.base_color = Rgb(1), .metallic = 1, .roughness = 0},
                  kPixels, {Sky()});
  scene.image.spp = 1;
  const Image image = RenderLayers(scene);
  const auto& sky = std::get<GradientSky>(std::get<EnvironmentLight>(scene.lights[0].kind).sky);
  double largest = 0;
  for (int i = 0; i < kPixels * kPixels; ++i) {
    const double x = ((i % kPixels) + 0.5 - kPixels / 2) * 2.2 / kPixels;
    const double y = (kPixels / 2 - (i / kPixels) - 0.5) * 2.2 / kPixels;
    if (x * x + y * y >= 1) continue;
    const Vec3d normal(x, y, std::sqrt(1 - x * x - y * y));
    const double up = 2 * normal.z * normal.y;  // y of the mirror direction
    const Rgb& end = up > 0 ? sky.zenith : sky.ground;
    const Rgb expected = sky.horizon + (end - sky.horizon) * std::abs(up);
    const float got = image.Find("R")->samples[static_cast<size_t>(i)];
    largest = std::max(largest, std::abs(double{got} / expected.x - 1));
  }
  return largest;
}

// The radiance in the mirror direction per unit of irradiance, with light and viewer at 30 degrees.
double PeakOf(double roughness) {
  return Reflect(PrepareMaterial(MaterialOf(GoldOf(roughness, 1))), Vec3d(0, 0, 1),
                 DirectionAt(-30), DirectionAt(30))
      .specular.x;
}

Figure PeakFigure() {
  Plot plot;
  plot.x = {.label = "roughness", .low = 0, .high = 1, .step = 0.1};
  plot.y = {.label = "radiance in the mirror direction per irradiance (1/sr)",
            .log = true,
            .low = 0.1,
            .high = 1e9};
  Curve& curve = plot.curves.emplace_back();
  for (int i = 2; i <= 200; ++i) {
    curve.x.push_back(i / 200.0);
    curve.y.push_back(PeakOf(i / 200.0));
  }
  return MakeFigure(std::move(plot));
}

}  // namespace

StudyResult StudyGrid(const StudyProgress& progress) {
  const Light lamp = SunTowards({0.5, 0.7, 0.9}, Rgb(2.5));
  StudyResult result;
  PaneSheet sheet;
  sheet.columns = {"under a lamp alone; metallic 0 to 1", "under a sky; metallic 0 to 1"};
  sheet.rows = {"roughness 0 to 1"};
  sheet.panes.push_back(RenderGrid(lamp));
  progress(0.2);
  sheet.panes.push_back(RenderGrid(Sky()));
  progress(0.8);
  result.pictures.push_back(MakeStudyPicture(
      "grids", "Gold: roughness 0 to 1 downwards, metallic 0 to 1 to the right.", sheet));
  result.figures.push_back({"peak",
                            "The smoother, the brighter and the narrower the highlight: as "
                            "1 / roughness^4, without an end.",
                            PeakFigure()});
  const double lamp_peak = SmoothMetalPeak(lamp);
  const double sky_peak = SmoothMetalPeak(Sky());
  const double error = MirrorError();
  result.numbers = {{"largest highlight of roughness 0 under a lamp", lamp_peak, ""},
                    {"largest reflection of roughness 0 under a sky", sky_peak, ""},
                    {"largest relative error of the mirror image of the sky", error, ""},
                    {"peak per irradiance, roughness 0.1", PeakOf(0.1), "1/sr"},
                    {"peak per irradiance, roughness 0.5", PeakOf(0.5), "1/sr"},
                    {"peak per irradiance, roughness 1", PeakOf(1), "1/sr"}};
  result.answer = fmt::format(
      "A metal has no diffuse part: all that it shows is what its microfacets mirror, tinted by "
      "F0. At roughness 0 they all lie flat, every ray leaves in the one mirror direction, and the "
      "sphere shows a sharp picture of its surroundings; at roughness 1 they point everywhere, and "
      "the same light is spread over the hemisphere: per unit of irradiance the mirror direction "
      "gets {:.2f}/sr at roughness 1, {:.2f} at 0.5 and {:.0f} at 0.1.\n\n"
      "That needs surroundings. Under a lamp that is a point the smooth metal is black (its "
      "largest highlight here: {:g}): the mirror image of a point has no size, and no pixel can "
      "show it. Under a sky its largest radiance is {:.3f}, and each pixel is the sky's radiance "
      "in the mirror direction, to {:.0e} of it.",
      PeakOf(1), PeakOf(0.5), PeakOf(0.1), lamp_peak, sky_peak, error);
  progress(1);
  return result;
}

}  // namespace nacre
