// SPDX-License-Identifier: Apache-2.0
// image_io/color_channels.h: finds the colour channels of an image, and converts them to linear
// Rec. 709.
#pragma once

#include <array>
#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/vec.h"
#include "image_io/image_file.h"

namespace nacre {

// Indices of channels; a grey layer has the same index three times.
struct ColorChannels {
  size_t r = 0, g = 0, b = 0;

  bool is_grey() const { return r == g; }
};

// Whether the channel is an alpha channel: A, Alpha or layer.A, in any case.
bool IsAlphaChannel(std::string_view name);

// Finds the colours of a layer; the layer "" is the beauty. These are the channels R, G and B after
// "layer.", in upper or lower case; for the beauty, ".R" counts, too. Without them, it is the
// layer's Y, or its only channel that is not alpha (for the beauty, the only one of the whole
// image). The full name of a channel ("Z") is also accepted as a layer. nullopt if there is none of
// these.
std::optional<ColorChannels> FindColors(const std::vector<Channel>& channels,
                                        std::string_view layer);

// Lists the channels of an image without colours, for errors: "it has X, Y2, ...".
std::string TellChannels(const std::vector<Channel>& channels);

// How to convert colours to linear Rec. 709. White luminance, adopted neutral and similar
// attributes do not change the meaning of samples, and are ignored.
struct ColorConversion {
  std::optional<Imath::M33d> matrix;  // row vectors: rgb * matrix; nullopt: no conversion
  std::string note;                   // what to tell the user; may be ""
};

// The conversion from the primaries in a header (chromaticities of EXR, PRIMARIES of Radiance). If
// they are missing or invalid, Rec. 709 is assumed.
ColorConversion ConversionToRec709(const std::map<std::string, std::string>& metadata);

// Converts `count` colours, which are `step` samples apart. Colours that are not finite are left
// unchanged. With `clip`, negative components, which lie outside of Rec. 709's gamut, become 0.
// Returns the number of colours with a component below 0 by more than float's rounding error.
size_t ConvertColors(const Imath::M33d& matrix, const std::array<float*, 3>& rgb, size_t step,
                     size_t count, bool clip, int threads = 0);

// Tells the user how many pixels are outside of the gamut; "" for 0.
std::string OutsideNote(size_t outside);

// Converts all layers with R, G and B if necessary; then the image's metadata says Rec. 709.
// Returns what to tell the user, or "".
std::string ConvertImage(Image* image);

// The display window, which is the whole image. Throws Error (kBadInput) if the file lacks samples
// for some of it, or has several parts; `what` ("a texture") names the use that needs the whole
// image.
Window WholeWindow(const ImageFile& image, const std::string& what);

}  // namespace nacre
