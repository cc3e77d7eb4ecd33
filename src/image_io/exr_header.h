// SPDX-License-Identifier: Apache-2.0
// image_io/exr_header.h: the contents of an EXR header, as given to the writer.
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
  std::string name;  // "R", "diffuse.G", "id.object"; unique
  PixelType type = PixelType::kHalf;
};

using ExrAttribute = std::variant<int, float, std::string>;

// The header of a file to write. The primaries always are those of Rec. 709.
struct ExrHeader {
  Window display;                    // the full frame
  Window data;                       // the part in the file; not empty, but may lie anywhere
  std::vector<ExrChannel> channels;  // in the caller's order; the file sorts them by name
  // As in OpenEXR, these are for row vectors: p_camera = p_world * world_to_camera.
  std::optional<Imath::M44f> world_to_camera;
  std::optional<Imath::M44f> world_to_ndc;
  std::map<std::string, ExrAttribute> attributes;  // by name
};

}  // namespace nacre
