// SPDX-License-Identifier: Apache-2.0
// cli/watch_job.h: nacre render --watch: repeats a render whenever its files change.
#pragma once

#include <filesystem>

#include "cli/render_options.h"

namespace nacre {

// Renders the scene at `path`, and again whenever its files have changed, until a stop signal
// comes; returns the exit code for that signal. `environment` is LoadOptions::environment. Throws
// Error for errors before the first picture is written; later errors are printed.
int RunWatchJob(const RenderOptions& options, const std::filesystem::path& path,
                const std::filesystem::path& environment);

}  // namespace nacre
