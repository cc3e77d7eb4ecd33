// SPDX-License-Identifier: Apache-2.0
// visibility/intersector.h: finds the surface that a ray hits first, and whether anything occludes
// a shadow ray. BVHs (box_trees.h, shell_tree.h) or bins find candidates; nacre's own tests decide
// every hit, in double (sphere_test.h, projected_sphere_test.h, triangle_test.h).
//
// Results depend only on the scene, the camera and the ray: not on which rays share a batch, on
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
#include "visibility/light_bins.h"
#include "visibility/occluder_lists.h"
#include "visibility/tile_kernel.h"

namespace nacre {

struct Scene;

// The most memory that bins of spheres for camera rays take; beyond it a BVH is better.
inline constexpr size_t kMaxCameraBinBytes = size_t{384} << 20;

struct IntersectorSettings {
  int threads = 0;      // for building; 0: as many as the machine has
  bool tree = true;     // false: no BVH is built until BuildTree is called
  bool shells = false;  // true: the spheres' BVH is a shell tree, even if they are not nested
  // BVHs must be valid for cameras up to this distance from the first one as well (MoveTo). Their
  // boxes grow with it.
  double eye_reach = 0;
  std::optional<bool> one_by_one{};  // as in BoxTrees; only benchmarks set it
};

// The possible occluders between the spheres and a light: in bins, or else in lists; small scenes
// may have both.
struct LightOccluders {
  ShadowLight light;           // as given to FindOccluders
  ShadowLight light_in_world;  // the same light relative to the world's origin
  std::optional<LightBins> bins;
  OccluderLists lists;
};

// Owns the BVHs, for the SIMD target that is active when it is made. Const methods may be called
// from several threads at once.
//
// Rays must start no farther from the camera than the farthest point of the scene: at the camera,
// on its orthographic image plane, or on a surface. (Rays from farther away can lose hits: they are
// beyond the error that the boxes of a BVH allow for.) Coordinates and radii must be within the
// ranges of scene/limits.h: none of their squares, relative to the camera, leaves the range of
// float.
class Intersector {
 public:
  // Copies what it needs of `scene`. Throws what BoxTrees throws.
  Intersector(const Scene& scene, const Vec3d& camera_position,
              const IntersectorSettings& settings = {});
  ~Intersector();
  Intersector(Intersector&&) noexcept;
  Intersector& operator=(Intersector&&) noexcept;

  // Moves the intersector to another camera of the same scene, or of one whose flat lights are
  // moved for that camera (scene/light_shapes.h). BVHs are kept; bins and occluders are not, if the
  // camera differs. Returns false if a new intersector must be made, because the camera is too far
  // from the one that the BVHs were built for, or because spheres are nested.
  bool MoveTo(const Scene& scene, const Vec3d& camera_position);

  // Updates the intersector for a scene in which, of all shapes, only some spheres have changed.
  // Bins are kept, and occluders as after ForgetOccluders. Returns false if a new intersector must
  // be made, because there are BVHs, other shapes or many changes, or because the camera differs.
  bool ChangeSpheres(const Scene& scene, const Vec3d& camera_position);

  // Whether the camera's position is outside all spheres.
  bool EyeIsOutside() const;

  // Whether so many spheres lie within one another that Closest and Occluded are faster than bins
  // (shell_tree.h).
  bool SpheresAreNested() const;

  // Builds what Closest and Occluded need, if it does not exist yet: a BVH of all primitives, or a
  // shell tree of the spheres and a BVH of the triangles. Throws Cancelled; then there is no new
  // BVH.
  void BuildTree(CancelPointer cancel = nullptr);

  // Whether BuildTree has succeeded.
  bool HasTree() const;

  // Whether the spheres are in a shell tree. If they are not nested, it may exist only after
  // BuildTree.
  bool HasShells() const;

  // Builds what NearerTriangles needs: a BVH of the triangles only.
  void BuildTriangleTree(CancelPointer cancel = nullptr);

  // Finds the first hit with t > 0 of each ray; kNoPrimitive and t = infinity where there is none.
  // From inside a sphere that is its far side. The surface that a ray starts on is not hit
  // (RayBatch::from_surfaces). Fills whole vectors past rays.count with misses.
  void Closest(const RayBatch& rays, ClosestHits* hits) const;

  // Finds the first hit of each ray on a triangle with t > 0 that is nearer than hits->t. Where
  // there is none, sets kNoPrimitive and leaves t.
  void NearerTriangles(const RayBatch& rays, ClosestHits* hits) const;

  // Whether a camera ray, which hits the sphere, does so at t or before.
  bool SphereIsFirst(uint32_t sphere, const RayBatch& rays, size_t ray, double t) const;

  // Bins the spheres for the camera rays of the window's pixels, whose samples lie at most
  // `sample_margin` pixels outside them (BinSpheres). False, and no bins, if that would take more
  // than kMaxCameraBinBytes. Triangles are not binned.
  bool BinForCamera(const CameraFrame& frame, const Window& window, double sample_margin);

  // After BinForCamera, these replace Closest and Refine for a tile that lies within one row of
  // cells (sphere_bins.h). EnterTile finds the spheres that the tile's rays may hit, and returns
  // false if there are none. HitsInTile finds the hits of the rays through `film` on spheres, in
  // the order of the rays, with the same bits as Closest and Refine.
  bool EnterTile(const Window& tile, TileRays rays, TileCandidates* candidates) const;
  void HitsInTile(const TileCandidates& candidates, const FilmBatch& film,
                  const HitOutput& to) const;

  // Fills `to` with the hits of the rays ray_indices[0..count), in that order, all of which hit
  // something; `closest` is what Closest found for `rays`. Entries from count to the next multiple
  // of kBatchPadding are copies of the last hit.
  void Refine(const RayBatch& rays, const ClosestHits& closest, const uint32_t* ray_indices,
              size_t count, const HitOutput& to) const;

  // Finds the possible occluders between the spheres and each light, so that shadow rays to it need
  // no BVH: their ShadowRayBatch::light is the light's index in `lights`. Triangles are ignored, so
  // this must not be called if the scene has any. `outward` tells that most rays will leave outward
  // (OccluderLists::outward_only).
  void FindOccluders(const std::vector<const Light*>& lights, bool outward);

  // Called after FindOccluders: finds the possible occluders between the spheres, of which there
  // are at most kMaxListedSpheres, and a light with an extent (occluder_lists.h), which gets the
  // next index.
  void FindOccludersOfBall(const std::optional<LightBall>& ball, const PrimitiveRange& target,
                           bool outward);

  // Discards the occluders of all lights. The next FindOccluders may reuse those of the same light
  // at the same index.
  void ForgetOccluders();

  // The occluders found for a light. The reference is valid until others are found.
  const LightOccluders& Occluders(uint32_t light) const;

  // False only if nothing can occlude a light of FindOccluders, or kAnyLight, from the hits of a
  // batch, which are all on one sphere and have their positions. After FindOccluders with `outward`
  // that holds for rays that leave outward.
  bool MayOcclude(uint32_t light, const HitBatch& hits) const;

  // Sets rays->occluded: whether a surface lies at 0 < t < t_max. The surface that a ray starts on
  // occludes it only if it is a sphere that the ray leaves inward.
  void Occluded(ShadowRayBatch* rays) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace nacre
