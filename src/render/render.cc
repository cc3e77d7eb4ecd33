// SPDX-License-Identifier: Apache-2.0
#include "render/render.h"

#include <algorithm>
#include <chrono>
#include <functional>
#include <memory>
#include <mutex>

#include <fmt/format.h>

#include "base/parallel.h"
#include "base/seconds_since.h"
#include "base/strip.h"
#include "render/adaptive.h"
#include "render/tile.h"

namespace nacre {
namespace {

// The buffers of one thread, reused from strip to strip: fresh memory costs a page fault per 4 KiB.
struct Worker {
  TileWork work;
  std::unique_ptr<CellRoom> cell;  // of adaptive sampling
  Strip strip;
  std::vector<uint8_t> blank;  // RenderTile's `blank`, for each tile of the strip
};

class WorkerPool {
 public:
  std::unique_ptr<Worker> Take() {
    const std::lock_guard lock(mutex_);
    if (free_.empty()) return std::make_unique<Worker>();
    std::unique_ptr<Worker> worker = std::move(free_.back());
    free_.pop_back();
    return worker;
  }
  void Return(std::unique_ptr<Worker> worker) {
    const std::lock_guard lock(mutex_);
    free_.push_back(std::move(worker));
  }

 private:
  std::mutex mutex_;
  std::vector<std::unique_ptr<Worker>> free_;
};

size_t TilesPerStrip(const FramePlan& plan) {
  return static_cast<size_t>((plan.window.width() - 1) / plan.sampling.tile_width + 1);
}

// Calls render_tile(number, tile) for the tiles of a strip from left to right.
template <class RenderOne>
void ForEachTile(const FramePlan& plan, const Window& strip, const RenderOne& render_tile) {
  const int width = plan.sampling.tile_width;
  size_t number = 0;
  for (int x = strip.x0; x < strip.x1; x += width) {
    render_tile(number++, Window{x, strip.y0, std::min(x + width, strip.x1), strip.y1});
  }
}

// Calls render_cell(cell) for the cells of adaptive sampling that the strip lies in. They lie on a
// grid of the whole frame.
template <class RenderOne>
void ForEachCell(const Window& strip, const RenderOne& render_cell) {
  for (int y = DownToCell(strip.y0); y < strip.y1; y += kCellSize) {
    for (int x = DownToCell(strip.x0); x < strip.x1; x += kCellSize) {
      render_cell(Window{x, y, x + kCellSize, y + kCellSize});
    }
  }
}

// Stores the ids of a strip in an image, whose id channels are floats.
void StoreIds(const Strip& strip, Image* image) {
  const size_t first = IndexIn(image->data, strip.window.x0, strip.window.y0);
  for (size_t i = 0; i < strip.ids.size(); ++i) {
    std::vector<float>& to = image->channels[strip.colors.size() + i].samples;
    std::ranges::copy(strip.ids[i], to.begin() + static_cast<ptrdiff_t>(first));
  }
}

// Renders strip `number` of the window into worker->strip, whose window and channels are set.
using StripRenderer = std::function<void(size_t number, Worker* worker)>;

// Renders all strips in parallel, into the image or, if that is null, passes them to the sink.
// on_progress(share), unless it is empty, is called after each strip with the share of the strips
// that are finished.
RenderStats RenderStrips(const FramePlan& plan, const RenderSettings& settings,
                         const StripRenderer& render_strip, Image* image, const StripSink& sink,
                         const std::function<void(double)>& on_progress) {
  const auto start = std::chrono::steady_clock::now();
  const Window& window = plan.window;
  const size_t strip_count = static_cast<size_t>(StripCount(plan.window.height()));
  RenderStats total;
  total.threads = ThreadCount(settings.threads);
  WorkerPool pool;
  std::mutex mutex;
  size_t done = 0;
  ParallelFor(strip_count, settings.threads, [&](size_t number) {
    const int y0 = window.y0 + static_cast<int>(number) * kStripRows;
    const Window rows{window.x0, y0, window.x1, std::min(y0 + kStripRows, window.y1)};
    RenderStats stats;
    std::unique_ptr<Worker> worker = pool.Take();
    worker->work.cancel = settings.cancel;
    {
      StageClock clock(settings.time_stages ? &stats : nullptr);
      worker->work.clock = &clock;
      worker->work.stats = &stats;
      // The worker's strip keeps the pixels of the strip that it rendered before. A tile that shows
      // the background often lies below another such tile, which then need not be filled again.
      // Rows that the strip before did not have are not filled yet.
      const bool has_new_rows = worker->strip.window.height() < rows.height();
      if (has_new_rows || image != nullptr) worker->blank.assign(TilesPerStrip(plan), 0);
      StartStrip(plan.film, rows, image, &worker->strip);
      render_strip(number, worker.get());
    }
    const auto output_start = std::chrono::steady_clock::now();
    if (image != nullptr) {
      StoreIds(worker->strip, image);
    } else {
      sink(worker->strip);
    }
    pool.Return(std::move(worker));
    stats.seconds(Stage::kOutput) = SecondsSince(output_start);
    const std::lock_guard lock(mutex);
    total.Add(stats);
    ++done;
    if (on_progress) on_progress(static_cast<double>(done) / static_cast<double>(strip_count));
  });
  total.render_seconds = SecondsSince(start);
  return total;
}

// The plan of a film that has only the first `samples` of each pixel.
FilmPlan PlanOfFirstSamples(const FramePlan& plan, int samples) {
  FilmPlan film = plan.film;
  film.spp = samples;
  film.weight = 0;
  for (int i = 0; i < samples; ++i) film.weight += SampleWeight(plan.sampling.sampler, i);
  return film;
}

// Implements Render; renders into the image if it is not null.
RenderStats RenderWhole(const FramePlan& plan, const RenderSettings& settings, Image* image,
                        const StripSink& sink) {
  const bool adaptive = plan.adaptive.max_error > 0;
  const auto render_strip = [&](size_t, Worker* worker) {
    Strip& strip = worker->strip;
    if (!adaptive) {
      return ForEachTile(plan, strip.window, [&](size_t number, const Window& tile) {
        RenderTile(plan, tile, &worker->work, &strip, &worker->blank[number]);
      });
    }
    if (!worker->cell) worker->cell = std::make_unique<CellRoom>();
    ForEachCell(strip.window, [&](const Window& cell) {
      RenderCell(plan, cell, Intersect(cell, strip.window), &worker->work, worker->cell.get(),
                 &strip);
    });
  };
  RenderStats total = RenderStrips(plan, settings, render_strip, image, sink, settings.on_progress);
  total.Add(plan.meshes.stats);
  if (!adaptive) {
    total.pixel_samples.Add(static_cast<uint32_t>(plan.scene->image.spp),
                            plan.window.pixel_count());
  }
  return total;
}

}  // namespace

RenderStats Render(const FramePlan& plan, const RenderSettings& settings, const StripSink& sink) {
  return RenderWhole(plan, settings, nullptr, sink);
}

RenderStats RenderPass(const FramePlan& plan, const RenderSettings& settings, int end,
                       FrameFilm* film, Image* image) {
  const int first = film->samples;
  const size_t tiles_per_strip = TilesPerStrip(plan);
  if (first == 0) {
    film->tiles.resize(static_cast<size_t>(StripCount(plan.window.height())) * tiles_per_strip);
  }
  const FilmPlan so_far = PlanOfFirstSamples(plan, end);
  const auto render_strip = [&](size_t strip, Worker* worker) {
    ForEachTile(plan, worker->strip.window, [&](size_t number, const Window& tile) {
      TileFilm& tile_film = film->tiles[strip * tiles_per_strip + number];
      if (first == 0) StartTile(plan.film, tile, tile.pixel_count(), &tile_film);
      AddTileSamples(plan, tile, first, end, &worker->work, &tile_film);
      ResolveTile(so_far, tile_film, &worker->strip);
      worker->work.clock->Charge(Stage::kFilm);
    });
  };
  // Reports the share of the samples of all passes.
  const auto on_progress = [&](double share) {
    if (settings.on_progress) {
      settings.on_progress((first + (end - first) * share) / plan.film.spp);
    }
  };
  RenderStats total = RenderStrips(plan, settings, render_strip, image, {}, on_progress);
  film->samples = end;
  if (first == 0) total.Add(plan.meshes.stats);
  total.pixel_samples.Add(static_cast<uint32_t>(end), plan.window.pixel_count());
  return total;
}

void FitImage(const FramePlan& plan, const RenderSettings& settings, Image* image) {
  image->display = plan.frame;
  image->data = plan.window;
  const std::vector<ChannelSpec> specs = StripChannels(plan.film.layers, PixelType::kFloat);
  image->channels.resize(specs.size());
  try {
    ParallelFor(specs.size(), settings.threads, [&](size_t i) {
      ThrowIfCancelled(settings.cancel);
      Channel& channel = image->channels[i];
      channel.name = specs[i].name;
      channel.type = specs[i].type;
      channel.samples.resize(plan.window.pixel_count());
    });
  } catch (...) {  // cancelled, or no memory for it
    image->channels.clear();
    throw;
  }
}

RenderStats RenderInto(const FramePlan& plan, const RenderSettings& settings, Image* image) {
  const auto start = std::chrono::steady_clock::now();
  FitImage(plan, settings, image);
  RenderStats stats = RenderWhole(plan, settings, image, {});
  stats.render_seconds = SecondsSince(start);
  return stats;
}

Image RenderImage(const FramePlan& plan, const RenderSettings& settings, RenderStats* stats) {
  Image image;
  const RenderStats rendered = RenderInto(plan, settings, &image);
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

std::string UnsettledNote(const FramePlan& plan, const RenderStats& stats) {
  if (stats.unsettled_pixels == 0) return {};
  return fmt::format("{} of {} pixels did not settle within {} samples", stats.unsettled_pixels,
                     plan.window.pixel_count(), stats.pixel_samples.most);
}

}  // namespace nacre
