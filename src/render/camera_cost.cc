// SPDX-License-Identifier: Apache-2.0
#include "render/camera_cost.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "visibility/geometry.h"
#include "visibility/sphere_bins.h"

namespace nacre {
namespace {

constexpr size_t kSample = 1024;

// Larger spheres do not belong to a cloud, and must not represent all spheres that are not sampled.
constexpr double kLargest = 128;  // pixels

// Costs in nanoseconds of one thread on AVX-512, fitted to measurements of `waiting_bench clouds`
// with 1e4 to 4e6 spheres, of which a ray passes 0.1 to 256 on average, at 1, 4 and 16 samples per
// pixel (1280x720). The sign of TreeSaves was right wherever one method took a fifth less time than
// the other, except for one cloud of 1e5 spheres.
constexpr double kBin = 80;      // per sphere, once for each view
constexpr double kGather = 250;  // per sphere in a cell, in each frame
// Per ray, what a BVH costs more: the ray descends to a few leaves.
constexpr double kDescend = 100;
// Per visible sphere, to fetch it and the nodes above it into the cache. In a cloud, the share of
// visible spheres falls with the root of the depth.
constexpr double kFetch = 560;
constexpr double kBuild = 700;  // per sphere

}  // namespace

CameraWork EstimateCameraWork(const Scene& scene, const CameraFrame& camera, const Window& window) {
  const size_t count = scene.spheres.size(), size = std::min(count, kSample);
  const Projector projector = MakeProjector(camera);
  double cells = 0, area = 0, visible = 0;
  Window covered{window.x1, window.y1, window.x0, window.y0};
  for (size_t i = 0; i < size; ++i) {
    // Indices go in steps of the golden ratio, because the order of spheres in a scene may have any
    // period.
    const uint64_t index = size == count ? i : ((i * 0x9e3779b97f4a7c15u >> 32) * count) >> 32;
    const Sphere& sphere = scene.spheres[index];
    const ProjectedBounds b =
        Project(projector, {sphere.center - scene.camera.position, sphere.radius});
    if (!b.visible) continue;
    const double x0 = std::max<double>(b.x0, window.x0), x1 = std::min<double>(b.x1, window.x1);
    const double y0 = std::max<double>(b.y0, window.y0), y1 = std::min<double>(b.y1, window.y1);
    if (!(x0 < x1 && y0 < y1)) continue;
    ++visible;
    const double width = std::min(x1 - x0, kLargest), height = std::min(y1 - y0, kLargest);
    cells += (1 + width / kCellSize) * (1 + height / kCellSize);
    area += M_PI / 4 * width * height;
    covered.x0 = std::min(covered.x0, static_cast<int>(x0));
    covered.y0 = std::min(covered.y0, static_cast<int>(y0));
    covered.x1 = std::max(covered.x1, static_cast<int>(std::ceil(x1)));
    covered.y1 = std::max(covered.y1, static_cast<int>(std::ceil(y1)));
  }
  CameraWork work;
  work.spheres = static_cast<double>(count);
  if (visible == 0) return work;
  const double scale = work.spheres / static_cast<double>(size);
  const auto pixels = static_cast<double>(covered.pixel_count());
  work.in_cells = cells * scale;
  work.depth = area * scale / pixels;
  work.rays = pixels * scene.image.spp;
  return work;
}

double TreeSaves(const CameraWork& work) {
  const double of_sphere = kGather - kFetch / std::sqrt(std::max(work.depth, 1.0));
  return work.in_cells * of_sphere + (work.to_bin ? work.spheres * kBin : 0) - work.rays * kDescend;
}

double TreeTakes(double spheres) { return spheres * kBuild; }

bool TreePaysOff(const CameraWork& work, bool tree, double* lost) {
  const double saves = TreeSaves(work);
  if (tree || saves <= 0) return saves > 0;
  *lost += saves;
  return *lost > TreeTakes(work.spheres);
}

}  // namespace nacre
