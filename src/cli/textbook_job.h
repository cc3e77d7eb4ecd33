// SPDX-License-Identifier: Apache-2.0
// cli/textbook_job.h: nacre render --preset textbook: the pictures of the founding lesson,
// including its faults, made by the lesson's own program (lesson/preset.h).
#pragma once

#include <string>

#include <CLI/App.hpp>

#include "cli/render_options.h"

namespace nacre {

// Renders the picture that the scene at `path` selects to options.outputs. `command` tells which
// options were given, and those that cannot apply are refused. Throws Error.
void RunTextbookJob(const RenderOptions& options, const std::string& path, const CLI::App& command);

}  // namespace nacre
