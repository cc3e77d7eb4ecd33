// SPDX-License-Identifier: Apache-2.0
// bench/visibility_bench.cc: camera rays against spheres: the exact hits of a 1920x1080 frame,
// one thread, by number of spheres. bench/embree_baseline.cc is what they are held against.
#include <cstdlib>
#include <string>

#include <benchmark/benchmark.h>

#include "base/parallel.h"
#include "render/camera.h"
#include "visibility/intersector.h"
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
  AlignedArray<double> x(kBatchCapacity), y(kBatchCapacity);
  constexpr int kPixels = kWidth * kHeight;
  for (auto _ : state) {
    for (int first = 0; first < kPixels; first += static_cast<int>(kBatchCapacity)) {
      const int count = std::min(static_cast<int>(kBatchCapacity), kPixels - first);
      for (int i = 0; i < count; ++i) {
        const std::div_t row_and_column = std::div(first + i, kWidth);
        x[static_cast<size_t>(i)] = row_and_column.rem + 0.5;
        y[static_cast<size_t>(i)] = row_and_column.quot + 0.5;
      }
      MakeCameraRays(camera, x.data(), y.data(), static_cast<size_t>(count), &rays);
      intersector.Closest(rays, &hits);
      benchmark::DoNotOptimize(hits.primitive.data());
    }
  }
  state.SetItemsProcessed(state.iterations() * kPixels);
}

// The same frame by tiles, with the binning of every frame and the hits' points and normals;
// Embree's tree above is built before.
void BenchTiles(benchmark::State& state, const SphereScene& which) {
  const FlushDenormals flush;
  const Scene scene = MakeSphereScene(which);
  Intersector intersector(scene, scene.camera.position, {.embree = false});
  const CameraFrame camera = MakeCameraFrame(scene.camera, kWidth, kHeight);
  const Window frame{0, 0, kWidth, kHeight};
  TileCandidates candidates;
  FilmBatch film;
  HitBatch hits;
  HitDirections directions;
  constexpr int kTileWidth = static_cast<int>(kBatchCapacity) / kCellSize;
  for (auto _ : state) {
    intersector.BinForCamera(camera, frame, 0);
    for (int y0 = 0; y0 < kHeight; y0 += kCellSize) {
      for (int x0 = 0; x0 < kWidth; x0 += kTileWidth) {
        const Window tile{x0, y0, std::min(x0 + kTileWidth, kWidth),
                          std::min(y0 + kCellSize, kHeight)};
        if (!intersector.EnterTile(tile, &candidates)) continue;
        film.count = tile.pixel_count();
        for (size_t i = 0; i < film.count; ++i) {
          const std::div_t row_and_column = std::div(static_cast<int>(i), tile.width());
          film.x[i] = x0 + row_and_column.rem + 0.5;
          film.y[i] = y0 + row_and_column.quot + 0.5;
        }
        intersector.HitsInTile(candidates, film, {&hits, &directions, false});
        benchmark::DoNotOptimize(hits.count);
      }
    }
  }
  state.SetItemsProcessed(state.iterations() * kWidth * kHeight);
}

const bool kRegistered = [] {
  for (const SphereScene& which : SphereScenes()) {
    const std::string scene = which.name;
    benchmark::RegisterBenchmark(("visibility/tiles/" + scene).c_str(), BenchTiles, which)
        ->Unit(benchmark::kMillisecond);
    benchmark::RegisterBenchmark(("visibility/embree_user/" + scene).c_str(), BenchClosest, which)
        ->Unit(benchmark::kMillisecond);
  }
  return true;
}();

}  // namespace
}  // namespace nacre
