// SPDX-License-Identifier: Apache-2.0
// bench/math_bench.cc: time and error of the ways to compute one highlight: the textbook's formula
// in float (the scalar baseline's), the stable form in float, and half-vector terms in double.
// The renderer chooses between the last two by the material; here each does all widths.
//
//   math/LOBE/WIDTH/PATH, WIDTH a roughness or an exponent; the counter max_rel_error is the worst
//   within three widths of the peak (Phong: one and a half) against the formula in double
#include <cmath>
#include <functional>
#include <random>
#include <string>
#include <vector>

#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include "base/float_mode.h"
#include "base/target.h"
#include "batch_shader.h"
#include "brdf/ggx.h"
#include "brdf/phong.h"
#include "scalar_baseline.h"
#include "scene/material.h"

namespace nacre {
namespace {

constexpr size_t kHits = 512;
// All of these are floats, so that no path is charged with rounding its input.
const Vec3d kPosition(0, 0, -5);
const Vec3d kToView(0, 0, 1);
const Vec3d kLight(3.5, 1, -2);

Vec3d ToLight() { return (kLight - kPosition).normalized(); }
double Irradiance() { return 1 / (kLight - kPosition).length2(); }

// Normals within three widths of the half vector, where a lobe of that width is.
void FillHits(double width, HitBatch* hits) {
  hits->count = kHits;
  std::mt19937 random(5);
  std::uniform_real_distribution<double> uniform(-3, 3);
  const Vec3d half = (ToLight() + kToView).normalized();
  const Vec3d across = (half % Vec3d(0, 1, 0)).normalized();
  const Vec3d along = half % across;
  for (size_t i = 0; i < kHits; ++i) {
    const Vec3d n =
        (half + (across * uniform(random) + along * uniform(random)) * width).normalized();
    hits->normal.x[i] = n.x;
    hits->normal.y[i] = n.y;
    hits->normal.z[i] = n.z;
    hits->to_view.z[i] = kToView.z;
    hits->position.z[i] = kPosition.z;
  }
}

struct Lobe {
  std::string name;
  double width;                               // of the peak, in radians
  Material material;                          // of this lobe alone
  std::function<double(const Vec3d&)> truth;  // radiance where the normal is this
  std::function<void(const baseline::Hits&, const baseline::PointLight&)> textbook;
};

double MaxRelError(const HitBatch& hits, const Lobe& lobe, const float* got) {
  double worst = 0;
  for (size_t i = 0; i < kHits; ++i) {
    const double expected =
        lobe.truth(Vec3d(hits.normal.x[i], hits.normal.y[i], hits.normal.z[i])) * Irradiance();
    // std::max drops a NaN on its right.
    if (expected > 0) worst = std::max(std::abs(got[i] / expected - 1), worst);
  }
  return worst;
}

void Report(benchmark::State& state, double error) {
  state.SetItemsProcessed(state.iterations() * static_cast<int64_t>(kHits));
  state.counters["max_rel_error"] = error;
}

void SetDoubleTerms(bool value, ShadingMaterial* material) {
  if (auto* phong = std::get_if<PhongFamilyModel>(&material->model)) phong->double_terms = value;
  if (auto* ggx = std::get_if<MicrofacetModel>(&material->model)) ggx->double_terms = value;
}

void BenchStable(benchmark::State& state, const Lobe& lobe, bool double_terms) {
  const FlushDenormals flush;
  PreparedHits batch;
  FillHits(lobe.width, &batch.hits);
  PrepareSurface(batch.hits, &batch.surface);
  ShadingMaterial material = PrepareMaterial(lobe.material);
  SetDoubleTerms(double_terms, &material);
  BatchShader shader({material}, kHits, {.position = kLight, .intensity = Rgb(1)});
  ReflectedRadiance radiance;
  shader.Shade(&batch, &radiance);
  const double error = MaxRelError(batch.hits, lobe, radiance.specular.x.data());
  for (auto _ : state) {
    shader.Shade(&batch, &radiance);
    benchmark::ClobberMemory();
  }
  Report(state, error);
}

void BenchTextbook(benchmark::State& state, const Lobe& lobe) {
  const FlushDenormals flush;
  HitBatch hits;
  FillHits(lobe.width, &hits);
  Soa3<float> position, normal, to_view, sum;
  for (size_t i = 0; i < kHits; ++i) {
    position.z[i] = static_cast<float>(kPosition.z);
    normal.x[i] = static_cast<float>(hits.normal.x[i]);
    normal.y[i] = static_cast<float>(hits.normal.y[i]);
    normal.z[i] = static_cast<float>(hits.normal.z[i]);
    to_view.z[i] = static_cast<float>(kToView.z);
  }
  const baseline::Hits arrays{position.x.data(), position.y.data(), position.z.data(),
                              normal.x.data(),   normal.y.data(),   normal.z.data(),
                              to_view.x.data(),  to_view.y.data(),  to_view.z.data(),
                              sum.x.data(),      sum.y.data(),      sum.z.data()};
  const baseline::PointLight light{static_cast<float>(kLight.x),
                                   static_cast<float>(kLight.y),
                                   static_cast<float>(kLight.z),
                                   1,
                                   1,
                                   1};
  lobe.textbook(arrays, light);
  const double error = MaxRelError(hits, lobe, sum.x.data());
  for (auto _ : state) {
    lobe.textbook(arrays, light);
    benchmark::ClobberMemory();
  }
  Report(state, error);
}

Lobe MakeGgx(double roughness) {
  const double alpha = AlphaFromRoughness(roughness);
  return {fmt::format("ggx/{}", roughness), alpha,
          Material{.name = {},
                   .emission = {0, 0, 0},
                   .model = MetallicRoughnessMaterial{.base_color = Rgb(1),
                                                      .metallic = 1,
                                                      .roughness = roughness,
                                                      .compensation = Compensation::kNone,
                                                      .diffuse_coupling =
                                                          DiffuseCoupling::kOneMinusFresnel}},
          [alpha](const Vec3d& n) {
            const Angles<double> a = ComputeAngles(n, ToLight(), kToView);
            return GgxDistribution(a, alpha) *
                   VisibilityHeightCorrelated(a.n_dot_l, a.n_dot_v, alpha) * a.n_dot_l;
          },
          [roughness](const auto& hits, const auto& light) {
            baseline::ShadeGgxHeightCorrelated(hits, kHits, light,
                                               {{1, 1, 1}, 1, static_cast<float>(roughness)});
          }};
}

Lobe MakePhong(double shininess) {
  return {fmt::format("phong/{}", shininess), 0.5 / std::sqrt(shininess),
          Material{.name = {},
                   .emission = {0, 0, 0},
                   .model = PhongMaterial{.model = PhongModel::kPhong,
                                          .convention = PhongConvention::kClassic,
                                          .color = Rgb(1),
                                          .ka = Rgb(0),
                                          .kd = Rgb(0),
                                          .ks = Rgb(1),
                                          .shininess = shininess}},
          [shininess](const Vec3d& n) { return PhongLobe(n, ToLight(), kToView, shininess); },
          [shininess](const auto& hits, const auto& light) {
            static constexpr float kBlack[3] = {0, 0, 0};
            baseline::ShadePhong(hits, kHits, light, kBlack, 1, static_cast<float>(shininess));
          }};
}

const bool kRegistered = [] {
  std::vector<Lobe> lobes;
  for (const double roughness : {0.5, 0.3, 0.1, 0.05, 0.02, 0.01}) {
    lobes.push_back(MakeGgx(roughness));
  }
  for (const double shininess : {1e1, 1e2, 1e3, 1e4, 1e5, 1e6}) {
    lobes.push_back(MakePhong(shininess));
  }
  for (const Lobe& lobe : lobes) {
    const std::string prefix = "math/" + lobe.name + "/";
    benchmark::RegisterBenchmark((prefix + "textbook_scalar").c_str(), BenchTextbook, lobe);
    benchmark::RegisterBenchmark((prefix + "stable_float").c_str(), BenchStable, lobe, false);
    benchmark::RegisterBenchmark((prefix + "double_terms").c_str(), BenchStable, lobe, true);
  }
  return true;
}();

}  // namespace
}  // namespace nacre
