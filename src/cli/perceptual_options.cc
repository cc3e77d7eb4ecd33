// SPDX-License-Identifier: Apache-2.0
#include "cli/perceptual_options.h"

#include <algorithm>
#include <charconv>

#include <CLI/CLI.hpp>

#include "base/error.h"
#include "cli/help_text.h"
#include "cli/render_options.h"

namespace nacre {
namespace {

constexpr int kMaxExposures = 64;

[[noreturn]] void FailExposures(const std::string& text) {
  throw Error(ExitCode::kUsage, "--flip-exposures", "\"" + text + "\" is not a range of exposures",
              "give START,STOP in stops, from -60 to 60, and, if you like, how many: -4,4,9");
}

void ParseExposures(const std::string& text, PerceptualOptions* options) {
  std::vector<double> numbers;
  const char* at = text.data();
  const char* const end = at + text.size();
  while (true) {
    double number = 0;
    const auto [rest, error] = std::from_chars(at, end, number);
    if (error != std::errc() || !(number >= -60 && number <= 60)) FailExposures(text);
    numbers.push_back(number);
    if (rest == end) break;
    if (*rest != ',') FailExposures(text);
    at = rest + 1;
  }
  if (numbers.size() < 2 || numbers.size() > 3 || numbers[1] < numbers[0]) FailExposures(text);
  options->start_exposure = numbers[0];
  options->stop_exposure = numbers[1];
  if (numbers.size() < 3) return;
  options->exposures = static_cast<int>(numbers[2]);
  if (*options->exposures != numbers[2] || *options->exposures < 1) FailExposures(text);
}

}  // namespace

void AddPerceptualOptions(CLI::App* command, PerceptualArguments* a) {
  const InGroup group(command, "Perceptual metrics (layers with R, G and B)");
  CLI::Option* const metrics = command->add_option(
      "--metrics", a->metrics,
      "In addition: ssim (structural similarity, 1: equal), flip (visible difference "
      "when the pictures alternate, 0: none, 1: most), hdr_flip (the same at several "
      "exposures; linear images), all or none");
  metrics->delimiter(',')->allow_extra_args(false)->check(
      CLI::IsMember({"ssim", "flip", "hdr_flip", "all", "none"}));
  if (!a->metrics.empty()) metrics->capture_default_str();
  command
      ->add_option("--ppd", a->pixels_per_degree,
                   "FLIP: pixels per degree of vision. If not given 67: a display 0.7 m wide with "
                   "3840 pixels, seen from 0.7 m")
      ->check(InRange(1, 1000));
  command
      ->add_option("--flip-exposures", a->exposures,
                   "HDR-FLIP: from START to STOP stops in COUNT steps; if not given, from where "
                   "the reference's brightest pixel is nearly white to where its median is")
      ->type_name("START,STOP[,COUNT]");
  AddDisplayOptions(command, &a->display,
                    "Tone operator that shows linear images to SSIM and FLIP; as in nacre tonemap",
                    "Exposure in stops, likewise");
  MoveBehindHelpAll(command, {"--ppd", "--flip-exposures", "--tonemap", "--exposure"});
}

std::optional<PerceptualOptions> MakePerceptualOptions(const PerceptualArguments& arguments) {
  PerceptualOptions options;
  // Checked even if it is not used, so that an invalid range is reported.
  if (!arguments.exposures.empty()) ParseExposures(arguments.exposures, &options);
  if (options.exposures.value_or(1) > kMaxExposures) FailExposures(arguments.exposures);
  const auto asked = [&](const std::string& name) {
    const auto& names = arguments.metrics;
    return std::find(names.begin(), names.end(), name) != names.end() ||
           std::find(names.begin(), names.end(), "all") != names.end();
  };
  options.ssim = asked("ssim");
  options.flip = asked("flip");
  options.hdr_flip = asked("hdr_flip");
  if (!options.ssim && !options.flip && !options.hdr_flip) return std::nullopt;
  options.display = arguments.display;
  options.pixels_per_degree = arguments.pixels_per_degree;
  return options;
}

}  // namespace nacre
