// SPDX-License-Identifier: Apache-2.0
// render/mesh_windows.h: where in the picture meshes can be.
#pragma once

#include <vector>

#include "base/image.h"
#include "hit/camera_frame.h"
#include "scene/scene.h"

namespace nacre {

// For each mesh the pixels that rays to it may pass through, samples lying at most `reach` pixels
// outside them; of many meshes one window for all.
std::vector<Window> FindMeshWindows(const Scene& scene, const CameraFrame& frame, double reach);

}  // namespace nacre
