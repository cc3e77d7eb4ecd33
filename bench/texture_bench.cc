// SPDX-License-Identifier: Apache-2.0
// bench/texture_bench.cc: what textures cost: look-ups alone, and all that is done for a run of 512
// hits on a sphere whose material has maps (coordinates, footprints, look-ups, what the maps make
// of the material, products with one light, reflection), beside shade/* of materials without.
//   texture/lookup_*       three channels of a 1024x1024 image at points like a sphere's
//   shade_mapped/*         one trilinear image for each map
#include <memory>
#include <random>
#include <string>

#include <benchmark/benchmark.h>

#include "base/float_mode.h"
#include "base/target.h"
#include "shading/shade.h"
#include "shading/textures.h"
#include "texture/sample_kernel.h"

namespace nacre {
namespace {

constexpr size_t kHits = 512;

MipChain MakeImage(int size) {
  std::mt19937 random(5);
  std::uniform_real_distribution<float> value(0.2f, 1);
  std::vector<float> values(3 * static_cast<size_t>(size) * static_cast<size_t>(size));
  for (float& v : values) v = value(random);
  return MakeMipChain(size, size, 3, std::move(values));
}

void ReportHits(benchmark::State& state) {
  state.SetItemsProcessed(state.iterations() * static_cast<int64_t>(kHits));
  state.counters["time_per_shade"] =
      benchmark::Counter(static_cast<double>(kHits), benchmark::Counter::kIsIterationInvariantRate |
                                                         benchmark::Counter::kInvert);
}

void BenchLookup(benchmark::State& state, TextureFilter filter, Target target) {
  PinTarget(target);
  const MipChain image = MakeImage(1024);
  AlignedArray<double> u(kHits), v(kHits);
  AlignedArray<float> footprint(kHits), zero(kHits),
      to[3] = {AlignedArray<float>(kHits), AlignedArray<float>(kHits), AlignedArray<float>(kHits)};
  for (size_t i = 0; i < kHits; ++i) {
    u[i] = 0.3 + 0.002 * static_cast<double>(i % 32);
    v[i] = 0.4 + 0.002 * static_cast<double>(i / 32);
    footprint[i] = 0.002f;
  }
  float* const channels[3] = {to[0].data(), to[1].data(), to[2].data()};
  for (auto _ : state) {
    SampleTexture(
        image, {filter, Wrap::kRepeat, Wrap::kClamp},
        {u.data(), v.data(), {footprint.data(), zero.data(), zero.data(), footprint.data()}, kHits},
        3, channels);
    benchmark::ClobberMemory();
  }
  ReportHits(state);
  PinTarget(SupportedTargets().back());
}

// A unit sphere seen from 6 in front of it.
Scene MakeScene(const Material& material) {
  Scene scene;
  scene.camera.position = Vec3d(0, 0, 6);
  scene.spheres = {{{0, 0, 0}, 1, {0}}};
  scene.materials = {material};
  scene.images = {{"image", std::make_shared<const MipChain>(MakeImage(1024)), 0.5f}};
  Texture texture{.image = ImageId{0}, .mapping = MappingKind::kSpherical};
  scene.textures = {texture};
  return scene;
}

HitBatch MakeHits() {
  HitBatch hits;
  hits.count = kHits;
  for (size_t i = 0; i < kHits; ++i) {
    const Vec3d n = Vec3d(-0.4 + 0.02 * static_cast<double>(i % 32),
                          -0.1 + 0.02 * static_cast<double>(i / 32), 0.9)
                        .normalized();
    const Vec3d position = n + Vec3d(0, 0, -6), to_view = -position.normalized();
    const auto put = [i](const Vec3d& value, Soa3<double>* to) {
      to->x[i] = value.x;
      to->y[i] = value.y;
      to->z[i] = value.z;
    };
    put(position, &hits.position);
    put(n, &hits.normal);
    put(to_view, &hits.to_view);
  }
  return hits;
}

CameraFrame MakeFrame() {
  return {Projection::kPerspective, {0, 0, -1}, {-0.25, 0.25, -1}, {5e-4, 0, 0}, {0, -5e-4, 0}};
}

void BenchMapped(benchmark::State& state, const Material& material, Target target) {
  PinTarget(target);
  const FlushDenormals flush;
  const Scene scene = MakeScene(material);
  KeptTables tables;
  const TextureScene textures = PrepareTextures(scene, 1, 0, &tables);
  const CameraFrame camera = MakeFrame();
  const ShadingMaterial prepared = PrepareMaterial(scene.materials[0]);
  HitBatch hits = MakeHits();
  Surface surface;
  PrepareSurface(hits, &surface);
  Light light{.kind = PointLight{.position = {3, 4, 8}, .intensity = {60, 60, 60}}};
  const ShadingLight shading_light = PrepareLight(light, scene.camera.position);
  LightBatch on_hits;
  const auto texture_hits = std::make_unique<HitParameters>();
  ShadeScratch scratch;
  ReflectedRadiance radiance;
  for (auto _ : state) {
    if (prepared.scene_material != nullptr) {
      TextureHits({textures, prepared, 0, kHits, hits, surface, *texture_hits, {&camera}});
    }
    PrepareRun(prepared, 0, kHits, &surface, texture_hits.get());
    EvaluateLight(shading_light, hits, surface, &on_hits);
    ShadeRun({{prepared, hits, surface, 0, kHits, texture_hits.get()},
              shading_light,
              &on_hits,
              &radiance},
             &scratch);
    benchmark::DoNotOptimize(radiance.diffuse.x.data());
    benchmark::ClobberMemory();
  }
  ReportHits(state);
  PinTarget(SupportedTargets().back());
}

struct MappedBench {
  const char* name;
  Material material;
};

std::vector<MappedBench> MakeMaterials() {
  const TextureId map{0};
  Material lambert, phong, plain, color, rough;
  lambert.model = LambertMaterial{.albedo = Rgb(0.8), .albedo_map = map};
  phong.model = PhongMaterial{.diffuse_map = map};
  plain.model = MetallicRoughnessMaterial{.roughness = 0.5};
  color.model = MetallicRoughnessMaterial{.roughness = 0.5, .base_color_map = map};
  rough.model = MetallicRoughnessMaterial{
      .metallic = 1, .roughness = 1, .base_color_map = map, .metallic_roughness_map = map};
  return {{"lambert", lambert},
          {"phong", phong},
          {"ggx_without_maps", plain},
          {"ggx_color", color},
          {"ggx_color_and_roughness", rough}};
}

const bool kRegistered = [] {
  constexpr std::pair<const char*, TextureFilter> kFilters[] = {
      {"nearest", TextureFilter::kNearest},
      {"bilinear", TextureFilter::kBilinear},
      {"trilinear", TextureFilter::kTrilinear}};
  for (const Target target : SupportedTargets()) {
    for (const auto& [name, filter] : kFilters) {
      benchmark::RegisterBenchmark(
          (std::string("texture/lookup_") + name + "/" + TargetName(target)).c_str(), BenchLookup,
          filter, target);
    }
    for (const MappedBench& mapped : MakeMaterials()) {
      benchmark::RegisterBenchmark(
          (std::string("shade_mapped/") + mapped.name + "/" + TargetName(target)).c_str(),
          BenchMapped, mapped.material, target);
    }
  }
  return true;
}();

}  // namespace
}  // namespace nacre
