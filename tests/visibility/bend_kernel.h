// SPDX-License-Identifier: Apache-2.0
// tests/visibility/bend_kernel.h: BendNormal and GrazingView of hit/shading_normal-inl.h for tests.
#pragma once

#include <vector>

#include "base/vec.h"

namespace nacre {

struct BendQuery {
  Vec3d normal, surface, to_view;
};

// On the active target.
std::vector<Vec3d> AskBend(const std::vector<BendQuery>& queries);
std::vector<Vec3d> AskGrazing(const std::vector<BendQuery>& queries);

}  // namespace nacre
