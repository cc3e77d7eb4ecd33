// SPDX-License-Identifier: Apache-2.0
#include "render/forecast.h"

#include <algorithm>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

#include "base/parallel.h"
#include "base/seconds_since.h"
#include "base/strip.h"
#include "render/adaptive.h"
#include "sampling/hash.h"

namespace nacre {

std::optional<Forecast> ForecastRender(const FramePlan& plan, const RenderSettings& settings) {
  constexpr size_t kLeastCells = 16, kMostCells = 64, kOneIn = 64;
  if (!(plan.adaptive.max_error > 0)) return std::nullopt;
  const Window& window = plan.window;
  const int x0 = DownToCell(window.x0), y0 = DownToCell(window.y0);
  const auto columns = static_cast<size_t>((window.x1 - x0 + kCellSize - 1) / kCellSize);
  const size_t cells = columns * static_cast<size_t>((window.y1 - y0 + kCellSize - 1) / kCellSize);
  const size_t one_in = std::max(kOneIn, cells / kMostCells), count = cells / one_in;
  if (count < kLeastCells) return std::nullopt;
  struct Room {
    TileWork work;
    CellRoom cell;
  };
  std::mutex mutex;
  std::vector<std::unique_ptr<Room>> rooms;  // those that no thread uses
  RenderStats total;
  double seconds = 0;  // of all threads
  ParallelFor(count, settings.threads, [&](size_t i) {
    // One cell of each `one_in` cells is chosen at random, so that regular patterns in the picture
    // do not bias the estimate.
    const size_t number = i * one_in + HashCombine(i, one_in) % one_in;
    const int x = x0 + static_cast<int>(number % columns) * kCellSize;
    const int y = y0 + static_cast<int>(number / columns) * kCellSize;
    const Window cell{x, y, x + kCellSize, y + kCellSize}, part = Intersect(cell, window);
    std::unique_ptr<Room> room;
    {
      const std::lock_guard lock(mutex);
      if (!rooms.empty()) {
        room = std::move(rooms.back());
        rooms.pop_back();
      }
    }
    // A render makes one for each thread, which does not count as time that a cell takes.
    if (!room) room = std::make_unique<Room>();
    const auto start = std::chrono::steady_clock::now();
    room->work.cancel = settings.cancel;
    Strip strip;
    RenderStats stats;
    StageClock clock(nullptr);
    room->work.clock = &clock;
    room->work.stats = &stats;
    StartStrip(plan.film, part, nullptr, &strip);
    RenderCell(plan, cell, part, &room->work, &room->cell, &strip);
    const double taken = SecondsSince(start);
    const std::lock_guard lock(mutex);
    total.Add(stats);
    seconds += taken;
    rooms.push_back(std::move(room));
  });
  const double threads =  // strips are rendered in parallel
      std::min(ThreadCount(settings.threads), StripCount(window.height()));
  return Forecast{
      total.pixel_samples.Mean(),
      static_cast<double>(total.unsettled_pixels) / static_cast<double>(total.pixel_samples.pixels),
      seconds / static_cast<double>(count) * static_cast<double>(cells) / threads};
}

}  // namespace nacre
