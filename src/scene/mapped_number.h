// SPDX-License-Identifier: Apache-2.0
// scene/mapped_number.h: the parameters that maps multiply (scene/material_parameters.h).
#pragma once

#include <cstddef>
#include <cstdint>

namespace nacre {

// The parameters of all models that may vary by hit, by their meaning.
enum class MappedNumber : uint8_t {
  kColor,          // albedo, the Phong family's color, base_color
  kSpecularColor,  // ks; dielectric_f0
  kSpecular,       // MetallicRoughnessMaterial::specular
  kWidth,          // roughness of lobes; shininess
  kUncoatedWidth,  // OpenPbrMaterial::specular_roughness, from which kWidth follows
  kAnisotropy,     // anisotropy; specular_roughness_anisotropy
  kMetallic,
  kSheenColor,      // fuzz_color
  kSheenRoughness,  // fuzz_roughness
  kEmission,
  kFilm,           // iridescence
  kFilmThickness,  // iridescence_thickness_nm
  kCount,
};
inline constexpr size_t kMappedNumbers = static_cast<size_t>(MappedNumber::kCount);

}  // namespace nacre
