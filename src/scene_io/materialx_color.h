// SPDX-License-Identifier: Apache-2.0
// scene_io/materialx_color.h: MaterialX's colour spaces by name, and their colours in linear
// Rec. 709, in which nacre renders.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/vec.h"

namespace nacre {

// How the numbers of a space become linear light.
enum class MaterialXTransfer : uint8_t { kLinear, kSrgb, kPower };

struct MaterialXColorSpace {
  std::string_view name;
  std::string_view primaries;  // as ParsePrimaries reads them; empty: numbers that are no colours
  MaterialXTransfer transfer = MaterialXTransfer::kLinear;
  double exponent = 1;  // kPower: linear = encoded^exponent
};

// The space of this name; nullptr if it is not known. The empty name, "none", "raw" and "data" mean
// numbers that are taken as they are.
const MaterialXColorSpace* FindMaterialXColorSpace(std::string_view name);
std::vector<std::string> MaterialXColorSpaceNames();

// The colour in linear Rec. 709. It may leave [0, 1] where the space is wider. Transfer curves are
// continued below 0 by symmetry.
Rgb ToRec709(const MaterialXColorSpace& space, const Rgb& color);

// How an image file in this space is read: the encoding of a scene's texture ("srgb", "linear").
// nullopt for spaces that textures do not have; `nearest` is then the closest to it that they have.
std::optional<std::string_view> TextureEncodingOf(const MaterialXColorSpace& space,
                                                  std::string_view* nearest);

}  // namespace nacre
