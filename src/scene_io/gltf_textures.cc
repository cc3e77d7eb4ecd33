// SPDX-License-Identifier: Apache-2.0
#include "scene_io/gltf_textures.h"

#include <cmath>
#include <cstdlib>
#include <optional>

#include <fmt/format.h>
#include <unistd.h>

#include "base/error.h"
#include "scene/limits.h"
#include "scene_io/gltf_extension.h"
#include "scene_io/uri.h"

namespace nacre {
namespace {

// The file name suffix by which the decoder is chosen.
std::string SuffixOf(std::string_view bytes) {
  if (bytes.starts_with("\x89PNG")) return ".png";
  return bytes.starts_with("\xff\xd8") ? ".jpg" : ".image";
}

Wrap WrapOf(int gl_constant) {
  if (gl_constant == gltf::kClampToEdge) return Wrap::kClamp;
  return gl_constant == gltf::kMirroredRepeat ? Wrap::kMirror : Wrap::kRepeat;
}

// The nearest texel if the sampler magnifies so; no mip levels if it minifies by kLinear.
TextureFilter FilterOf(const gltf::Sampler& sampler) {
  if (sampler.magFilter == gltf::kNearest) return TextureFilter::kNearest;
  return sampler.minFilter == gltf::kLinear ? TextureFilter::kBilinear : TextureFilter::kTrilinear;
}

// Applies KHR_texture_transform, in which v points down, to coordinates in which v points up. With
// c and s, the cosine and sine of the rotation:
//   u' = ox + sx c u + sy s (1 - v)
//   v' = 1 - (oy - sx s u + sy c (1 - v))
// Checks the range here rather than in the validation of the scene, which would report converted
// numbers that are not in the file.
void ApplyTransform(const GltfDocument& document, const GltfExtension& transform,
                    Texture* texture) {
  const Vec2d offset = transform.Pair("offset", {0, 0}), scale = transform.Pair("scale", {1, 1});
  const double rotation = transform.Number("rotation", 0);
  const Range& range = limits::kTextureScale;
  const auto check = [&](const char* name, const Vec2d& given, const Vec2d& tested,
                         const char* hint) {
    if (range.Contains(tested.x) && range.Contains(tested.y)) return;
    document.Refuse(transform.PlaceOf(name),
                    fmt::format("[{}, {}] is out of range", given.x, given.y),
                    fmt::format("each number {}{}", Describe(range), hint));
  };
  check("scale", scale, scale, "");
  constexpr double kMostTurns = limits::kAngleDeg.max / 360;
  if (!(std::abs(rotation) <= kMostTurns * 2 * M_PI)) {
    document.Refuse(transform.PlaceOf("rotation"), fmt::format("{} is out of range", rotation),
                    fmt::format("radians, {} turns at most", kMostTurns));
  }
  const double c = std::cos(rotation), s = std::sin(rotation);
  texture->scale = scale;
  texture->uv_rotate_deg = rotation * 180 / M_PI;
  texture->offset = {offset.x + scale.y * s, 1 - offset.y - scale.y * c};
  check("offset", offset, texture->offset, ", with what the scale adds to it");
}

// Locates an image. Throws Error (kBadInput) for images that do not exist, are out of bounds, or
// lie outside the folder, and for malformed data URIs.
GltfImage FindImage(const GltfDocument& document, int image) {
  const gltf::Model& model = document.model;
  const std::string place = fmt::format("/images/{}", image);
  const gltf::Image& source = document.At(model.images, image, place, "there is no such image");
  if (source.bufferView < 0) {
    if (source.uri.empty()) document.Refuse(place, "has no \"uri\" and no \"bufferView\"");
    GltfImage found;
    if (!IsDataUri(source.uri)) {
      found.file = document.Resolve(source.uri, place);
      found.key = found.file.string();
      return found;
    }
    std::optional<std::string> data = DecodeDataUri(source.uri);
    if (!data || data->empty()) document.Refuse(place + "/uri", "is a malformed data URI");
    found.data = std::make_shared<const std::string>(std::move(*data));
    found.bytes = *found.data;
    found.key = fmt::format("image {}", image);
    return found;
  }
  const gltf::BufferView* const found = gltf::ItemAt(model.bufferViews, source.bufferView);
  if (found == nullptr) {
    document.Refuse(place, fmt::format("there is no buffer view {}", source.bufferView));
  }
  const gltf::BufferView& view = *found;
  const gltf::Buffer* const buffer = gltf::ItemAt(model.buffers, view.buffer);
  if (buffer == nullptr || buffer->data == nullptr) {
    document.Refuse(place, fmt::format("there is no buffer {}", view.buffer));
  }
  const auto& data = buffer->data;
  if (view.byteOffset > data->size() || view.byteLength > data->size() - view.byteOffset) {
    document.Refuse(place, "reaches beyond its buffer");
  }
  if (view.byteLength == 0) document.Refuse(place, "has no bytes");
  // Buffers of the same file share their data, and so their key.
  return {.file = {},
          .data = data,
          .bytes = std::string_view(*data).substr(view.byteOffset, view.byteLength),
          .key = fmt::format("{} {} {}", static_cast<const void*>(data.get()), view.byteOffset,
                             view.byteLength)};
}

}  // namespace

TemporaryFile::TemporaryFile(std::string_view bytes, const std::string& suffix)
    : path_((std::filesystem::temp_directory_path() / "nacre-XXXXXX").string() + suffix) {
  const int file = mkstemps(path_.data(), static_cast<int>(suffix.size()));
  bool written = file >= 0;
  while (written && !bytes.empty()) {
    const ssize_t count = write(file, bytes.data(), bytes.size());
    written = count > 0;
    if (written) bytes.remove_prefix(static_cast<size_t>(count));
  }
  if (file >= 0) close(file);
  if (written) return;
  if (file >= 0) unlink(path_.c_str());
  throw Error(ExitCode::kInternal, path_, "cannot be written",
              "an image inside a model is decoded from there");
}

TemporaryFile::~TemporaryFile() { unlink(path_.c_str()); }

ImageId GltfTextures::AddImage(int image, const TextureReading& reading) {
  const auto [known, is_new] = images_.try_emplace({image, reading.Key({})});
  if (is_new) known->second = DecodeImage(image, reading);
  return known->second;
}

std::filesystem::path GltfTextures::FileOf(const GltfImage& image) {
  if (!image.file.empty()) return image.file;
  std::unique_ptr<const TemporaryFile>& file = files_[image.key];
  if (file == nullptr) {
    file = std::make_unique<const TemporaryFile>(image.bytes, SuffixOf(image.bytes));
  }
  return file->path();
}

void GltfTextures::WantAhead(int texture, TextureEncoding encoding) {
  const gltf::Texture* const source = gltf::ItemAt(document_.model.textures, texture);
  const int image = source != nullptr ? source->source : -1;
  if (image < 0) return;
  try {
    ahead_.Want(FileOf(FindImage(document_, image)), Reading(encoding));
  } catch (const Error&) {  // NOLINT(bugprone-empty-catch): Add will throw it again
  }
}

void GltfTextures::DecodeAhead() {
  if (document_.model.images.size() < 2) return;
  for (const gltf::Material& material : document_.model.materials) {
    const auto& pbr = material.pbrMetallicRoughness;
    WantAhead(pbr.baseColorTexture.index, TextureEncoding::kSrgb);
    if (gltf::FindExtension(material.extensions, "KHR_materials_unlit") != nullptr) continue;
    WantAhead(pbr.metallicRoughnessTexture.index, TextureEncoding::kLinear);
    WantAhead(material.emissiveTexture.index, TextureEncoding::kSrgb);
    WantAhead(material.normalTexture.index, TextureEncoding::kLinear);
  }
  ahead_.Decode(texels_, document_.threads);
}

ImageId GltfTextures::DecodeImage(int image, const TextureReading& reading) {
  const GltfImage source = FindImage(document_, image);
  const auto key = std::make_pair(source.key, reading.Key({}));
  const auto known = decoded_.find(key);
  if (known != decoded_.end()) return known->second;
  const gltf::Image& named = document_.model.images[static_cast<size_t>(image)];
  const bool is_file = !source.file.empty();
  const std::string name = is_file ? named.uri : fmt::format("image {}", image);
  try {
    if (is_file) texels_.AddFile(source.file);
    const ImageId id = AddTextureImage(FileOf(source), name, reading, &texels_, &scene_, &ahead_);
    files_.erase(source.key);
    decoded_.emplace(key, id);
    return id;
  } catch (const Error& error) {
    if (error.code() != ExitCode::kBadInput) throw;
    const Fault& fault = error.faults().front();
    document_.Refuse(fmt::format("/images/{}", image), fault.what,
                     fault.hint.empty() ? "save it again as PNG or JPEG" : fault.hint);
  }
}

TextureId GltfTextures::Add(const GltfTextureUse& use, const std::string& place) {
  if (use.texture < 0) return {};
  CheckIndex(use.texture, place);
  const gltf::Model& model = document_.model;
  const gltf::Texture& source = model.textures[static_cast<size_t>(use.texture)];
  if (source.source < 0) {
    document_.Warn("textures whose images only an extension names are left out");
    return {};
  }
  Texture texture;
  texture.name = fmt::format("texture {} of {}", use.texture, place);
  double tex_coord = use.tex_coord;
  if (const Json* transform = gltf::FindExtension(use.extensions, "KHR_texture_transform")) {
    const GltfExtension reader(document_, *transform, place + "/extensions/KHR_texture_transform");
    ApplyTransform(document_, reader, &texture);
    tex_coord = reader.Number("texCoord", tex_coord);
  }
  if (tex_coord != 0 && tex_coord != 1) {
    document_.Warn("textures on other coordinates than TEXCOORD_0 and TEXCOORD_1 are left out");
    return {};
  }
  texture.second_uvs = tex_coord == 1;
  if (source.sampler >= 0) {
    const gltf::Sampler* const sampler = gltf::ItemAt(model.samplers, source.sampler);
    if (sampler == nullptr) {
      document_.Refuse(fmt::format("/textures/{}/sampler", use.texture),
                       fmt::format("there is no sampler {}", source.sampler));
    }
    texture.sampling = {FilterOf(*sampler), WrapOf(sampler->wrapS), WrapOf(sampler->wrapT)};
  }
  texture.image = AddImage(source.source, Reading(use.encoding, use.glossiness));
  scene_.textures.push_back(std::move(texture));
  return {static_cast<uint32_t>(scene_.textures.size() - 1)};
}

}  // namespace nacre
