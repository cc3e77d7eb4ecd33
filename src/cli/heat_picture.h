// SPDX-License-Identifier: Apache-2.0
// cli/heat_picture.h: writes a heat map with its legend as a PNG.
#pragma once

#include <string>

#include "compare/heat_map.h"

namespace nacre {

// Writes the map, and below it a bar of its colours with ticks at powers of ten.
void WriteHeatPicture(const std::string& path, const Rgb8Picture& map, HeatQuantity quantity,
                      const HeatScale& scale);

}  // namespace nacre
