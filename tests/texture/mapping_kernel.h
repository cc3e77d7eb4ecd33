// SPDX-License-Identifier: Apache-2.0
// tests/texture/mapping_kernel.h: the mappings' SIMD twins, on arrays.
#pragma once

#include <vector>

#include "texture/mapping.h"

namespace nacre {

std::vector<Mapped<double>> MapPoints(MappingKind kind, const std::vector<Vec3d>& points);

}  // namespace nacre
