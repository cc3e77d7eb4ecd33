// SPDX-License-Identifier: Apache-2.0
// cli/textbook_job.h: nacre render --preset textbook: the founding lesson's pictures, faults and
// all, made by its own program (textbook/).
#pragma once

#include <string>

#include <CLI/App.hpp>

#include "cli/render_options.h"
#include "textbook/pictures.h"

namespace nacre {

enum class TextbookSubject : uint8_t { kComparison, kGrid };

// Which of the lesson's two pictures the scene asks for. Throws Error (usage) for a scene that is
// neither; `file` is what the message calls it.
TextbookSubject ChooseTextbookSubject(const Scene& scene, const std::string& file);

// Renders the picture that the scene at `path` chooses to options.outputs. `command` knows which
// options were given: those that cannot apply are refused. Throws Error.
void RunTextbookJob(const RenderOptions& options, const std::string& path, const CLI::App& command);

}  // namespace nacre
