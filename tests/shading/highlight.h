// SPDX-License-Identifier: Apache-2.0
// tests/shading/highlight.h: highlights on random normals under one directional light, as the
// kernels shade them. For tests and for the tables of scripts/accuracy.
#pragma once

#include <cstdint>
#include <random>

#include "shading/shade.h"

namespace nacre {

inline constexpr size_t kHighlightHits = 1000;  // not a multiple of any vector
inline const Vec3d kHighlightToView(0, 0, 1);
inline const Vec3d kHighlightToLight = Vec3d(0.7, 0.2, 0.6).normalized();

// Hits around the mirror direction, where a lobe of that width is: n leans from the half vector by
// up to three widths, in each of two directions.
inline HitBatch MakeHighlight(double width, uint32_t seed) {
  HitBatch hits;
  hits.count = kHighlightHits;
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-3, 3);
  const Vec3d half = (kHighlightToLight + kHighlightToView).normalized();
  const Vec3d across = (half % Vec3d(0, 1, 0)).normalized();
  const Vec3d along = half % across;
  for (size_t i = 0; i < hits.count; ++i) {
    // Drawn one after the other: operands of one sum are evaluated in an order that is the
    // compiler's choice.
    const double x = uniform(random);
    const double y = uniform(random);
    const Vec3d n = (half + (across * x + along * y) * width).normalized();
    hits.normal.x[i] = n.x;
    hits.normal.y[i] = n.y;
    hits.normal.z[i] = n.z;
    hits.to_view.z[i] = 1;
    hits.position.z[i] = -5;
  }
  return hits;
}

// A highlight, and what the kernels of the active target make of it.
struct Highlight {
  HitBatch hits;
  ReflectedRadiance radiance;
};

inline Highlight ShadeHighlight(const ShadingMaterial& material, const Rgb& irradiance,
                                double width, uint32_t seed) {
  Highlight highlight{MakeHighlight(width, seed), {}};
  Light light;
  light.kind =
      DirectionalLight{.direction_of_travel = -kHighlightToLight, .irradiance = irradiance};
  Surface surface;
  ShadeScratch scratch;
  PrepareSurface(highlight.hits, &surface);
  PrepareRun(material, 0, highlight.hits.count, &surface);
  const ShadingLight prepared = PrepareLight(light, Vec3d(0));
  LightBatch on_hits;
  EvaluateLight(prepared, highlight.hits, surface, &on_hits);
  ShadeRun({{material, highlight.hits, surface, 0, highlight.hits.count},
            prepared,
            &on_hits,
            &highlight.radiance},
           &scratch);
  return highlight;
}

}  // namespace nacre
