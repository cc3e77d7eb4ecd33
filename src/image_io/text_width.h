// SPDX-License-Identifier: Apache-2.0
// image_io/text_width.h: how wide text will be, without the module that draws it.
#pragma once

#include <string_view>

namespace nacre {

// Width in pixels of a line in DejaVu Sans, the font of DrawText, without kerning. Letters beyond
// ASCII count as the widest digit.
double TextWidth(std::string_view text, double size_px);

}  // namespace nacre
