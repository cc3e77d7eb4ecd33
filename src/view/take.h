// SPDX-License-Identifier: Apache-2.0
// view/take.h: renders the picture to a file for download.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "render/render.h"

namespace nacre {

// Larger files are not sent, because the page and the server would hold several copies.
inline constexpr size_t kMaxFileBytes = size_t{128} << 20;

// The bytes of the EXR file that `nacre render` makes of the plan.
std::vector<uint8_t> RenderExr(const FramePlan& plan, const RenderSettings& settings);

}  // namespace nacre
