// SPDX-License-Identifier: Apache-2.0
// api/scene_impl.h: what a public scene is made of, and the scene that it makes.
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
  // What was asked for. Values are not checked here.
  struct Source {
    nacre::SceneDocument document;
    bool allow_paths = true;  // a program may name any file; a file, those of its folder
    nacre::UserBrdfs user_brdfs;
    // What is added without text, with its materials by name.
    std::vector<std::string> names;
    std::unordered_map<std::string, uint32_t> places;  // of them
    std::vector<nacre::Sphere> spheres;                // material: index into `names`
    std::vector<nacre::Mesh> meshes;                   // likewise
  };
  Source source;

  // The scene as one that changes. Throws nacre::Error.
  static nacre::LiveScene MakeLive(const Source& source);

  // The scene, checked; made when first asked for. Any thread. Throws nacre::Error.
  std::shared_ptr<const nacre::Scene> Made() const;

  Impl() = default;
  // The scene of a document that has just been parsed, with the faults of that.
  Impl(Source read, FaultList* faults);
  Impl(const Impl& other) : source(other.source), made_(other.MadeSoFar()) {}
  Impl& operator=(const Impl&) = delete;

  // To be called after every change.
  void Change() { made_.reset(); }
  // The index of a name, which is added if it is new.
  nacre::MaterialId NameId(const std::string& name);

 private:
  std::shared_ptr<const nacre::Scene> MadeSoFar() const {
    const std::lock_guard lock(mutex_);
    return made_;
  }

  mutable std::mutex mutex_;
  mutable std::shared_ptr<const nacre::Scene> made_;
};

// Its functions in the library's own form. Throws nacre::Error (kUsage) where some are missing.
std::shared_ptr<const nacre::UserBrdf> ToOwn(const UserBrdf& brdf, const std::string& name);

}  // namespace nacre::v0
