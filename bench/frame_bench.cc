// bench/frame_bench.cc: whole frames in memory, one thread, by stage: planning included, files
// and process start left out.
#include <string>

#include <benchmark/benchmark.h>

#include "base/target.h"
#include "render/render.h"
#include "scene_io/load_scene.h"

namespace nacre {
namespace {

void BenchFrame(benchmark::State& state, const std::string& name, int spp, Target target) {
  PinTarget(target);
  Scene scene = LoadScene(std::string(NACRE_SOURCE_DIR) + "/scenes/" + name + ".json", {});
  scene.image.width = 1920;
  scene.image.height = 1080;
  scene.image.spp = spp;
  RenderSettings settings;
  settings.threads = 1;
  RenderStats total;
  for (auto _ : state) {
    const RenderPlan plan = MakePlan(scene, settings);
    total.Add(Render(plan, settings, [](const Strip& strip) {
      benchmark::DoNotOptimize(strip.colors.front().data());
    }));
  }
  const double frames = static_cast<double>(state.iterations());
  for (size_t i = 0; i < kStageCount; ++i) {
    const Stage stage = static_cast<Stage>(i);
    state.counters["ms_" + std::string(StageName(stage))] = 1e3 * total.seconds(stage) / frames;
  }
  state.counters["rays_per_s"] = benchmark::Counter(
      static_cast<double>(total.camera_rays + total.shadow_rays), benchmark::Counter::kIsRate);
  PinTarget(SupportedTargets().back());
}

const bool kRegistered = [] {
  const std::string sizes[] = {"material_grid", "phong_vs_pbr", "mesh_and_spheres"};
  for (const std::string& scene : sizes) {
    for (const int spp : {1, 16}) {
      for (const Target target : SupportedTargets()) {
        if (spp > 1 && target != SupportedTargets().back()) continue;
        benchmark::RegisterBenchmark(
            ("frame/" + scene + "/1920x1080/" + std::to_string(spp) + "spp/" + TargetName(target))
                .c_str(),
            BenchFrame, scene, spp, target)
            ->Unit(benchmark::kMillisecond);
      }
    }
  }
  return true;
}();

}  // namespace
}  // namespace nacre
