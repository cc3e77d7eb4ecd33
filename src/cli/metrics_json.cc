// SPDX-License-Identifier: Apache-2.0
#include "cli/metrics_json.h"

#include <cmath>

namespace nacre {
namespace {

void AddPerceptualJson(const PerceptualMetrics& metrics, Json* json) {
  if (metrics.ssim) (*json)["ssim"] = *metrics.ssim;
  if (metrics.flip_mean) {
    (*json)["flip"] = {{"mean", *metrics.flip_mean}, {"max", *metrics.flip_max}};
  }
  if (metrics.hdr_flip_mean) {
    (*json)["hdr_flip"] = {{"mean", *metrics.hdr_flip_mean},
                           {"max", *metrics.hdr_flip_max},
                           {"start_exposure", metrics.exposures.start},
                           {"stop_exposure", metrics.exposures.stop},
                           {"exposures", metrics.exposures.count}};
  }
  if (!metrics.notes.empty()) (*json)["notes"] = metrics.notes;
}

}  // namespace

std::string LayerName(const std::string& layer) { return layer.empty() ? "beauty" : layer; }
std::string LayerOfName(const std::string& name) { return name == "beauty" ? "" : name; }

Json MetricsJson(const std::vector<LayerMetrics>& layers,
                 const std::vector<PerceptualMetrics>& perceptual) {
  Json all = Json::array();
  for (const LayerMetrics& m : layers) {
    Json json = {{"layer", LayerName(m.layer)},
                 {"samples", m.samples},
                 {"rmse", m.rmse},
                 {"rel_mse", m.rel_mse},
                 // Equal images have an infinite PSNR, which JSON cannot express: it becomes null.
                 {"psnr_db", std::isfinite(m.psnr_db) ? Json(m.psnr_db) : Json()},
                 {"max_abs", m.max_abs},
                 {"max_abs_at", {m.max_abs_at.x, m.max_abs_at.y}},
                 {"max_rel", m.max_rel},
                 {"p999_rel", m.p999_rel},
                 {"zero_mismatches", m.zero_mismatches},
                 {"mean", m.mean_got},
                 {"mean_reference", m.mean_reference},
                 {"nonfinite_mismatches", m.nonfinite_mismatches}};
    for (const PerceptualMetrics& p : perceptual) {
      if (p.layer == m.layer) AddPerceptualJson(p, &json);
    }
    all.push_back(json);
  }
  return all;
}

Json VerdictJson(const Verdict& verdict, const std::vector<PerceptualMetrics>& perceptual) {
  return {{"match", verdict.match},
          {"reason", verdict.reason},
          {"pixels", verdict.pixels},
          {"exceeding_pixels", verdict.exceeding_pixels},
          {"layers", MetricsJson(verdict.layers, perceptual)}};
}

}  // namespace nacre
