// SPDX-License-Identifier: Apache-2.0
// image_io/png_reader.h: plain PNG files into memory without OpenImageIO, whose libraries take 0.2
// s to load.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "base/image.h"

namespace nacre {

// The image of a PNG file of 8 or 16 bits a sample, not interlaced: grey, grey and alpha, colours,
// colours and alpha, or a palette without transparency. Values and metadata["transfer"] as
// ReadImage (image_reader.h) says, and no other metadata; channels R G B A or Y A.
//
// Nothing for any other file, for a missing or a broken one, and for one of more samples than
// `max_samples`: ReadImage knows more kinds, and says what is wrong.
std::optional<Image> ReadPlainPng(const std::string& path, uint64_t max_samples);

}  // namespace nacre
