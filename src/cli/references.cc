// SPDX-License-Identifier: Apache-2.0
#include "cli/references.h"

#include <algorithm>
#include <fstream>
#include <limits>

#include <nlohmann/json.hpp>

#include "base/error.h"
#include "cli/progress.h"
#include "image_io/exr_reader.h"
#include "render/render.h"
#include "scene_io/load_scene.h"

namespace nacre {
namespace fs = std::filesystem;

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

CompareOptions OptionsOf(const Reference& reference) {
  CompareOptions options;
  options.layers = reference.layers;
  options.got_name = reference.scene.string();
  options.reference_name = reference.image.string();
  return options;
}

namespace {

// Throws Error for a scene or image that cannot be read or that do not belong together.
ReferenceRun RunReference(const Reference& reference, int threads) {
  ReferenceRun run;
  const Scene scene = LoadScene(reference.scene, {});
  RenderSettings settings;
  settings.threads = threads;
  settings.on_progress = [](double) { ThrowIfStopped(); };
  run.got = RenderImage(scene, settings);
  run.expected = ReadExr(reference.image.string());
  run.verdict = Judge(run.got, run.expected, reference.tolerances, OptionsOf(reference));
  return run;
}

}  // namespace

void RunReferences(const std::string& folder, int threads,
                   const std::function<void(const ReferenceOutcome&)>& done) {
  for (const fs::path& path : FindReferences(folder)) {
    ReferenceOutcome outcome;
    outcome.name = path.stem().stem().string();
    try {
      outcome.reference = ReadReference(path);
      outcome.run = RunReference(outcome.reference, threads);
    } catch (const Error& error) {
      // Told, and the others still get their turn.
      if (error.code() != ExitCode::kBadInput && error.code() != ExitCode::kCannotCompare) throw;
      outcome.failure = error.faults().front().what;
      outcome.message = error.what();
    }
    done(outcome);
  }
}

}  // namespace nacre
