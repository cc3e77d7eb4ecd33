// SPDX-License-Identifier: Apache-2.0
#include "texture/texel_search.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace nacre {
namespace {

using Place = TexelSearchRoom::Place;
using Span = TexelSearchRoom::Span;
using Level = TexelExtremes::Level;

// Footprints of more texels than this are searched by squares.
constexpr double kMaxPlaces = 4096;

// The squares of a level are this many times as wide as those of the level below.
constexpr int kSquareSide = 8;

// The number of octaves of contrast, from the greatest down, in which clusters are sought. Texels
// of less contrast matter only if they cover so much of the pixel that samples find them anyway.
constexpr int kOctaves = 12;

// At the pixel's border, the extreme texel of a square may lie outside of the pixel; then the next
// square is tried, up to this many.
constexpr int kMaxTries = 16;

// The index of the texel at an unwrapped position along one axis.
int WrapTexel(double at, int size, Wrap wrap) {
  return std::min(static_cast<int>(WrapCoordinate(at / size, wrap) * size), size - 1);
}

double TexelsInPixel(const TexelFootprint& f) {
  return std::abs(f.x_dx * f.y_dy - f.x_dy * f.y_dx);
}

// The offset of a position in texels from the pixel's centre, in pixels.
Vec2d OffsetInPixels(const TexelFootprint& f, double x, double y) {
  const double determinant = f.x_dx * f.y_dy - f.x_dy * f.y_dx;
  return {(f.y_dy * (x - f.x) - f.x_dy * (y - f.y)) / determinant,
          (f.x_dx * (y - f.y) - f.y_dx * (x - f.x)) / determinant};
}

// Half the sides of the box around the footprint, in texels.
Vec2d HalfBox(const TexelFootprint& f) {
  return {(std::abs(f.x_dx) + std::abs(f.x_dy)) / 2, (std::abs(f.y_dx) + std::abs(f.y_dy)) / 2};
}

// An estimate of the number of squares, `side` texels wide, that overlap that box.
double CountPlaces(const TexelGrid& grid, const TexelFootprint& f, int side) {
  const Vec2d half = HalfBox(f);
  return (2 * half.x / std::min(side, grid.texels.width) + 1) *
         (2 * half.y / std::min(side, grid.texels.height) + 1);
}

// Finds the squares along one axis that overlap [begin, end], in texels and not wrapped. In each
// repetition of the image they are counted from the image's first texel, and the last may be cut.
void FindSpans(double begin, double end, int side, int size, Wrap wrap, std::vector<Span>* spans) {
  spans->clear();
  const int count = (size + side - 1) / side;
  for (double first = std::floor(begin / size) * size; first < end; first += size) {
    // Beyond the edges, only the texels on the edge are repeated, and no square describes those.
    if (wrap == Wrap::kClamp && first != 0 && side > 1) continue;
    const bool mirrored = wrap == Wrap::kMirror && std::fmod(first / size, 2) != 0;
    const double origin = mirrored ? first + size - double{1} * count * side : first;
    for (double k = std::max(std::floor((begin - origin) / side), 0.0); k < count; ++k) {
      const Span span{std::max(origin + k * side, first),
                      std::min(origin + (k + 1) * side, first + size), 0};
      if (span.begin >= end) break;
      if (span.end <= begin) continue;
      const double center = (span.begin + span.end) / 2;
      spans->push_back({span.begin, span.end, WrapTexel(center, size, wrap) / side});
    }
  }
}

// Whether the centre of a texel (side = 1) lies in the pixel, or a square (side > 1) overlaps it.
bool IsInPixel(const TexelFootprint& f, const Place& place, int side) {
  const Vec2d half = side == 1 ? Vec2d(0) : (place.end - place.begin) / 2;
  const double texels = TexelsInPixel(f);
  const double most_dx = 0.5 + (std::abs(f.y_dy) * half.x + std::abs(f.x_dy) * half.y) / texels;
  const double most_dy = 0.5 + (std::abs(f.y_dx) * half.x + std::abs(f.x_dx) * half.y) / texels;
  return std::abs(place.offset.x) <= most_dx && std::abs(place.offset.y) <= most_dy;
}

// Calls use(place) for each texel, or square, that overlaps a box and is in the pixel.
template <class Use>
void ForEachPlace(const TexelGrid& grid, const TexelFootprint& f, const Vec2d& begin,
                  const Vec2d& end, int side, TexelSearchRoom* room, const Use& use) {
  FindSpans(begin.x, end.x, side, grid.texels.width, grid.wrap_u, &room->columns);
  FindSpans(begin.y, end.y, side, grid.texels.height, grid.wrap_v, &room->rows);
  for (const Span& row : room->rows) {
    for (const Span& column : room->columns) {
      Place place{{column.begin, row.begin}, {column.end, row.end}, {}, column.index, row.index};
      const Vec2d center = (place.begin + place.end) / 2;
      place.offset = OffsetInPixels(f, center.x, center.y);
      if (IsInPixel(f, place, side)) use(place);
    }
  }
}

void FindPlaces(const TexelGrid& grid, const TexelFootprint& f, int side, TexelSearchRoom* room) {
  room->places.clear();
  const Vec2d center(f.x, f.y), half = HalfBox(f);
  ForEachPlace(grid, f, center - half, center + half, side, room,
               [&](const Place& place) { room->places.push_back(place); });
}

double Measure(const TexelMeasure& measure, const TexelGrid& grid, int x, int y) {
  const double value = grid.texels.At(x, y, measure.channel);
  switch (measure.kind) {
    case TexelMeasure::Kind::kRest:
      return 1 - value;
    case TexelMeasure::Kind::kSolid:
      return value >= measure.number ? 1 : 0;
    default:
      if (measure.number == 1) return value;
      return std::pow(std::max(value, 1e-15), measure.number);  // so that inverses stay finite
  }
}

// Whether the measure is greatest where the channel is.
bool Ascends(const TexelMeasure& measure) {
  return measure.kind == TexelMeasure::Kind::kSolid ||
         (measure.kind == TexelMeasure::Kind::kPower && measure.number > 0);
}

struct Found {
  Place place;
  double measure;
};

// Finds the texel with the greatest or the least measure among the texels of a square of
// `levels[level]` that are in the pixel, as far as the pyramid tells. If none of them is in the
// pixel, the measure is `none`.
Found FindExtremeTexel(const TexelGrid& image, const TexelFootprint& f,
                       const std::vector<Level>& levels, size_t level, const Place& square,
                       const TexelMeasure& measure, bool greatest, double none,
                       TexelSearchRoom* room) {
  const bool high = greatest == Ascends(measure);
  Found found{square, none};
  for (size_t l = level + 1; l-- > 0;) {
    const TexelGrid& parts = l == 0 ? image : high ? levels[l - 1].high : levels[l - 1].low;
    bool any = false;
    const Vec2d begin = found.place.begin, end = found.place.end;
    ForEachPlace(image, f, begin, end, levels[l].side / kSquareSide, room, [&](const Place& part) {
      const double value = Measure(measure, parts, part.column, part.row);
      if (any && !(greatest ? value > found.measure : value < found.measure)) return;
      any = true;
      found = {part, value};
    });
    if (!any) return {square, none};
  }
  return found;
}

struct Extreme {
  size_t place;  // the place of greatest contrast
  double share;  // fraction of the pixel with a similar contrast; 0: it does not matter
  bool others;   // places of less contrast would matter even without these
};

// Finds the places of greatest contrast on one side of the mean (1: above it, -1: below) that
// together change the mean by the fraction `least_change`. `texels` is the number of texels in the
// pixel.
Extreme FindExtreme(const std::vector<double>& values, double mean, double side, double texels,
                    double least_change) {
  size_t extreme = 0;
  for (size_t i = 1; i < values.size(); ++i) {
    if (side * (values[i] - values[extreme]) > 0) extreme = i;
  }
  const double span = side * (values[extreme] - mean);
  if (!(span > 0)) return {0, 0, false};
  double counts[kOctaves] = {}, sums[kOctaves] = {};
  for (const double value : values) {
    const double contrast = side * (value - mean) / span;
    const int octave = contrast > 0 ? -std::ilogb(contrast) : kOctaves;
    if (octave >= kOctaves) continue;
    counts[octave] += 1;
    sums[octave] += contrast;
  }
  const double all = std::accumulate(sums, sums + kOctaves, 0.0);
  const double least = least_change * std::abs(mean) * texels / span;
  double count = 0, sum = 0;
  for (int octave = 0; octave < kOctaves; ++octave) {
    count += counts[octave];
    sum += sums[octave];
    if (sum > least) return {extreme, count / texels, all - sum > least};
  }
  return {0, 0, false};
}

// Footprints of more texels than this are not searched for normals.
constexpr double kMaxNormals = 256 * 256;

// Whether the pixel holds so many texels that some may be rare, and not an unreasonable number.
// False, too, if the footprint is not finite.
bool HoldsTexels(const TexelFootprint& f, double texels) {
  return texels > 2 && texels < 1e15 && std::abs(f.x) < 1e15 && std::abs(f.y) < 1e15;
}

// Makes the next level of a pyramid: each of its values is made by `join` from a square of `from`.
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
  if (!HoldsTexels(f, texels)) return;
  if (grid.texels.width == 1 && grid.texels.height == 1) return;
  std::vector<Place>& places = room->places;
  const std::vector<Level>* levels = nullptr;
  size_t level = 0;
  if (CountPlaces(grid, f, 1) <= kMaxPlaces) {
    FindPlaces(grid, f, 1, room);
    texels = static_cast<double>(places.size());
  } else {
    if (extremes == nullptr) return;
    levels = &extremes->Levels();
    while (level + 1 < levels->size() && CountPlaces(grid, f, (*levels)[level].side) > kMaxPlaces)
      ++level;
    const int side = (*levels)[level].side;
    if (CountPlaces(grid, f, side) <= kMaxPlaces) {
      FindPlaces(grid, f, side, room);
    } else {
      // The image is repeated very often in the pixel: one copy, in its middle, is enough.
      texels = double{1} * grid.texels.width * grid.texels.height;
      const double period_x = 2.0 * grid.texels.width;
      const double period_y = 2.0 * grid.texels.height;  // periods of mirrored images
      const Vec2d first(std::floor(f.x / period_x) * period_x,
                        std::floor(f.y / period_y) * period_y);
      places.assign(1, {first, first + Vec2d(grid.texels.width, grid.texels.height), {}, 0, 0});
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
      std::vector<double>& values = greatest && levels != nullptr ? room->high : room->low;
      for (int tries = 0; tries < kMaxTries; ++tries) {
        const Extreme extreme =
            FindExtreme(values, mean, greatest ? 1 : -1, texels, measure.least_change);
        if (!(extreme.share > 0 && extreme.share < 0.5)) break;
        const Place& place = places[extreme.place];
        const Found texel = levels == nullptr ? Found{place, values[extreme.place]}
                                              : FindExtremeTexel(grid, f, *levels, level, place,
                                                                 measure, greatest, mean, room);
        if (texel.measure == values[extreme.place]) {
          clusters->push_back({texel.place.offset, extreme.share, extreme.others});
          break;
        }
        values[extreme.place] = texel.measure;  // the square's extreme is outside of the pixel
      }
    }
  }
}

void FindNormalClusters(const TexelGrid& grid, const std::function<Vec3d(const Vec2d&)>& normal_at,
                        const TexelFootprint& f, std::span<const NormalLobe> lobes,
                        double least_change, TexelSearchRoom* room,
                        std::vector<TexelCluster>* clusters) {
  if (!HoldsTexels(f, TexelsInPixel(f)) || CountPlaces(grid, f, 1) > kMaxNormals) return;
  std::vector<Place>& places = room->places;
  FindPlaces(grid, f, 1, room);
  if (places.empty()) return;
  room->normals.clear();
  for (const Place& place : places)
    room->normals.push_back(normal_at((place.begin + place.end) / 2).normalized());
  const auto count = static_cast<double>(places.size());
  for (const NormalLobe& lobe : lobes) {
    std::vector<double>& values = room->high;
    values.clear();
    double sum = 0;
    for (size_t i = 0; i < places.size(); ++i) {
      const Vec2d& offset = places[i].offset;
      const Vec3d ideal = lobe.ideal + lobe.ideal_dx * offset.x + lobe.ideal_dy * offset.y;
      const double off = (room->normals[i] - ideal).length2() / (lobe.width * lobe.width);
      values.push_back(1 / ((1 + off) * (1 + off)));
      sum += values.back();
    }
    const Extreme extreme = FindExtreme(values, sum / count, 1, count, least_change);
    if (!(extreme.share > 0 && extreme.share < 0.5)) continue;
    clusters->push_back({places[extreme.place].offset, extreme.share, extreme.others});
  }
}

}  // namespace nacre
