// SPDX-License-Identifier: Apache-2.0
// no_embree/box_trees.cc: replaces src/embree in builds without Embree.
#include "visibility/box_trees.h"

#include "base/error.h"

namespace nacre {

struct BoxTrees::State {};

const char* EmbreeVersion() { return nullptr; }

BoxTrees::BoxTrees(const TraceGeometry* /*geometry*/, std::optional<bool> /*one_by_one*/) {
  throw Error(ExitCode::kBadInput, "scene", "this build has no Embree: it renders spheres only",
              "leave out meshes, and flat lights that are visible; or build nacre with "
              "NACRE_EMBREE=ON");
}
BoxTrees::~BoxTrees() = default;

// These are never called, because the constructor throws.
void BoxTrees::Build(BoxTree /*tree*/, int /*threads*/, CancelPointer /*cancel*/) {}
bool BoxTrees::Serve(const Vec3d& /*eye*/) const { return true; }
void BoxTrees::FindNearer(BoxTree /*tree*/, const RayBatch& /*rays*/, ClosestHits* /*hits*/) const {
}
void BoxTrees::FindOccluded(ShadowRayBatch* /*rays*/) const {}

}  // namespace nacre
