// SPDX-License-Identifier: Apache-2.0
// scene_io/gltf_textures.h: the textures of a glTF file.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <utility>

#include "scene/scene.h"
#include "scene_io/gltf_document.h"
#include "scene_io/temporary_file.h"
#include "scene_io/texture_image.h"

namespace nacre {

// Where an image of the file is: a file of its own, or bytes within.
struct GltfImage {
  std::filesystem::path file;               // resolved; empty: `bytes` hold it
  std::shared_ptr<const std::string> data;  // of the buffer or the data URI
  std::string_view bytes;                   // in `data`: encoded (PNG, JPEG...)
  std::string key;  // the same for images that are one file, or the same bytes of one buffer
};

// What a material says of one of its textures.
struct GltfTextureUse {
  int texture = -1;  // below 0: none
  int tex_coord = 0;
  gltf::Extensions extensions = nullptr;
  TextureEncoding encoding = TextureEncoding::kLinear;
  double glossiness = 0;  // TextureReading's
};

// Adds textures and their images to a scene, each image once for each reading, however many of the
// document's images are the same file or bytes.
class GltfTextures {
 public:
  GltfTextures(GltfDocument* document, Scene* scene)
      : document_(*document), scene_(*scene), texels_(document->bytes) {}

  // The texture as it is used, in nacre's coordinates: v up. None where `use` has none, and, with a
  // warning, where nacre cannot show it. `place`: of the use, for errors. Throws Error (kBadInput)
  // for images that are missing or broken, or more than TexelBudget allows.
  TextureId Add(const GltfTextureUse& use, const std::string& place);

  // Throws Error (kBadInput) if the file has no such texture.
  void CheckIndex(int texture, const std::string& place) const;

  // Before all that: decodes the images that most materials have, several at a time.
  void DecodeAhead();

  // Whether it is a texture that changes nothing: all of its texels are 1.
  bool IsWhite(TextureId texture) const;

 private:
  ImageId AddImage(int image, const TextureReading& reading);
  ImageId DecodeImage(int image, const TextureReading& reading);
  void WantAhead(int texture, TextureEncoding encoding);
  // The image as a file: its own, or a temporary one.
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
  // By reading, and by index in the document or by GltfImage::key.
  std::map<std::pair<int, std::string>, ImageId> images_;
  std::map<std::pair<std::string, std::string>, ImageId> decoded_;
};

}  // namespace nacre
