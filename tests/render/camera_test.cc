// SPDX-License-Identifier: Apache-2.0
// tests/render/camera_test.cc: rays of the cameras, and the matrices that headers carry.
#include "render/camera.h"

#include <cmath>

#include "catch.h"

namespace nacre {
namespace {

Vec3d DirectionAt(const CameraFrame& frame, double x, double y) {
  RayBatch rays;
  FilmBatch film;
  film.count = 1;
  film.x[0] = x;
  film.y[0] = y;
  MakeCameraRays(frame, film, &rays);
  return Vec3d(rays.direction.x[0], rays.direction.y[0], rays.direction.z[0]);
}

TEST_CASE("perspective rays span the vertical field of view") {
  Camera camera;  // at (0, 0, 10), looking to -z
  camera.fov_y_deg = 90;
  const CameraFrame frame = MakeCameraFrame(camera, 200, 100);
  // Exact in the real numbers, a few roundings here.
  const auto close = [](const Vec3d& a, const Vec3d& b) { return (a - b).length() < 1e-14; };
  CHECK(close(DirectionAt(frame, 100, 50), Vec3d(0, 0, -1)));
  CHECK(close(DirectionAt(frame, 100, 0), Vec3d(0, 1, -1)));
  CHECK(close(DirectionAt(frame, 200, 100), Vec3d(2, -1, -1)));
}

TEST_CASE("orthographic rays are parallel and start on the image plane") {
  Camera camera{.projection = Projection::kOrthographic,
                .position = {0, 0, 0},
                .look_at = {1, 0, 0},
                .height = 4};
  const CameraFrame frame = MakeCameraFrame(camera, 100, 100);
  RayBatch rays;
  FilmBatch film;
  film.count = 2;
  film.x[1] = film.y[1] = 50;
  MakeCameraRays(frame, film, &rays);
  CHECK(rays.direction.x[0] == 1);
  CHECK(rays.origin.y[0] == Approx(2));
  CHECK(rays.origin.z[0] == Approx(-2));  // looking to +x with +y up, -z is left
  CHECK(rays.origin.y[1] == Approx(0).margin(1e-15));
}

TEST_CASE("matrices take world points to the camera and the screen") {
  Camera camera{.position = {1, 2, 3}, .look_at = {1, 2, -7}, .fov_y_deg = 60};
  Vec3d p;
  WorldToCamera(camera).multVecMatrix(Vec3d(2, 4, 0), p);
  CHECK((p - Vec3d(1, 2, -3)).length() < 1e-14);
  // A point that the ray through film (0, 0) meets is at the top left corner.
  const CameraFrame frame = MakeCameraFrame(camera, 160, 90);
  WorldToNdc(camera, 160, 90).multVecMatrix(camera.position + DirectionAt(frame, 0, 0) * 5, p);
  CHECK(p.x == Approx(-1));
  CHECK(p.y == Approx(1));
  CHECK(p.z == Approx(1.0 / 5));
}

}  // namespace
}  // namespace nacre
