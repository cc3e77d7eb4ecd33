// SPDX-License-Identifier: Apache-2.0
// cli/textbook_job.h: nacre render --preset textbook: the founding lesson's pictures, faults and
// all, made by its own program (lesson/preset.h).
#pragma once

#include <string>

#include <CLI/App.hpp>

#include "cli/render_options.h"

namespace nacre {

// Renders the picture that the scene at `path` chooses to options.outputs. `command` knows which
// options were given: those that cannot apply are refused. Throws Error.
void RunTextbookJob(const RenderOptions& options, const std::string& path, const CLI::App& command);

}  // namespace nacre
