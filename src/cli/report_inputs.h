// SPDX-License-Identifier: Apache-2.0
// cli/report_inputs.h: what nacre report is given, read or rendered, and told apart by what it is.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "cli/render_options.h"

namespace nacre {

enum class ReportInput {
  kImage,       // EXR, PNG, ...
  kScene,       // rendered
  kReferences,  // a folder, validated
  kBench,       // bench.json
  kStats,       // JSON of render --stats: belongs to the image before it
};

// From the name and, of .json, from what it holds. Throws Error (kBadInput).
ReportInput KindOfInput(const std::string& path);

// A picture with what is known of how it was made.
struct ReportPicture {
  std::string name;
  Image image;
  std::optional<nlohmann::ordered_json> stats;
};

ReportPicture ReadPicture(const std::string& path, const std::string& part);
// `output` is the report's file, which the scene must not be made of.
ReportPicture RenderPicture(const std::string& path, const RenderOptions& options,
                            const std::string& output);

// Throws Error (kBadInput) if it is not JSON.
nlohmann::ordered_json ReadJson(const std::string& path);

}  // namespace nacre
