// SPDX-License-Identifier: Apache-2.0
// tests/render/thin_film_test.cc: what a plan says of OpenPBR materials that it does not render as
// they are.
#include <cmath>
#include <functional>
#include <string>
#include <type_traits>
#include <vector>

#include "catch.h"
#include "pictures.h"
#include "render/frame_plan.h"
#include "render/render.h"
#include "scene/material_parameters.h"
#include "textured_scenes.h"

namespace nacre {
namespace {

std::vector<std::string> NotesOf(const Scene& scene) { return MakePlan(scene, {}).why.notes; }

Scene LitSphere(const OpenPbrMaterial& material) {
  Scene scene = OrthographicSphere(material, 1);
  scene.materials[0].name = "ball";
  scene.lights = {Named("key", DirectionalLight{Vec3d(0, 0, -1), Rgb(1)})};
  return scene;
}

TEST_CASE("a plan notes light that would pass through") {
  OpenPbrMaterial glass;
  CHECK(NotesOf(LitSphere(glass)).empty());
  glass.transmission_weight = 0.5;
  REQUIRE(NotesOf(LitSphere(glass)).size() == 1);
  CHECK(NotesOf(LitSphere(glass))[0] ==
        "material \"ball\": the light that passes through is not rendered; the base is opaque");
}

// The middle of the picture of a sphere that is lit from the viewer: all cosines are 1.
template <class Model>
Rgb HeadOn(const Model& material,
           const std::type_identity_t<std::function<void(Scene*, Model*)>>& add_maps = {}) {
  Scene scene = OrthographicSphere(material, 1);
  scene.lights = {Named("key", DirectionalLight{Vec3d(0, 0, -1), Rgb(1)})};
  if (add_maps) {
    Model with_maps = material;
    add_maps(&scene, &with_maps);
    scene.materials[0].model = with_maps;
  }
  const Image image = RenderImage(scene, {});
  const size_t middle = static_cast<size_t>(32 * 64 + 32);
  return {image.Find("R")->samples[middle], image.Find("G")->samples[middle],
          image.Find("B")->samples[middle]};
}

void CheckNear(const Rgb& a, const Rgb& b) {
  // The pixel's centre is half a pixel from the middle: cosines are 1 - 3e-4 there, and a film is
  // evaluated at n.v, not at v.h.
  for (int c = 0; c < 3; ++c) CHECK(a[c] == Approx(b[c]).epsilon(2e-3));
}

TEST_CASE("maps of a film, and of what lies below it, are the constants that they hold") {
  for (const ThinFilmForm form : {ThinFilmForm::kGltf, ThinFilmForm::kSpectral,
                                  ThinFilmForm::kBelcourBarla, ThinFilmForm::kLines}) {
    for (const double metallic : {0.0, 0.5, 1.0}) {
      CAPTURE(static_cast<int>(form), metallic);
      MetallicRoughnessMaterial film{.base_color = {0.9, 0.6, 0.3}, .metallic = metallic};
      film.roughness = 0.3;
      film.iridescence = 1;
      film.iridescence_thickness_nm = 500;
      film.iridescence_model = form;
      MetallicRoughnessMaterial other = film;
      other.iridescence_thickness_nm = 200 + 0.25 * (500 - 200);
      const Rgb thin = HeadOn(other);
      CheckNear(HeadOn(film,
                       [](Scene* scene, MetallicRoughnessMaterial* material) {
                         material->iridescence_thickness_minimum_nm = 200;
                         material->iridescence_thickness_map =
                             AddConstant(scene, Rgb(1, 0.25, 1));  // green
                       }),
                thin);
      CHECK(std::abs(thin.z / HeadOn(film).z - 1) > 0.02);  // the check above could fail
      other = film;
      other.iridescence = 0.25;
      CheckNear(HeadOn(film,
                       [](Scene* scene, MetallicRoughnessMaterial* material) {
                         material->iridescence_map = AddConstant(scene, Rgb(0.25, 1, 1));
                       }),
                HeadOn(other));
      other = film;
      other.base_color = film.base_color * Rgb(0.5, 0.75, 1);
      CheckNear(HeadOn(film,
                       [](Scene* scene, MetallicRoughnessMaterial* material) {
                         material->base_color_map = AddConstant(scene, Rgb(0.5, 0.75, 1));
                       }),
                HeadOn(other));
    }
  }
}

TEST_CASE("maps of a metal's colours below OpenPBR's film are the constants that they hold") {
  for (const ThinFilmForm form : {ThinFilmForm::kSpectral, ThinFilmForm::kLines}) {
    for (const double metalness : {0.5, 1.0}) {
      for (const double coat : {0.0, 0.5, 1.0}) {
        CAPTURE(static_cast<int>(form), metalness, coat);
        OpenPbrMaterial film{.base_color = {0.9, 0.6, 0.3}, .base_metalness = metalness};
        film.coat_weight = coat;
        film.thin_film_weight = 0.75;
        film.options.film = form;
        OpenPbrMaterial other = film;
        other.base_color = film.base_color * Rgb(0.5, 0.75, 1);
        const Rgb darker = HeadOn(other);
        CheckNear(HeadOn(film,
                         [](Scene* scene, OpenPbrMaterial* material) {
                           material->base_color_map = AddConstant(scene, Rgb(0.5, 0.75, 1));
                         }),
                  darker);
        CHECK(std::abs(darker.x / HeadOn(film).x - 1) > 0.02);  // the check above could fail
        other = film;
        other.specular_color = Rgb(1, 0.5, 0.25);
        CheckNear(HeadOn(film,
                         [](Scene* scene, OpenPbrMaterial* material) {
                           material->specular_color_map = AddConstant(scene, Rgb(1, 0.5, 0.25));
                         }),
                  HeadOn(other));
      }
    }
  }
}

TEST_CASE("a white surface stays white under a film whose thickness is a map") {
  for (const double roughness : {0.0, 0.3, 1.0}) {
    CAPTURE(roughness);
    MetallicRoughnessMaterial film{.base_color = Rgb(1)};
    film.roughness = roughness;
    film.iridescence = 1;
    film.iridescence_ior = 1.8;
    film.iridescence_thickness_nm = 800;
    Scene scene = OrthographicSphere(film, 64);
    scene.lights = {WhiteSky()};
    film.iridescence_thickness_map =
        AddTexture(&scene, 16, 8, [](int x, int) { return Rgb((x % 4) / 3.0); });
    scene.materials[0].model = film;
    const Mean mean = MeanRed(RenderImage(scene, {}));
    CAPTURE(mean.value, mean.error);
    // 2e-4: the error of an albedo at render time (brdf/albedo.h).
    CHECK(std::abs(mean.value - 1) <= 4 * mean.error + 2e-4);
    CHECK(mean.error < 3e-3);  // the check above could fail
  }
}

TEST_CASE("films below any map of their materials make finite pictures") {
  for (const std::string_view name : {"open_pbr", "metallic_roughness"}) {
    const MaterialModel& model = *FindModel(name);
    for (const MaterialMap& map : model.maps) {
      for (const double metalness : {0.0, 1.0}) {
        Scene scene = LitSphere({});
        Material& material = scene.materials[0];
        material.model = model.make().model;
        const bool is_open_pbr = name == "open_pbr";
        FindParameter(model, is_open_pbr ? "thin_film_weight" : "iridescence")
            ->set(material, Rgb(1));
        FindParameter(model, is_open_pbr ? "base_metalness" : "metallic")
            ->set(material, Rgb(metalness));
        map.set(material, AddConstant(&scene, Rgb(0.5)));
        CAPTURE(name, map.name, metalness);
        const Image image = RenderImage(scene, {});
        bool is_finite = true, is_lit = false;
        for (const char* const channel : {"R", "G", "B"}) {
          for (const float sample : image.Find(channel)->samples) {
            is_finite = is_finite && std::isfinite(sample) && sample >= 0;
            is_lit = is_lit || sample > 0;
          }
        }
        CHECK(is_finite);
        CHECK(is_lit);
      }
    }
  }
}

}  // namespace
}  // namespace nacre
