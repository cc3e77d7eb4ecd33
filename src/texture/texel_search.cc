// SPDX-License-Identifier: Apache-2.0
#include "texture/texel_search.h"

#include <algorithm>
#include <cmath>

namespace nacre {
namespace {

using Place = TexelSearchRoom::Place;
using Level = TexelExtremes::Level;

// Footprints of more texels are searched by squares.
constexpr double kMaxPlaces = 4096;

// Squares of a level are so many times as wide as those of the level below.
constexpr int kSquareSide = 8;

// Clusters are sought by halving their contrast this many times: what has less contrast matters
// only if it covers so much of the pixel that samples find it.
constexpr int kOctaves = 12;

// The texel at an unwrapped place along one axis.
int WrapTexel(double at, int size, Wrap wrap) {
  return std::min(static_cast<int>(WrapCoordinate(at / size, wrap) * size), size - 1);
}

double TexelsInPixel(const TexelFootprint& f) {
  return std::abs(f.x_dx * f.y_dy - f.x_dy * f.y_dx);
}

// The offset of a place from the pixel's centre, in pixels.
Vec2d OffsetInPixels(const TexelFootprint& f, double x, double y) {
  const double determinant = f.x_dx * f.y_dy - f.x_dy * f.y_dx;
  return {(f.y_dy * (x - f.x) - f.x_dy * (y - f.y)) / determinant,
          (f.x_dx * (y - f.y) - f.y_dx * (x - f.x)) / determinant};
}

// Half the sides of the box around the footprint, in texels.
Vec2d HalfBox(const TexelFootprint& f) {
  return {(std::abs(f.x_dx) + std::abs(f.x_dy)) / 2, (std::abs(f.y_dx) + std::abs(f.y_dy)) / 2};
}

// About how many squares of this side, in texels, overlap that box.
double CountPlaces(const TexelFootprint& f, int side) {
  const Vec2d half = HalfBox(f);
  return (2 * half.x / side + 1) * (2 * half.y / side + 1);
}

// The texels whose centres lie in the pixel, or the squares (side > 1) that overlap it.
void FindPlaces(const TexelGrid& grid, const TexelFootprint& f, int side,
                std::vector<Place>* places) {
  places->clear();
  const Vec2d half = HalfBox(f);
  const double beyond = side > 1 ? side / 2.0 : 0;  // how far its centre may lie outside
  const double in_pixels = beyond / TexelsInPixel(f);
  const double most_dx = 0.5 + in_pixels * (std::abs(f.y_dy) + std::abs(f.x_dy));
  const double most_dy = 0.5 + in_pixels * (std::abs(f.y_dx) + std::abs(f.x_dx));
  const auto first = [&](double at, double reach) {
    return std::ceil((at - reach - beyond) / side - 0.5);
  };
  for (double row = first(f.y, half.y); (row + 0.5) * side <= f.y + half.y + beyond; ++row) {
    const double y = (row + 0.5) * side;
    const int texel_y = WrapTexel(y, grid.texels.height, grid.wrap_v);
    for (double column = first(f.x, half.x); (column + 0.5) * side <= f.x + half.x + beyond;
         ++column) {
      const double x = (column + 0.5) * side;
      const Vec2d offset = OffsetInPixels(f, x, y);
      if (!(std::abs(offset.x) <= most_dx && std::abs(offset.y) <= most_dy)) continue;
      const int texel_x = WrapTexel(x, grid.texels.width, grid.wrap_u);
      places->push_back({{x, y}, offset, texel_x / side, texel_y / side});
    }
  }
}

double Measure(const TexelMeasure& measure, const TexelGrid& grid, int x, int y) {
  const double value = grid.texels.At(x, y, measure.channel);
  switch (measure.kind) {
    case TexelMeasure::Kind::kSharpness: {
      const double square = std::max(value * value, 1e-30);  // so that the inverse stays finite
      return 1 / (square * square);
    }
    case TexelMeasure::Kind::kSolid:
      return value >= measure.threshold ? 1 : 0;
    default:
      return value;
  }
}

// Whether the measure is greatest where the channel is.
bool Ascends(const TexelMeasure& measure) { return measure.kind != TexelMeasure::Kind::kSharpness; }

// The centre of the texel that has the greatest or the least measure in a square of
// `levels[level]`.
Vec2d FindExtremeTexel(const TexelGrid& image, const std::vector<Level>& levels, size_t level,
                       const Place& square, const TexelMeasure& measure, bool greatest) {
  const bool high = greatest == Ascends(measure);
  Vec2d center = square.center;
  for (size_t l = level + 1; l-- > 0;) {
    const int side = levels[l].side / kSquareSide;
    const TexelGrid& parts = l == 0 ? image : high ? levels[l - 1].high : levels[l - 1].low;
    const Vec2d first = center - Vec2d(side * (kSquareSide - 1) / 2.0);
    double best = 0;
    for (int k = 0; k < kSquareSide * kSquareSide; ++k) {
      const Vec2d at = first + Vec2d(k % kSquareSide * side, k / kSquareSide * side);
      const int x = WrapTexel(at.x, image.texels.width, image.wrap_u) / side;
      const int y = WrapTexel(at.y, image.texels.height, image.wrap_v) / side;
      const double value = Measure(measure, parts, x, y);
      if (k > 0 && !(greatest ? value > best : value < best)) continue;
      best = value;
      center = at;
    }
  }
  return center;
}

struct Extreme {
  size_t place;
  double share;  // of the pixel, of what looks like it; 0: it does not matter
};

// Of what lies on one side of the mean (1: above it, -1: below): the places of greatest contrast
// that together change the mean by `least_change` of it. `texels`: in the pixel.
Extreme FindExtreme(const std::vector<double>& values, double mean, double side, double texels,
                    double least_change) {
  size_t extreme = 0;
  for (size_t i = 1; i < values.size(); ++i) {
    if (side * (values[i] - values[extreme]) > 0) extreme = i;
  }
  const double span = side * (values[extreme] - mean);
  if (!(span > 0)) return {0, 0};
  double counts[kOctaves] = {}, sums[kOctaves] = {};
  for (const double value : values) {
    const double contrast = side * (value - mean) / span;
    const int octave = contrast > 0 ? -std::ilogb(contrast) : kOctaves;
    if (octave >= kOctaves) continue;
    counts[octave] += 1;
    sums[octave] += contrast;
  }
  double count = 0, sum = 0;
  for (int octave = 0; octave < kOctaves; ++octave) {
    count += counts[octave];
    sum += sums[octave];
    if (sum * span > least_change * std::abs(mean) * texels) return {extreme, count / texels};
  }
  return {0, 0};
}

// The next level of a pyramid: of squares of `from`, the value that `join` makes of theirs.
template <class Join>
TexelGrid Reduce(const TexelGrid& from, const Join& join, std::vector<float>* values) {
  const TexelView& f = from.texels;
  const int width = (f.width + kSquareSide - 1) / kSquareSide;
  const int height = (f.height + kSquareSide - 1) / kSquareSide;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const int end_x = std::min((x + 1) * kSquareSide, f.width);
      const int end_y = std::min((y + 1) * kSquareSide, f.height);
      for (int c = 0; c < f.channels; ++c) {
        float joined = f.At(x * kSquareSide, y * kSquareSide, c);
        int count = 0;
        for (int j = y * kSquareSide; j < end_y; ++j) {
          for (int i = x * kSquareSide; i < end_x; ++i)
            joined = join(joined, f.At(i, j, c), count++);
        }
        values->push_back(joined);
      }
    }
  }
  return {{TexelKind::kFloats, values->data(), nullptr, f.channels, width, height},
          from.wrap_u,
          from.wrap_v};
}

}  // namespace

const std::vector<Level>& TexelExtremes::Levels() const {
  std::call_once(made_, [this] {
    TexelGrid low = image_, high = image_, mean = image_;
    for (int side = kSquareSide; low.texels.width > 1 || low.texels.height > 1;
         side *= kSquareSide) {
      Level level{side, {}, {}, {}, {}};
      low = level.low = Reduce(
          low, [](float a, float b, int) { return std::min(a, b); }, &level.values[0]);
      high = level.high = Reduce(
          high, [](float a, float b, int) { return std::max(a, b); }, &level.values[1]);
      mean = level.mean = Reduce(
          mean, [](float a, float b, int n) { return a + (b - a) / static_cast<float>(n + 1); },
          &level.values[2]);
      levels_.push_back(std::move(level));
    }
  });
  return levels_;
}

void FindTexelClusters(const TexelGrid& grid, const TexelExtremes* extremes,
                       const TexelFootprint& f, const std::vector<TexelMeasure>& measures,
                       TexelSearchRoom* room, std::vector<TexelCluster>* clusters) {
  double texels = TexelsInPixel(f);
  // Also if it is not finite.
  if (!(texels > 2 && texels < 1e15 && std::abs(f.x) < 1e15 && std::abs(f.y) < 1e15)) return;
  if (grid.texels.width == 1 && grid.texels.height == 1) return;
  std::vector<Place>& places = room->places;
  const std::vector<Level>* levels = nullptr;
  size_t level = 0;
  if (CountPlaces(f, 1) <= kMaxPlaces) {
    FindPlaces(grid, f, 1, &places);
    texels = static_cast<double>(places.size());
  } else {
    if (extremes == nullptr) return;
    levels = &extremes->Levels();
    while (level + 1 < levels->size() && CountPlaces(f, (*levels)[level].side) > kMaxPlaces)
      ++level;
    const int side = (*levels)[level].side;
    if (CountPlaces(f, side) <= kMaxPlaces) {
      FindPlaces(grid, f, side, &places);
    } else {
      // The image is repeated very often in the pixel: once, in its middle, is enough.
      texels = double{1} * grid.texels.width * grid.texels.height;
      const double period_x = 2.0 * grid.texels.width;
      const double period_y = 2.0 * grid.texels.height;  // if mirrored
      const Vec2d first(std::floor(f.x / period_x) * period_x,
                        std::floor(f.y / period_y) * period_y);
      places.assign(1, {first + Vec2d(side / 2.0), Vec2d(0), 0, 0});
    }
  }
  if (places.empty()) return;  // the footprint is a thin strip between the texels' centres
  for (const TexelMeasure& measure : measures) {
    room->low.clear();
    room->high.clear();
    double sum = 0;
    for (const Place& place : places) {
      const auto of = [&](const TexelGrid& from) {
        return Measure(measure, from, place.column, place.row);
      };
      if (levels == nullptr) {
        const double value = of(grid);
        room->low.push_back(value);
        sum += value;
      } else {
        const Level& l = (*levels)[level];
        room->low.push_back(of(Ascends(measure) ? l.low : l.high));
        room->high.push_back(of(Ascends(measure) ? l.high : l.low));
        sum += of(l.mean);
      }
    }
    const double mean = sum / static_cast<double>(places.size());
    for (const bool greatest : {true, false}) {
      const Extreme extreme = FindExtreme(greatest && levels != nullptr ? room->high : room->low,
                                          mean, greatest ? 1 : -1, texels, measure.least_change);
      if (!(extreme.share > 0 && extreme.share < 0.5)) continue;
      const Place& place = places[extreme.place];
      Vec2d offset = place.offset;
      if (levels != nullptr) {
        const Vec2d at = FindExtremeTexel(grid, *levels, level, place, measure, greatest);
        offset = OffsetInPixels(f, at.x, at.y);
      }
      clusters->push_back({offset, extreme.share});
    }
  }
}

}  // namespace nacre
