// SPDX-License-Identifier: Apache-2.0
#include "render/camera_cost.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "base/target.h"
#include "visibility/geometry.h"
#include "visibility/sphere_bins.h"

namespace nacre {
namespace {

constexpr size_t kSample = 1024;

// Larger spheres do not belong to a cloud, and must not represent all spheres that are not sampled.
constexpr double kLargest = 128;  // pixels

// Nanoseconds of one thread, as bench/camera_cost.py fits them to frames of clouds: 1e4 to 1e6
// spheres, of which a ray passes 0.1 to 256 on average, at 1, 4 and 16 samples per pixel
// (1280x720); without SIMD at 1 sample, and 4 for 1e4 spheres. They choose the faster method
// wherever it takes a tenth less time, but for clouds of 1e6 spheres of which a ray passes 16, on
// SSE4 (a quarter) and without SIMD (a third).
struct Costs {
  double bin;     // per sphere, once for each view
  double gather;  // per sphere in a cell, in each frame
  // Per visible sphere, to fetch it and the nodes above it into the cache. In a cloud, the share of
  // visible spheres falls with the root of the depth.
  double fetch;
  double descend;  // per ray, what a BVH costs more: the ray descends to a few leaves
  double overlap;  // of that, per sphere that the ray passes: boxes overlap
  double build;    // per sphere
};

// By SIMD target: packets of rays gain more from wide vectors in tiles than in a BVH.
Costs CostsOf(Target target) {
  switch (target) {
    case Target::kAvx3:
      return {.bin = 34, .gather = 128, .fetch = 324, .descend = 26, .overlap = 0.15, .build = 380};
    case Target::kAvx2:
      return {.bin = 39, .gather = 140, .fetch = 418, .descend = 38, .overlap = 0.17, .build = 380};
    case Target::kSse4:
    case Target::kNeon:  // not measured: as wide
      return {.bin = 44, .gather = 173, .fetch = 709, .descend = 99, .overlap = 0.18, .build = 380};
    case Target::kScalar:
      break;
  }
  return {.bin = 69, .gather = 178, .fetch = 664, .descend = 121, .overlap = 0.44, .build = 380};
}

}  // namespace

CameraWork EstimateCameraWork(const Scene& scene, const CameraFrame& camera, const Window& window) {
  const size_t count = scene.spheres.size(), size = std::min(count, kSample);
  const Projector projector = MakeProjector(camera);
  double cells = 0, area = 0, visible = 0;
  Window covered{window.x1, window.y1, window.x0, window.y0};
  // Fetched before any is projected: then the processor waits for many of them at a time.
  std::array<TraceSphere, kSample> sample;
  for (size_t i = 0; i < size; ++i) {
    // Indices go in steps of the golden ratio, because the order of spheres in a scene may have any
    // period.
    const uint64_t index = size == count ? i : ((i * 0x9e3779b97f4a7c15u >> 32) * count) >> 32;
    const Sphere& sphere = scene.spheres[index];
    sample[i] = {sphere.center - scene.camera.position, sphere.radius};
  }
  for (size_t i = 0; i < size; ++i) {
    const ProjectedBounds b = Project(projector, sample[i]);
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
  const Costs costs = CostsOf(ActiveTarget());
  const double of_sphere = costs.gather - costs.fetch / std::sqrt(std::max(work.depth, 1.0));
  const double of_ray = costs.descend + costs.overlap * work.depth;
  return work.in_cells * of_sphere + (work.to_bin ? work.spheres * costs.bin : 0) -
         work.rays * of_ray;
}

double TreeTakes(double spheres) { return spheres * CostsOf(ActiveTarget()).build; }

bool TreePaysOff(const CameraWork& work, bool tree, double* lost) {
  const double saves = TreeSaves(work);
  if (tree || saves <= 0) return saves > 0;
  *lost += saves;
  return *lost > TreeTakes(work.spheres);
}

}  // namespace nacre
