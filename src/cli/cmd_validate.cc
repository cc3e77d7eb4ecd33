// cli/cmd_validate.cc: nacre validate: renders scenes that have a reference image and compares.
//
// A folder of references holds, for each, NAME.reference.json:
//   {"scene": "x.json", "image": "x.exr", "layers": [""],
//    "tolerances": {"max_abs": 0, "max_rel": 1e-5, "exceeding_fraction": 0}, "reason": "..."}
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <memory>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "cli/commands.h"
#include "cli/print.h"
#include "cli/progress.h"
#include "cli/render_options.h"
#include "compare/verdict.h"
#include "image_io/exr_reader.h"
#include "render/render.h"
#include "scene_io/load_scene.h"

namespace nacre {
namespace {

namespace fs = std::filesystem;

struct Reference {
  std::string name;
  fs::path scene, image;
  std::vector<std::string> layers;
  Tolerances tolerances;
  std::string reason;  // why these tolerances
};

Reference ReadReference(const fs::path& path) {
  const auto fail = [&](const std::string& what) {
    throw Error(ExitCode::kCannotCompare, path.string(), what,
                "a reference names a scene, an image, tolerances and their reason");
  };
  std::ifstream file(path);
  const nlohmann::json json = nlohmann::json::parse(file, nullptr, /*allow_exceptions=*/false);
  if (!json.is_object()) fail("not a JSON object");
  Reference reference;
  try {
    reference.name = path.stem().stem().string();
    reference.scene = path.parent_path() / json.at("scene").get<std::string>();
    reference.image = path.parent_path() / json.at("image").get<std::string>();
    reference.layers = json.value("layers", std::vector<std::string>{});
    reference.reason = json.at("reason").get<std::string>();
    const nlohmann::json& tolerances = json.at("tolerances");
    reference.tolerances.max_abs = tolerances.value("max_abs", 0.0);
    reference.tolerances.max_rel = tolerances.value("max_rel", 0.0);
    reference.tolerances.exceeding_fraction = tolerances.value("exceeding_fraction", 0.0);
    reference.tolerances.rmse = tolerances.value("rmse", std::numeric_limits<double>::infinity());
  } catch (const nlohmann::json::exception& error) {
    fail(error.what());
  }
  return reference;
}

std::vector<fs::path> FindReferences(const std::string& folder) {
  std::error_code error;
  std::vector<fs::path> paths;
  for (const auto& entry : fs::directory_iterator(folder, error)) {
    if (entry.path().filename().string().ends_with(".reference.json"))
      paths.push_back(entry.path());
  }
  if (error || paths.empty()) {
    throw Error(ExitCode::kCannotCompare, folder,
                error ? error.message() : "no *.reference.json in this folder",
                "nacre validate DIR takes a folder of references, e.g. tests/references");
  }
  std::sort(paths.begin(), paths.end());
  return paths;
}

bool ValidateOne(const fs::path& path, int threads) {
  const Reference reference = ReadReference(path);
  const Scene scene = LoadScene(reference.scene, {});
  RenderSettings settings;
  settings.threads = threads;
  settings.on_progress = [](double) { ThrowIfStopped(); };
  const Image got = RenderImage(scene, settings);
  const Image expected = ReadExr(reference.image.string());
  CompareOptions options;
  options.layers = reference.layers;
  options.got_name = reference.scene.string();
  options.reference_name = reference.image.string();
  const Verdict verdict = Judge(got, expected, reference.tolerances, options);
  const LayerMetrics& m = verdict.layers.front();
  PrintOut(fmt::format("{:<24} {:<6} {:>11.3g} {:>11.3g} {:>11.3g} {:>9}  {}\n", reference.name,
                       verdict.match ? "match" : "DIFFER", m.rmse, m.max_rel, m.p999_rel,
                       verdict.exceeding_pixels,
                       verdict.match ? reference.reason : verdict.reason));
  return verdict.match;
}

}  // namespace

void AddValidateCommand(CLI::App* app, int* exit_code) {
  CLI::App* command = app->add_subcommand(
      "validate", "Render the scenes of a folder of references and compare with their images");
  struct Arguments {
    std::string folder = "tests/references";
    std::string target = "auto";
    int threads = 0;
  };
  const auto a = std::make_shared<Arguments>();
  command->add_option("DIR", a->folder, "Folder with *.reference.json files")
      ->capture_default_str();
  command->add_option("--threads", a->threads, "Threads to use; 0: as many as the machine has")
      ->check(CLI::Range(0, 1024));
  command->add_option("--target", a->target, "SIMD target: auto, avx3, avx2, sse4 or scalar")
      ->capture_default_str();
  command->footer("Exit code: 0 all match, 1 one differs, 2 one cannot be compared.");
  command->callback([a, exit_code] {
    ApplyTarget(a->target);
    const std::vector<fs::path> references = FindReferences(a->folder);
    PrintOut(fmt::format("{:<24} {:<6} {:>11} {:>11} {:>11} {:>9}  {}\n", "reference", "", "RMSE",
                         "max rel", "99.9% rel", "exceed", "tolerance's reason, or what differs"));
    bool all_match = true;
    bool all_compared = true;
    for (const fs::path& reference : references) {
      try {
        all_match = ValidateOne(reference, a->threads) && all_match;
      } catch (const Error& error) {
        // A missing scene or image: told, and the others still get their turn.
        if (error.code() != ExitCode::kBadInput && error.code() != ExitCode::kCannotCompare) throw;
        all_compared = false;
        PrintOut(fmt::format("{:<24} ERROR  {}\n", reference.stem().stem().string(),
                             error.faults().front().what));
        PrintError(fmt::format("{}\n", error.what()));
      }
    }
    *exit_code = static_cast<int>(!all_compared ? ExitCode::kCannotCompare
                                  : all_match   ? ExitCode::kOk
                                                : ExitCode::kDiffers);
  });
}

}  // namespace nacre
