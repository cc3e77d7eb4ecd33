// SPDX-License-Identifier: Apache-2.0
#include "scene_io/read_item.h"

#include <algorithm>
#include <exception>
#include <numeric>
#include <span>
#include <utility>
#include <variant>

#include "scene/hash.h"
#include "scene/idle_layers.h"
#include "scene/material_parameters.h"
#include "scene/validate.h"
#include "scene_io/readers.h"

namespace nacre {
namespace {

ShapeRead ReadOfSphere(size_t number) { return {{number, 0, 0, 0}, {1, 0, 0, 0}}; }

// Whether one material can replace the other without any effect beyond the material and what is
// made of it: neither on the scene's textures, nor on the validity of shapes and splits that use
// it. Materials from index `inline_ones` on belong to a split.
bool AreAlike(const Material& a, const Material& b, size_t inline_ones) {
  const auto* const split = std::get_if<SplitMaterial>(&a.model);
  if ((split != nullptr) != std::holds_alternative<SplitMaterial>(b.model)) return false;
  const bool owns =
      split != nullptr && std::any_of(split->materials.begin(), split->materials.end(),
                                      [&](MaterialId id) { return id.index >= inline_ones; });
  return !owns && CutsHoles(a) == CutsHoles(b) && a.single_sided == b.single_sided &&
         TexturesOf(a) == TexturesOf(b);
}

// Calls read(&context, &faults), which may append to the scene and returns whether it succeeded;
// then removes what it has appended. If it returns false, it must have left the rest of the scene
// unchanged.
template <class Read>
bool TryToRead(const SceneReading& reading, ScenePart part, ReadMembers* members, Scene* scene,
               const Read& read) {
  SceneContext context;
  SceneBudget budget(reading.options->max_primitives.value_or(kDefaultMaxPrimitives));
  TexelBudget texels(reading.bytes);
  SetUpContext(reading, &part, &budget, &texels, scene, &context);
  std::vector<std::string> warnings;
  if (context.on_warning) {
    context.on_warning = [&](const std::string& warning) { warnings.push_back(warning); };
  }
  std::swap(context.read.names, members->names);
  std::swap(context.read.sources, members->sources);
  context.whole_materials = &members->whole;
  const ShapeCounts before = CountShapes(*scene);
  const size_t textures = scene->textures.size(), images = scene->images.size();
  bool well = false;
  try {
    FaultList faults;
    well = read(&context, &faults) && faults.count() == 0 && scene->textures.size() == textures &&
           scene->images.size() == images;
  } catch (const std::exception&) {  // NOLINT(bugprone-empty-catch): a full read will throw it
  }
  scene->spheres.resize(before.spheres);
  scene->meshes.resize(before.meshes);
  scene->labels.resize(before.labels);
  scene->materials.resize(before.materials);
  scene->textures.resize(textures);
  scene->images.resize(images);
  std::swap(context.read.names, members->names);
  std::swap(context.read.sources, members->sources);
  members->current = well;
  if (!well) return false;
  members->varied.merge(context.read.varied);
  for (const std::string& warning : warnings) reading.options->on_warning(warning);
  return true;
}

const Material& WholeMaterial(size_t index, const Scene& scene, const ReadMembers& members) {
  const auto found = members.whole.find(static_cast<uint32_t>(index));
  return found != members.whole.end() ? found->second : scene.materials[index];
}

void SetWhole(size_t index, std::optional<Material> whole, ReadMembers* members) {
  members->whole.erase(static_cast<uint32_t>(index));
  if (whole) members->whole.emplace(static_cast<uint32_t>(index), *std::move(whole));
}

// Swaps what a shape has made anew, at the end of the scene, with what it had made before.
class ShapeSwap {
 public:
  ShapeSwap(const ShapeRead& known, Scene* scene)
      : known_(known), added_(CountShapes(*scene) - known.made), scene_(scene) {}

  // Whether both have the same number of items, and nothing else depends on the difference.
  bool Fits(const ReadMembers& members) const {
    for (size_t i = 0; i < known_.made.materials; ++i) {
      const Material& old = WholeMaterial(known_.first.materials + i, *scene_, members);
      Material now = scene_->materials[added_.materials + i];
      MoveIds(&now);
      // The shape's materials include those of its splits.
      if (!AreAlike(old, now, known_.first.materials + known_.made.materials)) return false;
    }
    for (size_t i = 0; i < known_.made.meshes; ++i) {
      if (scene_->meshes[known_.first.meshes + i].triangles.size() !=
          scene_->meshes[added_.meshes + i].triangles.size()) {
        return false;
      }
    }
    return true;
  }

  // Removes idle layers from the new materials. Returns, for each that had some, the original.
  std::vector<std::optional<Material>> RemoveIdleLayers() {
    std::vector<std::optional<Material>> whole;
    for (size_t i = added_.materials; i < scene_->materials.size(); ++i) {
      whole.push_back(nacre::RemoveIdleLayers(*scene_, &scene_->materials[i]));
    }
    return whole;
  }

  // Changes the material ids in the new items to those that the new materials will have after the
  // swap.
  void MoveIds() {
    Scene& s = *scene_;
    for (size_t i = added_.spheres; i < s.spheres.size(); ++i) Move(&s.spheres[i].material);
    for (size_t i = added_.meshes; i < s.meshes.size(); ++i) Move(&s.meshes[i].material);
    for (size_t i = added_.materials; i < s.materials.size(); ++i) MoveIds(&s.materials[i]);
  }

  // Whether the shapes are unchanged. Then the old ones stay, as others may hold pointers to them.
  bool SameShapes() const {
    const auto& [first, made] = known_;
    const auto hash = [&](size_t sphere, size_t mesh) {
      return HashShapes(std::span(scene_->spheres).subspan(sphere, made.spheres),
                        std::span(scene_->meshes).subspan(mesh, made.meshes));
    };
    return hash(first.spheres, first.meshes) == hash(added_.spheres, added_.meshes);
  }

  void Swap(bool shapes) {
    const auto swap = [](size_t first, size_t count, size_t added, auto* items) {
      const auto at = [&](size_t i) { return items->begin() + static_cast<ptrdiff_t>(i); };
      std::swap_ranges(at(first), at(first + count), at(added));
    };
    const auto& [first, made] = known_;
    if (shapes) {
      swap(first.spheres, made.spheres, added_.spheres, &scene_->spheres);
      swap(first.meshes, made.meshes, added_.meshes, &scene_->meshes);
    }
    swap(first.labels, made.labels, added_.labels, &scene_->labels);
    swap(first.materials, made.materials, added_.materials, &scene_->materials);
  }

  void Validate(FaultList* faults) const {
    const auto& [first, made] = known_;
    const Scene& s = *scene_;
    const std::string place;  // if there are faults, everything is read again
    for (size_t i = first.materials; i < first.materials + made.materials; ++i) {
      ValidateMaterial(s, i, faults);
    }
    for (size_t i = first.spheres; i < first.spheres + made.spheres; ++i) {
      ValidateSphere(s.spheres[i], added_.materials, place, faults);
      ValidateMaterialOfSphere(s, i, faults);
    }
    for (size_t i = first.meshes; i < first.meshes + made.meshes; ++i) {
      ValidateMesh(s.meshes[i], added_.materials, place, faults);
      ValidateMaterialOfMesh(s, i, faults);
    }
  }

 private:
  void Move(MaterialId* id) const {
    if (id->index < added_.materials) return;
    id->index = static_cast<uint32_t>(id->index - added_.materials + known_.first.materials);
  }
  void MoveIds(Material* material) const {
    auto* const split = std::get_if<SplitMaterial>(&material->model);
    if (split == nullptr) return;
    for (MaterialId& id : split->materials) Move(&id);
  }

  const ShapeRead& known_;
  ShapeCounts added_;  // where the new ones begin
  Scene* scene_;
};

}  // namespace

std::optional<size_t> MovePlainSphereToTree(size_t place, SceneTree* tree, ReadMembers* members) {
  const std::optional<ShapePlace> found = FindShape(place, *tree);
  if (!found) return std::nullopt;
  if (!found->run) return found->number;
  std::vector<SphereRun>& runs = tree->spheres.runs;
  const size_t run = *found->run, number = found->number;
  const auto at = [](auto& items, size_t i) { return items.begin() + static_cast<ptrdiff_t>(i); };
  const size_t index = runs[run].in_tree;
  auto& shapes = tree->root["shapes"].get_ref<Json::array_t&>();
  const Sphere& plain = runs[run].spheres[number];
  shapes.insert(at(shapes, index), JsonOf(plain, tree->spheres.MaterialOf(plain)));
  const size_t sphere = members->runs[run] + number;
  members->shapes.insert(at(members->shapes, index), ReadOfSphere(sphere));
  // Splits the run in two around the sphere.
  std::vector<Sphere>& spheres = runs[run].spheres;
  SphereRun rest{place + 1, {at(spheres, number + 1), spheres.end()}, index + 1};
  spheres.resize(number);
  for (size_t i = run + 1; i < runs.size(); ++i) ++runs[i].in_tree;
  if (!rest.spheres.empty()) {
    runs.insert(at(runs, run + 1), std::move(rest));
    members->runs.insert(at(members->runs, run + 1), sphere + 1);
  }
  if (runs[run].spheres.empty()) {
    runs.erase(at(runs, run));
    members->runs.erase(at(members->runs, run));
  }
  return index;
}

void ListShapes(SceneTree* tree, ReadMembers* members) {
  if (tree->spheres.runs.empty()) return;
  std::vector<ShapeRead> all;
  const std::vector<SphereRun>& runs = tree->spheres.runs;
  size_t run = 0;
  for (const ShapeRead& read : members->shapes) {
    all.push_back(read);
    if (run == runs.size() || runs[run].first != all.size()) continue;
    const size_t first = members->runs[run];
    for (size_t i = 0; i < runs[run].spheres.size(); ++i) all.push_back(ReadOfSphere(first + i));
    ++run;
  }
  members->shapes = std::move(all);
  members->runs.clear();
  CompleteTree("/shapes", tree);
}

std::optional<SceneChange> ReadMaterialAlone(const SceneTree& tree, const std::string& name,
                                             const SceneReading& reading, ReadMembers* members,
                                             Scene* scene) {
  const auto found = members->names.find(name);
  if (!members->current || found == members->names.end()) return std::nullopt;
  const uint32_t index = found->second.index;
  if (members->varied.contains(index)) return std::nullopt;
  const auto& materials = tree.root.at("materials").get_ref<const Json::object_t&>();
  const Json& json = (materials.begin() + index)->second;  // a search by name would take longer
  std::optional<Material> whole;
  const bool well = TryToRead(
      reading, ScenePart::kMaterials, members, scene,
      [&](SceneContext* context, FaultList* faults) {
        const JsonPath root{}, all = root.Member("materials");
        const ShapeCounts before = CountShapes(*scene);
        Material now = ReadNamedMaterial({json, all.Member(name), faults}, name, context);
        if (faults->count() > 0 || CountShapes(*scene) != before ||
            !AreAlike(WholeMaterial(index, *scene, *members), now, context->read.names.size())) {
          return false;
        }
        whole = RemoveIdleLayers(*scene, &now);
        Material& old = scene->materials[index];
        std::swap(old, now);
        ValidateMaterial(*scene, index, faults);
        if (faults->count() > 0) std::swap(old, now);
        return true;
      });
  if (!well) return std::nullopt;
  SetWhole(index, std::move(whole), members);
  SceneChange change = ScenePart::kMaterials;
  change.materials = {index};
  return change;
}

std::optional<SceneChange> ReadShapeAlone(const SceneTree& tree, size_t index, size_t place,
                                          const SceneReading& reading, ReadMembers* members,
                                          Scene* scene) {
  const Json& json = tree.root.at("shapes")[index];
  // Displacement refers to a texture, too, and its result cannot be told at a glance.
  if (!members->current || !json.is_object() || json.contains("displacement")) return std::nullopt;
  const ShapeRead known = members->shapes[index];
  bool same_shapes = false;
  std::vector<std::optional<Material>> whole;
  const bool well = TryToRead(
      reading, ScenePart::kShapes, members, scene, [&](SceneContext* context, FaultList* faults) {
        const JsonPath root{}, all = root.Member("shapes");
        const ShapeCounts before = CountShapes(*scene);
        ReadShape({json, all.Element(place), faults}, context);
        if (faults->count() > 0 || CountShapes(*scene) - before != known.made) return false;
        ShapeSwap swap(known, scene);
        if (!swap.Fits(*members)) return false;
        swap.MoveIds();
        whole = swap.RemoveIdleLayers();
        same_shapes = swap.SameShapes();
        swap.Swap(!same_shapes);
        swap.Validate(faults);
        if (faults->count() > 0) swap.Swap(!same_shapes);
        return true;
      });
  if (!well) return std::nullopt;
  SceneChange change;
  const auto& [first, made] = known;
  for (size_t i = 0; i < made.materials; ++i) {
    SetWhole(first.materials + i, std::move(whole[i]), members);
  }
  const auto list = [](size_t first_of, size_t count, std::vector<uint32_t>* to) {
    to->resize(count);
    std::iota(to->begin(), to->end(), static_cast<uint32_t>(first_of));
  };
  if (!same_shapes) {
    change.parts |= ScenePart::kShapes;
    if (made.meshes == 0) list(first.spheres, made.spheres, &change.spheres);
  }
  if (made.materials > 0) {
    change.parts |= ScenePart::kMaterials;
    list(first.materials, made.materials, &change.materials);
  }
  return change;
}

}  // namespace nacre
