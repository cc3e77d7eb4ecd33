// SPDX-License-Identifier: Apache-2.0
// bench/access_bench.cc: what it costs a kernel to come by its hits and materials. All that
// shading_bench.cc measures has its hits in L1 and L2 and one material for all; here the same
// light evaluation and shading with
//
//   one_material  the same, as the measure of the others
//   runs_of_16    hits sorted by material, 16 of each: as a tile of many materials is shaded
//   beyond_l2     one material, 16 MiB of hits
//
// access/MODEL/MODE/TARGET
#include <algorithm>
#include <random>
#include <string>
#include <vector>

#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include "base/float_mode.h"
#include "base/target.h"
#include "batch_shader.h"
#include "scene/material.h"

namespace nacre {
namespace {

constexpr size_t kHits = 512;
constexpr size_t kBeyondL2 = size_t{16} << 20;  // bytes

struct Access {
  const char* name;
  size_t run;    // hits of one material
  size_t bytes;  // that the hits take, about
};
constexpr Access kAccesses[] = {
    {"one_material", kHits, 0}, {"runs_of_16", 16, 0}, {"beyond_l2", kHits, kBeyondL2}};

// Hits all over the visible half of a unit sphere.
void FillHits(unsigned seed, HitBatch* hits) {
  hits->count = kHits;
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (size_t i = 0; i < kHits;) {
    const Vec3d n = Vec3d{uniform(random), uniform(random), uniform(random)}.normalized();
    const Vec3d position = n + Vec3d(0, 0, -6);
    const Vec3d to_view = -position.normalized();
    if ((n ^ to_view) <= 0) continue;
    hits->position.x[i] = position.x;
    hits->position.y[i] = position.y;
    hits->position.z[i] = position.z;
    hits->normal.x[i] = n.x;
    hits->normal.y[i] = n.y;
    hits->normal.z[i] = n.z;
    hits->to_view.x[i] = to_view.x;
    hits->to_view.y[i] = to_view.y;
    hits->to_view.z[i] = to_view.z;
    ++i;
  }
}

void BenchAccess(benchmark::State& state, const Material& material, const Access& access,
                 Target target) {
  PinTarget(target);
  const FlushDenormals flush;
  // What is read of a batch: positions in double, normals and view directions in float.
  constexpr size_t kBatchBytes = (3 * sizeof(double) + 6 * sizeof(float)) * kHits;
  std::vector<PreparedHits> batches(std::max(access.bytes / kBatchBytes, size_t{1}));
  for (size_t i = 0; i < batches.size(); ++i) {
    FillHits(static_cast<unsigned>(i), &batches[i].hits);
    PrepareSurface(batches[i].hits, &batches[i].surface);
  }
  BatchShader shader(std::vector<ShadingMaterial>(kHits / access.run, PrepareMaterial(material)),
                     access.run, {.position = {3, 4, 2}, .intensity = {60, 60, 60}});
  ReflectedRadiance radiance;
  size_t next = 0;
  for (auto _ : state) {
    shader.Shade(&batches[next], &radiance);
    next = next + 1 == batches.size() ? 0 : next + 1;
    benchmark::DoNotOptimize(radiance.diffuse.x.data());
    benchmark::ClobberMemory();
  }
  state.SetItemsProcessed(state.iterations() * static_cast<int64_t>(kHits));
  PinTarget(SupportedTargets().back());
}

struct NamedMaterial {
  const char* name;
  Material material;
};

std::vector<NamedMaterial> MakeMaterials() {
  const Rgb color(0.9, 0.6, 0.2);
  const auto material = [](auto model) {
    return Material{.name = {}, .emission = {0, 0, 0}, .model = model};
  };
  const MetallicRoughnessMaterial ggx{.base_color = color, .metallic = 0.5, .roughness = 0.3};
  MetallicRoughnessMaterial plain = ggx;
  plain.shadowing = Shadowing::kSchlickDirect;
  plain.compensation = Compensation::kNone;
  plain.diffuse_coupling = DiffuseCoupling::kOneMinusFresnel;
  return {{"lambert", material(LambertMaterial{color})},
          {"phong", material(PhongMaterial{.color = color, .shininess = 37.5})},
          {"ggx_plain_schlick_direct", material(plain)},
          {"ggx_default", material(ggx)}};
}

const bool kRegistered = [] {
  for (const NamedMaterial& named : MakeMaterials()) {
    for (const Access& access : kAccesses) {
      for (const Target target : SupportedTargets()) {
        benchmark::RegisterBenchmark(
            fmt::format("access/{}/{}/{}", named.name, access.name, TargetName(target)).c_str(),
            BenchAccess, named.material, access, target);
      }
    }
  }
  return true;
}();

}  // namespace
}  // namespace nacre
