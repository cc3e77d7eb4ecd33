// SPDX-License-Identifier: Apache-2.0
// shading/texture_kernels.h: the steps behind textures.h, over the hits of a run.
#pragma once

#include "shading/kernels.h"
#include "shading/textures.h"
#include "texture/sample_kernel.h"

namespace nacre {

// Fills point, inverse_size, geometric, side and, where maps turn normals, unturned
// (surface_points.cc).
void FindPoints(const TexturedRun& run, const HitBatch& hits, HitTextures* textures);

// For meshes with coordinates of their own: u, v and gradients at hits on triangles, before the
// texture's transform (surface_points.cc).
void FindMeshCoordinates(const TexturedRun& run, const PreparedTexture& texture,
                         const HitBatch& hits, HitTextures* textures);

// The frames of a normal map on meshes (surface_points.cc). False if no hit has one.
bool FindTangents(const TexturedRun& run, const PreparedTexture& texture, const HitBatch& hits,
                  HitTextures* textures);

// The colours between vertices, white on what has none, in `texels` (surface_points.cc).
void FindVertexColors(const TexturedRun& run, const HitBatch& hits, HitTextures* textures);

// u, v, gradients and footprints for a texture (coordinates_kernel.cc).
void MakeCoordinates(const TexturedRun& run, const PreparedTexture& texture, const HitBatch& hits,
                     HitTextures* textures);

// Normals turned by textures->texels, of which `middle` counts as 0, or by the slopes in its x and
// y, times `distance` (turn_kernel.cc). `frames`: FindTangents found some.
void TurnNormals(const TexturedRun& run, float middle, float scale, bool frames,
                 const HitTextures& textures, HitBatch* hits, Surface* surface);
void TurnNormalsBySlopes(const TexturedRun& run, double distance, const HitTextures& textures,
                         HitBatch* hits, Surface* surface);

// HitTextures::numbers: the material's own at every hit, then the texels that were looked up last
// multiplied to one of them; and what shading and layers make of all of them (mapped_kernel.cc).
void StartNumbers(const TexturedRun& run, HitTextures* textures);
void MultiplyNumber(const TexturedRun& run, const MapTarget& target, HitTextures* textures);
void FinishNumbers(const TexturedRun& run, HitTextures* textures);

}  // namespace nacre
