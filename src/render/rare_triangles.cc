// SPDX-License-Identifier: Apache-2.0
// render/rare_triangles.cc: finds those of a cell's small triangles (small_triangles.h) that are
// rare features of its pixels, and measures their radiance.
//
// In a finely tessellated mesh all triangles are small and none is rare. Where triangles of one
// material and side cover half of a pixel, or as much of the 3x3 pixels around it as the edge of a
// large object would, samples find them like any large object. The others are probed by a ray
// through the middle of each: hidden ones do not count, and those that look like their surroundings
// do not matter (evidence.h).
#include <algorithm>
#include <array>
#include <bitset>
#include <cmath>
#include <map>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "render/filter_shares.h"
#include "render/interval.h"
#include "render/probes.h"
#include "render/rare_features.h"

namespace nacre {
namespace {

// How many candidates of one appearance are probed in one pixel: no more than the samples that a
// pixel takes before it may stop.
constexpr size_t kMaxProbes = 16;

// Triangles of one appearance are not rare in a pixel if they cover this share of it, because the
// first 16 samples then have kExpectedHits hits on average; nor if they cover this area, in pixels,
// of the 3x3 pixels around it. The straight edge of a large object covers at least three of
// these, a curved one less.
constexpr double kCommonShare = kExpectedHits / 16;
constexpr double kCommonArea = 2.5;

// Pieces of one material and one visible side look alike.
using Appearance = std::pair<uint32_t, bool>;

struct Candidate {
  TrianglePiece piece;
  Appearance appearance;
  std::optional<Rgb> radiance;  // nullopt if it is hidden
};

uint32_t MaterialOf(const Candidate& candidate) { return candidate.appearance.first; }

// The side of a cell with a border of one pixel.
constexpr int kBorderedSide = kCellSize + 2;

Window WithBorder(const Window& cell) {
  return {cell.x0 - 1, cell.y0 - 1, cell.x1 + 1, cell.y1 + 1};
}

template <class Add>
void ForEachPieceShare(const PixelFilter& filter, const Window& cell, const TrianglePiece& piece,
                       const Add& add) {
  ForEachShare(filter, cell, piece.box,
               [&](uint32_t pixel, double share) { add(pixel, share * piece.fill); });
}

using PixelSet = std::bitset<kCellPixels>;

// A number for each pixel of a cell and its border. A piece belongs to the pixel that holds its
// centroid, or to the nearest one.
template <class Number>
struct BorderedCell {
  Number numbers[kBorderedSide][kBorderedSide] = {};

  Number& At(const Window& bordered, const TrianglePiece& piece) {
    const auto place = [](double at, int from) {
      return static_cast<size_t>(std::clamp(std::floor(at) - from, 0.0, kBorderedSide - 1.0));
    };
    return numbers[place(piece.y, bordered.y0)][place(piece.x, bordered.x0)];
  }
};
using PieceCounts = BorderedCell<size_t>;
using CoveredArea = BorderedCell<double>;  // in pixels

// The pixels around which triangles of one appearance cover less than the edge of a large object
// would.
PixelSet FindSparse(const CoveredArea& area) {
  PixelSet sparse;
  for (int row = 0; row < kCellSize; ++row) {
    for (int column = 0; column < kCellSize; ++column) {
      double sum = 0;
      for (int y = row; y < row + 3; ++y) {
        for (int x = column; x < column + 3; ++x) sum += area.numbers[y][x];
      }
      sparse[PixelAt(column, row)] = sum < kCommonArea;
    }
  }
  return sparse;
}

// Calls work(piece, appearance) for the pieces of the cell's small triangles.
template <class Work>
void ForEachCellPiece(const FramePlan& plan, const Window& cell, const Work& work) {
  ForEachPiece(plan.adaptive.small_triangles, plan.surfaces.primitives, MakeProjector(plan.camera),
               cell, [&](const TrianglePiece& piece) {
                 const MaterialId material = MaterialAt(plan.surfaces, piece.primitive, piece.x);
                 work(piece, Appearance{material.index, piece.front});
               });
}

// Whether samples of any pixel of the set may hit the piece.
bool MayAppearIn(const PixelSet& pixels, const PixelFilter& filter, const Window& cell,
                 const TrianglePiece& piece) {
  const Window over = PixelsOver(filter, cell, piece.box);
  for (int y = over.y0; y < over.y1; ++y) {
    for (int x = over.x0; x < over.x1; ++x) {
      if (pixels[PixelAt(x - cell.x0, y - cell.y0)]) return true;
    }
  }
  return false;
}

// The pieces that lie in pixels in which pieces of their appearance are rare, sorted by material.
// This leaves out finely tessellated meshes, of which a pixel may hold thousands of pieces.
std::vector<Candidate> FindCandidates(const FramePlan& plan, const Window& cell) {
  const PixelFilter& filter = plan.scene->image.filter;
  std::map<Appearance, CoveredArea> areas;
  ForEachCellPiece(plan, cell, [&](const TrianglePiece& piece, const Appearance& appearance) {
    areas[appearance].At(WithBorder(cell), piece) += piece.Area();
  });
  std::vector<Candidate> candidates;
  if (areas.empty()) return candidates;
  std::map<Appearance, PixelSet> rare;
  for (const auto& [appearance, area] : areas) rare[appearance] = FindSparse(area);
  std::map<Appearance, std::array<double, kCellPixels>> shares;
  ForEachCellPiece(plan, cell, [&](const TrianglePiece& piece, const Appearance& appearance) {
    if (!MayAppearIn(rare[appearance], filter, cell, piece)) return;
    candidates.push_back({piece, appearance, std::nullopt});
    auto& sums = shares[appearance];
    ForEachPieceShare(filter, cell, piece,
                      [&](uint32_t pixel, double share) { sums[pixel] += share; });
  });
  const double least = plan.adaptive.max_error * kDarkest / (2 * plan.adaptive.brightest);
  for (const auto& [appearance, sums] : shares) {
    for (size_t pixel = 0; pixel < kCellPixels; ++pixel) {
      if (!(sums[pixel] > least && sums[pixel] < kCommonShare)) rare[appearance].reset(pixel);
    }
  }
  std::erase_if(candidates, [&](const Candidate& candidate) {
    return !MayAppearIn(rare[candidate.appearance], filter, cell, candidate.piece);
  });
  std::ranges::stable_sort(candidates, {}, MaterialOf);
  return candidates;
}

// If a pixel holds too many candidates of one appearance, keeps an evenly chosen part of them,
// which represent the others with a larger area.
void ThinOut(const Window& cell, std::vector<Candidate>* candidates) {
  std::map<Appearance, PieceCounts> counts, taken;
  for (const Candidate& candidate : *candidates) {
    ++counts[candidate.appearance].At(WithBorder(cell), candidate.piece);
  }
  std::erase_if(*candidates, [&](Candidate& candidate) {
    TrianglePiece& piece = candidate.piece;
    const size_t count = counts[candidate.appearance].At(WithBorder(cell), piece);
    const size_t number = taken[candidate.appearance].At(WithBorder(cell), piece)++;
    if (count <= kMaxProbes) return false;
    piece.fill *= static_cast<double>(count) / kMaxProbes;
    // Keeps the first of each of kMaxProbes equal parts.
    return number > 0 && number * kMaxProbes / count == (number - 1) * kMaxProbes / count;
  });
}

// Sets the radiance of the candidates that a ray through their centroid hits.
void ProbeAll(const FramePlan& plan, std::vector<Candidate>* candidates, TileWork* work) {
  std::vector<Probe> probes;
  for (const Candidate& candidate : *candidates) {
    probes.push_back({candidate.piece.x, candidate.piece.y, candidate.piece.primitive});
  }
  TraceProbes(plan, false, &probes, work);
  for (size_t i = 0; i < probes.size(); ++i) {
    Candidate& candidate = (*candidates)[i];
    if (probes[i].hit == candidate.piece.primitive) candidate.radiance = probes[i].radiance;
  }
}

// Adds, by pixel, the share and the radiance of the visible candidates, all of one material.
void AddRareTriangles(const PixelFilter& filter, const Window& cell,
                      std::span<const Candidate> candidates, std::vector<RarePart>* rare) {
  struct Sums {
    double share = 0;
    Rgb radiance{0, 0, 0};
  };
  Sums sums[kCellPixels];
  for (const Candidate& candidate : candidates) {
    if (!candidate.radiance) continue;
    ForEachPieceShare(filter, cell, candidate.piece, [&](uint32_t pixel, double share) {
      sums[pixel].share += share;
      sums[pixel].radiance += *candidate.radiance * share;
    });
  }
  for (uint32_t pixel = 0; pixel < kCellPixels; ++pixel) {
    const auto& [share, radiance] = sums[pixel];
    if (share > 0) rare->push_back({pixel, share, radiance});
  }
}

}  // namespace

void FindRareTriangles(const FramePlan& plan, const Window& cell, TileWork* work,
                       std::vector<RarePart>* parts) {
  std::vector<Candidate> candidates = FindCandidates(plan, cell);
  if (candidates.empty()) return;
  ThinOut(cell, &candidates);
  ProbeAll(plan, &candidates, work);
  for (size_t first = 0, end = 0; first < candidates.size(); first = end) {
    const uint32_t material = MaterialOf(candidates[first]);
    while (end < candidates.size() && MaterialOf(candidates[end]) == material) ++end;
    AddRareTriangles(plan.scene->image.filter, cell, {candidates.data() + first, end - first},
                     parts);
  }
  work->clock->Charge(Stage::kSample);
}

}  // namespace nacre
