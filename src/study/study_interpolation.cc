// SPDX-License-Identifier: Apache-2.0
// study/study_interpolation.cc: exercise 3: flat, Gouraud and Phong shading over the number of
// faces.
#include <algorithm>
#include <cmath>
#include <string>

#include <fmt/format.h>

#include "scene/sphere_mesh.h"
#include "study/measures.h"
#include "study/picture.h"
#include "study/study.h"

namespace nacre {

Image RenderIcosphere(Interpolation interpolation, int subdivisions, int pixels) {
  const PhongMaterial phong{.convention = PhongConvention::kClassic,
                            .ka = Rgb(0),
                            .kd = Rgb(0.7),
                            .ks = Rgb(0.5),
                            .shininess = 64};
  Scene scene = SphereScene(phong, pixels, {SunTowards({2, 3, 3}, Rgb(1))});
  scene.image.spp = 1;
  scene.image.shadows = false;
  scene.spheres.clear();
  Mesh mesh = MakeMesh(Icosphere{.subdivisions = subdivisions});
  mesh.material = {0};
  mesh.interpolation = interpolation;
  scene.meshes.push_back(std::move(mesh));
  return RenderLayers(scene, {"diffuse", "specular"});
}

InterpolationError MeasureInterpolation(const Image& image, const Image& exact) {
  const std::vector<float>& alpha = exact.Find("A")->samples;
  const auto measure = [&](const char* channel, double* max, double* rms) {
    const std::vector<float>& got = image.Find(channel)->samples;
    const std::vector<float>& truth = exact.Find(channel)->samples;
    double squares = 0;
    size_t count = 0;
    for (size_t i = 0; i < alpha.size(); ++i) {
      if (alpha[i] == 0) continue;
      const double difference = double{got[i]} - double{truth[i]};
      *max = std::max(*max, std::abs(difference));
      squares += difference * difference;
      ++count;
    }
    *rms = std::sqrt(squares / static_cast<double>(count));
  };
  InterpolationError error;
  measure("diffuse.G", &error.diffuse_max, &error.diffuse_rms);
  measure("specular.G", &error.specular_max, &error.specular_rms);
  error.specular_peak = double{std::ranges::max(image.Find("specular.G")->samples)};
  return error;
}

namespace {

constexpr int kLevels = 7;  // 20 to 81 920 faces
constexpr int kMeasurePixels = 600, kPanePixels = 190;
constexpr double kCode = 1.0 / 255;

int FacesOf(int level) { return 20 << (2 * level); }

struct Level {
  InterpolationError flat, gouraud, phong;
};

std::vector<Level> MeasureLevels(const StudyProgress& progress) {
  std::vector<Level> levels;
  for (int level = 0; level < kLevels; ++level) {
    const auto render = [&](Interpolation interpolation) {
      return RenderIcosphere(interpolation, level, kMeasurePixels);
    };
    const Image exact = render(Interpolation::kPhong);
    levels.push_back({MeasureInterpolation(render(Interpolation::kFlat), exact),
                      MeasureInterpolation(render(Interpolation::kGouraud), exact),
                      MeasureInterpolation(exact, exact)});
    progress(0.7 * (level + 1) / kLevels);
  }
  return levels;
}

Plot ErrorPlot(const std::vector<Level>& levels, bool specular) {
  Plot plot;
  plot.title = specular ? "specular" : "diffuse";
  plot.x = {.label = "faces", .log = true};
  plot.y = {.label = "error of radiance (1: white)", .log = true, .low = 1e-4, .high = 1};
  const auto add = [&](const char* title, double InterpolationError::*error,
                       InterpolationError Level::*kind) {
    Curve& curve = plot.curves.emplace_back();
    curve.title = title;
    curve.style = CurveStyle::kMarkedLine;
    for (int level = 0; level < kLevels; ++level) {
      curve.x.push_back(FacesOf(level));
      curve.y.push_back(levels[static_cast<size_t>(level)].*kind.*error);
    }
  };
  const auto rms = specular ? &InterpolationError::specular_rms : &InterpolationError::diffuse_rms;
  const auto max = specular ? &InterpolationError::specular_max : &InterpolationError::diffuse_max;
  add("flat, largest", max, &Level::flat);
  add("flat, rms", rms, &Level::flat);
  add("Gouraud, largest", max, &Level::gouraud);
  add("Gouraud, rms", rms, &Level::gouraud);
  plot.rules.push_back({Rule::Across::kY, kCode, "one 8-bit code"});
  return plot;
}

// Plots the diffuse light, and its slope, along a horizontal line across the sphere, slightly above
// the middle, where there is no vertex.
Figure MachFigure() {
  constexpr int kLevel = 2;
  Plot value, slope;
  value.title = fmt::format("diffuse light across a sphere of {} faces", FacesOf(kLevel));
  slope.title = "its slope: steps are Mach bands";
  value.x = slope.x = {.label = "from left to right (radii)", .low = -1, .high = 1, .step = 0.5};
  value.y = {.label = "radiance (1: white)", .low = 0};
  slope.y = {.label = "change of radiance per radius", .low = -1, .high = 1};
  for (const auto& [title, interpolation] :
       {std::pair{"flat", Interpolation::kFlat}, std::pair{"Gouraud", Interpolation::kGouraud},
        std::pair{"Phong: the exact sphere's", Interpolation::kPhong}}) {
    const Image image = RenderIcosphere(interpolation, kLevel, kMeasurePixels);
    const std::vector<float>& samples = image.Find("diffuse.G")->samples;
    const size_t row = static_cast<size_t>(kMeasurePixels * 9 / 20) * kMeasurePixels;
    const double pixel = 2.2 / kMeasurePixels;
    Curve light, change;
    light.title = title;
    for (int x = 0; x + 1 < kMeasurePixels; ++x) {
      const size_t i = row + static_cast<size_t>(x);
      if (image.Find("A")->samples[i] == 0 || image.Find("A")->samples[i + 1] == 0) continue;
      light.x.push_back((x + 0.5 - kMeasurePixels / 2) * pixel);
      light.y.push_back(double{samples[i]});
      change.x.push_back((x + 1 - kMeasurePixels / 2) * pixel);
      change.y.push_back((double{samples[i + 1]} - double{samples[i]}) / pixel);
    }
    value.curves.push_back(std::move(light));
    if (interpolation == Interpolation::kFlat) continue;  // its slope is 0 or unbounded
    change.look = static_cast<int>(value.curves.size()) - 1;
    slope.curves.push_back(std::move(change));
  }
  return MakeRow({std::move(value), std::move(slope)});
}

StudyPicture Pictures() {
  PaneSheet sheet;
  sheet.rows = {"flat", "Gouraud", "Phong"};
  for (const Interpolation interpolation :
       {Interpolation::kFlat, Interpolation::kGouraud, Interpolation::kPhong}) {
    for (int level = 0; level < 5; ++level) {
      sheet.panes.push_back(
          ShowImage(RenderIcosphere(interpolation, level, kPanePixels), kClipped));
      if (interpolation == Interpolation::kFlat) {
        sheet.columns.push_back(fmt::format("{} faces", FacesOf(level)));
      }
    }
  }
  return MakeStudyPicture("interpolations", "The same meshes, by what is interpolated.", sheet);
}

// The smallest number of faces for which the error is below one 8-bit code; 0 if there is none.
int FacesBelowCode(const std::vector<Level>& levels, double InterpolationError::*error,
                   InterpolationError Level::*kind = &Level::gouraud) {
  for (int level = 0; level < kLevels; ++level) {
    if (levels[static_cast<size_t>(level)].*kind.*error < kCode) return FacesOf(level);
  }
  return 0;
}

std::string Table(const std::vector<Level>& levels) {
  std::string table =
      "| faces | flat, diffuse rms | Gouraud, diffuse rms | largest | Gouraud, specular rms | its "
      "peak of 0.5 |\n|---|---|---|---|---|---|\n";
  for (int level = 0; level < kLevels; ++level) {
    const auto& [flat, gouraud, phong] = levels[static_cast<size_t>(level)];
    table += fmt::format("| {} | {:.4f} | {:.4f} | {:.4f} | {:.4f} | {:.0f} % |\n", FacesOf(level),
                         flat.diffuse_rms, gouraud.diffuse_rms, gouraud.diffuse_max,
                         gouraud.specular_rms, 100 * gouraud.specular_peak / 0.5);
  }
  return table;
}

void AddNumbers(const std::vector<Level>& levels, StudyResult* result) {
  for (int level = 0; level < kLevels; ++level) {
    const Level& at = levels[static_cast<size_t>(level)];
    for (const auto& [name, error] :
         {std::pair{"flat", &at.flat}, {"Gouraud", &at.gouraud}, {"Phong", &at.phong}}) {
      const std::string beginning = fmt::format("{}, {} faces: ", name, FacesOf(level));
      const auto add = [&](const char* what, double value) {
        result->numbers.push_back({beginning + what, value, ""});
      };
      add("diffuse, largest", error->diffuse_max);
      add("diffuse, rms", error->diffuse_rms);
      add("specular, largest", error->specular_max);
      add("specular, rms", error->specular_rms);
      add("specular, peak", error->specular_peak);
    }
  }
}

}  // namespace

StudyResult StudyInterpolation(const StudyProgress& progress) {
  const std::vector<Level> levels = MeasureLevels(progress);
  StudyResult result;
  AddNumbers(levels, &result);
  result.pictures.push_back(Pictures());
  progress(0.8);
  result.figures.push_back({"errors", "Errors over the number of faces.",
                            MakeRow({ErrorPlot(levels, false), ErrorPlot(levels, true)})});
  result.figures.push_back(
      {"mach_bands", "Gouraud's light is continuous, its slope is not.", MachFigure()});
  result.answer = fmt::format(
      "Where its mean error is less than what 8 bits can show: for diffuse light from {} faces on "
      "(rms below 1/255; the largest error only from {}), for the highlight of exponent 64 from {} "
      "(rms). With fewer faces the highlight falls between the vertices and is missed: of its peak "
      "20 faces show {:.0f} %, 320 show {:.0f} % and 1280 show {:.0f} %. Flat shading needs {} "
      "faces to get its diffuse light below 1/255 rms. Phong's normals are the sphere's: "
      "its error is {:g} on every mesh, only the outline has corners.\n\n{}\n"
      "Lower than the error of the values is the eye's tolerance of kinks: Gouraud's slope jumps "
      "at every edge, and the eye sees the jumps as bright and dark lines (Mach bands).",
      FacesBelowCode(levels, &InterpolationError::diffuse_rms),
      FacesBelowCode(levels, &InterpolationError::diffuse_max),
      FacesBelowCode(levels, &InterpolationError::specular_rms),
      200 * levels[0].gouraud.specular_peak, 200 * levels[2].gouraud.specular_peak,
      200 * levels[3].gouraud.specular_peak,
      FacesBelowCode(levels, &InterpolationError::diffuse_rms, &Level::flat),
      levels[6].phong.diffuse_max, Table(levels));
  progress(1);
  return result;
}

}  // namespace nacre
