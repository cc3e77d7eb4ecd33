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

// The scene's shapes, and what finds those that rays hit: camera rays and shadow rays.
struct TracedShapes {
  PrimitiveNumbers primitives;
  CameraFrame camera{};
  double camera_extent = 0;                  // ShadowRayBatch::camera_extent
  std::shared_ptr<Intersector> intersector;  // null: there is nothing to hit
  bool eye_outside = false;                  // no camera ray starts inside a sphere

  // ShadowRayBatch::own_after of rays from surfaces that camera rays have hit, and that face the
  // light.
  double OwnAfter() const { return eye_outside ? kLeavesOutward : kLeavesToEitherSide; }
};

// How camera rays find the shapes.
struct TracePlan {
  std::vector<Window> mesh_windows;  // where in the frame meshes may be visible
  bool binned = false;               // spheres are binned for camera rays
  bool by_bins = false;              // camera rays use these bins, not a BVH
  TileRays tile_rays = TileRays::kSamples;
};

// Which optional arrays hits have (hit_positions.h).
struct HitArrays {
  bool exact_directions = false;  // HitBatch::normal and HitBatch::to_view
  // Whether all hits have positions. Otherwise only the hits of tiles that show a sphere with
  // may_be_shadowed have them.
  bool all_positions = true;
  std::vector<uint8_t> may_be_shadowed;  // by sphere
};

struct HitsPlan {
  TracedShapes shapes;
  TracePlan trace;
  HitArrays arrays;
};

// The reason to use a BVH if Intersector::SpheresAreNested.
inline constexpr char kNestedSpheres[] =
    "many spheres lie within one another, where a tree of shells is faster";

// Makes the intersector, or changes that of an earlier plan, but builds no BVH.
TracedShapes PrepareShapes(const Scene& scene, const RenderSettings& settings,
                           const CameraFrame& camera, PreparedScene* prepared);

// Makes the bins for camera rays. `window` holds the pixels of the frame that are rendered.
TracePlan PlanTrace(const Scene& scene, const RenderSettings& settings, const TracedShapes& shapes,
                    const Window& window, const PixelSampler& sampler, PreparedScene* prepared,
                    Explanation* why);

// Builds the BVHs that camera rays need and, if `for_shadows`, those that shadow rays need.
void BuildTrees(const TracedShapes& shapes, const TracePlan& trace, bool for_shadows,
                const RenderSettings& settings, Explanation* why);

}  // namespace nacre
