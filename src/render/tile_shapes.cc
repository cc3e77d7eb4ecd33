// SPDX-License-Identifier: Apache-2.0
#include "render/tile_shapes.h"

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

void FindTileShapes(const HitsPlan& plan, const Window& tile, TileShapes* shapes) {
  shapes->any = shapes->triangles = false;
  if (plan.intersector == nullptr) return;
  const bool spheres =
      !plan.primitives.scene->spheres.empty() &&
      (!plan.binned || plan.intersector->EnterTile(tile, plan.tile_rays, &shapes->spheres));
  shapes->triangles =
      std::any_of(plan.mesh_windows.begin(), plan.mesh_windows.end(),
                  [&](const Window& window) { return !Intersect(window, tile).empty(); });
  if (spheres) shapes->positions = NeedsPositions(plan, shapes->spheres);
  shapes->any = spheres || shapes->triangles;
}

}  // namespace nacre
