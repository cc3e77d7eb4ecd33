// SPDX-License-Identifier: Apache-2.0
// visibility/light_bins.h: spheres binned as a light sees them. Shadow rays are the light's camera
// rays: each finds what may be in its way in one cell, without a tree.
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

// Cells are numbered block by block, blocks and the cells in one row by row: neighbours are close
// in memory, and a block's spheres are sorted within the cache.
inline constexpr int kBlockBits = 4;
inline constexpr int kBlockSize = 1 << kBlockBits;  // cells across
inline constexpr size_t kBlockCells = size_t{kBlockSize} * kBlockSize;

// Square cells on a plane before the light. Those at the border reach to infinity: all places have
// a cell.
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
  // 0 also for what is not a number.
  static int Clamped(double place, int count) {
    return static_cast<int>(std::min(std::max(0.0, place), count - 0.5));
  }
};

// A sphere in a cell. Relative to the light bins' centre and, if the light is directional, in its
// axes, with z, towards the light, where the sphere ends. The radius bounds the true one and what
// rounding does to all of this and to a ray that passes by.
struct BinnedSphere {
  float x, y, z, radius;
};

struct LightBins {
  bool positional = false;
  Vec3d center{0, 0, 0};  // the light; or some point among the spheres
  Vec3d axes[3];          // of a directional light: across it, and towards it
  LightGrid grids[6];     // one for each face of a cube about the light; if directional, the first
  // Spheres and rays reach at most this far from the camera, or are not binned: the bins' margins
  // hold no longer.
  double max_reach = 0;

  std::vector<uint32_t> end;         // of each cell's list
  HugeArray<BinnedSphere> binned;    // cell by cell; a vector more may be read
  HugeArray<uint32_t> spheres;       // their numbers
  std::vector<uint32_t> large;       // spheres that any ray may meet, in ascending order
  std::vector<uint32_t> large_twin;  // of each, the first of them that coincides with it

  bool overfull = false;  // there would be too many: no cell has any

  size_t entries() const { return end.empty() ? 0 : end.back(); }
  uint32_t Begin(size_t cell) const { return cell == 0 ? 0 : end[cell - 1]; }
  // How many spheres a ray's cell holds, on average over the spheres' own places.
  double meeting = 0;
};

// The face of the cube about the light that a direction goes through: 0 to 5 for +x -x +y -y +z -z;
// and on it the place, two slopes in [-1, 1].
struct FacePlace {
  int face;
  double x, y;
};
inline FacePlace PlaceOnCube(const Vec3d& direction) {
  const Vec3d size(std::abs(direction.x), std::abs(direction.y), std::abs(direction.z));
  const int axis = size.x >= size.y && size.x >= size.z ? 0 : (size.y >= size.z ? 1 : 2);
  const double z = size[axis];
  return {2 * axis + (direction[axis] < 0 ? 1 : 0), direction[(axis + 1) % 3] / z,
          direction[(axis + 2) % 3] / z};
}

// Cells become smaller than most spheres where no more than about `room` entries come of it.
LightBins BinForLight(const TraceGeometry& geometry, const ShadowLight& light, size_t room,
                      int threads);

// As many entries as are nothing to speak of, for all lights together.
inline constexpr size_t kBinRoom = size_t{1} << 19;

// Intersector::Occluded for rays to the bins' light from spheres.
void OccludedByBins(const TraceGeometry& geometry, const LightBins& bins, ShadowRayBatch* rays);

}  // namespace nacre
