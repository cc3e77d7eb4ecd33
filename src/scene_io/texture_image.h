// SPDX-License-Identifier: Apache-2.0
// scene_io/texture_image.h: image files as textures take them.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "scene/scene.h"

namespace nacre {

// What the values of integer files mean; files of floats are linear whatever is said. kAlpha: the
// alpha channel alone, as numbers; 1 where a file has none.
enum class TextureEncoding : uint8_t { kSrgb, kLinear, kAlpha };

// How a file is read as a texture.
struct TextureReading {
  TextureEncoding encoding = TextureEncoding::kSrgb;
  // false: an integer file that is decoded as sRGB and says itself that it is something else (gAMA
  // or cHRM of PNG, ICC profiles) is refused. glTF forbids to look, and a scene may say so.
  bool trust_encoding = true;
  std::string part;  // of an EXR file that has several
};

// Reads any image file (image_io/image_file.h), decodes it to linear floats, exactly, and makes its
// mip levels. Red, green and blue are kept, or the one channel of a grey image; or else alpha.
// Colours are not divided by alpha: those of EXR files are multiplied by it, by convention.
//
// The texture is the display window; what a file has beyond it is left out. Throws Error
// (kBadInput) for files that are missing, broken or crops, over 65536 texels a side or over 2^30
// values, that have several parts and none is named, whose primaries are not Rec. 709's, or that
// hold NaN or infinities. `file` is what SceneImage calls it.
//
// Memory: 16/3 bytes a value, which is what the texture keeps, and what the reader takes.
SceneImage ReadTextureImage(const std::filesystem::path& path, const std::string& file,
                            const TextureReading& reading, size_t max_values = kMaxTexelValues);

// How many values more the scene's images may have: 2^30 together.
size_t TexelValuesLeft(const Scene& scene);

// The same as ReadTextureImage, added to the scene, whose images have 2^30 values at most together.
ImageId AddTextureImage(const std::filesystem::path& path, const std::string& file,
                        const TextureReading& reading, Scene* scene);

}  // namespace nacre
