// SPDX-License-Identifier: Apache-2.0
#include "render/rare_triangles.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "render/filter_shares.h"
#include "render/interval.h"
#include "render/probes.h"

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

struct Candidate {
  TrianglePiece piece;
  std::optional<Rgb> radiance;  // nullopt if it is hidden
};

// The side of a cell with a border of one pixel.
constexpr int kBorderedSide = kCellSize + 2;

Window WithBorder(const Window& cell) {
  return {cell.x0 - 1, cell.y0 - 1, cell.x1 + 1, cell.y1 + 1};
}

template <class Add>
void ForEachPieceShare(const PixelFilter& filter, const Window& cell, const TrianglePiece& piece,
                       const Add& add) {
  ForEachShare(filter, cell, piece.box,
               [&](int column, int row, double share) { add(column, row, share * piece.fill); });
}

// A set of the cell's pixels, row by row.
struct PixelSet {
  bool has[kCellSize][kCellSize] = {};
};

struct SharesOfCell {
  double share[kCellSize][kCellSize] = {};
};

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
      sparse.has[row][column] = sum < kCommonArea;
    }
  }
  return sparse;
}

// Calls work(piece) for the pieces of the cell's small triangles. Split materials are resolved.
void ForEachCellPiece(const FramePlan& plan, const Window& cell,
                      const std::function<void(const TrianglePiece&)>& work) {
  ForEachPiece(plan.adaptive.small_triangles, plan.surfaces.primitives, MakeProjector(plan.camera),
               cell, [&](const TrianglePiece& piece) {
                 if (!plan.surfaces.splits) return work(piece);
                 TrianglePiece resolved = piece;
                 resolved.material = MaterialAt(plan.surfaces, piece.primitive, piece.x).index;
                 work(resolved);
               });
}

// Pieces of one material and one visible side look alike.
using Appearance = std::pair<uint32_t, bool>;
Appearance AppearanceOf(const TrianglePiece& piece) { return {piece.material, piece.front}; }

// Whether samples of any pixel of the set may hit the piece.
bool MayAppearIn(const PixelSet& pixels, const PixelFilter& filter, const Window& cell,
                 const TrianglePiece& piece) {
  const Window over = PixelsOver(filter, cell, piece.box);
  for (int y = over.y0; y < over.y1; ++y) {
    for (int x = over.x0; x < over.x1; ++x) {
      if (pixels.has[y - cell.y0][x - cell.x0]) return true;
    }
  }
  return false;
}

// The pieces that lie in pixels in which pieces of their appearance are rare, sorted by material.
// This leaves out finely tessellated meshes, of which a pixel may hold thousands of pieces.
std::vector<Candidate> FindCandidates(const FramePlan& plan, const Window& cell) {
  const PixelFilter& filter = plan.scene->image.filter;
  std::map<Appearance, CoveredArea> areas;
  ForEachCellPiece(plan, cell, [&](const TrianglePiece& piece) {
    areas[AppearanceOf(piece)].At(WithBorder(cell), piece) += piece.Area();
  });
  std::vector<Candidate> candidates;
  if (areas.empty()) return candidates;
  std::map<Appearance, PixelSet> rare;
  for (const auto& [appearance, area] : areas) rare[appearance] = FindSparse(area);
  std::map<Appearance, SharesOfCell> shares;
  ForEachCellPiece(plan, cell, [&](const TrianglePiece& piece) {
    if (!MayAppearIn(rare[AppearanceOf(piece)], filter, cell, piece)) return;
    candidates.push_back({piece, std::nullopt});
    SharesOfCell& sums = shares[AppearanceOf(piece)];
    ForEachPieceShare(filter, cell, piece,
                      [&](int column, int row, double share) { sums.share[row][column] += share; });
  });
  const double least = plan.adaptive.max_error * kDarkest / (2 * plan.adaptive.brightest);
  for (const auto& [appearance, sums] : shares) {
    for (int row = 0; row < kCellSize; ++row) {
      for (int column = 0; column < kCellSize; ++column) {
        const double share = sums.share[row][column];
        if (!(share > least && share < kCommonShare)) rare[appearance].has[row][column] = false;
      }
    }
  }
  std::erase_if(candidates, [&](const Candidate& candidate) {
    return !MayAppearIn(rare[AppearanceOf(candidate.piece)], filter, cell, candidate.piece);
  });
  std::stable_sort(
      candidates.begin(), candidates.end(),
      [](const Candidate& a, const Candidate& b) { return a.piece.material < b.piece.material; });
  return candidates;
}

// If a pixel holds too many candidates of one appearance, keeps an evenly chosen part of them,
// which represent the others with a larger area.
void ThinOut(const Window& cell, std::vector<Candidate>* candidates) {
  std::map<Appearance, PieceCounts> counts, taken;
  for (const Candidate& candidate : *candidates) {
    ++counts[AppearanceOf(candidate.piece)].At(WithBorder(cell), candidate.piece);
  }
  std::erase_if(*candidates, [&](Candidate& candidate) {
    const TrianglePiece& piece = candidate.piece;
    const size_t count = counts[AppearanceOf(piece)].At(WithBorder(cell), piece);
    const size_t number = taken[AppearanceOf(piece)].At(WithBorder(cell), piece)++;
    if (count <= kMaxProbes) return false;
    candidate.piece.fill *= static_cast<double>(count) / kMaxProbes;
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
  TraceProbes(plan, &probes, work);
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
  Sums sums[kCellSize][kCellSize];
  for (const Candidate& candidate : candidates) {
    if (!candidate.radiance) continue;
    ForEachPieceShare(filter, cell, candidate.piece, [&](int column, int row, double share) {
      sums[row][column].share += share;
      sums[row][column].radiance += *candidate.radiance * share;
    });
  }
  for (uint32_t pixel = 0; pixel < kCellPixels; ++pixel) {
    const FilmPixel at = PixelOf(cell, pixel);
    const Sums& of_pixel = sums[at.y - cell.y0][at.x - cell.x0];
    if (of_pixel.share > 0) rare->push_back({pixel, of_pixel.share, of_pixel.radiance});
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
    const uint32_t material = candidates[first].piece.material;
    while (end < candidates.size() && candidates[end].piece.material == material) ++end;
    AddRareTriangles(plan.scene->image.filter, cell, {candidates.data() + first, end - first},
                     parts);
  }
  work->clock->Charge(Stage::kSample);
}

}  // namespace nacre
