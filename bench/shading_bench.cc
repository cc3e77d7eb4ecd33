// SPDX-License-Identifier: Apache-2.0
// bench/shading_bench.cc: throughput of shading: a run of 512 hits of one material, in L1, under
// one point light. All that is done per hit is counted: the light's direction and fall-off, from
// positions in double, what the material prepares per view, reflection. Per model and
// target: time per hit and light, beside the scalar baseline of the same table: plain per-hit float
// C++ in the textbook's form, x^5 by multiplication, -O3 -march=native (scalar_baseline.h).
//   ggx_plain_*            glTF's form: no compensation, diffuse 1 - F; the baseline's formula
//   ggx_default            with Turquin's compensation and a base scaled by the lobe's albedo
//   open_pbr_*             by the specification's text, with Kulla and Conty's compensation
//   stack_*                whole materials by EvaluateBsdf; the baseline is the scalar twin, in
//                          double, which evaluates per light what kernels evaluate per view
//   *_double_terms         lobes so narrow that their half vector is formed in double
//   *_in_lobe              hits that have Phong's lobe; everywhere else three of four have none, of
//                          which plain C++ knows the power at once
//   *_from_behind          the light is behind the sphere, and half vectors are formed with care
//                          (ForHalfAngles in packets-inl.h)
//   textbook_*, naive_*    SIMD, but the textbook's forms: what stability costs. Their constants,
//                          which else every run makes of material and light, are given them;
//   given_*                and these, of Phong's family, for a comparison of like with like
#include <cmath>
#include <functional>
#include <random>

#include <benchmark/benchmark.h>

#include "base/float_mode.h"
#include "base/target.h"
#include "scalar_baseline.h"
#include "scene/coat.h"
#include "scene/material.h"
#include "shading/bsdf.h"
#include "shading/scalar_bsdf.h"
#include "shading/shade.h"
#include "textbook_kernel.h"

namespace nacre {
namespace {

constexpr size_t kHits = 512;
constexpr double kShininess = 37.5;
constexpr double kRoughness = 0.3;

const Sphere kSphere{.center = {0, 0, -6}, .radius = 1, .material = {}};

const Vec3d kLight{3, 4, 2};

bool HasPhongLobe(const Vec3d& n, const Vec3d& to_light, const Vec3d& to_view) {
  const double n_dot_l = n ^ to_light;
  return n_dot_l > 0 && 2 * n_dot_l * (n ^ to_view) > (to_light ^ to_view);
}

// Hits all over the visible half of the sphere, or on as much of it as has Phong's lobe of kLight.
HitBatch MakeHits(bool in_lobe) {
  HitBatch hits;
  hits.count = kHits;
  hits.one_primitive = true;
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (size_t i = 0; i < kHits;) {
    const Vec3d n = Vec3d{uniform(random), uniform(random), uniform(random)}.normalized();
    const Vec3d position = n + kSphere.center;
    const Vec3d to_view = -position.normalized();
    if ((n ^ to_view) <= 0) continue;
    const Vec3d to_light = (kLight - position).normalized();
    if (in_lobe && !HasPhongLobe(n, to_light, to_view)) continue;
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

// Where the light and the hits are.
struct Places {
  bool from_behind = false;  // the light is behind the sphere, not kLight
  bool in_lobe = false;      // the hits are chosen by kLight
  bool by_position = false;  // it is evaluated from the hits' positions, as lights near spheres are
};

// Runs shade(lit, surface) for hits of a material on a target.
template <class Shade>
void BenchShade(benchmark::State& state, const ShadingMaterial& material, Target target,
                const Places& places, const Shade& shade) {
  PinTarget(target);
  const FlushDenormals flush;
  const HitBatch hits = MakeHits(places.in_lobe);
  Surface surface;
  LightBatch on_hits;
  ReflectedRadiance radiance;
  PrepareSurface(hits, &surface);
  Light source{
      .kind = PointLight{.position = {kLight.x, kLight.y, places.from_behind ? -20.0 : kLight.z},
                         .intensity = {60, 60, 60}}};
  ShadingLight light = PrepareLight(source, {0, 0, 0});
  if (!places.by_position && !OffsetFromSpheres({&kSphere, 1}, {0, 0, 0}, &light)) {
    state.SkipWithError("the light is too near for its offset from the sphere");
  }
  const LitHits lit{{material, hits, surface, 0, kHits},
                    light,
                    places.by_position ? &on_hits : nullptr,
                    &radiance,
                    false};
  for (auto _ : state) {
    if (places.by_position) EvaluateLight(light, hits, surface, &on_hits);
    shade(lit, &surface);
    benchmark::DoNotOptimize(radiance.sum.x.data());
    benchmark::ClobberMemory();
  }
  ReportShades(state);
  PinTarget(SupportedTargets().back());
}

void BenchKernel(benchmark::State& state, const Material& material, Target target,
                 const Places& places) {
  ShadeScratch scratch;
  const ShadingMaterial prepared = PrepareMaterial(material);
  BenchShade(state, prepared, target, places, [&](const LitHits& lit, Surface* surface) {
    PrepareRun(prepared, 0, kHits, surface);
    ShadeRun(lit, &scratch);
  });
}

// The same of a whole stack: layers, coats, and lobes that need a tangent.
void BenchStack(benchmark::State& state, const Material& material, Target target) {
  const ShadingMaterial prepared = PrepareMaterial(material);
  BsdfRoom room;
  std::vector<CoatHits> coats(prepared.coats.size());
  LightBatch on_hits;
  bool is_first = true;
  BenchShade(state, prepared, target, {}, [&](const LitHits& lit, Surface* surface) {
    if (is_first) {
      for (size_t i = 0; i < kHits; ++i) {
        const Vec3d normal(VectorAt(surface->normal, i));
        SetVector(DefaultTangent(prepared, normal), i, &surface->tangent);
      }
      for (CoatHits& coat : coats) {
        CopyToCoat(lit.hits, *surface, &coat);
        CopySoa(surface->tangent, kHits, &coat.surface.tangent);
      }
      is_first = false;
    }
    EvaluateLight(lit.light, lit.hits, *surface, &on_hits);
    PrepareBsdf(prepared, 0, kHits, nullptr, surface, coats);
    EvaluateBsdf({{prepared, lit.hits, *surface, 0, kHits, nullptr, coats},
                  lit.light,
                  &on_hits,
                  lit.radiance,
                  false},
                 &room);
  });
}

void BenchTwin(benchmark::State& state, const Material& material) {
  const ShadingMaterial prepared = PrepareMaterial(material);
  const HitBatch hits = MakeHits(false);
  Surface surface;
  PrepareSurface(hits, &surface);
  Rgb sum(0);
  for (auto _ : state) {
    for (size_t i = 0; i < kHits; ++i) {
      const Vec3d to_light = kLight - VectorAt(hits.position, i);
      const double distance2 = to_light ^ to_light;
      const Reflection reflected =
          Reflect(prepared, Vec3d(VectorAt(surface.normal, i)).normalized(), to_light.normalized(),
                  Vec3d(VectorAt(surface.to_view, i)).normalized());
      sum += reflected.Sum() * (60 / distance2);
    }
    benchmark::DoNotOptimize(sum);
  }
  ReportShades(state);
}

std::vector<std::pair<const char*, Material>> MakeStacks() {
  const OpenPbrMaterial base{.base_color = Rgb(0.9, 0.6, 0.2)};
  std::vector<std::pair<const char*, Material>> stacks;
  const auto add = [&](const char* name, const auto& change) {
    OpenPbrMaterial model = base;
    change(&model);
    stacks.emplace_back(name, Material{.model = model});
  };
  const auto coat = [](OpenPbrMaterial* m) { m->coat_weight = 1, m->coat_roughness = 0.2; };
  const auto coloured = [=](OpenPbrMaterial* m) { coat(m), m->coat_color = Rgb(0.9, 0.6, 0.3); };
  const auto fuzz = [](OpenPbrMaterial* m) { m->fuzz_weight = 1; };
  const auto film = [](OpenPbrMaterial* m) { m->thin_film_weight = 1; };
  const auto brushed = [](OpenPbrMaterial* m) { m->specular_roughness_anisotropy = 0.7; };
  add("stack_open_pbr", [](OpenPbrMaterial*) {});
  add("stack_open_pbr_coat", coat);
  add("stack_open_pbr_coloured_coat", coloured);
  add("stack_open_pbr_fuzz", fuzz);
  add("stack_open_pbr_film", film);
  add("stack_open_pbr_anisotropy", brushed);
  add("stack_open_pbr_everything", [=](OpenPbrMaterial* m) {
    coloured(m), fuzz(m), film(m), brushed(m);
    m->base_metalness = 0.5;
    m->base_diffuse_roughness = 0.5;
  });
  stacks.emplace_back("stack_metallic_roughness",
                      Material{.model = MetallicRoughnessMaterial{.base_color = base.base_color,
                                                                  .roughness = 0.3}});
  return stacks;
}

using TextbookKernel = void (*)(const TextbookGgxUniforms&, const LitHits&);

void BenchTextbookGgx(benchmark::State& state, TextbookKernel kernel, Target target) {
  const TextbookGgxLight light{{18, 12, 6}, {42, 48, 54}, {4, 3, 1}};
  const float alpha = static_cast<float>(kRoughness * kRoughness);
  const float k = static_cast<float>((kRoughness + 1) * (kRoughness + 1) / 8);
  const TextbookGgxUniforms uniforms{&light, alpha * alpha, k};
  BenchShade(state, {}, target, {}, [&](const LitHits& lit, Surface*) { kernel(uniforms, lit); });
}

using PhongKernel = void (*)(const PhongUniforms<float>&, const LitHits&);

void BenchGiven(benchmark::State& state, PhongKernel kernel, PhongModel model, Target target,
                bool in_lobe) {
  const PhongLight<float> light{{38, 25, 8}, {30, 30, 30}};
  const PhongUniforms<float> uniforms{model, {static_cast<float>(kShininess)}, light, nullptr};
  BenchShade(state, {}, target, {.in_lobe = in_lobe},
             [&](const LitHits& lit, Surface*) { kernel(uniforms, lit); });
}

struct GivenBench {
  const char* name;
  PhongKernel kernel;
  PhongModel model;
  bool in_lobe = false;
};

constexpr GivenBench kGiven[] = {
    {"given_phong", &ShadePhong, PhongModel::kPhong},
    {"given_phong_in_lobe", &ShadePhong, PhongModel::kPhong, true},
    {"given_blinn_phong", &ShadePhong, PhongModel::kBlinnPhong},
    {"naive_phong", &ShadeNaivePhong, PhongModel::kPhong},
    {"naive_phong_in_lobe", &ShadeNaivePhong, PhongModel::kPhong, true},
    {"naive_blinn_phong", &ShadeNaiveBlinnPhong, PhongModel::kBlinnPhong},
};

using BaselineKernel = std::function<void(const baseline::Hits&, const baseline::PointLight&)>;

void BenchBaseline(benchmark::State& state, const BaselineKernel& kernel, bool in_lobe) {
  const FlushDenormals flush;
  const HitBatch hits = MakeHits(in_lobe);
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
  const baseline::PointLight light{static_cast<float>(kLight.x),
                                   static_cast<float>(kLight.y),
                                   static_cast<float>(kLight.z),
                                   60,
                                   60,
                                   60};
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
  Places places = {};
};

std::vector<ModelBench> MakeModels() {
  static constexpr float kColor[3] = {0.9f, 0.6f, 0.2f};
  const Rgb color(0.9, 0.6, 0.2);
  const auto phong = [&](PhongModel model, double exponent = kShininess) {
    return Material{.name = {},
                    .emission = {0, 0, 0},
                    .model = PhongMaterial{.model = model,
                                           .convention = PhongConvention::kClassic,
                                           .color = color,
                                           .ka = {0, 0, 0},
                                           .kd = {0.7, 0.7, 0.7},
                                           .ks = {0.5, 0.5, 0.5},
                                           .shininess = exponent}};
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
  Material smooth = plain_ggx(Shadowing::kSchlickDirect);
  std::get<MetallicRoughnessMaterial>(smooth.model).roughness = kDoubleTermsRoughness / 2;
  const baseline::MetallicRoughness scalar_ggx{
      {0.9f, 0.6f, 0.2f}, 0.5f, static_cast<float>(kRoughness)};
  const float shininess = static_cast<float>(kShininess);
  const Material lambert{.name = {}, .emission = {0, 0, 0}, .model = LambertMaterial{color}};
  Material rough, burley, rough_base = ggx(Shadowing::kHeightCorrelated);
  rough.model = OrenNayarMaterial{.albedo = color};
  burley.model = BurleyMaterial{.albedo = color};
  std::get<MetallicRoughnessMaterial>(rough_base.model).diffuse = DiffuseForm::kOrenNayar;
  Material open_pbr, mix, film;
  open_pbr.model = OpenPbrMaterial{.base_color = color};
  mix.model = OpenPbrMaterial{.base_color = color, .base_metalness = 0.5};
  film.model = OpenPbrMaterial{.base_color = color, .base_metalness = 0.5, .thin_film_weight = 1};
  const BaselineKernel scalar_phong = [=](const auto& hits, const auto& light) {
    baseline::ShadePhong(hits, kHits, light, kColor, 0.5f, shininess);
  };
  return {
      {"lambert", lambert,
       [](const auto& hits, const auto& light) {
         baseline::ShadeLambert(hits, kHits, light, kColor);
       }},
      {"phong", phong(PhongModel::kPhong), scalar_phong},
      {"phong_in_lobe", phong(PhongModel::kPhong), scalar_phong, {.in_lobe = true}},
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
      {"ggx_plain_schlick_direct_from_behind",
       plain_ggx(Shadowing::kSchlickDirect),
       nullptr,
       {.from_behind = true}},
      {"lambert_by_position", lambert, nullptr, {.by_position = true}},
      {"phong_by_position", phong(PhongModel::kPhong), nullptr, {.by_position = true}},
      {"ggx_plain_schlick_direct_by_position",
       plain_ggx(Shadowing::kSchlickDirect),
       nullptr,
       {.by_position = true}},
      {"phong_double_terms", phong(PhongModel::kPhong, 2 * kDoubleTermsShininess), nullptr},
      {"blinn_phong_double_terms", phong(PhongModel::kBlinnPhong, 2 * kDoubleTermsShininess),
       nullptr},
      {"ggx_double_terms", smooth, nullptr},
      {"ggx_default", ggx(Shadowing::kHeightCorrelated), nullptr},
      {"ggx_plain_separable", plain_ggx(Shadowing::kSeparable), nullptr},
      {"oren_nayar", rough, nullptr},
      {"burley", burley, nullptr},
      {"ggx_default_oren_nayar_base", rough_base, nullptr},
      {"open_pbr_default", open_pbr, nullptr},
      {"open_pbr_mix", mix, nullptr},
      {"open_pbr_film", film, nullptr},
  };
}

const bool kRegistered = [] {
  for (const ModelBench& model : MakeModels()) {
    const std::string prefix = std::string("shade/") + model.name + "/";
    if (model.baseline) {
      benchmark::RegisterBenchmark((prefix + "scalar_baseline").c_str(), BenchBaseline,
                                   model.baseline, model.places.in_lobe);
    }
    for (const Target target : SupportedTargets()) {
      benchmark::RegisterBenchmark((prefix + TargetName(target)).c_str(), BenchKernel,
                                   model.material, target, model.places);
    }
  }
  for (const auto& [name, material] : MakeStacks()) {
    const std::string prefix = std::string("shade/") + name + "/";
    benchmark::RegisterBenchmark((prefix + "scalar_baseline").c_str(), BenchTwin, material);
    for (const Target target : SupportedTargets()) {
      benchmark::RegisterBenchmark((prefix + TargetName(target)).c_str(), BenchStack, material,
                                   target);
    }
  }
  for (const Target target : SupportedTargets()) {
    benchmark::RegisterBenchmark(("shade/textbook_ggx/" + TargetName(target)).c_str(),
                                 BenchTextbookGgx, &ShadeTextbookGgx, target);
    benchmark::RegisterBenchmark(("shade/textbook_ggx_as_written/" + TargetName(target)).c_str(),
                                 BenchTextbookGgx, &ShadeWrittenGgx, target);
    for (const GivenBench& given : kGiven) {
      benchmark::RegisterBenchmark(
          (std::string("shade/") + given.name + "/" + TargetName(target)).c_str(), BenchGiven,
          given.kernel, given.model, target, given.in_lobe);
    }
  }
  return true;
}();

}  // namespace
}  // namespace nacre
