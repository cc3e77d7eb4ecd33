// SPDX-License-Identifier: Apache-2.0
// api/scene_impl.h: the contents of a public scene, and the library's scene that is made from it.
#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <unordered_map>
#include <vector>

#include "api/border.h"
#include "scene/fault_list.h"
#include "scene/scene.h"
#include "scene_io/live_scene.h"
#include "scene_io/scene_document.h"

namespace nacre::v0 {

struct Scene::Impl {
  // What the caller has specified. Values are not validated here.
  struct Source {
    nacre::SceneDocument document;
    bool allow_paths = true;  // programs may name any file, files only those in their folder
    nacre::UserBrdfs user_brdfs;
    // Shapes that were added as numbers, and the names of their materials.
    std::vector<std::string> names;
    std::unordered_map<std::string, uint32_t> places;  // indices in `names`
    std::vector<nacre::Sphere> spheres;                // material: index into `names`
    std::vector<nacre::Mesh> meshes;                   // material: index into `names`
  };
  Source source;

  // Makes a scene that can be changed. Throws nacre::Error.
  static nacre::LiveScene MakeLive(const Source& source);

  // The validated scene, which the first call makes. Thread-safe. Throws nacre::Error.
  std::shared_ptr<const nacre::Scene> Made() const;

  Impl() = default;
  // Makes the scene of a document that has just been parsed. `faults` has what parsing found wrong.
  Impl(nacre::SceneDocument read, FaultList* faults);
  Impl(const Impl& other) : source(other.source), made_(other.MadeSoFar()) {}
  Impl& operator=(const Impl&) = delete;

  // To be called after every change of `source`.
  void Change() { made_.reset(); }
  // The index of a name in `names`, which is added if it is new.
  nacre::MaterialId NameId(const std::string& name);

 private:
  std::shared_ptr<const nacre::Scene> MadeSoFar() const {
    const std::lock_guard lock(mutex_);
    return made_;
  }

  mutable std::mutex mutex_;
  mutable std::shared_ptr<const nacre::Scene> made_;
};

// Converts the functions of a user's model. Throws nacre::Error (kUsage) if some are missing.
std::shared_ptr<const nacre::UserBrdf> ToOwn(const UserBrdf& brdf, const std::string& name);

}  // namespace nacre::v0
