// SPDX-License-Identifier: Apache-2.0
// scene_io/read_measured.cc: the tables of measured materials.
#include <utility>

#include <fmt/format.h>

#include "base/error.h"
#include "scene_io/measured_file.h"
#include "scene_io/readers.h"
#include "scene_io/text_file.h"

namespace nacre {
namespace {

// All tables of a scene together: some sixty of MERL's.
constexpr uint64_t kMaxMeasuredBytes = uint64_t{1} << 30;

std::shared_ptr<const MeasuredBrdf> FindMeasured(const std::filesystem::path& path,
                                                 SceneContext* context) {
  std::shared_ptr<const MeasuredBrdf>& known = context->measured[path.string()];
  if (known != nullptr) return known;
  std::shared_ptr<const MeasuredBrdf> brdf;
  std::string key;
  if (context->kept != nullptr) {
    key = KeyOfFile(path);
    const auto kept = context->kept->measured.find(key);
    if (kept != context->kept->measured.end()) brdf = kept->second.lock();
  }
  if (brdf == nullptr) brdf = ReadMeasuredFile(path);
  context->measured_bytes += MeasuredBytes(*brdf);
  if (context->measured_bytes > kMaxMeasuredBytes) {
    throw Error(ExitCode::kBadInput, {}, "the tables of all measured materials take over 1 GiB",
                "use fewer of them in one scene");
  }
  if (context->kept != nullptr) context->kept->measured[key] = brdf;
  return known = std::move(brdf);
}

}  // namespace

void ReadMeasuredTable(JsonObject* object, SceneContext* context, MeasuredMaterial* material) {
  const auto value = object->Find("file");
  if (!value || !ReadText(*value, &material->file)) return;
  try {
    material->brdf = FindMeasured(
        ResolveReference(context->folder, material->file, context->references), context);
  } catch (const Error& error) {
    AddFileFaults(error, *value);
  }
}

}  // namespace nacre
