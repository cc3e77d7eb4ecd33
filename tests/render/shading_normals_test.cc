// SPDX-License-Identifier: Apache-2.0
// tests/render/shading_normals_test.cc: interpolated and mapped normals neither make light nor lose
// more of it than is stated, and a smooth mesh is the sphere that it stands for.
#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "pictures.h"
#include "render/render.h"
#include "scene/sphere_mesh.h"
#include "targets.h"
#include "textured_scenes.h"

namespace nacre {
namespace {

Light WhiteSky() {
  return Named("sky", EnvironmentLight{.sky = ConstantSky{Rgb(1)}, .background = false});
}

// A dim sky, brighter upwards, with a sun behind the sphere: what a rim mirrors.
Light SkyWithSunBehind() {
  auto picture = std::make_shared<SkyPicture>();
  picture->width = 32;
  picture->height = 16;
  for (int y = 0; y < 16; ++y) {
    for (int x = 0; x < 32; ++x) {
      const bool sun = x <= 1 && y == 6;  // at -z, where the camera looks
      const auto value = static_cast<float>(sun ? 30 : 0.6 - 0.03 * y);
      for (int c = 0; c < 3; ++c) picture->rgb.push_back(value);
    }
  }
  return Named("sky", EnvironmentLight{.sky = PictureSky{picture, Rgb(1)}, .background = false});
}

// The mesh in the place of the sphere.
Scene AsMesh(Scene scene, Mesh mesh) {
  scene.spheres.clear();
  mesh.material = {0};
  scene.meshes = {std::move(mesh)};
  return scene;
}

double Largest(const Image& image) {
  const std::vector<float>& red = image.Find("R")->samples;
  return *std::max_element(red.begin(), red.end());
}

// The sum of what the pictures differ by, over that of the second: background, rim and all.
double RelativeDifference(const Image& a, const Image& b) {
  const std::vector<float>& x = a.Find("R")->samples;
  const std::vector<float>& y = b.Find("R")->samples;
  double difference = 0, sum = 0;
  for (size_t i = 0; i < x.size(); ++i) {
    difference += std::abs(double{x[i]} - y[i]);
    sum += y[i];
  }
  return difference / sum;
}

struct Case {
  std::string name;
  decltype(Material::model) model;
  Light light;
  int spp;
};

std::vector<Case> RefinedCases() {
  const MetallicRoughnessMaterial plastic{.base_color = Rgb(0.5), .roughness = 0.35};
  const MetallicRoughnessMaterial metal{.base_color = Rgb(0.9), .metallic = 1, .roughness = 0.15};
  const PhongMaterial phong{.model = PhongModel::kBlinnPhong,
                            .convention = PhongConvention::kRadiometric,
                            .ks = Rgb(0.5),
                            .shininess = 60};
  const Light point =
      Named("point", PointLight{.position = Vec3d(-3, 2, -4), .intensity = Rgb(60)});
  const Light lamp =
      Named("lamp", SphereAreaLight{.center = Vec3d(-3, 2, -3), .radius = 1, .radiance = Rgb(8)});
  std::vector<Case> cases;
  const auto add = [&](const std::string& name, const auto& model) {
    cases.push_back({name + ", sky of one radiance", model, WhiteSky(), 64});
    cases.push_back({name + ", sky with a sun", model, SkyWithSunBehind(), 256});
    cases.push_back({name + ", point light", model, point, 16});
    cases.push_back({name + ", sphere light", model, lamp, 64});
  };
  add("plastic", plastic);
  add("metal", metal);
  add("blinn_phong", phong);
  return cases;
}

TEST_CASE("a smooth mesh becomes the sphere that it stands for as it is refined") {
  for (const Case& c : RefinedCases()) {
    Scene sphere = OneSphere(c.model, 48, c.spp);
    sphere.lights = {c.light};
    const Image expected = RenderImage(sphere, {});
    for (const bool uv : {true, false}) {
      double first = 0, last = 1e9;
      for (const int level : {2, 3, 4}) {  // edges are half as long each time
        const int segments = 4 << level;
        Mesh mesh = uv ? MakeMesh(UvSphere{.segments = segments, .rings = segments / 2})
                       : MakeMesh(Icosphere{.subdivisions = level});
        const Image got = RenderImage(AsMesh(sphere, std::move(mesh)), {});
        const double difference = RelativeDifference(got, expected);
        CAPTURE(c.name, uv, level, difference, last);
        // Flat facets and outlines are off by the square of the edges, a quarter each time; where
        // all light comes from behind, as much of it as they hide may be most of what is seen.
        CHECK(difference <= 0.6 * last);
        // No rim is brighter than the sphere's, whose largest value is a pixel's: 10 %, and more
        // while facets are as large as what they mirror.
        CHECK(Largest(got) <= (level == 4 ? 1.1 : 1.6) * Largest(expected));
        if (level == 2) first = difference;
        last = difference;
      }
      CAPTURE(c.name, uv, first, last);
      CHECK(last <= 0.3 * first);
      CHECK(last <= 0.2);
    }
  }
}

// What a white surface loses where maps turn its normal, of the light that comes from everywhere.
enum class Loses {
  kNothing,    // metals: what their lobes send below the surface is mirrored there
  kFromBelow,  // matte ones: the part of the cosine's hemisphere that is below the surface
  // At least half of that: of matte ones under a lobe, which takes most of the grazing light, and
  // of rough matte ones, which send more of it back to where it comes from than to the viewer.
  kLessOfIt,
};

struct White {
  std::string name;
  decltype(Material::model) model;
  Loses loses;
};

std::vector<White> WhiteModels() {
  std::vector<White> models = {
      {"matte", LambertMaterial{Rgb(1)}, Loses::kFromBelow},
      {"rough matte", OrenNayarMaterial{Rgb(1), 1}, Loses::kLessOfIt},
      {"plastic", MetallicRoughnessMaterial{.base_color = Rgb(1), .roughness = 0.35},
       Loses::kLessOfIt},
      {"shiny plastic", MetallicRoughnessMaterial{.base_color = Rgb(1), .roughness = 0},
       Loses::kLessOfIt},
      {"dielectric", DielectricMaterial{.base_color = Rgb(1), .roughness = 0.2}, Loses::kLessOfIt}};
  for (const double roughness : {0.0, 0.0005, 0.005, 0.1, 0.35, 1.0}) {
    for (const Compensation compensation : {Compensation::kTurquin, Compensation::kKullaConty}) {
      const bool turquin = compensation == Compensation::kTurquin;
      models.push_back({"metal of roughness " + std::to_string(roughness) +
                            (turquin ? ", turquin" : ", kulla_conty"),
                        MetallicRoughnessMaterial{.base_color = Rgb(1),
                                                  .metallic = 1,
                                                  .roughness = roughness,
                                                  .compensation = compensation},
                        Loses::kNothing});
    }
  }
  return models;
}

struct TurnedShape {
  const char* name;
  std::function<void(Scene*)> turn;  // a scene of one sphere
};

TextureId AddBumps(Scene* scene) {
  return AddTexture(scene, 16, 8, [](int x, int y) {
    return Rgb(x * 7 % 5 / 4.0, (x * 3 + y * 5) % 7 / 6.0, 0.6 + 0.4 * ((x + y) % 2));
  });
}

std::vector<TurnedShape> TurnedShapes() {
  const auto mesh = [](const Mesh& of) {
    return [of](Scene* scene) { *scene = AsMesh(*scene, of); };
  };
  const auto tilt = [](double degrees) {
    return [degrees](Scene* scene) {
      const double angle = degrees * M_PI / 180;
      scene->materials[0].normal_map.texture =
          AddConstant(scene, Rgb(0.5 + 0.5 * std::sin(angle), 0.5, 0.5 + 0.5 * std::cos(angle)));
      scene->materials[0].normal_map.convention = NormalMap::Convention::kLiteral;
    };
  };
  const auto bumps = [](double distance) {
    return [distance](Scene* scene) { scene->materials[0].bump_map = {AddBumps(scene), distance}; };
  };
  return {{"uv sphere of 12 by 6", mesh(MakeMesh(UvSphere{.segments = 12, .rings = 6}))},
          {"icosphere of 80", mesh(MakeMesh(Icosphere{.subdivisions = 1}))},
          {"tilted by 20 degrees", tilt(20)},
          {"tilted by 40 degrees", tilt(40)},
          {"tilted by 60 degrees", tilt(60)},
          {"bump map", bumps(0.3)},
          {"flat bump map", bumps(0.03)},
          {"normal map",
           [](Scene* scene) { scene->materials[0].normal_map.texture = AddBumps(scene); }},
          {"normal map on a mesh", [](Scene* scene) {
             *scene = AsMesh(*scene, MakeMesh(UvSphere{.segments = 12, .rings = 6}));
             scene->materials[0].normal_map.texture = AddBumps(scene);
             scene->textures[0].mapping = MappingKind::kUv;
           }}};
}

// Each pixel's mean over several pictures, and how far it may be from the truth.
struct PixelMean {
  double value, deviation;
};

std::vector<PixelMean> MeanPixels(Scene scene) {
  constexpr int kPictures = 4;
  std::vector<double> sums, squares;
  std::vector<float> alpha;
  for (int k = 0; k < kPictures; ++k) {
    scene.image.seed = static_cast<uint64_t>(k);
    const Image image = RenderImage(scene, {});
    const std::vector<float>& red = image.Find("R")->samples;
    if (k == 0) alpha = image.Find("A")->samples;
    sums.resize(red.size());
    squares.resize(red.size());
    for (size_t i = 0; i < red.size(); ++i) {
      sums[i] += red[i];
      squares[i] += double{red[i]} * red[i];
    }
  }
  std::vector<PixelMean> pixels;
  double mean_variance = 0;
  for (size_t i = 0; i < sums.size(); ++i) {
    if (alpha[i] < 1) continue;
    const double mean = sums[i] / kPictures;
    const double variance = std::max(squares[i] / kPictures - mean * mean, 0.0) / (kPictures - 1);
    pixels.push_back({mean, variance});
    mean_variance += variance;
  }
  mean_variance /= static_cast<double>(pixels.size());
  // Its own four values may agree by chance: not better than those of all.
  for (PixelMean& p : pixels) p.deviation = std::sqrt(std::max(p.deviation, mean_variance));
  return pixels;
}

// A scene of one white sphere, turned.
Scene TurnedScene(const TurnedShape& shape, const decltype(Material::model)& model, int spp) {
  Scene scene = OneSphere(model, 24, spp);
  scene.lights = {WhiteSky()};
  shape.turn(&scene);
  return scene;
}

// The mean share of a cosine's hemisphere about the shading normals that is below the surface, in
// the pixels that MeanPixels gives: (1 - cos) / 2 of the angle that a map turned the normal by.
double ShareFromBelow(const TurnedShape& shape) {
  constexpr int kFiner = 8;  // samples a side of a pixel
  Scene turned = TurnedScene(shape, LambertMaterial{}, 1);
  turned.image.spp = 64;
  const std::vector<float> covered = RenderImage(turned, {}).Find("A")->samples;
  turned.image.spp = 1;
  turned.image.width = turned.image.height = 24 * kFiner;
  Scene smooth = turned;
  smooth.materials[0].normal_map = {};
  smooth.materials[0].bump_map = {};
  RenderSettings settings{.layers = {"N"}};
  const Image a = RenderImage(turned, settings), b = RenderImage(smooth, settings);
  double sum = 0, count = 0;
  for (size_t y = 0; y < 24 * kFiner; ++y) {
    for (size_t x = 0; x < 24 * kFiner; ++x) {
      if (covered[24 * (y / kFiner) + x / kFiner] < 1) continue;
      double cosine = 0;
      for (const char* name : {"N.X", "N.Y", "N.Z"}) {
        const size_t i = 24 * kFiner * y + x;
        cosine += double{a.Find(name)->samples[i]} * b.Find(name)->samples[i];
      }
      sum += (1 - cosine) / 2;
      count += 1;
    }
  }
  return sum / count;
}

TEST_CASE("a white surface reflects all light but what a turned normal expects from below it") {
  for (const TurnedShape& shape : TurnedShapes()) {
    const double from_below = ShareFromBelow(shape);
    for (const White& white : WhiteModels()) {
      const std::vector<PixelMean> pixels = MeanPixels(TurnedScene(shape, white.model, 64));
      REQUIRE(pixels.size() > 100);
      double sum = 0, variance = 0;
      for (const PixelMean& pixel : pixels) {
        CAPTURE(shape.name, white.name, pixel.value, pixel.deviation);
        // The compensation's own tolerance, and of thousands of pixels none beyond six deviations.
        CHECK(pixel.value <= 1 + 1e-3 + 6 * pixel.deviation);
        CHECK(pixel.deviation <= 0.1);  // it says something
        sum += pixel.value;
        variance += pixel.deviation * pixel.deviation;
      }
      const auto count = static_cast<double>(pixels.size());
      const double lost = 1 - sum / count;
      // The compensation's tolerance; the noise; and of coarse meshes the little that rays from
      // their lifted origins still meet of them.
      const double margin = 1e-3 + 5 * std::sqrt(variance) / count;
      CAPTURE(shape.name, white.name, lost, from_below, margin);
      CHECK(lost >= -margin);
      if (white.loses == Loses::kNothing) CHECK(lost <= margin);
      if (white.loses == Loses::kLessOfIt) {
        CHECK(lost <= from_below + margin);
        CHECK(lost >= from_below / 2 - margin);
      }
      // 0.1 %: the normals' own sampling.
      if (white.loses == Loses::kFromBelow) CHECK(std::abs(lost - from_below) <= margin + 1e-3);
    }
  }
}

TEST_CASE("a perfect mirror under maps reflects all light, in every pixel and on every target") {
  for (const TurnedShape& shape : TurnedShapes()) {
    for (const bool alone : {true, false}) {
      Scene scene = TurnedScene(
          shape, MetallicRoughnessMaterial{.base_color = Rgb(1), .metallic = 1, .roughness = 0},
          16);
      // Another white mirror, far off, and shadow rays: what each sees in the other is not traced,
      // but hides the sky. It is behind, where neither is seen.
      if (!alone) scene.spheres.push_back({Vec3d(0, 0, -1e4), 1e-3, {0}});
      ForEachTarget([&](Target) {
        const Image image = RenderImage(scene, {});
        const std::vector<float>& alpha = image.Find("A")->samples;
        const std::vector<float>& red = image.Find("R")->samples;
        float least = 1, most = 1;
        for (size_t i = 0; i < red.size(); ++i) {
          if (alpha[i] < 1) continue;
          least = std::min(least, red[i]);
          most = std::max(most, red[i]);
        }
        CAPTURE(shape.name, alone, least, most);
        CHECK(least >= 1 - 1e-6f);
        CHECK(most <= 1 + 1e-6f);
      });
    }
  }
}

// A metal whose normals are tilted by 40 degrees, under no light yet.
Scene TiltedMetal() {
  for (const TurnedShape& shape : TurnedShapes()) {
    if (std::string(shape.name) != "tilted by 40 degrees") continue;
    Scene scene = TurnedScene(
        shape, MetallicRoughnessMaterial{.base_color = Rgb(1), .metallic = 1, .roughness = 0.5}, 1);
    scene.lights.clear();
    return scene;
  }
  FAIL("there is no such shape");
  return {};
}

TEST_CASE("as many suns as there are directions are a sky, of normal-mapped metals too") {
  // Evenly spread on a spiral, each with its part of the sphere.
  constexpr int kSuns = 2000;
  Scene scene = TiltedMetal();
  for (int i = 0; i < kSuns; ++i) {
    const double y = 1 - (2 * i + 1.0) / kSuns, turn = i * M_PI * (3 - std::sqrt(5));
    const double across = std::sqrt(1 - y * y);
    scene.lights.push_back(
        Named("sun " + std::to_string(i),
              DirectionalLight{Vec3d(across * std::cos(turn), y, across * std::sin(turn)),
                               Rgb(4 * M_PI / kSuns)}));
  }
  const Image image = RenderImage(scene, {});
  const std::vector<float>& red = image.Find("R")->samples;
  const std::vector<float>& alpha = image.Find("A")->samples;
  double sum = 0, count = 0;
  for (size_t i = 0; i < red.size(); ++i) {
    if (alpha[i] < 1) continue;
    sum += red[i];
    count += 1;
  }
  REQUIRE(count > 100);
  // Suns are 0.08 rad apart and the lobe 0.25 wide: no pixel is more than a few parts in a hundred
  // off, and the mean of hundreds a tenth of that. What the surface cuts off would be 10 %.
  CHECK(sum / count == Approx(1).margin(0.01));
}

TEST_CASE("a light alone leaves on normal-mapped metals what it leaves beside others") {
  Scene scene = TiltedMetal();
  scene.lights = {Named("sun", DirectionalLight{Vec3d(-1, -0.2, 0.1), Rgb(1)})};
  const Image alone = RenderImage(scene, {});
  const Image apart = RenderImage(scene, {.layers = {"all"}});
  scene.lights.push_back(Named("none", DirectionalLight{Vec3d(0, 0, -1), Rgb(0)}));
  const Image together = RenderImage(scene, {});
  CHECK(SameBits(alone.Find("R")->samples, apart.Find("R")->samples));
  for (size_t i = 0; i < alone.Find("R")->samples.size(); ++i) {
    const float a = alone.Find("R")->samples[i], b = together.Find("R")->samples[i];
    CHECK(std::abs(a - b) <= 2 * 0x1p-23f * b);  // a sum that is rounded once more
  }
  CHECK(Largest(alone) > 0);
}

TEST_CASE("what a tilted normal loses of a matte surface's light comes from below the surface") {
  // Of the normal's hemisphere a wedge as wide as the tilt: (1 - cos) / 2 of the irradiance.
  const double tilt = 40 * M_PI / 180;
  Scene scene = OneSphere(LambertMaterial{Rgb(1)}, 32, 256);
  scene.lights = {WhiteSky()};
  scene.materials[0].normal_map.texture =
      AddConstant(&scene, Rgb(0.5 + 0.5 * std::sin(tilt), 0.5, 0.5 + 0.5 * std::cos(tilt)));
  scene.materials[0].normal_map.convention = NormalMap::Convention::kLiteral;
  scene.image.spp = 1024;
  const Image image = RenderImage(scene, {});
  const std::vector<float>& red = image.Find("R")->samples;
  double sum = 0, count = 0;
  for (size_t y = 12; y < 20; ++y) {  // far from the rim, where normals are bent
    for (size_t x = 12; x < 20; ++x) {
      sum += red[32 * y + x];
      count += 1;
    }
  }
  // A share p of samples is lost: sqrt(p (1 - p) / n), four times.
  CHECK(sum / count == Approx((1 + std::cos(tilt)) / 2).margin(4 * 0.33 / std::sqrt(64 * 1024)));
}

TEST_CASE("a level normal map changes no bit of a smooth mesh") {
  Scene plain = OneSphere(MetallicRoughnessMaterial{.roughness = 0.2}, 24, 16);
  plain.lights = {SkyWithSunBehind(), Named("sun", DirectionalLight{Vec3d(1, -1, 0.2), Rgb(1)})};
  plain = AsMesh(plain, MakeMesh(UvSphere{.segments = 12, .rings = 6}));
  Scene mapped = plain;
  mapped.materials[0].normal_map.texture = AddConstant(&mapped, Rgb(128.0 / 255, 128.0 / 255, 1));
  mapped.textures[0].mapping = MappingKind::kUv;
  CHECK(SameBits(RenderImage(plain, {}), RenderImage(mapped, {})));
}

}  // namespace
}  // namespace nacre
