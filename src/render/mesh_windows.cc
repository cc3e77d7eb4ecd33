// SPDX-License-Identifier: Apache-2.0
#include "render/mesh_windows.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace nacre {
namespace {

constexpr size_t kMaxMeshWindows = 64;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

struct Extent {
  double low = kInfinity, high = -kInfinity;

  void Add(double v) {
    low = std::min(low, v);
    high = std::max(high, v);
  }
};

// Rounds to a pixel coordinate that an int can hold.
int ToPixel(double v) { return static_cast<int>(std::clamp(v, -1e9, 1e9)); }

const Window kEverywhere{-1000000000, -1000000000, 1000000000, 1000000000};

// A window that holds the projection of a box. If all corners lie well in front of the eye, it is
// the bounding window of their projections.
Window WindowOf(const Extent (&box)[3], const CameraFrame& frame, double sample_margin) {
  Extent x, y;
  for (int corner = 0; corner < 8; ++corner) {
    Vec3d p;
    for (int c = 0; c < 3; ++c) p[c] = ((corner >> c) & 1) != 0 ? box[c].high : box[c].low;
    if (frame.projection == Projection::kPerspective) {
      const double depth = p.dot(frame.forward);
      if (depth <= 1e-6 * p.length()) return kEverywhere;
      p /= depth;
    }
    p -= frame.corner;
    x.Add(p.dot(frame.step_x) / frame.step_x.dot(frame.step_x));
    y.Add(p.dot(frame.step_y) / frame.step_y.dot(frame.step_y));
  }
  // One pixel more than needed, which is far more than rounding errors.
  const double margin = sample_margin + 1;
  return {ToPixel(std::floor(x.low - margin)), ToPixel(std::floor(y.low - margin)),
          ToPixel(std::ceil(x.high + margin)), ToPixel(std::ceil(y.high + margin))};
}

}  // namespace

std::vector<Window> FindMeshWindows(const Scene& scene, const CameraFrame& frame,
                                    double sample_margin) {
  std::vector<Window> windows;
  for (const Mesh& mesh : scene.meshes) {
    Extent box[3];
    for (const Vec3d& position : mesh.positions) {
      const Vec3d p = position - scene.camera.position;
      for (int c = 0; c < 3; ++c) box[c].Add(p[c]);
    }
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
