// SPDX-License-Identifier: Apache-2.0
#include "render/tile_shapes.h"

#include <algorithm>

namespace nacre {
namespace {

bool NeedsPositions(const HitArrays& plan, const TileCandidates& candidates) {
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
  const Intersector* const intersector = plan.shapes.intersector.get();
  if (intersector == nullptr) return;
  const TracePlan& trace = plan.trace;
  const bool spheres =
      !plan.shapes.primitives.scene->spheres.empty() &&
      (!trace.binned || intersector->EnterTile(tile, trace.tile_rays, &shapes->spheres));
  shapes->triangles =
      std::any_of(trace.mesh_windows.begin(), trace.mesh_windows.end(),
                  [&](const Window& window) { return !Intersect(window, tile).empty(); });
  if (spheres) shapes->positions = NeedsPositions(plan.arrays, shapes->spheres);
  shapes->any = spheres || shapes->triangles;
}

}  // namespace nacre
