// SPDX-License-Identifier: Apache-2.0
// render/hits_plan.h: how a frame's rays find the scene's shapes: trees, bins of spheres, and what
// is asked of the hits.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "base/image.h"
#include "hit/camera_frame.h"
#include "render/explanation.h"
#include "render/prepared_scene.h"
#include "render/settings.h"
#include "sampling/pixel_sampler.h"
#include "scene/primitives.h"
#include "visibility/intersector.h"

namespace nacre {

struct HitsPlan {
  PrimitiveNumbers primitives;
  CameraFrame camera{};
  std::shared_ptr<Intersector> intersector;  // null: there is nothing to hit
  std::vector<Window> mesh_windows;          // pixels that triangles may be seen in
  bool binned = false;                       // spheres are binned for the camera
  bool tiles = false;                        // and camera rays find them there, not by a tree
  TileRays tile_rays = TileRays::kSamples;
  bool eye_outside = false;       // no camera ray starts in a sphere
  bool exact_directions = false;  // hits have HitBatch::normal and to_view, too
  // Whether every hit has its position; else those of tiles that show a sphere on which shadow rays
  // may start.
  bool all_positions = true;
  std::vector<uint8_t> may_be_shadowed;  // by sphere
};

// Why Intersector::SpheresAreNested leaves a tree to find what rays meet.
inline constexpr char kNestedSpheres[] =
    "many spheres lie within one another: a tree of shells tells them apart sooner";

// The intersector, with the camera's bins and no tree. `window`: the pixels to render of a frame of
// the scene's size.
HitsPlan PlanHits(const Scene& scene, const RenderSettings& settings, const Window& window,
                  const CameraFrame& camera, const PixelSampler& sampler, PreparedScene* prepared,
                  Explanation* why);

// Then builds the trees that camera rays need, or shadow rays.
void BuildTrees(bool for_shadows, HitsPlan* plan, Explanation* why);

}  // namespace nacre
