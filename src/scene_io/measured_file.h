// SPDX-License-Identifier: Apache-2.0
// scene_io/measured_file.h: reads files of measured BRDFs, of either database, by their contents.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

#include "brdf/measured_table.h"

namespace nacre {

// Throws Error (kBadInput), located in the file, if it is neither, or damaged.
std::shared_ptr<const MeasuredBrdf> ReadMeasuredFile(const std::filesystem::path& path);

// The same of the bytes of a file that is called `file`.
std::shared_ptr<const MeasuredBrdf> ReadMeasured(std::string_view bytes, const std::string& file);

// The bytes that the tables take in memory.
uint64_t MeasuredBytes(const MeasuredBrdf& brdf);

}  // namespace nacre
