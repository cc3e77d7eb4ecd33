// SPDX-License-Identifier: Apache-2.0
// scene/cloud.cc: random clouds of spheres.
#include <utility>

#include "base/error.h"
#include "base/huge_pages.h"
#include "base/parallel.h"
#include "sampling/hash.h"
#include "scene/generators.h"
#include "scene/limits.h"

namespace nacre {
namespace {

// One SplitMix64 stream (Steele, Lea and Flood 2014) for each sphere. The standard library's
// distributions would differ from one implementation to the next.
class Stream {
 public:
  Stream(uint64_t seed, uint64_t index) : state_(Mix64(MixFirst(seed) + index)) {}

  uint64_t Next() { return Mix64(state_ += kStep); }
  // Uniform in [0, 1), a multiple of 2^-53.
  double NextUnit() { return static_cast<double>(Next() >> 11) * 0x1p-53; }
  double NextBetween(double min, double max) { return min + NextUnit() * (max - min); }
  // Uniform in [0, n), n < 2^32: the high half of a 32 x 32 bit product.
  uint64_t NextBelow(uint64_t n) { return ((Next() >> 32) * n) >> 32; }

 private:
  static constexpr uint64_t kStep = 0x9e3779b97f4a7c15u;
  uint64_t state_;
};

Sphere CloudSphere(const Cloud& cloud, uint64_t index) {
  Stream stream(cloud.seed, index);
  Sphere sphere;
  sphere.center.x = stream.NextBetween(cloud.min.x, cloud.max.x);
  sphere.center.y = stream.NextBetween(cloud.min.y, cloud.max.y);
  sphere.center.z = stream.NextBetween(cloud.min.z, cloud.max.z);
  sphere.radius = stream.NextBetween(cloud.radius_min, cloud.radius_max);
  sphere.material = cloud.materials[stream.NextBelow(cloud.materials.size())];
  return sphere;
}

void CheckCloud(const Cloud& cloud) {
  const auto refuse = [](const char* what, std::string hint) {
    throw Error(ExitCode::kBadInput, "cloud", what, std::move(hint));
  };
  if (!limits::kCloudCount.Contains(static_cast<double>(cloud.count))) {
    refuse("the number of spheres is out of range", Describe(limits::kCloudCount));
  }
  if (cloud.materials.empty()) refuse("no materials", "name at least one");
  if (!(cloud.min.x <= cloud.max.x && cloud.min.y <= cloud.max.y && cloud.min.z <= cloud.max.z)) {
    refuse("the box is inside out", "min is at most max in each coordinate");
  }
  if (!(limits::kLength.Contains(cloud.radius_min) && limits::kLength.Contains(cloud.radius_max) &&
        cloud.radius_min <= cloud.radius_max)) {
    refuse("the radii are out of range or in the wrong order", Describe(limits::kLength));
  }
}

}  // namespace

void AddCloud(const Cloud& cloud, int threads, Scene* scene) {
  CheckCloud(cloud);
  constexpr size_t kBlock = size_t{1} << 16;
  const size_t first = scene->spheres.size();
  scene->spheres.reserve(first + cloud.count);
  AdviseHugePages(scene->spheres.data() + first, cloud.count * sizeof(Sphere));
  scene->spheres.resize(first + cloud.count);
  Sphere* const spheres = scene->spheres.data() + first;
  ParallelForBlocks(cloud.count, kBlock, threads, [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) spheres[i] = CloudSphere(cloud, i);
  });
}

}  // namespace nacre
