// SPDX-License-Identifier: Apache-2.0
// cli/merge_tiles.h: which files are the tiles of one picture, and what that picture's file says.
#pragma once

#include <string>
#include <vector>

#include "image_io/exr_bands.h"

namespace nacre {

struct Tile {
  std::string path;
  Window rows;  // the part of the frame that it holds
};

struct TilesOfPicture {
  ExrBandHeader whole;      // header of the whole picture
  std::vector<Tile> tiles;  // from the top down; they hold every row once
};

// Reads the headers. Throws Error (kBadInput), naming the files, for tiles that differ in anything
// that decides their pixels, or that do not hold every row of the frame once.
TilesOfPicture FindTiles(const std::vector<std::string>& paths);

}  // namespace nacre
