// SPDX-License-Identifier: Apache-2.0
// shading/mesh_light_kernel.h: triangles of a mesh light as structure of arrays: one for each entry
// of a batch, and those that rays meet.
#pragma once

#include <vector>

#include "shading/area_kernels.h"

namespace nacre {

struct TriangleBatch {
  Soa3<float> corner, edge_x, edge_y;  // as in TriangleLight, relative to the hit
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

// Buffers for directions to a mesh light. Making them takes longer than the directions of a small
// batch, so they are kept with LightDirections.
struct MeshLightScratch {
  TriangleBatch seen;
  AlignedArray<float> rest{kBatchCapacity};  // the numbers that chose triangles, rescaled to [0, 1)
  CrossedTriangles meetings;
  // For each hit, where its direction meets the nearest triangle, in units of the direction, and
  // the dot product of the direction and the triangle's normal.
  AlignedArray<double> end{kBatchCapacity}, towards{kBatchCapacity};
  // For each triangle in `seen`: the direction, its pdf, the probability of choosing the triangle,
  // and the hit to whose pdf the product is added.
  Soa3<float> to_light;
  AlignedArray<float> pdf{kBatchCapacity}, probability{kBatchCapacity};
  AlignedArray<uint32_t> hit{kBatchCapacity};
};

}  // namespace nacre
