// SPDX-License-Identifier: Apache-2.0
// tests/render/sampled_lights_test.cc: pictures under lights with an extent and under skies,
// against what they must be in closed form, and against the same by other ways.
#include "render/sampled_lights.h"

#include <cmath>
#include <cstring>

#include "pictures.h"
#include "render/render.h"
#include "targets.h"

namespace nacre {
namespace {

Light Sky(double radiance) {
  EnvironmentLight sky{.sky = ConstantSky{Rgb(radiance)}, .rotate_deg = 0, .background = false};
  return Named("sky", sky);
}

TEST_CASE("under a constant sky a matte sphere shows its albedo, to float's last digits") {
  Scene scene = OneSphere(LambertMaterial{Rgb(0.6, 0.4, 0.2)});
  scene.lights = {Sky(2)};
  const Image image = RenderImage(scene, {});
  const std::vector<float>& alpha = image.Find("A")->samples;
  for (size_t i = 0; i < alpha.size(); ++i) {
    if (alpha[i] < 1) continue;
    // Products of a few floats: 4 x 2^-24.
    CHECK(std::abs(image.Find("R")->samples[i] - 1.2) <= 1.2 * 0x1p-22);
    CHECK(std::abs(image.Find("B")->samples[i] - 0.4) <= 0.4 * 0x1p-22);
  }
}

TEST_CASE("a white furnace shows nothing, whatever the model and roughness") {
  for (const double roughness : {0.0, 0.02, 0.1, 0.5, 1.0}) {
    for (const double metallic : {0.0, 1.0}) {
      CAPTURE(roughness, metallic);
      MetallicRoughnessMaterial white{
          .base_color = Rgb(1, 1, 1), .metallic = metallic, .roughness = roughness};
      Scene scene = OneSphere(white);
      scene.lights = {Sky(1)};
      scene.image.spp = 64;
      const Mean mean = MeanRed(RenderImage(scene, {}));
      CAPTURE(mean.value, mean.error);
      // The compensation's own tolerance, 1e-3, is tested where it is computed; and the noise.
      CHECK(std::abs(mean.value - 1) <= 1e-3 + 4 * mean.error);
    }
  }
}

TEST_CASE("a perfect mirror shows the sky that it sees") {
  ConductorMaterial mirror{.eta = Rgb(1e-3), .roughness = 0, .fresnel = ConductorFresnel::kSchlick};
  mirror.k = Rgb(100);  // F0 = 1 but for 4e-7
  Scene scene = OneSphere(mirror);
  GradientSky gradient{.zenith = Rgb(1, 2, 3), .horizon = Rgb(4, 5, 6), .ground = Rgb(7, 8, 9)};
  scene.lights = {Named("sky", EnvironmentLight{.sky = gradient, .background = false})};
  scene.image.spp = 1;
  scene.camera.projection = Projection::kOrthographic;
  scene.camera.height = 3;
  const Image image = RenderImage(scene, {.layers = {"N"}});
  size_t seen = 0;
  for (size_t i = 0; i < image.data.pixel_count(); ++i) {
    if (image.Find("A")->samples[i] < 1) continue;
    ++seen;
    const double ny = image.Find("N.Y")->samples[i], nz = image.Find("N.Z")->samples[i];
    const double y = 2 * nz * ny;  // of the view direction (0, 0, 1) mirrored in n
    const double expected = y > 0 ? 4 + (1 - 4) * y : 4 + (7 - 4) * -y;
    CHECK(std::abs(image.Find("R")->samples[i] - expected) <= 1e-5 * expected);
  }
  CHECK(seen > 1000);
}

TEST_CASE("the sky stands behind the scene where it is asked to") {
  Scene scene = OneSphere(LambertMaterial{Rgb(0.5)});
  scene.camera.fov_y_deg = 60;
  GradientSky gradient;
  scene.lights = {Named("sky", EnvironmentLight{.sky = gradient, .background = true})};
  scene.image.spp = 1;
  const Image image = RenderImage(scene, {});
  const double slope = std::tan(30 * M_PI / 180) * (1 - 1.0 / 64);
  for (const size_t column : {size_t{0}, size_t{31}}) {
    const double x = (2 * (static_cast<double>(column) + 0.5) / 64 - 1) * std::tan(30 * M_PI / 180);
    const double y = slope / std::sqrt(1 + x * x + slope * slope);
    const double expected = 1 + (0.3 - 1) * y;
    CHECK(std::abs(image.Find("R")->samples[column] - expected) <= 1e-6);
  }
  CHECK(image.Find("A")->samples[0] == 0);
}

// Where samples hit nothing, the general path places them all the same.
TEST_CASE("the sky beside a sphere is seen through the samples' own places") {
  Scene scene = OneSphere(LambertMaterial{Rgb(0.5)}, 64, 4);
  scene.camera.fov_y_deg = 60;
  scene.lights = {Named("sky", EnvironmentLight{.sky = GradientSky{}, .background = true})};
  const Image image = RenderImage(scene, {});
  const Image expected = RenderImage(scene, {.general_path = true});
  for (const char* channel : {"R", "G", "B", "A"}) {
    CHECK(image.Find(channel)->samples == expected.Find(channel)->samples);
  }
}

// A dim sky with a sun of one texel that gives most of the light.
std::shared_ptr<const SkyPicture> SunnyPicture() {
  auto picture = std::make_shared<SkyPicture>();
  picture->width = 64;
  picture->height = 32;
  for (int y = 0; y < 32; ++y) {
    for (int x = 0; x < 64; ++x) {
      const bool sun = x == 40 && y == 9;
      const auto blue = static_cast<float>(0.2 + 0.01 * y);
      const auto red = static_cast<float>(0.05 + 0.005 * x);  // tells longitudes apart
      for (const float value : {sun ? 400.0f : red, sun ? 300.0f : 0.1f, blue}) {
        picture->rgb.push_back(value);
      }
    }
  }
  return picture;
}

// Its texel in a direction, by the definition in scene.h; rotated.
double RedOf(const SkyPicture& picture, const Vec3d& direction, double rotate_rad) {
  const double c = std::cos(rotate_rad), s = std::sin(rotate_rad);
  const Vec3d d(direction.x * c - direction.z * s, direction.y, direction.z * c + direction.x * s);
  double u = std::atan2(d.x, -d.z) / (2 * M_PI);
  if (u < 0) u += 1;
  const double v = std::acos(std::clamp(d.y, -1.0, 1.0)) / M_PI;
  const int x = std::min(static_cast<int>(u * picture.width), picture.width - 1);
  const int y = std::min(static_cast<int>(v * picture.height), picture.height - 1);
  return picture.rgb[static_cast<size_t>(3 * (y * picture.width + x))];
}

// Irradiance by the midpoints of 512 x 1024 cells.
double RedIrradiance(const SkyPicture& picture, const Vec3d& normal, double rotate_rad) {
  constexpr int kRows = 512;
  double sum = 0;
  for (int i = 0; i < kRows; ++i) {
    const double theta = M_PI * (i + 0.5) / kRows;
    for (int k = 0; k < 2 * kRows; ++k) {
      const double phi = M_PI * (k + 0.5) / kRows;
      const Vec3d l(std::sin(theta) * std::cos(phi), std::cos(theta),
                    std::sin(theta) * std::sin(phi));
      const double cosine = l.dot(normal);
      if (cosine > 0) sum += RedOf(picture, l, rotate_rad) * cosine * std::sin(theta);
    }
  }
  return sum * M_PI / kRows * M_PI / kRows;
}

TEST_CASE("a picture of the sky lights as its texels do") {
  EnvironmentLight sky{
      .sky = PictureSky{SunnyPicture(), Rgb(2)}, .rotate_deg = 30, .background = false};
  Scene scene = OneSphere(LambertMaterial{Rgb(M_PI / 4)});
  scene.lights = {Named("sky", sky)};
  scene.image.width = scene.image.height = 48;
  scene.image.spp = 1024;
  scene.camera.projection = Projection::kOrthographic;
  scene.camera.height = 2.6;
  const Image image = RenderImage(scene, {.region = {24, 12, 35, 23}, .layers = {"N"}});
  const auto& picture = *std::get<PictureSky>(sky.sky).picture;
  const auto ratio = [&](size_t i) {
    const Vec3d n(image.Find("N.X")->samples[i], image.Find("N.Y")->samples[i],
                  image.Find("N.Z")->samples[i]);
    const double expected = 2 * RedIrradiance(picture, n.normalized(), M_PI / 6) / 4;
    return image.Find("R")->samples[i] / expected;
  };
  const Mean mean = MeanOf(image, ratio);
  CAPTURE(mean.value, mean.error);
  // The quadrature is 0.1 % off at the edges of the sun's texel, and a pixel's mean normal stands
  // for its normals, (1/18)^2 / 12 of a radian apart. Pixels' errors are independent.
  CHECK(std::abs(mean.value - 1) <= 1.3e-3 + 4 * mean.error);
  CHECK(mean.error < 2e-3);  // it says something
}

TEST_CASE("a perfect mirror shows the picture's texels") {
  ConductorMaterial mirror{.eta = Rgb(1e-3), .roughness = 0, .fresnel = ConductorFresnel::kSchlick};
  mirror.k = Rgb(100);  // F0 = 1 but for 4e-7
  Scene scene = OneSphere(mirror);
  EnvironmentLight sky{
      .sky = PictureSky{SunnyPicture(), Rgb(1)}, .rotate_deg = -70, .background = true};
  scene.lights = {Named("sky", sky)};
  scene.image.spp = 1;
  scene.camera.projection = Projection::kOrthographic;
  scene.camera.height = 3;
  const Image image = RenderImage(scene, {.layers = {"N"}});
  const auto& picture = *std::get<PictureSky>(sky.sky).picture;
  size_t wrong = 0, seen = 0;
  for (size_t i = 0; i < image.data.pixel_count(); ++i) {
    if (image.Find("A")->samples[i] < 1) continue;
    ++seen;
    const Vec3d n(image.Find("N.X")->samples[i], image.Find("N.Y")->samples[i],
                  image.Find("N.Z")->samples[i]);
    const Vec3d l = n * (2 * n.z) - Vec3d(0, 0, 1);
    const double expected = RedOf(picture, l, -70 * M_PI / 180);
    if (std::abs(image.Find("R")->samples[i] - expected) > 1e-5 * expected) ++wrong;
  }
  CHECK(seen > 1000);
  CHECK(wrong <= seen / 500);  // at texels' edges the normal's rounding decides
}

// Lights near a sphere, each with all that can go wrong: near, large, partly below the horizon.
std::vector<Light> AreaLights() {
  RectangleAreaLight rectangle{.center = Vec3d(2, 1.5, 2),
                               .facing = Vec3d(-2, -1.5, -2),
                               .up = Vec3d(0, 1, 0),
                               .width = 2,
                               .height = 1,
                               .radiance = Rgb(5)};
  DiskAreaLight disk{
      .center = Vec3d(-1, 2, 1.5), .facing = Vec3d(1, -2, -1.5), .radius = 1, .radiance = Rgb(5)};
  SphereAreaLight sphere{.center = Vec3d(1, 2, 2), .radius = 0.7, .radiance = Rgb(5)};
  return {Named("rectangle", rectangle), Named("disk", disk), Named("sphere", sphere)};
}

std::vector<decltype(Material::model)> Models() {
  MetallicRoughnessMaterial metal{.metallic = 1, .roughness = 0.3};
  MetallicRoughnessMaterial plastic{.roughness = 0.05};
  MetallicRoughnessMaterial lesson{.diffuse_coupling = DiffuseCoupling::kOneMinusFresnel};
  PhongMaterial phong;
  PhongMaterial blinn{.model = PhongModel::kBlinnPhong};
  blinn.shininess = 500;  // its terms are formed in double
  MetallicRoughnessMaterial clay{.diffuse = DiffuseForm::kOrenNayar};
  return {LambertMaterial{Rgb(0.7)},
          metal,
          plastic,
          lesson,
          phong,
          blinn,
          clay,
          OrenNayarMaterial{Rgb(0.7)},
          BurleyMaterial{Rgb(0.7)}};
}

TEST_CASE("area lights far away are point lights") {
  for (const auto& model : Models()) {
    // Lobes much wider than the light: the light's extent, 1/2000 rad, shows in the second order.
    if (const auto* m = std::get_if<MetallicRoughnessMaterial>(&model); m && m->roughness < 0.2) {
      continue;
    }
    if (const auto* m = std::get_if<PhongMaterial>(&model); m && m->shininess > 100) continue;
    Scene scene = OneSphere(model);
    const Vec3d place(300, 400, 500);
    const double area = 4;  // of the light, each
    SphereAreaLight sphere{.center = place, .radius = std::sqrt(area / M_PI), .radiance = Rgb(1e6)};
    RectangleAreaLight rectangle{.center = place,
                                 .facing = -place,
                                 .up = Vec3d(0, 1, 0),
                                 .width = 2,
                                 .height = 2,
                                 .radiance = Rgb(1e6)};
    DiskAreaLight disk{
        .center = place, .facing = -place, .radius = sphere.radius, .radiance = Rgb(1e6)};
    const Light bulb = Named("bulb", PointLight{.position = place, .intensity = Rgb(1e6 * area)});
    scene.lights = {bulb};
    const Image truth = RenderImage(scene, {});
    for (const Light& light : {Named("a", sphere), Named("b", rectangle), Named("c", disk)}) {
      scene.lights = {light};
      const Image image = RenderImage(scene, {});
      const double difference = MeanDifference(image, truth).value;
      CAPTURE(light.name, difference, MeanRed(truth).value);
      // (extent / distance)^2 = 8e-6, and what sampling the terminator leaves.
      CHECK(std::abs(difference) <= 1e-4 * MeanRed(truth).value);
    }
  }
}

TEST_CASE("a light has the same mean whichever way its directions are chosen") {
  std::vector<Light> lights = AreaLights();
  lights.push_back(Sky(1));
  QuadraticSky quadratic{.axis = Vec3d(1, 2, 0), .constant = 0.5, .linear = 0.4, .quadratic = 0.3};
  lights.push_back(Named("quadratic", EnvironmentLight{.sky = quadratic, .background = false}));
  lights.push_back(Named("gradient", EnvironmentLight{.sky = GradientSky{}, .background = false}));
  for (const auto& model : Models()) {
    for (const Light& light : lights) {
      CAPTURE(light.name, model.index());
      Scene scene = OneSphere(model);
      scene.lights = {light};
      scene.image.spp = 64;
      RenderSettings settings;
      const Image closed = RenderImage(scene, settings);
      settings.closed_forms = false;
      const Image sampled = RenderImage(scene, settings);
      CheckSameMean(closed, sampled);
    }
  }
}

TEST_CASE("layers of sampled lights add up to the picture") {
  Scene scene = OneSphere(MetallicRoughnessMaterial{});
  scene.lights = AreaLights();
  scene.lights.push_back(Sky(0.3));
  RenderSettings settings;
  const Image plain = RenderImage(scene, settings);
  settings.layers = {"all"};
  const Image all = RenderImage(scene, settings);
  for (const char* channel : {"R", "G", "B"}) {
    const std::vector<float>& beauty = all.Find(channel)->samples;
    CHECK(std::memcmp(beauty.data(), plain.Find(channel)->samples.data(), 4 * beauty.size()) == 0);
    const auto layer = [&](const std::string& name) -> const std::vector<float>& {
      return all.Find(name + "." + channel)->samples;
    };
    for (size_t i = 0; i < beauty.size(); ++i) {
      const double parts = double{layer("diffuse")[i]} + layer("specular")[i] +
                           layer("ambient")[i] + layer("emission")[i];
      // Layers round once each, after sums in double.
      CHECK(std::abs(parts - beauty[i]) <= 4 * 0x1p-24 * beauty[i]);
      const double lights = double{layer("light.rectangle")[i]} + layer("light.disk")[i] +
                            layer("light.sphere")[i] + layer("light.sky")[i];
      // The beauty adds the lights up in float, hit by hit.
      CHECK(std::abs(lights - (double{layer("diffuse")[i]} + layer("specular")[i])) <=
            16 * 0x1p-24 * beauty[i]);
    }
  }
}

TEST_CASE("pictures under sampled lights do not depend on threads, tiles, crops or intersectors") {
  Scene scene = OneSphere(MetallicRoughnessMaterial{});
  scene.spheres.push_back({Vec3d(0.8, 0.9, 0.9), 0.3, {0}});  // in the way
  scene.spheres.push_back({Vec3d(-3, 0, 0), 0.5, {0}});
  scene.lights = AreaLights();
  scene.lights.push_back(Sky(0.3));
  // The lamps that are surfaces make the scene one of triangles: once with, once without.
  for (const bool visible : {true, false}) {
    for (Light& light : scene.lights) {
      if (auto* rectangle = std::get_if<RectangleAreaLight>(&light.kind)) {
        rectangle->visible = visible;
      } else if (auto* disk = std::get_if<DiskAreaLight>(&light.kind)) {
        disk->visible = visible;
      }
    }
    for (const double max_error : {0.0, 0.2}) {
      CAPTURE(visible, max_error);
      RenderSettings settings{.threads = 1, .max_error = max_error, .max_samples = 64};
      const Image one = RenderImage(scene, settings);
      const auto check = [&](const RenderSettings& other) {
        const Image image = RenderImage(scene, other);
        for (const char* channel : {"R", "G", "B", "A"}) {
          const std::vector<float>& a = image.Find(channel)->samples;
          size_t i = 0, wrong = 0;
          for (int y = image.data.y0; y < image.data.y1; ++y) {
            for (int x = image.data.x0; x < image.data.x1; ++x, ++i) {
              const auto at = static_cast<size_t>(y * 64 + x);
              if (std::memcmp(&a[i], &one.Find(channel)->samples[at], 4) != 0) ++wrong;
            }
          }
          CHECK(wrong == 0);
        }
      };
      RenderSettings other = settings;
      other.threads = 3;
      other.tile_size = 7;
      check(other);
      other = settings;
      other.region = {13, 5, 50, 37};
      check(other);
      other = settings;
      other.intersector = IntersectorChoice::kEmbree;
      check(other);
      other.general_path = true;
      check(other);
    }
  }
}

TEST_CASE("a light's own shape is not in its way") {
  for (const Light& light : AreaLights()) {
    CAPTURE(light.name);
    Scene scene = OneSphere(LambertMaterial{Rgb(0.7)});
    scene.camera.fov_y_deg = 40;  // sees the light
    RenderSettings settings;
    settings.closed_forms = false;  // every hit asks
    settings.general_path = true;
    settings.layers = {"id.object"};
    scene.lights = {light};
    const Image visible = RenderImage(scene, settings);
    std::visit(
        [](auto& kind) {
          if constexpr (requires { kind.visible; }) kind.visible = false;
        },
        scene.lights[0].kind);
    const Image hidden = RenderImage(scene, settings);
    size_t on_sphere = 0, different = 0, seen = 0;
    for (size_t i = 0; i < visible.data.pixel_count(); ++i) {
      const auto at = [&](const Image& image, const char* name) {
        return image.Find(name)->samples[i];
      };
      if (at(visible, "id.object") > 1) ++seen;
      if (at(visible, "id.object") != 1 || at(visible, "A") != 1 || at(hidden, "A") != 1) continue;
      // Pixels that hold some of the light's shape are left out.
      if (at(visible, "R") > at(hidden, "R") + 1) continue;
      ++on_sphere;
      if (at(visible, "R") != at(hidden, "R")) ++different;
    }
    CHECK(seen > 10);
    CHECK(on_sphere > 100);
    CHECK(different == 0);
  }
}

// A perfect mirror beside a rough metal: a batch that holds hits on both is sampled by the light
// and by the lobes, one of the mirror alone is not.
TEST_CASE("what mirrors reflect of an area light does not depend on what else is in their tile") {
  ForEachTarget([](Target) {
    Scene scene;
    const auto add = [&](double roughness, const Vec3d& center, double radius) {
      ConductorMaterial metal{.roughness = roughness,
                              .shadowing = Shadowing::kSchlickDirect,
                              .compensation = Compensation::kKullaConty};
      scene.materials.emplace_back().model = metal;
      scene.spheres.push_back(
          {center, radius, {static_cast<uint32_t>(scene.materials.size() - 1)}});
    };
    add(0, {-0.6, 0, 0}, 1);
    add(0.35, {0.8, 0, 0.3}, 0.8);
    DiskAreaLight disk{
        .center = Vec3d(-2, 3, 5), .facing = Vec3d(2, -3, -5), .radius = 0.5, .radiance = Rgb(20)};
    scene.lights.push_back(Named("disk", disk));
    scene.camera.position = Vec3d(0, 0, 9);
    scene.camera.fov_y_deg = 20;
    scene.image.width = 90;
    scene.image.height = 40;
    scene.image.spp = 4;
    RenderSettings settings;
    const Image image = RenderImage(scene, settings);
    for (const int tile_size : {5, 16, 26, 64}) {
      settings.tile_size = tile_size;
      CHECK(SameBits(RenderImage(scene, settings), image));
    }
  });
}

}  // namespace
}  // namespace nacre
