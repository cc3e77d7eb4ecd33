// SPDX-License-Identifier: Apache-2.0
#include "scene_io/gltf_model.h"

namespace nacre::gltf {
namespace {

const Json* Find(const Json& object, const char* name) {
  const auto found = object.find(name);
  return found == object.end() ? nullptr : &*found;
}

// Sets *out if the object has the member `name`.
template <typename T>
void Get(const Json& object, const char* name, T* out) {
  if (const Json* json = Find(object, name)) *out = json->get<T>();
}

// Calls read(element, &out) for each element of the array `name`, which may be missing.
template <typename T, typename Read>
void GetAll(const Json& object, const char* name, std::vector<T>* out, const Read& read) {
  const Json* const array = Find(object, name);
  if (array == nullptr) return;
  out->reserve(array->size());
  for (const Json& element : *array) read(element, &out->emplace_back());
}

void ReadAccessor(const Json& json, Accessor* accessor) {
  Get(json, "bufferView", &accessor->bufferView);
  Get(json, "byteOffset", &accessor->byteOffset);
  Get(json, "count", &accessor->count);
  Get(json, "componentType", &accessor->componentType);
  Get(json, "type", &accessor->type);
  Get(json, "normalized", &accessor->normalized);
  const Json* const sparse = Find(json, "sparse");
  if (sparse == nullptr) return;
  accessor->isSparse = true;
  Get(*sparse, "count", &accessor->sparse.count);
  const Json& indices = (*sparse)["indices"];
  Get(indices, "bufferView", &accessor->sparse.indices.bufferView);
  Get(indices, "byteOffset", &accessor->sparse.indices.byteOffset);
  Get(indices, "componentType", &accessor->sparse.indices.componentType);
  const Json& values = (*sparse)["values"];
  Get(values, "bufferView", &accessor->sparse.values.bufferView);
  Get(values, "byteOffset", &accessor->sparse.values.byteOffset);
}

void ReadBufferView(const Json& json, BufferView* view) {
  Get(json, "buffer", &view->buffer);
  Get(json, "byteOffset", &view->byteOffset);
  Get(json, "byteLength", &view->byteLength);
  Get(json, "byteStride", &view->byteStride);
  view->extensions = Find(json, "extensions");
}

void ReadPrimitive(const Json& json, Primitive* primitive) {
  Get(json, "attributes", &primitive->attributes);
  Get(json, "indices", &primitive->indices);
  Get(json, "material", &primitive->material);
  Get(json, "mode", &primitive->mode);
  primitive->hasTargets = Find(json, "targets") != nullptr;
  primitive->extensions = Find(json, "extensions");
}

void ReadNode(const Json& json, Node* node) {
  Get(json, "name", &node->name);
  Get(json, "camera", &node->camera);
  Get(json, "mesh", &node->mesh);
  Get(json, "skin", &node->skin);
  Get(json, "children", &node->children);
  Get(json, "matrix", &node->matrix);
  Get(json, "rotation", &node->rotation);
  Get(json, "scale", &node->scale);
  Get(json, "translation", &node->translation);
  node->extensions = Find(json, "extensions");
}

void ReadSampler(const Json& json, Sampler* sampler) {
  Get(json, "magFilter", &sampler->magFilter);
  Get(json, "minFilter", &sampler->minFilter);
  Get(json, "wrapS", &sampler->wrapS);
  Get(json, "wrapT", &sampler->wrapT);
}

void ReadTextureInfo(const Json& parent, const char* name, TextureInfo* info) {
  const Json* const json = Find(parent, name);
  if (json == nullptr) return;
  Get(*json, "index", &info->index);
  Get(*json, "texCoord", &info->texCoord);
  Get(*json, "scale", &info->scale);
  info->extensions = Find(*json, "extensions");
}

void ReadMaterial(const Json& json, Material* material) {
  Get(json, "name", &material->name);
  Get(json, "emissiveFactor", &material->emissiveFactor);
  Get(json, "alphaMode", &material->alphaMode);
  Get(json, "alphaCutoff", &material->alphaCutoff);
  Get(json, "doubleSided", &material->doubleSided);
  ReadTextureInfo(json, "normalTexture", &material->normalTexture);
  ReadTextureInfo(json, "occlusionTexture", &material->occlusionTexture);
  ReadTextureInfo(json, "emissiveTexture", &material->emissiveTexture);
  material->extensions = Find(json, "extensions");
  const Json* const source = Find(json, "pbrMetallicRoughness");
  if (source == nullptr) return;
  PbrMetallicRoughness& pbr = material->pbrMetallicRoughness;
  Get(*source, "baseColorFactor", &pbr.baseColorFactor);
  Get(*source, "metallicFactor", &pbr.metallicFactor);
  Get(*source, "roughnessFactor", &pbr.roughnessFactor);
  ReadTextureInfo(*source, "baseColorTexture", &pbr.baseColorTexture);
  ReadTextureInfo(*source, "metallicRoughnessTexture", &pbr.metallicRoughnessTexture);
}

void ReadCamera(const Json& json, Camera* camera) {
  Get(json, "type", &camera->type);
  if (const Json* lens = Find(json, "perspective")) Get(*lens, "yfov", &camera->yfov);
  if (const Json* lens = Find(json, "orthographic")) Get(*lens, "ymag", &camera->ymag);
}

void ReadLight(const Json& json, Light* light) {
  Get(json, "name", &light->name);
  Get(json, "type", &light->type);
  Get(json, "color", &light->color);
  Get(json, "intensity", &light->intensity);
  Get(json, "range", &light->range);
  const Json* const spot = Find(json, "spot");
  if (spot == nullptr) return;
  Get(*spot, "innerConeAngle", &light->innerConeAngle);
  Get(*spot, "outerConeAngle", &light->outerConeAngle);
}

}  // namespace

const Json* FindExtension(Extensions extensions, const char* name) {
  return extensions == nullptr ? nullptr : Find(*extensions, name);
}

Model ReadModel(const Json& root) {
  Model model;
  const Json& asset = root["asset"];
  Get(asset, "version", &model.version);
  Get(asset, "minVersion", &model.minVersion);
  Get(root, "extensionsUsed", &model.extensionsUsed);
  Get(root, "extensionsRequired", &model.extensionsRequired);
  Get(root, "scene", &model.scene);
  const Json* const animations = Find(root, "animations");
  model.hasAnimations = animations != nullptr && !animations->empty();
  GetAll(root, "scenes", &model.scenes,
         [](const Json& json, Scene* scene) { Get(json, "nodes", &scene->nodes); });
  GetAll(root, "nodes", &model.nodes, &ReadNode);
  GetAll(root, "meshes", &model.meshes, [](const Json& json, Mesh* mesh) {
    GetAll(json, "primitives", &mesh->primitives, &ReadPrimitive);
  });
  GetAll(root, "accessors", &model.accessors, &ReadAccessor);
  GetAll(root, "bufferViews", &model.bufferViews, &ReadBufferView);
  GetAll(root, "buffers", &model.buffers,
         [](const Json& json, Buffer* buffer) { Get(json, "byteLength", &buffer->byteLength); });
  GetAll(root, "images", &model.images, [](const Json& json, Image* image) {
    Get(json, "uri", &image->uri);
    Get(json, "bufferView", &image->bufferView);
  });
  GetAll(root, "textures", &model.textures, [](const Json& json, Texture* texture) {
    Get(json, "sampler", &texture->sampler);
    Get(json, "source", &texture->source);
  });
  GetAll(root, "samplers", &model.samplers, &ReadSampler);
  GetAll(root, "materials", &model.materials, &ReadMaterial);
  GetAll(root, "cameras", &model.cameras, &ReadCamera);
  GetAll(root, "skins", &model.skins, [](const Json& json, Skin* skin) {
    Get(json, "joints", &skin->joints);
    Get(json, "inverseBindMatrices", &skin->inverseBindMatrices);
  });
  if (const Json* lights = FindExtension(Find(root, "extensions"), "KHR_lights_punctual")) {
    GetAll(*lights, "lights", &model.lights, &ReadLight);
  }
  return model;
}

}  // namespace nacre::gltf
