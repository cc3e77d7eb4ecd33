// SPDX-License-Identifier: Apache-2.0
#include "stress/leaks.h"

#include <atomic>
#include <memory>
#include <mutex>

#include "base/parallel.h"
#include "scene/scene.h"
#include "scene/sphere_mesh.h"
#include "stress/fuzz_draws.h"
#include "visibility/intersector.h"

namespace nacre {
namespace {

constexpr double kRadii[] = {1e-6, 1e-4, 1e-2, 1, 1e2, 1e4, 1e6};
// Of the centre from the eye, in radii: coordinates relative to the eye lose as many digits.
constexpr double kDistances[] = {0.3, 1e3};

struct Case {
  Mesh mesh;
  Vec3d inside;  // where rays start
  std::unique_ptr<Intersector> intersector;
};

std::vector<Case> MakeCases(int threads) {
  std::vector<Case> cases;
  for (const double radius : kRadii) {
    for (const double distance : kDistances) {
      Case& made = cases.emplace_back();
      const Vec3d center = Vec3d(0.36, -0.48, 0.8) * (distance * radius);
      made.mesh = MakeMesh(Icosphere{center, radius, 4});
      made.inside = center + Vec3d(0.4, 0.3, -0.1) * radius;
      Scene scene;
      scene.meshes = {made.mesh};
      made.intersector =
          std::make_unique<Intersector>(scene, Vec3d(0), IntersectorSettings{.threads = threads});
    }
  }
  return cases;
}

// A point on an edge, on a vertex, or by a touch beside one.
Vec3d DrawSeam(const Mesh& mesh, FuzzRandom* random) {
  const size_t first = 3 * random->Below(mesh.triangles.size() / 3);
  const Vec3d& a = mesh.positions[mesh.triangles[first]];
  const Vec3d& b = mesh.positions[mesh.triangles[first + 1]];
  const double along = random->OneIn(3) ? 0 : random->OneIn(4) ? 0.5 : random->Uniform(0, 1);
  const Vec3d point = a + (b - a) * along;
  if (random->OneIn(2)) return point;
  const double side = random->Magnitude(1e-17, 1e-6) * (b - a).length();
  return point +
         Vec3d(random->Uniform(-1, 1), random->Uniform(-1, 1), random->Uniform(-1, 1)) * side;
}

uint64_t LeaksOfBatch(const Case& which, FuzzRandom random, RayBatch* rays, ClosestHits* hits) {
  rays->count = kBatchCapacity;
  for (size_t i = 0; i < rays->count; ++i) {
    const Vec3d direction = DrawSeam(which.mesh, &random) - which.inside;
    rays->origin.x[i] = which.inside.x;
    rays->origin.y[i] = which.inside.y;
    rays->origin.z[i] = which.inside.z;
    rays->direction.x[i] = direction.x;
    rays->direction.y[i] = direction.y;
    rays->direction.z[i] = direction.z;
  }
  which.intersector->Closest(*rays, hits);
  uint64_t leaks = 0;
  for (size_t i = 0; i < rays->count; ++i) leaks += hits->primitive[i] == kNoPrimitive ? 1 : 0;
  return leaks;
}

}  // namespace

LeakResult CountLeaks(const LeakSettings& settings) {
  const std::vector<Case> cases = MakeCases(settings.threads);
  constexpr uint64_t kBatchesOfChunk = 64;
  constexpr uint64_t kChunk = kBatchesOfChunk * kBatchCapacity;
  const uint64_t chunks = (settings.rays + kChunk - 1) / kChunk;
  std::atomic<uint64_t> leaks{0};
  std::mutex mutex;
  uint64_t done = 0;
  ParallelFor(chunks, settings.threads, [&](size_t chunk) {
    const auto rays = std::make_unique<RayBatch>();
    const auto hits = std::make_unique<ClosestHits>();
    for (uint64_t i = 0; i < kBatchesOfChunk; ++i) {
      const uint64_t batch = chunk * kBatchesOfChunk + i;
      leaks += LeaksOfBatch(cases[batch % cases.size()],
                            FuzzRandom(settings.seed * 0x10001 + batch), rays.get(), hits.get());
    }
    if (!settings.on_progress) return;
    const std::lock_guard lock(mutex);
    settings.on_progress(static_cast<double>(++done) / static_cast<double>(chunks));
  });
  return {chunks * kChunk, leaks};
}

}  // namespace nacre
