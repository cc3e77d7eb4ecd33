// bench/shading_bench.cc: throughput of light evaluation plus shading: one point light, one
// uniform material, hits that stay in L1/L2; per model and target, with the scalar baseline in
// the same table.
#include <cmath>
#include <functional>
#include <random>

#include <benchmark/benchmark.h>

#include "base/parallel.h"
#include "base/target.h"
#include "scalar_baseline.h"
#include "shading/shade.h"

namespace nacre {
namespace {

constexpr size_t kHits = 512;
constexpr double kShininess = 37.5;
constexpr double kRoughness = 0.3;

// Hits all over the visible half of a unit sphere.
HitBatch MakeHits() {
  HitBatch hits;
  hits.count = kHits;
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (size_t i = 0; i < kHits;) {
    const Vec3d n = Vec3d(uniform(random), uniform(random), uniform(random)).normalized();
    const Vec3d position = n + Vec3d(0, 0, -6);
    const Vec3d to_view = -position.normalized();
    if ((n ^ to_view) <= 0) continue;
    hits.position.x[i] = position.x;
    hits.position.y[i] = position.y;
    hits.position.z[i] = position.z;
    hits.normal.x[i] = n.x;
    hits.normal.y[i] = n.y;
    hits.normal.z[i] = n.z;
    hits.to_view.x[i] = to_view.x;
    hits.to_view.y[i] = to_view.y;
    hits.to_view.z[i] = to_view.z;
    ++i;
  }
  return hits;
}

void ReportShades(benchmark::State& state) {
  state.SetItemsProcessed(state.iterations() * static_cast<int64_t>(kHits));
  state.counters["time_per_shade"] =
      benchmark::Counter(static_cast<double>(kHits), benchmark::Counter::kIsIterationInvariantRate |
                                                         benchmark::Counter::kInvert);
}

void BenchKernel(benchmark::State& state, const Material& material, Target target) {
  PinTarget(target);
  const FlushDenormals flush;
  const HitBatch hits = MakeHits();
  Light light;
  light.kind = PointLight{.position = {3, 4, 2}, .intensity = {60, 60, 60}, .attenuation = {}};
  Surface surface;
  ReflectedRadiance radiance;
  NarrowLobes scratch;
  const ShadingMaterial prepared = PrepareMaterial(material, {0, 0, 0});
  PrepareSurface(hits, &surface);
  const ShadingLight prepared_light = PrepareLight(light, {0, 0, 0});
  const LightOnBatch on_batch{&prepared_light, nullptr};
  for (auto _ : state) {
    PrepareRun(prepared, 0, kHits, &surface);
    ShadeRun(prepared, {hits, surface, {&on_batch, 1}}, 0, kHits, &scratch, &radiance);
    benchmark::DoNotOptimize(radiance.diffuse.x.data());
    benchmark::ClobberMemory();
  }
  ReportShades(state);
  PinTarget(SupportedTargets().back());
}

using BaselineKernel = std::function<void(const baseline::Hits&, const baseline::PointLight&)>;

void BenchBaseline(benchmark::State& state, const BaselineKernel& kernel) {
  const FlushDenormals flush;
  const HitBatch hits = MakeHits();
  Soa3<float> position;
  for (size_t i = 0; i < kHits; ++i) {
    position.x[i] = static_cast<float>(hits.position.x[i]);
    position.y[i] = static_cast<float>(hits.position.y[i]);
    position.z[i] = static_cast<float>(hits.position.z[i]);
  }
  Surface surface;
  PrepareSurface(hits, &surface);
  Soa3<float> sum;
  const Soa3<float>& n = surface.normal;
  const Soa3<float>& v = surface.to_view;
  const baseline::Hits arrays{position.x.data(), position.y.data(), position.z.data(),
                              n.x.data(),        n.y.data(),        n.z.data(),
                              v.x.data(),        v.y.data(),        v.z.data(),
                              sum.x.data(),      sum.y.data(),      sum.z.data()};
  const baseline::PointLight light{3, 4, 2, 60, 60, 60};
  for (auto _ : state) {
    kernel(arrays, light);
    benchmark::ClobberMemory();
  }
  ReportShades(state);
}

struct ModelBench {
  const char* name;
  Material material;
  BaselineKernel baseline;  // null: the baseline has no such model
};

std::vector<ModelBench> MakeModels() {
  static constexpr float kColor[3] = {0.9f, 0.6f, 0.2f};
  const Rgb color(0.9, 0.6, 0.2);
  const auto phong = [&](PhongModel model) {
    return Material{.name = {},
                    .emission = {0, 0, 0},
                    .model = PhongMaterial{.model = model,
                                           .convention = PhongConvention::kClassic,
                                           .color = color,
                                           .ka = {0, 0, 0},
                                           .kd = {0.7, 0.7, 0.7},
                                           .ks = {0.5, 0.5, 0.5},
                                           .shininess = kShininess}};
  };
  const auto ggx = [&](Shadowing shadowing) {
    return Material{
        .name = {},
        .emission = {0, 0, 0},
        .model = MetallicRoughnessMaterial{
            .base_color = color, .metallic = 0.5, .roughness = kRoughness, .shadowing = shadowing}};
  };
  const auto plain_ggx = [&](Shadowing shadowing) {
    Material material = ggx(shadowing);
    auto& model = std::get<MetallicRoughnessMaterial>(material.model);
    model.compensation = Compensation::kNone;
    model.diffuse_coupling = DiffuseCoupling::kOneMinusFresnel;
    return material;
  };
  const baseline::MetallicRoughness scalar_ggx{
      {0.9f, 0.6f, 0.2f}, 0.5f, static_cast<float>(kRoughness)};
  const float shininess = static_cast<float>(kShininess);
  return {
      {"lambert",
       {.name = {}, .emission = {0, 0, 0}, .model = LambertMaterial{color}},
       [](const auto& hits, const auto& light) {
         baseline::ShadeLambert(hits, kHits, light, kColor);
       }},
      {"phong", phong(PhongModel::kPhong),
       [=](const auto& hits, const auto& light) {
         baseline::ShadePhong(hits, kHits, light, kColor, 0.5f, shininess);
       }},
      {"modified_phong", phong(PhongModel::kModifiedPhong), nullptr},
      {"blinn_phong", phong(PhongModel::kBlinnPhong),
       [=](const auto& hits, const auto& light) {
         baseline::ShadeBlinnPhong(hits, kHits, light, kColor, 0.5f, shininess);
       }},
      {"ggx_plain_schlick_direct", plain_ggx(Shadowing::kSchlickDirect),
       [=](const auto& hits, const auto& light) {
         baseline::ShadeGgxSchlickDirect(hits, kHits, light, scalar_ggx);
       }},
      {"ggx_plain_height_correlated", plain_ggx(Shadowing::kHeightCorrelated),
       [=](const auto& hits, const auto& light) {
         baseline::ShadeGgxHeightCorrelated(hits, kHits, light, scalar_ggx);
       }},
      {"ggx_default", ggx(Shadowing::kHeightCorrelated), nullptr},
      {"ggx_plain_separable", plain_ggx(Shadowing::kSeparable), nullptr},
  };
}

const bool kRegistered = [] {
  for (const ModelBench& model : MakeModels()) {
    const std::string prefix = std::string("shade/") + model.name + "/";
    if (model.baseline) {
      benchmark::RegisterBenchmark((prefix + "scalar_baseline").c_str(), BenchBaseline,
                                   model.baseline);
    }
    for (const Target target : SupportedTargets()) {
      benchmark::RegisterBenchmark((prefix + TargetName(target)).c_str(), BenchKernel,
                                   model.material, target);
    }
  }
  return true;
}();

}  // namespace
}  // namespace nacre
