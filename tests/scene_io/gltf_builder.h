// SPDX-License-Identifier: Apache-2.0
// Small glTF files made in memory, to be changed and spoilt.
#pragma once

#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>
#include <unistd.h>

#include "base/error.h"
#include "scene_io/load_scene.h"

namespace nacre {

using Json = nlohmann::ordered_json;

// A folder of its own, gone at the end.
struct ModelFolder {
  std::filesystem::path path =
      std::filesystem::temp_directory_path() / ("nacre_models_" + std::to_string(getpid()));
  ModelFolder() { std::filesystem::create_directories(path); }
  ~ModelFolder() { std::filesystem::remove_all(path); }
  std::filesystem::path Write(const std::string& name, const std::string& bytes) const {
    std::ofstream(path / name, std::ios::binary) << bytes;
    return path / name;
  }
};

// A document and the bytes of its first buffer.
struct GltfFile {
  Json json;
  std::string bytes;

  template <typename T>
  size_t Append(const std::vector<T>& values) {
    bytes.resize((bytes.size() + 3) / 4 * 4);
    const size_t offset = bytes.size();
    bytes.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
    json["buffers"][0]["byteLength"] = bytes.size();
    return offset;
  }
  // The number of a new accessor with a buffer view of its own.
  template <typename T>
  int Accessor(const std::vector<T>& values, int component, const std::string& type,
               size_t components) {
    const size_t offset = Append(values);
    const size_t view = json["bufferViews"].size();
    json["bufferViews"].push_back(
        {{"buffer", 0}, {"byteOffset", offset}, {"byteLength", values.size() * sizeof(T)}});
    json["accessors"].push_back({{"bufferView", view},
                                 {"componentType", component},
                                 {"type", type},
                                 {"count", values.size() / components}});
    return static_cast<int>(json["accessors"].size()) - 1;
  }

  std::string Binary() const {
    const auto word = [](size_t value) {
      const auto number = static_cast<uint32_t>(value);
      return std::string{static_cast<char>(number), static_cast<char>(number >> 8),
                         static_cast<char>(number >> 16), static_cast<char>(number >> 24)};
    };
    std::string text = json.dump();
    text.resize((text.size() + 3) / 4 * 4, ' ');
    std::string data = bytes;
    data.resize((data.size() + 3) / 4 * 4);
    return "glTF" + word(2) + word(28 + text.size() + data.size()) + word(text.size()) + "JSON" +
           text + word(data.size()) + std::string("BIN\0", 4) + data;
  }
};

inline const std::vector<float> kSquare = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};

// A square of two triangles in the plane z = 0 that faces +z.
inline GltfFile MakeSquare() {
  GltfFile file;
  file.json = Json::parse(R"({"asset": {"version": "2.0"}, "scene": 0,
      "scenes": [{"nodes": [0]}], "nodes": [{"name": "square", "mesh": 0}], "materials": [],
      "meshes": [{"primitives": [{"attributes": {}}]}],
      "accessors": [], "bufferViews": [], "buffers": [{"byteLength": 0}]})");
  file.json["meshes"][0]["primitives"][0]["attributes"]["POSITION"] =
      file.Accessor(kSquare, 5126, "VEC3", 3);
  file.json["meshes"][0]["primitives"][0]["indices"] =
      file.Accessor(std::vector<uint16_t>{0, 1, 2, 0, 2, 3}, 5123, "SCALAR", 1);
  return file;
}

// The scene of such a file; warnings, if asked for.
inline Scene LoadFile(const GltfFile& file, std::vector<std::string>* warnings = nullptr) {
  const ModelFolder folder;
  LoadOptions options;
  options.on_warning = [&](const std::string& text) {
    if (warnings != nullptr) warnings->push_back(text);
  };
  return LoadScene(folder.Write("model.glb", file.Binary()), options);
}

}  // namespace nacre
