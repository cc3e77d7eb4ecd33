// SPDX-License-Identifier: Apache-2.0
// view/answer.h: what pages are answered: errors, metrics of the present picture against the one
// kept as A, and files for download.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "base/error.h"
#include "base/image.h"
#include "color/display.h"
#include "render/render.h"
#include "scene_io/json_text.h"

namespace nacre {

// The message about the faults of a request for the value at `pointer`, or of any request if it is
// empty.
std::string FaultMessage(const std::string& pointer, const Error& error);

// The message about the exception that is being handled; to be called in a catch block.
std::string CaughtFault(const std::string& pointer);

// Metrics of the beauty. SSIM and FLIP compare the display pictures. The images must have the same
// window.
Json BeautyMetricsJson(const Image& got, const Image& reference, const DisplaySettings& display);

// Larger files are not sent, because the page and the server would hold several copies.
inline constexpr size_t kMaxFileBytes = size_t{128} << 20;

// The bytes of the EXR file that `nacre render` makes of the plan.
std::vector<uint8_t> RenderExr(const FramePlan& plan, const RenderSettings& settings);

}  // namespace nacre
