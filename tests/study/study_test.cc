// SPDX-License-Identifier: Apache-2.0
// What the studies are made of: reflection by twins and kernels, shares by quadrature, rounding.
#include <cmath>

#include "brdf/albedo_integral.h"
#include "brdf/phong.h"
#include "catch.h"
#include "light/punctual.h"
#include "shading/share.h"
#include "study/light_curves.h"
#include "study/material_curves.h"
#include "study/rounding.h"
#include "tables.h"
#include "targets.h"

namespace nacre {
namespace {

template <class Model>
ShadingMaterial Prepare(const Model& model) {
  return PrepareMaterial(Material{.model = model});
}

std::vector<NamedMaterial> AllModels() {
  std::vector<NamedMaterial> models = {
      {"lambert", Prepare(LambertMaterial{Rgb(0.2, 0.5, 0.8)})},
      {"conductor", Prepare(ConductorMaterial{.eta = {0.2, 0.9, 1.4}, .k = {3.9, 2.4, 1.6}})},
      {"dielectric", Prepare(DielectricMaterial{.roughness = 0.3})},
      {"oren_nayar", Prepare(OrenNayarMaterial{.albedo = {0.2, 0.5, 0.9}, .roughness = 0.7})},
      {"burley", Prepare(BurleyMaterial{.albedo = {0.2, 0.5, 0.9}, .roughness = 0.7})},
      {"oren_nayar base", Prepare(MetallicRoughnessMaterial{.base_color = {0.9, 0.5, 0.1},
                                                            .roughness = 0.4,
                                                            .diffuse = DiffuseForm::kOrenNayar,
                                                            .diffuse_roughness = 0.8})},
      {"burley base",
       Prepare(DielectricMaterial{.roughness = 0.3, .diffuse = DiffuseForm::kBurley})},
  };
  for (const PhongModel model :
       {PhongModel::kPhong, PhongModel::kModifiedPhong, PhongModel::kBlinnPhong}) {
    models.push_back({"phong", Prepare(PhongMaterial{.model = model, .shininess = 40})});
  }
  for (const Compensation compensation :
       {Compensation::kNone, Compensation::kTurquin, Compensation::kKullaConty}) {
    for (const DiffuseCoupling coupling :
         {DiffuseCoupling::kAlbedoScaled, DiffuseCoupling::kOneMinusFresnel,
          DiffuseCoupling::kNone}) {
      models.push_back(
          {"metallic_roughness", Prepare(MetallicRoughnessMaterial{.base_color = {0.9, 0.5, 0.1},
                                                                   .metallic = 0.3,
                                                                   .roughness = 0.4,
                                                                   .compensation = compensation,
                                                                   .diffuse_coupling = coupling})});
    }
  }
  MetallicRoughnessMaterial covered{.base_color = {0.3, 0.1, 0.1}, .roughness = 0.6};
  covered.coat = 0.7;
  covered.coat_roughness = 0.2;
  models.push_back({"coated", Prepare(covered)});
  covered.sheen_color = {0.4, 0.5, 1};
  covered.sheen_roughness = 0.3;
  models.push_back({"coated velvet", Prepare(covered)});
  return models;
}

}  // namespace

TEST_CASE("Kernels compute what the curves show") {
  const Vec3d normal(0, 0, 1);
  ForEachTarget([&](Target) {
    for (const NamedMaterial& named : AllModels()) {
      CAPTURE(named.label);
      for (const double light : {-70.0, -20.0, 0.0, 35.0, 80.0}) {
        const Vec3d to_light = DirectionAt(light);
        const Vec3d to_view = Vec3d(-0.5, 0.3, 0.7).normalized();
        const Rgb exact = Reflect(named.material, normal, to_light, to_view).Sum();
        const Rgb kernel = ReflectByKernel(named.material, normal, to_light, to_view).Sum();
        for (int c = 0; c < 3; ++c) {
          // Float, and lobes 1e-2 rad wide and more: 1e-5 as the shading tests ask.
          CHECK(kernel[c] == Approx(exact[c]).epsilon(1e-5).margin(1e-7));
        }
      }
    }
  });
}

TEST_CASE("Nothing is reflected through the surface") {
  for (const NamedMaterial& named : AllModels()) {
    CHECK(Reflect(named.material, Vec3d(0, 0, 1), DirectionAt(95), DirectionAt(0)).Sum() == Rgb(0));
    CHECK(Reflect(named.material, Vec3d(0, 0, 1), DirectionAt(0), DirectionAt(95)).Sum() == Rgb(0));
  }
}

// By brute force: a fine grid of directions, of the cosine for the furnace and of n.v for one
// light.
TEST_CASE("Shares are the integrals that they are said to be") {
  constexpr int kPolar = 400, kAzimuths = 150;
  const double cosine = 0.6;
  const Vec3d fixed(-0.8, 0, 0.6);
  for (const NamedMaterial& named : AllModels()) {
    CAPTURE(named.label);
    for (const ShareOf what : {ShareOf::kFurnace, ShareOf::kOneLight}) {
      Rgb sum(0);
      for (int i = 0; i < kPolar; ++i) {
        const double polar = (i + 0.5) / kPolar * M_PI / 2;
        for (int j = 0; j < kAzimuths; ++j) {
          const double phi = (j + 0.5) / kAzimuths * M_PI;  // symmetric: half of it
          const Vec3d other(std::sin(polar) * std::cos(phi), std::sin(polar) * std::sin(phi),
                            std::cos(polar));
          const bool furnace = what == ShareOf::kFurnace;
          const Rgb value = Reflect(named.material, Vec3d(0, 0, 1), furnace ? other : fixed,
                                    furnace ? fixed : other)
                                .Sum();
          sum += value * (std::sin(polar) * (furnace ? 1 : other.z / cosine));
        }
      }
      sum *= M_PI / 2 / kPolar * 2 * M_PI / kAzimuths;
      const Rgb share = ReflectedShare(named.material, what, cosine);
      // The grid's own error, of a lobe that is cut by the horizon at most: 1e-4; the albedo fits'
      // another 1e-4.
      for (int c = 0; c < 3; ++c) CHECK(share[c] == Approx(sum[c]).epsilon(3e-4));
    }
  }
}

// Metallic mixes a dielectric over its base and a metal (glTF 2.0, Appendix B). E and B, a lobe's
// albedos for F = 1 and for Schlick's weight, are the table's, to 5e-14.
TEST_CASE(
    "A part metal reflects the shares of its dielectric and its metal, to the table's albedos") {
  const auto table = LoadTable("energy");
  for (const auto& row : table.at("dfg")) {
    const double mu = TableNumber(row.at("mu")), roughness = TableNumber(row.at("roughness"));
    const double one = TableNumber(row.at("E")), schlick = TableNumber(row.at("B"));
    for (const double metallic : {0.0, 0.3, 0.8, 1.0}) {
      MetallicRoughnessMaterial material{.base_color = {1, 0.5, 0.1},
                                         .metallic = metallic,
                                         .specular = 0.8,
                                         .roughness = roughness};
      Material any{.model = material};
      const Rgb share = ReflectedShare(PrepareMaterial(any), ShareOf::kFurnace, mu);
      for (int c = 0; c < 3; ++c) {
        const double base = material.base_color[c];
        const auto lobe = [&](double f0, double f90) {  // compensated as Turquin has it
          return (f0 * (one - schlick) + f90 * schlick) * (1 + f0 * (1 / one - 1));
        };
        const double gloss = lobe(0.8 * 0.04, 0.8);
        const double expected =
            (1 - metallic) * (gloss + base * (1 - gloss)) + metallic * lobe(base, 1);
        CAPTURE(roughness, mu, metallic, c, share[c], expected);
        // The render's own albedos, of E 1e-4 of itself (brdf/albedo.h).
        CHECK(std::abs(share[c] - expected) <= 1e-4);
      }
    }
  }
}

// What brdf/phong.h says of the radiometric scale.
TEST_CASE("ks is what Phong's lobes reflect of light from along the normal") {
  for (const double shininess : {0.0, 0.5, 1.0, 8.0, 32.0, 1e3, 1e6}) {
    for (const PhongModel model :
         {PhongModel::kPhong, PhongModel::kModifiedPhong, PhongModel::kBlinnPhong}) {
      Material material;
      material.model =
          PhongMaterial{.model = model, .kd = Rgb(0), .ks = Rgb(1), .shininess = shininess};
      const ShadingMaterial prepared = PrepareMaterial(material);
      const double furnace = model == PhongModel::kPhong        ? PhongFurnace(shininess)
                             : model == PhongModel::kBlinnPhong ? BlinnFurnace(shininess)
                                                                : 1.0;
      CAPTURE(shininess, static_cast<int>(model));
      // The quadrature's: c^n of an exponent below 1 ends at the horizon with an infinite slope,
      // and circles that the horizon cuts with that of a root.
      const double error = shininess < 1 ? 1e-4 : 1e-6;
      CHECK(ReflectedShare(prepared, ShareOf::kOneLight, 1).x == Approx(1).epsilon(error));
      CHECK(ReflectedShare(prepared, ShareOf::kFurnace, 1).x == Approx(furnace).epsilon(error));
      for (const double cosine : {0.9, 0.5, 0.1}) {
        CHECK(ReflectedShare(prepared, ShareOf::kFurnace, cosine).x <= furnace * (1 + error));
      }
    }
  }
}

TEST_CASE("A distribution of normals covers the surface once") {
  for (const auto& material :
       {Prepare(MetallicRoughnessMaterial{.roughness = 0.5}),
        Prepare(PhongMaterial{.model = PhongModel::kBlinnPhong, .shininess = 20})}) {
    REQUIRE(HasDistribution(material));
    const Plot plot = DistributionPlot({{"", material}});
    const Curve& curve = plot.curves.at(0);
    double sum = 0;  // of D n.h over the hemisphere, trapezoids of an eighth of a degree
    for (size_t i = 0; i + 1 < curve.x.size(); ++i) {
      const double angle = (curve.x[i] + curve.x[i + 1]) / 2 * M_PI / 180;
      const double step = (curve.x[i + 1] - curve.x[i]) * M_PI / 180;
      sum += (curve.y[i] + curve.y[i + 1]) / 2 * std::cos(angle) * std::sin(angle) * step;
    }
    CHECK(2 * M_PI * sum == Approx(1).epsilon(1e-4));
  }
  CHECK(!HasDistribution(Prepare(LambertMaterial{})));
  CHECK(!HasDistribution(Prepare(MetallicRoughnessMaterial{.roughness = 0})));
}

TEST_CASE("From afar every light falls off with the square of its distance") {
  const std::vector<Light> lights = [] {
    std::vector<Light> all(4);
    all[0].kind = PointLight{.intensity = Rgb(2)};
    all[1].kind = SphereAreaLight{.radius = 0.5, .radiance = Rgb(3)};
    all[2].kind = DiskAreaLight{.radius = 0.5, .radiance = Rgb(3)};
    all[3].kind = RectangleAreaLight{.width = 2, .height = 0.5, .radiance = Rgb(3)};
    return all;
  }();
  const double intensity[] = {2, 3 * M_PI / 4, 3 * M_PI / 4, 3};
  for (size_t i = 0; i < lights.size(); ++i) {
    CAPTURE(i);
    REQUIRE(HasFalloff(lights[i]));
    // (size / distance)^2 is 4e-6 at most.
    CHECK(*IrradianceAt(lights[i], 1000) * 1e6 == Approx(intensity[i]).epsilon(1e-5));
    CHECK(*IrradianceAt(lights[i], 0.6) < intensity[i] / 0.36 * (1 + 1e-9));
  }
  // A sphere's irradiance is exactly that of a point at its centre; inside there is none.
  CHECK(*IrradianceAt(lights[1], 0.6) == Approx(intensity[1] / 0.36));
  CHECK(!IrradianceAt(lights[1], 0.4));
  CHECK(!HasFalloff(Light{.kind = AmbientLight{Rgb(1)}}));
}

TEST_CASE("Errors of hits are those that the forms are known for") {
  // The textbook's in float at 1e4 radii: a quarter of the hits lost, and normals off by 0.1 rad.
  const HitError textbook = MeasureHits(HitForm::kTextbookFloat, 1e4);
  CHECK(textbook.wrong > 0.15);
  CHECK(textbook.normal > 0.05);
  for (const double distance : {1e1, 1e4, 1e7}) {
    const HitError nacre = MeasureHits(HitForm::kNacre, distance);
    CHECK(nacre.wrong == 0);
    CHECK(nacre.normal < 1e-10);
  }
  CHECK(MeasureHits(HitForm::kTextbookDouble, 1e7).normal > 1e-4);
  // Highlights: 7 % and more in float at roughness 0.05; the kernels within 1e-5.
  CHECK(MeasureGgx(GgxForm::kTextbookFloat, 0.05) > 0.01);
  CHECK(MeasureGgx(GgxForm::kTextbookDouble, 0.05) < 1e-6);
  CHECK(MeasureGgx(GgxForm::kNacre, 0.05) < 1e-6);
  CHECK(MeasureGgx(GgxForm::kNacre, 0.5) < 1e-5);
}

}  // namespace nacre
