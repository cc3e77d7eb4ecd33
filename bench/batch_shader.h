// SPDX-License-Identifier: Apache-2.0
// bench/batch_shader.h: a batch of hits under one point light, shaded as the renderer does it.
#pragma once

#include <utility>
#include <vector>

#include "shading/shade.h"

namespace nacre {

// Hits with their directions rounded to float: what the renderer's camera rays arrive at.
struct PreparedHits {
  HitBatch hits;
  Surface surface;
};

class BatchShader {
 public:
  // Material i is that of the hits from i * run on.
  BatchShader(std::vector<ShadingMaterial> materials, size_t run, const PointLight& light)
      : materials_(std::move(materials)), run_(run) {
    light_ = PrepareLight(Light{.kind = light}, Vec3d(0));
  }

  // Writes what the first materials * run hits reflect to `radiance`.
  void Shade(PreparedHits* batch, ReflectedRadiance* radiance) {
    auto& [hits, surface] = *batch;
    EvaluateLight(light_, hits, surface, &on_hits_);
    for (size_t i = 0; i < materials_.size(); ++i) {
      PrepareRun(materials_[i], i * run_, (i + 1) * run_, &surface);
      ShadeRun(
          {{materials_[i], hits, surface, i * run_, (i + 1) * run_}, light_, &on_hits_, radiance},
          &scratch_);
    }
  }

 private:
  std::vector<ShadingMaterial> materials_;
  size_t run_;
  ShadingLight light_;
  LightBatch on_hits_;
  ShadeScratch scratch_;
};

}  // namespace nacre
