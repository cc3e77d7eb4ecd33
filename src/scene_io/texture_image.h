// SPDX-License-Identifier: Apache-2.0
// scene_io/texture_image.h: image files as textures take them.
#pragma once

#include <cstdint>
#include <filesystem>

#include "scene/scene.h"

namespace nacre {

// What the values of integer files mean; files of floats are linear whatever is said. kAlpha: the
// alpha channel alone, as numbers; 1 where a file has none.
enum class TextureEncoding : uint8_t { kSrgb, kLinear, kAlpha };

// Reads any image file (EXR by OpenEXR, plain PNG by itself, others by OpenImageIO, which is
// loaded then), decodes it to
// linear floats, exactly, and makes its mip levels. Red, green and blue are kept, or the one
// channel of a grey image; or else alpha. Throws Error (kBadInput) for files that are missing,
// broken, over 65536 texels a side or over 2^30 values, or that hold NaN or infinities. `file` is
// what SceneImage calls it.
SceneImage ReadTextureImage(const std::filesystem::path& path, const std::string& file,
                            TextureEncoding encoding, size_t max_values = kMaxTexelValues);

// The same, added to the scene, whose images have 2^30 values at most together.
ImageId AddTextureImage(const std::filesystem::path& path, const std::string& file,
                        TextureEncoding encoding, Scene* scene);

}  // namespace nacre
