// SPDX-License-Identifier: Apache-2.0
// tests/render/constant_maps_test.cc: maps that are constant against constants, to the bit.
#include <algorithm>
#include <cmath>
#include <memory>
#include <string_view>
#include <utility>
#include <vector>

#include "scene/material_parameters.h"
#include "scene/sphere_mesh.h"
#include "targets.h"
#include "textured_scenes.h"

namespace nacre {
namespace {

// Renders the material and the same with maps, which `add_maps` gives it and which multiply to it.
template <class Model, class AddMaps>
void CheckConstantMaps(const Model& constant, const Model& factors, const AddMaps& add_maps) {
  ForEachTarget([&](Target) {
    Material plain, mapped;
    plain.model = constant;
    mapped.model = factors;
    Scene with_maps = TexturedSpheres(mapped);
    add_maps(&with_maps, &std::get<Model>(with_maps.materials[0].model));
    const Image got = AllLayers(with_maps), expected = AllLayers(TexturedSpheres(plain));
    REQUIRE(*std::max_element(expected.channels[0].samples.begin(),
                              expected.channels[0].samples.end()) > 0.1f);
    CheckSameBits(got, expected);
  });
}

TEST_CASE("constant maps have the bits of constants: metallic-roughness") {
  const Rgb color = Held(Rgb(0.9, 0.4, 0.2));
  const Rgb metallic_roughness = Held(Rgb(0, 0.7, 0.6));
  for (const double roughness : {1.0, 0.1, 0.0}) {
    for (const Compensation compensation :
         {Compensation::kTurquin, Compensation::kKullaConty, Compensation::kNone}) {
      for (const Shadowing shadowing :
           {Shadowing::kHeightCorrelated, Shadowing::kSchlickDirect, Shadowing::kSchlickIbl}) {
        for (const double tint : {1.0, 0.7}) {
          MetallicRoughnessMaterial factors{.base_color = Rgb(0.5, 1, 0.75),
                                            .metallic = 0.5,
                                            .f82_tint = Rgb(tint),
                                            .roughness = roughness,
                                            .shadowing = shadowing,
                                            .compensation = compensation};
          if (compensation == Compensation::kNone) {
            factors.diffuse_coupling = DiffuseCoupling::kOneMinusFresnel;
          }
          MetallicRoughnessMaterial constant = factors;
          constant.base_color = factors.base_color * color;
          constant.metallic = factors.metallic * metallic_roughness.z;
          constant.roughness = factors.roughness * metallic_roughness.y;
          CAPTURE(roughness, static_cast<int>(compensation), static_cast<int>(shadowing), tint);
          CheckConstantMaps(
              constant, factors, [&](Scene* scene, MetallicRoughnessMaterial* material) {
                material->base_color_map = AddConstant(scene, color);
                material->metallic_roughness_map = AddConstant(scene, metallic_roughness);
              });
          // Without a map of roughness the albedo fit is the material's.
          MetallicRoughnessMaterial colored = factors;
          colored.base_color = factors.base_color * color;
          CheckConstantMaps(colored, factors,
                            [&](Scene* scene, MetallicRoughnessMaterial* material) {
                              material->base_color_map = AddConstant(scene, color);
                            });
        }
      }
    }
  }
}

TEST_CASE("constant maps have the bits of constants: weights and colours of a dielectric") {
  const Rgb color = Held(Rgb(0.9, 0.4, 0.2)), weight = Held(Rgb(0.3));
  for (const Compensation compensation :
       {Compensation::kTurquin, Compensation::kKullaConty, Compensation::kNone}) {
    for (const double metallic : {0.0, 0.4}) {
      for (const double roughness : {0.5, 0.0}) {
        MetallicRoughnessMaterial factors{.metallic = metallic,
                                          .dielectric_f0 = Rgb(0.5, 0.1, 0.04),
                                          .specular = 0.75,
                                          .f82_tint = Rgb(metallic > 0 ? 0.7 : 1),
                                          .roughness = roughness,
                                          .compensation = compensation};
        if (compensation == Compensation::kNone) {
          factors.diffuse_coupling = DiffuseCoupling::kOneMinusFresnel;
        }
        MetallicRoughnessMaterial constant = factors;
        constant.dielectric_f0 = factors.dielectric_f0 * color;
        constant.specular = factors.specular * weight.x;
        CAPTURE(static_cast<int>(compensation), metallic, roughness);
        CheckConstantMaps(constant, factors,
                          [&](Scene* scene, MetallicRoughnessMaterial* material) {
                            material->specular_color_map = AddConstant(scene, color);
                            material->specular_map = AddConstant(scene, weight);
                          });
      }
    }
  }
}

TEST_CASE("constant maps have the bits of constants: the Phong family and Lambert") {
  const Rgb color = Held(Rgb(0.9, 0.4, 0.2)), gloss = Held(Rgb(0.3, 0.8, 0.6));
  const double share = 0.5;
  for (const PhongModel model :
       {PhongModel::kPhong, PhongModel::kModifiedPhong, PhongModel::kBlinnPhong}) {
    for (const PhongConvention convention :
         {PhongConvention::kClassic, PhongConvention::kRadiometric}) {
      for (const double shininess : {32.0, 2000.0}) {  // wide, and narrow
        PhongMaterial factors{.model = model,
                              .convention = convention,
                              .color = Rgb(0.5, 1, 0.75),
                              .shininess = shininess};
        PhongMaterial constant = factors;
        constant.color = factors.color * color;
        constant.ks = factors.ks * gloss;
        constant.shininess = shininess * share;
        CAPTURE(static_cast<int>(model), static_cast<int>(convention), shininess);
        CheckConstantMaps(constant, factors, [&](Scene* scene, PhongMaterial* material) {
          material->diffuse_map = AddConstant(scene, color);
          material->specular_map = AddConstant(scene, gloss);
          material->shininess_map = AddConstant(scene, Rgb(share));
        });
      }
    }
  }
  LambertMaterial factors, constant;
  factors.albedo = Rgb(0.5, 0.6, 0.7);
  constant.albedo = factors.albedo * color;
  CheckConstantMaps(constant, factors, [&](Scene* scene, LambertMaterial* material) {
    material->albedo_map = AddConstant(scene, color);
  });
}

TEST_CASE("constant maps have the bits of constants: rough matte surfaces and bases") {
  const Rgb color = Held(Rgb(0.9, 0.4, 0.2));
  const Rgb metallic_roughness = Held(Rgb(0, 0.7, 0.6));
  const auto matte = [&](auto factors) {
    factors.albedo = Rgb(0.5, 1, 0.75);
    factors.roughness = 0.6;
    auto constant = factors;
    constant.albedo = factors.albedo * color;
    CheckConstantMaps(constant, factors, [&](Scene* scene, auto* material) {
      material->albedo_map = AddConstant(scene, color);
    });
  };
  matte(OrenNayarMaterial{});
  matte(BurleyMaterial{});
  for (const DiffuseForm form : {DiffuseForm::kOrenNayar, DiffuseForm::kBurley}) {
    for (const bool own : {true, false}) {
      MetallicRoughnessMaterial factors{
          .base_color = Rgb(0.5, 1, 0.75), .metallic = 0.5, .diffuse = form};
      if (own) factors.diffuse_roughness = 0.8;
      MetallicRoughnessMaterial constant = factors;
      constant.base_color = factors.base_color * color;
      constant.metallic = factors.metallic * metallic_roughness.z;
      constant.roughness = factors.roughness * metallic_roughness.y;
      CAPTURE(static_cast<int>(form), own);
      CheckConstantMaps(constant, factors, [&](Scene* scene, MetallicRoughnessMaterial* material) {
        material->base_color_map = AddConstant(scene, color);
        material->metallic_roughness_map = AddConstant(scene, metallic_roughness);
      });
    }
  }
}

TEST_CASE("constant maps have the bits of constants: conductors and dielectrics") {
  const Rgb color = Held(Rgb(0.9, 0.4, 0.2));
  const double share = Held(0.7);
  for (const Compensation compensation :
       {Compensation::kTurquin, Compensation::kKullaConty, Compensation::kNone}) {
    CAPTURE(static_cast<int>(compensation));
    for (const ConductorFresnel fresnel :
         {ConductorFresnel::kExact, ConductorFresnel::kF82Tint, ConductorFresnel::kSchlick}) {
      for (const double roughness : {1.0, 0.1}) {
        ConductorMaterial factors{
            .roughness = roughness, .fresnel = fresnel, .compensation = compensation};
        ConductorMaterial constant = factors;
        constant.roughness = roughness * share;
        CAPTURE(static_cast<int>(fresnel), roughness);
        CheckConstantMaps(constant, factors, [&](Scene* scene, ConductorMaterial* material) {
          material->roughness_map = AddConstant(scene, Rgb(share));
        });
      }
    }
    for (const DielectricFresnel fresnel :
         {DielectricFresnel::kExact, DielectricFresnel::kSchlick}) {
      for (const DiffuseForm form : {DiffuseForm::kLambert, DiffuseForm::kOrenNayar}) {
        DielectricMaterial factors{.base_color = Rgb(0.5, 1, 0.75),
                                   .fresnel = fresnel,
                                   .compensation = compensation,
                                   .diffuse = form};
        if (compensation == Compensation::kNone) {
          factors.diffuse_coupling = DiffuseCoupling::kOneMinusFresnel;
        }
        DielectricMaterial constant = factors;
        constant.base_color = factors.base_color * color;
        // Of the exact curve's albedo, a roughness each has a blend: below.
        const bool rough = fresnel == DielectricFresnel::kSchlick;
        if (rough) constant.roughness = factors.roughness * share;
        CAPTURE(static_cast<int>(fresnel), static_cast<int>(form));
        CheckConstantMaps(constant, factors, [&](Scene* scene, DielectricMaterial* material) {
          material->base_color_map = AddConstant(scene, color);
          if (rough) material->roughness_map = AddConstant(scene, Rgb(share));
        });
      }
    }
  }
}

TEST_CASE("a dielectric's roughness map is within its albedo's error of the constant") {
  for (const Compensation compensation : {Compensation::kTurquin, Compensation::kKullaConty}) {
    for (const double share : {Held(0.9), Held(0.37), Held(0.12)}) {
      Material plain, mapped;
      DielectricMaterial coat{.roughness = share, .compensation = compensation};
      plain.model = coat;
      coat.roughness = 1;
      mapped.model = coat;
      Scene with_map = TexturedSpheres(mapped);
      std::get<DielectricMaterial>(with_map.materials[0].model).roughness_map =
          AddConstant(&with_map, Rgb(share));
      const Image got = AllLayers(with_map), expected = AllLayers(TexturedSpheres(plain));
      const std::vector<float>& a = got.Find("R")->samples;
      const std::vector<float>& b = expected.Find("R")->samples;
      double worst = 0;
      for (size_t i = 0; i < a.size(); ++i) {
        worst = std::max(worst, std::abs(double{a[i]} - b[i]) / std::max(double{b[i]}, 1e-3));
      }
      CAPTURE(static_cast<int>(compensation), share, worst);
      // tests/brdf/albedo_test.cc: 3e-5 of albedo, of a base that gets at least some tenths.
      CHECK(worst <= 3e-4);
    }
  }
}

// A sphere and a smooth mesh under a light of every kind, each in a layer of its own.
Scene UnderEveryLight(const Material& material) {
  Scene scene;
  scene.image.width = 20;
  scene.image.height = 12;
  scene.image.spp = 2;
  scene.camera.position = Vec3d(0, 0, 6);
  scene.camera.fov_y_deg = 30;
  scene.materials = {material};
  scene.spheres = {{{-1.1, 0, 0}, 1, {0}}};
  scene.meshes = {MakeMesh(UvSphere{.center = {1.1, 0.1, 0.2}, .segments = 12, .rings = 6})};
  scene.meshes[0].material = {0};
  const auto picture = std::make_shared<SkyPicture>(SkyPicture{
      4, 2, {1, 2, 3, 0, 1, 0, 5, 4, 3, 1, 1, 1, 0.1f, 0.2f, 0.3f, 2, 1, 0, 1, 0, 0, 7, 7, 7}});
  const auto panel = std::make_shared<Mesh>();
  panel->positions = {{-3, 3, 2}, {-1, 3, 2}, {-2, 4, 3}};
  panel->triangles = {0, 2, 1};
  const auto sky = [](const auto& of) { return EnvironmentLight{.sky = of, .background = false}; };
  const auto add = [&](const char* name, decltype(Light::kind) kind) {
    scene.lights.push_back(Light{.name = name, .kind = std::move(kind)});
  };
  add("ambient", AmbientLight{Rgb(0.1, 0.2, 0.3)});
  add("directional", DirectionalLight{Vec3d(1, -1, -1), Rgb(0.9, 1, 1.1)});
  add("point", PointLight{.position = Vec3d(3, 4, 5), .intensity = Rgb(90)});
  add("spot", SpotLight{.position = Vec3d(-3, 0, 5),
                        .direction_of_travel = Vec3d(3, 0, -5),
                        .intensity = Rgb(50, 50, 60)});
  add("sphere", SphereAreaLight{.center = Vec3d(0, 3, 1), .radius = 1, .visible = false});
  add("rectangle", RectangleAreaLight{.center = Vec3d(-1, 3, 2), .visible = false});
  add("disk", DiskAreaLight{.center = Vec3d(1, 3, 2), .visible = false});
  add("mesh", MeshAreaLight{panel, Rgb(3), true, false});
  add("constant", sky(ConstantSky{Rgb(0.5, 1, 1.5)}));
  add("gradient", sky(GradientSky{}));
  add("quadratic", sky(QuadraticSky{Rgb(1), Vec3d(1, 1, 0), 0.5, 0.4, 0.3}));
  add("picture", sky(PictureSky{picture, Rgb(1)}));
  return scene;
}

// What a map's channels multiply.
struct MappedParameter {
  std::string_view map;
  std::vector<std::string_view> parameters;  // of green and blue where there are two, else of all
};
const std::vector<MappedParameter> kMappedParameters = {
    {"albedo_map", {"albedo"}},
    {"diffuse_map", {"color"}},
    {"specular_map", {"ks", "specular"}},  // of the Phong family; of metallic_roughness
    {"shininess_map", {"shininess"}},
    {"base_color_map", {"base_color"}},
    {"metallic_roughness_map", {"roughness", "metallic"}},
    {"specular_color_map", {"dielectric_f0", "specular_color"}},
    {"roughness_map", {"roughness"}},
    {"emission_map", {"emission"}},
    {"coat_map", {"coat"}},
    {"coat_roughness_map", {"coat_roughness"}},
    {"sheen_color_map", {"sheen_color"}},
    {"sheen_roughness_map", {"sheen_roughness"}},
    {"base_metalness_map", {"base_metalness"}},
    {"specular_roughness_map", {"specular_roughness"}},
    {"fuzz_color_map", {"fuzz_color"}},
    {"fuzz_roughness_map", {"fuzz_roughness"}},
};

// What a layer of a map needs beside its parameter to be there.
constexpr std::pair<std::string_view, std::string_view> kOthers[] = {
    {"coat_roughness_map", "coat"},
    {"sheen_color_map", "sheen_roughness"},
    {"sheen_roughness_map", "sheen_color"},
    {"fuzz_color_map", "fuzz_weight"},
    {"fuzz_roughness_map", "fuzz_weight"}};

// Whether a choice is one of a base or a lobe beside the mapped ones, of which each is walked. What
// the base is does not ask for the lobe; presets set parameters; films have a material of their
// own.
bool IsWalked(const MaterialChoice& choice) {
  return choice.get != nullptr && choice.name != "diffuse" && choice.name != "iridescence_model" &&
         !choice.name.starts_with("film");
}

bool HasFilm(const Material& material) {
  const auto* const metallic = std::get_if<MetallicRoughnessMaterial>(&material.model);
  const auto* const open_pbr = std::get_if<OpenPbrMaterial>(&material.model);
  return (metallic != nullptr && metallic->iridescence > 0) ||
         (open_pbr != nullptr && open_pbr->thin_film_weight > 0);
}

// OpenPBR with everything on, and each option by itself: all of them together are 4 million.
std::vector<Material> WithEachOption(const MaterialModel& model) {
  const Material plain = model.make();
  std::vector<Material> made = {plain};
  auto& whole = std::get<OpenPbrMaterial>(made.emplace_back(plain).model);
  whole.base_metalness = 0.4;
  whole.base_diffuse_roughness = 0.6;
  whole.specular_color = Rgb(0.9, 0.7, 0.5);
  whole.coat_weight = 0.7;
  whole.coat_color = Rgb(0.4, 0.6, 0.9);
  whole.coat_roughness = 0.2;
  whole.fuzz_weight = 0.5;
  for (const MaterialChoice& choice : model.choices) {
    if (!IsWalked(choice)) continue;
    for (size_t option = 0; option < choice.options.size(); ++option) {
      choice.set(made.emplace_back(made[1]), option);
    }
  }
  const Material without_film = made[1];
  auto& film = std::get<OpenPbrMaterial>(made.emplace_back(without_film).model);
  film.base_metalness = 0;
  film.thin_film_weight = 0.8;
  return made;
}

// Every other choice of the model beside those that each map is walked with.
std::vector<Material> WithEveryChoice(const MaterialModel& model) {
  std::vector<Material> made = {model.make()};
  if (std::holds_alternative<OpenPbrMaterial>(made[0].model)) return WithEachOption(model);
  for (const MaterialChoice& choice : model.choices) {
    if (!IsWalked(choice)) continue;
    std::vector<Material> more;
    for (const Material& one : made) {
      for (size_t option = 0; option < choice.options.size(); ++option) {
        more.push_back(one);
        choice.set(more.back(), option);
      }
    }
    made = std::move(more);
  }
  if (std::holds_alternative<MetallicRoughnessMaterial>(made[0].model)) {
    const Material without_film = made[0];
    auto& film = std::get<MetallicRoughnessMaterial>(made.emplace_back(without_film).model);
    film.iridescence = 0.8;
    film.iridescence_model = ThinFilmForm::kSpectral;
  }
  return made;
}

TEST_CASE("every map of every model is the constant, from code 0 to 255, under every light") {
  size_t walked = 0;
  for (const MaterialModel& model : MaterialModels()) {
    const std::vector<Material> all = WithEveryChoice(model);
    for (const Material& factors : all) {
      // Of OpenPBR's options one code each will do: they are no functions of a map's number.
      const bool option =
          std::holds_alternative<OpenPbrMaterial>(factors.model) && &factors - all.data() > 1;
      const std::vector<int> codes = option ? std::vector{128} : std::vector{0, 1, 128, 255};
      for (const MaterialMap& map : model.maps) {
        if (map.name == "opacity_map") continue;     // cuts holes: tests/render/cut_outs_test.cc
        if (map.name == "anisotropy_map") continue;  // has a direction, too: below
        if (map.name.starts_with("iridescence")) continue;  // tests/render/thin_film_test.cc
        const auto entry =
            std::find_if(kMappedParameters.begin(), kMappedParameters.end(),
                         [&](const MappedParameter& known) { return known.map == map.name; });
        REQUIRE(entry != kMappedParameters.end());
        for (const int code : codes) {
          const double value = Held(code / 255.0);
          Material constant = factors, mapped = factors;
          // Layers whose other parameter is 0 are none.
          for (const auto& [of, other] : kOthers) {
            if (map.name != of) continue;
            FindParameter(model, other)->set(mapped, Rgb(0.5));
            FindParameter(model, other)->set(constant, Rgb(0.5));
          }
          for (const std::string_view name : entry->parameters) {
            const MaterialParameter* const parameter = FindParameter(model, name);
            if (parameter == nullptr) continue;
            // What is multiplied is 1 where it may be, so that codes are the numbers themselves.
            const double whole = parameter->range.max <= 1 ? parameter->range.max : 60;
            parameter->set(mapped, Rgb(whole));
            parameter->set(constant, Rgb(whole * value));
          }
          // The albedo of an exact dielectric, and below a film, is a blend of those at some
          // roughnesses. A metal's film has no map.
          const bool blended =
              map.name == "specular_roughness_map" ||
              (HasFilm(factors) &&
               (map.name == "metallic_roughness_map" || map.name == "specular_color_map")) ||
              (model.name == "dielectric" && map.name == "roughness_map" &&
               std::get<DielectricMaterial>(factors.model).fresnel == DielectricFresnel::kExact);
          // Fuzz widens Adobe's coat by its own numbers, without maps.
          const auto* const open_pbr = std::get_if<OpenPbrMaterial>(&factors.model);
          const bool widens_coat = open_pbr != nullptr && map.name.starts_with("fuzz_") &&
                                   open_pbr->options.coat_roughening == CoatRoughening::kAdobe;
          if (blended || widens_coat) continue;
          Scene scene = UnderEveryLight(mapped);
          map.set(scene.materials[0], AddConstant(&scene, Rgb(value)));
          CAPTURE(model.name, map.name, code, walked);
          CheckSameBits(AllLayers(scene), AllLayers(UnderEveryLight(constant)));
          ++walked;
        }
      }
    }
  }
  CHECK(walked > 400);
}

// Holds a roughness map to the constant, for a model whose albedo of a map's roughness is a blend
// of this error.
template <class Model>
void CheckRoughnessMap(const Model& model, double Model::*roughness, TextureId Model::*map,
                       float error = 3e-4f) {
  for (const int code : {0, 1, 128, 255}) {
    const double value = Held(code / 255.0);
    Material constant, mapped;
    Model of_value = model, of_one = model;
    of_value.*roughness = value;
    of_one.*roughness = 1;
    constant.model = of_value;
    mapped.model = of_one;
    Scene scene = UnderEveryLight(mapped);
    std::get<Model>(scene.materials[0].model).*map = AddConstant(&scene, Rgb(value));
    const Image got = AllLayers(scene), expected = AllLayers(UnderEveryLight(constant));
    for (size_t c = 0; c < got.channels.size(); ++c) {
      CAPTURE(code, got.channels[c].name);
      const auto& a = got.channels[c].samples;
      const auto& b = expected.channels[c].samples;
      // The albedo's error, as above: of what a base of .5 gives back.
      for (size_t i = 0; i < a.size(); ++i) {
        if (std::abs(a[i] - b[i]) > error * std::max(b[i], 1.0f)) {
          CAPTURE(i, a[i], b[i]);
          FAIL("differs");
        }
      }
    }
  }
}

TEST_CASE("an anisotropy map is the constant of its strength, along its direction") {
  for (const Compensation compensation :
       {Compensation::kTurquin, Compensation::kKullaConty, Compensation::kNone}) {
    for (const double strength : {Held(1.0 / 255), Held(0.3), 1.0}) {
      Material constant, mapped;
      MetallicRoughnessMaterial brushed{.metallic = 0.5,
                                        .roughness = 0.4,
                                        .anisotropy = strength,
                                        .anisotropy_rotation_deg = 30,
                                        .compensation = compensation};
      constant.model = brushed;
      brushed.anisotropy = 1;
      brushed.anisotropy_rotation_deg = 120;  // a quarter more than the map takes back
      mapped.model = brushed;
      Scene scene = TexturedSpheres(mapped);
      std::get<MetallicRoughnessMaterial>(scene.materials[0].model).anisotropy_map =
          AddConstant(&scene, Rgb(0.5, 0, strength));
      const Image got = AllLayers(scene), expected = AllLayers(TexturedSpheres(constant));
      for (size_t c = 0; c < got.channels.size(); ++c) {
        CAPTURE(static_cast<int>(compensation), strength, got.channels[c].name);
        const auto& a = got.channels[c].samples;
        const auto& b = expected.channels[c].samples;
        // Both albedos are polynomials of one table, in float and in double.
        for (size_t i = 0; i < a.size(); ++i) {
          if (std::abs(a[i] - b[i]) > 1e-4f * std::max(b[i], 1.0f)) {
            CAPTURE(i, a[i], b[i]);
            FAIL("differs");
          }
        }
      }
    }
  }
}

TEST_CASE("an exact dielectric's roughness map is the constant mirror and the constant's lobe") {
  CheckRoughnessMap(DielectricMaterial{.base_color = Rgb(0.5)}, &DielectricMaterial::roughness,
                    &DielectricMaterial::roughness_map);
  for (const double coat_weight : {0.0, 0.6}) {
    CAPTURE(coat_weight);
    CheckRoughnessMap(OpenPbrMaterial{.base_color = Rgb(0.5),
                                      .coat_weight = coat_weight,
                                      .coat_color = Rgb(0.3, 0.6, 0.9),
                                      .coat_roughness = 0.3},
                      &OpenPbrMaterial::specular_roughness,
                      &OpenPbrMaterial::specular_roughness_map);
  }
}

TEST_CASE("the roughness map of a dielectric below a film is the constant") {
  // The error of brdf/table_albedo.h.
  CheckRoughnessMap(OpenPbrMaterial{.base_color = Rgb(0.5), .thin_film_weight = 1},
                    &OpenPbrMaterial::specular_roughness, &OpenPbrMaterial::specular_roughness_map,
                    1e-3f);
}

TEST_CASE("a level normal map, a flat bump map and a constant emission map change no bit") {
  ForEachTarget([&](Target) {
    Material plain{.emission = Rgb(0.2, 0.4, 0.8) * Held(0.3),
                   .model = MetallicRoughnessMaterial{.roughness = 0.05}};
    Scene scene = TexturedSpheres(plain);
    Material& material = scene.materials[0];
    material.emission = Rgb(0.2, 0.4, 0.8);
    material.emission_map = AddConstant(&scene, Rgb(Held(0.3)));
    material.normal_map.texture = AddConstant(&scene, Rgb(128.0 / 255, 128.0 / 255, 1));
    material.bump_map.texture = AddConstant(&scene, Rgb(0.4));
    CheckSameBits(AllLayers(scene), AllLayers(TexturedSpheres(plain)));
    // Neither does one of length 0, which points nowhere.
    material.normal_map.texture =
        AddConstant(&scene, Rgb(double{128.0f / 255}, double{128.0f / 255}, double{128.0f / 255}));
    CheckSameBits(AllLayers(scene), AllLayers(TexturedSpheres(plain)));
  });
}

}  // namespace
}  // namespace nacre
