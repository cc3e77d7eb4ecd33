// SPDX-License-Identifier: Apache-2.0
// render/adaptive_plan.h: decisions that adaptive sampling (adaptive.h) makes once per frame.
#pragma once

#include <array>
#include <memory>
#include <span>
#include <vector>

#include "render/small_triangles.h"
#include "sampling/pixel_sampler.h"
#include "scene/scene.h"
#include "shading/material.h"

namespace nacre {

// Independently scrambled copies of a pixel's sample pattern. Their spread estimates the error of
// their mean.
inline constexpr int kReplicates = 4;

// A light that causes highlights: a point, the bounding ball of a light with an extent, or a sun of
// a sky.
struct HighlightLight {
  size_t number;     // punctual lights first, then those with an extent, as in LightsPlan
  bool directional;  // its light is parallel
  Vec3d position;    // relative to the camera; of a directional light the unit direction to it
  double radius;     // 0 for a punctual light; in radians for a directional one
};

// A highlight of a light on a sphere or a mesh. Film positions and areas are in pixels.
struct Glint {
  uint32_t primitive;
  uint32_t material;
  size_t light;  // HighlightLight::number
  double x, y;   // of its peak on the film
  double area;   // of a disk of the peak's radiance that has the flux of the whole highlight
  // An offset on the film from the peak to a point beside the highlight: four times its half-width
  // towards the sphere's centre, or to the centre if that is nearer.
  double beside_x, beside_y;
};

struct TexelMaps;  // texel_maps.h

// Samples are taken level by level; each level doubles the samples of each replicate. For most
// filters a level continues one pattern, every prefix of which is as well distributed as a pattern
// of that length, so that the error falls as with uniform sampling. The weights of a filter with
// negative lobes depend on the number of samples, so each level has a pattern of its own.
struct SampleLevels {
  struct Level {
    size_t pattern;
    int first, count;  // samples of the pattern
  };
  std::vector<Level> levels;
  std::vector<std::array<PixelSampler, kReplicates>> patterns;
};

// What causes highlights.
struct HighlightCauses {
  std::vector<HighlightLight> lights;  // all but skies
  // The half-width of each material's narrowest lobe, in radians: of the half vector's angle or,
  // for Phong, of the angle from the mirrored direction, which is twice as wide (highlights.cc).
  std::vector<double> lobe_widths;
};

struct AdaptivePlan {
  double max_error = 0;  // relative, see ErrorBound; 0: all pixels take the same samples
  double white = 0;      // WhiteLevel
  double brightest = 0;  // BrightestObject
  int max_samples = 0;   // of a pixel; levels double, so that it may be up to twice as many
  SampleLevels sampling;
  // Whether blocks may stop at the centres of their pixels (footprint.h).
  bool footprints = false;
  // Half the side, in pixels, of the square that a box filter averages, if the coverage of pixels
  // on outlines can be computed exactly (outline_coverage.h); else 0.
  double box_half_side = 0;
  // As box_half_side, if samples may be restricted to dust (dust.h); else 0.
  double dust_half_side = 0;
  double filter_radius = 0.5;  // in pixels from a pixel's centre
  // The error of taking a pixel's centre for its mean, as a multiple of the second differences.
  double center_error = 0;
  HighlightCauses highlights;
  SmallTriangles small_triangles;
  std::vector<Glint> mesh_glints;               // by ascending y
  std::shared_ptr<const TexelMaps> texel_maps;  // null: there are none
};

// `max_samples` is AdaptivePlan::max_samples.
SampleLevels PlanSampleLevels(const Scene& scene, int max_samples);

// Whether the filter and the lights allow that blocks stop at the centres of their pixels.
bool CentersMaySuffice(const Scene& scene);

// AdaptivePlan::center_error.
double CenterError(const PixelFilter& filter);

// HighlightCauses::lobe_widths of the scene's materials, in its order.
std::vector<double> LobeWidths(std::span<const ShadingMaterial> materials);

}  // namespace nacre
