// SPDX-License-Identifier: Apache-2.0
// image_io/exr_types.h: converts OpenEXR's windows and pixel types to nacre's.
#pragma once

#include <Imath/ImathBox.h>
#include <OpenEXR/ImfPixelType.h>

#include "base/image.h"

namespace nacre {

// The last pixel of an EXR window is inclusive.
inline Window ToWindow(const Imath::Box2i& box) {
  return {box.min.x, box.min.y, box.max.x + 1, box.max.y + 1};
}

inline PixelType ToPixelType(Imf::PixelType type) {
  if (type == Imf::HALF) return PixelType::kHalf;
  return type == Imf::UINT ? PixelType::kUint : PixelType::kFloat;
}

inline Imf::PixelType ToImfType(PixelType type) {
  if (type == PixelType::kHalf) return Imf::HALF;
  return type == PixelType::kUint ? Imf::UINT : Imf::FLOAT;
}

}  // namespace nacre
