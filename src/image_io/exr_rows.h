// SPDX-License-Identifier: Apache-2.0
// image_io/exr_rows.h: a strip's samples as they stand in an EXR file before compression.
#pragma once

#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include "image_io/exr_header.h"
#include "image_io/half.h"

namespace nacre {

// One channel of a strip: rows * width samples, row by row. Ids may be given as either; floats
// are rounded towards zero and held to the range of uint32_t.
using ChannelRows = std::variant<const float*, const uint32_t*>;

// Consecutive rows of a picture, in the order of ExrHeader::channels, over the data window's
// width.
struct StripView {
  int y = 0;  // of the first row, in the windows' coordinates
  int rows = 0;
  std::vector<ChannelRows> channels;
};

// How a row is stored: channel after channel, sorted by name, each as wide as the data window.
// All samples are whole 16-bit words, little-endian.
struct ExrLayout {
  std::vector<ExrChannel> channels;  // sorted
  std::vector<size_t> source;        // index of each in ExrHeader::channels
  size_t width = 0;
  size_t row_words = 0;
};

// 16-bit words of a sample.
size_t SampleWords(PixelType type);

// Throws Error (kInternal, where = path) for channels that no file can have: none, nameless ones,
// two of a name, or so many that a chunk of 32 rows would pass 2 GiB.
ExrLayout MakeExrLayout(const std::string& path, const ExrHeader& header);

// The strip's rows in the file's layout. `words` holds rows * row_words.
SampleCounts PackRows(const ExrLayout& layout, const StripView& strip, uint16_t* words);

}  // namespace nacre
