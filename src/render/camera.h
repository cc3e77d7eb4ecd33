// SPDX-License-Identifier: Apache-2.0
// render/camera.h: from film positions to rays.
#pragma once

#include "hit/batch.h"
#include "hit/camera_frame.h"
#include "scene/camera.h"

namespace nacre {

// `width` and `height`: the full frame in pixels. Pixels are square.
CameraFrame MakeCameraFrame(const Camera& camera, int width, int height);

// Rays relative to the camera's position through `count` film positions.
void MakeCameraRays(const CameraFrame& frame, const double* film_x, const double* film_y,
                    size_t count, RayBatch* rays);

// Row-major matrices for the EXR header, for row vectors (p' = p M) as OpenEXR has them:
// world to camera space (+x right, +y up, looking to -z), and world to normalised device
// coordinates (x and y in [-1, 1]).
Imath::M44d WorldToCamera(const Camera& camera);
Imath::M44d WorldToNdc(const Camera& camera, int width, int height);

}  // namespace nacre
