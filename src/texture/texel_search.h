// SPDX-License-Identifier: Apache-2.0
// texture/texel_search.h: the texels in a pixel's footprint that are rare and unlike the others
// there. Adaptive sampling must not overlook them (render/rare_texels.h).
#pragma once

#include <cstdint>
#include <mutex>
#include <vector>

#include "base/vec.h"
#include "texture/sample.h"

namespace nacre {

// An image, or a mip level of one, and how it is wrapped.
struct TexelGrid {
  TexelView texels;
  Wrap wrap_u = Wrap::kRepeat, wrap_v = Wrap::kRepeat;
};

// The least, the greatest and the mean of the texels, by channel, in squares of an image: a
// pyramid. They are made when a footprint first has too many texels to look at each: a scene whose
// footprints are all small does not pay for them.
class TexelExtremes {
 public:
  explicit TexelExtremes(const TexelGrid& image) : image_(image) {}

  struct Level {
    int side;  // of its squares, in texels
    TexelGrid low, high, mean;
    std::vector<float> values[3];  // of these grids
  };
  // From squares of 8x8 texels on, each level with squares 8 times as wide as the one before.
  const std::vector<Level>& Levels() const;

 private:
  TexelGrid image_;
  mutable std::once_flag made_;
  mutable std::vector<Level> levels_;
};

// A pixel's centre on the grid, in texels and not wrapped, and how it changes from one pixel to the
// next, to the right (x) and downwards (y).
struct TexelFootprint {
  double x, y;
  double x_dx, y_dx, x_dy, y_dy;
};

// What texels are compared by.
struct TexelMeasure {
  enum class Kind : uint8_t {
    kValue,      // the channel itself
    kSharpness,  // its inverse fourth power: of a roughness the height of the lobe's peak
    kSolid,      // 1 where the channel is at least `threshold`, else 0
  };
  Kind kind = Kind::kValue;
  int channel = 0;
  double threshold = 0;
  // Texels do not matter if together they change the pixel's mean by less than this part of it.
  double least_change = 0;
};

// Texels of a pixel that are brighter, or darker, than the others by about as much.
struct TexelCluster {
  Vec2d offset;  // from the pixel's centre to the extreme one of them, in pixels
  double share;  // of the pixel; a lower bound where there are too many texels to look at each
};

// Buffers of FindTexelClusters.
struct TexelSearchRoom {
  // A texel of the footprint, or a square of several.
  struct Place {
    Vec2d center;  // in texels, not wrapped
    Vec2d offset;  // from the pixel's centre to its own, in pixels
    int column, row;
  };
  std::vector<Place> places;
  std::vector<double> low, high;
};

// Adds the clusters that cover less than half of the footprint, at most two of each measure.
// `extremes`: of the grid. Without them footprints of thousands of texels are not searched.
void FindTexelClusters(const TexelGrid& grid, const TexelExtremes* extremes,
                       const TexelFootprint& footprint, const std::vector<TexelMeasure>& measures,
                       TexelSearchRoom* room, std::vector<TexelCluster>* clusters);

}  // namespace nacre
