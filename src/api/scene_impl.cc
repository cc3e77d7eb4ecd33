// SPDX-License-Identifier: Apache-2.0
#include "api/scene_impl.h"

#include <algorithm>
#include <functional>

#include "scene/fault_list.h"
#include "scene/validate.h"
#include "scene_io/json_text.h"
#include "scene_io/load_scene.h"
#include "scene_io/model_scene.h"
#include "scene_io/overrides.h"
#include "scene_io/read_scene.h"

namespace nacre::v0 {
namespace {

// The text of a scene file with shapes added to those that it has. Leaves a text that is no scene
// to its reader.
std::string WithShapes(const Scene::Impl::Source& source) {
  FaultList faults;
  Json root = ParseJson(source.text, source.file, &faults);
  if (!root.is_object()) return source.text;
  Json& shapes = root["shapes"];
  if (shapes.is_null()) shapes = Json::array();
  if (!shapes.is_array()) return source.text;
  ThrowFaults(faults, source.file);
  for (const std::string& shape : source.shapes) {
    shapes.push_back(ParseJson(shape, "AddShape", &faults));
    ThrowFaults(faults, "AddShape");
  }
  return JsonText(root);
}

LoadOptions OptionsOf(const Scene::Impl::Source& source) {
  LoadOptions options;
  options.overrides = source.overrides;
  options.user_brdfs = source.user_brdfs;
  options.allow_paths = source.allow_paths;
  // A program may ask for what a stranger's file may not.
  if (source.allow_paths) options.max_primitives = limits::kMaxPrimitivesMade;
  return options;
}

// The text of the source's scene file. Throws if it is a model that text cannot add to.
std::string TextOf(const Scene::Impl::Source& source) {
  if (source.shapes.empty()) return source.text;
  if (source.model_path.empty()) return WithShapes(source);
  throw nacre::Error(ExitCode::kUsage, source.model_path, "a model takes no shapes as parameters",
                     "AddSphere and AddMesh work; or name the model in a mesh of a scene");
}

nacre::Scene Read(const Scene::Impl::Source& source) {
  const std::string text = TextOf(source);
  if (!source.model_path.empty()) return LoadScene(source.model_path, OptionsOf(source));
  return LoadSceneText(text, source.file, source.folder, OptionsOf(source));
}

// The scene's materials of these names.
std::vector<nacre::MaterialId> FindMaterials(const std::vector<std::string>& names,
                                             const nacre::Scene& scene) {
  std::vector<std::string> known;
  known.reserve(scene.materials.size());
  for (const nacre::Material& material : scene.materials) known.push_back(material.name);
  FaultList faults;
  std::vector<nacre::MaterialId> ids;
  ids.reserve(names.size());
  for (const std::string& name : names) {
    const auto found = std::find(known.begin(), known.end(), name);
    ids.push_back({static_cast<uint32_t>(found - known.begin())});
    if (found != known.end()) continue;
    const std::string nearest = NearestName(name, known);
    faults.Add("material", "unknown material \"" + name + "\"",
               nearest.empty() ? "AddMaterial adds one" : "did you mean \"" + nearest + "\"?");
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
    append = [source](nacre::Scene* scene) { Append(source, scene); };
  }
  const std::string text = TextOf(source);
  if (!source.model_path.empty()) return {source.model_path, OptionsOf(source), append};
  return {text, source.file, source.folder, OptionsOf(source), append};
}

std::optional<std::string> Scene::Impl::ValueAt(const std::string& pointer) const {
  const LoadOptions options = OptionsOf(source);
  if (!source.model_path.empty()) return nacre::ValueAt(pointer, OverridesOf(options).root);
  FaultList faults;
  const std::string text = TextOf(source);
  SceneTree tree = ParseScene({text, source.file, source.folder}, options, &faults);
  ThrowFaults(faults, source.file);
  CompleteTree(pointer, &tree);
  return nacre::ValueAt(pointer, tree.root);
}

std::shared_ptr<const nacre::Scene> Scene::Impl::Made() const {
  const std::lock_guard lock(mutex_);
  if (made_) return made_;
  auto scene = std::make_shared<nacre::Scene>(Read(source));
  if (!source.spheres.empty() || !source.meshes.empty()) Append(source, scene.get());
  made_ = std::move(scene);
  return made_;
}

nacre::MaterialId Scene::Impl::NameId(const std::string& name) {
  std::vector<std::string>& names = source.names;
  // Shapes of one material mostly come together.
  const auto found = std::find(names.rbegin(), names.rend(), name);
  if (found != names.rend()) return {static_cast<uint32_t>(names.rend() - found - 1)};
  names.push_back(name);
  return {static_cast<uint32_t>(names.size() - 1)};
}

}  // namespace nacre::v0
