// SPDX-License-Identifier: Apache-2.0
// scene_io/gltf_textures.h: the textures of a glTF file.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "scene/scene.h"
#include "scene_io/gltf_document.h"
#include "scene_io/texture_image.h"

namespace nacre {

// Where an image of the file is stored: in a file of its own, or in bytes of the document.
struct GltfImage {
  std::filesystem::path file;               // resolved path; empty: the image is in `bytes`
  std::shared_ptr<const std::string> data;  // the buffer or data URI that holds `bytes`
  std::string_view bytes;                   // view into `data`, encoded (PNG, JPEG...)
  std::string key;  // equal for images that are one file, or the same bytes of one buffer
};

// How a material uses one of its textures.
struct GltfTextureUse {
  int texture = -1;  // below 0: none
  int tex_coord = 0;
  gltf::Extensions extensions = nullptr;
  TextureEncoding encoding = TextureEncoding::kLinear;
  double glossiness = 0;  // TextureReading::glossiness
};

// A file in the folder for temporary files, deleted with the object, for readers that need one.
// Throws Error (kInternal) if it cannot be written.
class TemporaryFile {
 public:
  // `suffix`: the end of the file's name, such as ".png".
  TemporaryFile(std::string_view bytes, const std::string& suffix);
  ~TemporaryFile();
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;

  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

// Adds textures and their images to a scene. Each image is read once per way of reading it
// (TextureReading), however many of the document's images are the same file or bytes.
class GltfTextures {
 public:
  GltfTextures(GltfDocument* document, Scene* scene)
      : document_(*document), scene_(*scene), texels_(document->bytes) {}

  // Adds the texture as it is used and returns its id, in nacre's texture coordinates (v up).
  // Returns none where `use` has no texture, and, with a warning, where nacre cannot show it.
  // `place` locates the use in errors. Throws Error (kBadInput) for images that are missing or
  // broken, or exceed the TexelBudget.
  TextureId Add(const GltfTextureUse& use, const std::string& place);

  // Throws Error (kBadInput) if the file has no such texture.
  void CheckIndex(int texture, const std::string& place) const {
    document_.At(document_.model.textures, texture, place,
                 fmt::format("there is no texture {}", texture));
  }

  // Decodes the images that most materials have on several threads. To be called before Add.
  void DecodeAhead();

  // Whether the texture has no effect because all of its texels are 1.
  bool IsWhite(TextureId texture) const {
    return texture.valid() && scene_.images[scene_.textures[texture.index].image.index].is_white;
  }

 private:
  ImageId AddImage(int image, const TextureReading& reading);
  ImageId DecodeImage(int image, const TextureReading& reading);
  void WantAhead(int texture, TextureEncoding encoding);
  // A file that holds the image: its own, or a temporary one.
  std::filesystem::path FileOf(const GltfImage& image);
  TextureReading Reading(TextureEncoding encoding, double glossiness = 0) const {
    return {.encoding = encoding,
            .glossiness = glossiness,
            .part = {},
            .threads = document_.threads,
            .on_warning = [this](const std::string& text) { document_.Warn(text); }};
  }

  GltfDocument& document_;
  Scene& scene_;
  TexelBudget texels_;
  TexturesAhead ahead_;
  std::map<std::string, std::unique_ptr<const TemporaryFile>> files_;  // by GltfImage::key
  // By reading, together with the image's index in the document (images_) or GltfImage::key
  // (decoded_).
  std::map<std::pair<int, std::string>, ImageId> images_;
  std::map<std::pair<std::string, std::string>, ImageId> decoded_;
};

}  // namespace nacre
