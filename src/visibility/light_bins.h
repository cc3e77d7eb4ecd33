// SPDX-License-Identifier: Apache-2.0
// visibility/light_bins.h: spheres binned by their projections towards a light. Shadow rays are
// like camera rays of the light: each finds all possible occluders in one cell, without a BVH.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "base/huge_pages.h"
#include "hit/batch.h"
#include "visibility/geometry.h"
#include "visibility/shadow_light.h"

namespace nacre {

// Cells are numbered block by block, and blocks, like the cells of a block, row by row: neighbours
// are close in memory, and sorting the spheres of a block stays in the cache.
inline constexpr int kBlockBits = 4;
inline constexpr int kBlockSize = 1 << kBlockBits;  // cells across
inline constexpr size_t kBlockCells = size_t{kBlockSize} * kBlockSize;

// A grid of square cells on a plane in front of the light. Cells at the border extend to infinity,
// so every point has a cell.
struct LightGrid {
  double x0 = 0, y0 = 0;
  double inverse_cell = 0;
  int columns = 1, rows = 1;
  size_t first_block = 0;

  size_t BlockColumns() const { return static_cast<size_t>((columns - 1) / kBlockSize) + 1; }
  size_t BlockRows() const { return static_cast<size_t>((rows - 1) / kBlockSize) + 1; }
  size_t Block(int column, int row) const {
    return first_block + static_cast<size_t>(row / kBlockSize) * BlockColumns() +
           static_cast<size_t>(column / kBlockSize);
  }
  static size_t InBlock(int column, int row) {
    return static_cast<size_t>(row % kBlockSize) * kBlockSize +
           static_cast<size_t>(column % kBlockSize);
  }

  int Column(double x) const { return Clamped((x - x0) * inverse_cell, columns); }
  int Row(double y) const { return Clamped((y - y0) * inverse_cell, rows); }
  size_t Cell(double x, double y) const {
    const int column = Column(x);
    const int row = Row(y);
    return Block(column, row) * kBlockCells + InBlock(column, row);
  }

 private:
  // NaN gives 0, too.
  static int Clamped(double position, int count) {
    return static_cast<int>(std::min(std::max(0.0, position), count - 0.5));
  }
};

// A sphere in a cell, relative to LightBins::center. If the light is directional, x, y and z are
// along LightBins::axes, and z is that of the sphere's end towards the light. The radius is an
// upper bound: it covers the rounding of these numbers and of a ray that passes the sphere.
struct BinnedSphere {
  float x, y, z, radius;
};

struct LightBins {
  bool positional = false;
  Vec3d center{0, 0, 0};  // the light or, if directional, some point among the spheres
  Vec3d axes[3];          // of a directional light: two across, the third towards it
  LightGrid grids[6];     // one for each face of a cube about the light; if directional, the first
  // Spheres and rays that extend further than this from the camera are not binned: the margins
  // would be too small for their rounding errors.
  double max_distance = 0;
  Vec3d made_eye{0, 0, 0}, made_center{0, 0, 0};  // TraceGeometry::eye and `center` of BinForLight

  std::vector<uint32_t> end;       // where each cell's list ends
  HugeArray<BinnedSphere> binned;  // cell by cell, padded by a vector
  HugeArray<uint32_t> spheres;     // indices of the spheres in `binned`
  std::vector<uint32_t> large;     // spheres that every ray is tested against, in ascending order
  std::vector<uint32_t> changed;   // spheres changed since; every ray is tested against them

  bool overfull = false;  // no sphere is binned, because there would be too many entries

  size_t entries() const { return end.empty() ? 0 : end.back(); }
  uint32_t Begin(size_t cell) const { return cell == 0 ? 0 : end[cell - 1]; }
  // The number of spheres in a ray's cell, averaged over rays to the spheres themselves.
  double mean_occupancy = 0;
};

// The point where a direction crosses a cube about the light: the face, 0 to 5 for
// +x -x +y -y +z -z, and two slopes in [-1, 1].
struct CubePoint {
  int face;
  double x, y;
};
inline CubePoint ProjectToCube(const Vec3d& direction) {
  const Vec3d size(std::abs(direction.x), std::abs(direction.y), std::abs(direction.z));
  const int axis = size.x >= size.y && size.x >= size.z ? 0 : (size.y >= size.z ? 1 : 2);
  const double z = size[axis];
  return {2 * axis + (direction[axis] < 0 ? 1 : 0), direction[(axis + 1) % 3] / z,
          direction[(axis + 2) % 3] / z};
}

// Bins the geometry's spheres for a light. Cells are smaller than most spheres as long as there are
// no more than about `entry_budget` entries.
LightBins BinForLight(const TraceGeometry& geometry, const ShadowLight& light, size_t entry_budget,
                      int threads);

// Updates the bins for the geometry's present camera, which has moved, and the same light. Returns
// false if it has moved too far, so that new bins must be made.
bool MoveBins(const TraceGeometry& geometry, LightBins* bins);

// Updates the bins after some spheres have changed. Returns false if every ray would have to be
// tested against too many of them, so that new bins must be made.
bool TakeChanged(const std::vector<ChangedSphere>& changed, LightBins* bins);

// Memory budget, in entries, for the bins of all lights together.
inline constexpr size_t kBinEntryBudget = size_t{1} << 19;

// Implements Intersector::Occluded for rays that start on spheres and go to the light of the bins.
void OccludedByBins(const TraceGeometry& geometry, const LightBins& bins, ShadowRayBatch* rays);

}  // namespace nacre
