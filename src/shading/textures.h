// SPDX-License-Identifier: Apache-2.0
// shading/textures.h: textures of a scene: prepared once per plan, and looked up at the hits of a
// batch.
#pragma once

#include "hit/batch.h"
#include "scene/scene.h"
#include "shading/hit_parameters.h"
#include "shading/kept_tables.h"
#include "shading/surface.h"
#include "shading/texture_scene.h"

namespace nacre {

// `threads` is as in ParallelFor. Tangents are taken from `kept`, whose tangents must be of the
// same meshes, or made and added to it. `scene` must outlive the result.
TextureScene PrepareTextures(const Scene& scene, double footprint, int threads, KeptTables* kept);

// Looks up the maps of a run of hits: replaces the shading normals of its hits and surface by those
// of normal and bump maps, sets tangents if the material asks for them, and stores all other
// results in run.textures. The hits must have exact directions.
void TextureHits(const TexturedRun& run);

}  // namespace nacre
