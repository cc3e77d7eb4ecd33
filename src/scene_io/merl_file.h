// SPDX-License-Identifier: Apache-2.0
// scene_io/merl_file.h: reads tables of the MERL database (.binary): three 32-bit counts, then the
// values of all cells as doubles, channel after channel.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "brdf/measured_table.h"

namespace nacre {

inline constexpr uint64_t kMerlHeaderBytes = 12;
inline constexpr uint64_t kMerlBytes = kMerlHeaderBytes + uint64_t{3 * 8} * MerlTable::kCells;

// Checks the counts at the beginning of the file, and that it has kMerlBytes. Throws Error
// (kBadInput), located in `file`.
void CheckMerlHeader(std::string_view head, uint64_t bytes, const std::string& file);

// Reads a whole file. Values are scaled to 1/sr; cells with a negative value are those without
// data, and become black. Throws Error (kBadInput), located in `file`.
MerlTable ReadMerl(std::string_view bytes, const std::string& file);

}  // namespace nacre
