// SPDX-License-Identifier: Apache-2.0
// render/hits_plan.h: how rays find the scene's shapes, by BVHs or by bins of spheres, and which
// optional arrays hits have.
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
  std::vector<Window> mesh_windows;          // where in the frame meshes may be visible
  bool binned = false;                       // spheres are binned for camera rays
  bool trace_by_bins = false;                // camera rays use these bins, not a BVH
  TileRays tile_rays = TileRays::kSamples;
  bool eye_outside = false;       // no camera ray starts inside a sphere
  bool exact_directions = false;  // hits have HitBatch::normal and HitBatch::to_view
  // Whether all hits have positions. Otherwise only the hits of tiles that show a sphere with
  // may_be_shadowed have them.
  bool all_positions = true;
  std::vector<uint8_t> may_be_shadowed;  // by sphere
};

// The reason to use a BVH if Intersector::SpheresAreNested.
inline constexpr char kNestedSpheres[] =
    "many spheres lie within one another, where a tree of shells is faster";

// Makes the intersector and the bins for camera rays, but no BVH. `window` holds the pixels of the
// frame that are rendered.
HitsPlan PlanHits(const Scene& scene, const RenderSettings& settings, const Window& window,
                  const CameraFrame& camera, const PixelSampler& sampler, PreparedScene* prepared,
                  Explanation* why);

// Afterwards builds the BVHs that camera rays need and, if `for_shadows`, those that shadow rays
// need.
void BuildTrees(bool for_shadows, const RenderSettings& settings, HitsPlan* plan, Explanation* why);

}  // namespace nacre
