// SPDX-License-Identifier: Apache-2.0
// bench/visibility_bench.cc: camera rays against spheres: the exact hits of a 1920x1080 frame,
// one thread, by number of spheres. bench/embree_baseline.cc is what they are held against.
#include <algorithm>
#include <string>

#include <benchmark/benchmark.h>

#include "base/parallel.h"
#include "render/camera.h"
#include "sampling/pixel_sampler.h"
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
  constexpr int kBatch = static_cast<int>(kBatchCapacity);
  for (auto _ : state) {
    for (int row = 0; row < kHeight; ++row) {
      for (int first = 0; first < kWidth; first += kBatch) {
        const int count = std::min(kBatch, kWidth - first);
        for (int i = 0; i < count; ++i) x[static_cast<size_t>(i)] = first + i + 0.5;
        std::fill_n(y.data(), count, row + 0.5);
        MakeCameraRays(camera, x.data(), y.data(), static_cast<size_t>(count), &rays);
        intersector.Closest(rays, &hits);
        benchmark::DoNotOptimize(hits.primitive.data());
      }
    }
  }
  state.SetItemsProcessed(state.iterations() * kWidth * kHeight);
}

// The same frame by tiles as the renderer goes about it: with the binning of every frame, the film
// positions, and the hits' points and normals. Embree's tree above is built before.
void BenchTiles(benchmark::State& state, const SphereScene& which) {
  const FlushDenormals flush;
  const Scene scene = MakeSphereScene(which);
  Intersector intersector(scene, scene.camera.position, {.embree = false});
  const CameraFrame camera = MakeCameraFrame(scene.camera, kWidth, kHeight);
  const Window frame{0, 0, kWidth, kHeight};
  const PixelSampler sampler = MakePixelSampler(scene.image.filter, 1, 0);
  PixelShifts shifts{kBatchCapacity};
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
        if (!intersector.EnterTile(tile, TileRays::kSamples, &candidates)) continue;
        film.count = tile.pixel_count();
        SamplePixels(sampler, tile, shifts, 0, 1, film.x.data(), film.y.data());
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
