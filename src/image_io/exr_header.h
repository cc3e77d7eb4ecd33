// SPDX-License-Identifier: Apache-2.0
// image_io/exr_header.h: what an EXR file says about itself, as the writer is told it.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include <Imath/ImathMatrix.h>

#include "base/image.h"

namespace nacre {

struct ExrChannel {
  std::string name;  // "R", "diffuse.G", "id.object"; each once
  PixelType type = PixelType::kHalf;
};

using ExrAttribute = std::variant<int, float, std::string>;

// The primaries are Rec. 709 always.
struct ExrHeader {
  Window display;                    // the full frame
  Window data;                       // the part in the file; not empty, anywhere
  std::vector<ExrChannel> channels;  // in the caller's order; the file sorts them by name
  // OpenEXR's convention: row vectors, p_camera = p_world * world_to_camera.
  std::optional<Imath::M44f> world_to_camera;
  std::optional<Imath::M44f> world_to_ndc;
  std::map<std::string, ExrAttribute> attributes;  // by name
};

}  // namespace nacre
