// SPDX-License-Identifier: Apache-2.0
// scene_io/model_scene.h: what turns a model into a scene: a camera that sees all of it, light,
// and the values that --set, --size and --spp give.
#pragma once

#include <string>

#include "scene/parts.h"
#include "scene/scene.h"
#include "scene_io/json_text.h"
#include "scene_io/kept_files.h"
#include "scene_io/load_scene.h"

namespace nacre {

// Gives meshes of materials with maps texture coordinates where they have none: those of one texel,
// as the usual viewers do. Returns whether there were any.
bool CompleteCoordinates(Scene* scene);

// Gives meshes that have colours a material of their own that asks for them, after its original.
void SplitColoredMaterials(Scene* scene);

// Points the camera at all spheres and meshes, from the front, the right and above: three quarters.
// Keeps its kind and field of view.
void FrameScene(Scene* scene);

// Three lights as photographers set them (key, fill, rim) about the camera, a room with soft boxes
// as an environment ("sky"), which metals mirror, and a grey background. For scenes without any
// light.
void AddStudioLights(Scene* scene);

// What overrides put into a model's scene.
struct ModelOverrides {
  Json root = Json::object();
  bool own_lights = false;  // they replace all of its lights
};

// Puts a further value. Throws Error (kUsage) if that cannot be done.
void AddOverride(const std::string& pointer, const std::string& json, ModelOverrides* overrides);

// Those of the options, the environment included. Throws Error as ApplyOptions does.
ModelOverrides OverridesOf(const LoadOptions& options);

// How a model's scene is completed.
struct ModelCompletion {
  const ModelOverrides* overrides = nullptr;
  const LoadOptions* options = nullptr;
  std::string file;           // the model
  bool has_camera = false;    // else one is added, and light if there is none
  KeptFiles* kept = nullptr;  // of a scene that is completed again; else null
};

// Completes these parts, which are as the file has them; the rest is complete. Overrides work as in
// scene files, on camera, image, lights, background, textures, and the materials that there are: on
// their parameters and maps, or, with a "model", on all of one. A camera that is added depends on
// the image, and light that is added on the camera, and the background on the light. Returns
// whether meshes got coordinates. Throws Error: kBadInput for values out of range and names that
// mean nothing, kUsage for overrides that cannot be made.
bool CompleteModelScene(const ModelCompletion& how, SceneParts parts, Scene* scene);

}  // namespace nacre
