// SPDX-License-Identifier: Apache-2.0
// image_io/exr_rows.h: converts a strip's samples to the layout of an EXR file before compression.
#pragma once

#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include "image_io/exr_header.h"
#include "image_io/half.h"

namespace nacre {

// One channel of a strip: rows * width samples, row by row. Ids may be given in either type; floats
// are truncated and clamped to the range of uint32_t.
using ChannelRows = std::variant<const float*, const uint32_t*>;

// Consecutive rows of a picture, over the width of the data window. Channels are in the order of
// ExrHeader::channels.
struct StripView {
  int y = 0;  // of the first row, in the coordinates of the windows
  int rows = 0;
  std::vector<ChannelRows> channels;
};

// The layout of a row in the file: channel by channel, sorted by name, each as wide as the data
// window. All samples are whole 16-bit words, little-endian.
struct ExrLayout {
  std::vector<ExrChannel> channels;  // sorted
  std::vector<size_t> source;        // the index of each in ExrHeader::channels
  size_t width = 0;
  size_t row_words = 0;
};

// The number of 16-bit words of a sample.
size_t SampleWords(PixelType type);

// Throws Error (kInternal, where = path) for channels that no file can have: none, nameless ones,
// two with one name, or so many that a chunk of 32 rows would exceed 2 GiB.
ExrLayout MakeExrLayout(const std::string& path, const ExrHeader& header);

// Converts the strip's rows to the file's layout. `words` has room for rows * row_words.
SampleCounts PackRows(const ExrLayout& layout, const StripView& strip, uint16_t* words);

}  // namespace nacre
