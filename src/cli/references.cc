// SPDX-License-Identifier: Apache-2.0
#include "cli/references.h"

#include <algorithm>
#include <limits>

#include "base/error.h"
#include "cli/progress.h"
#include "image_io/read_image.h"
#include "render/render.h"
#include "scene_io/json_reader.h"
#include "scene_io/load_scene.h"
#include "scene_io/text_file.h"

namespace nacre {
namespace fs = std::filesystem;

namespace {

constexpr char kReferenceHint[] =
    R"({"scene": "x.json", "image": "x.exr", "tolerances": {"max_rel": 1e-5}, "reason": "why"})";

void RequireText(JsonObject* object, std::string_view name, std::string* text) {
  if (object->Require(name, kReferenceHint)) object->Text(name, text);
}

// Reads a member that names a file beside the reference. Adds a fault for paths that scenes in that
// folder may not refer to.
fs::path FindFile(const fs::path& folder, std::string_view name, const ReferenceOptions& options,
                  JsonObject* object) {
  std::string text;
  RequireText(object, name, &text);
  const auto value = object->Find(name);
  if (!value || !value->json.is_string()) return {};  // reported already
  try {
    ResolveReference(folder, text, {.allow_paths = options.allow_paths});
  } catch (const Error& error) {
    for (const Fault& fault : error.faults()) value->AddFault(fault.what, fault.hint);
  }
  return folder / text;
}

void ReadLayers(JsonObject* object, std::vector<std::string>* layers) {
  const auto value = object->Find("layers");
  if (!value || !value->Expect(value->json.is_array(), "an array of names",
                               R"(["", "diffuse"]; "" is the beauty)")) {
    return;
  }
  for (size_t i = 0; i < value->json.size(); ++i) {
    std::string layer;
    if (ReadText(value->Element(i), &layer)) layers->push_back(layer);
  }
}

void ReadTolerances(JsonObject* object, Tolerances* tolerances) {
  const auto value = object->Require("tolerances", kReferenceHint);
  if (!value) return;
  constexpr Range kError{0, 1e30};
  JsonObject members(*value);
  members.Number("max_abs", kError, &tolerances->max_abs);
  members.Number("max_rel", kError, &tolerances->max_rel);
  members.Number("exceeding_fraction", limits::kUnit, &tolerances->exceeding_fraction);
  tolerances->rmse = std::numeric_limits<double>::infinity();
  members.Number("rmse", kError, &tolerances->rmse);
  members.RefuseOthers();
}

}  // namespace

Reference ReadReference(const fs::path& path, const ReferenceOptions& options) {
  constexpr uint64_t kMaxBytes = uint64_t{1} << 20;
  const std::string file = path.string();
  Reference reference;
  FaultList faults;
  std::error_code error;
  if (!fs::is_regular_file(path, error)) {
    throw Error(ExitCode::kCannotCompare, file, "is not a regular file");
  }
  try {
    const Json root = ParseJson(ReadTextFile(path, kMaxBytes), file, &faults);
    JsonObject object({root, JsonPath{}, &faults}, kReferenceHint);
    reference.scene = FindFile(path.parent_path(), "scene", options, &object);
    reference.image = FindFile(path.parent_path(), "image", options, &object);
    ReadLayers(&object, &reference.layers);
    ReadTolerances(&object, &reference.tolerances);
    RequireText(&object, "reason", &reference.reason);
    object.RefuseOthers();
  } catch (const Error& error) {
    throw Error(ExitCode::kCannotCompare, error.faults());
  }
  ThrowFaults(faults, file, ExitCode::kCannotCompare);
  reference.name = path.stem().stem().string();
  return reference;
}

std::vector<fs::path> FindReferences(const std::string& folder) {
  std::error_code error;
  std::vector<fs::path> paths;
  fs::directory_iterator entry(folder, error);
  for (; !error && entry != fs::directory_iterator(); entry.increment(error)) {
    if (entry->path().filename().string().ends_with(".reference.json"))
      paths.push_back(entry->path());
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

// Throws Error for a scene or image that cannot be read, or if they do not fit each other.
ReferenceRun RunReference(const Reference& reference, const ReferenceOptions& options,
                          std::vector<std::string>* read) {
  ReferenceRun run;
  LoadOptions load;
  load.allow_paths = options.allow_paths;
  load.on_file = [&](const fs::path& file) { read->push_back(file.string()); };
  const Scene scene = LoadScene(reference.scene, load);
  RenderSettings settings;
  settings.threads = options.threads;
  settings.on_progress = [](double) { ThrowIfStopped(); };
  run.got = RenderImage(scene, settings);
  run.expected = ReadImage(reference.image.string());
  run.verdict = Judge(run.got, run.expected, reference.tolerances, OptionsOf(reference));
  return run;
}

}  // namespace

void RunReferences(const std::string& folder, const ReferenceOptions& options,
                   const std::function<void(const ReferenceOutcome&)>& done) {
  for (const fs::path& path : FindReferences(folder)) {
    ReferenceOutcome outcome;
    outcome.name = path.stem().stem().string();
    try {
      outcome.read = {path.string()};
      outcome.reference = ReadReference(path, options);
      outcome.read.push_back(outcome.reference.scene.string());
      outcome.read.push_back(outcome.reference.image.string());
      outcome.run = RunReference(outcome.reference, options, &outcome.read);
    } catch (const Error& error) {
      // The error is reported, and the remaining references are still run.
      if (error.code() != ExitCode::kBadInput && error.code() != ExitCode::kCannotCompare) throw;
      outcome.failure = error.faults().front().what;
      outcome.message = error.what();
    }
    done(outcome);
  }
}

}  // namespace nacre
