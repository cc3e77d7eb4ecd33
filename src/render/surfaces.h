// SPDX-License-Identifier: Apache-2.0
// render/surfaces.h: the third stage: sorts hits into runs of one material, looks up the maps of
// materials that have any, and finishes the shading normals.
#pragma once

#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "base/aligned.h"
#include "render/explanation.h"
#include "render/hits.h"
#include "render/prepared_materials.h"
#include "render/settings.h"
#include "scene/primitives.h"
#include "shading/bsdf.h"
#include "shading/textures.h"

namespace nacre {

struct SurfacePlan {
  PrimitiveNumbers primitives;
  CameraFrame camera;
  int frame_width = 0;  // in pixels, for split materials
  std::shared_ptr<const PreparedMaterials> prepared;
  std::span<const ShadingMaterial> materials;  // PreparedMaterials::all
  bool splits = false;                         // some material depends on the film position
  bool emits_in_front_only = false;            // some material does
  bool interpolates = false;  // some mesh interpolates radiance, not normals (mesh_radiance.h)
  bool textured = false;      // some shape's material has ShadingMaterial::scene_material
  TextureScene textures;      // empty unless `textured`, except for `ambient`
};

// Whether the mesh interpolates radiance, not normals (mesh_radiance.h).
bool InterpolatesRadiance(const Mesh& mesh);

// `ambient` is the sum of the scene's ambient lights; the materials must have been prepared for
// whether it is black. `used` is FindUsedMaterials, by material of the scene.
SurfacePlan PlanSurfaces(const Scene& scene, const RenderSettings& settings,
                         const CameraFrame& camera, const Rgb& ambient,
                         std::shared_ptr<const PreparedMaterials> materials,
                         const std::vector<bool>& used, KeptTables* tables, Explanation* why);

// Whether the hits' directions are needed in double: some material has maps, or a lobe that is too
// narrow for float.
bool NeedsExactDirections(const SurfacePlan& plan);

// The material of a primitive, splits resolved. `film_x` is that of the sample, in pixels from the
// frame's left edge.
MaterialId MaterialAt(const SurfacePlan& plan, uint32_t primitive, double film_x);

// Hits [begin, end) of a batch share a material.
struct MaterialRun {
  MaterialId material;
  const ShadingMaterial* shading;
  size_t begin, end;
  bool interpolated;  // their radiance comes from InterpolateRadiance
};

struct Surfaces {
  HitBatch hits;
  RayFootprints footprints;  // of the rays that hit
  Surface surface;
  std::vector<MaterialRun> runs;  // those that are not interpolated come first
  size_t lit_runs = 0;            // number of runs that are shaded by lights, not interpolated
  size_t lit = 0;                 // number of hits in these runs
  // The values that maps give the hits. Made for the first material with maps.
  std::unique_ptr<HitParameters> textures;
  std::vector<CoatHits> coats;  // as many as any material of a hit so far had
};

// The runs that are shaded by lights.
inline std::span<const MaterialRun> LitRuns(const Surfaces& surfaces) {
  return {surfaces.runs.data(), surfaces.lit_runs};
}

// The hits of a run, as the BSDF of its material sees them.
inline MaterialHits HitsOf(const Surfaces& surfaces, const MaterialRun& run) {
  return {*run.shading, surfaces.hits,           surfaces.surface, run.begin,
          run.end,      surfaces.textures.get(), surfaces.coats};
}

// Hits [begin, end) of a batch that is not sorted yet belong to one run.
struct HitSegment {
  uint32_t run;
  size_t begin, end;
};

// Buffers of ResolveSurfaces.
struct SortRoom {
  // By material, the index of its run or kNoRun; then the same for interpolated runs.
  std::vector<uint32_t> run_of_material;
  std::vector<HitSegment> segments;
  AlignedArray<uint32_t> order{kBatchCapacity};
};

// Sorts the hits into runs and prepares their surfaces. May swap buffers with `hits`. Within a run,
// hits stay in the order of their rays. `film_x`, by ray, is read only if materials are split.
void ResolveSurfaces(const SurfacePlan& plan, const double* film_x, CameraHits* hits,
                     SortRoom* room, Surfaces* surfaces);

// Looks up maps, prepares the materials and makes the hits on coats. Hits and runs must be set.
void PrepareSurfaces(const SurfacePlan& plan, Surfaces* surfaces);

}  // namespace nacre
