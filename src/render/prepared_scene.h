// SPDX-License-Identifier: Apache-2.0
// render/prepared_scene.h: keeps data that is costly to compute from a scene from one plan to the
// next. Each piece has a key, which holds everything that it was made from; when the scene or the
// settings change, pieces whose key has changed are made again. Plans that use kept pieces give the
// same bits as plans made from scratch.
#pragma once

#include <memory>
#include <optional>
#include <utility>
#include <variant>
#include <vector>

#include "base/image.h"
#include "base/vec.h"
#include "render/prepared_materials.h"
#include "scene/hash.h"
#include "scene/parts.h"
#include "scene/scene_with_lights.h"
#include "shading/kept_tables.h"
#include "visibility/intersector.h"

namespace nacre {

// A piece, and the key of what it was made from.
template <class Key, class Value>
class Kept {
 public:
  // Whether the piece was made from what the key says.
  bool IsUpToDate(const Key& key) const { return key_ && *key_ == key; }

  void Set(const Key& key, Value made) {
    value = std::move(made);
    key_ = key;
  }
  void Forget() { key_.reset(); }

  // Returns the piece, made by make() unless it is up to date.
  template <class Make>
  Value& Get(const Key& key, const Make& make) {
    if (!IsUpToDate(key)) {
      key_.reset();  // make() may throw
      value = make();
      key_ = key;
    }
    return value;
  }

  Value value{};

 private:
  std::optional<Key> key_;
};

// The key of data that depends on the shapes and on other parts of the scene.
struct ViewKey {
  uint64_t made = 0;  // PreparedScene::shapes_made or intersectors_made
  PartVersions parts;
  std::vector<double> numbers;  // settings that the data depends on
  friend bool operator==(const ViewKey&, const ViewKey&) = default;
};

// The key of the data derived from each material, without the materials' own versions.
struct MaterialsKey {
  uint64_t made = 0;    // PreparedScene::shapes_made, if lights are among the shapes
  PartVersions lights;  // kLights, under the same condition
  bool in_ambient = false;
  const Material* first = nullptr;  // the derived data points to the materials
  size_t count = 0;
  friend bool operator==(const MaterialsKey&, const MaterialsKey&) = default;
};

struct PreparedScene {
  // The versions of the one scene that this object is for, to be updated at each change of the
  // scene.
  SceneVersions versions;

  // The scene's shapes with those of visible lights. Its key has the parts kShapes and, if the
  // shape of any light is added, kLights, which lights these are (it depends on the camera), and
  // the number of materials.
  Kept<ViewKey, std::shared_ptr<SceneWithLights>> with_lights;
  uint64_t shapes_made = 0;            // how often with_lights was made
  uint64_t materials_with_lights = 0;  // versions.materials() of those in with_lights

  // Materials that have changed since versions.materials() was `materials_prepared` are prepared
  // anew.
  Kept<MaterialsKey, std::shared_ptr<PreparedMaterials>> materials;
  uint64_t materials_prepared = 0;
  Kept<ViewKey, std::vector<bool>> used_materials;  // FindUsedMaterials

  // Whether there is only one plan, so that BVHs need not be valid for other cameras.
  bool for_one_plan = false;

  // Follows the camera, to which its coordinates are relative (Intersector::MoveTo), and changes of
  // a few spheres (Intersector::ChangeSpheres). Bins and occluder lists are kept inside it.
  Kept<ViewKey, std::shared_ptr<Intersector>> intersector;
  uint64_t intersector_shapes = 0;  // the value of shapes_made for the shapes that it holds
  uint64_t intersectors_made = 0;   // how often intersector was made
  Kept<ViewKey, bool> eye_outside;
  Kept<ViewKey, std::vector<Window>> mesh_windows;
  Kept<ViewKey, bool> camera_bins;       // the result of BinForCamera
  Kept<ViewKey, double> lost_to_tiles;   // `lost` of TreePaysOff, for these shapes
  Kept<ViewKey, std::monostate> lights;  // whether the intersector has the lights' occluders

  KeptHashes hashes;
  Kept<ViewKey, std::monostate> shapes_hash;      // whether `hashes` has the shapes' hashes
  std::optional<uint64_t> shapes_hashed;          // versions.shapes() of those, without lights
  Kept<ViewKey, std::monostate> material_hashes;  // whether `hashes` has the materials' hashes
  uint64_t materials_hashed = 0;                  // versions.materials() of those hashes

  KeptTables tables;
  PartVersions meshes_of_tangents;  // the versions that tables.tangents were made from
};

}  // namespace nacre
