// SPDX-License-Identifier: Apache-2.0
// lesson/preset.h: --preset textbook: renders the lesson's own pictures to files.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "image_io/exr_writer.h"
#include "scene/scene.h"
#include "textbook/pictures.h"

namespace nacre {

enum class TextbookSubject : uint8_t { kComparison, kGrid };

// Which of the lesson's two pictures the scene corresponds to. Throws Error (kUsage) for other
// scenes; `file` is the scene's name in the message.
TextbookSubject ChooseTextbookSubject(const Scene& scene, const std::string& file);

// Renders with the lesson's own program, including its faults. Sides of 0 mean those of the lesson.
TextbookPicture RenderTextbookSubject(TextbookSubject subject, int width, int height);

// Writes the picture to EXR and PNG files: its float image, which is display-referred, as samples
// of `type`, and its codes. All files are opened before any is written, and all are complete before
// any gets its name; before_they_appear may throw, and then none does. Throws Error (kCannotWrite).
void WriteTextbookFiles(const TextbookPicture& picture, const std::vector<std::string>& paths,
                        PixelType type, const ExrOptions& options,
                        const std::function<void()>& before_they_appear);

}  // namespace nacre
