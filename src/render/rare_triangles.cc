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

#include "render/evidence.h"
#include "render/filter_shares.h"
#include "render/interval.h"
#include "sampling/hash.h"

namespace nacre {
namespace {

// Candidates of one look in one pixel that are looked at: no more than the samples that a pixel
// takes before it may stop.
constexpr size_t kMostLooks = 16;

// Samples of one place, where lights are sampled: their mean is to tell how bright it is, which one
// sample need not.
constexpr size_t kSamplesOfLook = 8;

// Of one material, on one side: a pixel with as large a share is found by 16 samples, which expect
// kExpectedHits; and so is one among 3x3 pixels with as much of their area, as beside the straight
// edge of something large, which covers three of them at least: a curved one less.
constexpr double kFoundShare = kExpectedHits / 16;
constexpr double kFoundArea = 2.5;

struct Candidate {
  TrianglePiece piece;
  std::optional<Rgb> radiance;  // none: it is hidden
};

// The cell and a pixel around it, row by row.
constexpr int kSideAround = kCellSize + 2;

Window Around(const Window& cell) { return {cell.x0 - 1, cell.y0 - 1, cell.x1 + 1, cell.y1 + 1}; }

template <class Add>
void ForEachShareOf(const PixelFilter& filter, const Window& cell, const TrianglePiece& piece,
                    const Add& add) {
  ForEachShare(filter, cell, piece.box,
               [&](int column, int row, double share) { add(column, row, share * piece.fill); });
}

// Pixels of a cell.
struct PixelSet {
  bool of[kCellSize][kCellSize] = {};
};

struct SharesOfCell {
  double of[kCellSize][kCellSize] = {};
};

// A number for each pixel of a cell and around it: of pieces, the pixel of their centroid or the
// nearest to it.
template <class Number>
struct NumbersAround {
  Number of[kSideAround][kSideAround] = {};

  Number& At(const Window& around, const TrianglePiece& piece) {
    const auto place = [](double at, int from) {
      return static_cast<size_t>(std::clamp(std::floor(at) - from, 0.0, kSideAround - 1.0));
    };
    return of[place(piece.y, around.y0)][place(piece.x, around.x0)];
  }
};
using CountsAround = NumbersAround<size_t>;

// What triangles of one look cover.
using CoveredArea = NumbersAround<double>;

// The cell's pixels that are not beside as much of such triangles as beside a large thing's edge.
PixelSet FindSparse(const CoveredArea& area) {
  PixelSet sparse;
  for (int row = 0; row < kCellSize; ++row) {
    for (int column = 0; column < kCellSize; ++column) {
      double sum = 0;
      for (int y = row; y < row + 3; ++y) {
        for (int x = column; x < column + 3; ++x) sum += area.of[y][x];
      }
      sparse.of[row][column] = sum < kFoundArea;
    }
  }
  return sparse;
}

// The cell's small triangles, piece by piece, with materials that are no splits.
void ForEachPieceOf(const FramePlan& plan, const Window& cell,
                    const std::function<void(const TrianglePiece&)>& work) {
  ForEachPiece(plan.adaptive.small_triangles, plan.surfaces.primitives, MakeProjector(plan.camera),
               cell, [&](const TrianglePiece& piece) {
                 if (!plan.surfaces.splits) return work(piece);
                 TrianglePiece seen = piece;
                 seen.material = MaterialAt(plan.surfaces, piece.primitive, piece.x).index;
                 work(seen);
               });
}

// What is alike: a material and the side that is seen.
using Look = std::pair<uint32_t, bool>;
Look LookOf(const TrianglePiece& piece) { return {piece.material, piece.front}; }

bool LiesIn(const PixelSet& pixels, const PixelFilter& filter, const Window& cell,
            const TrianglePiece& piece) {
  const Window over = PixelsOver(filter, cell, piece.box);
  for (int y = over.y0; y < over.y1; ++y) {
    for (int x = over.x0; x < over.x1; ++x) {
      if (pixels.of[y - cell.y0][x - cell.x0]) return true;
    }
  }
  return false;
}

// The pieces that lie in pixels in which such pieces are rare, by materials. Those of finely cut
// meshes, of which a pixel may have thousands, are passed over.
std::vector<Candidate> FindCandidates(const FramePlan& plan, const Window& cell) {
  const PixelFilter& filter = plan.scene->image.filter;
  std::map<Look, CoveredArea> areas;
  ForEachPieceOf(plan, cell, [&](const TrianglePiece& piece) {
    areas[LookOf(piece)].At(Around(cell), piece) += piece.Area();
  });
  std::vector<Candidate> candidates;
  if (areas.empty()) return candidates;
  std::map<Look, PixelSet> rare;
  for (const auto& [look, area] : areas) rare[look] = FindSparse(area);
  std::map<Look, SharesOfCell> shares;
  ForEachPieceOf(plan, cell, [&](const TrianglePiece& piece) {
    if (!LiesIn(rare[LookOf(piece)], filter, cell, piece)) return;
    candidates.push_back({piece, std::nullopt});
    SharesOfCell& sums = shares[LookOf(piece)];
    ForEachShareOf(filter, cell, piece,
                   [&](int column, int row, double share) { sums.of[row][column] += share; });
  });
  const double least = plan.adaptive.max_error * kDarkest / (2 * plan.adaptive.brightest);
  for (const auto& [look, sums] : shares) {
    for (int row = 0; row < kCellSize; ++row) {
      for (int column = 0; column < kCellSize; ++column) {
        const double share = sums.of[row][column];
        if (!(share > least && share < kFoundShare)) rare[look].of[row][column] = false;
      }
    }
  }
  std::erase_if(candidates, [&](const Candidate& candidate) {
    return !LiesIn(rare[LookOf(candidate.piece)], filter, cell, candidate.piece);
  });
  std::stable_sort(
      candidates.begin(), candidates.end(),
      [](const Candidate& a, const Candidate& b) { return a.piece.material < b.piece.material; });
  return candidates;
}

// Of many candidates of one look in one pixel some stand for all, evenly among them.
void Thin(const Window& cell, std::vector<Candidate>* candidates) {
  std::map<Look, CountsAround> counts, taken;
  for (const Candidate& candidate : *candidates) {
    ++counts[LookOf(candidate.piece)].At(Around(cell), candidate.piece);
  }
  std::erase_if(*candidates, [&](Candidate& candidate) {
    const TrianglePiece& piece = candidate.piece;
    const size_t count = counts[LookOf(piece)].At(Around(cell), piece);
    const size_t number = taken[LookOf(piece)].At(Around(cell), piece)++;
    if (count <= kMostLooks) return false;
    candidate.piece.fill *= static_cast<double>(count) / kMostLooks;
    // The first of each of as many equal parts as are looked at.
    return number > 0 && number * kMostLooks / count == (number - 1) * kMostLooks / count;
  });
}

void NumberLooks(std::span<const Candidate> candidates, size_t each, SampleNumbers* numbers) {
  numbers->pixel_count = candidates.size();
  for (size_t i = 0; i < candidates.size(); ++i) {
    numbers->seeds[i] = HashCombine(candidates[i].piece.primitive, i);
    for (size_t k = 0; k < each; ++k) {
      numbers->number[each * i + k] = static_cast<uint32_t>(k);
      numbers->pixel[each * i + k] = static_cast<uint32_t>(i);
    }
  }
}

// Looks at the middle of each candidate, `each` times.
void LookAt(const FramePlan& plan, std::span<Candidate> candidates, size_t each, TileWork* work,
            StageClock* clock, RenderStats* stats) {
  TileWork& s = *work;
  for (size_t i = 0; i < candidates.size(); ++i) {
    std::fill_n(s.samples.film.x.data() + each * i, each, candidates[i].piece.x);
    std::fill_n(s.samples.film.y.data() + each * i, each, candidates[i].piece.y);
  }
  s.samples.film.count = each * candidates.size();
  if (plan.sampling.numbered) NumberLooks(candidates, each, &NumbersOf(&s.samples));
  ShadeSamples(plan, &s, clock, stats);
  for (size_t hit = 0; hit < s.surfaces.hits.count; ++hit) {
    Candidate& candidate = candidates[s.surfaces.hits.ray[hit] / each];
    if (s.surfaces.hits.primitive[hit] == candidate.piece.primitive) candidate.radiance = Rgb(0);
  }
  const Layer& beauty = plan.film.layers[0];
  Soa3<double>& values = GatherLayer(plan.film, beauty, 0, BackgroundOf(beauty, plan.film),
                                     BatchOf(plan, s), &s.layer_room);
  for (size_t i = 0; i < candidates.size(); ++i) {
    if (!candidates[i].radiance) continue;
    for (int channel = 0; channel < 3; ++channel) {
      const double* const value = ChannelOf(values, channel).data() + each * i;
      double sum = 0;
      for (size_t k = 0; k < each; ++k) sum += value[k];
      (*candidates[i].radiance)[channel] = sum / static_cast<double>(each);
    }
  }
}

void LookAtAll(const FramePlan& plan, std::vector<Candidate>* candidates, TileWork* work,
               StageClock* clock, RenderStats* stats) {
  const size_t each = plan.sampling.numbered ? kSamplesOfLook : 1;
  const size_t at_once = kBatchCapacity / each;
  for (size_t first = 0; first < candidates->size(); first += at_once) {
    const size_t count = std::min(at_once, candidates->size() - first);
    LookAt(plan, {candidates->data() + first, count}, each, work, clock, stats);
  }
}

// What the candidates that are seen, of one material, have of the cell's pixels.
void AddRare(const PixelFilter& filter, const Window& cell, std::span<const Candidate> candidates,
             std::vector<CellScratch::RareTriangles>* rare) {
  struct Sums {
    double share = 0;
    Rgb radiance{0, 0, 0};
  };
  Sums sums[kCellSize][kCellSize];
  for (const Candidate& candidate : candidates) {
    if (!candidate.radiance) continue;
    ForEachShareOf(filter, cell, candidate.piece, [&](int column, int row, double share) {
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

void FindRareTriangles(const FramePlan& plan, const Window& cell, TileWork* work, CellScratch* c,
                       StageClock* clock, RenderStats* stats) {
  c->rare_triangles.clear();
  std::vector<Candidate> candidates = FindCandidates(plan, cell);
  if (candidates.empty()) return;
  Thin(cell, &candidates);
  LookAtAll(plan, &candidates, work, clock, stats);
  for (size_t first = 0, end = 0; first < candidates.size(); first = end) {
    const uint32_t material = candidates[first].piece.material;
    while (end < candidates.size() && candidates[end].piece.material == material) ++end;
    AddRare(plan.scene->image.filter, cell, {candidates.data() + first, end - first},
            &c->rare_triangles);
  }
  std::stable_sort(c->rare_triangles.begin(), c->rare_triangles.end(),
                   [](const auto& a, const auto& b) { return a.pixel < b.pixel; });
  clock->Charge(Stage::kSample);
}

}  // namespace nacre
