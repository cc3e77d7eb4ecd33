// SPDX-License-Identifier: Apache-2.0
// render/render.h: renders a scene to strips of pixels.
#pragma once

#include <functional>
#include <vector>

#include "base/cancel.h"
#include "render/film.h"
#include "render/frame_plan.h"
#include "render/stats.h"

namespace nacre {

// Receives finished strips: from any thread, in any order, several at once.
using StripSink = std::function<void(const Strip&)>;

// Renders the plan's window and hands it to the sink in strips of kStripRows rows, counted from the
// window's top. The bits of a pixel depend only on the scene, the pixel's position, the number of
// samples, the SIMD target and the settings that choose another estimate (max_error with
// max_samples, closed_forms, far_lights): not on threads, tiles, the region, or which layers are
// rendered. An exception that the sink or settings.on_progress throws ends the render.
RenderStats Render(const FramePlan& plan, const RenderSettings& settings, const StripSink& sink);

// The film of a whole frame, kept from one pass of a progressive render to the next.
struct FrameFilm {
  std::vector<TileFilm> tiles;  // strip by strip, from left to right
  int samples = 0;              // of each pixel, so far
};

// One pass of a progressive render: adds samples [film->samples, end) of each pixel, where `end` is
// at most the plan's samples per pixel, and writes the mean of all samples so far to the image,
// which FitImage has made. settings.on_progress gets the share of the plan's samples. After the
// last pass the picture has the same bits as Render's. Not for adaptive sampling, nor for plans of
// one sample. After a pass that has thrown the film must not be used again.
RenderStats RenderPass(const FramePlan& plan, const RenderSettings& settings, int end,
                       FrameFilm* film, Image* image);

// Gives the image the plan's channels, all as float, and the size of the plan's window. Channels
// that it already has are not cleared. Throws Cancelled if the settings say so, and leaves no
// channels, because clearing a large channel takes longer than a cancelled render may.
void FitImage(const FramePlan& plan, const RenderSettings& settings, Image* image);

// Renders the whole window into an image, which is made to fit. Each pixel is written once,
// directly to its place.
RenderStats RenderInto(const FramePlan& plan, const RenderSettings& settings, Image* image);

// Renders the whole window into a new image. `stats` may be null.
Image RenderImage(const Scene& scene, const RenderSettings& settings, RenderStats* stats = nullptr);
Image RenderImage(const FramePlan& plan, const RenderSettings& settings, RenderStats* stats);

// A message about pixels that have not converged; "" if all have.
std::string UnsettledNote(const FramePlan& plan, const RenderStats& stats);

}  // namespace nacre
