// SPDX-License-Identifier: Apache-2.0
// render/camera_cost.h: whether a tree finds the spheres of camera rays in less time than tiles do.
// Tiles need no tree, and a ray costs less in them; but each frame gathers all spheres of a tile,
// those as well that others hide. A tree is built once, and its rays end where they hit.
#pragma once

#include "base/image.h"
#include "hit/camera_frame.h"
#include "scene/scene.h"

namespace nacre {

// What camera rays have to do in a frame.
struct CameraWork {
  double spheres = 0;   // of the scene
  double in_cells = 0;  // spheres of each cell of the picture, summed over the cells
  double depth = 0;     // spheres that a ray meets on average, in the box around all of them
  double rays = 0;      // in that box
  bool to_bin = true;   // the bins for this view are not made yet
};

// Estimated by a sample of the spheres.
CameraWork EstimateCameraWork(const Scene& scene, const CameraFrame& camera, const Window& window);

// Nanoseconds of one thread that a tree, once it is there, saves in such a frame; below 0 where
// tiles are faster.
double TreeSaves(const CameraWork& work);

// Nanoseconds of one thread that it takes to build a tree.
double TreeTakes(double spheres);

// Whether this frame is to use a tree. `tree`: it is there. `lost`: what a tree would have saved in
// the frames of these shapes so far, to which this one is added: a tree is built once that is more
// than it takes, so that however many frames follow, all of them take at most twice the least time.
bool TreePaysOff(const CameraWork& work, bool tree, double* lost);

}  // namespace nacre
