// SPDX-License-Identifier: Apache-2.0
// What is interpolated across the triangles of a mesh, and where its shadow rays start.
#include <array>
#include <cmath>
#include <cstring>
#include <map>
#include <stdexcept>
#include <string>
#include <string_view>

#include "pictures.h"
#include "render/render.h"
#include "scene/mesh.h"
#include "scene/sphere_mesh.h"
#include "targets.h"
#include "textured_scenes.h"

namespace nacre {
namespace {

constexpr double kUnit = 0x1p-24;

const std::array<Interpolation, 4> kInterpolations = {
    Interpolation::kPhong, Interpolation::kGouraud, Interpolation::kFlat, Interpolation::kFaceted};

Light MakeSun(const Vec3d& direction_of_travel) {
  Light sun;
  sun.name = "sun";
  sun.kind = DirectionalLight{direction_of_travel, {2, 1.5, 1}};
  return sun;
}

Light MakeLamp() {
  Light lamp;
  lamp.name = "lamp";
  lamp.kind = PointLight{.position = {3, 4, 5}, .intensity = {60, 50, 40}};
  return lamp;
}

Material MakeGlossy() {
  Material material{
      .name = "glossy",
      .emission = {0.01, 0.02, 0.03},
      .model = MetallicRoughnessMaterial{.base_color = {0.7, 0.5, 0.3}, .roughness = 0.4}};
  return material;
}

// A coarse sphere; each pixel is the one hit at its centre.
Scene MakeSphereScene(Interpolation interpolation, int subdivisions) {
  Scene scene;
  scene.camera.position = {1, 2, 9};
  scene.image.width = 61;
  scene.image.height = 57;
  scene.image.spp = 1;
  scene.image.filter = {FilterKind::kBox, 1};
  scene.materials = {MakeGlossy()};
  scene.meshes = {MakeMesh(Icosphere{.radius = 2, .subdivisions = subdivisions})};
  scene.meshes[0].material = {0};
  scene.meshes[0].interpolation = interpolation;
  scene.lights = {MakeSun({-1, -1, -0.5}), MakeLamp()};
  return scene;
}

RenderSettings Settings(std::vector<std::string> layers = {}, int threads = 2) {
  return RenderSettings{.threads = threads, .layers = std::move(layers)};
}

const std::vector<float>& Samples(const Image& image, std::string_view channel) {
  for (const Channel& c : image.channels) {
    if (c.name == channel) return c.samples;
  }
  throw std::runtime_error(std::string(channel));
}

std::array<float, 3> Triple(const Image& image, const std::array<const char*, 3>& names, size_t i) {
  return {Samples(image, names[0])[i], Samples(image, names[1])[i], Samples(image, names[2])[i]};
}
constexpr std::array<const char*, 3> kColor = {"R", "G", "B"};
constexpr std::array<const char*, 3> kNormal = {"N.X", "N.Y", "N.Z"};
constexpr std::array<const char*, 3> kPosition = {"P.X", "P.Y", "P.Z"};

Vec3d Vector(const std::array<float, 3>& v) { return {v[0], v[1], v[2]}; }

TEST_CASE("a flat triangle has one colour, that of its centroid") {
  const Scene scene = MakeSphereScene(Interpolation::kFlat, 1);
  const Mesh& mesh = scene.meshes[0];
  const Image image = RenderImage(scene, Settings({"N"}));
  std::map<std::array<float, 3>, std::array<float, 3>> colors;  // by the face's normal
  for (size_t i = 0; i < Samples(image, "A").size(); ++i) {
    if (Samples(image, "A")[i] == 0) continue;
    const auto color = Triple(image, kColor, i);
    const auto entry = colors.try_emplace(Triple(image, kNormal, i), color).first;
    CHECK(entry->second == color);
  }
  CHECK(colors.size() > 25);  // of 80, about half face the camera
  // The same triangle shaded point by point, through a camera that looks at the centroid.
  int compared = 0;
  for (const auto& [normal, color] : colors) {
    for (size_t t = 0; t < mesh.triangles.size() / 3; ++t) {
      if ((FaceNormal(mesh, t) - Vector(normal)).length() > 1e-6) continue;
      Scene look = MakeSphereScene(Interpolation::kFaceted, 1);
      look.camera.look_at =
          (mesh.positions[mesh.triangles[3 * t]] + mesh.positions[mesh.triangles[3 * t + 1]] +
           mesh.positions[mesh.triangles[3 * t + 2]]) /
          3;
      look.image.width = look.image.height = 1;
      const auto expected = Triple(RenderImage(look, Settings()), kColor, 0);
      for (size_t c = 0; c < 3; ++c) {
        // The camera's ray meets the centroid to double's precision: rounding in the kernel only.
        CHECK(std::abs(color[c] - expected[c]) <= 8 * kUnit * expected[c]);
      }
      ++compared;
    }
  }
  CHECK(compared == static_cast<int>(colors.size()));
}

// One triangle that fills a parallel view of 2 x 2, lit by one sun, with normals of its own.
Scene MakeTriangleScene(Interpolation interpolation) {
  Scene scene;
  scene.camera.projection = Projection::kOrthographic;
  scene.camera.height = 2;
  scene.image.width = scene.image.height = 32;
  scene.image.spp = 1;
  scene.image.filter = {FilterKind::kBox, 1};
  Mesh mesh{.positions = {{-2, -1, 0}, {2, -1, 0}, {0, 4, 0}},
            .normals = {Vec3d(-1, -0.5, 1).normalized(), Vec3d(1, 0.2, 2).normalized(),
                        Vec3d(0, 1, 1.5).normalized()},
            .triangles = {0, 1, 2},
            .material = {0},
            .interpolation = interpolation};
  scene.meshes = {mesh};
  scene.materials = {MakeGlossy()};
  scene.materials[0].emission = {0, 0, 0};
  scene.materials[0].model = LambertMaterial{{0.9, 0.6, 0.3}};
  scene.lights = {MakeSun({-0.3, -0.4, -1})};
  return scene;
}

TEST_CASE("Gouraud's colour is the affine combination of the vertices' colours") {
  const Scene scene = MakeTriangleScene(Interpolation::kGouraud);
  const Mesh& mesh = scene.meshes[0];
  const Vec3d to_light = Vec3d(0.3, 0.4, 1).normalized();
  const Rgb reflected = Rgb(0.9, 0.6, 0.3) * Rgb(2, 1.5, 1) * M_1_PI;
  ForEachTarget([&](Target) {
    const Image image = RenderImage(scene, Settings({"diffuse"}));
    for (int y = 0; y < 32; ++y) {
      for (int x = 0; x < 32; ++x) {
        const Vec3d p((x + 0.5) / 16 - 1, 1 - (y + 0.5) / 16, 0);
        // p = -2 a + 2 b and 5 c - 1 with a + b + c = 1.
        const double c = (p.y + 1) / 5, b = (p.x / 2 + 1 - c) / 2, a = 1 - b - c;
        double cosine = 0;
        int i = 0;
        for (const double weight : {a, b, c}) {
          cosine += weight * std::max(mesh.normals[static_cast<size_t>(i++)].dot(to_light), 0.0);
        }
        const auto color = Triple(image, kColor, static_cast<size_t>(32 * y + x));
        for (int k = 0; k < 3; ++k) {
          // The vertices' colours are good to 8 roundings of float, their mean adds one.
          const double expected = reflected[k] * cosine;
          CHECK(std::abs(color[static_cast<size_t>(k)] - expected) <= 9 * kUnit * expected);
        }
      }
    }
  });
}

TEST_CASE("Gouraud's ramps are straight: their second differences are 0") {
  Scene scene = MakeTriangleScene(Interpolation::kGouraud);
  scene.materials = {MakeGlossy()};
  scene.lights.push_back(MakeLamp());
  const Image image = RenderImage(scene, Settings({"diffuse", "specular"}));
  for (const char* channel : {"R", "diffuse.G", "specular.B"}) {
    const std::vector<float>& ramp = Samples(image, channel);
    for (size_t i = 0; i < ramp.size(); ++i) {
      if (i % 32 < 2) continue;
      const double second = double{ramp[i]} - 2 * double{ramp[i - 1]} + double{ramp[i - 2]};
      CHECK(std::abs(second) <= 4 * kUnit * ramp[i]);  // each is rounded once
    }
  }
  scene.meshes[0].interpolation = Interpolation::kPhong;
  const std::vector<float> curve = Samples(RenderImage(scene, Settings()), "R");
  CHECK(std::abs(curve[40] - 2 * curve[39] + curve[38]) > 64 * kUnit * curve[40]);
}

TEST_CASE("between the vertices of an icosphere Phong's normal is the sphere's") {
  for (int subdivisions = 0; subdivisions < 4; ++subdivisions) {
    const Scene scene = MakeSphereScene(Interpolation::kPhong, subdivisions);
    const Image image = RenderImage(scene, Settings({"N", "P"}));
    for (size_t i = 0; i < Samples(image, "A").size(); ++i) {
      if (Samples(image, "A")[i] == 0) continue;
      const Vec3d radial = Vector(Triple(image, kPosition, i)).normalized();
      CHECK((Vector(Triple(image, kNormal, i)) - radial).length() <= 8 * kUnit);
    }
  }
}

TEST_CASE("seen from behind, meshes reflect on the side that is seen") {
  for (const Interpolation interpolation : kInterpolations) {
    Scene scene = MakeTriangleScene(interpolation);
    const Image front = RenderImage(scene, Settings());
    Mesh& mesh = scene.meshes[0];
    mesh.triangles = {0, 2, 1};  // wound the other way: its normals point to the viewer still
    CHECK(SameBits(front, RenderImage(scene, Settings())));
    for (Vec3d& normal : mesh.normals) normal = -normal;
    CHECK(SameBits(front, RenderImage(scene, Settings())));
  }
}

TEST_CASE("every model with every interpolation: finite, the same bits, layers that add up") {
  for (const Interpolation interpolation : kInterpolations) {
    Scene scene = MakeSphereScene(interpolation, 2);
    scene.image.spp = 3;
    PhongMaterial phong, blinn;
    blinn.model = PhongModel::kBlinnPhong;
    Material split = MakeGlossy(), shiny = MakeGlossy(), waxy = MakeGlossy(), matt = MakeGlossy();
    shiny.model = phong;
    waxy.model = blinn;
    matt.model = LambertMaterial{};
    split.emission = {0, 0, 0};
    split.model = SplitMaterial{{0.3, 0.5, 0.7}, {{0}, {1}, {2}, {3}}};
    scene.materials = {scene.materials[0], shiny, waxy, matt, split};
    scene.meshes[0].material = {4};
    scene.spheres = {{{1.5, 1.5, 2}, 0.4, {0}}};  // shares a material with the mesh
    const Image image = RenderImage(scene, Settings({"all"}, 1));
    RenderSettings tiled = Settings({"all"}, 3);
    tiled.tile_size = 7;
    CHECK(SameBits(image, RenderImage(scene, tiled)));
    Scene one_layer = scene;
    const Image plain = RenderImage(scene, Settings());
    for (const char* c : kColor) {
      const std::string name = c;
      CHECK(Samples(image, name) == Samples(plain, name));
      for (size_t i = 0; i < Samples(image, name).size(); ++i) {
        const double beauty = Samples(image, name)[i];
        REQUIRE(std::isfinite(beauty));
        const auto at = [&](const std::string& layer) -> double {
          return Samples(image, layer + "." + name)[i];
        };
        const double reflected = at("diffuse") + at("specular");
        CHECK(std::abs(reflected + at("ambient") + at("emission") - beauty) <= 8 * kUnit * beauty);
        CHECK(std::abs(at("light.sun") + at("light.lamp") - reflected) <= 16 * kUnit * reflected);
      }
    }
  }
}

// A map that leans all normals one way is looked up once for a point, however many samples of the
// light follow: the mesh with the normals that it leads to reflects the same.
TEST_CASE("maps turn the normals of vertices and centroids once, not once a light sample") {
  for (const Interpolation interpolation : {Interpolation::kGouraud, Interpolation::kFlat}) {
    for (const bool glossy : {false, true}) {
      Scene scene;
      scene.camera.projection = Projection::kOrthographic;
      scene.camera.position = {0, 0, 5};
      scene.camera.height = 2;
      scene.image.width = scene.image.height = 16;
      scene.image.spp = 16;
      Mesh mesh{.positions = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}}};
      mesh.normals.assign(4, Vec3d(0, 0, 1));
      mesh.triangles = {0, 1, 2, 0, 2, 3};
      mesh.uvs = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
      mesh.material = {0};
      mesh.interpolation = interpolation;
      scene.meshes = {mesh};
      scene.materials = {MakeGlossy()};
      if (!glossy) scene.materials[0].model = LambertMaterial{{0.9, 0.6, 0.3}};
      Light lamp;
      lamp.name = "lamp";
      lamp.kind = SphereAreaLight{.center = {1, 2, 4}, .radius = 0.5, .radiance = {80, 70, 60}};
      scene.lights = {lamp};
      const Vec3d leaning = Vec3d(96.0 / 127, 0, 1).normalized();  // of code 224; 0 is that of 128
      Scene expected = scene;
      expected.meshes[0].normals.assign(4, leaning);
      scene.materials[0].normal_map.texture = AddConstant(&scene, Rgb(224.0 / 255, 128.0 / 255, 1));
      scene.textures[0].mapping = MappingKind::kUv;
      // The normal is that of floats, and so are colours: some roundings. A triangle's plane does
      // not lean with its map: its centroid is looked at alone, and sampled apart. Samples of a
      // lamp of 0.1 sr tell its light to 10 %, and 4096 random ones would tell it to 0.2 %.
      double tolerance = 32 * kUnit;
      if (interpolation == Interpolation::kFlat) {
        expected.meshes[0].interpolation = Interpolation::kPhong;
        for (Scene* s : {&scene, &expected}) {
          s->camera.position = {1.0 / 3, -1.0 / 3, 5};
          s->camera.look_at = {1.0 / 3, -1.0 / 3, 0};
          s->camera.height = 1e-3;
          s->image.spp = 4096;
          s->image.width = s->image.height = 1;
        }
        tolerance = 0.005;
      }
      const Image got = RenderImage(scene, Settings()), wanted = RenderImage(expected, Settings());
      for (const char* channel : kColor) {
        for (size_t i = 0; i < got.data.pixel_count(); ++i) {
          const double value = Samples(wanted, channel)[i];
          CAPTURE(channel, i, glossy, tolerance, value);
          REQUIRE(value > 0.1);
          CHECK(std::abs(Samples(got, channel)[i] - value) <= tolerance * value);
        }
      }
    }
  }
}

// Equal triangles give equal distances, by the same arithmetic: what comes first in the scene is
// seen in every pixel, on every target, whatever the tree makes of the order.
TEST_CASE("of triangles with the same vertices the first one is seen") {
  for (const bool one_mesh_each : {true, false}) {
    Scene scene = MakeSphereScene(Interpolation::kFaceted, 2);
    scene.lights.clear();
    scene.materials = {Material{}, Material{}};
    scene.materials[0].emission = {1, 0, 0};
    scene.materials[1].emission = {0, 1, 0};
    scene.meshes.push_back(scene.meshes[0]);
    scene.meshes[1].material = {1};
    if (!one_mesh_each) {  // other triangles between them
      scene.meshes.insert(scene.meshes.begin() + 1, MakeMesh(Icosphere{.radius = 0.5}));
      scene.meshes[1].material = {1};
    }
    ForEachTarget([&](Target) {
      const Image image = RenderImage(scene, Settings());
      double red = 0;
      for (size_t i = 0; i < image.data.pixel_count(); ++i) {
        CHECK(Samples(image, "G")[i] == 0);
        red += Samples(image, "R")[i];
      }
      CHECK(red > 500);
    });
  }
}

// Counts of shadow rays, lights and bad directions belong to the picture, whenever they were made.
TEST_CASE("what shading vertices and triangles takes is counted in the picture's statistics") {
  for (const Interpolation interpolation : {Interpolation::kGouraud, Interpolation::kFlat}) {
    Scene scene = MakeSphereScene(interpolation, 2);
    scene.image.shadows = true;
    const FramePlan plan = MakePlan(scene, {});
    const Mesh& mesh = scene.meshes[0];
    const size_t points =
        interpolation == Interpolation::kFlat ? mesh.triangles.size() / 3 : mesh.positions.size();
    RenderStats stats;
    RenderImage(plan, {}, &stats);
    CAPTURE(static_cast<int>(interpolation), points, stats.shades);
    // Both lights at each point; vertices on the outline have a point on either side.
    CHECK(stats.shades >= 2 * points);
    CHECK(stats.shades <= 4 * points);
    CHECK(stats.shadow_rays >= points / 4);
    CHECK(stats.shades == plan.meshes.stats.shades);
  }
}

TEST_CASE("lights with an extent shine on vertices and centroids, too") {
  for (const Interpolation interpolation : {Interpolation::kGouraud, Interpolation::kFlat}) {
    Scene scene = MakeSphereScene(interpolation, 3);
    scene.image.spp = 16;
    Light ball;
    ball.name = "ball";
    ball.kind = SphereAreaLight{.center = {3, 4, 5}, .radius = 0.5, .radiance = {80, 80, 80}};
    scene.lights = {ball};
    const auto mean = [](const Image& image) {
      double sum = 0;
      for (const float value : Samples(image, "R")) sum += value;
      return sum / static_cast<double>(Samples(image, "R").size());
    };
    const double interpolated = mean(RenderImage(scene, Settings()));
    scene.meshes[0].interpolation = Interpolation::kPhong;
    const double smooth = mean(RenderImage(scene, Settings()));
    // 1280 faces of a smooth light: a few percent, most of it where the highlight is.
    CHECK(interpolated == Approx(smooth).epsilon(0.05));
  }
}

TEST_CASE("no jagged shadows on coarse meshes where light grazes them") {
  for (int subdivisions = 0; subdivisions < 4; ++subdivisions) {
    for (const bool point : {false, true}) {
      Scene scene = MakeSphereScene(Interpolation::kPhong, subdivisions);
      Light beside = MakeLamp();
      std::get<PointLight>(beside.kind).position = {9, 1, -1};
      scene.lights = {point ? beside : MakeSun({-1, -0.2, 0.1})};
      const Image lifted = RenderImage(scene, Settings());
      scene.meshes[0].smooth_terminator = false;
      const Image jagged = RenderImage(scene, Settings());
      scene.image.shadows = false;
      const Image unshadowed = RenderImage(scene, Settings());
      // A sphere cannot shadow itself on the side that faces the light.
      CHECK(SameBits(lifted, unshadowed));
      CHECK(!SameBits(jagged, unshadowed));
    }
  }
}

TEST_CASE("the smooth terminator changes nothing but shadows of smooth normals") {
  for (const Interpolation interpolation :
       {Interpolation::kGouraud, Interpolation::kFlat, Interpolation::kFaceted}) {
    Scene scene = MakeSphereScene(interpolation, 1);
    const Image image = RenderImage(scene, Settings());
    scene.meshes[0].smooth_terminator = false;
    CHECK(SameBits(image, RenderImage(scene, Settings())));
  }
  // And meshes that are shadowed by something else stay so.
  Scene scene = MakeSphereScene(Interpolation::kPhong, 3);
  scene.lights = {MakeSun({0, 0, -1})};
  scene.spheres = {{{0, 0, 6}, 0.7, {0}}};
  scene.camera.position = {8, 0, 6};
  const auto lit = [&] {
    const Image image = RenderImage(scene, Settings({"diffuse"}));
    size_t count = 0;
    for (const float value : Samples(image, "diffuse.R")) count += value > 0 ? 1 : 0;
    return count;
  };
  const size_t with = lit();
  scene.image.shadows = false;
  CHECK(with + 20 < lit());
}

}  // namespace
}  // namespace nacre
