// SPDX-License-Identifier: Apache-2.0
// render/camera_cost.h: whether a BVH finds the spheres of camera rays in less time than tiles do.
// Tiles need no BVH, and a ray costs less in them; but each frame gathers all spheres of a tile,
// including those that others hide. A BVH is built once, and its rays end where they hit.
#pragma once

#include "base/image.h"
#include "hit/camera_frame.h"
#include "scene/scene.h"

namespace nacre {

// The work of a frame's camera rays.
struct CameraWork {
  double spheres = 0;   // of the scene
  double in_cells = 0;  // spheres of each cell of the picture, summed over the cells
  double depth = 0;     // spheres that a ray passes on average, in the box around all of them
  double rays = 0;      // in that box
  bool to_bin = true;   // the bins for this view are not made yet
};

// Estimates the work from a sample of the spheres.
CameraWork EstimateCameraWork(const Scene& scene, const CameraFrame& camera, const Window& window);

// Nanoseconds of one thread that a BVH saves in such a frame once it is built; below 0 where tiles
// are faster.
double TreeSaves(const CameraWork& work);

// Nanoseconds of one thread that it takes to build a BVH.
double TreeTakes(double spheres);

// Whether this frame should use a BVH. `tree` says that there is one. `lost` is the time that it
// would have saved in the frames of these shapes so far, to which this one is added. A BVH is built
// once that exceeds the time that it takes, so that any number of frames takes at most twice the
// least time.
bool TreePaysOff(const CameraWork& work, bool tree, double* lost);

}  // namespace nacre
