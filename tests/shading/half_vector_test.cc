// SPDX-License-Identifier: Apache-2.0
// tests/shading/half_vector_test.cc: lobes in the mirror's direction, from light beside the viewer
// to light opposite, where l + v nearly cancels and its roundings would show.
#include <cmath>
#include <random>
#include <vector>

#include "base/float_mode.h"
#include "shading/model_twins.h"
#include "shading/prepare.h"
#include "shading/shade.h"
#include "shading/soa_at.h"
#include "targets.h"

namespace nacre {
namespace {

constexpr size_t kMirrorHits = 1000;  // not a multiple of any vector

// Hits about (0, 0, 0), each lit by a direction of its own.
struct MirrorBatch {
  HitBatch hits;
  Surface surface;
  ShadingLight light;
  LightBatch directions;
  ShadeScratch scratch;

  void Shade(const ShadingMaterial& material, size_t begin, size_t end,
             ReflectedRadiance* radiance) {
    ShadeRun({{material, hits, surface, begin, end}, light, &directions, radiance}, &scratch);
  }
};

Vec3d WideAt(const Soa3<float>& soa, size_t i) {
  return Vec3d(soa.x[i], soa.y[i], soa.z[i]).normalized();
}

// Light and viewer at angles of 0 to 87 degrees from the normals, h within `width` of them.
void FillMirrorBatch(double width, MirrorBatch* batch) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> uniform(-1, 1);
  const auto direction = [&] {
    return Vec3d{uniform(random), uniform(random), uniform(random)}.normalized();
  };
  batch->hits.count = kMirrorHits;
  for (size_t i = 0; i < kMirrorHits; ++i) {
    const Vec3d n = direction();
    const Vec3d tangent = (n % direction()).normalized();
    const double angle = M_PI / 180 * 87 * static_cast<double>(i) / kMirrorHits;
    const Vec3d v = n * std::cos(angle) + tangent * std::sin(angle);
    const Vec3d h = (n + direction() * (width * uniform(random))).normalized();
    const Vec3d l = h * (2 * (h ^ v)) - v;
    SetAt(i, n, &batch->hits.normal);
    SetAt(i, v, &batch->hits.to_view);
    SetAt(i, l, &batch->directions.light_vector);
    batch->directions.inverse_length[i] = 1;
    batch->directions.irradiance[i] = 1;
  }
  PrepareSurface(batch->hits, &batch->surface);
  Light light{.kind =
                  DirectionalLight{.direction_of_travel = {0, 0, -1}, .irradiance = kLightColor}};
  batch->light = PrepareLight(light, {0, 0, 0});
}

// A lobe of this width changes by at most 2 / width of itself per radian that h turns, and what is
// made of u turns it by two roundings at most; cosines of 0.05 and above are off by 8 in all.
template <class Model>
void CheckMirrored(const ShadingMaterial& material, const Model& model, double width) {
  MirrorBatch batch;
  FillMirrorBatch(width, &batch);
  PrepareRun(material, 0, kMirrorHits, &batch.surface);
  ReflectedRadiance whole;
  batch.Shade(material, 0, kMirrorHits, &whole);
  const double tolerance = (2 * 2 / width + 2 * 8) * 0x1p-24;
  for (size_t i = 0; i < kMirrorHits; ++i) {
    const Vec3d n = WideAt(batch.surface.normal, i), v = WideAt(batch.surface.to_view, i);
    const Vec3d l = WideAt(batch.directions.light_vector, i);
    if ((n ^ l) < 0.05) continue;
    const Rgb got = ColorAt(whole.specular, i);
    const Rgb expected = Reflect(model, n, v, {l, 1}).specular;
    for (int c = 0; c < 3; ++c) {
      REQUIRE(std::abs(got[c] - expected[c]) <= tolerance * expected[c]);
    }
  }
}

TEST_CASE("mirrored light keeps its lobe up to light opposite the viewer") {
  const FlushDenormals flush;
  ForEachTarget([](Target) {
    for (const double roughness : {0.15, 0.2, 0.3, 0.6}) {
      MetallicRoughnessMaterial metal{
          .base_color = Rgb(0.9, 0.5, 0.1), .metallic = 1, .roughness = roughness};
      for (const Shadowing shadowing : {Shadowing::kSchlickDirect, Shadowing::kHeightCorrelated}) {
        metal.shadowing = shadowing;
        const ShadingMaterial prepared = Prepare(metal);
        CheckMirrored(prepared, std::get<MicrofacetModel>(prepared.model), roughness * roughness);
      }
    }
    for (const double shininess : {10.0, 40.0, 200.0}) {
      for (const PhongModel model : {PhongModel::kPhong, PhongModel::kBlinnPhong}) {
        PhongMaterial phong{.model = model, .shininess = shininess};
        CheckMirrored(Prepare(phong), phong, 1 / std::sqrt(shininess));
      }
    }
  });
}

// Every model whose kernel reads angles of the half vector, with each curve and compensation.
std::vector<ShadingMaterial> MaterialsWithHalfVectors() {
  std::vector<ShadingMaterial> materials;
  const auto add = [&](const auto& model) { materials.push_back(Prepare(model)); };
  for (const double roughness : {0.15, 0.5}) {
    for (const Compensation compensation :
         {Compensation::kNone, Compensation::kTurquin, Compensation::kKullaConty}) {
      MetallicRoughnessMaterial metallic{.roughness = roughness, .compensation = compensation};
      add(metallic);
      metallic.dielectric_f0 = Rgb(0.01, 0.04, 0.08);
      add(metallic);
      metallic.diffuse_coupling = DiffuseCoupling::kOneMinusFresnel;
      add(metallic);
      metallic.diffuse = DiffuseForm::kOrenNayar;
      add(metallic);
      metallic.metallic = 1;
      metallic.f82_tint = Rgb(0.7, 0.8, 0.9);
      add(metallic);
      for (const ConductorFresnel fresnel :
           {ConductorFresnel::kExact, ConductorFresnel::kF82Tint, ConductorFresnel::kSchlick}) {
        add(ConductorMaterial{
            .roughness = roughness, .fresnel = fresnel, .compensation = compensation});
      }
      for (const DielectricFresnel fresnel :
           {DielectricFresnel::kExact, DielectricFresnel::kSchlick}) {
        add(DielectricMaterial{
            .ior = 1.2, .roughness = roughness, .fresnel = fresnel, .compensation = compensation});
      }
    }
  }
  add(PhongMaterial{.model = PhongModel::kBlinnPhong, .shininess = 20});
  add(BurleyMaterial{});
  add(OrenNayarMaterial{});
  return materials;
}

// A block of hits takes the careful form of the half vector if any of its hits needs it. That must
// not change the bits of the others, or a pixel would depend on its tile.
TEST_CASE("a hit's bits do not depend on whether others need more care") {
  const FlushDenormals flush;
  MirrorBatch batch;
  FillMirrorBatch(0.3, &batch);
  // Offsets as those to positional lights, of any length: products of theirs are rounded where
  // products of unit vectors are exact.
  for (size_t i = 0; i < kMirrorHits; ++i) {
    const double length = 1 + 6 * static_cast<double>(i) / kMirrorHits;
    const Vec3d l = WideAt(batch.directions.light_vector, i);
    SetAt(i, l * length, &batch.directions.light_vector);
    batch.directions.inverse_length[i] = static_cast<float>(1 / length);
  }
  ForEachTarget([&](Target) {
    size_t material_number = 0;
    for (const ShadingMaterial& material : MaterialsWithHalfVectors()) {
      CAPTURE(material_number++);
      ReflectedRadiance whole, alone;
      PrepareRun(material, 0, kMirrorHits, &batch.surface);
      batch.Shade(material, 0, kMirrorHits, &whole);
      for (size_t i = 0; i < kMirrorHits; ++i) {
        PrepareRun(material, i, i + 1, &batch.surface);
        batch.Shade(material, i, i + 1, &alone);
        CAPTURE(i);
        REQUIRE(ColorAt(whole.specular, i) == ColorAt(alone.specular, i));
        REQUIRE(ColorAt(whole.diffuse, i) == ColorAt(alone.diffuse, i));
      }
    }
  });
}

// l + v along the normal, free of roundings however short it is. All that errs are a few dozen
// operations on what is left; below 2^-45 the smallest normal number counts, which is added to
// |n x u|^2 (SquaredLength).
TEST_CASE("a half vector of next to no length keeps its lobe") {
  const FlushDenormals flush;
  constexpr double kTolerance = 32 * 0x1p-24;
  constexpr size_t kSteps = 45;
  MirrorBatch batch;
  batch.hits.count = kSteps;
  for (size_t i = 0; i < kSteps; ++i) {
    const double height = std::exp2(-1.0 - static_cast<double>(i));
    SetAt(i, {0, 0, 1}, &batch.hits.normal);
    SetAt(i, Vec3d{-1, 0, height}.normalized(), &batch.hits.to_view);
    batch.directions.inverse_length[i] = 1;
    batch.directions.irradiance[i] = 1;
  }
  PrepareSurface(batch.hits, &batch.surface);
  for (size_t i = 0; i < kSteps; ++i) {
    const Soa3<float>& v = batch.surface.to_view;
    SetAt(i, {-v.x[i], 0, v.z[i]}, &batch.directions.light_vector);
  }
  batch.light =
      PrepareLight({.name = {}, .kind = DirectionalLight{.irradiance = kLightColor}}, {0, 0, 0});
  ForEachTarget([&](Target) {
    for (const Shadowing shadowing : {Shadowing::kSchlickDirect, Shadowing::kHeightCorrelated}) {
      const ShadingMaterial prepared =
          Prepare(MetallicRoughnessMaterial{.roughness = 0.15, .shadowing = shadowing});
      const auto& model = std::get<MicrofacetModel>(prepared.model);
      PrepareRun(prepared, 0, kSteps, &batch.surface);
      ReflectedRadiance got;
      batch.Shade(prepared, 0, kSteps, &got);
      for (size_t i = 0; i < kSteps; ++i) {
        const Vec3d v = WideAt(batch.surface.to_view, i);
        const Rgb expected = Reflect(model, {0, 0, 1}, v, {{-v.x, 0, v.z}, 1}).specular;
        CAPTURE(i);
        REQUIRE(std::abs(got.specular.y[i] - expected.y) <= kTolerance * expected.y);
      }
    }
  });
}

}  // namespace
}  // namespace nacre
