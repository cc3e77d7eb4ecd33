// SPDX-License-Identifier: Apache-2.0
// cli/metrics_json.h: the results of a comparison as JSON.
#pragma once

#include <string>
#include <vector>

#include "compare/perceptual.h"
#include "compare/verdict.h"
#include "scene_io/json_text.h"

namespace nacre {

// Converts the layer "", which has no name of its own, to "beauty" and back.
std::string LayerName(const std::string& layer);
std::string LayerOfName(const std::string& name);

// `perceptual` has the metrics of those layers that have any; they are merged with the layer's
// others.
Json MetricsJson(const std::vector<LayerMetrics>& layers,
                 const std::vector<PerceptualMetrics>& perceptual);
Json VerdictJson(const Verdict& verdict, const std::vector<PerceptualMetrics>& perceptual);

}  // namespace nacre
