// SPDX-License-Identifier: Apache-2.0
#include "stress/fuzz.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <memory>
#include <mutex>
#include <vector>

#include <fmt/format.h>

#include "base/parallel.h"
#include "brdf/albedo.h"
#include "shading/scalar_bsdf.h"
#include "shading/shade.h"
#include "stress/fuzz_draws.h"

namespace nacre {
namespace {

// Hits of a chunk, in runs of one material each. The second placement puts up to 16 others first.
constexpr size_t kHits = 1000;
constexpr size_t kRuns = 8;
constexpr size_t kRunLength = kHits / kRuns;
static_assert(kHits + 16 <= kBatchCapacity);

// A batch and what is reflected of it.
struct Placement {
  std::array<size_t, kHits> place;  // of each hit in the batch
  HitBatch hits;
  Surface surface;
  ShadingLight light;
  LightBatch evaluated;
  ShadeScratch scratch;
  ReflectedRadiance radiance;
};

struct Drawn {
  Vec3d position, normal, to_view;
};

void Set(const Vec3d& v, size_t i, Soa3<double>* to) {
  to->x[i] = v.x;
  to->y[i] = v.y;
  to->z[i] = v.z;
}

void Fill(const std::vector<Drawn>& drawn, const Light& light, Placement* p) {
  p->hits.count = 1 + *std::max_element(p->place.begin(), p->place.end());
  for (size_t i = 0; i < kHits; ++i) {
    Set(drawn[i].position, p->place[i], &p->hits.position);
    Set(drawn[i].normal, p->place[i], &p->hits.normal);
    Set(drawn[i].to_view, p->place[i], &p->hits.to_view);
  }
  PrepareSurface(p->hits, &p->surface);
  p->light = PrepareLight(light, Vec3d(0, 0, 0));
  EvaluateLight(p->light, p->hits, p->surface, &p->evaluated);
}

void Shade(const ShadingMaterial& material, const Rgb& color, size_t begin, size_t end,
           Placement* p) {
  p->light.color = color;
  for (size_t i = begin; material.by_hit.tangent && i < end; ++i) {
    SetVector(DefaultTangent(material, VectorAt(p->hits.normal, i)), i, &p->surface.tangent);
  }
  PrepareRun(material, begin, end, &p->surface);
  ShadeRun({{material, p->hits, p->surface, begin, end}, p->light, &p->evaluated, &p->radiance},
           &p->scratch);
}

// The bits of a hit's radiance.
std::array<uint32_t, 6> BitsOf(const Placement& p, size_t hit) {
  const size_t i = p.place[hit];
  const auto& [sum, diffuse, specular] = p.radiance;
  return {std::bit_cast<uint32_t>(diffuse.x[i]),  std::bit_cast<uint32_t>(diffuse.y[i]),
          std::bit_cast<uint32_t>(diffuse.z[i]),  std::bit_cast<uint32_t>(specular.x[i]),
          std::bit_cast<uint32_t>(specular.y[i]), std::bit_cast<uint32_t>(specular.z[i])};
}

uint64_t Mix(uint64_t hash, uint64_t value) {
  return (hash ^ value) * 0x100000001b3u + (hash >> 29);
}

// No lobe reflects more than this of irradiance 1, cosine included. GGX: D is at most 1 / (pi
// alpha^2), and V n.l at most 1 / (2 alpha), as Smith's roots are at least alpha; Turquin's scale
// is at most 1 / E. Phong's normalisations are below n + 8.
double LargestOfLobe(const ShadingMaterial& material) {
  if (const auto* phong = std::get_if<PhongFamilyModel>(&material.model)) {
    return phong->shininess + 8;
  }
  const auto* ggx = std::get_if<MicrofacetModel>(&material.model);
  if (ggx == nullptr) return 1;
  const double alpha = std::max(ggx->alpha, 0x1p-40);
  const double largest = 1 + 1 / (2 * M_PI * alpha * alpha * alpha);
  if (ggx->compensation != Compensation::kTurquin) return largest;
  return largest / (ggx->anisotropic ? 1 - LossOf(*ggx, 0.0) : AlbedoOne(ggx->albedo.lobe, 0.0));
}

// The same of all lobes of the material. The factor 10 is for Kulla and Conty's.
double LargestReflection(const Material& material) {
  const ShadingMaterial prepared = PrepareMaterial(material);
  double largest = LargestOfLobe(prepared);
  for (const auto& coat : prepared.coats) largest += LargestOfLobe(*coat);
  for (const LayerModel& layer : prepared.layers) {
    // Charlie's D is at most (2 + 1 / alpha) / (2 pi), and its visibility times n.l, 1 / (4 n.v)
    // with Smith's terms, which grow as 1 / n.v does, less than 100.
    const auto* sheen = std::get_if<SheenModel>(&layer);
    if (sheen != nullptr) largest += 100 * (2 + 1 / sheen->charlie.alpha) / (2 * M_PI);
  }
  return 10 * largest;
}

class ChunkFuzz {
 public:
  ChunkFuzz(uint64_t seed, FuzzResult* result) : random_(seed), result_(result) {
    light_.kind = PointLight{};
    constexpr Attenuation kAttenuations[] = {{1, 0, 0}, {0, 0, 1}, {0, 1, 0}, {0.5, 0.1, 0.01}};
    std::get<PointLight>(light_.kind).attenuation = random_.Pick(kAttenuations);
    std::vector<Drawn> drawn(kHits);
    for (Drawn& hit : drawn) {
      const FuzzDirections d = DrawDirections(&random_);
      hit = {-d.to_light * DrawDistance(&random_), d.normal, d.to_view};
    }
    const size_t first = random_.Below(17);
    for (size_t i = 0; i < kHits; ++i) {
      ordered_.place[i] = i;
      moved_.place[i] = first + kHits - 1 - i;
    }
    Fill(drawn, light_, &ordered_);
    Fill(drawn, light_, &moved_);
  }

  uint64_t FuzzModel(const MaterialModel& model) {
    ClearRadiance(kBatchCapacity, &ordered_.radiance);
    ClearRadiance(kBatchCapacity, &moved_.radiance);
    uint64_t hash = 0;
    for (size_t run = 0; run < kRuns; ++run) {
      const size_t begin = run * kRunLength;
      const size_t end = begin + kRunLength;
      const Material material = DrawMaterial(model, &random_);
      const Rgb color = DrawLight(&random_);
      const ShadingMaterial prepared = PrepareMaterial(material);
      Shade(prepared, color, begin, end, &ordered_);
      Shade(prepared, color, moved_.place[end - 1], moved_.place[begin] + 1, &moved_);
      for (size_t hit = begin; hit < end; ++hit) {
        Judge(model, material, color, hit);
        for (const uint32_t bits : BitsOf(ordered_, hit)) hash = Mix(hash, bits);
      }
    }
    result_->draws += kHits;
    return hash;
  }

 private:
  void Judge(const MaterialModel& model, const Material& material, const Rgb& color, size_t hit) {
    const double irradiance = ordered_.evaluated.irradiance[hit];
    result_->lit += irradiance > 0;
    const std::array<uint32_t, 6> bits = BitsOf(ordered_, hit);
    if (bits != BitsOf(moved_, hit)) Fault(&result_->moved, "moved", model, material, color, hit);
    for (int i = 0; i < 6; ++i) {
      const float value = std::bit_cast<float>(bits[static_cast<size_t>(i)]);
      if (std::isnan(value)) Fault(&result_->nan, "NaN", model, material, color, hit);
      if (value < 0) Fault(&result_->negative, "negative", model, material, color, hit);
      if (!std::isinf(value)) continue;
      const double largest = LargestReflection(material) * color[i % 3] * irradiance;
      if (largest > std::numeric_limits<float>::max()) {
        ++result_->overflowed;
      } else {
        Fault(&result_->infinite, "infinite", model, material, color, hit);
      }
    }
    JudgeConstantLobe(model, material, color, hit);
  }

  // 0^0 = 1: with exponent 0 the lobe is ks everywhere on the lit side.
  void JudgeConstantLobe(const MaterialModel& model, const Material& material, const Rgb& color,
                         size_t hit) {
    const auto* phong = std::get_if<PhongMaterial>(&material.model);
    if (phong == nullptr || phong->shininess != 0 ||
        phong->convention != PhongConvention::kClassic ||
        phong->model == PhongModel::kModifiedPhong) {
      return;
    }
    const float expected =
        static_cast<float>(phong->ks.x * color.x) * ordered_.evaluated.irradiance[hit];
    if (!std::isnormal(expected)) return;
    const float got = ordered_.radiance.specular.x[hit];
    if (got != expected)
      Fault(&result_->power_of_zero, "0^0 is not 1", model, material, color, hit);
  }

  void Fault(uint64_t* count, const char* what, const MaterialModel& model,
             const Material& material, const Rgb& color, size_t hit) {
    ++*count;
    if (!result_->first_fault.empty()) return;
    const auto text = [&](const Soa3<float>& v) {
      return fmt::format("({:a}, {:a}, {:a})", v.x[hit], v.y[hit], v.z[hit]);
    };
    std::string parameters;
    for (const MaterialParameter& parameter : model.parameters) {
      const Rgb value = parameter.get(material);
      parameters += fmt::format(" {} {:g},{:g},{:g}", parameter.name, value.x, value.y, value.z);
    }
    for (const MaterialChoice& choice : model.choices) {
      if (choice.get == nullptr) continue;
      parameters += fmt::format(" {} {}", choice.name, choice.options[choice.get(material)]);
    }
    result_->first_fault = fmt::format(
        "{}: {}{} n {} v {} l {} light {:g} {:g} {:g} irradiance {:g} diffuse {} specular {}", what,
        model.name, parameters, text(ordered_.surface.normal), text(ordered_.surface.to_view),
        text(ordered_.evaluated.light_vector), color.x, color.y, color.z,
        ordered_.evaluated.irradiance[hit], text(ordered_.radiance.diffuse),
        text(ordered_.radiance.specular));
  }

  FuzzRandom random_;
  FuzzResult* result_;
  Light light_;
  Placement ordered_, moved_;
};

void Add(const FuzzResult& part, FuzzResult* sum) {
  sum->draws += part.draws;
  sum->lit += part.lit;
  sum->nan += part.nan;
  sum->negative += part.negative;
  sum->infinite += part.infinite;
  sum->overflowed += part.overflowed;
  sum->power_of_zero += part.power_of_zero;
  sum->moved += part.moved;
  sum->hash += part.hash;  // any order
  if (sum->first_fault.empty()) sum->first_fault = part.first_fault;
}

}  // namespace

FuzzResult FuzzModels(const FuzzSettings& settings) {
  const auto models = MaterialModels();
  const uint64_t per_chunk = kHits * models.size();
  const uint64_t chunks = (settings.draws + per_chunk - 1) / per_chunk;
  FuzzResult result;
  std::mutex mutex;
  uint64_t done = 0;
  const auto body = [&](size_t chunk) {
    FuzzResult part;
    const uint64_t seed = settings.seed * 0x2545f4914f6cdd1du + chunk;
    const auto fuzz = std::make_unique<ChunkFuzz>(seed, &part);
    for (const MaterialModel& model : models) part.hash = Mix(part.hash, fuzz->FuzzModel(model));
    part.hash = Mix(part.hash, chunk);
    const std::lock_guard lock(mutex);
    Add(part, &result);
    ++done;
    if (settings.on_progress && (done % 256 == 0 || done == chunks)) {
      settings.on_progress(static_cast<double>(done) / static_cast<double>(chunks));
    }
  };
  if (settings.flush_denormals) {
    ParallelFor(chunks, settings.threads, body);
  } else {
    for (size_t chunk = 0; chunk < chunks; ++chunk) body(chunk);
  }
  return result;
}

std::string Describe(const FuzzResult& r) {
  return fmt::format(
      "{} lit, {} NaN, {} negative, {} infinite ({} more beyond float's range), {} of 0^0, {} "
      "moved, "
      "hash {:016x}{}{}",
      r.lit, r.nan, r.negative, r.infinite, r.overflowed, r.power_of_zero, r.moved, r.hash,
      r.first_fault.empty() ? "" : "\n  first: ", r.first_fault);
}

}  // namespace nacre
