// SPDX-License-Identifier: Apache-2.0
// cli/metrics_json.h: the results of a comparison as JSON.
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "compare/perceptual.h"
#include "compare/verdict.h"

namespace nacre {

// Converts the layer "", which has no name of its own, to "beauty" and back.
std::string LayerName(const std::string& layer);
std::string LayerOfName(const std::string& name);

// `perceptual` has the metrics of those layers that have any; they are merged with the layer's
// others.
nlohmann::ordered_json MetricsJson(const std::vector<LayerMetrics>& layers,
                                   const std::vector<PerceptualMetrics>& perceptual);
nlohmann::ordered_json VerdictJson(const Verdict& verdict,
                                   const std::vector<PerceptualMetrics>& perceptual);

}  // namespace nacre
