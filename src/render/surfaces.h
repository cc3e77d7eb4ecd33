// SPDX-License-Identifier: Apache-2.0
// render/surfaces.h: the third stage: hits sorted into runs of one material, with the maps of those
// that have any looked up and their shading normals final.
#pragma once

#include <limits>
#include <memory>
#include <vector>

#include "base/aligned.h"
#include "render/explanation.h"
#include "render/hits.h"
#include "render/settings.h"
#include "scene/primitives.h"
#include "shading/shade.h"
#include "shading/textures.h"

namespace nacre {

struct SurfacePlan {
  PrimitiveNumbers primitives;
  int frame_width = 0;                     // that split materials divide
  std::vector<ShadingMaterial> materials;  // one per material of the scene, `black`, and coats
  MaterialId black;                        // the back of one-sided emitters
  std::vector<MaterialId> coats;           // by material of the scene; none of those without
  bool coated = false;                     // some material has a coat
  bool splits = false;                     // some material depends on the film position
  bool one_sided = false;                  // some material emits in front only
  bool interpolates = false;  // some mesh interpolates radiance, not normals (mesh_radiance.h)
  bool textured = false;      // some hits may need textures
  TextureScene textures;      // empty if no shape has any
};

// `ambient`: the sum of the scene's ambient lights.
SurfacePlan PlanSurfaces(const Scene& scene, const RenderSettings& settings,
                         const CameraFrame& camera, const Rgb& ambient, KeptTables* tables,
                         Explanation* why);

// Whether some material has a lobe too narrow for float, or maps: its hits keep their directions in
// double.
bool NeedsExactDirections(const SurfacePlan& plan);

// The material of a primitive where the sample lies at film_x pixels from the frame's left edge:
// splits resolved.
MaterialId MaterialAt(const SurfacePlan& plan, uint32_t primitive, double film_x);

// Hits [begin, end) of a batch share a material.
struct MaterialRun {
  MaterialId material;
  const ShadingMaterial* shading;
  size_t begin, end;
  bool interpolated;  // they reflect what was worked out for their mesh's vertices or triangles
};

struct CoatedHits;

struct Surfaces {
  HitBatch hits;
  Surface surface;
  std::vector<MaterialRun> runs;  // those that are not interpolated come first
  size_t lit_runs = 0;            // how many of the runs are not interpolated,
  size_t lit = 0;                 // and how many hits these have
  // What maps have made of the materials: made for the first hit on one with maps.
  std::unique_ptr<HitTextures> textures;
  // Coats over some of the hits: made for the first hit that has one.
  std::unique_ptr<CoatedHits> coats;
};

// Hits on clear coats, each at the place of a hit below it, with a shading normal, maps and lobe of
// its own. The integrator shades them like any others.
struct CoatedHits {
  Surfaces surfaces;  // their Surface::base is what the coat transmits, per channel
  AlignedArray<uint32_t> below{kBatchCapacity};  // by hit on a coat: the index of the hit below it
};

// Whether any hit has a coat.
inline bool AnyCoat(const Surfaces& surfaces) {
  return surfaces.coats && surfaces.coats->surfaces.hits.count > 0;
}

// The runs that lights shine on.
inline std::span<const MaterialRun> LitRuns(const Surfaces& surfaces) {
  return {surfaces.runs.data(), surfaces.lit_runs};
}

// Buffers of ResolveSurfaces.
struct SortRoom {
  // Index into runs, or none, per material of the scene; then the same of interpolated runs.
  std::vector<uint32_t> run_of_material;
  AlignedArray<uint32_t> run_of_hit{kBatchCapacity};
  AlignedArray<uint32_t> order{kBatchCapacity};
};

// Takes the hits over: within a run they are in the order of their rays, so that what a hit's lane
// computes never depends on its neighbours. `film_x`: of each ray, where materials are split.
void ResolveSurfaces(const SurfacePlan& plan, const double* film_x, CameraHits* hits,
                     SortRoom* room, Surfaces* surfaces);

// After the hits of `surfaces` and their runs are there: looks up maps and readies the materials,
// and coats.
void PrepareSurfaces(const SurfacePlan& plan, Surfaces* surfaces);

}  // namespace nacre
