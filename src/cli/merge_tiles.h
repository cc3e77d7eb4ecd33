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
  ExrBandHeader whole;                // header of the whole picture
  std::vector<Tile> tiles;            // from the top down; they hold every row once
  std::vector<std::string> unproven;  // files without a checksum, all of whose samples were decoded
};

// Reads all of the files. Throws Error (kBadInput), naming them, for tiles that are not what was
// written, that differ in anything that decides their pixels, or that do not hold every row of the
// frame once.
TilesOfPicture FindTiles(const std::vector<std::string>& paths);

}  // namespace nacre
