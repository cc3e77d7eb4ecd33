#include "render/footprint.h"

#include <algorithm>
#include <cmath>

namespace nacre {
namespace {

// The block and the filter's reach around its pixels' centres.
struct Footprint {
  double x0, y0, x1, y1;
};

Footprint FootprintOf(const Window& block, double reach) {
  return {block.x0 + 0.5 - reach, block.y0 + 0.5 - reach, block.x1 - 0.5 + reach,
          block.y1 - 0.5 + reach};
}

// The only sphere that the cell's rays can hit, or null.
const TileCandidate* OnlyCandidate(const TileCandidates& candidates) {
  const TileCandidate* only = nullptr;
  for (const auto& cell : candidates.cells) {
    for (const TileCandidate& candidate : cell) {
      if (only != nullptr) return nullptr;
      only = &candidate;
    }
  }
  return only;
}

// The blocks whose footprint's corners all hit: a sphere's picture is convex, so it covers them.
uint32_t FindCovered(const RenderPlan& plan, const Window& cell, uint32_t blocks,
                     TileScratch* scratch, CellScratch* cell_scratch) {
  FilmBatch& corners = cell_scratch->corners;
  for (size_t block = 0; block < kCellBlocks; ++block) {
    const Footprint f = FootprintOf(BlockWindow(cell, block), plan.adaptive.reach);
    const double x[4] = {f.x0, f.x1, f.x0, f.x1};
    const double y[4] = {f.y0, f.y0, f.y1, f.y1};
    std::copy_n(x, 4, corners.x.data() + 4 * block);
    std::copy_n(y, 4, corners.y.data() + 4 * block);
  }
  corners.count = 4 * kCellBlocks;
  HitBatch& hits = scratch->unsorted_hits;
  plan.intersector->HitsInTile(scratch->candidates, corners,
                               {&hits, &scratch->unsorted_directions, false});
  int corners_hit[kCellBlocks] = {};
  for (size_t i = 0; i < hits.count; ++i) ++corners_hit[hits.ray[i] / 4];
  uint32_t covered = 0;
  for (size_t block = 0; block < kCellBlocks; ++block) {
    if (corners_hit[block] == 4) covered |= 1u << block;
  }
  return covered & blocks;
}

uint32_t FindBeside(const RenderPlan& plan, const Window& cell, uint32_t blocks,
                    const TileCandidate& candidate) {
  const FilmBounds bounds = Projector(plan.camera).Project(candidate.sphere);
  uint32_t beside = 0;
  for (size_t block = 0; block < kCellBlocks; ++block) {
    const Footprint f = FootprintOf(BlockWindow(cell, block), plan.adaptive.reach);
    const bool apart = !bounds.visible || f.x1 < bounds.x0 || bounds.x1 < f.x0 ||
                       f.y1 < bounds.y0 || bounds.y1 < f.y0;
    if (apart) beside |= 1u << block;
  }
  return beside & blocks;
}

// Whether no light's shadow can fall on the sphere.
bool IsNeverShadowed(const RenderPlan& plan, uint32_t sphere) {
  return std::all_of(plan.lights.begin(), plan.lights.end(),
                     [&](const PlannedLight& light) { return NeverShadowed(light, sphere); });
}

// The largest second differences of a block's values along rows and columns, added.
double Curvature(const double* v) {
  double along_x = 0, along_y = 0;
  for (int i = 0; i < kBlockSide; ++i) {
    for (int j = 1; j + 1 < kBlockSide; ++j) {
      const double* row = v + i * kBlockSide + j;
      const double* column = v + j * kBlockSide + i;
      along_x = std::max(along_x, std::abs(row[-1] - 2 * row[0] + row[1]));
      along_y =
          std::max(along_y, std::abs(column[-kBlockSide] - 2 * column[0] + column[kBlockSide]));
    }
  }
  return along_x + along_y;
}

bool IsFlat(const AdaptivePlan& plan, const double* values) {
  double darkest = std::abs(values[0]);
  for (size_t i = 1; i < kBlockPixels; ++i) darkest = std::min(darkest, std::abs(values[i]));
  // Written so that NaN is not flat.
  return plan.center_error * Curvature(values) <= plan.max_error * std::max(darkest, kDarkest);
}

// Whether the normals of the block's hits turn by a small part of the lobe from pixel to pixel.
bool ResolvesLobe(const Soa3<float>& normals, size_t first_hit, double width) {
  const auto turn2 = [&](size_t a, size_t b) {
    const double x = normals.x[a] - normals.x[b];
    const double y = normals.y[a] - normals.y[b];
    const double z = normals.z[a] - normals.z[b];
    return x * x + y * y + z * z;
  };
  double most = 0;
  for (size_t i = 0; i < kBlockPixels; ++i) {
    const size_t hit = first_hit + i;
    if (i % kBlockSide != 0) most = std::max(most, turn2(hit, hit - 1));
    if (i >= kBlockSide) most = std::max(most, turn2(hit, hit - kBlockSide));
  }
  return 16 * most <= width * width;
}

}  // namespace

uint32_t FindPlainBlocks(const RenderPlan& plan, const Window& cell, uint32_t blocks,
                         TileScratch* scratch, CellScratch* cell_scratch) {
  if (!plan.adaptive.footprints || !plan.tiles || plan.splits) return 0;
  const TileCandidate* const only = OnlyCandidate(scratch->candidates);
  if (only == nullptr || only->around_camera) return 0;
  const uint32_t beside = FindBeside(plan, cell, blocks, *only);
  if (beside == blocks || !IsNeverShadowed(plan, only->primitive)) return beside;
  return beside | FindCovered(plan, cell, blocks & ~beside, scratch, cell_scratch);
}

bool IsSmooth(const RenderPlan& plan, size_t first_ray, const Soa3<double>& values,
              const TileScratch& s) {
  // Hits are in the order of rays (there is one material), all of the block's or none.
  const uint32_t* const begin = s.hits.ray.data();
  const uint32_t* const found =
      std::lower_bound(begin, begin + s.hits.count, static_cast<uint32_t>(first_ray));
  const auto first_hit = static_cast<size_t>(found - begin);
  const bool hit = first_hit < s.hits.count && *found == first_ray;
  if (!hit) return true;
  const double width = plan.adaptive.widths[s.runs.front().material.index];
  return IsFlat(plan.adaptive, values.x.data() + first_ray) &&
         IsFlat(plan.adaptive, values.y.data() + first_ray) &&
         IsFlat(plan.adaptive, values.z.data() + first_ray) &&
         ResolvesLobe(s.surface.normal, first_hit, width);
}

}  // namespace nacre
