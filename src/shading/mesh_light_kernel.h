// SPDX-License-Identifier: Apache-2.0
// shading/mesh_light_kernel.h: triangles of a light as vectors read and write them: one for each
// entry of a batch, and those that rays meet.
#pragma once

#include <vector>

#include "shading/area_kernels.h"

namespace nacre {

struct TriangleBatch {
  Soa3<float> corner, edge_x, edge_y;  // as TriangleLight's, relative to the hit
};

// A triangle that the ray from a hit meets, whether it is the nearest or not.
struct CrossedTriangle {
  uint32_t hit, triangle;
};

struct CrossedTriangles {
  std::vector<CrossedTriangle> entries;
  size_t count = 0;

  void Add(const CrossedTriangle& triangle) {
    if (count == entries.size()) entries.resize(2 * count + kBatchCapacity);
    entries[count++] = triangle;
  }
};

// What directions to a light of triangles are worked out in. It takes longer to make than a small
// batch's directions do, so it is kept with them.
struct MeshLightScratch {
  TriangleBatch seen;
  AlignedArray<float> rest{kBatchCapacity};  // what is left of the numbers that chose triangles
  CrossedTriangles meetings;
  // Where directions meet the nearest triangle, in units of them, and their product with its
  // normal.
  AlignedArray<double> end{kBatchCapacity}, towards{kBatchCapacity};
  // Of triangles in `seen`, on their way into the pdf of directions.
  Soa3<float> to_light;
  AlignedArray<float> pdf{kBatchCapacity}, probability{kBatchCapacity};
  AlignedArray<uint32_t> hit{kBatchCapacity};
};

}  // namespace nacre
