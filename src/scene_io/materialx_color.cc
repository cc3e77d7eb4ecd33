// SPDX-License-Identifier: Apache-2.0
#include "scene_io/materialx_color.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "color/primaries.h"
#include "color/transfer.h"

namespace nacre {
namespace {

// SMPTE RP 431-2 with the white D65; Adobe RGB (1998), 4.3.1; ITU-R BT.2020-2, table 3; the sets
// AP0 and AP1 of SMPTE ST 2065-1 and AMPAS S-2014-004.
constexpr std::string_view kRec709 = kRec709Primaries;
constexpr std::string_view kDisplayP3 = "0.68 0.32 0.265 0.69 0.15 0.06 0.3127 0.329";
constexpr std::string_view kAdobe = "0.64 0.33 0.21 0.71 0.15 0.06 0.3127 0.329";
constexpr std::string_view kRec2020 = "0.708 0.292 0.17 0.797 0.131 0.046 0.3127 0.329";
constexpr std::string_view kAp0 = "0.7347 0.2653 0 1 0.0001 -0.077 0.32168 0.33767";
constexpr std::string_view kAp1 = "0.713 0.293 0.165 0.83 0.128 0.044 0.32168 0.33767";
constexpr double kAdobeExponent = 563.0 / 256;

using Transfer = MaterialXTransfer;

// MaterialX's own names (libraries/cmlib, 1.39), and those of the ASWF's color interop forum.
constexpr auto kSpaces = std::to_array<MaterialXColorSpace>({
    {"", {}},
    {"none", {}},
    {"raw", {}},
    {"data", {}},
    {"lin_rec709", kRec709},
    {"lin_rec709_scene", kRec709},
    {"srgb_texture", kRec709, Transfer::kSrgb},
    {"srgb_rec709_scene", kRec709, Transfer::kSrgb},
    {"g18_rec709", kRec709, Transfer::kPower, 1.8},
    {"g18_rec709_scene", kRec709, Transfer::kPower, 1.8},
    {"g22_rec709", kRec709, Transfer::kPower, 2.2},
    {"g22_rec709_scene", kRec709, Transfer::kPower, 2.2},
    {"rec709_display", kRec709, Transfer::kPower, 2.4},
    {"acescg", kAp1},
    {"lin_ap1", kAp1},
    {"lin_ap1_scene", kAp1},
    {"g22_ap1", kAp1, Transfer::kPower, 2.2},
    {"g22_ap1_scene", kAp1, Transfer::kPower, 2.2},
    {"aces2065_1", kAp0},
    {"lin_ap0_scene", kAp0},
    {"lin_displayp3", kDisplayP3},
    {"lin_p3d65_scene", kDisplayP3},
    {"srgb_displayp3", kDisplayP3, Transfer::kSrgb},
    {"srgb_p3d65_scene", kDisplayP3, Transfer::kSrgb},
    {"lin_adobergb", kAdobe},
    {"lin_adobergb_scene", kAdobe},
    {"adobergb", kAdobe, Transfer::kPower, kAdobeExponent},
    {"g22_adobergb_scene", kAdobe, Transfer::kPower, kAdobeExponent},
    {"lin_rec2020_scene", kRec2020},
});

double Linear(const MaterialXColorSpace& space, double encoded) {
  const double size = std::abs(encoded);
  switch (space.transfer) {
    case Transfer::kLinear:
      return encoded;
    case Transfer::kSrgb:
      return std::copysign(SrgbEotf(size), encoded);
    case Transfer::kPower:
      return std::copysign(std::pow(size, space.exponent), encoded);
  }
  return encoded;
}

}  // namespace

const MaterialXColorSpace* FindMaterialXColorSpace(std::string_view name) {
  const auto found = std::ranges::find(kSpaces, name, &MaterialXColorSpace::name);
  return found != kSpaces.end() ? &*found : nullptr;
}

std::vector<std::string> MaterialXColorSpaceNames() {
  std::vector<std::string> names;
  for (const MaterialXColorSpace& space : kSpaces) {
    if (!space.name.empty()) names.emplace_back(space.name);
  }
  return names;
}

Rgb ToRec709(const MaterialXColorSpace& space, const Rgb& color) {
  if (space.primaries.empty()) return color;
  const Vec3d linear(Linear(space, color.x), Linear(space, color.y), Linear(space, color.z));
  if (space.primaries == kRec709) return Rgb(linear);
  return Rgb(linear * Rec709FromPrimaries(*ParsePrimaries(space.primaries)));
}

std::optional<std::string_view> TextureEncodingOf(const MaterialXColorSpace& space,
                                                  std::string_view* nearest) {
  *nearest = space.transfer == Transfer::kLinear ? "linear" : "srgb";
  const bool is_known = space.primaries.empty() || space.primaries == kRec709;
  return is_known && space.transfer != Transfer::kPower ? std::optional(*nearest) : std::nullopt;
}

}  // namespace nacre
