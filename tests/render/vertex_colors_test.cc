// SPDX-License-Identifier: Apache-2.0
// tests/render/vertex_colors_test.cc: meshes that bring colours and second texture coordinates.
#include <cmath>
#include <memory>

#include "pictures.h"
#include "render/render.h"

namespace nacre {
namespace {

// A square that fills the picture, lit evenly.
Scene Square(decltype(Material::model) model) {
  Scene scene;
  Material& material = scene.materials.emplace_back();
  material.model = std::move(model);
  Mesh& mesh = scene.meshes.emplace_back();
  mesh.positions = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
  mesh.uvs = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  mesh.triangles = {0, 1, 2, 0, 2, 3};
  mesh.material = {0};
  scene.camera.projection = Projection::kOrthographic;
  scene.camera.position = Vec3d(0, 0, 5);
  scene.camera.height = 2;
  scene.image.width = scene.image.height = 32;
  scene.image.spp = 1;
  Light& light = scene.lights.emplace_back();
  light.name = "sun";
  light.kind = DirectionalLight{.direction_of_travel = {0.5, 0, -1}, .irradiance = Rgb(3, 2, 1)};
  return scene;
}

Image Render(const Scene& scene) {
  return RenderImage(scene, {.layers = {"P", "albedo", "emission", "diffuse"}});
}

// Affine over the square, and so between its corners: red along x, green along y, blue of neither.
Vec3f ColorAt(const Vec3d& p) { return Vec3f(Vec3d((p.x + 1) / 2, (p.y + 3) / 4, 0.25)); }

void GiveColors(Scene* scene, VertexColors use) {
  Mesh& mesh = scene->meshes[0];
  mesh.colors.clear();
  for (const Vec3d& position : mesh.positions) mesh.colors.push_back(ColorAt(position));
  scene->materials[0].vertex_colors = use;
}

void CheckColored(const Image& image, const Image& white, const char* const (&channels)[3]) {
  const auto at = [](const Image& from, const char* channel, size_t i) {
    return double{from.Find(channel)->samples[i]};
  };
  size_t seen = 0;
  for (size_t i = 0; i < image.data.pixel_count(); ++i) {
    if (at(image, "A", i) < 1) continue;
    ++seen;
    const Vec3f color = ColorAt({at(image, "P.X", i), at(image, "P.Y", i), 0});
    for (int c = 0; c < 3; ++c) {
      const double expected = at(white, channels[c], i) * double{color[c]};
      // Colours and products in float, a layer of half floats' input aside.
      CHECK(std::abs(at(image, channels[c], i) - expected) <= 1e-6 * (1 + expected));
    }
  }
  CHECK(seen == 32 * 32);
}

TEST_CASE("colours of vertices multiply albedo and base colour") {
  for (const decltype(Material::model)& model :
       {decltype(Material::model)(LambertMaterial{Rgb(1)}),
        decltype(Material::model)(PhongMaterial{.color = Rgb(1)})}) {
    Scene scene = Square(model);
    const Image white = Render(scene);
    GiveColors(&scene, VertexColors::kBase);
    CheckColored(Render(scene), white, {"diffuse.R", "diffuse.G", "diffuse.B"});
    CheckColored(Render(scene), white, {"albedo.R", "albedo.G", "albedo.B"});
  }
}

TEST_CASE("colours of vertices multiply what is shown without light") {
  Scene scene = Square(LambertMaterial{Rgb(0)});
  scene.materials[0].emission = Rgb(1, 0.5, 4);
  const Image white = Render(scene);
  GiveColors(&scene, VertexColors::kEmission);
  CheckColored(Render(scene), white, {"R", "G", "B"});
}

TEST_CASE("white vertices, and colours that no material asks for, change no bit") {
  const MetallicRoughnessMaterial metal{.base_color = Rgb(0.9, 0.5, 0.2), .metallic = 0.5};
  Scene scene = Square(metal);
  const Image plain = Render(scene);
  scene.materials[0].vertex_colors = VertexColors::kBase;
  CHECK(SameBits(Render(scene), plain));  // the mesh has none
  scene.meshes[0].colors.assign(4, Vec3f(1));
  CHECK(SameBits(Render(scene), plain));
  GiveColors(&scene, VertexColors::kNone);
  CHECK(SameBits(Render(scene), plain));
  GiveColors(&scene, VertexColors::kBase);
  CHECK_FALSE(SameBits(Render(scene), plain));
}

TEST_CASE("textures are on the coordinates that they ask for") {
  Scene scene = Square(LambertMaterial{});
  std::vector<float> values;
  for (int i = 0; i < 16; ++i) {
    for (const double value : {0.05 * i, 1 - 0.05 * i, 0.3}) {
      values.push_back(static_cast<float>(value));
    }
  }
  auto chain = std::make_shared<const MipChain>(MakeMipChain(4, 4, 3, std::move(values)));
  scene.images.push_back({"image", std::move(chain), 0.5f});
  scene.textures.emplace_back().image = {0};
  scene.materials[0].model = LambertMaterial{.albedo = Rgb(1), .albedo_map = {0}};
  const Image first = Render(scene);
  Mesh& mesh = scene.meshes[0];
  mesh.second_uvs = mesh.uvs;
  mesh.uvs.assign(4, Vec2d(0.125, 0.125));  // all of it is one texel
  CHECK_FALSE(SameBits(Render(scene), first));
  scene.textures[0].second_uvs = true;
  CHECK(SameBits(Render(scene), first));
}

TEST_CASE("what is no metal reflects what it is told to at normal incidence") {
  // As a dielectric of that index by Schlick's curve, with a map or without.
  const double ior = 1.8, f0 = (ior - 1) * (ior - 1) / ((ior + 1) * (ior + 1));
  Scene scene = Square(DielectricMaterial{.base_color = Rgb(0.5),
                                          .ior = ior,
                                          .roughness = 0.6,
                                          .fresnel = DielectricFresnel::kSchlick});
  const Image coat = Render(scene);
  MetallicRoughnessMaterial plastic{.base_color = Rgb(0.5), .roughness = 0.6};
  plastic.dielectric_f0 = Rgb(f0);
  const auto check_same = [&](const Image& image) {
    for (size_t i = 0; i < coat.data.pixel_count(); ++i) {
      const double expected = coat.Find("R")->samples[i];
      CHECK(std::abs(double{image.Find("R")->samples[i]} - expected) <= 1e-6 * expected);
    }
  };
  scene.materials[0].model = plastic;
  const Image plain = Render(scene);
  check_same(plain);
  scene.images.push_back(
      {"white", std::make_shared<const MipChain>(MakeMipChain(1, 1, 3, {1, 1, 1})), 0.5f});
  scene.textures.emplace_back().image = {0};
  plastic.base_color_map = {0};
  scene.materials[0].model = plastic;
  CHECK(SameBits(Render(scene), plain));
  plastic.dielectric_f0 = Rgb(0.04);
  scene.materials[0].model = plastic;
  CHECK_FALSE(SameBits(Render(scene), plain));
}

}  // namespace
}  // namespace nacre
