// SPDX-License-Identifier: Apache-2.0
// render/rare_texels.h: finds the texels in a cell's pixels that are rare features: bright ones of
// an emission map, holes of a cut-out, stars of a sky.
//
// One ray through the middle of a pixel finds the part of each map that lies in the pixel. The
// texels there that differ most from the others (texture/texel_search.h) are probed by a ray each,
// which measures how they look under the scene's lights, whatever the map controls. In a normal map
// over a narrow lobe (roughness below 0.45) these are the texels that mirror a light, or the sun of
// a sky, to the eye. Not found are texels of surfaces that the middle of a pixel does not show,
// texels that are seen in mirrors, glints of bump maps, glints of normal maps on matte surfaces or
// between texels that are interpolated, and normals where more than 256 x 256 texels lie in a
// pixel.
#pragma once

#include "render/evidence.h"

namespace nacre {

// Adds rare texels to known->parts, and sets has_other_texels.
void FindRareTexels(const FramePlan& plan, const Window& cell, TileWork* work,
                    KnownFeatures* known);

}  // namespace nacre
