// SPDX-License-Identifier: Apache-2.0
// render/render.h: from a scene to strips of pixels.
#pragma once

#include <functional>
#include <vector>

#include "render/film.h"
#include "render/frame_plan.h"
#include "render/stats.h"

namespace nacre {

// Receives finished strips: from any thread, in any order, several at once.
using StripSink = std::function<void(const Strip&)>;

// Renders what the plan says and hands strips of kStripRows rows, counted from the window's top,
// to the sink. A pixel's bits depend on scene, pixel, samples, target and the settings
// that choose another estimate (max_error, closed forms) only: not on threads, tiles, crop or the
// layers asked for. Exceptions of the sink and of settings.on_progress end it.
RenderStats Render(const FramePlan& plan, const RenderSettings& settings, const StripSink& sink);

// The film of a frame between passes.
struct FrameFilm {
  std::vector<TileFilm> tiles;
  int samples = 0;  // of each pixel, so far
};

// Adds samples [film->samples, end) of each pixel, end at most the plan's, and hands strips of the
// mean so far to the sink. settings.on_progress is told the share of the plan's samples. After all
// passes the picture has the bits of Render's. Not for adaptive
// sampling. A film whose pass has thrown is of no use any more.
RenderStats RenderPass(const FramePlan& plan, const RenderSettings& settings, int end,
                       FrameFilm* film, const StripSink& sink);

// Black, with the plan's channels; and the place of a strip in it.
Image EmptyImage(const FramePlan& plan);
void PutStrip(const Strip& strip, Image* image);

// The whole picture in memory, channels as StripChannels has them, all in float. For tests,
// comparisons and labels; `stats` may be null.
Image RenderImage(const Scene& scene, const RenderSettings& settings, RenderStats* stats = nullptr);
Image RenderImage(const FramePlan& plan, const RenderSettings& settings, RenderStats* stats);

}  // namespace nacre
