// SPDX-License-Identifier: Apache-2.0
#include "render/mesh_windows.h"

#include <algorithm>
#include <cmath>

#include <Imath/ImathBox.h>

namespace nacre {
namespace {

constexpr size_t kMaxMeshWindows = 64;

// Rounds to a pixel coordinate that an int can hold.
int ToPixel(double v) { return static_cast<int>(std::clamp(v, -1e9, 1e9)); }

const Window kEverywhere{-1000000000, -1000000000, 1000000000, 1000000000};

// A window that holds the projection of a box. If all corners lie well in front of the eye, it is
// the bounding window of their projections.
Window WindowOf(const Imath::Box3d& box, const CameraFrame& frame, double sample_margin) {
  Imath::Box2d on_film;
  for (int corner = 0; corner < 8; ++corner) {
    Vec3d p;
    for (int c = 0; c < 3; ++c) p[c] = ((corner >> c) & 1) != 0 ? box.max[c] : box.min[c];
    if (frame.projection == Projection::kPerspective) {
      const double depth = p.dot(frame.forward);
      if (depth <= 1e-6 * p.length()) return kEverywhere;
      p /= depth;
    }
    p -= frame.corner;
    on_film.extendBy({p.dot(frame.step_x) / frame.step_x.dot(frame.step_x),
                      p.dot(frame.step_y) / frame.step_y.dot(frame.step_y)});
  }
  // One pixel more than needed, which is far more than rounding errors.
  const double margin = sample_margin + 1;
  const Vec2d &low = on_film.min, &high = on_film.max;
  return {ToPixel(std::floor(low.x - margin)), ToPixel(std::floor(low.y - margin)),
          ToPixel(std::ceil(high.x + margin)), ToPixel(std::ceil(high.y + margin))};
}

}  // namespace

std::vector<Window> FindMeshWindows(const Scene& scene, const CameraFrame& frame,
                                    double sample_margin) {
  std::vector<Window> windows;
  for (const Mesh& mesh : scene.meshes) {
    Imath::Box3d box;
    for (const Vec3d& position : mesh.positions) box.extendBy(position - scene.camera.position);
    if (mesh.positions.empty()) continue;
    const Window window = WindowOf(box, frame, sample_margin);
    if (windows.size() < kMaxMeshWindows) {
      windows.push_back(window);
    } else {
      windows.back() = BoundingWindow(windows.back(), window);
    }
  }
  return windows;
}

}  // namespace nacre
