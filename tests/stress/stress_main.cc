// SPDX-License-Identifier: Apache-2.0
// tests/stress/stress_main.cc: the program behind scripts/stress: renders the stability gallery
// beside the truth, judges it, looks for leaks, and fuzzes the reflection models at length. Text to
// stdout.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <unistd.h>

#include "base/error.h"
#include "base/target.h"
#include "color/display.h"
#include "compare/heat_map.h"
#include "image_io/canvas.h"
#include "image_io/png_writer.h"
#include "render/render.h"
#include "stress/fuzz.h"
#include "stress/gallery.h"
#include "stress/leaks.h"
#include "stress/random_scene.h"
#include "stress/surface_fuzz.h"
#include "stress/truth_reflect.h"

namespace nacre {
namespace {

// One line that is written over, on a terminal; nothing in a pipe.
void ShowProgress(const std::string& text) {
  if (isatty(STDERR_FILENO) != 0) fmt::print(stderr, "\r{:<40}\r{}", "", text);
}

struct Options {
  std::string folder;  // for pictures; empty: none
  int width = 0;       // of pictures; 0: as the scenes say
  uint64_t random_scenes = 0;
  uint64_t draws = 0;               // of the fuzz; 0: none
  uint64_t rays = 0;                // at the seams of meshes; 0: none
  uint64_t models = 0;              // broken models on each target; 0: none
  std::vector<std::string> scenes;  // of the gallery; empty: all
  bool gallery = true;
};

// nacre, truth and error side by side, as 8-bit sRGB.
Rgb8Picture MakeTriptych(const Image& image, const TruthPicture& truth,
                         const Comparison& comparison) {
  const Rgb8Picture got = ShowImage(image, {});
  std::vector<float> plane[3];
  for (const TruthPixel& pixel : truth.pixels) {
    for (size_t c = 0; c < 3; ++c) {
      plane[c].push_back(static_cast<float>(pixel.radiance[static_cast<int>(c)]));
    }
  }
  Rgb8Picture expected = got;
  EncodeDisplay({}, plane[0].data(), plane[1].data(), plane[2].data(), truth.pixels.size(),
                expected.rgb8.data());
  Rgb8Picture errors{got.width, got.height, {}};
  const HeatScale scale{.low = 1e-8, .high = 1};
  for (const float error : comparison.error) {
    const Rgb8 color = error == 0 ? kHeatEqual : HeatColor(scale.Position(error));
    errors.rgb8.insert(errors.rgb8.end(), color.begin(), color.end());
  }
  Canvas canvas(3 * got.width, got.height, {0, 0, 0});
  canvas.Paste(got, 0, 0);
  canvas.Paste(expected, got.width, 0);
  canvas.Paste(errors, 2 * got.width, 0);
  return canvas.Draw();
}

// Returns whether every bound holds.
bool RunScene(const GalleryScene& entry, const Options& options) {
  const Scene scene = LoadGalleryScene(entry.name, options.width);
  const Image image = RenderImage(scene, {.layers = {"N", "Z", "id.object"}});
  const TruthPicture truth = RenderTruth(scene);
  const Comparison c = Compare(scene, image, truth);
  const bool holds = c.GeometryHolds() && c.RadianceHolds();
  fmt::print(
      "{:<18} {:>7} {:>5} {:>5} {:>6} {:>5} {:>8.1e} {:>8.1e} {:>8.1e} {:>8.1e} {:>8.2f}  {}{}\n",
      entry.name, c.pixels, c.doubtful, c.false_hits, c.false_misses, c.wrong_objects,
      c.normal_error, c.depth_error, c.radiance_error_most, c.radiance_error, c.of_bound,
      c.worst_material, holds ? "" : "  FAILS");
  if (c.not_finite > 0) fmt::print("{:<18} {} pixels not finite or negative\n", "", c.not_finite);
  std::fflush(stdout);
  if (!options.folder.empty()) {
    WritePng(fmt::format("{}/{}.png", options.folder, entry.name), MakeTriptych(image, truth, c));
  }
  return holds;
}

bool RunGallery(const Options& options) {
  if (!options.folder.empty()) std::filesystem::create_directories(options.folder);
  fmt::print("{:<18} {:>7} {:>5} {:>5} {:>6} {:>5} {:>8} {:>8} {:>8} {:>8} {:>8}  {}\n", "scene",
             "pixels", "doubt", "false", "false", "wrong", "normal", "depth", "radiance", "",
             "of its", "worst");
  fmt::print("{:<18} {:>7} {:>5} {:>5} {:>6} {:>5} {:>8} {:>8} {:>8} {:>8} {:>8}  {}\n", "", "",
             "ful", "hits", "misses", "ids", "max rad", "max rel", "99.99 %", "max", "bound",
             "material");
  bool holds = true;
  for (const GalleryScene& entry : GalleryScenes()) {
    const auto& names = options.scenes;
    if (!names.empty() && std::find(names.begin(), names.end(), entry.name) == names.end())
      continue;
    holds = RunScene(entry, options) && holds;
  }
  return holds;
}

// Renders `count` random scenes beside the truth. Tells the worst, and each that fails by its seed.
bool RunRandomScenes(uint64_t count) {
  uint64_t failed = 0, pixels = 0, doubtful = 0;
  double normal = 0, of_bound = 0;
  for (uint64_t seed = 0; seed < count; ++seed) {
    Scene scene = MakeRandomScene(seed);
    UsePlainForms(&scene);
    const Comparison c =
        Compare(scene, RenderImage(scene, {.threads = 1, .layers = {"N", "Z", "id.object"}}),
                RenderTruth(scene, 1));
    pixels += c.pixels;
    doubtful += c.doubtful;
    normal = std::max(normal, c.normal_error);
    of_bound = std::max(of_bound, c.of_bound);
    if (!c.GeometryHolds() || c.of_bound > kRandomSceneSlack) {
      ++failed;
      fmt::print(
          "random scene {}: {} false hits, {} misses, {} wrong ids, {} not finite, normal "
          "{:.1e}, {:.2f} of its bound ({})\n",
          seed, c.false_hits, c.false_misses, c.wrong_objects, c.not_finite, c.normal_error,
          c.of_bound, c.worst_material);
    }
    if (seed % 256 == 0) ShowProgress(fmt::format("random scenes {} of {}", seed, count));
  }
  ShowProgress("");
  fmt::print(
      "random scenes: {} of {} fail; {} pixels, {} doubtful, normal {:.1e} rad, {:.2f} of the "
      "radiance's bound\n",
      failed, count, pixels, doubtful, normal, of_bound);
  return failed == 0;
}

bool RunFuzz(uint64_t draws) {
  bool holds = true;
  for (const Target target : SupportedTargets()) {
    PinTarget(target);
    FuzzSettings settings;
    settings.draws = draws / SupportedTargets().size();
    settings.on_progress = [&](double done) {
      ShowProgress(fmt::format("fuzz {:<6} {:5.1f} %", TargetName(target), 100 * done));
    };
    const FuzzResult result = FuzzModels(settings);
    ShowProgress("");
    fmt::print("fuzz {:<6} {} draws: {}\n", TargetName(target), result.draws, Describe(result));
    std::fflush(stdout);
    holds = holds && result.Holds();
  }
  return holds;
}

bool RunLeaks(uint64_t rays) {
  bool holds = true;
  for (const Target target : SupportedTargets()) {
    PinTarget(target);
    LeakSettings settings;
    settings.rays = rays / SupportedTargets().size();
    settings.on_progress = [&](double done) {
      ShowProgress(fmt::format("leaks {:<6} {:5.1f} %", TargetName(target), 100 * done));
    };
    const LeakResult result = CountLeaks(settings);
    ShowProgress("");
    fmt::print("leaks {:<6} {} rays at the seams of closed meshes: {} get out\n",
               TargetName(target), result.rays, result.leaks);
    std::fflush(stdout);
    holds = holds && result.leaks == 0;
  }
  return holds;
}

bool RunSurfaces(uint64_t models) {
  bool holds = true;
  for (const Target target : SupportedTargets()) {
    PinTarget(target);
    const SurfaceFuzzResult result = FuzzSurfaces(models, [&](double done) {
      ShowProgress(fmt::format("models {:<6} {:5.1f} %", TargetName(target), 100 * done));
    });
    ShowProgress("");
    fmt::print("models {:<6} {} broken models: {}\n", TargetName(target), result.scenes,
               Describe(result));
    std::fflush(stdout);
    holds = holds && result.Holds();
  }
  return holds;
}

double ParseNumber(const std::string& name, const std::string& text) {
  char* end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  if (text.empty() || *end != '\0' || !(value >= 0 && value <= 1e15)) {
    throw Error(ExitCode::kUsage, name, "wants a number, not \"" + text + "\"");
  }
  return value;
}

// A name that no scene has would leave nothing to judge, and that would pass.
void CheckSceneNames(const std::vector<std::string>& names) {
  std::vector<std::string> known;
  for (const GalleryScene& entry : GalleryScenes()) known.emplace_back(entry.name);
  for (const std::string& name : names) {
    if (std::find(known.begin(), known.end(), name) != known.end()) continue;
    const std::string nearest = NearestName(name, known);
    throw Error(ExitCode::kUsage, name, "no scene of scenes/stability",
                nearest.empty() ? "" : "did you mean \"" + nearest + "\"?");
  }
}

Options ParseOptions(int count, char** arguments) {
  Options options;
  for (int i = 1; i < count; ++i) {
    const std::string name = arguments[i];
    const std::string value = i + 1 < count ? arguments[i + 1] : "";
    if (name == "--no-gallery") {
      options.gallery = false;
      continue;
    }
    if (name.rfind("--", 0) != 0) {
      options.scenes.push_back(name);
      continue;
    }
    ++i;
    if (name == "--out") {
      options.folder = value;
    } else if (name == "--width") {
      options.width = static_cast<int>(ParseNumber(name, value));
    } else if (name == "--random") {
      options.random_scenes = static_cast<uint64_t>(ParseNumber(name, value));
    } else if (name == "--draws") {
      options.draws = static_cast<uint64_t>(ParseNumber(name, value));
    } else if (name == "--rays") {
      options.rays = static_cast<uint64_t>(ParseNumber(name, value));
    } else if (name == "--models") {
      options.models = static_cast<uint64_t>(ParseNumber(name, value));
    } else {
      throw Error(ExitCode::kUsage, name, "unknown option", "see scripts/stress --help");
    }
  }
  CheckSceneNames(options.scenes);
  return options;
}

int Run(const Options& options) {
  bool holds = true;
  if (options.gallery) holds = RunGallery(options);
  if (options.random_scenes > 0) holds = RunRandomScenes(options.random_scenes) && holds;
  if (options.rays > 0) holds = RunLeaks(options.rays) && holds;
  if (options.models > 0) holds = RunSurfaces(options.models) && holds;
  if (options.draws > 0) holds = RunFuzz(options.draws) && holds;
  fmt::print("{}\n", holds ? "every bound holds" : "a bound is exceeded");
  return holds ? 0 : 1;
}

}  // namespace
}  // namespace nacre

int main(int argc, char** argv) try {
  return nacre::Run(nacre::ParseOptions(argc, argv));
} catch (const std::exception& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 2;
}
