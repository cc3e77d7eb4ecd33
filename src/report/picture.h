// SPDX-License-Identifier: Apache-2.0
// report/picture.h: images as the page holds them: samples of each channel, deflated, and how small
// they had to be made.
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "base/image.h"
#include "compare/plane.h"
#include "report/page.h"

namespace nacre {

// What is done so that all pictures of a page fit.
struct Packing {
  bool half = false;  // float samples become half; else they stay what the file has
  int factor = 1;     // pixels become means of factor x factor of them; ids the middle one's

  // In words, or "" if nothing is.
  std::string InWords() const;
};

// The least that makes the images' samples fit into `limit` bytes before they are deflated.
Packing ChoosePacking(const std::vector<const Image*>& images, size_t limit);

// {name, width, height, x0, y0, factor, transfer, layers, facts}, and its samples as blobs. Samples
// that half cannot hold (infinite, beyond 65504) keep their channel in float.
nlohmann::ordered_json PackImage(const Image& image, const std::string& name,
                                 const Packing& packing, Page* page);

// {kind, layer, type, blob, x0, y0, width, height} of a map of values in [0, 1] whose top left
// pixel is that of `window`, in 255 steps.
nlohmann::ordered_json PackMap(const Plane& map, const Window& window, const std::string& kind,
                               const std::string& layer, const Packing& packing, Page* page);

}  // namespace nacre
