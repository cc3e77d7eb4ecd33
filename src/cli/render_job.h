// cli/render_job.h: the whole job behind render, grid and pair: scene in, files out.
#pragma once

#include <functional>

#include "cli/render_options.h"

namespace nacre {

// Checks the outputs (`input` is the scene's file, or empty), calls `load`, renders and writes.
// `load` gets what scene_io is to be told. Throws Error.
void RunRenderJob(const RenderOptions& options, const std::string& input,
                  const std::function<Scene(const LoadOptions&)>& load);

}  // namespace nacre
