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
    light_.kind = light;
  }

  // Adds what the first materials * run hits reflect to `radiance`.
  void Shade(PreparedHits* batch, ReflectedRadiance* radiance) {
    auto& [hits, surface] = *batch;
    for (size_t i = 0; i < materials_.size(); ++i) {
      PrepareRun(materials_[i], i * run_, (i + 1) * run_, &surface);
    }
    EvaluateLight(light_, Vec3d(0), hits, surface, &lit_);
    for (size_t i = 0; i < materials_.size(); ++i) {
      ShadeRun(materials_[i], LightColor(light_), {hits, surface, lit_}, i * run_, (i + 1) * run_,
               &scratch_, radiance);
    }
  }

 private:
  std::vector<ShadingMaterial> materials_;
  size_t run_;
  Light light_;
  LightBatch lit_;
  NarrowLobes scratch_;
};

}  // namespace nacre
