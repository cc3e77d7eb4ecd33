// SPDX-License-Identifier: Apache-2.0
// bench/visibility_bench.cc: camera rays against spheres: the exact hits of a 1920x1080 frame,
// one thread, by number of spheres. bench/embree_baseline.cc is what they are held against.
#include <algorithm>
#include <cmath>
#include <string>

#include <benchmark/benchmark.h>

#include "base/float_mode.h"
#include "float_visibility.h"
#include "render/camera.h"
#include "render/frame_plan.h"
#include "sampling/pixel_sampler.h"
#include "visibility/intersector.h"
#include "visibility/sphere_bins.h"
#include "visibility_scenes.h"

namespace nacre {
namespace {

constexpr int kWidth = kFrameWidth;
constexpr int kHeight = kFrameHeight;

void BenchClosest(benchmark::State& state, const SphereScene& which) {
  const FlushDenormals flush;
  const Scene scene = MakeSphereScene(which);
  const Intersector intersector(scene, scene.camera.position, {});
  const CameraFrame camera = MakeCameraFrame(scene.camera, kWidth, kHeight);
  RayBatch rays;
  ClosestHits hits;
  FilmBatch film;
  constexpr int kBatch = static_cast<int>(kBatchCapacity);
  for (auto _ : state) {
    for (int row = 0; row < kHeight; ++row) {
      for (int first = 0; first < kWidth; first += kBatch) {
        const int count = std::min(kBatch, kWidth - first);
        film.count = static_cast<size_t>(count);
        for (int i = 0; i < count; ++i) film.x[static_cast<size_t>(i)] = first + i + 0.5;
        std::fill_n(film.y.data(), count, row + 0.5);
        MakeCameraRays(camera, film, &rays);
        intersector.Closest(rays, &hits);
        benchmark::DoNotOptimize(hits.primitive.data());
      }
    }
  }
  state.SetItemsProcessed(state.iterations() * kWidth * kHeight);
}

// Calls trace(tile) for the frame's tiles that rays may hit something in; they are in `candidates`.
template <class Trace>
void ForEachTile(const Intersector& intersector, TileCandidates* candidates, const Trace& trace) {
  for (int y0 = 0; y0 < kHeight; y0 += kCellSize) {
    for (int x0 = 0; x0 < kWidth; x0 += kMaxTileWidth) {
      const Window tile{x0, y0, std::min(x0 + kMaxTileWidth, kWidth),
                        std::min(y0 + kCellSize, kHeight)};
      if (intersector.EnterTile(tile, TileRays::kSamples, candidates)) trace(tile);
    }
  }
}

// The exact hits of tiles, as the renderer goes about them.
class ExactTiles {
 public:
  const HitBatch& Trace(const Intersector& intersector, const TileCandidates& candidates) {
    film_.count = film_.pixels = candidates.tile.pixel_count();
    PlaceCenters(candidates.tile, film_.x.data(), film_.y.data());
    intersector.HitsInTile(candidates, film_, {&hits_, &directions_, false});
    return hits_;
  }

 private:
  FilmBatch film_;
  HitBatch hits_;
  HitDirections directions_;
};

// The same frame by tiles: with the binning of every frame, the film positions, and the hits'
// positions, normals and view directions. Embree's tree above is built before.
void BenchTiles(benchmark::State& state, const SphereScene& which) {
  const FlushDenormals flush;
  const Scene scene = MakeSphereScene(which);
  Intersector intersector(scene, scene.camera.position, {.tree = false});
  const CameraFrame camera = MakeCameraFrame(scene.camera, kWidth, kHeight);
  TileCandidates candidates;
  ExactTiles tiles;
  size_t found = 0;
  for (auto _ : state) {
    intersector.BinForCamera(camera, {0, 0, kWidth, kHeight}, kPixelCenterMargin);
    found = 0;
    ForEachTile(intersector, &candidates, [&](const Window&) {
      size_t hits = tiles.Trace(intersector, candidates).count;
      benchmark::DoNotOptimize(hits);  // of constants newer versions warn
      found += hits;
    });
  }
  state.SetItemsProcessed(state.iterations() * kWidth * kHeight);
  state.counters["hits"] = static_cast<double>(found);
}

// The same tiles in float alone, and how far its hits are off: pixels whose nearest sphere is
// another one, and the largest error of a depth, over the sphere's radius.
void BenchFloatTiles(benchmark::State& state, const SphereScene& which) {
  const FlushDenormals flush;
  const Scene scene = MakeSphereScene(which);
  Intersector intersector(scene, scene.camera.position, {.tree = false});
  const std::vector<FloatSphere> spheres = FloatSpheres(scene);
  const CameraFrame camera = MakeCameraFrame(scene.camera, kWidth, kHeight);
  TileCandidates candidates;
  FloatHits hits;
  for (auto _ : state) {
    intersector.BinForCamera(camera, {0, 0, kWidth, kHeight}, kPixelCenterMargin);
    ForEachTile(intersector, &candidates, [&](const Window&) {
      TraceFloatTile(camera, spheres, candidates, &hits);
      benchmark::DoNotOptimize(hits.sphere.data());
    });
  }
  state.SetItemsProcessed(state.iterations() * kWidth * kHeight);

  int64_t wrong = 0, found = 0;
  double error = 0;
  ExactTiles exact_tiles;
  ForEachTile(intersector, &candidates, [&](const Window& tile) {
    std::fill_n(hits.sphere.data(), tile.pixel_count(), kNoPrimitive);
    TraceFloatTile(camera, spheres, candidates, &hits);
    const HitBatch& exact = exact_tiles.Trace(intersector, candidates);
    found += static_cast<int64_t>(exact.count);
    size_t next = 0;
    for (uint32_t ray = 0; ray < tile.pixel_count(); ++ray) {
      const bool is_hit = next < exact.count && exact.ray[next] == ray;
      const uint32_t sphere = is_hit ? exact.primitive[next] : kNoPrimitive;
      wrong += hits.sphere[ray] != sphere;
      if (is_hit && hits.sphere[ray] == sphere) {
        const Vec3d position{exact.position.x[next], exact.position.y[next],
                             exact.position.z[next]};
        const int x = tile.x0 + static_cast<int>(ray) % tile.width();
        const int y = tile.y0 + static_cast<int>(ray) / tile.width();
        const Vec3d direction =
            camera.corner + camera.step_x * (x + 0.5) + camera.step_y * (y + 0.5);
        error = std::max(error, std::abs(position.length() - hits.t[ray] * direction.length()) /
                                    scene.spheres[sphere].radius);
      }
      next += is_hit ? 1 : 0;
    }
  });
  state.counters["hits"] = static_cast<double>(found);
  state.counters["wrong_pixels"] = static_cast<double>(wrong);
  state.counters["depth_error"] = error;
}

const bool kRegistered = [] {
  for (const SphereScene& which : SphereScenes()) {
    const std::string scene = which.name;
    benchmark::RegisterBenchmark(("visibility/tiles/" + scene).c_str(), BenchTiles, which)
        ->Unit(benchmark::kMillisecond);
    benchmark::RegisterBenchmark(("visibility/float_tiles/" + scene).c_str(), BenchFloatTiles,
                                 which)
        ->Unit(benchmark::kMillisecond);
    benchmark::RegisterBenchmark(("visibility/embree_user/" + scene).c_str(), BenchClosest, which)
        ->Unit(benchmark::kMillisecond);
  }
  return true;
}();

}  // namespace
}  // namespace nacre
