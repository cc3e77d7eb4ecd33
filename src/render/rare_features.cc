// SPDX-License-Identifier: Apache-2.0
#include "render/rare_features.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "render/evidence.h"
#include "render/filter_shares.h"
#include "render/glints.h"
#include "render/interval.h"
#include "render/rare_triangles.h"

namespace nacre {
namespace {

// Pictures that look alike: each of them that a sample hits tells of the others.
struct Likeness {
  uint32_t material;
  size_t light;  // of highlights
  auto operator<=>(const Likeness&) const = default;
};
constexpr size_t kWhole = std::numeric_limits<size_t>::max();  // no highlight: a sphere

// A picture as the square of the same area around the same place, in pixels.
struct SmallPicture {
  Likeness likeness;
  double x, y, half_side;
  double radiance;  // at most, beyond what is beside it
};

void AddSpheres(const FramePlan& plan, const Projector& projector, const TileCandidates& candidates,
                std::vector<SmallPicture>* small) {
  for (const auto& cell : candidates.cells) {
    for (const TileCandidate& candidate : cell) {
      const ProjectedBounds b = Project(projector, candidate.sphere);
      const double width = b.x1 - b.x0, height = b.y1 - b.y0;
      if (!b.visible || !(width < kWidestRare && height < kWidestRare)) continue;
      small->push_back(
          {{MaterialAt(plan.surfaces, candidate.primitive, (b.x0 + b.x1) / 2).index, kWhole},
           (b.x0 + b.x1) / 2,
           (b.y0 + b.y1) / 2,
           std::sqrt(M_PI / 4 * width * height) / 2,
           plan.adaptive.brightest});
    }
  }
}

// The highlights that lie where samples of the cell's pixels may.
std::vector<Glint> GlintsIn(const FramePlan& plan, const Projector& projector, const Window& cell,
                            const TileCandidates& candidates) {
  std::vector<Glint> glints;
  for (const auto& in_cell : candidates.cells) {
    for (const TileCandidate& candidate : in_cell) {
      AddGlints(plan, projector, candidate, kWidestRare * kWidestRare, &glints);
    }
  }
  const double reach = plan.adaptive.reach + kWidestRare;
  const std::vector<Glint>& of_meshes = plan.adaptive.mesh_glints;
  const auto first = std::lower_bound(of_meshes.begin(), of_meshes.end(), cell.y0 - reach,
                                      [](const Glint& g, double y) { return g.y < y; });
  for (auto g = first; g != of_meshes.end() && g->y < cell.y1 + reach; ++g) glints.push_back(*g);
  std::erase_if(glints, [&](const Glint& g) {
    return !(g.x > cell.x0 - reach && g.x < cell.x1 + reach && g.y > cell.y0 - reach &&
             g.y < cell.y1 + reach);
  });
  return glints;
}

// Looks at the peak of each highlight and beside it: what its lobe, its light, shadows and things
// in front make of it.
void AddHighlights(const FramePlan& plan, const std::vector<Glint>& glints, TileWork* work,
                   StageClock* clock, RenderStats* stats, std::vector<SmallPicture>* small) {
  constexpr size_t kAtOnce = kBatchCapacity / 2;
  bool seen[kAtOnce];  // the peaks that nothing hides
  TileWork& s = *work;
  for (size_t first = 0; first < glints.size(); first += kAtOnce) {
    const size_t count = std::min(kAtOnce, glints.size() - first);
    for (size_t i = 0; i < count; ++i) {
      const Glint& g = glints[first + i];
      s.samples.film.x[2 * i] = g.x;
      s.samples.film.y[2 * i] = g.y;
      s.samples.film.x[2 * i + 1] = g.x + g.beside_x;
      s.samples.film.y[2 * i + 1] = g.y + g.beside_y;
    }
    s.samples.film.count = 2 * count;
    if (plan.sampling.numbered) NumberAlike(s.samples.film.count, &NumbersOf(&s.samples));
    ShadeSamples(plan, &s, clock, stats);
    const Layer& beauty = plan.film.layers[0];
    Soa3<double>& values = GatherLayer(plan.film, beauty, 0, BackgroundOf(beauty, plan.film),
                                       BatchOf(plan, s), &s.layer_room);
    std::fill_n(seen, count, false);
    for (size_t hit = 0; hit < s.surfaces.hits.count; ++hit) {
      const uint32_t ray = s.surfaces.hits.ray[hit];
      if (ray % 2 != 0) continue;
      seen[ray / 2] = s.surfaces.hits.primitive[hit] == glints[first + ray / 2].primitive;
    }
    for (size_t i = 0; i < count; ++i) {
      if (!seen[i]) continue;
      const Glint& g = glints[first + i];
      double radiance = 0;
      for (int channel = 0; channel < 3; ++channel) {
        const double* const value = ChannelOf(values, channel).data() + 2 * i;
        radiance = std::max(radiance, value[0] - value[1]);
      }
      if (!(radiance > 0)) continue;
      small->push_back({{g.material, g.light}, g.x, g.y, std::sqrt(g.area) / 2, radiance});
    }
  }
}

// What like pictures have of a cell's pixels, by rows: of the samples, and of the radiance.
struct Shares {
  double samples[kCellSize][kCellSize] = {};
  double radiance[kCellSize][kCellSize] = {};
};

// Adds the picture's share of the samples of each of the cell's pixels that it is in the reach of.
void AddShares(const PixelFilter& filter, const Window& cell, const SmallPicture& picture,
               Shares* shares) {
  ForEachShare(filter, cell, {picture.x, picture.y, picture.half_side, picture.half_side},
               [&](int column, int row, double share) {
                 shares->samples[row][column] += share;
                 shares->radiance[row][column] += share * picture.radiance;
               });
}

}  // namespace

void FindRareFeatures(const FramePlan& plan, const Window& cell, TileWork* work, CellScratch* c,
                      StageClock* clock, RenderStats* stats) {
  std::fill_n(c->rare_samples, kCellPixels, 0.0);
  std::fill_n(c->rare_radiance, kCellPixels, 0.0);
  const TileCandidates& candidates = work->sight.spheres;
  const Projector projector = MakeProjector(plan.camera);
  std::vector<SmallPicture> small;
  AddSpheres(plan, projector, candidates, &small);
  const std::vector<Glint> glints = GlintsIn(plan, projector, cell, candidates);
  AddHighlights(plan, glints, work, clock, stats, &small);
  std::stable_sort(small.begin(), small.end(), [](const SmallPicture& a, const SmallPicture& b) {
    return a.likeness < b.likeness;
  });
  const double least_wanted = plan.adaptive.max_error * kDarkest;
  for (size_t i = 0; i < small.size();) {
    Shares shares;
    const Likeness likeness = small[i].likeness;
    for (; i < small.size() && small[i].likeness == likeness; ++i) {
      AddShares(plan.scene->image.filter, cell, small[i], &shares);
    }
    for (uint32_t pixel = 0; pixel < kCellPixels; ++pixel) {
      const FilmPixel at = PixelOf(cell, pixel);
      const double share = shares.samples[at.y - cell.y0][at.x - cell.x0];
      const double radiance = shares.radiance[at.y - cell.y0][at.x - cell.x0];
      if (share == 0 || radiance * 2 <= least_wanted) continue;
      c->rare_samples[pixel] = std::max(c->rare_samples[pixel], kExpectedHits / share);
      c->rare_radiance[pixel] += radiance;
    }
  }
  FindRareTriangles(plan, cell, work, c, clock, stats);
}

}  // namespace nacre
