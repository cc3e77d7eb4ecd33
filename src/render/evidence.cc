// SPDX-License-Identifier: Apache-2.0
#include "render/evidence.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <vector>

namespace nacre {
namespace {

// Of the pixels 95 % are to be within the wanted error.
constexpr double kMayBeBeyond = 0.05;

// What a pixel's samples hit: misses see the background alone.
enum Kind : uint8_t { kMisses, kMixed, kHits };

struct PixelEvidence {
  uint32_t pixel;
  Kind kind;
  double contrast;  // of its samples, in its widest channel
  double single;    // from its least or greatest sample to the next: what only one has met
  bool isolated;    // its neighbours do not explain the contrast
};

bool IsOpen(const CellScratch& c, uint32_t pixel) {
  return (c.outlines_only >> pixel / kBlockPixels & 1) == 0;
}

// Rows and columns in the cell, whose blocks lie row by row.
struct CellPlace {
  int column, row;
};

CellPlace PlaceInCell(uint32_t pixel) {
  constexpr uint32_t kAcross = kCellSize / kBlockSide;
  constexpr auto kPixels = static_cast<uint32_t>(kBlockPixels);
  const uint32_t block = pixel / kPixels, in_block = pixel % kPixels;
  return {static_cast<int>(block % kAcross * kBlockSide + in_block % kBlockSide),
          static_cast<int>(block / kAcross * kBlockSide + in_block / kBlockSide)};
}

uint32_t PixelAt(const CellPlace& place) {
  constexpr int kAcross = kCellSize / kBlockSide;
  const int block = place.row / kBlockSide * kAcross + place.column / kBlockSide;
  const int in_block = place.row % kBlockSide * kBlockSide + place.column % kBlockSide;
  return static_cast<uint32_t>(block * static_cast<int>(kBlockPixels) + in_block);
}

double MeanOf(const CellScratch& c, uint32_t pixel, size_t channel) {
  double sum = 0;
  for (const auto& replicate : c.replicate) sum += replicate[channel][pixel];
  return sum / (double{kReplicates} * c.samples[pixel]);
}

Kind KindOf(const CellScratch& c, uint32_t pixel) {
  double hits = 0;
  for (const auto& replicate : c.replicate) hits += replicate[kAlphaSum][pixel];
  const double samples = double{kReplicates} * c.samples[pixel];
  // Weights round.
  if (std::abs(hits) < 1e-6 * samples) return kMisses;
  return std::abs(hits - samples) < 1e-6 * samples ? kHits : kMixed;
}

double SamplesTaken(const CellScratch& c, uint32_t pixel) {
  return double{kReplicates} * c.samples[pixel];
}

double WantedOf(const CellScratch& c, uint32_t pixel) {
  return c.intervals[pixel / kBlockPixels].wanted[pixel % kBlockPixels];
}

// The least and the greatest mean of the pixel and those around it in the cell.
PixelRange MeansAround(const CellScratch& c, uint32_t pixel, size_t channel) {
  const CellPlace at = PlaceInCell(pixel);
  PixelRange range{std::numeric_limits<double>::infinity(),
                   -std::numeric_limits<double>::infinity()};
  for (int row = std::max(at.row - 1, 0); row <= std::min(at.row + 1, kCellSize - 1); ++row) {
    for (int column = std::max(at.column - 1, 0); column <= std::min(at.column + 1, kCellSize - 1);
         ++column) {
      const uint32_t other = PixelAt({column, row});
      if (c.samples[other] == 0) continue;
      const double mean = MeanOf(c, other, channel);
      range.low = std::min(range.low, mean);
      range.high = std::max(range.high, mean);
    }
  }
  return range;
}

// Whether what the pixel's samples differ by is more than twice that of the means around it: of an
// edge between two parts of the picture, both sides are seen there.
bool IsIsolated(const CellScratch& c, uint32_t pixel, size_t channel, double contrast) {
  const PixelRange means = MeansAround(c, pixel, channel);
  return 2 * (means.high - means.low) < contrast;
}

PixelEvidence EvidenceOf(const CellScratch& c, uint32_t pixel) {
  PixelEvidence evidence{pixel, KindOf(c, pixel), 0, 0, false};
  size_t widest = 0;
  for (size_t channel = 0; channel < 3; ++channel) {
    const double low1 = c.low1[channel][pixel], low2 = c.low2[channel][pixel];
    const double high2 = c.high2[channel][pixel], high1 = c.high1[channel][pixel];
    evidence.single = std::max({evidence.single, low2 - low1, high1 - high2});
    if (!(high1 - low1 > evidence.contrast)) continue;
    evidence.contrast = high1 - low1;
    widest = channel;
  }
  evidence.isolated = evidence.contrast > 0 && IsIsolated(c, pixel, widest, evidence.contrast);
  return evidence;
}

// What pixels of some kinds tell of one another.
struct Pool {
  double contrast = 0;  // mean of the witnesses' (evidence.h), by one sample each
  double share = 0;     // of the pixels that are witnesses
};

// All pixels but those at the cell's border, whose neighbours are not known.
bool IsInner(uint32_t pixel) {
  const CellPlace at = PlaceInCell(pixel);
  return at.column > 0 && at.row > 0 && at.column + 1 < kCellSize && at.row + 1 < kCellSize;
}

// Whether what is known beforehand of the pixel matters for it.
bool HasKnownRare(const CellScratch& c, uint32_t pixel) { return c.known_rare[pixel] > 0; }

// By how much the pixel's mean is wrong if no sample has hit these triangles, as far as they are
// darker or brighter than all that is seen around: else they are the edge of something.
double ContrastOf(const CellScratch& c, const CellScratch::RareTriangles& rare) {
  double contrast = 0;
  for (size_t channel = 0; channel < 3; ++channel) {
    const PixelRange around = MeansAround(c, rare.pixel, channel);
    const double radiance = rare.radiance[static_cast<int>(channel)];
    contrast = std::max(
        {contrast, radiance - rare.share * around.high, rare.share * around.low - radiance});
  }
  return contrast;
}

// The triangles of one pixel matter together. Those of which all together cannot matter ask for
// nothing: a part of what is wanted, divided by their number, each.
void AddKnownTriangles(std::span<const CellScratch::RareTriangles> of_pixel, CellScratch* c) {
  const uint32_t pixel = of_pixel[0].pixel;
  const double wanted = WantedOf(*c, pixel);
  double all = 0;
  for (const auto& rare : of_pixel) all += ContrastOf(*c, rare);
  if (!(2 * all > wanted)) return;
  const auto count = static_cast<double>(of_pixel.size());
  for (const auto& rare : of_pixel) {
    if (!(2 * count * ContrastOf(*c, rare) > wanted)) continue;
    c->known_rare[pixel] = std::max(c->known_rare[pixel], kExpectedHits / rare.share);
  }
}

// Sets known_rare, of pixels with samples.
void FindKnownRare(CellScratch* c) {
  for (uint32_t pixel = 0; pixel < kCellPixels; ++pixel) {
    const bool matters = 2 * c->rare_radiance[pixel] > WantedOf(*c, pixel);
    c->known_rare[pixel] = matters ? c->rare_samples[pixel] : 0;
  }
  const auto& all = c->rare_triangles;
  for (size_t first = 0, end = 0; first < all.size(); first = end) {
    const uint32_t pixel = all[first].pixel;
    while (end < all.size() && all[end].pixel == pixel) ++end;
    if (c->samples[pixel] > 0) AddKnownTriangles({all.data() + first, end - first}, c);
  }
}

// Pixels of the kind `left_out` tell nothing, nor do those in which what is rare is known
// beforehand: that is known of all pixels that have it.
Pool PoolOf(const CellScratch& c, const std::vector<PixelEvidence>& all, Kind left_out) {
  Pool pool;
  size_t inner = 0, witnesses = 0;
  for (const PixelEvidence& e : all) {
    if (e.kind == left_out || !IsInner(e.pixel) || HasKnownRare(c, e.pixel)) continue;
    ++inner;
    if (!e.isolated || e.single <= WantedOf(c, e.pixel)) continue;
    pool.contrast += e.single;
    ++witnesses;
  }
  // One pixel makes no pattern.
  if (witnesses < 2) return {};
  pool.contrast /= static_cast<double>(witnesses);
  pool.share = static_cast<double>(witnesses - 1) / static_cast<double>(inner);
  return pool;
}

// The samples that a pixel needs of which the pool is true (evidence.h).
double SamplesFor(const Pool& pool, double wanted, double samples) {
  if (pool.share == 0) return 0;
  const double least = wanted / pool.contrast;
  if (least >= 1) return 0;
  const double affected = std::min(pool.share / std::min(samples * least, 1.0), 1.0);
  return std::max(std::log(affected / kMayBeBeyond), 0.0) / least;
}

// Takes back that the pixel's interval is narrow enough.
void Doubt(uint32_t pixel, CellScratch* c) {
  c->intervals[pixel / kBlockPixels].narrow &= ~(1u << pixel % kBlockPixels);
}

}  // namespace

void ClearEvidence(CellScratch* c) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  for (auto* low : {c->low1, c->low2}) std::fill_n(&low[0][0], 3 * kCellPixels, kInfinity);
  for (auto* high : {c->high1, c->high2}) std::fill_n(&high[0][0], 3 * kCellPixels, -kInfinity);
}

void RequireEvidence(CellScratch* c) {
  FindKnownRare(c);
  std::vector<PixelEvidence> all;
  for (const uint32_t pixel : c->active) {
    if (IsOpen(*c, pixel)) all.push_back(EvidenceOf(*c, pixel));
  }
  // Pixels with hits and those without tell of those with both, and these of either.
  std::array<Pool, 3> pools;
  pools[kMisses] = PoolOf(*c, all, kHits);
  pools[kHits] = PoolOf(*c, all, kMisses);
  pools[kMixed] = pools[kHits];
  for (const PixelEvidence& e : all) {
    const Pool& pool = pools[e.kind];
    const double wanted = WantedOf(*c, e.pixel), samples = SamplesTaken(*c, e.pixel);
    const bool by_own = c->covered[e.pixel] >= 0 || samples * wanted >= kByChance * e.contrast;
    const bool by_cell = samples >= SamplesFor(pool, wanted, samples);
    if (!by_own || !by_cell) Doubt(e.pixel, c);
  }
  for (const uint32_t pixel : c->active) {
    if (SamplesTaken(*c, pixel) < c->known_rare[pixel]) Doubt(pixel, c);
  }
}

}  // namespace nacre
