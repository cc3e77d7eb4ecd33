// SPDX-License-Identifier: Apache-2.0
// tests/shading/thin_film_lobe_test.cc: materials under thin films: energy, limits, and the figures
// of other implementations, by whose options they are imitated.
#include <algorithm>
#include <cmath>

#include "catch.h"
#include "scene/material.h"
#include "shading/material.h"
#include "shading/scalar_bsdf.h"
#include "shading/share.h"

namespace nacre {
namespace {

const MicrofacetModel& ModelOfPrepared(const ShadingMaterial& material) {
  return std::get<MicrofacetModel>(material.model);
}

// Fresnel's term at a cosine.
template <class Model>
Rgb FresnelAt(const Model& model, double cosine) {
  Material material;
  material.model = model;
  const ShadingMaterial prepared = PrepareMaterial(material);
  return FresnelOf(ModelOfPrepared(prepared), cosine, 1 - cosine);
}

double Distance(const Rgb& a, const Rgb& b) {
  return std::max({std::abs(a.x - b.x), std::abs(a.y - b.y), std::abs(a.z - b.z)});
}

// The film of the figures: 400 nm of index 1.4 on gold.
OpenPbrMaterial FilmOnGold() {
  OpenPbrMaterial gold{.base_color = {0.929, 0.788, 0.374}, .base_metalness = 1};
  gold.specular_color = {0.967, 0.888, 0.574};
  gold.thin_film_weight = 1;
  gold.thin_film_thickness = 0.4;
  gold.options.film = ThinFilmForm::kLines;
  return gold;
}

// A film of 500 nm and index 1.4 on an index of 1.5.
OpenPbrMaterial FilmOnPlastic() {
  OpenPbrMaterial plastic{.base_color = {1, 1, 1}};
  plastic.thin_film_weight = 1;
  plastic.options.film = ThinFilmForm::kLines;
  return plastic;
}

}  // namespace

TEST_CASE("films of other implementations have their figures at normal incidence") {
  // Airy's sums at 620, 540 and 450 nm, computed once by a program of its own and rounded to three
  // digits, for indices that are guessed in three ways from the same colours.
  OpenPbrMaterial gold = FilmOnGold();
  gold.options.film_metal = FilmMetal::kRealIndex;
  CHECK(Distance(FresnelAt(gold, 1), {0.916, 0.783, 0.129}) < 2e-3);
  // A dielectric, in air and under a coat of index 1.6.
  OpenPbrMaterial plastic = FilmOnPlastic();
  CHECK(Distance(FresnelAt(plastic, 1), {0.0284, 0.0196, 0.0374}) < 1e-4);
  plastic.coat_weight = 1;
  CHECK(Distance(FresnelAt(plastic, 1), {0.0059, 0.0094, 0.0021}) < 1e-4);
  // As MaterialX has it: air above the film, and a base of the index that is relative to the coat.
  plastic.options.film_outside = FilmOutside::kAir;
  plastic.options.coat_fresnel = CoatFresnel::kInvertRatio;
  CHECK(Distance(FresnelAt(plastic, 1), {0.0482, 0.0806, 0.0119}) < 1e-4);
  // The film remains where the interface vanishes.
  OpenPbrMaterial bubble = FilmOnPlastic();
  bubble.specular_ior = 1;
  CHECK(Distance(FresnelAt(bubble, 1), {0.0581, 0.0973, 0.0136}) < 1e-4);
}

TEST_CASE("films by the rules of Adobe's library have its values") {
  // Rows of adobe/openpbr-bsdf a29da96 in single precision: f n.l of the lobe without its second.
  OpenPbrMaterial metal{.options = OptionsOf(OpenPbrRules::kAdobe)};
  metal.options.compensation = Compensation::kNone;
  metal.base_color = {0.5257, 0.8656, 0.7612};
  metal.base_metalness = 1;
  metal.specular_color = {0.8167, 0.9872, 0.7853};
  metal.specular_roughness = 0.5619;
  metal.thin_film_weight = 1;
  metal.thin_film_thickness = 0.6267;
  metal.thin_film_ior = 1.3515;
  const auto specular = [](const OpenPbrMaterial& material, const Vec3d& l, const Vec3d& v) {
    return Reflect(PrepareMaterial({.model = material}), Vec3d(0, 0, 1), l, v).specular;
  };
  CHECK(Distance(specular(metal, {-0.3880684, 0.1679083, 0.9062061},
                          {0.2668286, -0.03725427, 0.9630238}),
                 {0.3352868, 0.6054575, 0.4781917}) < 1e-5);
}

TEST_CASE("a film's weight is a blend with the interface without it, and fades as it is told") {
  OpenPbrMaterial gold = FilmOnGold();
  for (const double cosine : {1.0, 0.6, 0.2}) {
    const Rgb with = FresnelAt(gold, cosine);
    OpenPbrMaterial other = gold;
    other.thin_film_weight = 0;
    const Rgb without = FresnelAt(other, cosine);
    other.thin_film_weight = 0.3;
    CHECK(Distance(FresnelAt(other, cosine), with * 0.3 + without * 0.7) < 1e-5);
    other.thin_film_weight = 1;
    other.options.film_fade_nm = 800;  // at half of which smoothstep is 1/2
    CHECK(Distance(FresnelAt(other, cosine), (with + without) * 0.5) < 1e-5);
    other.options.film_fade_nm = 30;
    other.thin_film_thickness = 0;
    CHECK(Distance(FresnelAt(other, cosine), without) < 1e-15);
  }
  // A film of the base's own index is none.
  OpenPbrMaterial plastic = FilmOnPlastic();
  plastic.thin_film_ior = plastic.specular_ior;
  OpenPbrMaterial bare = plastic;
  bare.thin_film_weight = 0;
  for (const double cosine : {1.0, 0.5, 0.1, 0.01}) {
    CHECK(Distance(FresnelAt(plastic, cosine), FresnelAt(bare, cosine)) < 1e-5);
  }
}

TEST_CASE("a white base under a film reflects all light") {
  // What the film reflects and what its base gets are both of the film's albedo, which has an error
  // of 3e-4 (tests/brdf/table_albedo_test.cc).
  double worst = 0;
  for (const double thickness : {0.15, 0.4, 1.0}) {
    for (const double roughness : {0.0, 0.01, 0.05, 0.1, 0.3, 0.6, 1.0}) {
      OpenPbrMaterial open_pbr{.base_color = {1, 1, 1}, .specular_roughness = roughness};
      open_pbr.thin_film_weight = 1;
      open_pbr.thin_film_thickness = thickness;
      MetallicRoughnessMaterial metallic{.base_color = {1, 1, 1}, .roughness = roughness};
      metallic.iridescence = 1;
      metallic.iridescence_thickness_nm = 1000 * thickness;
      for (const Material& material : {Material{.model = open_pbr}, Material{.model = metallic}}) {
        const ShadingMaterial prepared = PrepareMaterial(material);
        for (const double n_dot_v : {1e-4, 0.01, 0.05, 0.2, 0.5, 0.8, 1.0}) {
          const Rgb share = ReflectedShare(prepared, ShareOf::kFurnace, n_dot_v);
          CAPTURE(thickness, roughness, n_dot_v, share);
          worst = std::max(worst, Distance(share, Rgb(1)));
        }
      }
    }
  }
  CAPTURE(worst);
  CHECK(worst < 1e-3);
}

TEST_CASE("specular scales all that a dielectric under a film reflects, and nothing of metals") {
  MetallicRoughnessMaterial film{.base_color = {0.9, 0.6, 0.3}};
  film.iridescence = 1;
  const Rgb whole = FresnelAt(film, 0.4);
  film.specular = 0.5;
  CHECK(Distance(FresnelAt(film, 0.4), whole * 0.5) < 1e-15);
  film.metallic = 1;
  const Rgb metal = FresnelAt(film, 0.4);
  film.specular = 1;
  CHECK(FresnelAt(film, 0.4) == metal);
}

}  // namespace nacre
