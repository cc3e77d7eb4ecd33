// SPDX-License-Identifier: Apache-2.0
// bench/frame_bench.cc: whole frames in memory, by stage: planning included, files and process
// start left out. One thread unless the name says otherwise.
//
//   frame/SCENE/WIDTHxHEIGHT/SPPspp/TARGET[/VARIANT]
#include <algorithm>
#include <string>
#include <variant>
#include <vector>

#include <benchmark/benchmark.h>

#include "base/parallel.h"
#include "base/target.h"
#include "render/render.h"
#include "scene_io/load_scene.h"

namespace nacre {
namespace {

// Scenes as they are, and the material grid in two further forms.
//   material_grid           the default material; nacre finds that 2 of the 25 spheres can lie in
//                           another's shadow, and casts shadow rays there
//   material_grid_plain     Schlick's shadowing, no compensation: the sum of the usual two terms
//   material_grid_shadows   the light beside the grid, so that spheres shadow one another
Scene LoadBenchScene(const std::string& name) {
  const std::string grid = "material_grid";
  const bool is_grid = name.compare(0, grid.size(), grid) == 0;
  const std::string file = is_grid ? grid : name;
  LoadOptions options;
  // bench/cases.py renders the same scene by the same two overrides.
  if (name == "material_grid_shadows") {
    options.overrides = {{"/lights/key/position", "[12, 1.5, 3]"}};
  }
  Scene scene = LoadScene(std::string(NACRE_SOURCE_DIR) + "/scenes/" + file + ".json", options);
  if (name != "material_grid_plain") return scene;
  for (Material& material : scene.materials) {
    auto* model = std::get_if<MetallicRoughnessMaterial>(&material.model);
    if (model == nullptr) continue;
    model->shadowing = Shadowing::kSchlickDirect;
    model->compensation = Compensation::kNone;
    model->diffuse_coupling = DiffuseCoupling::kOneMinusFresnel;
  }
  return scene;
}

struct FrameCase {
  std::string scene;
  int width = 1920;
  int height = 1080;
  int spp = 1;
  Target target = Target::kScalar;
  // "", "no_shadows", or "embree", "general_path" or "threads2" (see Settings).
  std::string variant{};

  std::string Name() const {
    return "frame/" + scene + "/" + std::to_string(width) + "x" + std::to_string(height) + "/" +
           std::to_string(spp) + "spp/" + TargetName(target) +
           (variant.empty() ? "" : "/" + variant);
  }

  RenderSettings Settings() const {
    RenderSettings settings{.threads = variant == "threads2" ? 2 : 1,
                            .general_path = variant == "general_path"};
    if (variant == "embree") settings.intersector = IntersectorChoice::kEmbree;
    return settings;
  }
};

void BenchFrame(benchmark::State& state, const FrameCase& which) {
  PinTarget(which.target);
  Scene scene = LoadBenchScene(which.scene);
  scene.image.width = which.width;
  scene.image.height = which.height;
  scene.image.spp = which.spp;
  if (which.variant == "no_shadows") scene.image.shadows = false;
  RenderSettings settings = which.Settings();
  const auto render = [&] {
    const FramePlan plan = MakePlan(scene, settings);
    return Render(plan, settings, [](const Strip& strip) {
      benchmark::DoNotOptimize(strip.colors.front().data());
    });
  };
  uint64_t rays = 0;
  for (auto _ : state) {
    const RenderStats stats = render();
    rays += stats.camera_rays + stats.shadow_rays;
  }
  state.counters["rays_per_s"] =
      benchmark::Counter(static_cast<double>(rays), benchmark::Counter::kIsRate);
  // Their shares are of frames of their own, as to ask for them takes time, too.
  settings.time_stages = true;
  RenderStats total;
  const int64_t frames = std::max<int64_t>(state.iterations() / 4, 1);
  for (int64_t i = 0; i < frames; ++i) total.Add(render());
  for (size_t i = 0; i < kStageCount; ++i) {
    const Stage stage = static_cast<Stage>(i);
    state.counters["ms_" + std::string(StageName(stage))] =
        1e3 * total.seconds(stage) / static_cast<double>(frames);
  }
  PinTarget(SupportedTargets().back());
}

// Whole frames of every scene, on every target at one sample a pixel.
std::vector<FrameCase> FullFrames() {
  std::vector<FrameCase> cases;
  const Target best = SupportedTargets().back();
  for (const char* scene : {"material_grid", "material_grid_plain", "material_grid_shadows",
                            "phong_vs_pbr", "mesh_and_spheres"}) {
    for (const Target target : SupportedTargets())
      cases.push_back({.scene = scene, .target = target});
    cases.push_back({.scene = scene, .spp = 16, .target = best});
    for (const char* variant : {"embree", "general_path", "threads2"}) {
      if (variant == std::string("threads2") && ThreadCount(0) < 2) continue;
      cases.push_back({.scene = scene, .target = best, .variant = variant});
    }
  }
  for (const char* scene : {"material_grid", "material_grid_plain"}) {
    for (const int spp : {1, 16}) {
      cases.push_back({.scene = scene, .spp = spp, .target = best, .variant = "no_shadows"});
    }
  }
  return cases;
}

// Small frames at many sample counts, for time against error.
std::vector<FrameCase> PrecisionFrames() {
  std::vector<FrameCase> cases;
  const auto add = [&](int spp, Target target, const char* variant) {
    cases.push_back({"material_grid", 480, 270, spp, target, variant});
  };
  for (const int spp : {1, 2, 4, 8, 16, 32, 64, 128, 256}) {
    for (const Target target : SupportedTargets()) add(spp, target, "");
    add(spp, SupportedTargets().back(), "embree");
    add(spp, SupportedTargets().back(), "general_path");
  }
  return cases;
}

const bool kRegistered = [] {
  for (const std::vector<FrameCase>& cases : {FullFrames(), PrecisionFrames()}) {
    for (const FrameCase& which : cases) {
      auto* frame = benchmark::RegisterBenchmark(which.Name().c_str(), BenchFrame, which);
      frame->Unit(benchmark::kMillisecond);
      if (which.Settings().threads > 1) frame->UseRealTime();
    }
  }
  return true;
}();

}  // namespace
}  // namespace nacre
