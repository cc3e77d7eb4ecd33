// SPDX-License-Identifier: Apache-2.0
// report/picture.h: encodes images for a page: the samples of each channel, deflated, and reduced
// if necessary.
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "base/image.h"
#include "compare/plane.h"
#include "report/page.h"

namespace nacre {

// How pictures are reduced so that all of a page fit.
struct Packing {
  bool half = false;  // float samples become half; else they keep the type in the file
  int factor = 1;     // pixels are averaged over factor x factor; ids are sampled in the middle

  // Describes the reduction, or returns "" if there is none.
  std::string InWords() const;
};

// The least reduction by which the images' samples fit into `limit` bytes before they are deflated.
Packing ChoosePacking(const std::vector<const Image*>& images, size_t limit);

// Moves the window to coordinates with the frame's corner at the origin.
Window FromCorner(const Window& window, const Window& display);

// Returns {name, width, height, x0, y0, factor, transfer, layers, facts}, with its samples as
// blobs. Channels with samples that half cannot hold (infinite, or beyond 65504) remain in float.
nlohmann::ordered_json PackImage(const Image& image, const std::string& name,
                                 const Packing& packing, Page* page);

// Returns {kind, layer, type, blob, x0, y0, width, height} for a map of values in [0, 1], quantised
// to 255 steps. Its top left pixel is that of `window`.
nlohmann::ordered_json PackMap(const Plane& map, const Window& window, const std::string& kind,
                               const std::string& layer, const Packing& packing, Page* page);

}  // namespace nacre
