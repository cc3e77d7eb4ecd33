// SPDX-License-Identifier: Apache-2.0
#include "view/metrics.h"

#include <cmath>

#include "compare/metrics.h"
#include "compare/perceptual.h"

namespace nacre {

Json BeautyMetricsJson(const Image& got, const Image& reference, const DisplaySettings& display) {
  CompareOptions options;
  options.layers = {""};
  const ImagePair pair = PairImages(got, reference, options);
  const LayerMetrics metrics = CompareLayer(pair, pair.layers.front());
  Json json = {{"rmse", metrics.rmse},
               {"rel_mse", metrics.rel_mse},
               // JSON has no infinity, which is the PSNR of equal pictures.
               {"psnr_db", std::isfinite(metrics.psnr_db) ? Json(metrics.psnr_db) : Json()},
               {"max_abs", std::isfinite(metrics.max_abs) ? Json(metrics.max_abs) : Json()},
               {"max_abs_at", {metrics.max_abs_at.x, metrics.max_abs_at.y}}};
  PerceptualOptions perceptual;
  perceptual.hdr_flip = false;  // takes seconds
  perceptual.display = display;
  for (const PerceptualMetrics& seen : MeasurePerceptual(got, reference, perceptual, options)) {
    if (seen.ssim) json["ssim"] = *seen.ssim;
    if (seen.flip_mean) json["flip"] = *seen.flip_mean;
  }
  return json;
}

}  // namespace nacre
