// SPDX-License-Identifier: Apache-2.0
// cli/render_job.h: the whole job behind render, grid and pair: scene in, files out.
#pragma once

#include <functional>
#include <vector>

#include "cli/render_options.h"
#include "image_io/draw_text.h"

namespace nacre {

// Checks the outputs (`inputs` are the files that the command names), calls `load`, renders and
// writes.
// `load` gets what scene_io is to be told. `captions`, if any, are drawn into PNG files in place of
// the scene's labels; they are in pixels of the whole frame. Throws Error.
void RunRenderJob(const RenderOptions& options, const std::vector<std::string>& inputs,
                  const std::function<Scene(const LoadOptions&)>& load,
                  const std::vector<TextItem>& captions = {});

}  // namespace nacre
