// SPDX-License-Identifier: Apache-2.0
#include "render/camera.h"

#include <cmath>

namespace nacre {
namespace {

struct CameraAxes {
  Vec3d right, up, forward;
};

CameraAxes MakeAxes(const Camera& camera) {
  CameraAxes basis;
  basis.forward = (camera.look_at - camera.position).normalized();
  basis.right = (basis.forward % camera.up).normalized();
  basis.up = basis.right % basis.forward;
  return basis;
}

// Half the height of the view, at distance 1 (perspective) or in world units (orthographic).
double HalfHeight(const Camera& camera) {
  return camera.projection == Projection::kPerspective ? std::tan(camera.fov_y_deg * M_PI / 360)
                                                       : camera.height / 2;
}

}  // namespace

CameraFrame MakeCameraFrame(const Camera& camera, int width, int height) {
  const CameraAxes basis = MakeAxes(camera);
  const double pixel = 2 * HalfHeight(camera) / height;
  CameraFrame frame;
  frame.projection = camera.projection;
  frame.forward = basis.forward;
  frame.step_x = basis.right * pixel;
  frame.step_y = -basis.up * pixel;
  frame.corner = -(frame.step_x * width + frame.step_y * height) / 2;
  if (camera.projection == Projection::kPerspective) frame.corner += basis.forward;
  return frame;
}

Imath::M44d WorldToCamera(const Camera& camera) {
  const CameraAxes b = MakeAxes(camera);
  const Vec3d& p = camera.position;
  return {b.right.x,      b.up.x,      -b.forward.x,  0,  //
          b.right.y,      b.up.y,      -b.forward.y,  0,  //
          b.right.z,      b.up.z,      -b.forward.z,  0,  //
          -(b.right ^ p), -(b.up ^ p), b.forward ^ p, 1};
}

Imath::M44d WorldToNdc(const Camera& camera, int width, int height) {
  const double y = 1 / HalfHeight(camera);
  const double x = y * height / width;
  // Perspective divides by the depth, and z becomes its reciprocal.
  const Imath::M44d perspective(x, 0, 0, 0, 0, y, 0, 0, 0, 0, 0, -1, 0, 0, 1, 0);
  const Imath::M44d orthographic(x, 0, 0, 0, 0, y, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1);
  return WorldToCamera(camera) *
         (camera.projection == Projection::kPerspective ? perspective : orthographic);
}

}  // namespace nacre
