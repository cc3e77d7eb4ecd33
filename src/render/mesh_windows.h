// SPDX-License-Identifier: Apache-2.0
// render/mesh_windows.h: finds where in the frame meshes may be visible.
#pragma once

#include <vector>

#include "base/image.h"
#include "hit/camera_frame.h"
#include "scene/scene.h"

namespace nacre {

// For each mesh a window that holds all pixels whose samples may hit it, if samples lie at most
// `sample_margin` pixels outside their pixel. Beyond a certain number of meshes the last window is
// that of all remaining ones.
std::vector<Window> FindMeshWindows(const Scene& scene, const CameraFrame& frame,
                                    double sample_margin);

}  // namespace nacre
