// SPDX-License-Identifier: Apache-2.0
// cli/metrics_json.h: the figures of a comparison for programs.
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "compare/perceptual.h"
#include "compare/verdict.h"

namespace nacre {

// "beauty" for the layer "", which has no name of its own, and back.
std::string LayerName(const std::string& layer);
std::string LayerOfName(const std::string& name);

// `perceptual`: of the layers that have any; their figures join those of their layer.
nlohmann::ordered_json MetricsJson(const std::vector<LayerMetrics>& layers,
                                   const std::vector<PerceptualMetrics>& perceptual);
nlohmann::ordered_json VerdictJson(const Verdict& verdict,
                                   const std::vector<PerceptualMetrics>& perceptual);

}  // namespace nacre
