// SPDX-License-Identifier: Apache-2.0
// visibility/intersector.h: which surface a ray meets first, and whether anything is in its way.
// Trees find candidates (box_trees.h, shell_tree.h), or bins; our own tests decide every hit, in
// double (sphere_test.h, projected_sphere_test.h, triangle_test.h).
//
// Results depend on the scene, the camera and the ray alone: not on which rays share a batch, on
// threads, or on the SIMD target. Of primitives at the same t the lowest id is hit.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "base/cancel.h"
#include "base/vec.h"
#include "hit/batch.h"
#include "scene/scene.h"
#include "visibility/light_bins.h"
#include "visibility/occluder_lists.h"
#include "visibility/tile_kernel.h"

namespace nacre {

// Bins of spheres for camera rays take at most this; beyond it a tree is better.
inline constexpr size_t kMaxCameraBinBytes = size_t{384} << 20;

struct IntersectorSettings {
  int threads = 0;      // that building uses; 0: as many as the machine has
  bool tree = true;     // false: no tree is built until BuildTree is called
  bool shells = false;  // the tree of spheres is one of shells whatever they are like
  // Trees are to be good for cameras up to this far from the first one as well: MoveTo. Their boxes
  // grow with it.
  double eye_reach = 0;
  std::optional<bool> one_by_one{};  // as BoxTrees has it; set by benchmarks alone
};

// What can come between the spheres and a light: bins, or else lists; in small scenes both may be
// there.
struct LightOccluders {
  ShadowLight light;           // of FindOccluders
  ShadowLight light_in_world;  // likewise, relative to the world's origin
  std::optional<LightBins> bins;
  OccluderLists lists;
};

// Owns the trees, for the SIMD target that is active when it is made. Const methods may be called
// from several threads at once.
//
// Rays start no further from the camera than some point of the scene does: at the camera, on its
// orthographic image plane, or on a surface. (Farther origins can lose hits: they are beyond the
// error that the bounds in the tree of boxes allow for.) Coordinates and radii are within the
// ranges of scene/limits.h: no square of theirs, relative to the camera, leaves the range of float.
class Intersector {
 public:
  // Takes what it needs of `scene`. Throws what BoxTrees throws.
  Intersector(const Scene& scene, const Vec3d& camera_position,
              const IntersectorSettings& settings = {});
  ~Intersector();
  Intersector(Intersector&&) noexcept;
  Intersector& operator=(Intersector&&) noexcept;

  // Makes it that of another camera of the same scene, or of one whose flat lights are lifted for
  // that camera (scene/light_shapes.h). Trees stay; bins and occluders do not, if it is another.
  // False: it cannot be, because the camera is too far from that of the trees, or spheres are
  // nested; a new one must be made.
  bool MoveTo(const Scene& scene, const Vec3d& camera_position);

  // Makes it that of another scene, of whose shapes some spheres alone have changed. Bins stay, and
  // occluders as after ForgetOccluders. False: it cannot be, because there are trees, other shapes
  // or many changes, or the camera is another; a new one must be made.
  bool ChangeSpheres(const Scene& scene, const Vec3d& camera_position);

  // Whether so many spheres lie within one another that Closest and Occluded are faster than what
  // is found in bins (shell_tree.h).
  bool SpheresAreNested() const;

  // Makes what Closest and Occluded need, if it is not there: a tree of all, of boxes, or of shells
  // for the spheres and of boxes for the triangles. Throws Cancelled; then there is no new tree.
  void BuildTree(CancelPointer cancel = nullptr);

  // Whether BuildTree has made it.
  bool HasTree() const;

  // Whether the spheres are in shells: once BuildTree is called.
  bool HasShells() const;

  // Makes what NearerTriangles needs: a tree of the triangles alone.
  void BuildTriangleTree(CancelPointer cancel = nullptr);

  // The first hit with t > 0 of each ray; kNoPrimitive and t = infinity where there is none.
  // Inside a sphere that is its far side. Where the ray starts on a surface, that surface is no
  // hit (RayBatch::from_surfaces). Fills whole vectors past rays.count with misses.
  void Closest(const RayBatch& rays, ClosestHits* hits) const;

  // The first hit on a triangle with t > 0 nearer than hits->t of each ray; where there is none,
  // kNoPrimitive, and t stays.
  void NearerTriangles(const RayBatch& rays, ClosestHits* hits) const;

  // Whether the sphere that a camera ray hits lies before t on the ray, or at t.
  bool SphereIsFirst(uint32_t sphere, const RayBatch& rays, size_t ray, double t) const;

  // Bins the spheres for the camera rays of the window's pixels, whose samples lie at most
  // `sample_margin` pixels outside them (BinSpheres). False, and no bins, if that would take more
  // than kMaxCameraBinBytes. Triangles are not binned.
  bool BinForCamera(const CameraFrame& frame, const Window& window, double sample_margin);

  // Then, instead of Closest and Refine, for a tile that lies within one row of cells
  // (sphere_bins.h): the spheres that its rays may hit, false if none; and the hits of the rays
  // through `film` on spheres, in their order. The same bits as Closest's and Refine's.
  bool EnterTile(const Window& tile, TileRays rays, TileCandidates* candidates) const;
  void HitsInTile(const TileCandidates& candidates, const FilmBatch& film,
                  const HitOutput& to) const;

  // Fills `to` from the rays ray_indices[0..count), in that order, all of which hit something;
  // `closest` is what Closest found for `rays`. Entries from count to the next multiple of
  // kBatchPadding are copies of the last hit.
  void Refine(const RayBatch& rays, const ClosestHits& closest, const uint32_t* ray_indices,
              size_t count, const HitOutput& to) const;

  // Finds what can come between the spheres and each light, so that shadow rays to it need no tree:
  // ShadowRayBatch::light is then the light's place in `lights`. Triangles are not seen: with any
  // in the scene this must not be called. `outward`: ShadowRayBatch's, which those rays must have.
  void FindOccluders(const std::vector<const Light*>& lights, bool outward);

  // Likewise, after FindOccluders, what can come between the spheres and a light with an extent
  // (occluder_lists.h), of at most kMaxListedSpheres spheres: the next place.
  void FindOccludersOfBall(const std::optional<LightBall>& ball, const PrimitiveRange& target,
                           bool outward);

  // Begins with the first light again. The next FindOccluders may take what this one has found for
  // the same light at the same place in the list.
  void ForgetOccluders();

  // What was found for a light. The reference holds until the next FindOccluders.
  const LightOccluders& Occluders(uint32_t light) const;

  // False only if nothing can come between a light of FindOccluders, or kAnyLight, and the hits of
  // a batch, which are all on one sphere and have their positions.
  bool MayOcclude(uint32_t light, const HitBatch& hits) const;

  // Sets rays->occluded: whether a surface lies at 0 < t < t_max. The surface that a ray starts on
  // is in its way only where a sphere's ray leaves inward.
  void Occluded(ShadowRayBatch* rays) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace nacre
