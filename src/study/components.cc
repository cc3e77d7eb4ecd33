// SPDX-License-Identifier: Apache-2.0
// study/components.cc: exercise 1: the effect of the exponent on each of Phong's components.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "study/picture.h"
#include "study/reflection.h"
#include "study/study.h"

namespace nacre {
namespace {

constexpr double kExponents[] = {4, 16, 64, 256};
const char* const kComponents[] = {"ambient", "diffuse", "specular"};

Image RenderExponent(double shininess) {
  const PhongMaterial phong{.convention = PhongConvention::kClassic,
                            .color = Rgb(0.8, 0.2, 0.2),
                            .ka = Rgb(0.1),
                            .kd = Rgb(0.7),
                            .ks = Rgb(0.5),
                            .shininess = shininess};
  const Light sky{.name = "sky", .kind = AmbientLight{Rgb(1)}};
  return RenderLayers(SphereScene(phong, 200, {SunTowards({2, 3, 3}, Rgb(1)), sky}),
                      {"ambient", "diffuse", "specular"});
}

// The largest difference of a component between two pictures.
double LargestDifference(const Image& a, const Image& b, const std::string& layer) {
  double largest = 0;
  for (const char* channel : {".R", ".G", ".B"}) {
    const std::vector<float>& x = a.Find(layer + channel)->samples;
    const std::vector<float>& y = b.Find(layer + channel)->samples;
    for (size_t i = 0; i < x.size(); ++i) {
      largest = std::max(largest, std::abs(double{x[i]} - double{y[i]}));
    }
  }
  return largest;
}

// The largest difference between the picture and the sum of its components.
double SumError(const Image& image) {
  double largest = 0;
  for (const char* channel : {"R", "G", "B"}) {
    const std::vector<float>& whole = image.Find(channel)->samples;
    for (size_t i = 0; i < whole.size(); ++i) {
      double sum = 0;
      for (const char* layer : kComponents) {
        sum += double{image.Find(std::string(layer) + "." + channel)->samples[i]};
      }
      largest = std::max(largest, std::abs(sum - double{whole[i]}));
    }
  }
  return largest;
}

// The fraction of the sphere's pixels whose highlight is at least half its peak, ks.
double HighlightShare(const Image& image) {
  size_t sphere = 0;
  size_t bright = 0;
  const std::vector<float>& specular = image.Find("specular.G")->samples;
  const std::vector<float>& alpha = image.Find("A")->samples;
  for (size_t i = 0; i < alpha.size(); ++i) {
    sphere += alpha[i] > 0.5f;
    bright += alpha[i] > 0.5f && specular[i] >= 0.25f;
  }
  return static_cast<double>(bright) / static_cast<double>(sphere);
}

Figure LobeFigure() {
  Plot plot;
  plot.x = {.label = "angle between viewer and mirror direction (degrees)",
            .low = 0,
            .high = 90,
            .step = 15};
  plot.y = {.label = "lobe (r.v)^n (1: its peak)", .low = 0, .high = 1};
  for (const double n : kExponents) {
    plot.curves.push_back(MakeCurve(fmt::format("n = {}", n), Steps(0, 90, 360), [&](double x) {
      return std::pow(std::max(DirectionAt(x).z, 0.0), n);
    }));
  }
  plot.rules.push_back({Rule::Across::kY, 0.5, "half of the peak"});
  return MakeFigure(std::move(plot));
}

std::string ComponentsAnswer(double same, double sum, const std::string& shares) {
  return fmt::format(
      "The exponent changes the specular component and nothing else: between n = {} and n = {} the "
      "ambient and the diffuse picture differ by {:g} at most. The highlight keeps its peak, ks, "
      "and narrows: its lobe falls to one half at acos(0.5^(1/n)) from the mirror direction.\n\n"
      "| n | half width | share of the sphere with at least half of the peak |\n|---|---|---|\n{}\n"
      "The components are radiance and add up: their sum differs from the whole picture by {:.1e} "
      "at most, which is the rounding of the layers to float.",
      kExponents[0], kExponents[3], same, shares, sum);
}

}  // namespace

StudyResult StudyComponents(const StudyProgress& progress) {
  StudyResult result;
  PaneSheet sheet;
  sheet.columns = {"ambient", "diffuse", "specular", "together"};
  std::vector<Image> images;
  double same = 0, sum = 0;
  std::string shares;
  for (const double n : kExponents) {
    images.push_back(RenderExponent(n));
    const Image& image = images.back();
    for (const char* layer : {"ambient", "diffuse", "specular", ""}) {
      sheet.panes.push_back(ShowImage(image, kClipped, layer));
    }
    sheet.rows.push_back(fmt::format("n = {}", n));
    for (const char* layer : {"ambient", "diffuse"}) {
      same = std::max(same, LargestDifference(image, images.front(), layer));
    }
    sum = std::max(sum, SumError(image));
    const double half_width = std::acos(std::pow(0.5, 1 / n)) * 180 / M_PI;
    const double share = HighlightShare(image);
    result.numbers.push_back({fmt::format("half width of the lobe, n = {}", n), half_width, "deg"});
    result.numbers.push_back(
        {fmt::format("share of the sphere with at least half of ks, n = {}", n), share, ""});
    shares += fmt::format("| {} | {:.2f}° | {:.2f} % |\n", n, half_width, 100 * share);
    progress(static_cast<double>(images.size()) / std::size(kExponents));
  }
  result.numbers.push_back(
      {"largest change of ambient and diffuse between the exponents", same, ""});
  result.numbers.push_back({"largest difference of the components' sum to the whole", sum, ""});
  result.pictures.push_back(MakeStudyPicture(
      "components", "The components apart and together, for four exponents.", sheet));
  result.figures.push_back(
      {"lobes", "Phong's lobe: the larger the exponent, the narrower.", LobeFigure()});
  result.answer = ComponentsAnswer(same, sum, shares);
  return result;
}

}  // namespace nacre
