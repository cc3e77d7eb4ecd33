// SPDX-License-Identifier: Apache-2.0
// visibility/box_trees.h: BVHs of bounding boxes around spheres and triangles, which find
// candidates for the exact tests. They are Embree's (src/embree). A build without Embree has none
// (src/no_embree): it finds spheres by bins and by shells, and renders no triangles.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "base/cancel.h"
#include "hit/batch.h"
#include "visibility/geometry.h"

namespace nacre {

// The version of this build's Embree, or null if it has none.
const char* EmbreeVersion();

enum class BoxTree : uint8_t {
  kAll,        // the spheres, unless they are in shells, and the triangles
  kTriangles,  // the triangles only
};

// Owns the BVHs, for the SIMD target that is active when it is made. Const methods may be called
// from several threads at once.
class BoxTrees {
 public:
  // Builds no BVH yet. Keeps a pointer to `geometry`, which may be moved (MoveGeometry).
  // `one_by_one` says whether incoherent rays are traced one by one rather than in packets; nullopt
  // chooses what is faster for the number of shapes. Throws Error: kInternal if Embree lacks the
  // target's instruction set, kBadInput if this build has no Embree.
  explicit BoxTrees(const TraceGeometry* geometry, std::optional<bool> one_by_one = {});
  ~BoxTrees();
  BoxTrees(const BoxTrees&) = delete;
  BoxTrees& operator=(const BoxTrees&) = delete;

  // Builds a BVH, if it does not exist yet, on up to `threads` threads (0: as many as the machine
  // has). Throws Error (kInternal) if Embree fails because memory is short. Throws Cancelled.
  void Build(BoxTree tree, int threads, CancelPointer cancel = nullptr);

  // Whether the BVHs that exist are valid for a camera at `eye` as well.
  bool Serve(const Vec3d& eye) const;

  // Finds the rays' first hits, and replaces those in `hits` that are farther.
  void FindNearer(BoxTree tree, const RayBatch& rays, ClosestHits* hits) const;

  // Sets rays->occluded where something in kAll occludes the ray; leaves the others as they are.
  void FindOccluded(ShadowRayBatch* rays) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace nacre
