// SPDX-License-Identifier: Apache-2.0
// scene_io/gltf_model.h: the parts of a glTF 2.0 document that nacre shows, as plain structs. The
// members have the names, units and defaults of the specification; an index below 0 means none.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "scene_io/json_text.h"

namespace nacre::gltf {

// Values of accessor.componentType.
enum ComponentType : int {
  kByte = 5120,
  kUnsignedByte = 5121,
  kShort = 5122,
  kUnsignedShort = 5123,
  kUnsignedInt = 5125,
  kFloat = 5126,
};

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

struct Accessor {
  struct Indices {
    int bufferView = -1;
    uint64_t byteOffset = 0;
    int componentType = 0;
  };
  struct Values {
    int bufferView = -1;
    uint64_t byteOffset = 0;
  };
  struct Sparse {
    uint64_t count = 0;  // 0: the accessor is not sparse
    Indices indices;
    Values values;
  };
  int bufferView = -1;
  uint64_t byteOffset = 0, count = 0;
  int componentType = 0;
  std::string type;  // "SCALAR", "VEC2", ...
  bool normalized = false;
  bool isSparse = false;
  Sparse sparse;
};

struct Primitive {
  std::map<std::string, int> attributes;  // accessors by name
  int indices = -1, material = -1, mode = kTriangles;
  bool hasTargets = false;  // morph targets
  Extensions extensions = nullptr;
};

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
  int sampler = -1, source = -1;
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
  std::string type;  // "perspective" or "orthographic"
  double yfov = 0;   // for perspective cameras: radians
  double ymag = 0;   // for orthographic cameras: half the view's height
};

// KHR_lights_punctual.
struct Light {
  std::string name, type;
  std::vector<double> color = {1, 1, 1};
  double intensity = 1;
  double range = 0;                                                    // 0: unlimited
  double innerConeAngle = 0, outerConeAngle = 0.78539816339744830962;  // for spot lights: radians
};

struct Skin {
  std::vector<int> joints;  // indices of nodes
  int inverseBindMatrices = -1;
};

struct Scene {
  std::vector<int> nodes;
};

struct Model {
  std::string version, minVersion;  // from "asset"; minVersion may be empty
  std::vector<std::string> extensionsUsed, extensionsRequired;
  int scene = -1;  // the default scene
  bool hasAnimations = false;
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
  std::vector<Skin> skins;
};

// Converts `root`, which must have passed CheckGltfTypes (gltf_types.h), to structs. They point to
// the extensions in it, so `root` must outlive them.
Model ReadModel(const Json& root);

}  // namespace nacre::gltf
