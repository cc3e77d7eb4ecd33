// SPDX-License-Identifier: Apache-2.0
// tests/shading/shade_test.cc: the shading kernels against models evaluated in double from the
// scalar twins, on every target, and the promises that keep bits independent of neighbours.
#include "shading/shade.h"

#include <cmath>
#include <random>
#include <vector>

#include "base/float_mode.h"
#include "scene/material_parameters.h"
#include "shading/light_batch.h"
#include "shading/model_twins.h"
#include "shading/prepare.h"
#include "shading/scalar_bsdf.h"
#include "targets.h"

namespace nacre {
namespace {

constexpr size_t kHits = 1000;  // not a multiple of any vector

// Hits all around the visible side of a unit sphere at (0, 0, -6), seen from the origin.
HitBatch MakeHits() {
  HitBatch hits;
  hits.count = kHits;
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (size_t i = 0; i < kHits;) {
    // In braces: arguments in parentheses are evaluated in an order that is the compiler's choice.
    const Vec3d n = Vec3d{uniform(random), uniform(random), uniform(random)}.normalized();
    const Vec3d position = n + Vec3d(0, 0, -6);
    const Vec3d to_view = -position.normalized();
    if ((n ^ to_view) <= 0.01) continue;
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

Vec3d At(const Soa3<double>& soa, size_t i) { return {soa.x[i], soa.y[i], soa.z[i]}; }
Rgb At(const Soa3<float>& soa, size_t i) { return {soa.x[i], soa.y[i], soa.z[i]}; }

Light MakeLight(const std::string& kind) {
  Light light;
  if (kind == "point") {
    light.kind = PointLight{.position = {3, 4, 2}, .intensity = kLightColor};
  } else if (kind == "behind") {
    light.kind = PointLight{.position = {3, 4, -14}, .intensity = kLightColor};
  } else if (kind == "quadratic") {
    light.kind =
        PointLight{.position = {3, 4, 2}, .intensity = kLightColor, .attenuation = {0, 0, 0.3}};
  } else if (kind == "polynomial") {
    light.kind =
        PointLight{.position = {3, 4, 2}, .intensity = kLightColor, .attenuation = {1, 0.1, 0.05}};
  } else if (kind == "directional") {
    light.kind = DirectionalLight{.direction_of_travel = {-3, -4, -5}, .irradiance = kLightColor};
  } else {
    light.kind = SpotLight{.position = {3, 4, 2},
                           .direction_of_travel = {-3, -4, -8},
                           .intensity = kLightColor,
                           .cutoff_deg = 20,
                           .inner_deg = 5,
                           .exponent = 3.5};
  }
  return light;
}

// A batch of hits under one light, and what it takes to shade it.
struct Batch {
  HitBatch hits = MakeHits();
  Surface surface;
  ShadingLight light;
  LightBatch evaluated;
  ShadeScratch scratch;

  explicit Batch(const Light& scene_light) : light(PrepareLight(scene_light, {0, 0, 0})) {
    PrepareSurface(hits, &surface);
    EvaluateLight(light, hits, surface, &evaluated);
  }
  void Shade(const ShadingMaterial& material, size_t begin, size_t end,
             ReflectedRadiance* radiance) {
    PrepareRun(material, begin, end, &surface);
    ShadeRun({{material, hits, surface, begin, end}, light, &evaluated, radiance}, &scratch);
  }
};

ReflectedRadiance Shade(const ShadingMaterial& material, const Light& light) {
  Batch batch(light);
  ReflectedRadiance radiance;
  batch.Shade(material, 0, batch.hits.count, &radiance);
  return radiance;
}

// Relative error against the double model where the light is not grazing: with n.l >= 0.01 the
// rounding of directions to float (u = 6e-8) costs up to u / 0.01 in each cosine; `lobe_error` is
// what it costs the lobe. Grazing light must be small, and light from behind nothing.
template <class Model>
void CheckModel(const ShadingMaterial& material, const Model& model, const std::string& light_kind,
                double lobe_error) {
  CAPTURE(light_kind);
  const HitBatch hits = MakeHits();
  const Light light = MakeLight(light_kind);
  const ReflectedRadiance got = Shade(material, light);
  const double cosine_error = 8 * 0x1p-24 / 0.01;
  // The base gets 1 minus an albedo that may be near 1.
  const double base_error = 64 * 0x1p-24;
  for (size_t i = 0; i < hits.count; ++i) {
    const Vec3d n = At(hits.normal, i);
    const Incident incident = Illuminate(light, At(hits.position, i));
    const double cosine = n ^ incident.to_light;
    const Rgb diffuse = At(got.diffuse, i);
    const Rgb specular = At(got.specular, i);
    if (cosine <= -1e-6) {
      REQUIRE(diffuse == Rgb(0, 0, 0));
      REQUIRE(specular == Rgb(0, 0, 0));
    }
    // The penumbra's edge and a cone's rim have steep relative slopes, like grazing light.
    if (cosine < 0.01 || incident.irradiance < 1e-3) continue;
    const Reflected expected = Reflect(model, n, At(hits.to_view, i), incident);
    for (int c = 0; c < 3; ++c) {
      REQUIRE(std::abs(diffuse[c] - expected.diffuse[c]) <=
              cosine_error * expected.diffuse[c] + base_error * kLightColor[c]);
      REQUIRE(std::abs(specular[c] - expected.specular[c]) <=
              (cosine_error + lobe_error) * expected.specular[c] + 1e-30);
    }
  }
}

template <class Model>
void CheckPlain(const Model& model, const std::string& light, double lobe_error) {
  CheckModel(Prepare(model), model, light, lobe_error);
}

TEST_CASE("kernels agree with the models in double on every target and under every light") {
  const FlushDenormals flush;
  ForEachTarget([](Target) {
    for (const char* light : {"point", "quadratic", "polynomial", "directional", "spot"}) {
      CheckPlain(LambertMaterial{Rgb(0.9, 0.5, 0.1)}, light, 0);
      for (const double roughness : {0.0, 0.3, 1.0}) {
        CheckPlain(OrenNayarMaterial{Rgb(1, 0.5, 0.1), roughness}, light, 0);
        CheckPlain(BurleyMaterial{Rgb(1, 0.5, 0.1), roughness}, light, 0);
      }
      for (const PhongModel model :
           {PhongModel::kPhong, PhongModel::kModifiedPhong, PhongModel::kBlinnPhong}) {
        for (const PhongConvention convention :
             {PhongConvention::kClassic, PhongConvention::kRadiometric}) {
          PhongMaterial phong{.model = model,
                              .convention = convention,
                              .color = Rgb(0.9, 0.5, 0.1),
                              .shininess = 40};
          // The whole hemisphere, far tails included: n tan(theta) u, tan up to the point where
          // the lobe is 1e-30, about 5.6 for n = 40.
          CheckPlain(phong, light, 16 * 40 * 5.6 * 0x1p-24);
        }
      }
    }
  });
}

// Every combination that the microfacet models know.
std::vector<Material> MicrofacetMaterials(double roughness) {
  std::vector<Material> materials;
  for (const char* name : {"metallic_roughness", "conductor", "dielectric"}) {
    const MaterialModel& model = *FindModel(name);
    std::vector<Material> some = {model.make()};
    const auto set = [&](std::string_view parameter, const Rgb& value) {
      if (const auto* found = FindParameter(model, parameter)) found->set(some[0], value);
    };
    set("roughness", Rgb(roughness));
    set("base_color", {0.9, 0.5, 0.1});
    set("metallic", Rgb(0.4));
    set("f82_tint", {1, 1, 1});
    set("eta", {0.15, 0.4, 1.4});
    set("k", {4, 2.4, 1.6});
    for (const MaterialChoice& choice : model.choices) {
      if (choice.name == "preset" || choice.name == "iridescence_model") continue;
      std::vector<Material> more;
      for (const Material& material : some) {
        for (size_t option = 0; option < choice.options.size(); ++option) {
          choice.set(more.emplace_back(material), option);
        }
      }
      some = std::move(more);
    }
    materials.insert(materials.end(), some.begin(), some.end());
  }
  auto tinted = std::get<MetallicRoughnessMaterial>(materials[0].model);
  tinted.f82_tint = Rgb(0.5, 0.9, 0.7);
  materials.emplace_back().model = tinted;
  // Half a dielectric's reflection, and none, under every coupling and compensation.
  for (size_t i = 0, count = materials.size(); i < count; ++i) {
    auto* weak = std::get_if<MetallicRoughnessMaterial>(&materials[i].model);
    if (weak == nullptr || weak->shadowing != Shadowing::kHeightCorrelated) continue;
    MetallicRoughnessMaterial less = *weak;
    less.dielectric_f0 = Rgb(0.08, 0.04, 0.01);
    less.specular = i % 2 == 0 ? 0.5 : 0;
    less.metallic = i % 3 == 0 ? 0 : 0.4;
    materials.emplace_back().model = less;
  }
  return materials;
}

TEST_CASE("microfacet kernels agree with the model in double in every combination") {
  const FlushDenormals flush;
  ForEachTarget([](Target) {
    for (const double roughness : {0.1, 0.3, 0.7, 1.0}) {
      for (const Material& material : MicrofacetMaterials(roughness)) {
        const ShadingMaterial prepared = Prepare(material);
        const auto& model = std::get<MicrofacetModel>(prepared.model);
        CheckModel(prepared, model, "point", 8 * 0x1p-24 / (roughness * roughness));
        // Where Fresnel's curves rise: v.h is about 0.3.
        CheckModel(prepared, model, "behind", 8 * 0x1p-24 / (roughness * roughness));
      }
    }
    const ShadingMaterial plain = Prepare(MetallicRoughnessMaterial{});
    for (const char* light : {"polynomial", "directional", "spot"}) {
      CheckModel(plain, std::get<MicrofacetModel>(plain.model), light, 8 * 0x1p-24 / 0.25);
    }
  });
}

// The same law as of Reflect (material_test.cc), of the kernels: what each of the two hits' kernels
// rounds, 2e-6 of a lobe this wide, and 64 roundings of the light for a base that gets 1 minus an
// albedo.
TEST_CASE("kernels reflect of a part metal the mix of its dielectric and its metal") {
  const FlushDenormals flush;
  ForEachTarget([](Target) {
    for (const Compensation compensation :
         {Compensation::kTurquin, Compensation::kKullaConty, Compensation::kNone}) {
      for (const Rgb& tint : {Rgb(1), Rgb(0, 0.5, 0.9)}) {
        MetallicRoughnessMaterial material{.base_color = {1, 0.3, 0.02},
                                           .specular = 0.7,
                                           .f82_tint = tint,
                                           .roughness = 0.7,
                                           .compensation = compensation};
        const auto shade = [&](double metallic) {
          material.metallic = metallic;
          return Shade(Prepare(material), MakeLight("point"));
        };
        const ReflectedRadiance dielectric = shade(0), metal = shade(1), mixed = shade(0.4);
        for (size_t i = 0; i < kHits; ++i) {
          CAPTURE(static_cast<int>(compensation), tint.x, i);
          const Rgb specular = At(dielectric.specular, i) * 0.6 + At(metal.specular, i) * 0.4;
          const Rgb diffuse = At(dielectric.diffuse, i) * 0.6;
          for (int c = 0; c < 3; ++c) {
            REQUIRE(std::abs(At(mixed.specular, i)[c] - specular[c]) <= 4e-6 * specular[c]);
            REQUIRE(std::abs(At(mixed.diffuse, i)[c] - diffuse[c]) <=
                    4e-6 * diffuse[c] + 64 * 0x1p-24 * kLightColor[c]);
          }
        }
      }
    }
  });
}

TEST_CASE("a delta lobe shows no punctual light, its base does") {
  const ShadingMaterial material = Prepare(MetallicRoughnessMaterial{.roughness = 0});
  CHECK(HasDeltaLobe(material));
  CHECK(!HasDeltaLobe(Prepare(MetallicRoughnessMaterial{})));
  const ReflectedRadiance got = Shade(material, MakeLight("point"));
  double diffuse = 0;
  for (size_t i = 0; i < kHits; ++i) {
    REQUIRE(At(got.specular, i) == Rgb(0, 0, 0));
    diffuse += got.diffuse.x[i];
  }
  CHECK(diffuse > 0);
}

TEST_CASE("a hit's bits do not depend on its place in the batch or the run") {
  const FlushDenormals flush;
  std::vector<Material> materials = MicrofacetMaterials(0.05);
  for (const MaterialModel& model : MaterialModels()) materials.push_back(model.make());
  ForEachTarget([&](Target) {
    Batch batch(MakeLight("spot"));
    for (const Material& material : materials) {
      const ShadingMaterial prepared = Prepare(material);
      ReflectedRadiance whole;
      batch.Shade(prepared, 0, kHits, &whole);
      ReflectedRadiance parts;
      for (size_t begin = 0; begin < kHits;) {
        const size_t end = std::min(kHits, begin + 1 + begin % 13);
        batch.Shade(prepared, begin, end, &parts);
        begin = end;
      }
      for (size_t i = 0; i < kHits; ++i) {
        REQUIRE(At(whole.diffuse, i) == At(parts.diffuse, i));
        REQUIRE(At(whole.specular, i) == At(parts.specular, i));
      }
    }
  });
}

// Two layers of different kinds of cloth over a lobe and its base.
ShadingMaterial UnderTwoLayers() {
  MetallicRoughnessMaterial base{.base_color = Rgb(0.8, 0.5, 0.2), .roughness = 0.4};
  ShadingMaterial material = Prepare(base);
  material.layers = {SheenModel{Rgb(0.9, 0.3, 0.1), MakeCharlie(0.3)},
                     SheenModel{Rgb(0.1, 0.4, 0.7), MakeCharlie(0.8)}};
  return material;
}

TEST_CASE("each of several layers covers those below it, as the scalar material has it") {
  const FlushDenormals flush;
  const ShadingMaterial material = UnderTwoLayers();
  // As in CheckModel, of the model and of both layers: their cosines, and the 6e-8 of the half
  // vector in sin^(1 / alpha), which is no more than 4e-7 / roughness^2.
  const double error = 3 * 8 * 0x1p-24 / 0.01 + 2 * 4e-7 / (0.3 * 0.3);
  ForEachTarget([&](Target) {
    for (const char* kind : {"point", "directional", "polynomial"}) {
      CAPTURE(kind);
      const Light light = MakeLight(kind);
      Batch batch(light);
      const ReflectedRadiance got = Shade(material, light);
      size_t lit = 0;
      for (size_t i = 0; i < kHits; ++i) {
        const Vec3d n = At(batch.hits.normal, i);
        const Incident in = Illuminate(light, At(batch.hits.position, i));
        if ((n ^ in.to_light) < 0.01) continue;
        const Reflection want = Reflect(material, n, in.to_light, At(batch.hits.to_view, i));
        for (int c = 0; c < 3; ++c) {
          const double irradiance = kLightColor[c] * in.irradiance;
          const double diffuse = want.diffuse[c] * irradiance;
          const double specular = want.specular[c] * irradiance;
          REQUIRE(std::abs(At(got.diffuse, i)[c] - diffuse) <= error * diffuse);
          REQUIRE(std::abs(At(got.specular, i)[c] - specular) <= error * specular + 1e-30);
        }
        ++lit;
      }
      CHECK(lit > 100);
    }
  });
}

TEST_CASE("the order of layers counts") {
  ShadingMaterial material = UnderTwoLayers();
  const Vec3d n(0, 0, 1), v = Vec3d(0.8, 0, 0.3).normalized(),
                          l = Vec3d(-0.3, 0.8, 0.2).normalized();
  const Reflection one = Reflect(material, n, l, v);
  std::swap(material.layers[0], material.layers[1]);
  const Reflection other = Reflect(material, n, l, v);
  CHECK(std::abs(one.diffuse.x / other.diffuse.x - 1) > 0.01);
  CHECK(one.specular.x == Approx(other.specular.x).epsilon(1e-14));  // the same is taken from it
}

TEST_CASE("the black base of a metal is skipped, and no bit changes") {
  for (const DiffuseCoupling coupling :
       {DiffuseCoupling::kAlbedoScaled, DiffuseCoupling::kOneMinusFresnel}) {
    for (const Compensation compensation :
         {Compensation::kNone, Compensation::kTurquin, Compensation::kKullaConty}) {
      MetallicRoughnessMaterial metal{.metallic = 1,
                                      .roughness = 0.4,
                                      .compensation = compensation,
                                      .diffuse_coupling = coupling,
                                      .diffuse = DiffuseForm::kOrenNayar};
      const ShadingMaterial skipped = Prepare(metal);
      const auto& model = std::get<MicrofacetModel>(skipped.model);
      // What Fresnel's curve leaves costs nothing to ask for; an albedo does.
      CHECK(model.coupling ==
            (coupling == DiffuseCoupling::kAlbedoScaled ? DiffuseCoupling::kNone : coupling));
      CHECK(model.base_form == DiffuseForm::kLambert);
      ShadingMaterial whole = skipped;
      auto& whole_model = std::get<MicrofacetModel>(whole.model);
      whole_model.coupling = coupling;
      whole_model.base_form = metal.diffuse;
      whole_model.base_roughness = metal.roughness;
      whole_model.prepared = model.prepared || coupling == DiffuseCoupling::kAlbedoScaled;
      ForEachTarget([&](Target) {
        const ReflectedRadiance a = Shade(skipped, MakeLight("point"));
        const ReflectedRadiance b = Shade(whole, MakeLight("point"));
        for (size_t i = 0; i < kHits; ++i) {
          REQUIRE(At(a.diffuse, i) == At(b.diffuse, i));
          REQUIRE(At(a.specular, i) == At(b.specular, i));
        }
      });
    }
  }
}

TEST_CASE("a base that is black in one channel is none that can be skipped") {
  MetallicRoughnessMaterial material{.base_color = {0, 0.5, 0.2}};
  const ShadingMaterial prepared = Prepare(material);
  CHECK(std::get<MicrofacetModel>(prepared.model).coupling == material.diffuse_coupling);
}

TEST_CASE("a light near a huge, far surface keeps its direction") {
  // Ground of radius 1e6 around (0, -1e6, 0): a light 1 above it, hits 1 away from its foot.
  ForEachTarget([](Target) {
    HitBatch hits;
    hits.count = 1;
    const double radius = 1e6;
    const double angle = 1 / radius;
    hits.position.x[0] = radius * std::sin(angle);
    hits.position.y[0] = -2 * radius * std::pow(std::sin(angle / 2), 2);
    hits.normal.y[0] = 1;
    hits.to_view.y[0] = 1;
    Surface surface;
    LightBatch batch;
    PrepareSurface(hits, &surface);
    Light light{.kind = PointLight{.position = {0, 1, 0}, .intensity = {1, 1, 1}}};
    EvaluateLight(PrepareLight(light, {0, 0, 0}), hits, surface, &batch);
    // Rounding of the difference to float and one normalisation: a few u.
    const Vec3d offset = Vec3d(0, 1, 0) - At(hits.position, 0);
    const Vec3d to_light = offset.normalized();
    CHECK(DirectionToLight(batch, 0).x == Approx(to_light.x).epsilon(8 * 0x1p-24));
    CHECK(DirectionToLight(batch, 0).y == Approx(to_light.y).epsilon(8 * 0x1p-24));
    CHECK(batch.irradiance[0] == Approx(1 / offset.length2()).epsilon(8 * 0x1p-24));
  });
}

TEST_CASE("constants of materials") {
  Material material{.emission = Rgb(1, 2, 3), .model = LambertMaterial{Rgb(0.5, 0.5, 0.25)}};
  CHECK(PrepareMaterial(material).of_ambient == Rgb(0.5, 0.5, 0.25));
  CHECK(PrepareMaterial(material).emission == Rgb(1, 2, 3));
  material.model = PhongMaterial{.color = Rgb(1, 0.5, 0.25), .ka = Rgb(0.5, 0.5, 0.5)};
  CHECK(PrepareMaterial(material).of_ambient == Rgb(0.5, 0.25, 0.125));
}

}  // namespace
}  // namespace nacre
