// SPDX-License-Identifier: Apache-2.0
// cli/report_inputs.h: the inputs of nacre report, which are told apart by their contents.
#pragma once

#include <optional>
#include <string>

#include "cli/render_options.h"
#include "scene_io/json_text.h"

namespace nacre {

enum class ReportInput {
  kImage,       // EXR, PNG, ...
  kScene,       // to be rendered
  kReferences,  // a folder to validate
  kBench,       // bench.json
  kStats,       // JSON of render --stats, for the image before it
};

// Decides by the name and, for .json, by the contents. Throws Error (kBadInput).
ReportInput KindOfInput(const std::string& path);

// A picture with what is known about its making.
struct ReportPicture {
  std::string name;
  Image image;
  std::optional<Json> stats;
};

ReportPicture ReadPicture(const std::string& path, const std::string& part);
// Renders a scene. `output` is the report's file, which must not be an input of the scene.
ReportPicture RenderPicture(const std::string& path, const RenderOptions& options,
                            const std::string& output);

// Throws Error (kBadInput) for text that is not JSON.
Json ReadJson(const std::string& path);

}  // namespace nacre
