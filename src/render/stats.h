// SPDX-License-Identifier: Apache-2.0
// render/stats.h: counts and times of a render, and the clock that measures the times.
#pragma once

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdint>
#include <string_view>

namespace nacre {

// Stages of the work on a tile. Times are summed over threads.
enum class Stage : uint8_t {
  kSample,
  kIntersect,
  kSurfaces,
  kLight,
  kShadow,
  kShade,
  kFilm,
  kOutput
};
inline constexpr size_t kStageCount = 8;

constexpr std::string_view StageName(Stage stage) {
  constexpr std::string_view kNames[kStageCount] = {"sample", "intersect", "surfaces", "light",
                                                    "shadow", "shade",     "film",     "output"};
  return kNames[static_cast<size_t>(stage)];
}

// The numbers of samples per pixel.
struct PixelSampleCounts {
  uint64_t pixels = 0, samples = 0;
  uint32_t fewest = 0, most = 0;  // samples of a pixel

  void Add(uint32_t of_each, uint64_t of_pixels) {
    Add({of_pixels, of_pixels * of_each, of_each, of_each});
  }
  void Add(const PixelSampleCounts& part) {
    if (part.pixels == 0) return;
    fewest = pixels == 0 ? part.fewest : std::min(fewest, part.fewest);
    most = std::max(most, part.most);
    pixels += part.pixels;
    samples += part.samples;
  }
  double Mean() const {
    return pixels == 0 ? 0 : static_cast<double>(samples) / static_cast<double>(pixels);
  }
};

struct RenderStats {
  uint64_t camera_rays = 0;
  uint64_t hits = 0;
  uint64_t shadow_rays = 0;
  uint64_t light_batches = 0;       // lights times batches of hits
  uint64_t unsettled_pixels = 0;    // pixels of adaptive sampling that have not converged
  PixelSampleCounts pixel_samples;  // 0 for a pixel in which adaptive sampling expects no hit
  // Sampled directions with coordinates that are not finite. They add nothing; there should be
  // none.
  uint64_t directions_not_finite = 0;
  uint64_t shades = 0;  // number of evaluations of a light at a hit
  // In seconds, summed over threads. Without RenderSettings::time_stages only kOutput is measured.
  std::array<double, kStageCount> stage_seconds{};
  double plan_seconds = 0;    // wall-clock time of making the plan, including BVHs
  double render_seconds = 0;  // wall-clock time of rendering
  int threads = 0;

  double& seconds(Stage stage) { return stage_seconds[static_cast<size_t>(stage)]; }
  double seconds(Stage stage) const { return stage_seconds[static_cast<size_t>(stage)]; }

  // Adds the counts and stage times of a part of the work.
  void Add(const RenderStats& part) {
    camera_rays += part.camera_rays;
    hits += part.hits;
    shadow_rays += part.shadow_rays;
    light_batches += part.light_batches;
    shades += part.shades;
    directions_not_finite += part.directions_not_finite;
    unsettled_pixels += part.unsettled_pixels;
    pixel_samples.Add(part.pixel_samples);
    for (size_t i = 0; i < kStageCount; ++i) stage_seconds[i] += part.stage_seconds[i];
  }
};

// Charges the time since the last call to a stage. The destructor adds the times to the stats. The
// total comes from the system's clock, and its division into stages from the processor's counter:
// the system's clock at each call would take a twentieth of the time.
class StageClock {
 public:
  // Measures nothing if `stats` is null.
  explicit StageClock(RenderStats* stats) : stats_(stats) {}
  StageClock(const StageClock&) = delete;
  StageClock& operator=(const StageClock&) = delete;
  ~StageClock() {
    if (stats_ == nullptr) return;
    const double seconds = std::chrono::duration<double>(Clock::now() - start_).count();
    const auto ticks = static_cast<double>(Ticks() - first_tick_);
    if (!(ticks > 0)) return;
    for (size_t i = 0; i < kStageCount; ++i) {
      stats_->stage_seconds[i] += seconds * (static_cast<double>(stage_ticks_[i]) / ticks);
    }
  }

  void Charge(Stage stage) {
    if (stats_ == nullptr) return;
    const uint64_t now = Ticks();
    stage_ticks_[static_cast<size_t>(stage)] += now - last_tick_;
    last_tick_ = now;
  }

 private:
  using Clock = std::chrono::steady_clock;

  static uint64_t Ticks() {
#if defined(__x86_64__)
    return __builtin_ia32_rdtsc();
#else
    return static_cast<uint64_t>(Clock::now().time_since_epoch().count());
#endif
  }

  RenderStats* stats_;
  Clock::time_point start_ = Clock::now();
  uint64_t first_tick_ = Ticks();
  uint64_t last_tick_ = first_tick_;
  std::array<uint64_t, kStageCount> stage_ticks_{};
};

}  // namespace nacre
