// SPDX-License-Identifier: Apache-2.0
// api/scene_impl.h: what a public scene is made of, and the scene that it makes.
#pragma once

#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "api/border.h"
#include "scene/scene.h"
#include "scene_io/live_scene.h"

namespace nacre::v0 {

struct Scene::Impl {
  // What was asked for. Nothing is checked here but that files can be read.
  struct Source {
    std::string model_path;  // of a model; else `text` is that of a scene file
    std::string text = R"({"nacre": 1})";
    std::string file = "scene";  // what errors call the text
    std::filesystem::path folder = ".";
    bool allow_paths = true;  // a program may name any file; a file, those of its folder
    std::vector<std::pair<std::string, std::string>> overrides;  // pointer and JSON
    std::vector<std::string> shapes;                             // objects in JSON
    nacre::UserBrdfs user_brdfs;
    // What is added without text, with its materials by name.
    std::vector<std::string> names;
    std::vector<nacre::Sphere> spheres;  // material: index into `names`
    std::vector<nacre::Mesh> meshes;     // likewise
  };
  Source source;

  // The scene as one that changes. Throws nacre::Error.
  static nacre::LiveScene MakeLive(const Source& source);

  // What the text says at a JSON pointer, with what was set; nothing if that is nothing. Throws
  // nacre::Error.
  std::optional<std::string> ValueAt(const std::string& pointer) const;

  // The scene, checked; made when first asked for. Any thread. Throws nacre::Error.
  std::shared_ptr<const nacre::Scene> Made() const;

  Impl() = default;
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
