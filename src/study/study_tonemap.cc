// SPDX-License-Identifier: Apache-2.0
// study/study_tonemap.cc: one HDR picture shown by each tone operator.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "color/tone.h"
#include "color/transfer.h"
#include "study/light_curves.h"
#include "study/measures.h"
#include "study/picture.h"
#include "study/study.h"

namespace nacre {

double AcesReachesWhite() {
  double low = 1;
  double high = 100;
  for (int i = 0; i < 60; ++i) {
    const double middle = (low + high) / 2;
    (ToneAces(middle) < 1 ? low : high) = middle;
  }
  return high;
}

GammaGap LargestGammaGap() {
  GammaGap gap;
  for (int i = 1; i <= 1000000; ++i) {
    const double linear = i * 1e-6;
    const double difference = std::abs(std::pow(linear, 1 / 2.2) - SrgbOetf(linear));
    if (difference > gap.difference) gap = {difference, linear};
  }
  return gap;
}

namespace {

Image RenderHdr() {
  const Light sky{.name = "sky",
                  .kind = EnvironmentLight{.sky = GradientSky{.zenith = Rgb(0.15, 0.3, 0.7),
                                                              .horizon = Rgb(0.6, 0.6, 0.6),
                                                              .ground = Rgb(0.08, 0.06, 0.05)}}};
  Scene scene =
      SphereScene(MetallicRoughnessMaterial{.base_color = Rgb(0.75, 0.12, 0.06), .roughness = 0.3},
                  150, {SunTowards({-1, 1.2, 1}, Rgb(6, 5.6, 5)), sky});
  scene.image.spp = 64;
  return RenderLayers(scene);
}

StudyPicture Operators(const Image& image) {
  PaneSheet sheet;
  for (const double ev : {-2.0, 0.0, 2.0, 4.0}) {
    for (const std::string& name : ToneOperatorNames()) {
      sheet.panes.push_back(ShowImage(image, {.tone = ParseToneOperator(name), .exposure_ev = ev}));
      if (ev == 0) sheet.columns.push_back(name == "reinhard_extended" ? "extended" : name);
    }
    sheet.rows.push_back(fmt::format("{:+g} EV", ev));
  }
  return MakeStudyPicture("operators",
                          "One linear picture under every operator and four exposures.", sheet);
}

}  // namespace

StudyResult StudyTonemap(const StudyProgress& progress) {
  const Image image = RenderHdr();
  progress(0.5);
  StudyResult result;
  result.pictures.push_back(Operators(image));
  result.figures.push_back({"curves", "What becomes of greys.", MakeFigure(TonePlot(0))});
  const double white = AcesReachesWhite();
  const double grey = ToneAces(0.18);
  const double reinhard = ToneReinhard(1.0);
  const GammaGap gap = LargestGammaGap();
  const double brightest = double{std::ranges::max(image.Find("R")->samples)};
  result.numbers = {{"brightest red of the picture", brightest, ""},
                    {"ACES of middle grey 0.18", grey, ""},
                    {"ACES is white from", white, ""},
                    {"Reinhard of 1", reinhard, ""},
                    {"largest difference of x^(1/2.2) and sRGB, encoded", gap.difference, ""},
                    {"at the linear value", gap.linear, ""}};
  result.answer = fmt::format(
      "The picture's radiance goes up to {:.1f}. Without an operator all above 1 is cut off, "
      "channel by channel, and the red turns to orange and yellow. Reinhard never reaches white (1 "
      "becomes {:.2f}) and greys the rest; extended Reinhard is white where it is told. ACES "
      "(Narkowicz' fit) is white from {:.4f} on and makes {:.4f} of middle grey. Khronos' Neutral "
      "keeps colours as they are until near white; AgX turns bright colours pale, as film does.\n\n"
      "After the operator comes the transfer curve: sRGB's, not x^(1/2.2), which differs by up to "
      "{:.4f} ({:.1f} codes of 255) at the linear value {:.5f}.",
      brightest, reinhard, white, grey, gap.difference, 255 * gap.difference, gap.linear);
  progress(1);
  return result;
}

}  // namespace nacre
