// SPDX-License-Identifier: Apache-2.0
// tests/render/render_test.cc: whole pictures: what a pixel's bits may not depend on, what layers
// add up to, and that skips skip nothing that shows.
#include "render/render.h"

#include <atomic>
#include <cmath>
#include <cstring>

#include <half.h>

#include "base/error.h"
#include "image_io/half.h"
#include "pictures.h"
#include "targets.h"

namespace nacre {
namespace {

MaterialId Add(Scene* scene, Material material) {
  scene->materials.push_back(std::move(material));
  return {static_cast<uint32_t>(scene->materials.size() - 1)};
}

template <class Model>
Material Make(const Model& model, const Rgb& emission = {0, 0, 0}) {
  return Material{.emission = emission, .model = model};
}

// Every kind of material and light, a mesh, shadows, a filter wider than a pixel.
Scene MakeScene() {
  Scene scene;
  scene.camera.position = {0.3, 0.8, 6};
  scene.image.width = 67;
  scene.image.height = 45;
  scene.image.spp = 5;
  scene.image.filter = {FilterKind::kMitchell, 4};
  scene.background = {0.05, 0.06, 0.1};
  PhongMaterial phong{.color = {0.8, 0.2, 0.2}};
  MetallicRoughnessMaterial gold{.base_color = {1, 0.77, 0.34}, .metallic = 1, .roughness = 0.25};
  const MaterialId lambert = Add(&scene, Make(LambertMaterial{{0.6, 0.6, 0.5}}));
  const MaterialId red = Add(&scene, Make(phong));
  const MaterialId metal = Add(&scene, Make(gold, {0.01, 0.02, 0.03}));
  const MaterialId split = Add(&scene, Make(SplitMaterial{{0.5}, {red, metal}}));
  scene.spheres = {{{0, -100, 0}, 99, lambert},
                   {{-1.1, 0, 0}, 0.9, red},
                   {{1.1, 0, 0}, 0.9, metal},
                   {{0, 0.9, 0.8}, 0.4, split}};
  Mesh mesh{.positions = {{-2, -0.9, 1.5}, {-1, -0.9, 2}, {-1.5, 0.2, 1.4}},
            .triangles = {0, 1, 2},
            .material = lambert};
  scene.meshes.push_back(mesh);
  Light key;
  key.name = "key";
  key.kind = PointLight{.position = {3, 4, 5}, .intensity = {90, 85, 80}};
  Light sun;
  sun.name = "sun";
  sun.kind = DirectionalLight{.direction_of_travel = {1, -1, -0.5}, .irradiance = {0.5, 0.6, 0.7}};
  Light spot;
  spot.name = "spot";
  spot.kind = SpotLight{.position = {-3, 5, 3},
                        .direction_of_travel = {3, -5, -3},
                        .intensity = {50, 50, 50},
                        .attenuation = {1, 0, 0.1},
                        .cutoff_deg = 25,
                        .inner_deg = 15,
                        .exponent = 2};
  Light sky;
  sky.name = "sky";
  sky.kind = AmbientLight{{0.1, 0.1, 0.12}};
  scene.lights = {key, sun, spot, sky};
  return scene;
}

RenderSettings Settings(int threads, std::vector<std::string> layers = {}) {
  return RenderSettings{.threads = threads, .layers = std::move(layers)};
}

TEST_CASE("no image is cleared for a render that was cancelled") {
  const Scene scene = OneSphere(LambertMaterial{Rgb(0.8)}, 8, 1);
  const FramePlan plan = MakePlan(scene, {});
  const std::atomic<bool> cancel = true;
  RenderSettings settings{.cancel = &cancel};
  Image image;
  CHECK_THROWS_AS(FitImage(plan, settings, &image), Cancelled);
  CHECK(image.channels.empty());  // and none is half as large as the image says
  FitImage(plan, {}, &image);
  CHECK(image.channels.size() == 4);
}

TEST_CASE("an image that held another picture is written over") {
  const Scene scene = MakeScene();
  Scene other = OneSphere(LambertMaterial{Rgb(0.8)}, scene.image.width, 1);
  other.background = Rgb(0.5, 0.25, 0.125);
  Image image = RenderImage(scene, Settings(1, {"all"}));
  for (const int threads : {1, 2}) {
    for (const bool first : {false, true}) {
      const Scene& shown = first ? scene : other;
      const RenderSettings settings = Settings(threads, {"all"});
      const FramePlan plan = MakePlan(shown, settings);
      RenderInto(plan, settings, &image);
      CHECK(SameBits(image, RenderImage(shown, settings)));
    }
  }
}

TEST_CASE("threads and tiles change no bit") {
  const Scene scene = MakeScene();
  ForEachTarget([&](Target) {
    const Image one = RenderImage(scene, Settings(1, {"all"}));
    for (const int threads : {2, 7}) {
      CHECK(SameBits(one, RenderImage(scene, Settings(threads, {"all"}))));
    }
    for (const int tile_size : {0, 1, 7, 16, 64}) {
      CAPTURE(tile_size);
      RenderSettings tiled = Settings(1, {"all"});
      tiled.tile_size = tile_size;
      CHECK(SameBits(one, RenderImage(scene, tiled)));
    }
  });
}

TEST_CASE("a crop holds the bits of the full frame") {
  const Scene scene = MakeScene();
  const Image full = RenderImage(scene, Settings(1, {"all"}));
  const Window crop{11, 9, 53, 40};
  RenderSettings cropped = Settings(1, {"all"});
  cropped.region = crop;
  const Image part = RenderImage(scene, cropped);
  REQUIRE(part.data == crop);
  REQUIRE(part.display == full.display);
  for (size_t c = 0; c < full.channels.size(); ++c) {
    CAPTURE(full.channels[c].name);
    bool same = true;
    for (int y = crop.y0; y < crop.y1; ++y) {
      for (int x = crop.x0; x < crop.x1; ++x) {
        const size_t in_full = static_cast<size_t>(y) * 67 + static_cast<size_t>(x);
        const size_t in_part =
            static_cast<size_t>(y - crop.y0) * 42 + static_cast<size_t>(x - crop.x0);
        same = same && full.channels[c].samples[in_full] == part.channels[c].samples[in_part];
      }
    }
    CHECK(same);
  }
}

TEST_CASE("a region without a pixel is refused") {
  const Scene scene = MakeScene();
  RenderSettings outside = Settings(1);
  outside.region = {100, 0, 120, 10};
  CHECK_THROWS_AS(RenderImage(scene, outside), Error);
}

// One rounding of the beauty and of each of the four layers, of at most half an ulp of the largest
// of them, and of the sum of diffuse and specular of each sample: within 4 ulp. Where weights
// cancel the last is half an ulp of what samples are: no more than twice the brightest pixel here,
// times the weights' absolute sum, 1.4 of Mitchell's over 4 pixels.
void CheckLayers(Scene scene, const PixelFilter& filter) {
  scene.image.filter = filter;
  const Image alone = RenderImage(scene, Settings(1));
  const Image layered = RenderImage(scene, Settings(1, {"all"}));
  for (const char* channel : {"R", "G", "B"}) {
    const std::vector<float>& beauty = layered.Find(channel)->samples;
    CHECK(SameBits(alone.Find(channel)->samples, beauty));
    const float brightest = *std::max_element(beauty.begin(), beauty.end());
    const double cancelled = filter.kind == FilterKind::kMitchell ? 1.4 * 0x1p-24 * brightest : 0;
    double lights_error = 0;
    for (size_t i = 0; i < beauty.size(); ++i) {
      const auto layer = [&](const std::string& name) {
        return double{layered.Find(name + "." + channel)->samples[i]};
      };
      const double sum =
          layer("diffuse") + layer("specular") + layer("ambient") + layer("emission");
      double largest = std::abs(double{beauty[i]});
      for (const char* name : {"diffuse", "specular", "ambient", "emission"}) {
        largest = std::max(largest, std::abs(layer(name)));
      }
      const float top = static_cast<float>(largest);
      const double ulp = double{std::nextafter(top, INFINITY)} - double{top};
      REQUIRE(std::abs(sum - double{beauty[i]}) <= 4 * ulp + cancelled);
      double lights = 0;
      for (const Light& light : scene.lights) {
        if (light.name != "sky") lights += layer("light." + light.name);
      }
      lights_error =
          std::max(lights_error, std::abs(lights - layer("diffuse") - layer("specular")));
    }
    CHECK(lights_error < 1e-5);  // a few roundings of values around 1 to 10
  }
}

TEST_CASE("layers do not change the beauty, and add up to it") {
  const Scene scene = MakeScene();
  CheckLayers(scene, {});
  CheckLayers(scene, {FilterKind::kGaussian, 3});
  CheckLayers(scene, {FilterKind::kBlackmanHarris, 3.3});
  CheckLayers(scene, {FilterKind::kMitchell, 4});
}

// Of which kernels leave the sum, and the parts where a layer shows them.
TEST_CASE("under one light, too, layers do not change the beauty and add up to it") {
  for (size_t one = 0; one < 3; ++one) {
    Scene scene = MakeScene();
    scene.lights = {scene.lights[one], scene.lights[3]};
    CAPTURE(scene.lights[0].name);
    CheckLayers(scene, {});
    CheckLayers(scene, {FilterKind::kGaussian, 3});
    Scene dark = scene;  // where nothing else is left once weights cancel
    dark.background = {0, 0, 0};
    dark.lights.pop_back();
    dark.image.width = 268;
    dark.image.height = 180;
    dark.image.spp = 16;
    CheckLayers(dark, {FilterKind::kMitchell, 4});
    const Image beauty = RenderImage(scene, Settings(1));
    const auto same_beauty = [&](const RenderSettings& settings) {
      const Image image = RenderImage(scene, settings);
      for (const char* channel : {"R", "G", "B"}) {
        CHECK(SameBits(beauty.Find(channel)->samples, image.Find(channel)->samples));
      }
    };
    for (const std::string& layer : {std::string("diffuse"), "light." + scene.lights[0].name}) {
      same_beauty(Settings(1, {layer}));
    }
    RenderSettings general = Settings(1);
    general.general_path = true;
    same_beauty(general);
  }
}

TEST_CASE("one light beside one with an extent is not the only one") {
  Scene scene = MakeScene();
  Light lamp;
  lamp.name = "lamp";
  lamp.kind = SphereAreaLight{.center = {-3, 4, 5}, .radius = 0.5, .radiance = {40, 30, 20}};
  scene.lights = {scene.lights[0], lamp};
  CheckLayers(scene, {});
}

TEST_CASE("in half, too, layers add up to the beauty within half an ulp of each") {
  Image image = RenderImage(MakeScene(), Settings(1, {"all"}));
  for (Channel& channel : image.channels) {
    std::vector<uint16_t> halves(channel.samples.size());
    FloatToHalf(channel.samples.data(), halves.size(), halves.data());
    for (size_t i = 0; i < halves.size(); ++i) {
      const imath_half_bits_t bits = halves[i];
      channel.samples[i] = imath_half_to_float(bits);
    }
  }
  const auto half_ulp = [](double value) {
    return std::ldexp(0.5, std::max(std::ilogb(std::max(std::abs(value), 1e-30)), -14) - 10);
  };
  for (const char* channel : {"R", "G", "B"}) {
    const std::vector<float>& beauty = image.Find(channel)->samples;
    for (size_t i = 0; i < beauty.size(); ++i) {
      double error = -double{beauty[i]};
      double bound = half_ulp(beauty[i]);
      for (const std::string layer : {"diffuse", "specular", "ambient", "emission"}) {
        const double value = image.Find(layer + "." + channel)->samples[i];
        error += value;
        bound += half_ulp(value);
      }
      // The floats that are rounded to half have errors of their own, 2^-13 of a half's ulp.
      REQUIRE(std::abs(error) <= bound * 1.001);
    }
  }
}

TEST_CASE("a black light has a layer, and it is black") {
  Scene scene = MakeScene();
  std::get<PointLight>(scene.lights[0].kind).intensity = {0, 0, 0};
  for (const std::vector<std::string>& layers :
       {std::vector<std::string>{"light.key"}, std::vector<std::string>{"all"}}) {
    const Image image = RenderImage(scene, Settings(1, layers));
    for (const float value : image.Find("light.key.G")->samples) REQUIRE(value == 0);
  }
}

TEST_CASE("equally near samples give P and ids of the first, whatever the tile") {
  // A filter of hardly any width puts all samples of a pixel at its centre, on a split's edge.
  Scene scene = MakeScene();
  scene.image.width = 65;
  scene.image.filter = {FilterKind::kBox, 1e-12};
  RenderSettings tiny = Settings(1, {"id.material", "P"});
  tiny.tile_size = 1;
  CHECK(SameBits(RenderImage(scene, tiny), RenderImage(scene, Settings(1, {"id.material", "P"}))));
}

TEST_CASE("a camera inside a lone sphere sees its wall in shadow") {
  // The wall is lit from outside only, so all light is blocked; nothing may be skipped.
  for (const Projection projection : {Projection::kPerspective, Projection::kOrthographic}) {
    Scene scene;
    scene.image.width = 16;
    scene.image.height = 16;
    scene.camera.projection = projection;
    scene.camera.position = {0, 0, 0.2};
    const MaterialId white = Add(&scene, Make(LambertMaterial{{1, 1, 1}}));
    scene.spheres = {{{0, 0, 0}, 5, white}};
    Light sun;
    sun.name = "sun";
    sun.kind = DirectionalLight{.direction_of_travel = {0.3, -1, -1}, .irradiance = {3, 3, 3}};
    scene.lights = {sun};
    const Image image = RenderImage(scene, Settings(1));
    for (const float value : image.Find("R")->samples) REQUIRE(value == 0);
    // A light inside shows.
    scene.lights[0].kind = PointLight{.position = {0, 1, 0}, .intensity = {9, 9, 9}};
    CHECK(RenderImage(scene, Settings(1)).Find("R")->samples[8 * 16 + 8] > 0);
  }
}

TEST_CASE("shadow rays skipped for a sphere alone leave every bit") {
  Scene scene = MakeScene();
  scene.spheres = {scene.spheres[2]};
  scene.meshes.clear();
  RenderStats skipped_stats;
  RenderStats general_stats;
  const Image skipped = RenderImage(scene, Settings(1), &skipped_stats);
  RenderSettings general = Settings(1);
  general.general_path = true;
  const Image traced = RenderImage(scene, general, &general_stats);
  CHECK(skipped_stats.shadow_rays == 0);
  CHECK(general_stats.shadow_rays > 0);
  CHECK(SameBits(skipped, traced));
}

TEST_CASE("an empty scene is its background, without an intersector") {
  Scene scene;
  scene.image.width = 20;
  scene.image.height = 20;
  scene.background = {0.25, 0.5, 1};
  CHECK(MakePlan(scene, {}).hits.shapes.intersector == nullptr);
  const Image image = RenderImage(scene, Settings(1));
  CHECK(image.Find("R")->samples[123] == 0.25f);
  CHECK(image.Find("B")->samples[399] == 1.0f);
  CHECK(image.Find("A")->samples[7] == 0.0f);
}

TEST_CASE("shadows: on, off by scene, off by light") {
  // A sphere between a plane-like ground and a light straight above: its shadow is at the centre.
  Scene scene;
  scene.image.width = 21;
  scene.image.height = 21;
  scene.image.spp = 1;
  scene.camera.projection = Projection::kOrthographic;
  scene.camera.position = {0, 0.5, 10};  // between ground and sphere
  scene.camera.look_at = {0, 0, 0};
  scene.camera.height = 0.5;
  const MaterialId white = Add(&scene, Make(LambertMaterial{{1, 1, 1}}));
  scene.spheres = {{{0, -100, 0}, 100, white}, {{0, 2, 0}, 0.5, white}};
  Light sun;
  sun.name = "sun";
  sun.kind = DirectionalLight{.direction_of_travel = {0, -1, 0}, .irradiance = {M_PI, M_PI, M_PI}};
  scene.lights = {sun};
  const size_t center = 10 * 21 + 10;
  CHECK(RenderImage(scene, Settings(1)).Find("R")->samples[center] == 0);
  scene.lights[0].shadows = false;
  CHECK(RenderImage(scene, Settings(1)).Find("R")->samples[center] == Approx(1).epsilon(1e-3));
  scene.lights[0].shadows = true;
  scene.image.shadows = false;
  CHECK(RenderImage(scene, Settings(1)).Find("R")->samples[center] == Approx(1).epsilon(1e-3));
}

TEST_CASE("a split shows each material on its side") {
  Scene scene;
  scene.image.width = 40;
  scene.image.height = 10;
  scene.image.spp = 1;
  scene.camera.position = {0, 0, 3};
  const MaterialId a = Add(&scene, Make(LambertMaterial{{0, 0, 0}}, {1, 0, 0}));
  const MaterialId b = Add(&scene, Make(LambertMaterial{{0, 0, 0}}, {0, 1, 0}));
  const MaterialId c = Add(&scene, Make(LambertMaterial{{0, 0, 0}}, {0, 0, 1}));
  const MaterialId split = Add(&scene, Make(SplitMaterial{{0.25, 0.5}, {a, b, c}}));
  scene.spheres = {{{0, 0, -100}, 100, split}};
  const Image image = RenderImage(scene, Settings(1, {"id.material"}));
  const std::vector<float>& id = image.Find("id.material")->samples;
  CHECK(id[5 * 40 + 9] == 1);
  CHECK(id[5 * 40 + 10] == 2);
  CHECK(id[5 * 40 + 19] == 2);
  CHECK(id[5 * 40 + 20] == 3);
}

TEST_CASE("geometry layers hold what is at the pixel's centre") {
  Scene scene;
  scene.image.width = 31;
  scene.image.height = 31;
  scene.image.spp = 1;
  scene.camera.position = {1, 2, 13};
  scene.camera.look_at = {1, 2, 0};
  const MaterialId white = Add(&scene, Make(LambertMaterial{{1, 1, 1}}));
  scene.spheres = {{{1, 2, 3}, 2, white}};
  const Image image = RenderImage(scene, Settings(1, {"N", "P", "Z", "id.object"}));
  const size_t center = 15 * 31 + 15;
  CHECK(image.Find("Z")->samples[center] == 8);
  CHECK(image.Find("P.X")->samples[center] == Approx(1).margin(1e-6));
  CHECK(image.Find("P.Y")->samples[center] == Approx(2).margin(1e-6));
  CHECK(image.Find("P.Z")->samples[center] == 5);
  CHECK(image.Find("N.Z")->samples[center] == 1);
  CHECK(image.Find("id.object")->samples[center] == 1);
  CHECK(image.Find("id.object")->samples[0] == 0);
  CHECK(image.Find("Z")->samples[0] == 0);
}

TEST_CASE("an eye in a sphere's very centre sees its inside all around") {
  // Rays that are nearest to the centre at 0, of either sign, have no other case to fall into.
  ForEachTarget([](Target) {
    for (const IntersectorChoice intersector :
         {IntersectorChoice::kTiles, IntersectorChoice::kEmbree}) {
      Scene scene;
      scene.spheres.push_back({Vec3d(1, 2, 3), 5, Add(&scene, Make(LambertMaterial{}))});
      scene.camera.position = {1, 2, 3};
      scene.camera.look_at = {1.5, 2.25, 2};
      scene.camera.fov_y_deg = 150;
      scene.image.width = scene.image.height = 33;
      scene.image.spp = 1;
      RenderSettings settings = Settings(1);
      settings.intersector = intersector;
      settings.layers = {"N", "Z"};
      const Image image = RenderImage(scene, settings);
      const Vec3d forward = (scene.camera.look_at - scene.camera.position).normalized();
      size_t outward = 0, behind = 0;
      for (size_t i = 0; i < image.data.pixel_count(); ++i) {
        const Vec3d n(image.Find("N.X")->samples[i], image.Find("N.Y")->samples[i],
                      image.Find("N.Z")->samples[i]);
        if (n.dot(forward) >= 0) ++outward;
        // The hit is the radius away, along the normal turned round.
        if (std::abs(image.Find("Z")->samples[i] + 5 * n.dot(forward)) > 1e-5) ++behind;
      }
      CHECK(outward == 0);
      CHECK(behind == 0);
    }
  });
}

TEST_CASE("targets differ by no more than rounding") {
  // DESIGN's bound, on 99.9 % of this small picture's pixels: the rest lie on edges.
  const Scene scene = MakeScene();
  const TargetGuard guard;
  PinTarget(SupportedTargets().front());  // scalar, where it is built
  const Image scalar = RenderImage(scene, Settings(1));
  ForEachTarget([&](Target) {
    const Image image = RenderImage(scene, Settings(1));
    size_t off = 0;
    const std::vector<float>& a = scalar.Find("G")->samples;
    const std::vector<float>& b = image.Find("G")->samples;
    for (size_t i = 0; i < a.size(); ++i) {
      if (std::abs(a[i] - b[i]) > 1e-5f + 1e-4f * std::abs(a[i])) ++off;
    }
    CHECK(off <= a.size() / 1000);
  });
}

}  // namespace
}  // namespace nacre
