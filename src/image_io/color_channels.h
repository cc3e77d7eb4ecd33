// SPDX-License-Identifier: Apache-2.0
// image_io/color_channels.h: which channels of an image are its colours, and whether they may be
// taken as linear Rec. 709.
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

// Indices of channels; the same three times for a grey layer.
struct ColorChannels {
  size_t r = 0, g = 0, b = 0;

  bool is_grey() const { return r == g; }
};

// A, Alpha and layer.A, in any case.
bool IsAlphaChannel(std::string_view name);

// The colours of a layer, "" for the beauty: R, G and B after "layer.", in upper or lower case; of
// the beauty also those called ".R". Without them the layer's Y, or its only channel that is not
// alpha: of the beauty that of the whole image. A channel's own name ("Z") is a layer, too. Nothing
// if there is none of these.
std::optional<ColorChannels> FindColors(const std::vector<Channel>& channels,
                                        std::string_view layer);

// What an image without them has instead, for errors: "it has X, Y2, ...".
std::string TellChannels(const std::vector<Channel>& channels);

// What is done with colours to have them in linear Rec. 709. White luminance, adopted neutral and
// the like do not change what samples are, and are left alone.
struct ColorConversion {
  std::optional<Imath::M33d> matrix;  // rgb * it; none: they are taken as they are
  std::string note;                   // what to tell of it; "" if there is nothing
};

// By what a header says of its primaries (chromaticities of EXR, PRIMARIES of Radiance).
// Without a word of them, and by a word that names none, they are Rec. 709's.
ColorConversion ConversionToRec709(const std::map<std::string, std::string>& metadata);

// Converts `count` colours, each `step` after the one before. Colours that are not finite stay as
// they are. `clip`: what lies outside of Rec. 709's gamut, below 0, becomes 0. Returns how many do,
// by more than float's rounding.
size_t ConvertColors(const Imath::M33d& matrix, const std::array<float*, 3>& rgb, size_t step,
                     size_t count, bool clip, int threads = 0);

// What to tell of so many; "" of none.
std::string OutsideNote(size_t outside);

// Converts all layers of R, G and B, if that is needed, after which the image says that it is in
// Rec. 709. Returns what to tell of it.
std::string ConvertImage(Image* image);

// The display window, which is the image. Throws Error (kBadInput) if the file has no samples for
// all of it, or has several parts; `what` ("a texture") needs it.
Window WholeWindow(const ImageFile& image, const std::string& what);

}  // namespace nacre
