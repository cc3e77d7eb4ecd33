// SPDX-License-Identifier: Apache-2.0
// render/prepared_scene.h: what is costly to make of a scene, kept from one plan to the next, and
// from what each piece was made: a change of the scene, or of what is asked for, makes those pieces
// again that depend on it. Plans made with pieces that were kept have the bits of others.
#pragma once

#include <memory>
#include <optional>
#include <utility>
#include <variant>
#include <vector>

#include "base/image.h"
#include "base/vec.h"
#include "scene/light_shapes.h"
#include "scene/parts.h"
#include "shading/kept_tables.h"
#include "visibility/intersector.h"

namespace nacre {

// A piece and its key: what it was made from.
template <class Key, class Value>
class Kept {
 public:
  // Whether the piece that is there was made from this.
  bool IsUpToDate(const Key& key) const { return key_ && *key_ == key; }

  void Set(const Key& key, Value made) {
    value = std::move(made);
    key_ = key;
  }
  void Forget() { key_.reset(); }

  // The piece, made by make() unless it is up to date.
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

// Of the scene's shapes with those of visible lights, which lie by where the camera is.
struct ShapesKey {
  PartVersions parts;       // kShapes, and kLights if any light is shown
  std::vector<bool> shown;  // by light
  Vec3d eye{0, 0, 0};
  size_t materials = 0;
  friend bool operator==(const ShapesKey&, const ShapesKey&) = default;
};

// Of what depends on the shapes and more parts of the scene.
struct ViewKey {
  uint64_t made = 0;  // how often the shapes, as above, were made; or the intersector
  PartVersions parts;
  std::vector<double> numbers;  // of the settings
  friend bool operator==(const ViewKey&, const ViewKey&) = default;
};

struct PreparedScene {
  // To be told of all changes of the scene: one object is for one scene.
  PartVersions versions;

  Kept<ShapesKey, std::shared_ptr<SceneWithLights>> with_lights;
  uint64_t shapes_made = 0;

  // The trees' coordinates are relative to the camera. Bins and lists are in the intersector.
  Kept<ViewKey, std::shared_ptr<Intersector>> intersector;
  uint64_t intersectors_made = 0;
  Kept<ViewKey, bool> eye_outside;
  Kept<ViewKey, std::vector<Window>> mesh_windows;
  Kept<ViewKey, bool> camera_bins;       // what BinForCamera has returned
  Kept<ViewKey, std::monostate> lights;  // whose occluders the intersector has found

  KeptTables tables;
  PartVersions meshes_of_tangents;  // the versions that tables.tangents are of
};

}  // namespace nacre
