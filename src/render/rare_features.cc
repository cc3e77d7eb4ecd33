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
#include "render/rare_texels.h"
#include "render/rare_triangles.h"

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
  const auto first = std::lower_bound(of_meshes.begin(), of_meshes.end(), cell.y0 - margin,
                                      [](const Glint& g, double y) { return g.y < y; });
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
  constexpr size_t kPerBatch = kBatchCapacity / 2;
  bool is_visible[kPerBatch];  // by highlight: nothing hides its peak
  TileWork& s = *work;
  for (size_t first = 0; first < glints.size(); first += kPerBatch) {
    const size_t count = std::min(kPerBatch, glints.size() - first);
    for (size_t i = 0; i < count; ++i) {
      const Glint& g = glints[first + i];
      s.samples.film.x[2 * i] = g.x;
      s.samples.film.y[2 * i] = g.y;
      s.samples.film.x[2 * i + 1] = g.x + g.beside_x;
      s.samples.film.y[2 * i + 1] = g.y + g.beside_y;
    }
    s.samples.film.count = 2 * count;
    if (plan.sampling.numbered) NumberAlike(s.samples.film.count, &EnsureNumbers(&s.samples));
    ShadeSamples(plan, &s);
    const Layer& beauty = plan.film.layers[0];
    Soa3<double>& values = GatherLayer(plan.film, beauty, 0, BackgroundOf(beauty, plan.film),
                                       BatchOf(plan, s), &s.layer_room);
    std::fill_n(is_visible, count, false);
    for (size_t hit = 0; hit < s.surfaces.hits.count; ++hit) {
      const uint32_t ray = s.surfaces.hits.ray[hit];
      if (ray % 2 != 0) continue;
      is_visible[ray / 2] = s.surfaces.hits.primitive[hit] == glints[first + ray / 2].primitive;
    }
    for (size_t i = 0; i < count; ++i) {
      if (!is_visible[i]) continue;
      const Glint& g = glints[first + i];
      double radiance = 0;
      for (int channel = 0; channel < 3; ++channel) {
        const double* const value = ChannelOf(values, channel).data() + 2 * i;
        radiance = std::max(radiance, value[0] - value[1]);
      }
      if (!(radiance > 0)) continue;
      features->push_back({{g.material, g.light}, g.x, g.y, std::sqrt(g.area) / 2, radiance});
    }
  }
}

// By pixel of a cell, row by row: the share of its samples that hit features of one kind, and the
// radiance that these add to the pixel.
struct Shares {
  double samples[kCellSize][kCellSize] = {};
  double radiance[kCellSize][kCellSize] = {};
};

// Adds a feature's share of the samples of each of the cell's pixels whose filter covers it.
void AddShares(const PixelFilter& filter, const Window& cell, const SmallFeature& feature,
               Shares* shares) {
  ForEachShare(filter, cell, {feature.x, feature.y, feature.half_side, feature.half_side},
               [&](int column, int row, double share) {
                 if (share == 0) return;  // the radiance may be infinite
                 shares->samples[row][column] += share;
                 shares->radiance[row][column] += share * feature.radiance;
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
  std::stable_sort(features.begin(), features.end(),
                   [](const SmallFeature& a, const SmallFeature& b) { return a.kind < b.kind; });
  const double least_tolerance = plan.adaptive.max_error * kDarkest;
  for (size_t i = 0; i < features.size();) {
    Shares shares;
    const FeatureKind kind = features[i].kind;
    for (; i < features.size() && features[i].kind == kind; ++i) {
      AddShares(plan.scene->image.filter, cell, features[i], &shares);
    }
    for (uint32_t pixel = 0; pixel < kCellPixels; ++pixel) {
      const FilmPixel at = PixelOf(cell, pixel);
      const double share = shares.samples[at.y - cell.y0][at.x - cell.x0];
      const double radiance = shares.radiance[at.y - cell.y0][at.x - cell.x0];
      if (share == 0 || radiance * 2 <= least_tolerance) continue;
      known->samples[pixel] =
          std::max(known->samples[pixel], kExpectedHits * dust.sampled_share[pixel] / share);
      known->radiance[pixel] += radiance;
    }
  }
  known->parts.clear();
  FindRareTriangles(plan, cell, work, &known->parts);
  FindRareTexels(plan, cell, work, known);
  std::stable_sort(known->parts.begin(), known->parts.end(),
                   [](const auto& a, const auto& b) { return a.pixel < b.pixel; });
}

}  // namespace nacre
