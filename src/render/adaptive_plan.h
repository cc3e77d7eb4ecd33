// SPDX-License-Identifier: Apache-2.0
// render/adaptive_plan.h: how a picture with a wanted error is sampled, decided once.
#pragma once

#include <array>
#include <vector>

#include "render/small_triangles.h"
#include "sampling/pixel_sampler.h"
#include "scene/scene.h"
#include "shading/material.h"

namespace nacre {

// Independent scramblings of the same sample pattern, whose spread tells the error of their mean.
inline constexpr int kReplicates = 4;

// A light that highlights may be of, as a point or a ball around what it extends over.
struct HighlightLight {
  size_t number;  // punctual ones first, then those with an extent, as in DirectPlan
  bool far;       // of parallel light
  Vec3d place;    // relative to the camera; of a far light the unit direction to it
  double radius;  // 0 of a punctual light
};

// A highlight of a light on a sphere or a mesh, in pixels of the frame.
struct Glint {
  uint32_t primitive;
  uint32_t material;
  size_t light;  // HighlightLight::number
  double x, y;   // where its peak lies
  double area;   // of a disk as bright as the peak that has all of the highlight's flux
  // From the peak a step on the film that is four times the highlight's half-width, or to the
  // sphere's centre if that is less: to what is seen beside it.
  double beside_x, beside_y;
};

struct AdaptivePlan {
  double max_error = 0;  // 0: every pixel takes the same samples
  double white = 0;      // WhiteLevel
  double brightest = 0;  // BrightestObject
  int max_samples = 0;   // about, of a pixel
  // Samples are added level by level: as many again as there are, in each replicate. Of most
  // filters they go on in one pattern, of which every such beginning is as well spread as a pattern
  // of its own, so that its error falls as that of uniform sampling. The weights of a filter with
  // negative lobes depend on the count: each level has a pattern of its own.
  struct Level {
    size_t pattern;
    int first, count;  // samples of the pattern
  };
  std::vector<Level> levels;
  std::vector<std::array<PixelSampler, kReplicates>> patterns;
  // Where the footprint test may stop a block at the pixels' centres:
  bool footprints = false;
  // Half the side of the square that a pixel is the mean of, where it may be known what share of it
  // a sphere covers before the background; or 0.
  double square = 0;
  PixelSampler center;
  double reach = 0.5;                  // of the pixel filter, from the centre
  double center_error = 0;             // of a centre's value, in units of its second differences
  std::vector<double> widths;          // of each material's narrowest lobe, in radians
  std::vector<HighlightLight> lights;  // all but skies
  SmallTriangles small_triangles;
  std::vector<Glint> mesh_glints;  // from the top of the film down
};

// `max_samples`: of a pixel, at least. Materials are those of the scene.
AdaptivePlan PlanAdaptive(const Scene& scene, const std::vector<ShadingMaterial>& materials,
                          double max_error, int max_samples);

}  // namespace nacre
