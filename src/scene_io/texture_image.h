// SPDX-License-Identifier: Apache-2.0
// scene_io/texture_image.h: reads image files as textures.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "scene/scene.h"

namespace nacre {

// What the values of integer files mean; files of floats are always linear. kAlpha: only the alpha
// channel is read, as linear numbers; 1 where a file has none.
enum class TextureEncoding : uint8_t { kSrgb, kLinear, kAlpha };

// How a file is read as a texture.
struct TextureReading {
  TextureEncoding encoding = TextureEncoding::kSrgb;
  // false: an integer file that would be decoded as sRGB is refused if it declares another colour
  // space (gAMA or cHRM of PNG, ICC profiles). glTF forbids checking this, and a scene may skip it.
  bool trust_encoding = true;
  // If above 0, the values are glossinesses, which are multiplied by this number. The texture holds
  // the corresponding roughness, 1 minus the product.
  double glossiness = 0;
  std::string part;  // which part of a multi-part EXR file
  int threads = 0;   // for decoding; 0: as many as the machine has
  std::function<void(const std::string&)> on_warning{};

  // Readings of one file have equal keys if they give the same texture.
  std::string Key(const std::filesystem::path& path) const;
};

// Limits the number of values (channels times texels) in the images of one scene or model together:
// 2^27 whatever the size of its files, beyond that 64 for each of their bytes, 2^30 at most.
// image_file.h bounds a single image in the same way, but many images may share a few bytes. Values
// that are decoded count even if the scene does not keep them.
class TexelBudget {
 public:
  // `file_bytes`: the size of the scene or model file with its buffers, without files that AddFile
  // counts. `values_before`: values of images that the scene already has, which reduce the maximum
  // of 2^30.
  explicit TexelBudget(uint64_t file_bytes, uint64_t values_before = 0)
      : file_bytes_(file_bytes), values_before_(values_before) {}

  // Counts the size of a file that belongs to the scene, once however often it is named.
  void AddFile(const std::filesystem::path& path);
  // To be called before values are decoded. Throws Error (kBadInput), located at `where`, if there
  // are too many, or if a side has more than 65536 texels.
  void Spend(const std::string& where, int64_t width, int64_t height, size_t channels);

 private:
  uint64_t file_bytes_, values_before_, spent_ = 0;
  std::set<std::filesystem::path> files_;
};

struct DecodedImage {
  SceneImage image;
  size_t outside = 0;  // number of pixels outside of Rec. 709's gamut
};

// Decodes images that a scene is going to read ahead of that, on several threads. Errors are left
// to the reader of each image, so that they are reported in the scene's order.
class TexturesAhead {
 public:
  // To be called in the order in which images are going to be read. Missing files are skipped.
  void Want(const std::filesystem::path& path, const TextureReading& reading);

  // Decodes all wanted images, as far as the budget, which is not spent, would allow them. Does
  // nothing for a single image, which its reader decodes as fast.
  void Decode(TexelBudget budget, int threads);

  // Moves the decoded image out; nullopt if it was not decoded or has been taken.
  std::optional<DecodedImage> Take(const std::filesystem::path& path,
                                   const TextureReading& reading);

 private:
  struct Wanted {
    std::filesystem::path path;
    TextureReading reading;
    std::optional<DecodedImage> image;
  };
  std::vector<Wanted> wanted_;
  std::map<std::string, size_t> by_key_;
};

// Reads any image file (image_io/image_file.h), decodes it to linear floats without loss, and
// builds its mip levels. Keeps red, green and blue, or the one channel of a grey image, or else
// alpha (kAlpha). Colours are not divided by alpha; those of EXR files are premultiplied by
// convention.
//
// The texture is the display window; pixels beyond it are ignored. Throws Error (kBadInput) for
// files that are missing, broken or crops, exceed the budget, have several parts of which none is
// named, or hold NaN or infinities. Floats that are read as colours (kSrgb) are converted from the
// file's primaries to Rec. 709, with a warning; components outside of its gamut are clipped at 0,
// with another warning. `file` is the name in SceneImage and in warnings.
//
// Memory: that of the file's samples (texture/texels.h), plus 4 bytes per value during reading.
// `ahead`, which may be null, supplies images that are decoded already.
SceneImage ReadTextureImage(const std::filesystem::path& path, const std::string& file,
                            const TextureReading& reading, TexelBudget* budget,
                            TexturesAhead* ahead = nullptr);

// Reads an image as ReadTextureImage does and adds it to the scene.
ImageId AddTextureImage(const std::filesystem::path& path, const std::string& file,
                        const TextureReading& reading, TexelBudget* budget, Scene* scene,
                        TexturesAhead* ahead = nullptr);

// The number of values in all images of the scene, without mip levels.
uint64_t TexelValuesOf(const Scene& scene);

}  // namespace nacre
