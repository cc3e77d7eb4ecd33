// SPDX-License-Identifier: Apache-2.0
// bench/nested_bench.cc: small frames of very many spheres that lie within one another, planning
// included: without a tree of shells (visibility/shell_tree.h) every ray is tested against most of
// them, and frames take a hundred times as long and more. One thread.
//
//   nested/KIND/SPHERES
#include <random>
#include <string>

#include <benchmark/benchmark.h>

#include "render/render.h"

namespace nacre {
namespace {

enum class NestedKind { kConcentric, kCoincident, kOverlapping, kAroundEye };

struct NestedCase {
  const char* name;
  NestedKind kind;
};

Scene MakeNestedScene(NestedKind kind, int count) {
  Scene scene;
  scene.image.width = 96;
  scene.image.height = 72;
  scene.image.spp = 4;
  scene.camera.position = {0, 0, kind == NestedKind::kAroundEye ? 0.1 : 5.0};
  scene.camera.look_at = {0, 0, 0};
  scene.materials.emplace_back();
  Light lamp;
  lamp.name = "lamp";
  lamp.kind = PointLight{.position = {0.4, 0.5, 4}, .intensity = Rgb(40)};
  scene.lights.push_back(lamp);
  std::mt19937 random(1);
  std::uniform_real_distribution<double> jitter(-0.05, 0.05);
  for (int i = 0; i < count; ++i) {
    Sphere sphere{.center = {0, 0, 0}, .radius = 1, .material = {0}};
    if (kind == NestedKind::kConcentric || kind == NestedKind::kAroundEye) {
      sphere.radius = 0.5 + 1.0 * i / count;
    } else if (kind == NestedKind::kOverlapping) {
      sphere.center = {jitter(random), jitter(random), jitter(random)};
    }
    scene.spheres.push_back(sphere);
  }
  return scene;
}

void BenchNested(benchmark::State& state, NestedKind kind, int count) {
  const Scene scene = MakeNestedScene(kind, count);
  RenderSettings settings{.threads = 1};
  for (auto _ : state) {
    const FramePlan plan = MakePlan(scene, settings);
    Render(plan, settings,
           [](const Strip& strip) { benchmark::DoNotOptimize(strip.colors.front().data()); });
  }
}

const bool kRegistered = [] {
  for (const NestedCase& which : {NestedCase{"concentric", NestedKind::kConcentric},
                                  NestedCase{"coincident", NestedKind::kCoincident},
                                  NestedCase{"overlapping", NestedKind::kOverlapping},
                                  NestedCase{"around_eye", NestedKind::kAroundEye}}) {
    for (const int count : {1000, 100'000}) {
      const std::string name =
          std::string("nested/") + which.name + (count == 1000 ? "/1e3" : "/1e5");
      benchmark::RegisterBenchmark(name.c_str(), BenchNested, which.kind, count)
          ->Unit(benchmark::kMillisecond);
    }
  }
  return true;
}();

}  // namespace
}  // namespace nacre
