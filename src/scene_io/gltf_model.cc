// SPDX-License-Identifier: Apache-2.0
#include "scene_io/gltf_model.h"

#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "scene_io/scene_budget.h"

namespace nacre::gltf {
namespace {

// --- The members of each object, in the order in which missing ones are reported. A member has the
// type of the variable that it is read into. ---

constexpr bool kRequired = true;

// A member that is only checked.
template <class T>
constexpr T* kUnread = nullptr;

// An array of `length` numbers. `to` may be null.
struct Numbers {
  std::vector<double>* to;
  size_t length;
};

void ForEachMember(Asset* asset, const auto& use) {
  use("version", &asset->version, kRequired);
  use("minVersion", &asset->minVersion);
}

void ForEachMember(SparseIndices* indices, const auto& use) {
  use("bufferView", &indices->bufferView, kRequired);
  use("byteOffset", &indices->byteOffset);
  use("componentType", &indices->componentType, kRequired);
}

void ForEachMember(SparseValues* values, const auto& use) {
  use("bufferView", &values->bufferView, kRequired);
  use("byteOffset", &values->byteOffset);
}

void ForEachMember(Sparse* sparse, const auto& use) {
  use("count", &sparse->count, kRequired);
  use("indices", &sparse->indices, kRequired);
  use("values", &sparse->values, kRequired);
}

void ForEachMember(Accessor* accessor, const auto& use) {
  use("bufferView", &accessor->bufferView);
  use("byteOffset", &accessor->byteOffset);
  use("componentType", &accessor->componentType, kRequired);
  use("normalized", &accessor->normalized);
  use("count", &accessor->count, kRequired);
  use("type", &accessor->type, kRequired);
  use("sparse", &accessor->sparse);
}

void ForEachMember(Buffer* buffer, const auto& use) {
  use("uri", kUnread<std::string>);  // may be a data URI, which is long
  use("byteLength", &buffer->byteLength, kRequired);
}

void ForEachMember(BufferView* view, const auto& use) {
  use("buffer", &view->buffer, kRequired);
  use("byteOffset", &view->byteOffset);
  use("byteLength", &view->byteLength, kRequired);
  use("byteStride", &view->byteStride);
  use("extensions", &view->extensions);
}

void ForEachMember(Camera::Perspective* camera, const auto& use) {
  use("yfov", &camera->yfov, kRequired);
  for (const char* name : {"aspectRatio", "znear", "zfar"}) use(name, kUnread<double>);
}

void ForEachMember(Camera::Orthographic* camera, const auto& use) {
  use("ymag", &camera->ymag, kRequired);
  for (const char* name : {"xmag", "znear", "zfar"}) use(name, kUnread<double>);
}

void ForEachMember(Camera* camera, const auto& use) {
  use("type", &camera->type, kRequired);
  use("perspective", &camera->perspective);
  use("orthographic", &camera->orthographic);
}

void ForEachMember(Image* image, const auto& use) {
  use("uri", &image->uri);
  use("bufferView", &image->bufferView);
}

void ForEachMember(TextureInfo* info, const auto& use) {
  use("index", &info->index, kRequired);
  use("texCoord", &info->texCoord);
  use("scale", &info->scale);
  use("extensions", &info->extensions);
}

void ForEachMember(PbrMetallicRoughness* pbr, const auto& use) {
  use("baseColorFactor", Numbers{&pbr->baseColorFactor, 4});
  use("metallicFactor", &pbr->metallicFactor);
  use("roughnessFactor", &pbr->roughnessFactor);
  use("baseColorTexture", &pbr->baseColorTexture);
  use("metallicRoughnessTexture", &pbr->metallicRoughnessTexture);
}

void ForEachMember(Material* material, const auto& use) {
  use("name", &material->name);
  use("pbrMetallicRoughness", &material->pbrMetallicRoughness);
  use("emissiveFactor", Numbers{&material->emissiveFactor, 3});
  use("alphaMode", &material->alphaMode);
  use("alphaCutoff", &material->alphaCutoff);
  use("doubleSided", &material->doubleSided);
  use("emissiveTexture", &material->emissiveTexture);
  use("normalTexture", &material->normalTexture);
  use("occlusionTexture", &material->occlusionTexture);
  use("extensions", &material->extensions);
}

void ForEachMember(Primitive* primitive, const auto& use) {
  use("attributes", &primitive->attributes, kRequired);
  use("indices", &primitive->indices);
  use("material", &primitive->material);
  use("mode", &primitive->mode);
  use("targets", &primitive->targets);
  use("extensions", &primitive->extensions);
}

void ForEachMember(Mesh* mesh, const auto& use) {
  use("name", kUnread<std::string>);
  use("primitives", &mesh->primitives, kRequired);
}

void ForEachMember(Node* node, const auto& use) {
  use("name", &node->name);
  use("camera", &node->camera);
  use("mesh", &node->mesh);
  use("skin", &node->skin);
  use("children", &node->children);
  use("matrix", Numbers{&node->matrix, 16});
  use("rotation", Numbers{&node->rotation, 4});
  use("scale", Numbers{&node->scale, 3});
  use("translation", Numbers{&node->translation, 3});
  use("extensions", &node->extensions);
}

void ForEachMember(Sampler* sampler, const auto& use) {
  use("magFilter", &sampler->magFilter);
  use("minFilter", &sampler->minFilter);
  use("wrapS", &sampler->wrapS);
  use("wrapT", &sampler->wrapT);
}

void ForEachMember(Scene* scene, const auto& use) { use("nodes", &scene->nodes); }

void ForEachMember(Skin* skin, const auto& use) {
  use("joints", &skin->joints, kRequired);
  use("inverseBindMatrices", &skin->inverseBindMatrices);
}

void ForEachMember(Texture* texture, const auto& use) {
  use("sampler", &texture->sampler);
  use("source", &texture->source);
  use("extensions", &texture->extensions);
}

void ForEachMember(Light::Spot* spot, const auto& use) {
  use("innerConeAngle", &spot->innerConeAngle);
  use("outerConeAngle", &spot->outerConeAngle);
}

void ForEachMember(Light* light, const auto& use) {
  use("name", &light->name);
  use("type", &light->type, kRequired);
  use("color", Numbers{&light->color, 3});
  use("intensity", &light->intensity);
  use("range", &light->range);
  use("spot", &light->spot);
}

void ForEachMember(Variant* variant, const auto& use) { use("name", &variant->name, kRequired); }

void ForEachMember(VariantMapping* mapping, const auto& use) {
  use("variants", &mapping->variants, kRequired);
  use("material", &mapping->material, kRequired);
}

void ForEachMember(Model* model, const auto& use) {
  use("asset", &model->asset, kRequired);
  use("scene", &model->scene);
  use("extensionsUsed", &model->extensionsUsed);
  use("extensionsRequired", &model->extensionsRequired);
  use("accessors", &model->accessors);
  use("animations", &model->animations);
  use("buffers", &model->buffers);
  use("bufferViews", &model->bufferViews);
  use("cameras", &model->cameras);
  use("extensions", &model->extensions);
  use("images", &model->images);
  use("materials", &model->materials);
  use("meshes", &model->meshes);
  use("nodes", &model->nodes);
  use("samplers", &model->samplers);
  use("scenes", &model->scenes);
  use("skins", &model->skins);
  use("textures", &model->textures);
}

// An extension of any object. Most of their members are checked where they are used
// (GltfExtension).
struct Extension {
  std::string_view name;
  std::vector<Light> lights{};
  std::vector<Variant> variants{};
  std::vector<VariantMapping> mappings{};
  int source = -1;
};

void ForEachMember(Extension* extension, const auto& use) {
  if (extension->name == "KHR_lights_punctual") {
    use("light", kUnread<int>);
    use("lights", &extension->lights);
  } else if (extension->name == "KHR_materials_variants") {
    use("variants", &extension->variants);
    use("mappings", &extension->mappings);
  } else if (extension->name == "EXT_texture_webp") {
    use("source", &extension->source);
  } else if (extension->name == "KHR_texture_transform") {
    use("offset", Numbers{nullptr, 2});
    use("scale", Numbers{nullptr, 2});
    use("rotation", kUnread<double>);
    use("texCoord", kUnread<int>);
  }
  for (const ExtensionTexture& texture : kExtensionTextures) {
    if (texture.extension == extension->name) use(texture.member, kUnread<TextureInfo>);
  }
}

// --- Whether a value has the type of the variable that it is read into, and the type in words. ---

template <class T>
concept Object = requires(T* object) {
  ForEachMember(object, [](const auto&...) {});
};

// Upper bound on the number of objects in an array: "{}," takes three bytes of text, and becomes a
// struct of up to a kilobyte.
template <Object T>
constexpr size_t kMost = size_t{1} << 20;
template <>
constexpr size_t kMost<Material> = kMaxModelMaterials;

// JSON has only one type of number: 3.0 and 3e0 are as whole as 3.
bool IsWhole(const Json& json, double max) {
  if (!json.is_number()) return false;
  const auto number = json.get<double>();
  return number >= 0 && number <= max && number == std::floor(number);
}

bool Fits(const Json& json, const int*) { return IsWhole(json, 0x7fffffff); }
bool Fits(const Json& json, const uint64_t*) { return IsWhole(json, 0x1p53); }
bool Fits(const Json& json, const double*) { return json.is_number(); }
bool Fits(const Json& json, const bool*) { return json.is_boolean(); }
bool Fits(const Json& json, const std::string*) { return json.is_string(); }
bool Fits(const Json&, const Json* const*) { return true; }
template <class T>
bool Fits(const Json& json, const T*) {
  return json.is_object();
}
template <class T>
bool AllFit(const Json& json) {
  return json.is_array() && std::all_of(json.begin(), json.end(), [](const Json& element) {
           return Fits(element, static_cast<const T*>(nullptr));
         });
}
bool Fits(const Json& json, const std::vector<int>*) { return AllFit<int>(json); }
bool Fits(const Json& json, const std::vector<std::string>*) { return AllFit<std::string>(json); }
bool Fits(const Json& json, const Numbers& numbers) {
  return json.size() == numbers.length && AllFit<double>(json);
}
template <Object T>
bool Fits(const Json& json, const std::vector<T>*) {
  return json.size() <= kMost<T> && AllFit<T>(json);
}

std::string Describe(const int*) { return "a whole number from 0 on"; }
std::string Describe(const uint64_t*) { return "a whole number from 0 on"; }
std::string Describe(const double*) { return "a number"; }
std::string Describe(const bool*) { return "true or false"; }
std::string Describe(const std::string*) { return "a string"; }
std::string Describe(const std::vector<int>*) { return "an array of whole numbers from 0 on"; }
std::string Describe(const std::vector<std::string>*) { return "an array of strings"; }
std::string Describe(const Numbers& numbers) {
  return fmt::format("an array of {} numbers", numbers.length);
}
template <class T>
std::string Describe(const T*) {
  return "an object";
}
template <Object T>
std::string Describe(const std::vector<T>*) {
  return fmt::format("an array of objects, {} at most", kMost<T>);
}

// --- Reading. ---

template <Object T>
void ReadObject(const Json& json, const std::string& where, FaultList* faults, T* object);

// Each stores a value that fits. `to` may be null.
template <class T>
void Store(const Json& json, const std::string&, FaultList*, T* to) {
  if (to != nullptr) *to = json.get<T>();
}
void Store(const Json& json, const std::string&, FaultList*, const Numbers& numbers) {
  if (numbers.to != nullptr) *numbers.to = json.get<std::vector<double>>();
}
void Store(const Json& json, const std::string&, FaultList*, const Json** to) { *to = &json; }
template <Object T>
void Store(const Json& json, const std::string& where, FaultList* faults, T* to) {
  T unread;
  ReadObject(json, where, faults, to != nullptr ? to : &unread);
}
template <Object T>
void Store(const Json& json, const std::string& where, FaultList* faults, std::optional<T>* to) {
  ReadObject(json, where, faults, &to->emplace());
}
template <Object T>
void Store(const Json& json, const std::string& where, FaultList* faults, std::vector<T>* to) {
  to->reserve(json.size());
  for (size_t i = 0; i < json.size(); ++i) {
    ReadObject(json[i], fmt::format("{}/{}", where, i), faults, &to->emplace_back());
  }
}

void Store(const Json& json, const std::string& where, FaultList* faults,
           std::map<std::string, int>* to);

template <class To>
void ReadMember(const Json& json, const std::string& where, FaultList* faults, const To& to) {
  if (Fits(json, to)) {
    Store(json, where, faults, to);
  } else {
    faults->Add(where, "is not " + Describe(to));
  }
}

void Store(const Json& json, const std::string& where, FaultList* faults,
           std::map<std::string, int>* to) {
  for (const auto& [name, member] : json.items()) {
    ReadMember(member, where + "/" + PointerToken(name), faults, &(*to)[name]);
  }
}

// Extensions must be objects, whether or not they are known.
void CheckExtensions(const Json& extensions, const std::string& where, FaultList* faults) {
  if (!extensions.is_object()) {
    faults->Add(where, "is not an object");
    return;
  }
  for (const auto& [name, json] : extensions.items()) {
    Extension extension{name};
    ReadMember(json, where + "/" + PointerToken(name), faults, &extension);
  }
}

template <Object T>
void ReadObject(const Json& json, const std::string& where, FaultList* faults, T* object) {
  for (const auto& entry : json.items()) {
    const std::string place = where + "/" + PointerToken(entry.key());
    if (entry.key() == "extensions") CheckExtensions(entry.value(), place, faults);
    ForEachMember(object, [&](std::string_view name, const auto& to, bool = false) {
      if (name == entry.key()) ReadMember(entry.value(), place, faults, to);
    });
  }
  ForEachMember(object, [&](std::string_view name, const auto& to, bool is_required = false) {
    if (!is_required || json.contains(name)) return;
    faults->Add(where, fmt::format("has no \"{}\"", name), Describe(to) + " is required there");
  });
}

}  // namespace

const Json* FindExtension(Extensions extensions, const char* name) {
  if (extensions == nullptr) return nullptr;
  const auto found = extensions->find(name);
  return found == extensions->end() ? nullptr : &*found;
}

Model ReadModel(const Json& root, FaultList* faults) {
  Model model;
  if (!root.is_object()) {
    faults->Add({}, "is not a glTF file", "a glTF file is a JSON object");
    return model;
  }
  ReadObject(root, {}, faults, &model);
  if (faults->count() > 0) return model;
  // Their types have been checked.
  const auto extension = [&](Extensions extensions, const char* name) {
    Extension read{name};
    if (const Json* const json = FindExtension(extensions, name)) {
      ReadObject(*json, {}, faults, &read);
    }
    return read;
  };
  constexpr const char* kVariants = "KHR_materials_variants";
  model.lights = extension(model.extensions, "KHR_lights_punctual").lights;
  model.variants = extension(model.extensions, kVariants).variants;
  for (Texture& texture : model.textures) {
    // The core's source is for programs that do not read WebP.
    const int webp = extension(texture.extensions, "EXT_texture_webp").source;
    if (webp >= 0) texture.source = webp;
  }
  for (Mesh& mesh : model.meshes) {
    for (Primitive& primitive : mesh.primitives) {
      primitive.mappings = extension(primitive.extensions, kVariants).mappings;
    }
  }
  return model;
}

}  // namespace nacre::gltf
