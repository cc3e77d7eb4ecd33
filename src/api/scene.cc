// SPDX-License-Identifier: Apache-2.0
// api/scene.cc: scenes of the public API.
#include <algorithm>
#include <filesystem>
#include <utility>

#include "api/scene_impl.h"
#include "scene_io/load_scene.h"
#include "scene_io/scene_json.h"

namespace nacre::v0 {

Scene::Scene() : impl_(std::make_unique<Impl>()) {}
Scene::Scene(const Scene& other) : impl_(std::make_unique<Impl>(*other.impl_)) {}
Scene& Scene::operator=(const Scene& other) {
  if (this != &other) impl_ = std::make_unique<Impl>(*other.impl_);
  return *this;
}
Scene::Scene(Scene&&) noexcept = default;
Scene& Scene::operator=(Scene&&) noexcept = default;
Scene::~Scene() = default;

Scene Scene::FromFile(const std::string& path) {
  return AtBorder([&] {
    Scene scene;
    FaultList faults;
    if (IsModelFile(path)) {
      scene.impl_ = std::make_unique<Impl>(DocumentOfModel(path), &faults);
    } else {
      RefuseOtherModels(path);
      const std::string text = ReadSceneText(path);
      scene.impl_ = std::make_unique<Impl>(
          ParseDocument({text, path, std::filesystem::path(path).parent_path()}, &faults), &faults);
    }
    return scene;
  });
}

Scene Scene::FromJson(const std::string& text, const std::string& folder) {
  return AtBorder([&] {
    Scene scene;
    FaultList faults;
    scene.impl_ = std::make_unique<Impl>(ParseDocument({text, "scene", folder}, &faults), &faults);
    return scene;
  });
}

void Scene::Set(const std::string& pointer, const Value& value) {
  AtBorder([&] { PutValue(pointer, value.json(), &impl_->source.document); });
  impl_->Change();
}

std::optional<Value> Scene::Get(const std::string& pointer) const {
  return AtBorder([&]() -> std::optional<Value> {
    const SceneDocument& document = impl_->source.document;
    std::optional<Json> value = ValueIn(document.tree, pointer);
    // A value that was set for a model is complete unless it is an object, which the model
    // completes.
    if (!document.model.empty() && (!value || value->is_object())) {
      const auto made = impl_->Made();
      value = ValueIn({ModelTree(*made, made->image, document.tree.root), {}}, pointer);
    }
    if (!value) return std::nullopt;
    return Value::Json(JsonText(*value));
  });
}

bool Scene::Has(const std::string& pointer) const {
  if (!impl_->source.document.model.empty())
    return Get(pointer).value_or(Value::Json("null")).json() != "null";
  return AtBorder([&] { return HasValueIn(impl_->source.document.tree, pointer); });
}

void Scene::SetCamera(const Parameters& camera) { Set("/camera", camera); }

void Scene::SetBackground(const Rgb& radiance) { Set("/background", radiance); }

void Scene::AddTexture(const std::string& name, const Parameters& texture) {
  Set("/textures/" + PointerToken(name), texture);
}

void Scene::AddMaterial(const std::string& name, const Parameters& material) {
  Set("/materials/" + PointerToken(name), material);
  impl_->source.user_brdfs.erase(name);
}

void Scene::AddMaterial(const std::string& name, const UserBrdf& brdf, const Parameters& rest) {
  const auto own = AtBorder([&] { return ToOwn(brdf, name); });
  Parameters material = rest;
  if (std::ranges::find(rest, "model", &Parameter::name) == rest.end()) {
    material.push_back({"model", "lambert"});
  }
  AddMaterial(name, material);
  impl_->source.user_brdfs[name] = own;
}

void Scene::AddLight(const std::string& name, const Parameters& light) {
  Set("/lights/" + PointerToken(name), light);
}

void Scene::AddShape(const Parameters& shape) {
  AtBorder([&] { PutShape(Value(shape).json(), &impl_->source.document); });
  impl_->Change();
}

void Scene::AddSphere(const Vec3& center, double radius, const std::string& material) {
  impl_->source.spheres.push_back({ToOwn(center), radius, impl_->NameId(material)});
  impl_->Change();
}

void Scene::AddMesh(const Mesh& mesh, const std::string& material) {
  nacre::Mesh own;
  own.material = impl_->NameId(material);
  own.positions.reserve(mesh.positions.size());
  for (const Vec3& position : mesh.positions) own.positions.push_back(ToOwn(position));
  own.normals.reserve(mesh.normals.size());
  for (const Vec3& normal : mesh.normals) own.normals.push_back(ToOwn(normal));
  own.uvs.reserve(mesh.uvs.size());
  for (const auto& [u, v] : mesh.uvs) own.uvs.emplace_back(u, v);
  own.triangles = mesh.triangles;
  impl_->source.meshes.push_back(std::move(own));
  impl_->Change();
}

void Scene::Check() const {
  AtBorder([&] { impl_->Made(); });
}

size_t Scene::sphere_count() const {
  return AtBorder([&] { return impl_->Made()->spheres.size(); });
}

size_t Scene::mesh_count() const {
  return AtBorder([&] { return impl_->Made()->meshes.size(); });
}

std::vector<std::string> Scene::material_names() const {
  return AtBorder([&] { return NamesOf(impl_->Made()->materials); });
}

std::vector<std::string> Scene::light_names() const {
  return AtBorder([&] { return NamesOf(impl_->Made()->lights); });
}

}  // namespace nacre::v0
