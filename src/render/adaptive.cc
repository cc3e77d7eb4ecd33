#include "render/adaptive.h"

#include <algorithm>
#include <cmath>

#include "render/film_kernel.h"
#include "render/footprint.h"
#include "render/tile_layers.h"

namespace nacre {
namespace {

// Student's t: 97.5 % of the distribution with three degrees of freedom lie below.
constexpr double kStudent = 3.182446305;

// Samples of a pixel that are added up before they are added to its sum: fixed, so that the order
// of the additions is.
constexpr int kPiece = 4;

// Samples [first, first + count) of one replicate of one block.
struct Unit {
  size_t block;
  size_t replicate;
};

// The units' samples, one after the other. `samplers`: of each replicate.
void MakeUnitSamples(const PixelSampler* samplers, const Window& cell,
                     const std::vector<Unit>& units, int first, int count, TileScratch* s,
                     CellScratch* c) {
  const size_t size = kBlockPixels * static_cast<size_t>(count);
  for (size_t u = 0; u < units.size(); ++u) {
    const Window block = BlockWindow(cell, units[u].block);
    const PixelSampler& sampler = samplers[units[u].replicate];
    ShiftPixels(sampler, block, &c->shifts);
    SamplePixels(sampler, block, c->shifts, first, count, s->samples.x.data() + u * size,
                 s->samples.y.data() + u * size);
  }
  s->samples.count = units.size() * size;
  s->weights.resize(static_cast<size_t>(count));
  for (int i = 0; i < count; ++i) {
    s->weights[static_cast<size_t>(i)] = SampleWeight(samplers[0], first + i);
  }
}

FilmPixel UnitPixel(const Window& cell, const std::vector<Unit>& units, size_t unit_size,
                    uint32_t ray) {
  const size_t block = units[ray / unit_size].block;
  const size_t pixel = ray % kBlockPixels;
  const Window window = BlockWindow(cell, block);
  return {block * kBlockPixels + pixel, window.x0 + static_cast<int>(pixel % kBlockSide),
          window.y0 + static_cast<int>(pixel / kBlockSide)};
}

void AddUnits(const RenderPlan& plan, const Window& cell, const std::vector<Unit>& units, int count,
              TileScratch* scratch, CellScratch* c) {
  TileScratch& s = *scratch;
  const size_t unit_size = kBlockPixels * static_cast<size_t>(count);
  alignas(kVectorBytes) double piece[kBlockPixels];
  size_t sum = 0;
  size_t light_layer = 0;
  for (const Layer& layer : plan.layers) {
    if (!IsAveraged(layer.kind)) continue;
    Soa3<double>& values = GatherLayer(plan, layer, light_layer, &s);
    for (int channel = 0; channel < FloatChannels(layer.kind); ++channel, ++sum) {
      const double* value = ChannelOf(values, channel).data();
      for (const Unit& unit : units) {
        AddSamples(value, s.weights.data(), count, kBlockPixels, true, piece);
        value += unit_size;
        const size_t first = unit.block * kBlockPixels;
        double* const total = s.film.sums[sum].data() + first;
        for (size_t i = 0; i < kBlockPixels; ++i) total[i] += piece[i];
        if (layer.kind != LayerKind::kBeauty) continue;
        double* const replicate = c->replicate[unit.replicate][channel] + first;
        for (size_t i = 0; i < kBlockPixels; ++i) replicate[i] += piece[i];
      }
    }
    if (layer.kind == LayerKind::kLight) ++light_layer;
  }
  if (s.hits.count > 0 && s.film.nearest_distance.size() > 0) {
    AddNearest(
        plan, [&](uint32_t ray) { return UnitPixel(cell, units, unit_size, ray); }, &s);
  }
}

// The active blocks' samples of a level, in batches.
void AddLevel(const RenderPlan& plan, const Window& cell, size_t level, TileScratch* s,
              CellScratch* c, StageClock* clock, RenderStats* stats) {
  const auto& samplers = plan.adaptive.levels[level];
  const int samples = samplers[0].samples_per_pixel;
  const int count = std::min(samples, kPiece);
  const size_t most = kBatchCapacity / (kBlockPixels * static_cast<size_t>(count));
  std::vector<Unit> units;
  for (int first = 0; first < samples; first += count) {
    const auto flush = [&] {
      if (units.empty()) return;
      MakeUnitSamples(samplers.data(), cell, units, first, count, s, c);
      TraceAndShade(plan, s, clock, stats);
      AddUnits(plan, cell, units, count, s, c);
      clock->Charge(Stage::kFilm);
      units.clear();
    };
    for (size_t replicate = 0; replicate < kReplicates; ++replicate) {
      for (const uint32_t block : c->active) {
        units.push_back({block, replicate});
        if (units.size() == most) flush();
      }
    }
    flush();
  }
  for (const uint32_t block : c->active) c->samples[block] += static_cast<uint32_t>(samples);
}

// Whether every pixel's interval is narrow enough.
bool HasConverged(const RenderPlan& plan, size_t block, const CellScratch& c) {
  const double scale = 1.0 / c.samples[block];
  const size_t first = block * kBlockPixels;
  bool converged = true;
  for (size_t channel = 0; channel < 3; ++channel) {
    for (size_t i = first; i < first + kBlockPixels; ++i) {
      double mean = 0;
      for (const auto& replicate : c.replicate) mean += replicate[channel][i];
      mean *= scale / kReplicates;
      double squares = 0;
      for (const auto& replicate : c.replicate) {
        const double difference = replicate[channel][i] * scale - mean;
        squares += difference * difference;
      }
      const double half_width = kStudent * std::sqrt(squares / ((kReplicates - 1) * kReplicates));
      // NaN never converges; it is counted where the picture is written.
      converged =
          converged && half_width <= plan.adaptive.max_error * std::max(std::abs(mean), kDarkest);
    }
  }
  return converged;
}

// The pixels' centres of the blocks in `blocks` (bits), and which of them that settles.
uint32_t AddCenters(const RenderPlan& plan, const Window& cell, uint32_t blocks, uint32_t plain,
                    TileScratch* scratch, CellScratch* c, StageClock* clock, RenderStats* stats) {
  TileScratch& s = *scratch;
  std::vector<Unit> units;
  for (; blocks != 0; blocks &= blocks - 1) {
    units.push_back({static_cast<size_t>(__builtin_ctz(blocks)), 0});
  }
  if (units.empty()) return 0;
  MakeUnitSamples(&plan.adaptive.center, cell, units, 0, 1, &s, c);
  TraceAndShade(plan, &s, clock, stats);
  uint32_t smooth = 0;
  size_t sum = 0;
  size_t light_layer = 0;
  for (const Layer& layer : plan.layers) {
    if (!IsAveraged(layer.kind)) continue;
    Soa3<double>& values = GatherLayer(plan, layer, light_layer, &s);
    if (layer.kind == LayerKind::kBeauty) {
      for (size_t u = 0; u < units.size(); ++u) {
        const uint32_t bit = 1u << units[u].block;
        if ((plain & bit) != 0 && IsSmooth(plan, u * kBlockPixels, values, s)) smooth |= bit;
      }
    }
    for (int channel = 0; channel < FloatChannels(layer.kind); ++channel, ++sum) {
      const double* value = ChannelOf(values, channel).data();
      for (const Unit& unit : units) {
        if ((smooth >> unit.block & 1) != 0) {
          std::copy_n(value, kBlockPixels, s.film.sums[sum].data() + unit.block * kBlockPixels);
        }
        value += kBlockPixels;
      }
    }
    if (layer.kind == LayerKind::kLight) ++light_layer;
  }
  if (s.hits.count > 0 && s.film.nearest_distance.size() > 0) {
    AddNearest(
        plan, [&](uint32_t ray) { return UnitPixel(cell, units, kBlockPixels, ray); }, &s);
  }
  clock->Charge(Stage::kFilm);
  return smooth;
}

// Rows of blocks into rows of the strip, as far as they lie in `part`.
template <typename T, typename U, typename Convert>
void PutBlock(const Window& block, const Window& part, const Strip& strip, const T* from,
              std::vector<U>* to, const Convert& convert) {
  const Window shown = Intersect(block, part);
  for (int y = shown.y0; y < shown.y1; ++y) {
    const T* const row = from + (y - block.y0) * kBlockSide - block.x0;
    U* const out =
        to->data() +
        static_cast<size_t>(y - strip.window.y0) * static_cast<size_t>(strip.window.width()) -
        strip.window.x0;
    for (int x = shown.x0; x < shown.x1; ++x) out[x] = convert(row[x]);
  }
}

void ResolveCell(const RenderPlan& plan, const Window& cell, const Window& part,
                 const TileFilm& film, const CellScratch& c, Strip* strip) {
  for (size_t b = 0; b < kCellBlocks; ++b) {
    const Window block = BlockWindow(cell, b);
    if (Intersect(block, part).empty()) continue;
    const double scale = c.samples[b] == 0 ? 1.0 : 1.0 / (double{kReplicates} * c.samples[b]);
    const size_t first = b * kBlockPixels;
    size_t sum = 0, nearest = 0, id = 0, color = 0;
    for (const ChannelKind kind : plan.channels) {
      if (kind == ChannelKind::kAveraged) {
        PutBlock(block, part, *strip, film.sums[sum++].data() + first, &strip->colors[color++],
                 [&](double v) { return static_cast<float>(v * scale); });
      } else if (kind == ChannelKind::kNearest) {
        PutBlock(block, part, *strip, film.nearest[nearest++].data() + first,
                 &strip->colors[color++], [](float v) { return v; });
      } else {
        PutBlock(block, part, *strip, film.ids[id].data() + first, &strip->ids[id],
                 [](uint32_t v) { return v; });
        ++id;
      }
    }
  }
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

Window BlockWindow(const Window& cell, size_t block) {
  constexpr size_t kAcross = kCellSide / kBlockSide;
  const int x = cell.x0 + static_cast<int>(block % kAcross) * kBlockSide;
  const int y = cell.y0 + static_cast<int>(block / kAcross) * kBlockSide;
  return {x, y, x + kBlockSide, y + kBlockSide};
}

void RenderCell(const RenderPlan& plan, const Window& cell, const Window& part,
                TileScratch* scratch, CellScratch* cell_scratch, Strip* strip, RenderStats* stats) {
  TileScratch& s = *scratch;
  CellScratch& c = *cell_scratch;
  StageClock clock(stats);
  const bool anything = plan.intersector != nullptr &&
                        (!plan.tiles || plan.intersector->EnterTile(cell, &s.candidates));
  clock.Charge(Stage::kIntersect);
  if (!anything) {
    FillBackground(plan, part, strip);
    clock.Charge(Stage::kFilm);
    return;
  }
  StartTile(plan, cell, &s.film);
  for (AlignedArray<double>& sums : s.film.sums) std::fill_n(sums.data(), kCellPixels, 0.0);
  std::fill_n(&c.replicate[0][0][0], sizeof(c.replicate) / sizeof(double), 0.0);
  std::fill_n(c.samples, kCellBlocks, 0u);
  clock.Charge(Stage::kFilm);
  const uint32_t blocks = BlocksOf(cell, part);
  const uint32_t plain = FindPlainBlocks(plan, cell, blocks, &s, &c);
  clock.Charge(Stage::kIntersect);
  const bool all_centers = s.film.nearest_distance.size() > 0;
  const uint32_t smooth =
      AddCenters(plan, cell, all_centers ? blocks : plain, plain, &s, &c, &clock, stats);
  c.active.clear();
  for (uint32_t left = blocks & ~smooth; left != 0; left &= left - 1) {
    c.active.push_back(static_cast<uint32_t>(__builtin_ctz(left)));
  }
  for (size_t level = 0; level < plan.adaptive.levels.size() && !c.active.empty(); ++level) {
    AddLevel(plan, cell, level, &s, &c, &clock, stats);
    std::erase_if(c.active, [&](uint32_t block) { return HasConverged(plan, block, c); });
    clock.Charge(Stage::kFilm);
  }
  stats->unsettled_pixels += c.active.size() * kBlockPixels;
  ResolveCell(plan, cell, part, s.film, c, strip);
  clock.Charge(Stage::kFilm);
}

}  // namespace nacre
