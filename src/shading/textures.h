// SPDX-License-Identifier: Apache-2.0
// shading/textures.h: textures of a scene: prepared once per plan, and looked up at the hits of a
// batch.
#pragma once

#include <span>

#include "hit/batch.h"
#include "hit/camera_frame.h"
#include "scene/scene.h"
#include "shading/hit_parameters.h"
#include "shading/kept_tables.h"
#include "shading/surface.h"
#include "shading/texture_scene.h"

namespace nacre {

// `threads` is as in ParallelFor. Tangents are taken from `kept`, whose tangents must be of the
// same meshes, or made and added to it. `scene` must outlive the result.
TextureScene PrepareTextures(const Scene& scene, const CameraFrame& camera, double footprint,
                             int threads, KeptTables* kept);

// Looks up the maps of a run of hits, which are all on one material with maps: replaces the shading
// normals of `hits` and `surface` by those of normal and bump maps, and stores all other results in
// `textures`. `hits` must have exact directions.
void TextureHits(const TexturedRun& run, HitBatch* hits, Surface* surface, HitParameters* textures);

// The following take the unmapped surface, whose normal is Surface::interpolated_normal, as the
// horizon of normal-mapped hits (bsdf.cc).

// Sets the irradiance at hits [begin, end) to 0 where none of the surfaces faces the light.
void HideFacingAway(std::span<const Surface* const> surfaces, size_t begin, size_t end,
                    LightBatch* light);

// Mirrors the hits' directions that lie below the horizon in the unmapped surface, so that none
// does, up to rounding. Directions behind the normal-mapped normal are left as they are.
void RaiseAboveHorizon(const Surface& surface, size_t begin, size_t end, Soa3<float>* to_light);

// Stores the light of the hits, mirrored in the unmapped surface, along unit vectors. Where the
// normal-mapped normal faces the mirrored light, its irradiance is that of `light`; elsewhere the
// irradiance is 0, and the direction the normal itself. Returns whether any irradiance is left.
bool MirrorAtHorizon(const Surface& surface, size_t begin, size_t end, const LightBatch& light,
                     LightBatch* mirrored);

}  // namespace nacre
