// render/tile_layers.h: from the radiance of a batch of hits to the film's layers.
#pragma once

#include "render/tile.h"

namespace nacre {

// Whether a layer shows this light (index into Scene::lights) alone.
bool WantsLightLayer(const RenderPlan& plan, size_t light);

// Moves scratch->single, the reflection of one light, to its layer and adds it to the total.
void KeepLightLayer(const RenderPlan& plan, size_t light, TileScratch* scratch);

// Adds a round's samples to every layer.
void AddToFilm(const RenderPlan& plan, const TileRound& round, TileScratch* scratch,
               StripFilm* film);

}  // namespace nacre
