// SPDX-License-Identifier: Apache-2.0
#include "render/tile_sight.h"

#include <algorithm>

namespace nacre {
namespace {

bool NeedsPositions(const HitsPlan& plan, const TileCandidates& candidates) {
  if (plan.all_positions) return true;
  const auto casts = [&](const TileCandidate& candidate) {
    return plan.may_be_shadowed[candidate.primitive] != 0;
  };
  return std::any_of(candidates.cells.begin(), candidates.cells.end(), [&](const auto& cell) {
    return std::any_of(cell.begin(), cell.end(), casts);
  });
}

}  // namespace

void FindSight(const HitsPlan& plan, const Window& tile, TileSight* sight) {
  sight->shapes = sight->triangles = false;
  if (plan.intersector == nullptr) return;
  const bool spheres =
      !plan.primitives.scene->spheres.empty() &&
      (!plan.binned || plan.intersector->EnterTile(tile, plan.tile_rays, &sight->spheres));
  sight->triangles =
      std::any_of(plan.mesh_windows.begin(), plan.mesh_windows.end(),
                  [&](const Window& window) { return !Intersect(window, tile).empty(); });
  if (spheres) sight->positions = NeedsPositions(plan, sight->spheres);
  sight->shapes = spheres || sight->triangles;
}

}  // namespace nacre
