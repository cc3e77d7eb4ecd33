// SPDX-License-Identifier: Apache-2.0
// scene_io/kept_files.h: a cache of what a scene has read from files, so that
// reading the scene again reads only files that have changed. Entries last as long as some scene
// holds them.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <string>

#include "scene/scene.h"

namespace nacre {

struct KeptFiles {
  struct Image {
    SceneImage image;  // without texels; these are below
    std::weak_ptr<const MipChain> texels;
  };
  // By a key of the file (KeyOfFile()) and of how it was read.
  std::map<std::string, Image> images;
  std::map<std::string, std::weak_ptr<const SkyPicture>> skies;
  std::map<std::string, std::weak_ptr<const Mesh>> light_meshes;
  std::map<std::string, std::weak_ptr<const MeasuredBrdf>> measured;
};

// Identifies the present state of a file: two keys are equal only if the file has not been written
// or replaced in between. A missing file has a key, too.
std::string KeyOfFile(const std::filesystem::path& path);

// Removes entries that no scene holds any more.
void DropUnheld(KeptFiles* kept);

}  // namespace nacre
