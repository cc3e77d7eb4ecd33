// SPDX-License-Identifier: Apache-2.0
// tests/render/textures_test.cc: whole pictures with textures: normals, bumps, coordinates.
#include <algorithm>
#include <cmath>
#include <functional>

#include "targets.h"
#include "textured_scenes.h"

namespace nacre {
namespace {

// The normals that a picture of 16x16 pixels of a unit sphere has at its hits.
Scene OneSphere(const Material& material) {
  Scene scene;
  scene.image.width = scene.image.height = 16;
  scene.image.spp = 1;
  scene.camera.position = Vec3d(0, 0, 4);
  scene.materials = {material};
  scene.spheres = {{{0, 0, 0}, 1, {0}}};
  Light sun;
  sun.name = "sun";
  sun.kind = DirectionalLight{Vec3d(-1, -0.3, -1), Rgb(1)};
  scene.lights = {sun};
  return scene;
}

struct HitNormal {
  Vec3d plain, turned;
};
std::vector<HitNormal> Normals(const Scene& plain, const Scene& turned) {
  const Image a = AllLayers(plain), b = AllLayers(turned);
  std::vector<HitNormal> normals;
  const auto at = [](const Image& image, size_t i) {
    const auto value = [&](const char* name) { return double{image.Find(name)->samples[i]}; };
    return Vec3d(value("N.X"), value("N.Y"), value("N.Z"));
  };
  for (size_t i = 0; i < a.data.pixel_count(); ++i) {
    if (a.Find("A")->samples[i] > 0) normals.push_back({at(a, i), at(b, i)});
  }
  return normals;
}

TEST_CASE("the literal convention tilts a level map by 0.318 degrees") {
  const Scene plain = OneSphere(Material{.model = LambertMaterial{}});
  Scene scene = plain;
  NormalMap& map = scene.materials[0].normal_map;
  map.texture = AddConstant(&scene, Rgb(128.0 / 255, 128.0 / 255, 1));
  map.convention = NormalMap::Convention::kLiteral;
  // 2 * 128/255 - 1 = 1/255 in x and in y, against 1.
  const double expected = std::atan(std::sqrt(2.0) / 255);
  CHECK(expected * 180 / M_PI == Approx(0.3178).epsilon(1e-3));
  const std::vector<HitNormal> normals = Normals(plain, scene);
  REQUIRE(normals.size() > 20);
  for (const HitNormal& n : normals) {
    // Normals of floats: angles to 1e-7.
    CHECK(std::asin(n.plain.cross(n.turned).length()) == Approx(expected).margin(3e-7));
    CHECK(n.turned.length() == Approx(1).margin(2.4e-7));  // 4 u
  }
}

TEST_CASE("a normal map's x leans along growing u and its y along growing v, mirrored or not") {
  const Scene plain = OneSphere(Material{.model = LambertMaterial{}});
  const auto lean = [&](const Rgb& texel, const Vec2d& scale) {
    Scene scene = plain;
    const TextureId id = AddConstant(&scene, texel);
    scene.textures[id.index].scale = scale;
    scene.materials[0].normal_map.texture = id;
    Vec3d sum(0, 0, 0);
    for (const HitNormal& n : Normals(plain, scene)) sum += n.turned - n.plain;
    return sum;
  };
  // Seen from +z, u grows to +x and v to +y.
  const Rgb along_u(1, 128.0 / 255, 1), along_v(128.0 / 255, 1, 1);
  CHECK(lean(along_u, {1, 1}).x > 1);
  CHECK(lean(along_v, {1, 1}).y > 1);
  CHECK(lean(along_u, {-1, 1}).x < -1);  // u grows to -x
  CHECK(lean(along_v, {-1, 1}).y > 1);
  CHECK(lean(along_u, {1, -1}).x > 1);
  CHECK(lean(along_v, {1, -1}).y < -1);
}

TEST_CASE("a turned normal stays above its surface, and light from below stays out") {
  Material material{.model = LambertMaterial{.albedo = Rgb(1)}};
  Scene scene = OneSphere(material);
  scene.materials[0].normal_map.texture = AddConstant(&scene, Rgb(1, 128.0 / 255, 0.2));
  const Scene plain = OneSphere(material);
  size_t dark = 0;
  for (const HitNormal& n : Normals(plain, scene)) CHECK(n.plain.dot(n.turned) >= -1e-6);
  const Image a = AllLayers(plain), b = AllLayers(scene);
  for (size_t i = 0; i < a.data.pixel_count(); ++i) {
    if (!(a.Find("A")->samples[i] > 0) || a.Find("R")->samples[i] > 0) continue;
    ++dark;
    CHECK(b.Find("R")->samples[i] == 0);
  }
  CHECK(dark > 10);
}

TEST_CASE("bumps turn the normal as the displaced surface has it") {
  // h = distance (1 + sin(2 pi u)) / 2 on the unit sphere: P' = (1 + h) P has a normal along
  // P (1 + h) - grad h, with grad h = dh/du grad u. For small h: P - grad h.
  const Scene plain = OneSphere(Material{.model = LambertMaterial{}});
  const int width = 2048;
  double last = 0;
  for (const double distance : {0.08, 0.02}) {
    Scene scene = plain;
    const TextureId id = AddTexture(&scene, width, 4, [&](int x, int) {
      return Rgb(0.5 + 0.5 * std::sin(2 * M_PI * (x + 0.5) / width));
    });
    scene.textures[id.index].sampling.filter = TextureFilter::kBilinear;
    scene.materials[0].bump_map = {id, distance};
    double worst = 0;
    const std::vector<HitNormal> normals = Normals(plain, scene);
    for (const HitNormal& n : normals) {
      // Longitude from -z through -x: u = phi / 2 pi, and its gradient is 1 / sin(theta).
      const Vec3d p = n.plain;
      const double phi = std::atan2(-p.x, -p.z);
      const double ring = std::sqrt(p.x * p.x + p.z * p.z);
      const double h = distance * (0.5 + 0.5 * std::sin(phi));
      const Vec3d along = Vec3d(p.z, 0, -p.x) / ring;  // of growing phi
      const Vec3d gradient = along * (distance * 0.5 * std::cos(phi) / ring);
      const Vec3d displaced = (p * (1 + h) - gradient).normalized();
      worst = std::max(worst, displaced.cross(n.turned).length());
    }
    // The neglected term is h times the tilt: second order.
    if (last > 0) CHECK(worst < last / 12);
    last = worst;
  }
  CHECK(last < 0.02 * 0.02);
}

TEST_CASE("nothing shows at the seam, at any level of detail") {
  // A ramp in v alone: u must not count, and the seam of u, which faces the camera, not show.
  Scene scene = OneSphere(Material{.emission = Rgb(1), .model = LambertMaterial{.albedo = Rgb(0)}});
  scene.camera.position = Vec3d(0, 0, -4);  // the seam is at -z
  scene.image.width = scene.image.height = 33;
  const TextureId id = AddTexture(&scene, 512, 256, [&](int x, int) {
    return Rgb(0.5 + 0.4 * std::sin(2 * M_PI * (x + 0.5) / 512));
  });
  scene.materials[0].emission_map = id;
  const Image image = AllLayers(scene);
  const auto& red = image.Find("R")->samples;
  // Along the middle row the value is that of the sine within what filtering takes from it; a level
  // chosen across the seam would be its mean, 0.5, there.
  for (size_t x = 12; x < 21; ++x) {
    const auto& px = image.Find("N.X")->samples;
    const auto& pz = image.Find("N.Z")->samples;
    const size_t i = 16 * 33 + x;
    const double phi = std::atan2(-double{px[i]}, -double{pz[i]});
    CHECK(double{red[i]} == Approx(0.5 + 0.4 * std::sin(phi)).margin(2e-3));
  }
}

// A square of two triangles across the view, with texture coordinates.
Scene Square(MappingKind mapping) {
  Scene scene;
  scene.image.width = scene.image.height = 16;
  scene.image.spp = 1;
  scene.camera.projection = Projection::kOrthographic;
  scene.camera.height = 2;
  scene.camera.position = Vec3d(0, 0, 5);
  Mesh mesh{.positions = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}},
            .uvs = {{0, 0}, {1, 0}, {1, 1}, {0, 1}},
            .triangles = {0, 1, 2, 0, 2, 3},
            .material = {0}};
  scene.meshes = {mesh};
  Material material{.emission = Rgb(1)};
  scene.materials = {material};
  const TextureId id = AddTexture(
      &scene, 16, 16, [](int x, int y) { return Rgb(x / 16.0, y / 16.0, (x ^ y) / 16.0); });
  scene.textures[id.index].mapping = mapping;
  scene.textures[id.index].axis = Vec3d(0, 0, 1);
  scene.textures[id.index].sampling = {TextureFilter::kBilinear, Wrap::kRepeat, Wrap::kRepeat};
  scene.materials[0].emission_map = id;
  return scene;
}

TEST_CASE("an image on a square is that image, from its lower left corner") {
  for (const MappingKind mapping : {MappingKind::kUv, MappingKind::kPlanar}) {
    const Image image = AllLayers(Square(mapping));
    for (size_t y = 0; y < 16; ++y) {
      for (size_t x = 0; x < 16; ++x) {
        const size_t i = y * 16 + x;
        // Coordinates in double: the centre of a texel to 1e-14 of a texel.
        CHECK(double{image.Find("R")->samples[i]} == Approx(static_cast<double>(x) / 16));
        CHECK(double{image.Find("G")->samples[i]} == Approx(static_cast<double>(15 - y) / 16));
      }
    }
  }
}

TEST_CASE("texture coordinates are scaled, turned and moved, in this order") {
  Scene scene = Square(MappingKind::kUv);
  scene.textures[0].scale = Vec2d(1, 0.5);
  scene.textures[0].uv_rotate_deg = 90;  // (u, v) becomes (-v, u)
  scene.textures[0].offset = Vec2d(0.75, 0);
  scene.textures[0].sampling.filter = TextureFilter::kNearest;
  const Image image = AllLayers(scene);
  const auto at = [&](size_t x, size_t y, const char* name) {
    return 16 * double{image.Find(name)->samples[(15 - y) * 16 + x]};
  };
  // u' = 0.75 - v / 2, v' = u at the centres of pixels.
  CHECK(at(3, 0, "R") == std::floor(16 * (0.75 - 0.5 / 32)));
  CHECK(at(3, 0, "G") == 3);
  CHECK(at(9, 14, "R") == std::floor(16 * (0.75 - 14.5 / 32)));
  CHECK(at(9, 14, "G") == 9);
}

TEST_CASE("seen from behind, a normal map is the front turned round") {
  Scene plain = Square(MappingKind::kUv);
  plain.camera.position = Vec3d(0, 0, -5);
  plain.materials[0].emission_map = {};
  for (const bool bump : {false, true}) {
    Scene scene = plain;
    TextureId id;
    if (bump) {  // rises with u: the front's normal leans to -u
      id = AddTexture(&scene, 16, 1, [](int x, int) { return Rgb(x / 16.0); });
      scene.textures[id.index].sampling.wrap_u = Wrap::kClamp;
      scene.materials[0].bump_map = {id, 0.5};
    } else {  // the front's normal leans to +u
      id = AddConstant(&scene, Rgb(1, 128.0 / 255, 1));
      scene.materials[0].normal_map.texture = id;
    }
    scene.textures[id.index].mapping = MappingKind::kUv;
    const Image image = AllLayers(scene);
    const size_t middle = 8 * 16 + 8;
    CHECK(image.Find("N.Z")->samples[middle] < 0);
    CHECK((bump ? 1 : -1) * image.Find("N.X")->samples[middle] > 0.1f);
    scene.camera.position = Vec3d(0, 0, 5);
    const Image front = AllLayers(scene);
    CHECK((bump ? -1 : 1) * front.Find("N.X")->samples[middle] > 0.1f);
  }
}

TEST_CASE("a far surface shows its texture's mean, in both projections") {
  for (const Projection projection : {Projection::kOrthographic, Projection::kPerspective}) {
    Scene scene = Square(MappingKind::kUv);
    scene.textures[0].scale = Vec2d(500, 500);
    scene.textures[0].sampling.filter = TextureFilter::kTrilinear;
    scene.camera.projection = projection;
    // Perspective: the same part of the square, from so far that depth counts.
    scene.camera.position = Vec3d(0, 0, 50);
    scene.camera.fov_y_deg = 2 * std::atan(1.0 / 50) * 180 / M_PI;
    const Image image = AllLayers(scene);
    for (const float red : image.Find("R")->samples) {
      CHECK(double{red} == Approx(7.5 / 16).epsilon(1e-6));
    }
  }
}

TEST_CASE("scenes with textures have the same bits by tiles, crops, layers and threads") {
  Material material;
  MetallicRoughnessMaterial metallic;
  material.model = metallic;
  Scene scene = TexturedSpheres(material);
  const auto noise = [](int x, int y) {
    return Rgb((x * 7 + y * 3) % 16 / 16.0, (x * 5 + y) % 16 / 16.0, (x + y * 11) % 16 / 16.0);
  };
  const TextureId id = AddTexture(&scene, 32, 16, noise);
  auto& model = std::get<MetallicRoughnessMaterial>(scene.materials[0].model);
  model.base_color_map = model.metallic_roughness_map = id;
  scene.materials[0].normal_map = {id, 0.3};
  scene.materials[0].bump_map = {id, 0.02};
  // Others between them, so that runs begin anywhere.
  scene.materials.push_back(Material{.model = LambertMaterial{}});
  scene.spheres[1].material = {1};
  RenderSettings settings{.threads = 1};
  const Image whole = RenderImage(scene, settings);
  settings.threads = 3;
  settings.tile_size = 5;
  settings.layers = {"all"};
  settings.intersector = IntersectorChoice::kEmbree;
  const Image other_way = RenderImage(scene, settings);
  for (size_t c = 0; c < whole.channels.size(); ++c) {
    CHECK(whole.channels[c].samples == other_way.channels[c].samples);
  }
  settings.region = {11, 5, 30, 29};
  settings.general_path = true;
  const Image part = RenderImage(scene, settings);
  for (int y = 5; y < 29; ++y) {
    for (int x = 11; x < 30; ++x) {
      const auto from = static_cast<size_t>((y - 5) * 19 + x - 11);
      const auto to = static_cast<size_t>(y * 48 + x);
      REQUIRE(part.Find("R")->samples[from] == whole.Find("R")->samples[to]);
    }
  }
}

// A wall of bands of the materials, each from the top to the bottom and 32 pixels wide, so that
// every tile has hits of all of them at the same places of its batch.
Scene BandedWall(const std::vector<decltype(Material::model)>& models) {
  Scene scene = Square(MappingKind::kPlanar);
  scene.image.width = static_cast<int>(32 * models.size());
  scene.image.height = 64;
  scene.camera.height = 64.0 / 32;
  scene.meshes.clear();
  const double left = -static_cast<double>(models.size()) / 2;
  for (size_t i = 0; i < models.size(); ++i) {
    Mesh band;
    const double x = left + static_cast<double>(i);
    band.positions = {{x, -2, 0}, {x + 1, -2, 0}, {x + 1, 2, 0}, {x, 2, 0}};
    band.triangles = {0, 1, 2, 0, 2, 3};
    band.material = {static_cast<uint32_t>(i)};
    scene.meshes.push_back(band);
  }
  scene.materials.resize(models.size());
  for (size_t i = 0; i < models.size(); ++i) {
    scene.materials[i] = {};
    scene.materials[i].model = models[i];
  }
  return scene;
}

// The products of maps with a light's colour are kept from light sample to light sample: those of
// the batch before, of another material, or of another light would be taken for them.
TEST_CASE("what maps make of a light is of the hit's own texels, material and light") {
  const TextureId map{0};  // Square's
  const LambertMaterial lambert{.albedo = Rgb(0.9), .albedo_map = map};
  const LambertMaterial darker{.albedo = Rgb(0.4), .albedo_map = map};
  MetallicRoughnessMaterial metallic{.base_color_map = map};
  PhongMaterial phong{.diffuse_map = map};
  DielectricMaterial coat{.base_color_map = map};
  const Light red = {.name = "red",
                     .kind = DirectionalLight{Vec3d(-0.3, -0.2, -1), Rgb(1, 0.25, 0.125)}};
  const Light blue = {.name = "blue",
                      .kind = DirectionalLight{Vec3d(-0.3, -0.2, -1), Rgb(0.125, 0.25, 1)}};
  const Light lamp = {.name = "lamp",
                      .kind = RectangleAreaLight{.center = Vec3d(0, 0, 4),
                                                 .facing = Vec3d(0, 0, -1),
                                                 .up = Vec3d(0, 1, 0),
                                                 .radiance = Rgb(5, 4, 3)}};
  const std::vector<std::vector<decltype(Material::model)>> walls = {
      {lambert}, {metallic}, {phong}, {coat}, {lambert, darker}, {metallic, phong, coat}};
  for (const auto& models : walls) {
    for (const std::vector<Light>& lights :
         {std::vector<Light>{red}, std::vector<Light>{lamp}, std::vector<Light>{red, blue}}) {
      Scene scene = BandedWall(models);
      scene.lights = lights;
      CAPTURE(models.size(), models[0].index(), lights[0].name, lights.size());
      RenderSettings settings{.threads = 1};
      const Image whole = RenderImage(scene, settings);
      // A pixel alone is a batch that nothing came before.
      for (int y = 3; y < 64; y += 15) {
        for (int x = 5; x < scene.image.width; x += 11) {
          settings.region = {x, y, x + 1, y + 1};
          const Image alone = RenderImage(scene, settings);
          const auto at = static_cast<size_t>(y * scene.image.width + x);
          for (const char* channel : {"R", "G", "B"}) {
            CHECK(whole.Find(channel)->samples[at] == alone.Find(channel)->samples[0]);
          }
        }
      }
      settings.region = {};
      if (lights.size() < 2) continue;
      scene.lights = {red};
      const Image by_red = RenderImage(scene, settings);
      scene.lights = {blue};
      const Image by_blue = RenderImage(scene, settings);
      for (const char* channel : {"R", "G", "B"}) {
        for (size_t i = 0; i < whole.data.pixel_count(); ++i) {
          const double sum =
              double{by_red.Find(channel)->samples[i]} + by_blue.Find(channel)->samples[i];
          // Each light's diffuse and specular part are rounded after two products, and their sums.
          REQUIRE(std::abs(whole.Find(channel)->samples[i] - sum) <= 8 * 0x1p-24 * sum);
        }
      }
    }
  }
}

}  // namespace
}  // namespace nacre
