// SPDX-License-Identifier: Apache-2.0
// visibility/geometry.h: the scene's primitives as the hit tests read them: doubles relative to
// the camera (world position minus camera position, rounded once).
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "base/huge_pages.h"
#include "base/vec.h"
#include "visibility/cut_out.h"
#include "visibility/shell_tree.h"
#include "visibility/sphere_test.h"

namespace nacre {

struct Scene;

struct TraceGeometry {
  HugeArray<TraceSphere> spheres;  // in scene order
  ShellTree shells;  // of the spheres; only if many are nested, which BVHs of boxes cannot cull

  // The vertices of all meshes, mesh after mesh, and the triangles, which index them.
  std::vector<Vec3d> positions;
  std::vector<Vec3d>
      normals;  // one per position, 0 where a mesh has none; empty if no mesh has any
  std::vector<std::array<uint32_t, 3>> triangles;
  // Meshes with holes, in the order of their triangles. Most scenes have none.
  std::vector<CutOut> cut_outs;
  // Per triangle: 1 if it is single-sided, else 0. Empty if none is.
  std::vector<uint8_t> single_sided;

  // No point of any primitive is further than this from the camera.
  double extent = 0;
  // Whether the camera is outside all spheres; true only by more than all rounding errors.
  bool eye_outside = true;

  Vec3d eye{0, 0, 0};  // the camera's position in the world
  // How far a camera may be from the one that the BVHs were built for.
  double eye_reach = 0;

  uint32_t SphereCount() const { return static_cast<uint32_t>(spheres.size()); }
};

// Throws Error (kBadInput) when there are more primitives than ids.
TraceGeometry MakeTraceGeometry(const Scene& scene, const Vec3d& camera_position, int threads = 0);

// A sphere that has changed, with its former and its present value.
struct ChangedSphere {
  uint32_t index;
  TraceSphere before, now;
};

// Replaces the geometry's spheres by those of `scene`, which must have the same other shapes and
// the same camera. Returns the spheres that have changed, in ascending order. If there are more
// than `most`, or if the number of spheres differs, returns nullopt and leaves the geometry as it
// was.
std::optional<std::vector<ChangedSphere>> ChangeSpheres(const Scene& scene, size_t most,
                                                        int threads, TraceGeometry* geometry);

// Makes all coordinates but those of shells relative to another camera. `scene` must have the same
// shapes.
void MoveGeometry(const Scene& scene, const Vec3d& camera_position, int threads,
                  TraceGeometry* geometry);

}  // namespace nacre
