// SPDX-License-Identifier: Apache-2.0
// scene_io/model_scene.h: what turns a model into a scene: a camera that sees all of it, light,
// and the values that --set, --size and --spp give.
#pragma once

#include <string>

#include "scene/scene.h"
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

// Gives the scene of a model the overrides, a camera unless it has one, and light if it has none.
// Overrides work as in scene files, on camera, image, lights, background, textures, and the
// materials that there are: on their parameters and maps, or, with a "model", on all of one. Throws
// Error: kBadInput for values out of range and names that mean nothing, kUsage for overrides that
// cannot be made.
void CompleteModelScene(const LoadOptions& options, const std::string& file, bool has_camera,
                        Scene* scene);

}  // namespace nacre
