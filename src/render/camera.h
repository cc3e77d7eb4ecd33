// SPDX-License-Identifier: Apache-2.0
// render/camera.h: makes camera rays through film positions.
#pragma once

#include "hit/batch.h"
#include "hit/camera_frame.h"
#include "scene/camera.h"

namespace nacre {

// `width` and `height` are those of the full frame, in pixels. Pixels are square.
CameraFrame MakeCameraFrame(const Camera& camera, int width, int height);

// Makes rays through film positions. Origins are relative to the camera's position.
void MakeCameraRays(const CameraFrame& frame, const FilmBatch& film, RayBatch* rays);

// Matrices for the EXR header, row-major and for row vectors (p' = p M), as OpenEXR has them: from
// world to camera space (+x right, +y up, looking along -z), and from world space to normalised
// device coordinates (x and y in [-1, 1]).
Imath::M44d WorldToCamera(const Camera& camera);
Imath::M44d WorldToNdc(const Camera& camera, int width, int height);

}  // namespace nacre
