// SPDX-License-Identifier: Apache-2.0
// tests/shading/material_test.cc: what is made of materials and lights before the kernels run,
// against numbers and laws that do not come from there.
#include "shading/material.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "brdf/angles.h"
#include "brdf/burley.h"
#include "brdf/eon.h"
#include "brdf/fresnel.h"
#include "brdf/ggx.h"
#include "brdf/multi_scatter.h"
#include "brdf/quadrature.h"
#include "shading/bsdf.h"
#include "shading/light_batch.h"
#include "shading/lobe_sample.h"
#include "shading/prepare.h"
#include "shading/scalar_bsdf.h"
#include "shading/shade.h"
#include "targets.h"

namespace nacre {
namespace {

template <class Model>
MicrofacetModel PrepareModel(const Model& model) {
  return std::get<MicrofacetModel>(Prepare(model).model);
}

void CheckEqual(const Rgb& got, const Rgb& expected) {
  for (int c = 0; c < 3; ++c) CHECK(got[c] == Approx(expected[c]).epsilon(1e-12));
}

TEST_CASE("metallic-roughness mixes its base and F0") {
  MetallicRoughnessMaterial material{
      .base_color = {0.8, 0.4, 0.2}, .metallic = 0.25, .roughness = 0.3};
  const MicrofacetModel model = PrepareModel(material);
  CheckEqual(model.f0, {0.23, 0.13, 0.08});  // 0.75 x 0.04 and a quarter of the colour
  CheckEqual(model.diffuse * M_PI, {0.6, 0.3, 0.15});
  CHECK(model.alpha == Approx(0.09));
  CHECK(model.schlick_k == Approx(0.21125));  // 1.3^2 / 8
  material.shadowing = Shadowing::kSchlickIbl;
  CHECK(PrepareModel(material).schlick_k == Approx(0.045));  // 0.3^2 / 2
}

// glTF 2.0, Appendix B: metallic mixes the BRDFs of a dielectric and of a metal, not their numbers.
TEST_CASE("a part metal reflects the mix of what the dielectric and the metal reflect") {
  const Vec3d normal(0, 0, 1);
  for (const Compensation compensation :
       {Compensation::kTurquin, Compensation::kKullaConty, Compensation::kNone}) {
    for (const DiffuseCoupling coupling :
         {DiffuseCoupling::kAlbedoScaled, DiffuseCoupling::kNone}) {
      for (const Rgb& tint : {Rgb(1), Rgb(0, 0.5, 0.9)}) {
        for (const Shadowing shadowing :
             {Shadowing::kHeightCorrelated, Shadowing::kSchlickDirect, Shadowing::kSchlickIbl}) {
          for (const double metallic : {0.1, 0.5, 0.9}) {
            MetallicRoughnessMaterial material{.base_color = {0.9, 0.3, 0.02},
                                               .dielectric_f0 = {0.08, 0.04, 0.3},
                                               .specular = 0.7,
                                               .f82_tint = tint,
                                               .roughness = 0.6,
                                               .shadowing = shadowing,
                                               .compensation = compensation,
                                               .diffuse_coupling = coupling};
            const auto of = [&](double m) {
              material.metallic = m;
              return Prepare(material);
            };
            const ShadingMaterial dielectric = of(0), metal = of(1), mixed = of(metallic);
            for (const double view : {0.0, 0.8, 1.5}) {
              for (const double light : {-1.55, -0.8, 0.3, 1.2}) {
                CAPTURE(static_cast<int>(compensation), static_cast<int>(coupling), tint.x,
                        static_cast<int>(shadowing), metallic, view, light);
                const Vec3d v(std::sin(view), 0, std::cos(view));
                const Vec3d l(0.6 * std::sin(light), 0.8 * std::sin(light), std::cos(light));
                const Reflection a = Reflect(dielectric, normal, l, v);
                const Reflection b = Reflect(metal, normal, l, v);
                const Reflection got = Reflect(mixed, normal, l, v);
                CheckEqual(got.specular, a.specular * (1 - metallic) + b.specular * metallic);
                CheckEqual(got.diffuse, a.diffuse * (1 - metallic));
              }
            }
          }
        }
      }
    }
  }
}

TEST_CASE("the lesson's coupling takes from the base what the mixed F0 reflects") {
  MetallicRoughnessMaterial material{.base_color = {0.9, 0.3, 0.02},
                                     .metallic = 0.5,
                                     .compensation = Compensation::kNone,
                                     .diffuse_coupling = DiffuseCoupling::kOneMinusFresnel};
  const Vec3d normal(0, 0, 1), v = Vec3d(0.5, 0, 1).normalized(), l = Vec3d(0, 2, 1).normalized();
  const Angles<double> a = ComputeAngles(normal, l, v);
  Rgb expected;
  for (int c = 0; c < 3; ++c) {
    const double f0 = 0.04 * 0.5 + material.base_color[c] * 0.5;
    expected[c] =
        (1 - FresnelSchlick(f0, SchlickWeight(a))) * 0.5 * material.base_color[c] * M_1_PI * l.z;
  }
  CheckEqual(Reflect(Prepare(material), normal, l, v).diffuse, expected);
}

TEST_CASE("what is no metal reflects as much as `specular` says, at all angles") {
  MetallicRoughnessMaterial material{
      .base_color = {0.8, 0.4, 0.2}, .dielectric_f0 = {0.1, 0.04, 0.02}, .roughness = 0.3};
  const MicrofacetModel whole = PrepareModel(material);
  CHECK(whole.f90 == 1);
  material.specular = 0.25;
  const MicrofacetModel quarter = PrepareModel(material);
  CheckEqual(quarter.f0, {0.025, 0.01, 0.005});
  CHECK(quarter.f90 == 0.25);
  for (const double cosine : {1.0, 0.7, 0.2, 0.0}) {
    const Rgb all = FresnelOf(whole, cosine, 1 - cosine);
    CheckEqual(FresnelOf(quarter, cosine, 1 - cosine), all * 0.25);
  }
  // A fifth of it metal, whose reflection is never less.
  material.metallic = 0.2;
  const MicrofacetModel mixed = PrepareModel(material);
  CheckEqual(mixed.f0, {0.8 * 0.025 + 0.16, 0.8 * 0.01 + 0.08, 0.8 * 0.005 + 0.04});
  CHECK(mixed.f90 == Approx(0.8 * 0.25 + 0.2).epsilon(1e-15));
  for (const double metallic : {0.1, 0.3, 0.7, 1e-17, 0.9999999999999999}) {
    material.metallic = metallic;
    material.specular = 1;
    CHECK(PrepareModel(material).f90 == 1);
  }
  // None: a Lambert surface, however smooth.
  material.metallic = 0;
  material.specular = 0;
  material.roughness = 0;
  CHECK(!HasDeltaLobe(Prepare(material)));
  material.roughness = 0.3;
  const MicrofacetModel none = PrepareModel(material);
  for (const double n_dot_v : {1.0, 0.5, 0.01}) {
    for (int c = 0; c < 3; ++c) CHECK(CoverAlbedo(none, n_dot_v, c) == 0);
  }
}

TEST_CASE("radiometric Phong is normalised, classic Phong is not") {
  PhongMaterial phong{.model = PhongModel::kModifiedPhong,
                      .convention = PhongConvention::kClassic,
                      .color = {0.5, 0.5, 0.5},
                      .kd = 0.5 * Rgb(1, 1, 1),
                      .ks = 0.25 * Rgb(1, 1, 1),
                      .shininess = 8};
  CheckEqual(std::get<PhongFamilyModel>(Prepare(phong).model).diffuse, {0.25, 0.25, 0.25});
  CheckEqual(std::get<PhongFamilyModel>(Prepare(phong).model).specular, {0.25, 0.25, 0.25});
  phong.convention = PhongConvention::kRadiometric;
  const auto model = std::get<PhongFamilyModel>(Prepare(phong).model);
  CheckEqual(model.diffuse * M_PI, {0.25, 0.25, 0.25});
  CheckEqual(model.specular * M_PI, {1.25, 1.25, 1.25});  // (8 + 2) / 2 pi
}

TEST_CASE("a base has the roughness that it is given, or else the lobe's") {
  DielectricMaterial coat{.base_color = {1, 0.5, 0}, .roughness = 0.25};
  CHECK(PrepareModel(coat).base_form == DiffuseForm::kLambert);
  coat.diffuse = DiffuseForm::kOrenNayar;
  CHECK(PrepareModel(coat).base_roughness == 0.25);
  CHECK(PrepareModel(coat).base_ratio.x == Approx(1));  // a white one gives all of it back
  CHECK(PrepareModel(coat).base_ratio.z == 0);
  coat.diffuse_roughness = 0.75;
  CHECK(PrepareModel(coat).base_roughness == 0.75);
  coat.diffuse_roughness = 0;
  CHECK(PrepareModel(coat).base_form == DiffuseForm::kLambert);  // the same, and in closed form
  coat.diffuse = DiffuseForm::kBurley;
  CHECK(PrepareModel(coat).base_form == DiffuseForm::kBurley);
}

TEST_CASE("closed forms are for Lambert's diffuse reflection alone") {
  CHECK(DiffuseIsFlat(Prepare(LambertMaterial{})));
  CHECK(!DiffuseIsFlat(Prepare(OrenNayarMaterial{})));
  CHECK(!DiffuseIsFlat(Prepare(BurleyMaterial{})));
  MetallicRoughnessMaterial plastic;
  CHECK(DiffuseIsFlat(Prepare(plastic)));
  plastic.diffuse = DiffuseForm::kOrenNayar;
  CHECK(!DiffuseIsFlat(Prepare(plastic)));
  plastic.diffuse_roughness = 0;
  CHECK(DiffuseIsFlat(Prepare(plastic)));
  plastic.diffuse = DiffuseForm::kBurley;
  CHECK(!DiffuseIsFlat(Prepare(plastic)));
}

TEST_CASE("what materials reflect of light from everywhere") {
  PhongMaterial phong{.color = {1, 1, 1}, .ka = {0.25, 0.25, 0.25}, .kd = {0.75, 0.75, 0.75}};
  CheckEqual(Prepare(phong).of_ambient, Rgb(0.25));
  MetallicRoughnessMaterial metallic_roughness{.base_color = {0.5, 0.25, 1}};
  CheckEqual(Prepare(metallic_roughness).of_ambient, {0.5, 0.25, 1});
  // A white base under a clear coat gives back all light, a black one the coat's 9.178 % (Fresnel's
  // mean for 1.5: Egan and Hilgeman 1973).
  DielectricMaterial dielectric{.base_color = {1, 1, 1}, .ior = 1.5};
  CheckEqual(Prepare(dielectric).of_ambient, Rgb(1));
  dielectric.base_color = {0, 0, 0};
  CHECK(Prepare(dielectric).of_ambient.x == Approx(0.0918).margin(5e-5));
  // So does a conductor that absorbs nothing; F0 is 4 %.
  const ShadingMaterial metal = Prepare(ConductorMaterial{.eta = {1.5, 1.5, 1.5}, .k = {0, 0, 0}});
  CHECK(metal.of_ambient.x == Approx(0.0918).margin(5e-5));
  CHECK(metal.albedo.x == Approx(0.04));
}

TEST_CASE("a white base under Kulla and Conty's lobe loses and gains nothing") {
  const QuadratureRule& rule = GaussLegendre(32);
  for (const double roughness : {0.3, 0.6, 1.0}) {
    MetallicRoughnessMaterial material{
        .base_color = {1, 1, 1}, .roughness = roughness, .compensation = Compensation::kKullaConty};
    const MicrofacetModel model = PrepareModel(material);
    // The base takes (1 - lobe(v)) (1 - lobe(l)): over all l, 1 - lobe(v) is to be left.
    double base = 0;
    for (size_t i = 0; i < rule.x.size(); ++i) {
      base += rule.w[i] * 2 * rule.x[i] * (1 - CoverAlbedo(model, rule.x[i], 0));
    }
    CAPTURE(roughness);
    // The albedo fits are right to 2e-5 (brdf/albedo_curve.h), and the base is most of the light.
    CHECK(base * M_PI * model.diffuse.x == Approx(1).epsilon(1e-4));
  }
}

// Its colour is that of light that has met the first lobe's curve again and again: the curve that
// the material has, averaged, and not the one that would be exact.
TEST_CASE("Kulla and Conty's lobe takes the average of the Fresnel curve that the first lobe has") {
  std::vector<Material> materials;
  const auto add = [&](const auto& model) { materials.push_back(Material{.model = model}); };
  for (const ConductorFresnel fresnel :
       {ConductorFresnel::kExact, ConductorFresnel::kF82Tint, ConductorFresnel::kSchlick}) {
    ConductorMaterial iron;  // whose three curves average to 0.497, 0.497 and 0.520 in blue
    iron.eta = {2.9114, 2.9497, 2.5845};
    iron.k = {3.0893, 2.9318, 2.7670};
    iron.fresnel = fresnel;
    iron.roughness = 0.7;
    iron.compensation = Compensation::kKullaConty;
    add(iron);
  }
  for (const DielectricFresnel fresnel : {DielectricFresnel::kExact, DielectricFresnel::kSchlick}) {
    DielectricMaterial glass{.ior = 1.5,
                             .roughness = 0.7,
                             .fresnel = fresnel,
                             .compensation = Compensation::kKullaConty};
    add(glass);
  }
  for (const double metallic : {0.0, 1.0}) {
    for (const Rgb& tint : {Rgb(1), Rgb(0.5, 0.8, 0.9)}) {
      MetallicRoughnessMaterial mixed{.base_color = {0.9, 0.5, 0.1},
                                      .metallic = metallic,
                                      .specular = 0.6,
                                      .f82_tint = tint,
                                      .roughness = 0.7,
                                      .compensation = Compensation::kKullaConty};
      add(mixed);
    }
  }
  const QuadratureRule& rule = GaussLegendre(32);
  for (size_t i = 0; i < materials.size(); ++i) {
    const auto model = std::get<MicrofacetModel>(PrepareMaterial(materials[i]).model);
    Rgb average(0);
    for (size_t k = 0; k < rule.x.size(); ++k) {
      average += FresnelOf(model, rule.x[k], 1 - rule.x[k]) * (2 * rule.x[k] * rule.w[k]);
    }
    Rgb expected;
    for (int c = 0; c < 3; ++c) {
      expected[c] = KullaContyFresnel(average[c], model.albedo.lobe.e_average);
    }
    CAPTURE(i, average.x, average.y, average.z);
    CheckEqual(model.f_multiple, expected);
  }
}

// One hit at the origin of its batch's space, its normal along y.
HitBatch MakeHit(const Vec3d& to_view) {
  HitBatch hits;
  hits.count = 1;
  hits.normal.y[0] = 1;
  hits.to_view.x[0] = to_view.x;
  hits.to_view.y[0] = to_view.y;
  hits.to_view.z[0] = to_view.z;
  return hits;
}

TEST_CASE("lights and hits meet in the camera's space") {
  const Vec3d camera(10, -20, 30), position(1, 2, 0.5);
  const HitBatch hits = MakeHit({0, 1, 0});
  Surface surface;
  PrepareSurface(hits, &surface);
  Light point, spot;
  point.kind = PointLight{.position = camera + position, .intensity = {1, 1, 1}};
  spot.kind = SpotLight{
      .position = camera + position, .direction_of_travel = -position, .intensity = {1, 1, 1}};
  for (const Light& light : {point, spot}) {
    LightBatch batch;
    const ShadingLight prepared = PrepareLight(light, camera);
    EvaluateLight(prepared, hits, surface, &batch);
    CHECK(prepared.position == position);
    CHECK(batch.irradiance[0] == Approx(1 / position.length2()).epsilon(1e-6));
  }
}

TEST_CASE("a light beside a far hit keeps its direction") {
  // Floats are 0.06 apart out there.
  HitBatch hits = MakeHit({0, 1, 0});
  const Vec3d position(1e6 + 0.03, -2e6 + 0.01, 3e5), offset(0.27, 0.53, -0.11);
  hits.position.x[0] = position.x;
  hits.position.y[0] = position.y;
  hits.position.z[0] = position.z;
  Light light{.kind = PointLight{.position = position + offset, .intensity = {1, 1, 1}}};
  ForEachTarget([&](Target) {
    Surface surface;
    LightBatch batch;
    PrepareSurface(hits, &surface);
    EvaluateLight(PrepareLight(light, {0, 0, 0}), hits, surface, &batch);
    // The positions are doubles of 2e-10; the rest is a few roundings to float.
    CHECK(DirectionToLight(batch, 0).x == Approx(offset.normalized().x).epsilon(1e-6));
    CHECK(batch.irradiance[0] == Approx(1 / offset.length2()).epsilon(1e-6));
  });
}

TEST_CASE("runs may be prepared in any order") {
  MetallicRoughnessMaterial rough, smooth;
  rough.roughness = 1;
  smooth.roughness = 0.2;
  const ShadingMaterial materials[2] = {Prepare(rough), Prepare(smooth)};
  constexpr size_t kCount = 40, kBorder = 17;
  HitBatch hits;
  hits.count = kCount;
  std::fill_n(hits.normal.y.data(), kCount, 1.0);
  std::fill_n(hits.to_view.x.data(), kCount, 0.8);
  std::fill_n(hits.to_view.y.data(), kCount, 0.6);
  ForEachTarget([&](Target) {
    Surface forth, back;
    for (Surface* surface : {&forth, &back}) PrepareSurface(hits, surface);
    PrepareRun(materials[0], 0, kBorder, &forth);
    PrepareRun(materials[1], kBorder, kCount, &forth);
    PrepareRun(materials[1], kBorder, kCount, &back);
    PrepareRun(materials[0], 0, kBorder, &back);
    for (size_t i = 0; i < kCount; ++i) {
      CHECK(back.multiple[i] == forth.multiple[i]);
      CHECK(back.transmittance.y[i] == forth.transmittance.y[i]);
    }
    CHECK(forth.multiple[kBorder - 1] > 2 * forth.multiple[kBorder]);  // the materials differ
  });
}

// What the one hit reflects of a directional light of irradiance 1.
void ReflectSun(const ShadingMaterial& material, const HitBatch& hits, const Vec3d& to_light,
                ReflectedRadiance* radiance) {
  Light light{.kind = DirectionalLight{.direction_of_travel = -to_light, .irradiance = {1, 1, 1}}};
  const ShadingLight prepared = PrepareLight(light, {0, 0, 0});
  Surface surface;
  LightBatch on_hit;
  ShadeScratch scratch;
  PrepareSurface(hits, &surface);
  PrepareRun(material, 0, 1, &surface);
  EvaluateLight(prepared, hits, surface, &on_hit);
  ShadeRun({{material, hits, surface, 0, 1}, prepared, &on_hit, radiance}, &scratch);
}

TEST_CASE("a normal that leans away from the viewer counts as seen edge-on") {
  MetallicRoughnessMaterial material{.roughness = 0.7, .compensation = Compensation::kNone};
  const ShadingMaterial prepared = Prepare(material);
  const auto& model = std::get<MicrofacetModel>(prepared.model);
  const Vec3d normal(0, 1, 0), to_light = Vec3d(1, 0.5, 0).normalized();
  const Vec3d to_view = Vec3d(-0.2, -0.1, 1).normalized();
  const HitBatch hits = MakeHit(to_view);
  const Angles<double> angles = ComputeAngles(normal, to_light, to_view);
  const double fresnel = FresnelSchlick(model.f0.x, SchlickWeight(angles));
  const double expected = GgxDistribution(angles, model.alpha) * fresnel * angles.n_dot_l *
                          VisibilityHeightCorrelated(angles.n_dot_l, 0.0, model.alpha);
  ForEachTarget([&](Target) {
    ReflectedRadiance radiance;
    ReflectSun(prepared, hits, to_light, &radiance);
    CHECK(radiance.specular.x[0] == Approx(expected).epsilon(1e-5));
  });
}

TEST_CASE("a user's function is asked for hits that are seen from above their normal alone") {
  size_t asked = 0;
  const auto brdf = std::make_shared<UserBrdf>();
  brdf->evaluate = [&](const UserBrdf::Batch& batch, const UserBrdf::Values& rgb) {
    asked += batch.count;
    for (double* const plane : rgb) std::fill_n(plane, batch.count, 1.0);
  };
  const Material material{.user = brdf};
  const ShadingMaterial prepared = Prepare(material);
  const auto reflected = [&](const Vec3d& to_view) {
    ReflectedRadiance radiance;
    ReflectSun(prepared, MakeHit(to_view), {0, 1, 0}, &radiance);
    return radiance.sum.x[0];
  };
  CHECK(reflected(Vec3d(0.6, 0.8, 0)) == 1);
  CHECK(asked == 1);
  CHECK(reflected(Vec3d(1, -1e-9, 0)) == 0);  // as roundings of grazing views are
  CHECK(asked == 1);
}

// On spheres n.v of what is seen rounds to above -4e-7, and with it n.u: the limit of grazing
// viewers then, and not no lobe at all.
TEST_CASE("a hit at the limb whose half vector rounds to below the surface has its lobe") {
  MetallicRoughnessMaterial material{.roughness = 0.7, .compensation = Compensation::kNone};
  const ShadingMaterial prepared = Prepare(material);
  const auto& model = std::get<MicrofacetModel>(prepared.model);
  const Vec3d to_light(1, 1e-7, 0), to_view(0, -3e-7, 1);
  const HitBatch hits = MakeHit(to_view);
  const Angles<double> angles = ComputeAngles(Vec3d(0, 1, 0), to_light, to_view);
  // h in the surface: D is alpha^2 / pi; n.l V with n.v = 0 is 1 / (2 alpha).
  const double expected =
      model.alpha * FresnelSchlick(model.f0.x, SchlickWeight(angles)) / (2 * M_PI);
  ForEachTarget([&](Target) {
    ReflectedRadiance radiance;
    ReflectSun(prepared, hits, to_light, &radiance);
    CHECK(radiance.specular.x[0] == Approx(expected).epsilon(1e-5));
  });
}

TEST_CASE("rough diffuse surfaces whose normal leans away count as seen edge-on, too") {
  const Vec3d to_light = Vec3d(1, 0.5, 0).normalized();
  const Vec3d to_view = Vec3d(-0.2, -0.3, 1).normalized();
  const HitBatch hits = MakeHit(to_view);
  Angles<double> edge_on = ComputeAngles(Vec3d(0, 1, 0), to_light, to_view);
  edge_on.n_dot_v = 1e-300;
  const std::pair<ShadingMaterial, double> cases[] = {
      {Prepare(OrenNayarMaterial{.albedo = {0.8, 0.8, 0.8}, .roughness = 1}),
       Eon(edge_on, 0.8, 1.0)},
      {Prepare(BurleyMaterial{.albedo = {0.8, 0.8, 0.8}, .roughness = 1}),
       0.8 * BurleyDiffuse(edge_on, 1.0)}};
  for (const auto& each : cases) {
    ForEachTarget([&](Target) {
      ReflectedRadiance radiance;
      ReflectSun(each.first, hits, to_light, &radiance);
      CHECK(radiance.diffuse.x[0] == Approx(each.second * edge_on.n_dot_l).epsilon(1e-5));
    });
  }
}

TEST_CASE("light exactly opposite the viewer of a normal that leans away: no highlight, no NaN") {
  const Vec3d to_view(0, -1, 0);  // of a hit whose normal is +y
  const HitBatch hits = MakeHit(to_view);
  for (const DiffuseCoupling coupling :
       {DiffuseCoupling::kAlbedoScaled, DiffuseCoupling::kOneMinusFresnel}) {
    MetallicRoughnessMaterial material{.diffuse_coupling = coupling};
    const ShadingMaterial prepared = Prepare(material);
    ForEachTarget([&](Target) {
      ReflectedRadiance radiance;
      ReflectSun(prepared, hits, -to_view, &radiance);
      CHECK(radiance.specular.x[0] == 0);
      CHECK(std::isfinite(radiance.diffuse.x[0]));
    });
  }
}

}  // namespace
}  // namespace nacre
