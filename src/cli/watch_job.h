// SPDX-License-Identifier: Apache-2.0
// cli/watch_job.h: nacre render --watch: the job of a render again at each change of its files.
#pragma once

#include <filesystem>

#include "cli/render_options.h"

namespace nacre {

// Renders the scene at `path`, and again whenever its files have changed, until a stop signal
// comes; returns the exit code for that. `environment` as LoadOptions::environment. Throws Error
// for what is wrong before the first picture is written; later errors are printed.
int RunWatchJob(const RenderOptions& options, const std::filesystem::path& path,
                const std::filesystem::path& environment);

}  // namespace nacre
