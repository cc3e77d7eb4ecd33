// SPDX-License-Identifier: Apache-2.0
#include "render/render.h"

#include <algorithm>
#include <chrono>
#include <memory>
#include <mutex>

#include "base/parallel.h"
#include "render/adaptive.h"
#include "render/tile.h"

namespace nacre {
namespace {

double SecondsSince(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

// What a worker needs, reused from strip to strip: fresh memory costs a page fault per 4 KiB.
struct Worker {
  TileWork work;
  std::unique_ptr<CellScratch> cell;  // of adaptive sampling
  Strip strip;
  std::vector<uint8_t> blank;  // of each of its tiles, as RenderTile says
};

// Hands workers out and takes them back.
class WorkerPool {
 public:
  std::unique_ptr<Worker> Take() {
    const std::lock_guard lock(mutex_);
    if (free_.empty()) return std::make_unique<Worker>();
    std::unique_ptr<Worker> worker = std::move(free_.back());
    free_.pop_back();
    return worker;
  }
  void Give(std::unique_ptr<Worker> worker) {
    const std::lock_guard lock(mutex_);
    free_.push_back(std::move(worker));
  }

 private:
  std::mutex mutex_;
  std::vector<std::unique_ptr<Worker>> free_;
};

// The cells of adaptive sampling lie on a grid of the frame.
void RenderCells(const FramePlan& plan, const Window& window, Worker* worker, StageClock* clock,
                 RenderStats* stats) {
  if (!worker->cell) worker->cell = std::make_unique<CellScratch>();
  const auto first = [](int pixel) { return pixel / kCellSize * kCellSize; };
  for (int y = first(window.y0); y < window.y1; y += kCellSize) {
    for (int x = first(window.x0); x < window.x1; x += kCellSize) {
      const Window cell{x, y, x + kCellSize, y + kCellSize};
      RenderCell(plan, cell, Intersect(cell, window), &worker->work, worker->cell.get(),
                 &worker->strip, clock, stats);
    }
  }
}

void RenderStrip(const FramePlan& plan, const Window& window, bool time_stages, Worker* worker,
                 RenderStats* stats) {
  StageClock clock(time_stages ? stats : nullptr);
  const int rows_before = worker->strip.window.height();
  StartStrip(plan.film, window, &worker->strip);
  if (plan.adaptive.max_error > 0) return RenderCells(plan, window, worker, &clock, stats);
  // What the strip before this one showed still stands, where it had these rows: most tiles of the
  // background lie below others.
  const auto tiles = static_cast<size_t>((window.width() - 1) / plan.sampling.tile_width + 1);
  if (rows_before < window.height()) worker->blank.assign(tiles, 0);
  for (size_t i = 0; i < tiles; ++i) {
    const int x = window.x0 + static_cast<int>(i) * plan.sampling.tile_width;
    const Window tile{x, window.y0, std::min(x + plan.sampling.tile_width, window.x1), window.y1};
    RenderTile(plan, tile, &worker->work, &worker->strip, &worker->blank[i], &clock, stats);
  }
}

size_t TilesOfRow(const FramePlan& plan) {
  return static_cast<size_t>((plan.window.width() - 1) / plan.sampling.tile_width + 1);
}

// Strip by strip, from left to right.
std::vector<Window> TilesOf(const FramePlan& plan) {
  const Window& window = plan.window;
  std::vector<Window> tiles;
  for (int y = window.y0; y < window.y1; y += kStripRows) {
    for (int x = window.x0; x < window.x1; x += plan.sampling.tile_width) {
      tiles.push_back({x, y, std::min(x + plan.sampling.tile_width, window.x1),
                       std::min(y + kStripRows, window.y1)});
    }
  }
  return tiles;
}

}  // namespace

RenderStats Render(const FramePlan& plan, const RenderSettings& settings, const StripSink& sink) {
  const auto start = std::chrono::steady_clock::now();
  const Window& window = plan.window;
  const int strip_count = (window.height() + kStripRows - 1) / kStripRows;
  RenderStats total;
  total.threads = ThreadCount(settings.threads);
  WorkerPool pool;
  std::mutex mutex;
  int done = 0;
  ParallelFor(static_cast<size_t>(strip_count), settings.threads, [&](size_t i) {
    const int y0 = window.y0 + static_cast<int>(i) * kStripRows;
    const Window rows{window.x0, y0, window.x1, std::min(y0 + kStripRows, window.y1)};
    RenderStats stats;
    std::unique_ptr<Worker> worker = pool.Take();
    worker->work.cancel = settings.cancel;
    RenderStrip(plan, rows, settings.time_stages, worker.get(), &stats);
    const auto output_start = std::chrono::steady_clock::now();
    sink(worker->strip);
    pool.Give(std::move(worker));
    stats.seconds(Stage::kOutput) = SecondsSince(output_start);
    const std::lock_guard lock(mutex);
    total.Add(stats);
    ++done;
    if (settings.on_progress) settings.on_progress(static_cast<double>(done) / strip_count);
  });
  if (plan.adaptive.max_error == 0) {
    total.pixel_samples.Add(static_cast<uint32_t>(plan.scene->image.spp), window.pixel_count());
  }
  total.render_seconds = SecondsSince(start);
  return total;
}

RenderStats RenderPass(const FramePlan& plan, const RenderSettings& settings, int end,
                       FrameFilm* film, const StripSink& sink) {
  const auto start = std::chrono::steady_clock::now();
  const Window& window = plan.window;
  const std::vector<Window> tiles = TilesOf(plan);
  const bool is_first = film->samples == 0;
  if (is_first) film->tiles.resize(tiles.size());
  // What the film is after so many samples.
  FilmPlan so_far = plan.film;
  so_far.spp = end;
  so_far.weight = 0;
  for (int i = 0; i < end; ++i) so_far.weight += SampleWeight(plan.sampling.sampler, i);
  const size_t per_strip = TilesOfRow(plan);
  RenderStats total;
  total.threads = ThreadCount(settings.threads);
  WorkerPool pool;
  std::mutex mutex;
  const size_t strips = tiles.size() / per_strip;
  size_t done = 0;
  ParallelFor(strips, settings.threads, [&](size_t i) {
    std::unique_ptr<Worker> worker = pool.Take();
    worker->work.cancel = settings.cancel;
    RenderStats stats;
    StageClock clock(settings.time_stages ? &stats : nullptr);
    const Window& first = tiles[i * per_strip];
    StartStrip(plan.film, {window.x0, first.y0, window.x1, first.y1}, &worker->strip);
    for (size_t t = i * per_strip; t < (i + 1) * per_strip; ++t) {
      TileFilm& of_tile = film->tiles[t];
      if (is_first) StartTile(plan.film, tiles[t], tiles[t].pixel_count(), &of_tile);
      AddSamples(plan, tiles[t], film->samples, end, &worker->work, &of_tile, &clock, &stats);
      ResolveTile(so_far, of_tile, &worker->strip);
    }
    sink(worker->strip);
    pool.Give(std::move(worker));
    const std::lock_guard lock(mutex);
    total.Add(stats);
    ++done;
    // Of the samples of all passes.
    const double of_pass = static_cast<double>(done) / static_cast<double>(strips);
    const double samples = film->samples + (end - film->samples) * of_pass;
    if (settings.on_progress) settings.on_progress(samples / plan.film.spp);
  });
  film->samples = end;
  total.pixel_samples.Add(static_cast<uint32_t>(end), window.pixel_count());
  total.render_seconds = SecondsSince(start);
  return total;
}

Image EmptyImage(const FramePlan& plan) {
  Image image;
  image.display = plan.frame;
  image.data = plan.window;
  for (const ChannelSpec& spec : StripChannels(plan.film.layers, PixelType::kFloat)) {
    image.channels.push_back({spec.name, spec.type, std::vector<float>(plan.window.pixel_count())});
  }
  return image;
}

void PutStrip(const Strip& strip, Image* image) {
  const size_t offset = static_cast<size_t>(strip.window.y0 - image->data.y0) *
                        static_cast<size_t>(image->data.width());
  const size_t pixels = strip.window.pixel_count();
  auto channel = image->channels.begin();
  for (const AlignedArray<float>& plane : strip.colors) {
    std::copy_n(plane.data(), pixels, (channel++)->samples.data() + offset);
  }
  for (const AlignedArray<uint32_t>& plane : strip.ids) {
    std::transform(plane.data(), plane.data() + pixels, (channel++)->samples.data() + offset,
                   [](uint32_t id) { return static_cast<float>(id); });
  }
}

Image RenderImage(const FramePlan& plan, const RenderSettings& settings, RenderStats* stats) {
  Image image = EmptyImage(plan);
  const RenderStats rendered =
      Render(plan, settings, [&](const Strip& strip) { PutStrip(strip, &image); });
  if (stats != nullptr) *stats = rendered;
  return image;
}

Image RenderImage(const Scene& scene, const RenderSettings& settings, RenderStats* stats) {
  const auto start = std::chrono::steady_clock::now();
  const FramePlan plan = MakePlan(scene, settings);
  const double plan_seconds = SecondsSince(start);
  Image image = RenderImage(plan, settings, stats);
  if (stats != nullptr) stats->plan_seconds = plan_seconds;
  return image;
}

}  // namespace nacre
