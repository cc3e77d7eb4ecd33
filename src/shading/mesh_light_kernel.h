// SPDX-License-Identifier: Apache-2.0
// shading/mesh_light_kernel.h: triangles of a light, one for each entry of a batch, as vectors read
// them.
#pragma once

#include "shading/area_kernels.h"

namespace nacre {

struct SeenTriangles {
  Soa3<float> corner, edge_x, edge_y;  // as TriangleLight's, relative to the hit
};

}  // namespace nacre
