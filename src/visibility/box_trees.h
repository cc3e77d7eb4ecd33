// SPDX-License-Identifier: Apache-2.0
// visibility/box_trees.h: trees of boxes around spheres and triangles, which find candidates for
// the exact tests. They are Embree's (src/embree). A build without Embree has none (src/no_embree):
// it finds spheres by bins and by shells, and renders no triangles.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "base/cancel.h"
#include "hit/batch.h"
#include "visibility/geometry.h"

namespace nacre {

// The version of this build's Embree; null: there is none.
const char* EmbreeVersion();

enum class BoxTree : uint8_t {
  kAll,        // of the spheres, unless they are in shells, and of the triangles
  kTriangles,  // of these alone
};

// For the SIMD target that is active when it is made. Const methods may be called from several
// threads at once.
class BoxTrees {
 public:
  // Builds no tree yet. Keeps a pointer to `geometry`, which may be moved (MoveGeometry).
  // `one_by_one`: whether incoherent rays are traced so, and not in packets; none: by what is
  // faster for so many shapes. Throws Error: kInternal where Embree has not the target's
  // instruction set, kBadInput if this build has no Embree.
  explicit BoxTrees(const TraceGeometry* geometry, std::optional<bool> one_by_one = {});
  ~BoxTrees();
  BoxTrees(const BoxTrees&) = delete;
  BoxTrees& operator=(const BoxTrees&) = delete;

  // Builds a tree that is not there, on up to `threads` threads (0: as many as the machine has).
  // Throws Error (kInternal) where Embree fails: out of memory. Throws Cancelled.
  void Build(BoxTree tree, int threads, CancelPointer cancel = nullptr);

  // Whether the trees that are there are good for a camera at `eye` as well.
  bool Serve(const Vec3d& eye) const;

  // Puts the rays' first hits in the place of those that they are nearer than.
  void FindNearer(BoxTree tree, const RayBatch& rays, ClosestHits* hits) const;

  // Sets rays->occluded where something of kAll is in the way; the others stay.
  void FindOccluded(ShadowRayBatch* rays) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace nacre
