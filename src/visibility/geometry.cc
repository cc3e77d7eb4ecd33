// SPDX-License-Identifier: Apache-2.0
// visibility/geometry.cc: extracts the primitives from the scene.
#include "visibility/geometry.h"

#include <algorithm>
#include <atomic>
#include <limits>
#include <memory>
#include <mutex>
#include <optional>
#include <utility>

#include "base/error.h"
#include "base/parallel.h"
#include "hit/batch.h"
#include "scene/scene.h"

namespace nacre {
namespace {

void CheckPrimitiveCount(const Scene& scene) {
  size_t primitives = scene.spheres.size();
  size_t vertices = 0;
  for (const Mesh& mesh : scene.meshes) {
    primitives += mesh.triangles.size() / 3;
    vertices += mesh.positions.size();
  }
  if (std::max(primitives, vertices) >= kNoPrimitive) {
    throw Error(ExitCode::kBadInput, "/shapes", "more than 2^32 - 2 primitives or vertices",
                "split the scene");
  }
}

void AppendMesh(const Mesh& mesh, bool with_normals, TraceGeometry* geometry) {
  const auto base = static_cast<uint32_t>(geometry->positions.size());
  geometry->positions.resize(base + mesh.positions.size());
  if (with_normals) {
    if (HasSmoothNormals(mesh)) {
      geometry->normals.insert(geometry->normals.end(), mesh.normals.begin(), mesh.normals.end());
    }
    geometry->normals.resize(geometry->positions.size(), Vec3d(0));
  }
  for (size_t i = 0; i + 2 < mesh.triangles.size(); i += 3) {
    geometry->triangles.push_back(
        {base + mesh.triangles[i], base + mesh.triangles[i + 1], base + mesh.triangles[i + 2]});
  }
}

// Whether the mesh has only front sides, because its material is single-sided.
bool LacksBack(const Scene& scene, const Mesh& mesh) {
  const size_t material = mesh.material.index;
  return scene.image.culling && material < scene.materials.size() &&
         scene.materials[material].single_sided;
}

// The sphere as the hit tests read it, relative to the camera. Adding 0 turns -0 into 0, which some
// hit tests would do and others not.
TraceSphere Traced(const Sphere& sphere, const Vec3d& eye) {
  return {sphere.center - eye + Vec3d(0), sphere.radius};
}

// Where spheres are, seen from the camera.
struct Reach {
  double farthest = 0;                                   // no point is further away
  double gap = std::numeric_limits<double>::infinity();  // outside all spheres if above 0
};

Reach ReachOf(const TraceSphere& sphere) {
  constexpr double kRounding = 1e-9;  // far above the rounding errors of hits
  const double distance = sphere.center.length();
  return {distance + sphere.radius, distance - sphere.radius * (1 + kRounding)};
}

// Calls move(i) for i < count, on several threads; returns the reach of all results.
template <class Move>
Reach MoveAll(size_t count, int threads, const Move& move) {
  constexpr size_t kBlock = size_t{1} << 14;
  std::vector<Reach> reaches((count + kBlock - 1) / kBlock);
  const auto join = [](Reach* all, const Reach& one) {
    all->farthest = std::max(all->farthest, one.farthest);
    all->gap = std::min(all->gap, one.gap);
  };
  ParallelForBlocks(count, kBlock, threads, [&](size_t begin, size_t end) {
    Reach of_block;
    for (size_t i = begin; i < end; ++i) join(&of_block, move(i));
    reaches[begin / kBlock] = of_block;
  });
  Reach all;
  for (const Reach& reach : reaches) join(&all, reach);
  return all;
}

}  // namespace

TraceGeometry MakeTraceGeometry(const Scene& scene, const Vec3d& camera_position, int threads) {
  CheckPrimitiveCount(scene);
  TraceGeometry geometry;
  geometry.spheres = HugeArray<TraceSphere>(scene.spheres.size());
  const bool with_normals = std::any_of(scene.meshes.begin(), scene.meshes.end(), HasSmoothNormals);
  for (const Mesh& mesh : scene.meshes) {
    const auto first = static_cast<uint32_t>(geometry.triangles.size());
    const auto vertex = static_cast<uint32_t>(geometry.positions.size());
    AppendMesh(mesh, with_normals, &geometry);
    if (LacksBack(scene, mesh) || !geometry.single_sided.empty()) {
      geometry.single_sided.resize(first, 0);
      geometry.single_sided.resize(geometry.triangles.size(), LacksBack(scene, mesh) ? 1 : 0);
    }
    std::optional<CutOut> holes = MakeCutOut(scene, mesh);
    if (!holes) continue;
    holes->begin = first;
    holes->end = static_cast<uint32_t>(geometry.triangles.size());
    holes->first_vertex = vertex;
    geometry.cut_outs.push_back(std::move(*holes));
  }
  MoveGeometry(scene, camera_position, threads, &geometry);
  if (AreNested(geometry.spheres)) geometry.shells = BuildShellTree(geometry.spheres);
  return geometry;
}

std::optional<std::vector<ChangedSphere>> ChangeSpheres(const Scene& scene, size_t most,
                                                        int threads, TraceGeometry* geometry) {
  if (scene.spheres.size() != geometry->spheres.size()) return std::nullopt;
  std::mutex mutex;
  std::atomic<size_t> count = 0;
  std::vector<ChangedSphere> changed;
  const Reach reach = MoveAll(scene.spheres.size(), threads, [&](size_t i) {
    const TraceSphere now = Traced(scene.spheres[i], geometry->eye);
    if (!Coincide(now, geometry->spheres[i]) && count.fetch_add(1) < most) {
      const std::lock_guard lock(mutex);
      changed.push_back({static_cast<uint32_t>(i), geometry->spheres[i], now});
    }
    return ReachOf(now);
  });
  if (count > most) return std::nullopt;
  std::sort(changed.begin(), changed.end(),
            [](const ChangedSphere& a, const ChangedSphere& b) { return a.index < b.index; });
  for (const ChangedSphere& sphere : changed) geometry->spheres[sphere.index] = sphere.now;
  // With triangles, whose extent is not computed again, the extent must not shrink.
  geometry->extent =
      geometry->positions.empty() ? reach.farthest : std::max(geometry->extent, reach.farthest);
  geometry->eye_outside = reach.gap > 0;
  return changed;
}

void MoveGeometry(const Scene& scene, const Vec3d& camera_position, int threads,
                  TraceGeometry* geometry) {
  geometry->eye = camera_position;
  const Reach reach = MoveAll(scene.spheres.size(), threads, [&](size_t i) {
    const TraceSphere traced = Traced(scene.spheres[i], camera_position);
    std::construct_at(geometry->spheres.data() + i, traced);
    return ReachOf(traced);
  });
  geometry->extent = reach.farthest;
  geometry->eye_outside = reach.gap > 0;
  Vec3d* to = geometry->positions.data();
  for (const Mesh& mesh : scene.meshes) {
    const Reach of_mesh = MoveAll(mesh.positions.size(), threads, [&](size_t i) {
      to[i] = mesh.positions[i] - camera_position;
      return Reach{.farthest = to[i].length()};
    });
    geometry->extent = std::max(geometry->extent, of_mesh.farthest);
    to += mesh.positions.size();
  }
  for (CutOut& holes : geometry->cut_outs) MoveCutOut(camera_position, &holes);
}

}  // namespace nacre
