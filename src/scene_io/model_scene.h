// SPDX-License-Identifier: Apache-2.0
// scene_io/model_scene.h: turns a model into a scene by adding a camera that sees all of it, light,
// and the values of --set, --size and --spp.
#pragma once

#include <string>

#include "scene/parts.h"
#include "scene/scene.h"
#include "scene_io/json_text.h"
#include "scene_io/kept_files.h"
#include "scene_io/load_options.h"

namespace nacre {

// Gives meshes without texture coordinates whose materials have maps the coordinates (0, 0), so
// that they show a single texel, as the usual viewers do. Returns whether there were such meshes.
bool CompleteCoordinates(Scene* scene);

// Gives meshes with vertex colours a copy of their material that uses these.
void SplitColoredMaterials(Scene* scene);

// The values that overrides set in a model's scene.
struct ModelOverrides {
  Json root = Json::object();
  bool own_lights = false;  // the overrides replace all of the model's lights
};

// The overrides of the options, the environment included. Throws Error as ApplyOptions does.
ModelOverrides OverridesOf(const LoadOptions& options);

// How to complete a model's scene.
struct ModelCompletion {
  const ModelOverrides* overrides = nullptr;
  const LoadOptions* options = nullptr;
  std::string file;           // the model's file
  bool has_camera = false;    // false: a camera is added, and light if there is none
  KeptFiles* kept = nullptr;  // for a scene that is completed again; else null
};

// Completes the given parts of the scene, which must be as the file has them; the other parts must
// be complete already. Overrides work as in scene files, on camera, image, lights, background,
// textures and existing materials: they change a material's parameters and maps, or, with a
// "model", replace all of it. A camera that is added depends on the image, lights that are added on
// the camera, and the background on the lights. Returns whether meshes were given texture
// coordinates. Throws Error: kBadInput for values out of range and names that do not exist, kUsage
// for overrides that cannot be made.
bool CompleteModelScene(const ModelCompletion& how, SceneParts parts, Scene* scene);

}  // namespace nacre
