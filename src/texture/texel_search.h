// SPDX-License-Identifier: Apache-2.0
// texture/texel_search.h: the texels in a pixel's footprint that are rare and unlike the others
// there. Adaptive sampling must not overlook them (render/rare_texels.cc).
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

// A pyramid of the least, the greatest and the mean value of each channel in squares of an image.
// It is made when a footprint first has too many texels to look at each: a scene whose footprints
// are all small does not pay for it.
class TexelExtremes {
 public:
  explicit TexelExtremes(const TexelGrid& image) : image_(image) {}

  struct Level {
    int side;  // width of its squares, in texels
    TexelGrid low, high, mean;
    std::vector<float> values[3];  // storage of these grids
  };
  // The first level has squares of 8x8 texels, each other level squares 8 times as wide as the
  // level before. Makes the levels at the first call; threads may call it at once.
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

// The number by which texels are compared.
struct TexelMeasure {
  enum class Kind : uint8_t {
    kPower,  // the channel to the power of `number`
    kRest,   // 1 minus the channel
    kSolid,  // 1 where the channel is at least `number`, else 0
  };
  Kind kind = Kind::kPower;
  int channel = 0;
  double number = 1;
  // Texels do not matter if together they change the pixel's mean by less than this fraction of it.
  double least_change = 0;
};

// Texels of a pixel that are all brighter, or all darker, than the others by a similar amount.
struct TexelCluster {
  Vec2d offset;  // from the pixel's centre to the most extreme of them, in pixels
  double share;  // fraction of the pixel; a lower bound if squares were searched, not texels
  bool others;   // whether texels that stand out less matter, too
};

// Buffers of FindTexelClusters and FindNormalClusters.
struct TexelSearchRoom {
  // A texel of the footprint, or a square of several.
  struct Place {
    Vec2d begin, end;  // in texels, not wrapped
    Vec2d offset;      // from the pixel's centre to the place's centre, in pixels
    int column, row;
  };
  // The extent and the index of a Place along one axis.
  struct Span {
    double begin, end;
    int index;
  };
  std::vector<Place> places;
  std::vector<Span> columns, rows;
  std::vector<double> low, high;
  std::vector<Vec3d> normals;  // unit vectors, one for each of `places`
};

// Adds the clusters that cover less than half of the footprint, at most two for each measure.
// `extremes` are those of the grid; if null, footprints of thousands of texels are not searched.
void FindTexelClusters(const TexelGrid& grid, const TexelExtremes* extremes,
                       const TexelFootprint& footprint, const std::vector<TexelMeasure>& measures,
                       TexelSearchRoom* room, std::vector<TexelCluster>* clusters);

// Normals are compared by how brightly they reflect one small light to the eye. The normal `ideal`
// mirrors the light; with the angle to `ideal` the brightness falls as GGX's lobe does. Vectors are
// in the frame of the normal map.
struct NormalLobe {
  Vec3d ideal;               // unit vector, at the pixel's centre
  Vec3d ideal_dx, ideal_dy;  // the change of `ideal` from pixel to pixel
  double width;              // the angle, in radians, at which the brightness is a quarter
};

// FindTexelClusters for a normal map; `normal_at` returns the normal at a position in texels. Adds
// at most one cluster for each lobe. Footprints of more than 256 x 256 texels are not searched.
void FindNormalClusters(const TexelGrid& grid, const std::function<Vec3d(const Vec2d&)>& normal_at,
                        const TexelFootprint& footprint, std::span<const NormalLobe> lobes,
                        double least_change, TexelSearchRoom* room,
                        std::vector<TexelCluster>* clusters);

}  // namespace nacre
