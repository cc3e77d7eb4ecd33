// SPDX-License-Identifier: Apache-2.0
// cli/merge_tiles.h: checks that files are the tiles of one picture, and makes that picture's
// header.
#pragma once

#include <string>
#include <vector>

#include "image_io/exr_bands.h"

namespace nacre {

struct Tile {
  std::string path;
  Window rows;  // the rows of the frame that it holds
};

struct TilesOfPicture {
  ExrBandHeader whole;                // header of the whole picture
  std::vector<Tile> tiles;            // from the top down; they hold every row once
  std::vector<std::string> unproven;  // files without a checksum, which were checked by decoding
                                      // all samples
};

// Reads all of the files. Throws Error (kBadInput), naming the files, for tiles that are damaged,
// that differ in anything that affects their pixels, or that do not hold every row of the frame
// exactly once.
TilesOfPicture FindTiles(const std::vector<std::string>& paths);

}  // namespace nacre
