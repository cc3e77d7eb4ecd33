// SPDX-License-Identifier: Apache-2.0
// scene_io/kept_files.h: images and meshes of files that a scene holds, for when it is read again:
// files that have not changed are not read anew. Entries last as long as some scene holds them.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <string>

#include "scene/scene.h"

namespace nacre {

struct KeptFiles {
  struct Image {
    SceneImage image;  // its texels are below
    std::weak_ptr<const MipChain> texels;
  };
  // By what they were read from and how, KeyOfFile() included.
  std::map<std::string, Image> images;
  std::map<std::string, std::weak_ptr<const SkyPicture>> skies;
  std::map<std::string, std::weak_ptr<const Mesh>> light_meshes;
};

// Names a file as it is now: two keys are equal only if the file has not been written or replaced
// in between. A missing file has a key, too.
std::string KeyOfFile(const std::filesystem::path& path);

// Forgets entries that no scene holds any more.
void DropUnheld(KeptFiles* kept);

}  // namespace nacre
