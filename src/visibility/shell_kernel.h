// SPDX-License-Identifier: Apache-2.0
// visibility/shell_kernel.h: Embree's callbacks for spheres that have a shell tree.
#pragma once

#include "visibility/sphere_kernel.h"

namespace nacre {

// As SphereCallbacks, for a geometry of one primitive that is all spheres at once.
PrimitiveCallbacks ShellCallbacks();

}  // namespace nacre
