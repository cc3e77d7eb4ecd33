// SPDX-License-Identifier: Apache-2.0
// scene_io/mtl_file.h: the statements of a Wavefront material library (MTL).
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "base/vec.h"

namespace nacre {

// An image that a material refers to.
struct MtlImage {
  std::string file;                 // as written in the file; empty: none
  std::string place;                // where the file names it: "models/car.mtl:12"
  Vec2d scale{1, 1}, offset{0, 0};  // texture coordinates are multiplied by `scale`, then `offset`
                                    // is added
  bool clamp = false;
  double multiplier = 1;  // for bump maps
};

// A material. Numbers are named by the letters that the format gives them.
struct MtlMaterial {
  std::string name;  // all that follows "newmtl", a comment included
  Rgb ka{0, 0, 0}, kd{0, 0, 0}, ks{0, 0, 0}, ke{0, 0, 0};
  double ns = 1;                 // exponent
  double opacity = 1;            // d, or else 1 - Tr
  double ni = 1;                 // index of refraction
  int illum = 2;                 // 0: diffuse colour only; 1: no highlight; 2: all; above 2:
                                 // effects not shown
  std::optional<double> pr, pm;  // roughness and metallic
  double ps = 0;                 // strength of the sheen
  double pc = 0, pcr = 0;        // strength and roughness of the clear coat
  MtlImage map_ka, map_kd, map_ks, map_ns, map_ke, map_d, norm, bump, disp;
  MtlImage map_pr, map_pm, map_ps, map_pc, map_pcr;
};

// Reads the materials of a library. Their numbers are in the ranges of nacre's materials
// (scene/limits.h): numbers of the file that are not are clamped. Calls warn, perhaps several
// times, for numbers that are clamped, for statements that are not read and for those that are left
// out, such as missing numbers, NaN and infinities. Throws Error (kBadInput) with the file and the
// line for words in the place of numbers, and for more than `max_materials` materials.
std::vector<MtlMaterial> ReadMtlFile(const std::filesystem::path& path, size_t max_materials,
                                     const std::function<void(const std::string&)>& warn);

}  // namespace nacre
