// SPDX-License-Identifier: Apache-2.0
#include "render/adaptive.h"

#include <algorithm>
#include <array>
#include <span>

#include "render/cell_film.h"
#include "render/convergence.h"
#include "render/evidence.h"
#include "render/footprint.h"
#include "render/rare_features.h"
#include "sampling/hash.h"

namespace nacre {
namespace {

// Samples of a pixel that are added up before they are added to its sum: fixed, so that the order
// of the additions is.
constexpr int kPiece = 16;

using Unit = CellScratch::Unit;

// The units' samples [first, first + count), one unit after the other. `samplers`: of each
// replicate.
void MakeUnitSamples(const PixelSampler* samplers, const Window& cell, std::span<const Unit> units,
                     int first, int count, TileWork* s, CellScratch* c) {
  c->pixels.clear();
  for (const Unit& unit : units) {
    const FilmPixel pixel = PixelOf(cell, unit.pixel);
    c->pixels.push_back({pixel.x, pixel.y, unit.replicate});
  }
  SamplePixelList(samplers, c->pixels, first, count, s->samples.film.x.data(),
                  s->samples.film.y.data());
  s->samples.film.count = units.size() * static_cast<size_t>(count);
}

std::array<PixelRun, kBlockSide> RowsOf(const Window& block) {
  std::array<PixelRun, kBlockSide> rows;
  for (int i = 0; i < kBlockSide; ++i) {
    rows[static_cast<size_t>(i)] = {block.x0, block.y0 + i, kBlockSide};
  }
  return rows;
}

// The same where units take one sample and come by whole blocks.
void MakeBlockSamples(const PixelSampler* samplers, const Window& cell, std::span<const Unit> units,
                      int index, TileWork* s, CellScratch* c) {
  for (size_t ray = 0; ray < units.size(); ray += kBlockPixels) {
    const Window block = BlockWindow(cell, units[ray].pixel / kBlockPixels);
    const PixelSampler& sampler = samplers[units[ray].replicate];
    PreparePixels(sampler, RowsOf(block), &c->block);
    SamplePixels(sampler, c->block, index, 1, s->samples.film.x.data() + ray,
                 s->samples.film.y.data() + ray);
  }
  s->samples.film.count = units.size();
}

// Which samples those are, for lights that are sampled.
void NumberUnits(const PixelSampler* samplers, const Window& cell, std::span<const Unit> units,
                 int first, int count, SampleNumbers* numbers) {
  numbers->pixel_count = units.size();
  size_t ray = 0;
  for (uint32_t i = 0; i < units.size(); ++i) {
    const FilmPixel pixel = PixelOf(cell, units[i].pixel);
    numbers->seeds[i] = PixelSeed(pixel.x, pixel.y, samplers[units[i].replicate].seed);
    for (int k = 0; k < count; ++k, ++ray) {
      numbers->number[ray] = static_cast<uint32_t>(first + k);
      numbers->pixel[ray] = i;
    }
  }
}

// In four sums, of every fourth product each. `count`: a power of two, not 1.
double SumOfPiece(const double* values, const double* weights, size_t count) {
  if (count == 2) return weights[0] * values[0] + weights[1] * values[1];
  double sums[4] = {};
  for (size_t i = 0; i < count; i += 4) {
    for (size_t k = 0; k < 4; ++k) sums[k] += weights[i + k] * values[i + k];
  }
  return (sums[0] + sums[1]) + (sums[2] + sums[3]);
}

// Adds a sample of each of a block's pixels. The arrays do not overlap, which lets the compiler use
// vectors.
void AddBlock(const double* __restrict values, double weight, double* __restrict sums) {
  for (size_t k = 0; k < kBlockPixels; ++k) sums[k] += weight * values[k];
}

// Takes those of such samples that hit into the pixels' ranges: without branches, which would go
// either way.
void WidenRanges(const double* values, const double* hits, double* low, double* high) {
  for (size_t k = 0; k < kBlockPixels; ++k) {
    const bool hit = hits[k] != 0;
    low[k] = (hit & (values[k] < low[k])) ? values[k] : low[k];
    high[k] = (hit & (values[k] > high[k])) ? values[k] : high[k];
  }
}

// Sorts a sample into the two least and the two greatest ones.
void WidenExtremes(double value, double* low1, double* low2, double* high2, double* high1) {
  *low2 = std::min(*low2, std::max(*low1, value));
  *low1 = std::min(*low1, value);
  *high2 = std::max(*high2, std::min(*high1, value));
  *high1 = std::max(*high1, value);
}

// One of each of a block's pixels, of which all have some.
void WidenByBlock(const double* values, int channel, uint32_t pixel, CellScratch* c) {
  double* __restrict const low1 = c->low1[channel] + pixel;
  double* __restrict const low2 = c->low2[channel] + pixel;
  double* __restrict const high2 = c->high2[channel] + pixel;
  double* __restrict const high1 = c->high1[channel] + pixel;
  for (size_t k = 0; k < kBlockPixels; ++k) {
    WidenExtremes(values[k], low1 + k, low2 + k, high2 + k, high1 + k);
  }
}

// A pixel's samples that stand in a row.
void WidenByPiece(const double* values, size_t count, int channel, uint32_t pixel, CellScratch* c) {
  double low1 = c->low1[channel][pixel], low2 = c->low2[channel][pixel];
  double high2 = c->high2[channel][pixel], high1 = c->high1[channel][pixel];
  for (size_t i = 0; i < count; ++i) WidenExtremes(values[i], &low1, &low2, &high2, &high1);
  c->low1[channel][pixel] = low1;
  c->low2[channel][pixel] = low2;
  c->high2[channel][pixel] = high2;
  c->high1[channel][pixel] = high1;
}

void MarkHits(const TileWork& s, std::vector<double>* hits) {
  std::fill_n(hits->begin(), s.samples.film.count, 0.0);
  for (size_t i = 0; i < s.surfaces.hits.count; ++i) (*hits)[s.surfaces.hits.ray[i]] = 1;
}

// Where an averaged layer's channel is summed up, by replicates: coverage and the beauty have sums
// for each, from which pixels know when they have converged.
void FindSums(LayerKind layer, int channel, double* film_sum, CellScratch* c,
              double* (&sums)[kReplicates]) {
  for (size_t r = 0; r < kReplicates; ++r) {
    sums[r] = layer == LayerKind::kBeauty  ? c->replicate[r][channel]
              : layer == LayerKind::kAlpha ? c->replicate[r][kAlphaSum]
                                           : film_sum;
  }
}

void AddUnits(const FramePlan& plan, const Window& cell, std::span<const Unit> units,
              TileWork* work, CellScratch* c) {
  TileWork& s = *work;
  const size_t count = s.samples.weights.size();
  if (count == 1 && c->outlined != 0) MarkHits(s, &c->hits);
  size_t sum = 0;
  size_t light_layer = 0;
  for (const Layer& layer : plan.film.layers) {
    if (!IsAveraged(layer.kind)) continue;
    const bool beauty = layer.kind == LayerKind::kBeauty;
    Soa3<double>& values =
        GatherLayer(plan.film, layer, light_layer, BackgroundOf(layer, plan.film), BatchOf(plan, s),
                    &s.layer_room);
    for (int channel = 0; channel < FloatChannels(layer.kind); ++channel, ++sum) {
      const double* value = ChannelOf(values, channel).data();
      double* sums[kReplicates];
      FindSums(layer.kind, channel, s.film.sums[sum].data(), c, sums);
      if (count == 1) {
        // Units are of whole blocks, which stand in a row in the sums as well.
        for (size_t i = 0; i < units.size(); i += kBlockPixels, value += kBlockPixels) {
          const uint32_t pixel = units[i].pixel;
          AddBlock(value, s.samples.weights[0], sums[units[i].replicate] + pixel);
          if (beauty) WidenByBlock(value, channel, pixel, c);
          if (!beauty || (c->outlined >> pixel / kBlockPixels & 1) == 0) continue;
          WidenRanges(value, c->hits.data() + i, c->low[channel] + pixel, c->high[channel] + pixel);
        }
        continue;
      }
      for (const Unit& unit : units) {
        sums[unit.replicate][unit.pixel] += SumOfPiece(value, s.samples.weights.data(), count);
        if (beauty) WidenByPiece(value, count, channel, unit.pixel, c);
        value += count;
      }
    }
    if (layer.kind == LayerKind::kLight) ++light_layer;
  }
  AddNearest(
      plan.film, BatchOf(plan, s),
      [&](uint32_t ray) { return PixelOf(cell, units[ray / count].pixel); }, &s.layer_room,
      &s.film);
}

// The active pixels' samples of a level, in batches.
void AddLevel(const FramePlan& plan, const Window& cell, size_t level, TileWork* s, CellScratch* c,
              StageClock* clock, RenderStats* stats) {
  const AdaptivePlan::Level& piece = plan.adaptive.levels[level];
  const auto& samplers = plan.adaptive.patterns[piece.pattern];
  const int end = piece.first + piece.count;
  const int count = std::min(piece.count, kPiece);
  const bool by_blocks = level < kCommonLevels && piece.count == 1;
  const size_t most = kBatchCapacity / static_cast<size_t>(count);
  for (int first = piece.first; first < end; first += count) {
    s->samples.weights.resize(static_cast<size_t>(count));
    for (int i = 0; i < count; ++i) {
      s->samples.weights[static_cast<size_t>(i)] = SampleWeight(samplers[0], first + i);
    }
    size_t listed = 0;
    const auto flush = [&] {
      if (listed == 0) return;
      const std::span<const Unit> units(c->units.data(), listed);
      if (by_blocks) {
        MakeBlockSamples(samplers.data(), cell, units, first, s, c);
      } else {
        MakeUnitSamples(samplers.data(), cell, units, first, count, s, c);
      }
      if (plan.sampling.numbered) {
        NumberUnits(samplers.data(), cell, units, first, count, &NumbersOf(&s->samples));
      }
      ShadeSamples(plan, s, clock, stats);
      AddUnits(plan, cell, units, s, c);
      clock->Charge(Stage::kFilm);
      listed = 0;
    };
    // Groups of 16 pixels, whole blocks in the common levels, or single ones, by replicates.
    const size_t group = by_blocks ? kBlockPixels : 1;
    for (size_t i = 0; i < c->active.size(); i += group) {
      for (uint32_t replicate = 0; replicate < kReplicates; ++replicate) {
        for (size_t k = i; k < i + group; ++k) c->units[listed++] = {c->active[k], replicate};
        if (listed == most) flush();
      }
    }
    flush();
  }
  for (const uint32_t pixel : c->active) c->samples[pixel] += static_cast<uint32_t>(piece.count);
}

// The pixels of the blocks in `blocks` (bits).
void ListPixels(uint32_t blocks, std::vector<uint32_t>* pixels) {
  pixels->clear();
  for (; blocks != 0; blocks &= blocks - 1) {
    const auto first = static_cast<uint32_t>(__builtin_ctz(blocks)) * uint32_t{kBlockPixels};
    for (uint32_t i = 0; i < kBlockPixels; ++i) pixels->push_back(first + i);
  }
}

// The centres of the pixels of the blocks in `blocks` (bits), and which of these blocks that
// settles.
uint32_t AddCenters(const FramePlan& plan, const Window& cell, uint32_t blocks, uint32_t plain,
                    TileWork* work, CellScratch* c, StageClock* clock, RenderStats* stats) {
  if (blocks == 0) return 0;
  TileWork& s = *work;
  ListPixels(blocks, &c->active);
  const std::vector<uint32_t>& pixels = c->active;
  for (size_t i = 0; i < pixels.size(); ++i) {
    const FilmPixel pixel = PixelOf(cell, pixels[i]);
    s.samples.film.x[i] = pixel.x + 0.5;
    s.samples.film.y[i] = pixel.y + 0.5;
  }
  s.samples.film.count = pixels.size();
  // Only where they lie is of interest: no footprint is plain under sampled lights.
  if (plan.sampling.numbered) NumberAlike(pixels.size(), &NumbersOf(&s.samples));
  ShadeSamples(plan, &s, clock, stats);
  uint32_t hit_of_ray[kCellPixels];
  std::fill_n(hit_of_ray, kCellPixels, kNoHit);
  for (size_t i = 0; i < s.surfaces.hits.count; ++i)
    hit_of_ray[s.surfaces.hits.ray[i]] = static_cast<uint32_t>(i);
  uint32_t smooth = 0;
  size_t sum = 0;
  size_t light_layer = 0;
  for (const Layer& layer : plan.film.layers) {
    if (!IsAveraged(layer.kind)) continue;
    Soa3<double>& values =
        GatherLayer(plan.film, layer, light_layer, BackgroundOf(layer, plan.film), BatchOf(plan, s),
                    &s.layer_room);
    if (layer.kind == LayerKind::kBeauty) {
      for (size_t i = 0; i < pixels.size(); i += kBlockPixels) {
        const uint32_t bit = 1u << pixels[i] / kBlockPixels;
        if ((plain & bit) != 0 && IsSmooth(plan, i, values, hit_of_ray, s)) smooth |= bit;
      }
    }
    for (int channel = 0; channel < FloatChannels(layer.kind); ++channel, ++sum) {
      const double* const value = ChannelOf(values, channel).data();
      for (size_t i = 0; i < pixels.size(); i += kBlockPixels) {
        if ((smooth >> pixels[i] / kBlockPixels & 1) == 0) continue;
        std::copy_n(value + i, kBlockPixels, s.film.sums[sum].data() + pixels[i]);
      }
    }
    if (layer.kind == LayerKind::kLight) ++light_layer;
  }
  AddNearest(
      plan.film, BatchOf(plan, s), [&](uint32_t ray) { return PixelOf(cell, pixels[ray]); },
      &s.layer_room, &s.film);
  clock->Charge(Stage::kFilm);
  return smooth;
}

// One hit for every pixel whose covered share is known, before its first sample: all of these may
// miss. Of its hits only the mean counts, so one that is sought out in the middle of what is
// covered does no harm.
void SeekHits(const FramePlan& plan, const Window& cell, TileWork* work, CellScratch* c,
              StageClock* clock, RenderStats* stats) {
  if (c->sought.empty()) return;
  TileWork& s = *work;
  for (size_t i = 0; i < c->sought.size(); ++i) {
    s.samples.film.x[i] = c->sought[i].x;
    s.samples.film.y[i] = c->sought[i].y;
  }
  s.samples.film.count = c->sought.size();
  ShadeSamples(plan, &s, clock, stats);
  MarkHits(s, &c->hits);
  size_t sum = 0;
  size_t light_layer = 0;
  for (const Layer& layer : plan.film.layers) {
    if (!IsAveraged(layer.kind)) continue;
    const bool beauty = layer.kind == LayerKind::kBeauty;
    const Rgb background = BackgroundOf(layer, plan.film);
    Soa3<double>& values =
        GatherLayer(plan.film, layer, light_layer, background, BatchOf(plan, s), &s.layer_room);
    for (int channel = 0; channel < FloatChannels(layer.kind); ++channel, ++sum) {
      const double* const value = ChannelOf(values, channel).data();
      double* sums[kReplicates];
      FindSums(layer.kind, channel, s.film.sums[sum].data(), c, sums);
      for (size_t i = 0; i < c->sought.size(); ++i) {
        if (c->hits[i] == 0) continue;
        const uint32_t pixel = c->sought[i].pixel;
        // A hit in place of a miss: the number of samples stays.
        sums[0][pixel] += value[i] - background[channel];
        if (beauty) c->low[channel][pixel] = c->high[channel][pixel] = value[i];
      }
    }
    if (layer.kind == LayerKind::kLight) ++light_layer;
  }
  AddNearest(
      plan.film, BatchOf(plan, s),
      [&](uint32_t ray) { return PixelOf(cell, c->sought[ray].pixel); }, &s.layer_room, &s.film);
  clock->Charge(Stage::kFilm);
}

// The blocks, as bits, that have pixels in `part`.
uint32_t BlocksOf(const Window& cell, const Window& part) {
  uint32_t blocks = 0;
  for (size_t b = 0; b < kCellBlocks; ++b) {
    if (!Intersect(BlockWindow(cell, b), part).empty()) blocks |= 1u << b;
  }
  return blocks;
}

}  // namespace

void RenderCell(const FramePlan& plan, const Window& cell, const Window& part, TileWork* work,
                CellScratch* cell_scratch, Strip* strip, StageClock* clock, RenderStats* stats) {
  TileWork& s = *work;
  CellScratch& c = *cell_scratch;
  FindSight(plan.hits, cell, &s.sight);
  clock->Charge(Stage::kIntersect);
  if (!ShowsAnything(plan, s.sight)) {
    FillBackground(plan.film, part, strip);
    stats->pixel_samples.Add(0, part.pixel_count());
    clock->Charge(Stage::kFilm);
    return;
  }
  StartTile(plan.film, cell, kBatchCapacity, &s.film);
  std::fill_n(c.samples, kCellPixels, 0u);
  clock->Charge(Stage::kFilm);
  // All that the frame has: pixels tell of one another, whatever part is rendered.
  const uint32_t blocks = BlocksOf(cell, plan.frame);
  c.pictures = PicturesOf(plan.camera, s.sight.spheres);
  const uint32_t plain = FindPlainBlocks(plan, cell, blocks, &s, &c);
  clock->Charge(Stage::kIntersect);
  const bool all_centers = s.film.nearest_distance.size() > 0;
  const uint32_t smooth =
      AddCenters(plan, cell, all_centers ? blocks : plain, plain, &s, &c, clock, stats);
  const uint32_t sampled = blocks & ~smooth;
  ClearReplicates(sampled, &c);
  ListPixels(sampled, &c.active);
  FindOutlines(plan, cell, &c);
  ClearEvidence(&c);
  FindRareFeatures(plan, cell, &s, &c, clock, stats);
  SeekHits(plan, cell, &s, &c, clock, stats);
  for (size_t level = 0; level < plan.adaptive.levels.size() && !c.active.empty(); ++level) {
    AddLevel(plan, cell, level, &s, &c, clock, stats);
    DropConverged(plan, level, &c);
    clock->Charge(Stage::kFilm);
  }
  stats->unsettled_pixels += CountUnsettled(plan, cell, part, &c);
  stats->pixel_samples.Add(CountSamples(cell, part, c));
  AddReplicates(sampled, c, &s.film);
  ResolveCell(plan, cell, part, s.film, c, strip);
  clock->Charge(Stage::kFilm);
}

}  // namespace nacre
