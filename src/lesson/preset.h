// SPDX-License-Identifier: Apache-2.0
// lesson/preset.h: --preset textbook: the lesson's own pictures as files.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "image_io/exr_writer.h"
#include "scene/scene.h"
#include "textbook/pictures.h"

namespace nacre {

enum class TextbookSubject : uint8_t { kComparison, kGrid };

// Which of the lesson's two pictures the scene asks for. Throws Error (usage) for a scene that is
// neither; `file` is what the message calls it.
TextbookSubject ChooseTextbookSubject(const Scene& scene, const std::string& file);

// By the lesson's own program, faults and all. Sides that are 0 are the lesson's.
TextbookPicture RenderTextbookSubject(TextbookSubject subject, int width, int height);

// Writes the picture to EXR and PNG files: its float image, which is display-referred, as samples
// of `type`, and its codes. All files are open before any is written, and complete before any gets
// its name; before_they_appear may throw, and then none does. Throws Error (kCannotWrite).
void WriteTextbookFiles(const TextbookPicture& picture, const std::vector<std::string>& paths,
                        PixelType type, const ExrOptions& options,
                        const std::function<void()>& before_they_appear);

}  // namespace nacre
