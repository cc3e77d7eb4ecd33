// SPDX-License-Identifier: Apache-2.0
// scene_io/texture_image.h: image files as textures take them.
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

// What the values of integer files mean; files of floats are linear whatever is said. kAlpha: the
// alpha channel alone, as numbers; 1 where a file has none.
enum class TextureEncoding : uint8_t { kSrgb, kLinear, kAlpha };

// How a file is read as a texture.
struct TextureReading {
  TextureEncoding encoding = TextureEncoding::kSrgb;
  // false: an integer file that is decoded as sRGB and says itself that it is something else (gAMA
  // or cHRM of PNG, ICC profiles) is refused. glTF forbids to look, and a scene may say so.
  bool trust_encoding = true;
  // Above 0: the values are glossinesses, which this multiplies. The texture holds the roughness
  // that they stand for, 1 less the product.
  double glossiness = 0;
  std::string part;  // of an EXR file that has several
  int threads = 0;   // to decode on; 0: as many as the machine has
  std::function<void(const std::string&)> on_warning{};

  // The same for readings of one file that give one texture.
  std::string Key(const std::filesystem::path& path) const;
};

// How many values the images of one scene or model may have together: 2^27 whatever the size of its
// files, beyond that 64 for each of their bytes, 2^30 at most. It is image_file.h's bound of one
// image, held for all of them: many images may share a few bytes. Values that are decoded count
// even if the scene does not keep them.
class TexelBudget {
 public:
  // `file_bytes`: of the scene or model file with its buffers, as far as AddFile does not count
  // them. `values_before`: of images that the scene has already, which leave fewer of the 2^30.
  explicit TexelBudget(uint64_t file_bytes, uint64_t values_before = 0)
      : file_bytes_(file_bytes), values_before_(values_before) {}

  // Counts the bytes of a file that belongs to the scene, once however often it is named.
  void AddFile(const std::filesystem::path& path);
  // To be called before they are decoded. Throws Error (kBadInput) in the place `where` if there
  // are too many, or if a side is over 65536 texels.
  void Spend(const std::string& where, int64_t width, int64_t height, size_t channels);

 private:
  uint64_t file_bytes_, values_before_, spent_ = 0;
  std::set<std::filesystem::path> files_;
};

struct DecodedImage {
  SceneImage image;
  size_t outside = 0;  // pixels that lay outside of Rec. 709's gamut
};

// Images that a scene is going to read, decoded ahead of that on several threads. What is wrong
// with one is left to its reader, so that faults are found in the scene's order.
class TexturesAhead {
 public:
  // In the order in which they are going to be read. Files that are missing are left out.
  void Want(const std::filesystem::path& path, const TextureReading& reading);

  // Decodes all that are wanted, as far as the budget would allow them; it is not spent. Nothing is
  // done for a single one, which its reader decodes as fast.
  void Decode(TexelBudget budget, int threads);

  // The image, once; nothing if it was not decoded.
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

// Reads any image file (image_io/image_file.h), decodes it to linear floats, exactly, and makes its
// mip levels. Red, green and blue are kept, or the one channel of a grey image; or else alpha.
// Colours are not divided by alpha: those of EXR files are multiplied by it, by convention.
//
// The texture is the display window; what a file has beyond it is left out. Throws Error
// (kBadInput) for files that are missing, broken or crops, that the budget does not allow, that
// have several parts and none is named, or that hold NaN or infinities. Floats that are read as
// colours (kSrgb) are converted to Rec. 709 from the file's primaries, with a warning; what is
// outside of its gamut is cut off at 0, with another. `file` is what SceneImage and warnings call
// it.
//
// Memory: that of the file's samples (texture/texels.h), and 4 bytes a value while it is read.
// `ahead`, which may be null, has some that are decoded.
SceneImage ReadTextureImage(const std::filesystem::path& path, const std::string& file,
                            const TextureReading& reading, TexelBudget* budget,
                            TexturesAhead* ahead = nullptr);

// The same, added to the scene.
ImageId AddTextureImage(const std::filesystem::path& path, const std::string& file,
                        const TextureReading& reading, TexelBudget* budget, Scene* scene,
                        TexturesAhead* ahead = nullptr);

// How many values the images of the scene have, mip levels left out.
uint64_t TexelValuesOf(const Scene& scene);

}  // namespace nacre
