// SPDX-License-Identifier: Apache-2.0
#include "scene_io/gltf_types.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string_view>

#include <fmt/format.h>

#include "scene_io/scene_budget.h"

namespace nacre {
namespace {

enum class Kind : uint8_t {
  kIndex,  // a whole number that fits an int
  kSize,   // a whole number of bytes or elements
  kNumber,
  kText,
  kBoolean,
  kIndices,  // an array of kIndex
  kTexts,    // an array of kText
  kNumbers,  // an array of `length` numbers
  kObject,   // whose members are in the table
  kObjects,  // an array of such objects
  kTexture,  // an object whose members are in the table under kTextureInfo
};

// The table's name for the texture infos of materials and their extensions.
constexpr std::string_view kTextureInfo = "textureInfo";

struct Member {
  // The names on the path to the object, without array indices. In an extension, the path starts
  // with the extension's name.
  std::string_view object;
  std::string_view name;  // empty: any name
  Kind kind;
  size_t length = 0;  // for kNumbers; for kObjects, the maximum, 0: the default of MostOf
  bool is_required = false;
};

constexpr Member Required(std::string_view object, std::string_view name, Kind kind) {
  return {object, name, kind, 0, true};
}

constexpr std::array kMembers = {
    Required("", "asset", Kind::kObject),
    Member{"", "scene", Kind::kIndex},
    Member{"", "extensionsUsed", Kind::kTexts},
    Member{"", "extensionsRequired", Kind::kTexts},
    Member{"", "accessors", Kind::kObjects},
    Member{"", "buffers", Kind::kObjects},
    Member{"", "bufferViews", Kind::kObjects},
    Member{"", "cameras", Kind::kObjects},
    Member{"", "images", Kind::kObjects},
    Member{"", "materials", Kind::kObjects, kMaxModelMaterials},
    Member{"", "meshes", Kind::kObjects},
    Member{"", "nodes", Kind::kObjects},
    Member{"", "samplers", Kind::kObjects},
    Member{"", "scenes", Kind::kObjects},
    Member{"", "skins", Kind::kObjects},
    Member{"", "textures", Kind::kObjects},
    Required("asset", "version", Kind::kText),
    Member{"asset", "minVersion", Kind::kText},
    Member{"accessors", "bufferView", Kind::kIndex},
    Member{"accessors", "byteOffset", Kind::kSize},
    Required("accessors", "componentType", Kind::kIndex),
    Member{"accessors", "normalized", Kind::kBoolean},
    Required("accessors", "count", Kind::kSize),
    Required("accessors", "type", Kind::kText),
    Member{"accessors", "sparse", Kind::kObject},
    Required("accessors/sparse", "count", Kind::kIndex),
    Required("accessors/sparse", "indices", Kind::kObject),
    Required("accessors/sparse", "values", Kind::kObject),
    Required("accessors/sparse/indices", "bufferView", Kind::kIndex),
    Member{"accessors/sparse/indices", "byteOffset", Kind::kSize},
    Required("accessors/sparse/indices", "componentType", Kind::kIndex),
    Required("accessors/sparse/values", "bufferView", Kind::kIndex),
    Member{"accessors/sparse/values", "byteOffset", Kind::kSize},
    Member{"buffers", "uri", Kind::kText},
    Required("buffers", "byteLength", Kind::kSize),
    Required("bufferViews", "buffer", Kind::kIndex),
    Member{"bufferViews", "byteOffset", Kind::kSize},
    Required("bufferViews", "byteLength", Kind::kSize),
    Member{"bufferViews", "byteStride", Kind::kSize},
    Required("cameras", "type", Kind::kText),
    Member{"cameras", "perspective", Kind::kObject},
    Member{"cameras", "orthographic", Kind::kObject},
    Required("cameras/perspective", "yfov", Kind::kNumber),
    Member{"cameras/perspective", "aspectRatio", Kind::kNumber},
    Member{"cameras/perspective", "znear", Kind::kNumber},
    Member{"cameras/perspective", "zfar", Kind::kNumber},
    Member{"cameras/orthographic", "xmag", Kind::kNumber},
    Required("cameras/orthographic", "ymag", Kind::kNumber),
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
    Member{"materials", "emissiveTexture", Kind::kTexture},
    Member{"materials", "normalTexture", Kind::kTexture},
    Member{"materials", "occlusionTexture", Kind::kTexture},
    Member{"materials/pbrMetallicRoughness", "baseColorFactor", Kind::kNumbers, 4},
    Member{"materials/pbrMetallicRoughness", "metallicFactor", Kind::kNumber},
    Member{"materials/pbrMetallicRoughness", "roughnessFactor", Kind::kNumber},
    Member{"materials/pbrMetallicRoughness", "baseColorTexture", Kind::kTexture},
    Member{"materials/pbrMetallicRoughness", "metallicRoughnessTexture", Kind::kTexture},
    Member{"meshes", "name", Kind::kText},
    Required("meshes", "primitives", Kind::kObjects),
    Required("meshes/primitives", "attributes", Kind::kObject),
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
    Member{"samplers", "magFilter", Kind::kIndex},
    Member{"samplers", "minFilter", Kind::kIndex},
    Member{"samplers", "wrapS", Kind::kIndex},
    Member{"samplers", "wrapT", Kind::kIndex},
    Member{"scenes", "nodes", Kind::kIndices},
    Required("skins", "joints", Kind::kIndices),
    Member{"skins", "inverseBindMatrices", Kind::kIndex},
    Member{"textures", "sampler", Kind::kIndex},
    Member{"textures", "source", Kind::kIndex},
    Member{"KHR_lights_punctual", "light", Kind::kIndex},
    Member{"KHR_lights_punctual", "lights", Kind::kObjects},
    Member{"KHR_lights_punctual/lights", "name", Kind::kText},
    Required("KHR_lights_punctual/lights", "type", Kind::kText),
    Member{"KHR_lights_punctual/lights", "color", Kind::kNumbers, 3},
    Member{"KHR_lights_punctual/lights", "intensity", Kind::kNumber},
    Member{"KHR_lights_punctual/lights", "range", Kind::kNumber},
    Member{"KHR_lights_punctual/lights", "spot", Kind::kObject},
    Member{"KHR_lights_punctual/lights/spot", "innerConeAngle", Kind::kNumber},
    Member{"KHR_lights_punctual/lights/spot", "outerConeAngle", Kind::kNumber},
    Member{"KHR_materials_clearcoat", "clearcoatTexture", Kind::kTexture},
    Member{"KHR_materials_clearcoat", "clearcoatRoughnessTexture", Kind::kTexture},
    Member{"KHR_materials_clearcoat", "clearcoatNormalTexture", Kind::kTexture},
    Member{"KHR_materials_pbrSpecularGlossiness", "diffuseTexture", Kind::kTexture},
    Member{"KHR_materials_pbrSpecularGlossiness", "specularGlossinessTexture", Kind::kTexture},
    Member{"KHR_materials_sheen", "sheenColorTexture", Kind::kTexture},
    Member{"KHR_materials_sheen", "sheenRoughnessTexture", Kind::kTexture},
    Member{"KHR_materials_specular", "specularTexture", Kind::kTexture},
    Member{"KHR_materials_specular", "specularColorTexture", Kind::kTexture},
    Required(kTextureInfo, "index", Kind::kIndex),
    Member{kTextureInfo, "texCoord", Kind::kIndex},
    Member{kTextureInfo, "scale", Kind::kNumber},
    Member{"KHR_texture_transform", "offset", Kind::kNumbers, 2},
    Member{"KHR_texture_transform", "scale", Kind::kNumbers, 2},
    Member{"KHR_texture_transform", "rotation", Kind::kNumber},
    Member{"KHR_texture_transform", "texCoord", Kind::kIndex},
};

// JSON has only one type of number: 3.0 and 3e0 are as whole as 3, and are converted to it.
bool IsWhole(Json* json, double max) {
  if (!json->is_number()) return false;
  const auto number = json->get<double>();
  if (!(number >= 0) || number > max || number != std::floor(number)) return false;
  if (!json->is_number_integer()) *json = static_cast<uint64_t>(number);
  return true;
}

bool IsIndex(Json* json) { return IsWhole(json, 0x7fffffff); }

bool AllOf(Json* json, bool (*is_right)(Json*)) {
  return json->is_array() &&
         std::all_of(json->begin(), json->end(), [&](Json& element) { return is_right(&element); });
}

// Upper bound on the number of objects in an array: "{}," takes three bytes of text, and becomes a
// struct of up to a kilobyte.
size_t MostOf(const Member& member) {
  constexpr size_t kMostObjects = size_t{1} << 20;
  return member.length > 0 ? member.length : kMostObjects;
}

bool HasKind(const Member& member, Json* json) {
  switch (member.kind) {
    case Kind::kIndex:
      return IsIndex(json);
    case Kind::kSize:
      return IsWhole(json, 0x1p53);
    case Kind::kNumber:
      return json->is_number();
    case Kind::kText:
      return json->is_string();
    case Kind::kBoolean:
      return json->is_boolean();
    case Kind::kIndices:
      return AllOf(json, &IsIndex);
    case Kind::kTexts:
      return AllOf(json, [](Json* element) { return element->is_string(); });
    case Kind::kNumbers:
      return json->size() == member.length &&
             AllOf(json, [](Json* element) { return element->is_number(); });
    case Kind::kObject:
    case Kind::kTexture:
      return json->is_object();
    case Kind::kObjects:
      return json->size() <= MostOf(member) &&
             AllOf(json, [](Json* element) { return element->is_object(); });
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
    case Kind::kTexture:
      return "an object";
    case Kind::kObjects:
      return fmt::format("an array of objects, {} at most", MostOf(member));
  }
  return {};
}

const Member* FindMember(std::string_view object, std::string_view name) {
  for (const Member& member : kMembers) {
    if (member.object == object && (member.name == name || member.name.empty())) return &member;
  }
  return nullptr;
}

void CheckObject(const std::string& pointer, const std::string& place, Json* object,
                 FaultList* faults);

// Extensions that are not in the table are only checked to be objects; their members are checked
// where they are used (GltfExtension).
void CheckExtensions(const std::string& pointer, Json* extensions, FaultList* faults) {
  if (!extensions->is_object()) {
    faults->Add(pointer, "is not an object");
    return;
  }
  for (auto& [name, json] : extensions->items()) {
    const std::string where = pointer + "/" + PointerToken(name);
    if (json.is_object()) {
      CheckObject(where, name, &json, faults);
    } else {
      faults->Add(where, "is not an object");
    }
  }
}

// Checks the members of `object`, which is at `pointer` in the file and under `place` in the table.
void CheckObject(const std::string& pointer, const std::string& place, Json* object,
                 FaultList* faults) {
  for (auto& [name, json] : object->items()) {
    const std::string where = pointer + "/" + PointerToken(name);
    if (name == "extensions") {
      CheckExtensions(where, &json, faults);
      continue;
    }
    const Member* const member = FindMember(place, name);
    if (member == nullptr) continue;
    if (!HasKind(*member, &json)) {
      faults->Add(where, "is not " + Describe(*member));
      continue;
    }
    const bool is_texture = member->kind == Kind::kTexture;
    const std::string inner = is_texture      ? std::string(kTextureInfo)
                              : place.empty() ? name
                                              : place + "/" + name;
    if (member->kind == Kind::kObject || is_texture) CheckObject(where, inner, &json, faults);
    if (member->kind != Kind::kObjects) continue;
    for (size_t i = 0; i < json.size(); ++i) {
      CheckObject(fmt::format("{}/{}", where, i), inner, &json[i], faults);
    }
  }
  for (const Member& member : kMembers) {
    if (member.is_required && member.object == place && !object->contains(member.name)) {
      faults->Add(pointer, fmt::format("has no \"{}\"", member.name),
                  fmt::format("{} is required there", Describe(member)));
    }
  }
}

}  // namespace

void CheckGltfTypes(Json* root, FaultList* faults) {
  if (!root->is_object()) {
    faults->Add({}, "is not a glTF file", "a glTF file is a JSON object");
    return;
  }
  CheckObject({}, {}, root, faults);
}

}  // namespace nacre
