// SPDX-License-Identifier: Apache-2.0
// image_io/color_channels.h: which channels of an image are its colours, and whether they may be
// taken as linear Rec. 709.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

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

// Throws Error (kBadInput) if the file says that its primaries are not Rec. 709's (chromaticities
// of EXR). White luminance, adopted neutral and the like do not change what samples are, and are
// left alone.
void CheckPrimaries(const ImageFile& image);

// How far a coordinate of the same primary may be off in another file: three digits are off by
// 5e-4, and there is a white of .3127 .3290 and of .3128 .3292.
inline constexpr double kPrimariesError = 1e-3;

// Whether two attributes "chromaticities" mean the same primaries: x and y of red, green, blue and
// white.
bool SamePrimaries(const std::string& a, const std::string& b);

// The display window, which is the image. Throws Error (kBadInput) if the file has no samples for
// all of it, or has several parts; `what` ("a texture") needs it.
Window WholeWindow(const ImageFile& image, const std::string& what);

}  // namespace nacre
