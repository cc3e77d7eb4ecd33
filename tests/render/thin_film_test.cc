// SPDX-License-Identifier: Apache-2.0
// tests/render/thin_film_test.cc: what a plan says of OpenPBR materials that it does not render as
// they are.
#include <cmath>
#include <string>
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

TEST_CASE("a plan notes films that do not know the maps below them") {
  OpenPbrMaterial film{.base_metalness = 1};
  film.thin_film_weight = 1;
  CHECK(NotesOf(LitSphere(film)).empty());
  const auto notes_with_map = [](const OpenPbrMaterial& material) {
    Scene scene = LitSphere(material);
    std::get<OpenPbrMaterial>(scene.materials[0].model).base_color_map =
        AddConstant(&scene, Rgb(0.5));
    return NotesOf(scene);
  };
  REQUIRE(notes_with_map(film).size() == 1);
  CHECK(notes_with_map(film)[0].find("without maps") != std::string::npos);
  film.base_metalness = 0;  // the colour of a diffuse base does not change its film
  CHECK(notes_with_map(film).empty());
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
