// SPDX-License-Identifier: Apache-2.0
#include "scene_io/gltf_document.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstring>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "base/error.h"
#include "base/excerpt.h"
#include "base/path.h"
#include "base/printable.h"
#include "scene/fault_list.h"
#include "scene_io/text_file.h"
#include "scene_io/text_lines.h"
#include "scene_io/uri.h"

namespace nacre {
namespace {

constexpr uint64_t kMaxBytes = 0xffffffffu;  // the largest length in a GLB header

// Extensions that nacre supports, at least in part, or that do not change the picture.
constexpr std::array<std::string_view, 15> kKnownExtensions = {
    "EXT_texture_webp",
    "KHR_materials_anisotropy",
    "KHR_materials_clearcoat",
    "KHR_materials_iridescence",
    "KHR_materials_sheen",
    "KHR_lights_punctual",
    "KHR_materials_emissive_strength",
    "KHR_materials_ior",
    "KHR_materials_pbrSpecularGlossiness",
    "KHR_materials_specular",
    "KHR_materials_unlit",
    "KHR_mesh_quantization",
    "KHR_xmp_json_ld",
    "KHR_texture_transform",
    "KHR_materials_variants"};

bool IsKnown(const std::string& extension) {
  return std::ranges::find(kKnownExtensions, extension) != kKnownExtensions.end();
}

uint32_t Word(std::string_view bytes, size_t offset) {
  std::array<unsigned char, 4> b;
  std::memcpy(b.data(), bytes.data() + offset, 4);
  return b[0] | uint32_t{b[1]} << 8 | uint32_t{b[2]} << 16 | uint32_t{b[3]} << 24;
}

bool IsBinary(std::string_view bytes) { return bytes.starts_with("glTF"); }

constexpr size_t kHeader = 12, kChunkHeader = 8;  // sizes in bytes in a GLB file
constexpr uint32_t kJson = 0x4e4f534a, kBinary = 0x004e4942;

[[noreturn]] void RefuseDamaged(const std::string& file, std::string what) {
  throw Error(ExitCode::kBadInput, file, std::move(what), "the file is damaged or incomplete");
}

// How many of a file's `size` bytes to read, judged by `head`, its beginning: all of a text, and
// the length in the header of a binary file. Throws Error (kBadInput) for what cannot be glTF.
uint64_t JudgeHead(std::string_view head, uint64_t size, const std::string& file) {
  if (!IsBinary(head)) {
    const std::string_view text = WithoutByteOrderMark(head, file);
    // A .gltf file may be named .glb by mistake.
    const size_t start = text.find_first_not_of(" \t\r\n");
    if (HasExtension(file, ".glb") && (start == std::string_view::npos || text[start] != '{')) {
      throw Error(ExitCode::kBadInput, file, R"(does not begin with "glTF", as .glb files do)",
                  "is it a web page that a download left, or another kind of file?");
    }
    const size_t zero = text.find('\0');
    if (zero != std::string_view::npos) RefuseZero(head, zero, file);
    return size;
  }
  if (size < kHeader + kChunkHeader) RefuseDamaged(file, "is too short for a binary glTF file");
  if (Word(head, 4) != 2) {
    throw Error(ExitCode::kBadInput, file, fmt::format("is glTF {}", Word(head, 4)),
                "this program reads glTF 2.0");
  }
  const uint64_t length = Word(head, 8);
  if (length > size) {
    RefuseDamaged(file, fmt::format("has {} bytes, and says that it has {}", size, length));
  }
  if (length < kHeader + kChunkHeader || Word(head, kHeader + 4) != kJson) {
    RefuseDamaged(file, "its first chunk is not JSON");
  }
  if (Word(head, kHeader) > length - kHeader - kChunkHeader) {
    RefuseDamaged(file, fmt::format("the chunk at byte {} is longer than the file", kHeader));
  }
  return length;
}

struct BinaryFile {
  std::string_view json;
  std::optional<std::string_view> data;  // the binary chunk, if there is one
};

// Splits a binary file into chunks. `bytes` must end where the header that JudgeHead has checked
// says.
BinaryFile ChunksOf(std::string_view bytes, const std::string& file) {
  const uint64_t length = bytes.size();
  BinaryFile result;
  size_t chunk = 0;
  for (uint64_t offset = kHeader; offset < length; ++chunk) {
    if (length - offset < kChunkHeader || length - offset - kChunkHeader < Word(bytes, offset)) {
      RefuseDamaged(file, fmt::format("the chunk at byte {} is longer than the file", offset));
    }
    const uint32_t type = Word(bytes, offset + 4);
    const std::string_view content = bytes.substr(offset + kChunkHeader, Word(bytes, offset));
    if (chunk == 0) result.json = content;
    if (chunk == 1 && type == kBinary) result.data = content;  // other chunks belong to extensions
    offset += kChunkHeader + content.size();
  }
  // Some exporters pad the JSON with characters 0 instead of blanks.
  result.json = result.json.substr(0, result.json.find_last_not_of('\0') + 1);
  if (result.json.empty()) RefuseDamaged(file, "its first chunk is not JSON");
  return result;
}

// Returns `part`, which is within `bytes`, as a string that reuses the memory of `bytes`.
std::string Keep(std::string_view part, std::string bytes) {
  const auto offset = static_cast<size_t>(part.data() - bytes.data());
  bytes.resize(offset + part.size());
  bytes.erase(0, offset);
  return bytes;
}

// Loads the bytes of all buffers. Each file is read once, however many buffers use it.
// `binary_chunk` is the binary chunk of the document's own file; null if it has none.
void ReadBuffers(const std::shared_ptr<const std::string>& binary_chunk, GltfDocument* document) {
  std::map<std::filesystem::path, std::shared_ptr<const std::string>> files;
  const auto read = [&](const std::string& uri, const std::string& place) {
    if (IsDataUri(uri)) {
      std::optional<std::string> data = DecodeDataUri(uri);
      if (!data) document->Refuse(place + "/uri", "is a malformed data URI");
      return std::make_shared<const std::string>(std::move(*data));
    }
    const std::filesystem::path path = document->Resolve(uri, place + "/uri");
    std::shared_ptr<const std::string>& bytes = files[path];
    if (bytes == nullptr) {
      bytes = std::make_shared<const std::string>(ReadBytes(path, kMaxBytes));
      document->bytes += bytes->size();
    }
    return bytes;
  };
  auto& buffers = document->model.buffers;
  for (size_t i = 0; i < buffers.size(); ++i) {
    Json& json = document->root["buffers"][i];
    const std::string place = fmt::format("/buffers/{}", i);
    const auto uri = json.find("uri");
    if (uri != json.end()) {
      buffers[i].data = read(uri->get_ref<const std::string&>(), place);
      uri->get_ref<std::string&>().clear();  // keeps the data only once
    } else if (i == 0 && binary_chunk) {
      buffers[i].data = binary_chunk;
    } else {
      continue;  // missing data is reported where it is used
    }
    if (buffers[i].data->size() < buffers[i].byteLength) {
      document->Refuse(place,
                       fmt::format("has {} bytes, not the {} of its byteLength",
                                   buffers[i].data->size(), buffers[i].byteLength),
                       "the file is damaged or incomplete");
    }
  }
}

// The major and minor number of a version like "2.0".
std::optional<std::pair<unsigned, unsigned>> VersionOf(std::string_view text) {
  std::pair<unsigned, unsigned> version;
  const char* const end = text.data() + text.size();
  const auto major = std::from_chars(text.data(), end, version.first);
  if (major.ec != std::errc() || major.ptr == end || *major.ptr != '.') return std::nullopt;
  const auto minor = std::from_chars(major.ptr + 1, end, version.second);
  if (minor.ec != std::errc() || minor.ptr != end) return std::nullopt;
  return version;
}

// Refuses files of glTF 1, whose top-level arrays are objects, before they cause a fault
// everywhere.
void RefuseOldVersion(const GltfDocument& document) {
  const Json& root = document.root;
  if (!root.is_object()) return;
  const auto accessors = root.find("accessors");
  const auto asset = root.find("asset");
  const Json version = asset != root.end() && asset->is_object() && asset->contains("version")
                           ? (*asset)["version"]
                           : Json();
  const bool says_so = (version.is_string() && version.get_ref<const std::string&>() == "1.0") ||
                       (version.is_number() && version.get<double>() == 1);
  if (says_so || (accessors != root.end() && accessors->is_object())) {
    document.Refuse("/asset/version", "glTF 1.0", "this program reads glTF 2.0");
  }
}

// Collects the names of the extensions of all objects in the tree, since some files do not list
// those that they use. Animations are skipped, because they are not shown at all.
void FindExtensions(const Json& json, std::set<std::string>* names) {
  if (json.is_object()) {
    for (const auto& [name, member] : json.items()) {
      if (name == "extras" || name == "animations") continue;
      if (name == "extensions" && member.is_object()) {
        for (const auto& [extension, value] : member.items()) names->insert(extension);
      }
      FindExtensions(member, names);
    }
  } else if (json.is_array()) {
    for (const Json& element : json) FindExtensions(element, names);
  }
}

// Versions "2.x" are read as 2.0, which they extend, unless minVersion says that this is not
// enough.
void CheckVersionAndExtensions(GltfDocument* document) {
  const gltf::Model& model = document->model;
  const std::string reads = "this program reads glTF 2.0";
  const auto version = VersionOf(model.asset.version);
  if (!version || version->first != 2) {
    document->Refuse("/asset/version", fmt::format("glTF {}", Excerpt(model.asset.version)), reads);
  }
  if (!model.asset.minVersion.empty()) {
    const auto least = VersionOf(model.asset.minVersion);
    if (!least || *least > std::make_pair(2u, 0u)) {
      document->Refuse("/asset/minVersion",
                       fmt::format("glTF {} is required", Excerpt(model.asset.minVersion)), reads);
    }
  }
  for (const std::string& extension : model.extensionsRequired) {
    if (IsKnown(extension)) continue;
    document->Refuse(
        "/extensionsRequired",
        fmt::format("the extension {} is required and not known here", Excerpt(extension)),
        extension.find("_texture_") != std::string::npos
            ? "export the model with PNG, JPEG or WebP textures"
            : "export the model without it");
  }
  std::set<std::string> used(model.extensionsUsed.begin(), model.extensionsUsed.end());
  FindExtensions(document->root, &used);
  for (const std::string& extension : used) {
    if (IsKnown(extension)) continue;
    document->Warn(
        fmt::format("the extension {} is not known here and left out", Excerpt(extension)));
  }
}

// Refuses mappings of variants or materials that do not exist, whichever variant is shown.
void CheckMappings(const GltfDocument& document) {
  const gltf::Model& model = document.model;
  for (size_t m = 0; m < model.meshes.size(); ++m) {
    for (size_t p = 0; p < model.meshes[m].primitives.size(); ++p) {
      const std::vector<gltf::VariantMapping>& mappings = model.meshes[m].primitives[p].mappings;
      for (size_t i = 0; i < mappings.size(); ++i) {
        const std::string place = fmt::format(
            "/meshes/{}/primitives/{}/extensions/KHR_materials_variants/mappings/{}", m, p, i);
        document.At(model.materials, mappings[i].material, place + "/material",
                    fmt::format("there is no material {}", mappings[i].material));
        for (const int variant : mappings[i].variants) {
          document.At(model.variants, variant, place + "/variants",
                      fmt::format("there is no variant {}", variant));
        }
      }
    }
  }
}

std::string VariantInQuotes(const std::string& name) {
  return fmt::format("\"{}\"", Excerpt(Printable(name), 40));
}

// The variant of this name. If none is asked for, tells which there are.
std::optional<int> FindVariant(const std::optional<std::string>& name, GltfDocument* document) {
  const std::vector<gltf::Variant>& variants = document->model.variants;
  const auto names = [&] {
    constexpr size_t kMost = 8;
    std::string all;
    for (size_t i = 0; i < std::min(variants.size(), kMost); ++i) {
      all += (i == 0 ? "" : ", ") + VariantInQuotes(variants[i].name);
    }
    if (variants.size() > kMost) all += fmt::format(" and {} more", variants.size() - kMost);
    return all;
  };
  if (!name) {
    if (!variants.empty()) {
      document->Warn(
          "its materials have variants, and it is shown without one; --variant names "
          "one: " +
          names());
    }
    return std::nullopt;
  }
  const auto found = std::ranges::find(variants, *name, &gltf::Variant::name);
  if (found == variants.end()) {
    throw Error(ExitCode::kUsage, "--variant",
                fmt::format("{} has no variant {}", document->file, VariantInQuotes(*name)),
                variants.empty() ? "it has none" : "one of " + names());
  }
  if (std::ranges::count(variants, *name, &gltf::Variant::name) > 1) {
    document->Warn(
        fmt::format("several variants are called {}: the first is shown", VariantInQuotes(*name)));
  }
  return static_cast<int>(found - variants.begin());
}

}  // namespace

void GltfDocument::Refuse(const std::string& pointer, std::string what, std::string hint) const {
  throw Error(ExitCode::kBadInput, PlaceInFile(file, pointer), std::move(what), std::move(hint));
}

void GltfDocument::RefuseExtension(const std::string& pointer, const std::string& name) const {
  Refuse(pointer + "/extensions/" + PointerToken(name),
         fmt::format("the extension {} alone has its data and is not known here", Excerpt(name)),
         "export the model without it");
}

std::filesystem::path GltfDocument::Resolve(const std::string& uri,
                                            const std::string& pointer) const {
  // Some exporters write file names unencoded, with a % that is part of the name.
  std::string name = PercentDecoded(uri);
  std::error_code ignored;
  if (name != uri && !std::filesystem::exists(folder / name, ignored) &&
      std::filesystem::exists(folder / uri, ignored)) {
    name = uri;
  }
  try {
    return ResolveReference(folder, name, references);
  } catch (const Error& error) {
    const Fault& fault = error.faults().front();
    const bool is_url = uri.find("://") != std::string::npos;
    Refuse(pointer, fault.what, is_url ? "only files are read, no URLs" : fault.hint);
  }
}

GltfDocument ReadGltfDocument(const std::filesystem::path& path, const LoadOptions& options) {
  GltfDocument document;
  document.file = path.string();
  document.folder = path.parent_path();
  document.references = {options.allow_paths, options.on_file};
  document.on_warning = options.on_warning;
  document.threads = options.threads;
  std::string bytes = ReadBytes(path, kMaxBytes, [&](std::string_view head, uint64_t size) {
    return JudgeHead(head, size, document.file);
  });
  document.bytes = bytes.size();
  const BinaryFile chunks =
      IsBinary(bytes) ? ChunksOf(bytes, document.file) : BinaryFile{bytes, {}};
  FaultList faults;
  document.root = ParseJson(chunks.json, document.file, &faults, options.on_progress);
  RefuseOldVersion(document);
  document.model = gltf::ReadModel(document.root, &faults);
  ThrowFaults(faults, document.file);
  CheckVersionAndExtensions(&document);
  CheckMappings(document);
  document.variant = FindVariant(options.variant, &document);
  std::shared_ptr<const std::string> binary_chunk;
  if (chunks.data) {
    binary_chunk = std::make_shared<const std::string>(Keep(*chunks.data, std::move(bytes)));
  }
  ReadBuffers(binary_chunk, &document);
  return document;
}

}  // namespace nacre
