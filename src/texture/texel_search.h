// SPDX-License-Identifier: Apache-2.0
// texture/texel_search.h: the texels in a pixel's footprint that are rare and unlike the others
// there. Adaptive sampling must not overlook them (render/rare_texels.h).
#pragma once

#include <cstdint>
#include <functional>
#include <mutex>
#include <span>
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
    kPower,  // the channel to the power of `number`
    kRest,   // 1 minus the channel
    kSolid,  // 1 where the channel is at least `number`, else 0
  };
  Kind kind = Kind::kPower;
  int channel = 0;
  double number = 1;
  // Texels do not matter if together they change the pixel's mean by less than this part of it.
  double least_change = 0;
};

// Texels of a pixel that are brighter, or darker, than the others by about as much.
struct TexelCluster {
  Vec2d offset;  // from the pixel's centre to the extreme one of them, in pixels
  double share;  // of the pixel; a lower bound where there are too many texels to look at each
  bool others;   // that stand out less matter, too
};

// Buffers of FindTexelClusters.
struct TexelSearchRoom {
  // A texel of the footprint, or a square of several.
  struct Place {
    Vec2d begin, end;  // in texels, not wrapped
    Vec2d offset;      // from the pixel's centre to its own, in pixels
    int column, row;
  };
  // The same along one axis.
  struct Span {
    double begin, end;
    int index;
  };
  std::vector<Place> places;
  std::vector<Span> columns, rows;
  std::vector<double> low, high;
  std::vector<Vec3d> normals;  // unit, by place
};

// Adds the clusters that cover less than half of the footprint, at most two of each measure.
// `extremes`: of the grid. Without them footprints of thousands of texels are not searched.
void FindTexelClusters(const TexelGrid& grid, const TexelExtremes* extremes,
                       const TexelFootprint& footprint, const std::vector<TexelMeasure>& measures,
                       TexelSearchRoom* room, std::vector<TexelCluster>* clusters);

// What normals are compared by: how brightly they reflect one small light to the eye. The `ideal`
// one mirrors it; with the angle to that one it falls as GGX's lobe does. In the frame of the map.
struct NormalLobe {
  Vec3d ideal;               // unit, at the pixel's centre
  Vec3d ideal_dx, ideal_dy;  // how it changes from pixel to pixel
  double width;              // the angle at which a quarter is left
};

// The same for a map of normals, which `normal_at` tells at places in texels: adds at most one
// cluster of each lobe. Footprints of more than 256 x 256 texels are not searched.
void FindNormalClusters(const TexelGrid& grid, const std::function<Vec3d(const Vec2d&)>& normal_at,
                        const TexelFootprint& footprint, std::span<const NormalLobe> lobes,
                        double least_change, TexelSearchRoom* room,
                        std::vector<TexelCluster>* clusters);

}  // namespace nacre
