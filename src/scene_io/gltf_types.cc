// SPDX-License-Identifier: Apache-2.0
#include "scene_io/gltf_types.h"

#include <array>
#include <cstdint>
#include <string_view>

#include <fmt/format.h>

namespace nacre {
namespace {

enum class Kind : uint8_t {
  kIndex,  // a whole number that an int can hold
  kSize,   // a whole number of bytes or elements
  kNumber,
  kText,
  kBoolean,
  kIndices,  // an array of kIndex
  kTexts,    // an array of kText
  kNumbers,  // an array of `length` numbers
  kObject,   // of which the table has more
  kObjects,  // an array of such
};

struct Member {
  std::string_view object;  // where: the names on the way, arrays left out
  std::string_view name;    // empty: every one
  Kind kind;
  size_t length = 0;
};

constexpr std::array kMembers = {
    Member{"", "asset", Kind::kObject},
    Member{"", "scene", Kind::kIndex},
    Member{"", "extensionsUsed", Kind::kTexts},
    Member{"", "extensionsRequired", Kind::kTexts},
    Member{"", "accessors", Kind::kObjects},
    Member{"", "buffers", Kind::kObjects},
    Member{"", "bufferViews", Kind::kObjects},
    Member{"", "cameras", Kind::kObjects},
    Member{"", "images", Kind::kObjects},
    Member{"", "materials", Kind::kObjects},
    Member{"", "meshes", Kind::kObjects},
    Member{"", "nodes", Kind::kObjects},
    Member{"", "samplers", Kind::kObjects},
    Member{"", "scenes", Kind::kObjects},
    Member{"", "textures", Kind::kObjects},
    Member{"asset", "version", Kind::kText},
    Member{"accessors", "bufferView", Kind::kIndex},
    Member{"accessors", "byteOffset", Kind::kSize},
    Member{"accessors", "componentType", Kind::kIndex},
    Member{"accessors", "normalized", Kind::kBoolean},
    Member{"accessors", "count", Kind::kSize},
    Member{"accessors", "type", Kind::kText},
    Member{"accessors", "sparse", Kind::kObject},
    Member{"accessors/sparse", "count", Kind::kIndex},
    Member{"accessors/sparse", "indices", Kind::kObject},
    Member{"accessors/sparse", "values", Kind::kObject},
    Member{"accessors/sparse/indices", "bufferView", Kind::kIndex},
    Member{"accessors/sparse/indices", "byteOffset", Kind::kIndex},
    Member{"accessors/sparse/indices", "componentType", Kind::kIndex},
    Member{"accessors/sparse/values", "bufferView", Kind::kIndex},
    Member{"accessors/sparse/values", "byteOffset", Kind::kIndex},
    Member{"buffers", "uri", Kind::kText},
    Member{"buffers", "byteLength", Kind::kSize},
    Member{"bufferViews", "buffer", Kind::kIndex},
    Member{"bufferViews", "byteOffset", Kind::kSize},
    Member{"bufferViews", "byteLength", Kind::kSize},
    Member{"bufferViews", "byteStride", Kind::kSize},
    Member{"cameras", "type", Kind::kText},
    Member{"cameras", "perspective", Kind::kObject},
    Member{"cameras", "orthographic", Kind::kObject},
    Member{"cameras/perspective", "yfov", Kind::kNumber},
    Member{"cameras/perspective", "aspectRatio", Kind::kNumber},
    Member{"cameras/perspective", "znear", Kind::kNumber},
    Member{"cameras/perspective", "zfar", Kind::kNumber},
    Member{"cameras/orthographic", "xmag", Kind::kNumber},
    Member{"cameras/orthographic", "ymag", Kind::kNumber},
    Member{"cameras/orthographic", "znear", Kind::kNumber},
    Member{"cameras/orthographic", "zfar", Kind::kNumber},
    Member{"images", "uri", Kind::kText},
    Member{"images", "bufferView", Kind::kIndex},
    Member{"materials", "name", Kind::kText},
    Member{"materials", "pbrMetallicRoughness", Kind::kObject},
    Member{"materials", "emissiveFactor", Kind::kNumbers, 3},
    Member{"materials", "alphaMode", Kind::kText},
    Member{"materials", "alphaCutoff", Kind::kNumber},
    Member{"materials", "doubleSided", Kind::kBoolean},
    Member{"materials", "emissiveTexture", Kind::kObject},
    Member{"materials", "normalTexture", Kind::kObject},
    Member{"materials", "occlusionTexture", Kind::kObject},
    Member{"materials/emissiveTexture", "index", Kind::kIndex},
    Member{"materials/emissiveTexture", "texCoord", Kind::kIndex},
    Member{"materials/normalTexture", "index", Kind::kIndex},
    Member{"materials/normalTexture", "texCoord", Kind::kIndex},
    Member{"materials/normalTexture", "scale", Kind::kNumber},
    Member{"materials/occlusionTexture", "index", Kind::kIndex},
    Member{"materials/pbrMetallicRoughness", "baseColorFactor", Kind::kNumbers, 4},
    Member{"materials/pbrMetallicRoughness", "metallicFactor", Kind::kNumber},
    Member{"materials/pbrMetallicRoughness", "roughnessFactor", Kind::kNumber},
    Member{"materials/pbrMetallicRoughness", "baseColorTexture", Kind::kObject},
    Member{"materials/pbrMetallicRoughness", "metallicRoughnessTexture", Kind::kObject},
    Member{"materials/pbrMetallicRoughness/baseColorTexture", "index", Kind::kIndex},
    Member{"materials/pbrMetallicRoughness/baseColorTexture", "texCoord", Kind::kIndex},
    Member{"materials/pbrMetallicRoughness/metallicRoughnessTexture", "index", Kind::kIndex},
    Member{"materials/pbrMetallicRoughness/metallicRoughnessTexture", "texCoord", Kind::kIndex},
    Member{"meshes", "name", Kind::kText},
    Member{"meshes", "primitives", Kind::kObjects},
    Member{"meshes/primitives", "attributes", Kind::kObject},
    Member{"meshes/primitives/attributes", "", Kind::kIndex},
    Member{"meshes/primitives", "indices", Kind::kIndex},
    Member{"meshes/primitives", "material", Kind::kIndex},
    Member{"meshes/primitives", "mode", Kind::kIndex},
    Member{"nodes", "name", Kind::kText},
    Member{"nodes", "camera", Kind::kIndex},
    Member{"nodes", "mesh", Kind::kIndex},
    Member{"nodes", "skin", Kind::kIndex},
    Member{"nodes", "children", Kind::kIndices},
    Member{"nodes", "matrix", Kind::kNumbers, 16},
    Member{"nodes", "rotation", Kind::kNumbers, 4},
    Member{"nodes", "scale", Kind::kNumbers, 3},
    Member{"nodes", "translation", Kind::kNumbers, 3},
    Member{"scenes", "nodes", Kind::kIndices},
    Member{"textures", "sampler", Kind::kIndex},
    Member{"textures", "source", Kind::kIndex},
};

bool IsWhole(const Json& json, double max) {
  return json.is_number_integer() && json.get<double>() >= 0 && json.get<double>() <= max;
}

bool AllOf(const Json& json, bool (*is_right)(const Json&)) {
  if (!json.is_array()) return false;
  for (const Json& element : json) {
    if (!is_right(element)) return false;
  }
  return true;
}

bool IsIndex(const Json& json) { return IsWhole(json, 0x7fffffff); }

bool HasKind(const Json& json, const Member& member) {
  switch (member.kind) {
    case Kind::kIndex:
      return IsIndex(json);
    case Kind::kSize:
      return IsWhole(json, 0x1p53);
    case Kind::kNumber:
      return json.is_number();
    case Kind::kText:
      return json.is_string();
    case Kind::kBoolean:
      return json.is_boolean();
    case Kind::kIndices:
      return AllOf(json, &IsIndex);
    case Kind::kTexts:
      return AllOf(json, [](const Json& element) { return element.is_string(); });
    case Kind::kNumbers:
      return json.size() == member.length &&
             AllOf(json, [](const Json& element) { return element.is_number(); });
    case Kind::kObject:
      return json.is_object();
    case Kind::kObjects:
      return AllOf(json, [](const Json& element) { return element.is_object(); });
  }
  return false;
}

std::string Describe(const Member& member) {
  switch (member.kind) {
    case Kind::kIndex:
    case Kind::kSize:
      return "a whole number from 0 on";
    case Kind::kNumber:
      return "a number";
    case Kind::kText:
      return "a string";
    case Kind::kBoolean:
      return "true or false";
    case Kind::kIndices:
      return "an array of whole numbers from 0 on";
    case Kind::kTexts:
      return "an array of strings";
    case Kind::kNumbers:
      return fmt::format("an array of {} numbers", member.length);
    case Kind::kObject:
      return "an object";
    case Kind::kObjects:
      return "an array of objects";
  }
  return {};
}

const Member* FindMember(std::string_view object, std::string_view name) {
  for (const Member& member : kMembers) {
    if (member.object == object && (member.name == name || member.name.empty())) return &member;
  }
  return nullptr;
}

// They are read where they are used, as objects.
void CheckExtensions(const Json& extensions, const std::string& where, FaultList* faults) {
  if (!extensions.is_object()) {
    faults->Add(where, "is not an object");
    return;
  }
  for (const auto& [name, json] : extensions.items()) {
    if (!json.is_object()) faults->Add(where + "/" + PointerToken(name), "is not an object");
  }
}

// `object` is found at `pointer`; `place` is where that is in the table.
void CheckObject(const Json& object, const std::string& pointer, const std::string& place,
                 FaultList* faults) {
  for (const auto& [name, json] : object.items()) {
    const std::string where = pointer + "/" + PointerToken(name);
    if (name == "extensions") {
      CheckExtensions(json, where, faults);
      continue;
    }
    const Member* const member = FindMember(place, name);
    if (member == nullptr) continue;
    if (!HasKind(json, *member)) {
      faults->Add(where, "is not " + Describe(*member));
      continue;
    }
    const std::string inner = place.empty() ? name : place + "/" + name;
    if (member->kind == Kind::kObject) CheckObject(json, where, inner, faults);
    if (member->kind != Kind::kObjects) continue;
    for (size_t i = 0; i < json.size(); ++i) {
      CheckObject(json[i], fmt::format("{}/{}", where, i), inner, faults);
    }
  }
}

}  // namespace

void CheckGltfTypes(const Json& root, FaultList* faults) {
  if (!root.is_object()) {
    faults->Add({}, "is not a glTF file", "a glTF file is a JSON object");
    return;
  }
  CheckObject(root, {}, {}, faults);
}

}  // namespace nacre
