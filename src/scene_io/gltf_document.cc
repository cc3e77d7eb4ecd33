// SPDX-License-Identifier: Apache-2.0
#include "scene_io/gltf_document.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <new>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "base/error.h"
#include "scene_io/gltf_types.h"
#include "scene_io/text_file.h"

namespace nacre {
namespace {

constexpr uint64_t kMaxBytes = 0xffffffffu;  // the length in a GLB header

// All that are understood, at least in part, or that change nothing that is shown here. The last
// one is for images, which are warned of on their own.
constexpr std::array<std::string_view, 9> kKnownExtensions = {
    "KHR_lights_punctual",    "KHR_materials_emissive_strength",
    "KHR_materials_ior",      "KHR_materials_pbrSpecularGlossiness",
    "KHR_materials_specular", "KHR_materials_unlit",
    "KHR_mesh_quantization",  "KHR_xmp_json_ld",
    "KHR_texture_transform"};

bool IsKnown(const std::string& extension) {
  return std::find(kKnownExtensions.begin(), kKnownExtensions.end(), extension) !=
         kKnownExtensions.end();
}

uint32_t Word(const std::string& bytes, size_t offset) {
  std::array<unsigned char, 4> b;
  std::memcpy(b.data(), bytes.data() + offset, 4);
  return b[0] | uint32_t{b[1]} << 8 | uint32_t{b[2]} << 16 | uint32_t{b[3]} << 24;
}

// The JSON text of a binary file; tinygltf reads up to 8 bytes beyond a chunk that ends too late.
std::string_view JsonOfBinary(const std::string& bytes, const std::string& file) {
  constexpr uint32_t kJson = 0x4e4f534a;
  constexpr size_t kHeader = 12, kChunkHeader = 8;
  const auto refuse = [&](std::string what) {
    throw Error(ExitCode::kBadInput, file, std::move(what), "the file is damaged or incomplete");
  };
  if (bytes.size() < kHeader + kChunkHeader) refuse("is too short for a binary glTF file");
  if (Word(bytes, 4) != 2) {
    throw Error(ExitCode::kBadInput, file, fmt::format("is glTF {}", Word(bytes, 4)),
                "this program reads glTF 2.0");
  }
  const uint64_t length = Word(bytes, 8);
  if (length > bytes.size()) {
    refuse(fmt::format("has {} bytes, and says that it has {}", bytes.size(), length));
  }
  for (uint64_t offset = kHeader; offset < length;) {
    if (length - offset < kChunkHeader || length - offset - kChunkHeader < Word(bytes, offset)) {
      refuse(fmt::format("the chunk at byte {} is longer than the file", offset));
    }
    offset += kChunkHeader + Word(bytes, offset);
  }
  if (length < kHeader + kChunkHeader || Word(bytes, kHeader + 4) != kJson) {
    refuse("its first chunk is not JSON");
  }
  return std::string_view(bytes).substr(kHeader + kChunkHeader, Word(bytes, kHeader));
}

// What tinygltf's callbacks are given: external buffers are read in the order of the file.
struct Files {
  const GltfDocument* document;
  std::vector<uint64_t> lengths;  // of the external buffers
  size_t next = 0;
};

std::vector<uint64_t> ExternalLengths(const Json& root) {
  std::vector<uint64_t> lengths;
  for (const Json& buffer : root.value("buffers", Json::array())) {
    const std::string uri = buffer.value("uri", std::string());
    if (!uri.empty() && !uri.starts_with("data:")) {
      lengths.push_back(buffer.value("byteLength", uint64_t{0}));
    }
  }
  return lengths;
}

bool ReadBuffer(std::vector<unsigned char>* out, std::string*, const std::string& name,
                void* user_data) {
  Files& files = *static_cast<Files*>(user_data);
  const GltfDocument& document = *files.document;
  std::filesystem::path path;
  try {
    path = ResolveReference(document.folder, name, document.references);
  } catch (const Error& error) {
    const Fault& fault = error.faults().front();
    const bool is_url = name.find("://") != std::string::npos;
    document.Refuse("/buffers", fault.what, is_url ? "only files are read, no URLs" : fault.hint);
  }
  const uint64_t length = files.next < files.lengths.size() ? files.lengths[files.next++] : 0;
  const std::string bytes = ReadTextFile(path, kMaxBytes);
  if (bytes.size() < length) {
    document.Refuse("/buffers",
                    fmt::format("\"{}\" has {} bytes, not {}", name, bytes.size(), length));
  }
  // It may be longer; tinygltf would have it exact.
  out->assign(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(length));
  return true;
}

// Keeps encoded bytes. Of an image in a buffer view, which tinygltf has not checked, it touches
// nothing.
bool KeepImage(tinygltf::Image* image, const int, std::string*, std::string*, int, int,
               const unsigned char* bytes, int size, void*) {
  image->as_is = true;
  if (image->bufferView < 0 && size > 0) image->image.assign(bytes, bytes + size);
  return true;
}

// tinygltf forms a pointer to an image in a buffer view before anybody has looked at its offset.
void CheckImageOffsets(const Json& root, const GltfDocument& document) {
  const auto element = [&](const char* array, uint64_t index) {
    const auto found = root.find(array);
    return found != root.end() && index < found->size() ? (*found)[index] : Json::object();
  };
  const Json images = root.value("images", Json::array());
  for (size_t i = 0; i < images.size(); ++i) {
    if (!images[i].contains("bufferView")) continue;
    const Json view = element("bufferViews", images[i]["bufferView"].get<uint64_t>());
    const Json buffer = element("buffers", view.value("buffer", uint64_t{0}));
    if (view.value("byteOffset", uint64_t{0}) > buffer.value("byteLength", uint64_t{0})) {
      document.Refuse(fmt::format("/images/{}", i), "reaches beyond its buffer");
    }
  }
}

std::string FirstLine(const std::string& text) { return text.substr(0, text.find('\n')); }

// All file access of tinygltf. A template, because newer ones ask for sizes, too, of files that
// they leave to their reader otherwise; ReadBuffer judges sizes itself.
template <class Callbacks>
Callbacks MakeCallbacks(Files* files, Callbacks callbacks) {
  callbacks.FileExists = [](const std::string&, void*) { return true; };
  callbacks.ExpandFilePath = [](const std::string& name, void*) { return name; };
  callbacks.ReadWholeFile = &ReadBuffer;
  callbacks.WriteWholeFile = [](std::string*, const std::string&, const std::vector<unsigned char>&,
                                void*) { return false; };
  if constexpr (requires { callbacks.GetFileSizeInBytes; }) {
    callbacks.GetFileSizeInBytes = [](size_t* size, std::string*, const std::string&, void*) {
      *size = 1;  // within any limit
      return true;
    };
  }
  callbacks.user_data = files;
  return callbacks;
}

void Parse(const std::string& bytes, bool is_binary, const Json& root, GltfDocument* document) {
  Files files{document, ExternalLengths(root)};
  tinygltf::TinyGLTF loader;
  loader.SetImageLoader(&KeepImage, nullptr);
  loader.SetFsCallbacks(MakeCallbacks(&files, tinygltf::FsCallbacks{}));
  std::string error, warning;
  const auto length = static_cast<unsigned int>(bytes.size());
  bool is_read = false;
  try {
    is_read = is_binary ? loader.LoadBinaryFromMemory(
                              &document->model, &error, &warning,
                              reinterpret_cast<const unsigned char*>(bytes.data()), length)
                        : loader.LoadASCIIFromString(&document->model, &error, &warning,
                                                     bytes.data(), length, {});
  } catch (const Error&) {
    throw;
  } catch (const std::bad_alloc&) {
    error = "there is no memory for it";
  } catch (const std::exception& e) {
    error = e.what();
  }
  if (is_read && error.empty()) return;
  document->Refuse({}, error.empty() ? "is not a glTF file" : FirstLine(error));
}

void CheckVersionAndExtensions(GltfDocument* document) {
  const tinygltf::Model& model = document->model;
  if (!model.asset.version.starts_with("2.")) {
    document->Refuse("/asset/version", fmt::format("glTF {}", model.asset.version),
                     "this program reads glTF 2.0");
  }
  for (const std::string& extension : model.extensionsRequired) {
    if (IsKnown(extension)) continue;
    document->Refuse("/extensionsRequired",
                     fmt::format("the extension {} is required and not known here", extension),
                     "export the model without it");
  }
  for (const std::string& extension : model.extensionsUsed) {
    if (!IsKnown(extension)) {
      document->Warn(fmt::format("the extension {} is not known here and left out", extension));
    }
  }
}

}  // namespace

void GltfDocument::Warn(const std::string& text) {
  if (warned.insert(text).second && on_warning) on_warning(file + ": " + text);
}

void GltfDocument::Refuse(const std::string& pointer, std::string what, std::string hint) const {
  throw Error(ExitCode::kBadInput, PlaceInFile(file, pointer), std::move(what), std::move(hint));
}

GltfDocument ReadGltfDocument(const std::filesystem::path& path, const LoadOptions& options) {
  GltfDocument document;
  document.file = path.string();
  document.folder = path.parent_path();
  document.references = {options.allow_paths, options.on_file};
  document.on_warning = options.on_warning;
  const std::string bytes = ReadTextFile(path, kMaxBytes);
  const bool is_binary = bytes.starts_with("glTF");
  const std::string_view text = is_binary ? JsonOfBinary(bytes, document.file) : bytes;
  FaultList faults;
  const Json root = ParseJson(text, document.file, &faults, options.on_progress);
  CheckGltfTypes(root, &faults);
  if (faults.count() > 0) {
    std::vector<Fault> all = faults.All();
    for (Fault& fault : all) fault.where = PlaceInFile(document.file, fault.where);
    throw Error(ExitCode::kBadInput, std::move(all));
  }
  CheckImageOffsets(root, document);
  Parse(bytes, is_binary, root, &document);
  CheckVersionAndExtensions(&document);
  return document;
}

}  // namespace nacre
