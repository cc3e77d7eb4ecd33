// SPDX-License-Identifier: Apache-2.0
#include "render/mesh_windows.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace nacre {
namespace {

constexpr size_t kMostWindows = 64;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

struct Extent {
  double low = kInfinity, high = -kInfinity;

  void Add(double v) {
    low = std::min(low, v);
    high = std::max(high, v);
  }
};

// Pixels, clamped to what an int holds.
int ToPixel(double v) { return static_cast<int>(std::clamp(v, -1e9, 1e9)); }

const Window kEverywhere{-1000000000, -1000000000, 1000000000, 1000000000};

// Where a box is seen: its corners' pictures hold it between them if all lie well before the eye.
Window WindowOf(const Extent (&box)[3], const CameraFrame& frame, double reach) {
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
  // A pixel more than rounding can make of it.
  const double margin = reach + 1;
  return {ToPixel(std::floor(x.low - margin)), ToPixel(std::floor(y.low - margin)),
          ToPixel(std::ceil(x.high + margin)), ToPixel(std::ceil(y.high + margin))};
}

Window Around(const Window& a, const Window& b) {
  return {std::min(a.x0, b.x0), std::min(a.y0, b.y0), std::max(a.x1, b.x1), std::max(a.y1, b.y1)};
}

}  // namespace

std::vector<Window> FindMeshWindows(const Scene& scene, const CameraFrame& frame, double reach) {
  std::vector<Window> windows;
  for (const Mesh& mesh : scene.meshes) {
    Extent box[3];
    for (const Vec3d& position : mesh.positions) {
      const Vec3d p = position - scene.camera.position;
      for (int c = 0; c < 3; ++c) box[c].Add(p[c]);
    }
    if (mesh.positions.empty()) continue;
    const Window window = WindowOf(box, frame, reach);
    if (windows.size() < kMostWindows) {
      windows.push_back(window);
    } else {
      windows.back() = Around(windows.back(), window);
    }
  }
  return windows;
}

}  // namespace nacre
