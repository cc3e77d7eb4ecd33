// SPDX-License-Identifier: Apache-2.0
#include "api/scene_impl.h"

#include <functional>
#include <string_view>
#include <unordered_map>
#include <utility>

#include "scene/fault_list.h"
#include "scene/limits.h"
#include "scene/validate.h"

namespace nacre::v0 {
namespace {

LoadOptions OptionsOf(const Scene::Impl::Source& source) {
  LoadOptions options;
  options.user_brdfs = source.user_brdfs;
  options.allow_paths = source.allow_paths;
  // A program may exceed the limit for untrusted files.
  if (source.allow_paths) options.max_primitives = limits::kMaxPrimitivesMade;
  return options;
}

// The scene's materials with these names. Throws Error for names that do not exist.
std::vector<nacre::MaterialId> FindMaterials(const std::vector<std::string>& names,
                                             const nacre::Scene& scene) {
  std::unordered_map<std::string_view, uint32_t> places;
  for (const nacre::Material& material : scene.materials) {
    places.try_emplace(material.name, static_cast<uint32_t>(places.size()));
  }
  FaultList faults;
  std::vector<nacre::MaterialId> ids;
  ids.reserve(names.size());
  for (const std::string& name : names) {
    const auto found = places.find(name);
    ids.push_back(found != places.end() ? nacre::MaterialId{found->second} : nacre::MaterialId{});
    if (found != places.end()) continue;
    faults.Add("material", "unknown material \"" + name + "\"",
               NearestHint(name, NamesOf(scene.materials), "AddMaterial adds one"));
  }
  if (faults.count() > 0) throw nacre::Error(ExitCode::kBadInput, faults.All());
  return ids;
}

void Append(const Scene::Impl::Source& source, nacre::Scene* scene) {
  const std::vector<nacre::MaterialId> ids = FindMaterials(source.names, *scene);
  scene->spheres.reserve(scene->spheres.size() + source.spheres.size());
  for (nacre::Sphere sphere : source.spheres) {
    sphere.material = ids[sphere.material.index];
    scene->spheres.push_back(sphere);
  }
  for (nacre::Mesh mesh : source.meshes) {
    mesh.material = ids[mesh.material.index];
    scene->meshes.push_back(std::move(mesh));
  }
  std::vector<nacre::Fault> faults = Validate(*scene);
  if (!faults.empty()) throw nacre::Error(ExitCode::kBadInput, std::move(faults));
}

}  // namespace

std::shared_ptr<const nacre::UserBrdf> ToOwn(const UserBrdf& brdf, const std::string& name) {
  if (!brdf.evaluate || bool{brdf.sample} != bool{brdf.pdf}) {
    throw nacre::Error(ExitCode::kUsage, "UserBrdf",
                       brdf.evaluate ? "has only one of `sample` and `pdf`" : "has no `evaluate`",
                       "a model evaluates; if it samples, it tells the pdf of that");
  }
  const auto directions = [](const nacre::UserBrdf::Batch& batch) {
    return Directions{batch.count, batch.normal, batch.to_view, batch.to_light};
  };
  auto own = std::make_shared<nacre::UserBrdf>();
  own->name = name;
  own->evaluate = [=, evaluate = brdf.evaluate](const auto& batch, const auto& rgb) {
    evaluate(directions(batch), rgb);
  };
  if (!brdf.sample) return own;
  own->sample = [=, sample = brdf.sample](const auto& batch, const double* u, const double* v,
                                          const auto& to_light) {
    sample(directions(batch), u, v, to_light);
  };
  own->pdf = [=, pdf = brdf.pdf](const auto& batch, double* out) { pdf(directions(batch), out); };
  return own;
}

nacre::LiveScene Scene::Impl::MakeLive(const Source& source) {
  std::function<void(nacre::Scene*)> append;
  if (!source.spheres.empty() || !source.meshes.empty()) {
    Source shapes;
    shapes.names = source.names;
    shapes.spheres = source.spheres;
    shapes.meshes = source.meshes;
    append = [shapes = std::move(shapes)](nacre::Scene* scene) { Append(shapes, scene); };
  }
  return {source.document, OptionsOf(source), append};
}

Scene::Impl::Impl(nacre::SceneDocument read, FaultList* faults) {
  source.document = std::move(read);
  source.allow_paths = false;
  made_ = std::make_shared<nacre::Scene>(ReadDocument(source.document, OptionsOf(source), faults));
}

std::shared_ptr<const nacre::Scene> Scene::Impl::Made() const {
  const std::lock_guard lock(mutex_);
  if (made_) return made_;
  FaultList faults;
  auto scene =
      std::make_shared<nacre::Scene>(ReadDocument(source.document, OptionsOf(source), &faults));
  if (!source.spheres.empty() || !source.meshes.empty()) Append(source, scene.get());
  made_ = std::move(scene);
  return made_;
}

nacre::MaterialId Scene::Impl::NameId(const std::string& name) {
  std::vector<std::string>& names = source.names;
  const auto [place, is_new] = source.places.try_emplace(name, static_cast<uint32_t>(names.size()));
  if (is_new) names.push_back(name);
  return {place->second};
}

}  // namespace nacre::v0
