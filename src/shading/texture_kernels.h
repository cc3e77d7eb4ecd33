// SPDX-License-Identifier: Apache-2.0
// shading/texture_kernels.h: the steps of TextureHits (textures.h), each for all hits of a run.
#pragma once

#include "scene/material_parameters.h"
#include "shading/hit_parameters.h"
#include "shading/surface.h"
#include "shading/texture_scene.h"
#include "texture/sample_kernel.h"

namespace nacre {

// Fills point, inverse_size, geometric, side and, if the material is normal-mapped or bump-mapped,
// interpolated_normal (surface_points.cc). On meshes, point and inverse_size are left to
// MakeCoordinates.
void FindPoints(const TexturedRun& run);

// For meshes with their own (u, v): fills u, v and gradients at hits on triangles, before the
// texture's transform (surface_points.cc).
void FindMeshCoordinates(const TexturedRun& run, const PreparedTexture& texture);

// Fills the interpolated frames of a normal map on meshes (surface_points.cc). Returns false if no
// hit has one.
bool FindTangents(const TexturedRun& run, const PreparedTexture& texture);

// Stores interpolated vertex colours in `texels`, white on shapes without them (surface_points.cc).
void FindVertexColors(const TexturedRun& run);

// Fills u, v, gradients and footprints for a texture, at rays from a camera or in cones
// (coordinates_kernel.cc).
void MakeCoordinates(const TexturedRun& run, const PreparedTexture& texture);

// Replace shading normals by normal-mapped ones (normal_map_kernel.cc). MapNormals reads the normal
// map from textures.texels, where the value `middle` stands for 0, and scales its x and y by
// `scale`; `frames` is the result of FindTangents. MapNormalsBySlopes reads the slopes of a bump
// map from x and y of textures.texels, and multiplies them by `distance`.
void MapNormals(const TexturedRun& run, float middle, float scale, bool frames);
void MapNormalsBySlopes(const TexturedRun& run, double distance);

// Sets Surface::tangent by the gradients of the coordinates and, if `frames`, by FindTangents, at
// final shading normals (normal_map_kernel.cc). If `by_map`, red and green of the last texels that
// were looked up are the direction, of which 0.5 stands for 0, before the material's turn.
void StoreTangents(const TexturedRun& run, bool frames, bool by_map);

// Compute HitParameters::numbers (mapped_kernel.cc). StartNumbers sets the material's own
// parameters at every hit, MultiplyNumber multiplies one of them by the last texels that were
// looked up, and FinishNumbers derives the constants of shading and the values of output layers
// from all of them.
void StartNumbers(const TexturedRun& run);
void MultiplyNumber(const TexturedRun& run, const MapTarget& target);
void FinishNumbers(const TexturedRun& run);

}  // namespace nacre
