// SPDX-License-Identifier: Apache-2.0
#include "render/adaptive.h"

#include <algorithm>
#include <span>

#include "render/convergence.h"
#include "render/rare_features.h"
#include "sampling/hash.h"

namespace nacre {
namespace {

// A pixel's samples are first added up in chunks of at most this many. The size is fixed, so that
// the order of the additions, and with it their rounding, is the same everywhere.
constexpr int kChunk = 16;

// Makes the film positions of samples [first, first + count) of each entry of the list, entry by
// entry. There is one sampler per replicate.
void MakeListSamples(const PixelSampler* samplers, const Window& cell,
                     std::span<const SampleEntry> list, int first, int count, TileWork* s,
                     std::vector<SampledPixel>* pixels) {
  pixels->clear();
  for (const SampleEntry& entry : list) {
    const FilmPixel pixel = PixelOf(cell, entry.pixel);
    pixels->push_back({pixel.x, pixel.y, entry.replicate});
  }
  SamplePixelList(samplers, *pixels, first, count, s->samples.film.x.data(),
                  s->samples.film.y.data());
  s->samples.film.count = list.size() * static_cast<size_t>(count);
}

// Makes the film position of one sample of each entry, if the list consists of whole blocks.
void MakeBlockSamples(const PixelSampler* samplers, const Window& cell,
                      std::span<const SampleEntry> list, int index, TileWork* s, PixelBatch* room) {
  for (size_t ray = 0; ray < list.size(); ray += kBlockPixels) {
    const Window block = BlockWindow(cell, list[ray].pixel / kBlockPixels);
    const PixelSampler& sampler = samplers[list[ray].replicate];
    PixelRun rows[kBlockSide];
    for (int i = 0; i < kBlockSide; ++i) rows[i] = {block.x0, block.y0 + i, kBlockSide};
    PreparePixels(sampler, rows, room);
    SamplePixels(sampler, *room, index, 1, s->samples.film.x.data() + ray,
                 s->samples.film.y.data() + ray);
  }
  s->samples.film.count = list.size();
}

// The weighted sum of a chunk, in four partial sums. `count` is a power of two, but not 1.
double SumOfChunk(const double* values, const double* weights, size_t count) {
  if (count == 2) return weights[0] * values[0] + weights[1] * values[1];
  double sums[4] = {};
  for (size_t i = 0; i < count; i += 4) {
    for (size_t k = 0; k < 4; ++k) sums[k] += weights[i + k] * values[i + k];
  }
  return (sums[0] + sums[1]) + (sums[2] + sums[3]);
}

// Adds one sample of each of a block's pixels. The arrays do not overlap, so that the compiler can
// vectorise.
void AddBlock(const double* __restrict values, double weight, double* __restrict sums) {
  for (size_t k = 0; k < kBlockPixels; ++k) sums[k] += weight * values[k];
}

// Extends the ranges of a block's pixels by the samples that hit. There are no branches, because
// they would be mispredicted.
void ExtendHitRanges(const double* values, const double* hits, double* low, double* high) {
  for (size_t k = 0; k < kBlockPixels; ++k) {
    const bool hit = hits[k] != 0;
    low[k] = (hit & (values[k] < low[k])) ? values[k] : low[k];
    high[k] = (hit & (values[k] > high[k])) ? values[k] : high[k];
  }
}

// Updates the two least and the two greatest samples with one more.
void UpdateExtremes(double value, double* lowest, double* second_lowest, double* second_highest,
                    double* highest) {
  *second_lowest = std::min(*second_lowest, std::max(*lowest, value));
  *lowest = std::min(*lowest, value);
  *second_highest = std::max(*second_highest, std::min(*highest, value));
  *highest = std::max(*highest, value);
}

// Updates the extremes with one sample of each of a block's pixels.
void UpdateBlockExtremes(const double* values, int channel, uint32_t pixel,
                         CellEvidence* evidence) {
  double* __restrict const lowest = evidence->lowest[channel] + pixel;
  double* __restrict const second_lowest = evidence->second_lowest[channel] + pixel;
  double* __restrict const second_highest = evidence->second_highest[channel] + pixel;
  double* __restrict const highest = evidence->highest[channel] + pixel;
  for (size_t k = 0; k < kBlockPixels; ++k) {
    UpdateExtremes(values[k], lowest + k, second_lowest + k, second_highest + k, highest + k);
  }
}

// Updates the extremes with `count` samples of one pixel.
void UpdatePixelExtremes(const double* values, size_t count, int channel, uint32_t pixel,
                         CellEvidence* evidence) {
  double lowest = evidence->lowest[channel][pixel],
         second_lowest = evidence->second_lowest[channel][pixel];
  double second_highest = evidence->second_highest[channel][pixel],
         highest = evidence->highest[channel][pixel];
  for (size_t i = 0; i < count; ++i)
    UpdateExtremes(values[i], &lowest, &second_lowest, &second_highest, &highest);
  evidence->lowest[channel][pixel] = lowest;
  evidence->second_lowest[channel][pixel] = second_lowest;
  evidence->second_highest[channel][pixel] = second_highest;
  evidence->highest[channel][pixel] = highest;
}

void MarkHits(const TileWork& s, std::vector<double>* hits) {
  std::fill_n(hits->begin(), s.samples.film.count, 0.0);
  for (size_t i = 0; i < s.surfaces.hits.count; ++i) (*hits)[s.surfaces.hits.ray[i]] = 1;
}

// The sums of an averaged layer's channel, by replicate. Beauty and coverage are summed for each
// replicate, because the differences between replicates tell when a pixel has converged; other
// layers have one sum.
void FindSums(LayerKind layer, int channel, double* film_sum, CellSamples* samples,
              double* (&sums)[kReplicates]) {
  for (size_t r = 0; r < kReplicates; ++r) {
    sums[r] = layer == LayerKind::kBeauty  ? samples->sums[r][channel]
              : layer == LayerKind::kAlpha ? samples->sums[r][kAlphaSum]
                                           : film_sum;
  }
}

// Calls use(layer, background, values) for each averaged layer, whose values are those of the
// batch, by ray.
template <class Use>
void ForEachAveragedLayer(const FramePlan& plan, TileWork* work, const Use& use) {
  for (const Layer& layer : plan.film.layers) {
    if (!IsAveraged(layer.kind)) continue;
    const Rgb background = BackgroundOf(layer, plan.film);
    use(layer, background,
        GatherLayer(plan.film, layer, background, BatchOf(plan, *work), &work->layer_room));
  }
}

void AddListSamples(const FramePlan& plan, const Window& cell, std::span<const SampleEntry> list,
                    TileWork* work, CellRoom* room) {
  TileWork& s = *work;
  CellState& c = room->state;
  OutlinePixels& outlines = c.outlines;
  const size_t count = s.samples.weights.size();
  if (count == 1 && outlines.blocks != 0) MarkHits(s, &room->hits);
  size_t sum = 0;
  const auto add = [&](const Layer& layer, const Rgb& background, Soa3<double>& values) {
    const bool beauty = layer.kind == LayerKind::kBeauty;
    for (int channel = 0; channel < FloatChannels(layer.kind); ++channel, ++sum) {
      WeighDust(background[channel], list, count, c.dust, ChannelOf(values, channel).data());
      const double* value = ChannelOf(values, channel).data();
      double* sums[kReplicates];
      FindSums(layer.kind, channel, s.film.sums[sum].data(), &c.samples, sums);
      if (count == 1) {
        // The list consists of whole blocks, whose pixels are contiguous in the sums as well.
        for (size_t i = 0; i < list.size(); i += kBlockPixels, value += kBlockPixels) {
          const uint32_t pixel = list[i].pixel;
          AddBlock(value, s.samples.weights[0], sums[list[i].replicate] + pixel);
          if (beauty) UpdateBlockExtremes(value, channel, pixel, &c.evidence);
          if (!beauty || !HasOutlines(outlines, pixel / kBlockPixels)) continue;
          ExtendHitRanges(value, room->hits.data() + i, outlines.hit_low[channel] + pixel,
                          outlines.hit_high[channel] + pixel);
        }
        continue;
      }
      for (const SampleEntry& entry : list) {
        sums[entry.replicate][entry.pixel] += SumOfChunk(value, s.samples.weights.data(), count);
        if (beauty) UpdatePixelExtremes(value, count, channel, entry.pixel, &c.evidence);
        value += count;
      }
    }
  };
  ForEachAveragedLayer(plan, &s, add);
  AddNearest(
      plan.film, BatchOf(plan, s),
      [&](uint32_t ray) { return PixelOf(cell, list[ray / count].pixel); }, &s.layer_room, &s.film);
}

// Takes the samples of a level for all active pixels, in batches.
void AddLevel(const FramePlan& plan, const Window& cell, size_t level, TileWork* s,
              CellRoom* room) {
  CellState& c = room->state;
  const SampleLevels::Level& l = plan.adaptive.sampling.levels[level];
  const auto& samplers = plan.adaptive.sampling.patterns[l.pattern];
  const int end = l.first + l.count;
  const int count = std::min(l.count, kChunk);
  const bool by_blocks = level < kCommonLevels && l.count == 1;
  const size_t capacity = kBatchCapacity / static_cast<size_t>(count);
  for (int first = l.first; first < end; first += count) {
    SetWeights(samplers[0], first, count, &s->samples);
    size_t listed = 0;
    const auto flush = [&] {
      if (listed == 0) return;
      const std::span<const SampleEntry> list(room->list.data(), listed);
      if (by_blocks) {
        MakeBlockSamples(samplers.data(), cell, list, first, s, &room->block);
      } else {
        MakeListSamples(samplers.data(), cell, list, first, count, s, &room->pixels);
      }
      MoveToDust(plan, cell, list, static_cast<size_t>(count), &s->samples.film, &c.dust);
      if (plan.sampling.numbered) {
        const auto seed_of = [&](size_t i) {
          const FilmPixel pixel = PixelOf(cell, list[i].pixel);
          return PixelSeed(pixel.x, pixel.y, samplers[list[i].replicate].seed);
        };
        NumberPixelByPixel(listed, first, static_cast<size_t>(count), seed_of,
                           &EnsureNumbers(&s->samples));
      }
      ShadeSamples(plan, s);
      AddListSamples(plan, cell, list, s, room);
      s->clock->Charge(Stage::kFilm);
      listed = 0;
    };
    // A group is a whole block in the common levels, else a single pixel. It is listed for all
    // replicates in turn.
    const size_t group = by_blocks ? kBlockPixels : 1;
    for (size_t i = 0; i < c.active.size(); i += group) {
      for (uint32_t replicate = 0; replicate < kReplicates; ++replicate) {
        for (size_t k = i; k < i + group; ++k) room->list[listed++] = {c.active[k], replicate};
        if (listed == capacity) flush();
      }
    }
    flush();
  }
  for (const uint32_t pixel : c.active) c.samples.count[pixel] += static_cast<uint32_t>(l.count);
}

// Lists the pixels of the blocks whose bits are set.
std::vector<uint32_t> ListPixels(uint32_t blocks) {
  std::vector<uint32_t> pixels;
  pixels.reserve(kCellPixels);
  ForEachBlock(blocks, [&](size_t block) {
    const auto first = static_cast<uint32_t>(block * kBlockPixels);
    for (uint32_t i = 0; i < kBlockPixels; ++i) pixels.push_back(first + i);
  });
  return pixels;
}

// Takes one sample through the centre of each pixel of the blocks whose bits are set in `blocks`.
// Returns, as bits, the blocks of `edge_free` that need no more samples. The film gets their
// values, and the positions, depths and ids of all `blocks`.
uint32_t AddCenters(const FramePlan& plan, const Window& cell, uint32_t blocks, uint32_t edge_free,
                    TileWork* work) {
  if (blocks == 0) return 0;
  TileWork& s = *work;
  const std::vector<uint32_t> pixels = ListPixels(blocks);
  for (size_t i = 0; i < pixels.size(); ++i) {
    const FilmPixel pixel = PixelOf(cell, pixels[i]);
    s.samples.film.x[i] = pixel.x + 0.5;
    s.samples.film.y[i] = pixel.y + 0.5;
  }
  s.samples.film.count = pixels.size();
  // Any numbers will do: under sampled lights no block stops at its centres, and only positions,
  // depths and ids are used.
  if (plan.sampling.numbered) {
    NumberPixelByPixel(
        pixels.size(), 0, 1, [](size_t) { return uint64_t{0}; }, &EnsureNumbers(&s.samples));
  }
  ShadeSamples(plan, &s);
  uint32_t hit_of_ray[kCellPixels];
  std::fill_n(hit_of_ray, kCellPixels, kNoHit);
  for (size_t i = 0; i < s.surfaces.hits.count; ++i)
    hit_of_ray[s.surfaces.hits.ray[i]] = static_cast<uint32_t>(i);
  uint32_t smooth = 0;
  size_t sum = 0;
  const auto add = [&](const Layer& layer, const Rgb&, const Soa3<double>& values) {
    if (layer.kind == LayerKind::kBeauty) {
      for (size_t i = 0; i < pixels.size(); i += kBlockPixels) {
        const uint32_t bit = 1u << pixels[i] / kBlockPixels;
        if ((edge_free & bit) != 0 && IsSmooth(plan, i, values, hit_of_ray, s)) smooth |= bit;
      }
    }
    for (int channel = 0; channel < FloatChannels(layer.kind); ++channel, ++sum) {
      const double* const value = ChannelOf(values, channel).data();
      for (size_t i = 0; i < pixels.size(); i += kBlockPixels) {
        if ((smooth >> pixels[i] / kBlockPixels & 1) == 0) continue;
        std::copy_n(value + i, kBlockPixels, s.film.sums[sum].data() + pixels[i]);
      }
    }
  };
  ForEachAveragedLayer(plan, &s, add);
  AddNearest(
      plan.film, BatchOf(plan, s), [&](uint32_t ray) { return PixelOf(cell, pixels[ray]); },
      &s.layer_room, &s.film);
  work->clock->Charge(Stage::kFilm);
  return smooth;
}

// Gives every pixel whose coverage is known one hit before its first sample, because all samples of
// a barely covered pixel may miss. Only the mean of its hits is used, so that it does no harm to
// choose a point in the middle of the covered part.
void AddCoveredHits(const FramePlan& plan, const Window& cell, TileWork* work, CellRoom* room) {
  OutlinePixels& outlines = room->state.outlines;
  const std::vector<OutlinePixels::CoveredPoint>& points = outlines.covered_points;
  if (points.empty()) return;
  TileWork& s = *work;
  for (size_t i = 0; i < points.size(); ++i) {
    s.samples.film.x[i] = points[i].x;
    s.samples.film.y[i] = points[i].y;
  }
  s.samples.film.count = points.size();
  ShadeSamples(plan, &s);
  MarkHits(s, &room->hits);
  size_t sum = 0;
  const auto add = [&](const Layer& layer, const Rgb& background, Soa3<double>& values) {
    const bool beauty = layer.kind == LayerKind::kBeauty;
    for (int channel = 0; channel < FloatChannels(layer.kind); ++channel, ++sum) {
      const double* const value = ChannelOf(values, channel).data();
      double* sums[kReplicates];
      FindSums(layer.kind, channel, s.film.sums[sum].data(), &room->state.samples, sums);
      for (size_t i = 0; i < points.size(); ++i) {
        if (room->hits[i] == 0) continue;
        const uint32_t pixel = points[i].pixel;
        // It replaces a miss by a hit, so that the number of samples stays the same.
        sums[0][pixel] += value[i] - background[channel];
        if (beauty) outlines.hit_low[channel][pixel] = outlines.hit_high[channel][pixel] = value[i];
      }
    }
  };
  ForEachAveragedLayer(plan, &s, add);
  AddNearest(
      plan.film, BatchOf(plan, s), [&](uint32_t ray) { return PixelOf(cell, points[ray].pixel); },
      &s.layer_room, &s.film);
  work->clock->Charge(Stage::kFilm);
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
                CellRoom* room, Strip* strip) {
  TileWork& s = *work;
  CellState& c = room->state;
  FindTileShapes(plan.hits, cell, &s.shapes);
  work->clock->Charge(Stage::kIntersect);
  if (!ShowsAnything(plan, s.shapes)) {
    FillBackground(plan.film, part, strip);
    work->stats->pixel_samples.Add(0, part.pixel_count());
    work->clock->Charge(Stage::kFilm);
    c.active.clear();
    return;
  }
  StartTile(plan.film, cell, kBatchCapacity, &s.film);
  std::fill_n(c.samples.count, kCellPixels, 0u);
  work->clock->Charge(Stage::kFilm);
  // All blocks within the frame, whatever part is rendered, because pixels depend on their
  // neighbours.
  const uint32_t blocks = BlocksOf(cell, plan.frame);
  const CellProjections projections = ProjectSpheres(plan.camera, s.shapes.spheres);
  c.edges = FindEdges(plan, cell, blocks, projections, &s);
  work->clock->Charge(Stage::kIntersect);
  const bool all_centers = s.film.nearest_distance2.size() > 0;
  const uint32_t smooth =
      AddCenters(plan, cell, all_centers ? blocks : c.edges.none, c.edges.none, &s);
  const uint32_t sampled = blocks & ~smooth;
  ClearReplicates(sampled, &c.samples);
  c.active = ListPixels(sampled);
  FindDust(plan, cell, s.shapes, &c.dust);
  FindOutlinePixels(plan, cell, c.active, projections, c.dust, &c.outlines);
  ClearEvidence(&c.evidence);
  FindRareFeatures(plan, cell, c.dust, &s, &c.known);
  AddCoveredHits(plan, cell, &s, room);
  for (size_t level = 0; level < plan.adaptive.sampling.levels.size() && !c.active.empty();
       ++level) {
    AddLevel(plan, cell, level, &s, room);
    DropConverged(plan, level, &c);
    work->clock->Charge(Stage::kFilm);
  }
  work->stats->unsettled_pixels += CountUnsettled(plan, cell, part, &c);
  work->stats->pixel_samples.Add(CountSamples(cell, part, c.samples));
  AddReplicates(sampled, c.samples, &s.film);
  ResolveCell(plan, cell, part, s.film, c.samples, c.outlines, strip);
  work->clock->Charge(Stage::kFilm);
}

}  // namespace nacre
