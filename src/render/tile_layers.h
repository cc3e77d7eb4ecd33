// render/tile_layers.h: from the radiance of a batch of hits to the film's layers.
#pragma once

#include "render/tile.h"

namespace nacre {

// Adds scratch->single, the reflection of one light, to the light's layer and to the total.
void KeepLightLayer(size_t light_layer, TileScratch* scratch);

// Adds a round's samples to every layer of the tile's film.
void AddToFilm(const RenderPlan& plan, TileScratch* scratch);

// Fills a tile that nothing is hit in, under samples of weight 1, with what its film would resolve
// to: to the bit, because the background is a float and sums of it are exact.
void FillBackground(const RenderPlan& plan, const Window& tile, Strip* strip);

}  // namespace nacre
