// SPDX-License-Identifier: Apache-2.0
#include "render/rare_features.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "render/filter_shares.h"
#include "render/glints.h"
#include "render/interval.h"
#include "render/probes.h"

namespace nacre {
namespace {

// Features of one kind look alike, so that a sample that hits one of them represents the others.
// They are pooled: a pixel needs samples enough to hit any of them.
struct FeatureKind {
  uint32_t material;
  size_t light;  // of a highlight; kWholeSphere otherwise
  auto operator<=>(const FeatureKind&) const = default;
};
constexpr size_t kWholeSphere = std::numeric_limits<size_t>::max();

// A feature's projection, replaced by a square of the same area and centre, in pixels.
struct SmallFeature {
  FeatureKind kind;
  double x, y, half_side;
  double radiance;  // an upper bound, in excess of what surrounds it
};

void AddSmallSpheres(const FramePlan& plan, const Projector& projector,
                     const TileCandidates& candidates, std::vector<SmallFeature>* features) {
  for (const auto& cell : candidates.cells) {
    for (const TileCandidate& candidate : cell) {
      const ProjectedBounds b = ProjectClosely(projector, candidate.sphere);
      const double width = b.x1 - b.x0, height = b.y1 - b.y0;
      if (!b.visible || !(width < kMaxRareWidth && height < kMaxRareWidth)) continue;
      features->push_back(
          {{MaterialAt(plan.surfaces, candidate.primitive, (b.x0 + b.x1) / 2).index, kWholeSphere},
           (b.x0 + b.x1) / 2,
           (b.y0 + b.y1) / 2,
           std::sqrt(M_PI / 4 * width * height) / 2,
           plan.adaptive.brightest});
    }
  }
}

// The highlights that samples of the cell's pixels may hit.
std::vector<Glint> FindGlints(const FramePlan& plan, const Projector& projector, const Window& cell,
                              const TileCandidates& candidates) {
  std::vector<Glint> glints;
  for (const auto& in_cell : candidates.cells) {
    for (const TileCandidate& candidate : in_cell) {
      AddGlints(plan, projector, candidate, kMaxRareWidth * kMaxRareWidth, &glints);
    }
  }
  const double margin = plan.adaptive.filter_radius + kMaxRareWidth;
  const std::vector<Glint>& of_meshes = plan.adaptive.mesh_glints;
  const auto first = std::ranges::lower_bound(of_meshes, cell.y0 - margin, {}, &Glint::y);
  for (auto g = first; g != of_meshes.end() && g->y < cell.y1 + margin; ++g) glints.push_back(*g);
  std::erase_if(glints, [&](const Glint& g) {
    return !(g.x > cell.x0 - margin && g.x < cell.x1 + margin && g.y > cell.y0 - margin &&
             g.y < cell.y1 + margin);
  });
  return glints;
}

// Measures the radiance of each highlight by one ray to its peak and one beside it, which also
// finds whether other shapes shadow or hide it.
void AddHighlights(const FramePlan& plan, const std::vector<Glint>& glints, TileWork* work,
                   std::vector<SmallFeature>* features) {
  std::vector<Probe> probes;
  for (const Glint& g : glints) {
    probes.push_back({g.x, g.y});
    probes.push_back({g.x + g.beside_x, g.y + g.beside_y});
  }
  TraceProbes(plan, true, &probes, work);
  for (size_t i = 0; i < glints.size(); ++i) {
    const Glint& g = glints[i];
    const Probe &peak = probes[2 * i], &beside = probes[2 * i + 1];
    if (peak.hit != g.primitive) continue;  // something hides it
    double radiance = 0;
    for (int channel = 0; channel < 3; ++channel) {
      radiance = std::max(radiance, peak.radiance[channel] - beside.radiance[channel]);
    }
    if (!(radiance > 0)) continue;
    features->push_back({{g.material, g.light}, g.x, g.y, std::sqrt(g.area) / 2, radiance});
  }
}

// By pixel: the share of its samples that hit features of one kind, and the radiance that these add
// to the pixel.
struct Shares {
  double samples[kCellPixels] = {}, radiance[kCellPixels] = {};
};

// Adds a feature's share of the samples of each of the cell's pixels whose filter covers it.
void AddShares(const PixelFilter& filter, const Window& cell, const SmallFeature& feature,
               Shares* shares) {
  ForEachShare(filter, cell, {feature.x, feature.y, feature.half_side, feature.half_side},
               [&](uint32_t pixel, double share) {
                 if (share == 0) return;  // the radiance may be infinite
                 shares->samples[pixel] += share;
                 shares->radiance[pixel] += share * feature.radiance;
               });
}

}  // namespace

void FindRareFeatures(const FramePlan& plan, const Window& cell, const CellDust& dust,
                      TileWork* work, KnownFeatures* known) {
  std::fill_n(known->samples, kCellPixels, 0.0);
  std::fill_n(known->radiance, kCellPixels, 0.0);
  const TileCandidates& candidates = work->shapes.spheres;
  const Projector projector = MakeProjector(plan.camera);
  std::vector<SmallFeature> features;
  AddSmallSpheres(plan, projector, candidates, &features);
  const std::vector<Glint> glints = FindGlints(plan, projector, cell, candidates);
  AddHighlights(plan, glints, work, &features);
  std::ranges::stable_sort(features, {}, &SmallFeature::kind);
  const double least_tolerance = plan.adaptive.max_error * kDarkest;
  for (size_t i = 0; i < features.size();) {
    Shares shares;
    const FeatureKind kind = features[i].kind;
    for (; i < features.size() && features[i].kind == kind; ++i) {
      AddShares(plan.scene->image.filter, cell, features[i], &shares);
    }
    for (uint32_t pixel = 0; pixel < kCellPixels; ++pixel) {
      const double share = shares.samples[pixel], radiance = shares.radiance[pixel];
      if (share == 0 || radiance * 2 <= least_tolerance) continue;
      known->samples[pixel] =
          std::max(known->samples[pixel], kExpectedHits * dust.sampled_share[pixel] / share);
      known->radiance[pixel] += radiance;
    }
  }
  known->parts.clear();
  FindRareTriangles(plan, cell, work, &known->parts);
  FindRareTexels(plan, cell, work, known);
  std::ranges::stable_sort(known->parts, {}, &RarePart::pixel);
}

}  // namespace nacre
