// SPDX-License-Identifier: Apache-2.0
// scene_io/gltf_model.h: the parts of a glTF 2.0 document that nacre shows, as plain structs. The
// members have the names, units and defaults of the specification; an index below 0 means none.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "scene/fault_list.h"
#include "scene_io/json_text.h"

namespace nacre::gltf {

// Values of primitive.mode.
enum Mode : int { kPoints = 0, kTriangles = 4, kTriangleStrip = 5, kTriangleFan = 6 };

// Values of a sampler's filters and wrap modes that differ from the defaults.
inline constexpr int kNearest = 9728, kLinear = 9729;
inline constexpr int kClampToEdge = 33071, kMirroredRepeat = 33648;

// The member "extensions" of an object in the document's JSON tree; null if it has none.
using Extensions = const Json*;
// The extension with this name, or null.
const Json* FindExtension(Extensions extensions, const char* name);

struct Buffer {
  uint64_t byteLength = 0;
  std::shared_ptr<const std::string> data;  // at least byteLength bytes; null: a buffer without
                                            // data
};

struct BufferView {
  int buffer = -1;
  uint64_t byteOffset = 0, byteLength = 0, byteStride = 0;
  Extensions extensions = nullptr;
};

struct SparseIndices {
  int bufferView = -1;
  uint64_t byteOffset = 0;
  int componentType = 0;
};

struct SparseValues {
  int bufferView = -1;
  uint64_t byteOffset = 0;
};

struct Sparse {
  int count = 0;
  SparseIndices indices;
  SparseValues values;
};

struct Accessor {
  int bufferView = -1;
  uint64_t byteOffset = 0, count = 0;
  int componentType = 0;
  std::string type;  // "SCALAR", "VEC2", ...
  bool normalized = false;
  std::optional<Sparse> sparse;
};

// KHR_materials_variants: what a primitive has in some variants of the file's materials.
struct Variant {
  std::string name;
};
struct VariantMapping {
  std::vector<int> variants;
  int material = -1;
};

struct Primitive {
  std::map<std::string, int> attributes;  // accessors by name
  int indices = -1, material = -1, mode = kTriangles;
  const Json* targets = nullptr;  // morph targets, of any form
  Extensions extensions = nullptr;
  std::vector<VariantMapping> mappings;
};

// The accessor of an attribute; below 0 if the primitive does not have it.
inline int AttributeOf(const Primitive& primitive, const std::string& name) {
  const auto found = primitive.attributes.find(name);
  return found == primitive.attributes.end() ? -1 : found->second;
}

struct Mesh {
  std::vector<Primitive> primitives;
};

struct Node {
  std::string name;
  int camera = -1, mesh = -1, skin = -1;
  std::vector<int> children;
  std::vector<double> matrix, rotation, scale, translation;  // empty: not given
  Extensions extensions = nullptr;
};

struct Image {
  std::string uri;  // as it is written; may be a data URI
  int bufferView = -1;
};

struct Texture {
  int sampler = -1, source = -1;  // that of EXT_texture_webp, if there is one
  Extensions extensions = nullptr;
};

struct Sampler {
  int magFilter = -1, minFilter = -1, wrapS = -1, wrapT = -1;
};

struct TextureInfo {
  int index = -1, texCoord = 0;
  double scale = 1;  // for normal textures
  Extensions extensions = nullptr;
};

struct PbrMetallicRoughness {
  std::vector<double> baseColorFactor = {1, 1, 1, 1};
  double metallicFactor = 1, roughnessFactor = 1;
  TextureInfo baseColorTexture, metallicRoughnessTexture;
};

struct Material {
  std::string name;
  PbrMetallicRoughness pbrMetallicRoughness;
  TextureInfo normalTexture, occlusionTexture, emissiveTexture;
  std::vector<double> emissiveFactor = {0, 0, 0};
  std::string alphaMode = "OPAQUE";
  double alphaCutoff = 0.5;
  bool doubleSided = false;
  Extensions extensions = nullptr;
};

struct Camera {
  struct Perspective {
    double yfov = 0;  // radians
  };
  struct Orthographic {
    double ymag = 0;  // half the view's height
  };
  std::string type;  // "perspective" or "orthographic"
  Perspective perspective;
  Orthographic orthographic;
};

// KHR_lights_punctual.
struct Light {
  struct Spot {
    double innerConeAngle = 0, outerConeAngle = 0.78539816339744830962;  // radians
  };
  std::string name, type;
  std::vector<double> color = {1, 1, 1};
  double intensity = 1;
  double range = 0;  // 0: unlimited
  Spot spot;
};

struct Skin {
  std::vector<int> joints;  // indices of nodes
  int inverseBindMatrices = -1;
};

struct Scene {
  std::vector<int> nodes;
};

struct Asset {
  std::string version, minVersion;  // minVersion may be empty
};

struct Model {
  Asset asset;
  std::vector<std::string> extensionsUsed, extensionsRequired;
  int scene = -1;                    // the default scene
  const Json* animations = nullptr;  // of any form
  Extensions extensions = nullptr;
  std::vector<Scene> scenes;
  std::vector<Node> nodes;
  std::vector<Mesh> meshes;
  std::vector<Accessor> accessors;
  std::vector<BufferView> bufferViews;
  std::vector<Buffer> buffers;  // their data is not loaded yet
  std::vector<Image> images;
  std::vector<Texture> textures;
  std::vector<Sampler> samplers;
  std::vector<Material> materials;
  std::vector<Camera> cameras;
  std::vector<Light> lights;
  std::vector<Variant> variants;
  std::vector<Skin> skins;
};

// The textures of extensions of materials.
struct ExtensionTexture {
  const char* extension;
  const char* member;
};
inline constexpr std::array kExtensionTextures = {
    ExtensionTexture{"KHR_materials_anisotropy", "anisotropyTexture"},
    ExtensionTexture{"KHR_materials_clearcoat", "clearcoatTexture"},
    ExtensionTexture{"KHR_materials_clearcoat", "clearcoatRoughnessTexture"},
    ExtensionTexture{"KHR_materials_clearcoat", "clearcoatNormalTexture"},
    ExtensionTexture{"KHR_materials_pbrSpecularGlossiness", "diffuseTexture"},
    ExtensionTexture{"KHR_materials_pbrSpecularGlossiness", "specularGlossinessTexture"},
    ExtensionTexture{"KHR_materials_sheen", "sheenColorTexture"},
    ExtensionTexture{"KHR_materials_sheen", "sheenRoughnessTexture"},
    ExtensionTexture{"KHR_materials_specular", "specularTexture"},
    ExtensionTexture{"KHR_materials_specular", "specularColorTexture"}};

// The item with this index, or null if there is none.
template <class Item>
const Item* ItemAt(const std::vector<Item>& items, int index) {
  const bool exists = index >= 0 && static_cast<size_t>(index) < items.size();
  return exists ? &items[static_cast<size_t>(index)] : nullptr;
}

// Converts `root` to structs, which point to the extensions in it, so `root` must outlive them.
// Adds a fault for each member that nacre reads and that violates its type in glTF 2.0 (negative
// offsets, indices that are not whole numbers and arrays of a wrong length included), and for each
// required member that is missing. A whole number may be written as 3.0 or 3e0. What is not read
// (extras, unknown extensions, most of animations) may be anything.
Model ReadModel(const Json& root, FaultList* faults);

}  // namespace nacre::gltf
