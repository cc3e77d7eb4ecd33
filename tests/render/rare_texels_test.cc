// SPDX-License-Identifier: Apache-2.0
// tests/render/rare_texels_test.cc: pictures to a wanted error of maps and skies in which few
// texels matter, many to a pixel.
#include <cmath>
#include <functional>
#include <memory>
#include <random>

#include "light/environment.h"
#include "pictures.h"
#include "textured_scenes.h"
#include "told_pixels.h"

namespace nacre {
namespace {

constexpr int kTexels = 512;  // of a map, along each axis

// What a map holds at its texels: `rare` at one in `of`, else `common`.
using MapValues = std::function<double(int, int)>;
MapValues Dots(uint32_t seed, uint32_t of, double rare, double common) {
  auto values = std::make_shared<std::vector<double>>(size_t{kTexels} * kTexels);
  std::mt19937 random(seed);
  for (double& value : *values) value = random() % of == 0 ? rare : common;
  return [=](int x, int y) { return (*values)[static_cast<size_t>(y * kTexels + x)]; };
}

// A square that fills the picture, seen in parallel, a unit a pixel. Texel (0, 0) begins at its
// lower left corner.
struct MappedSquare {
  double texels_per_pixel;
  MapValues values;
  Wrap wrap = Wrap::kRepeat;

  Scene Make(TextureId* texture) const {
    Scene scene;
    scene.image.width = scene.image.height = kSide;
    scene.image.filter = {FilterKind::kBox, 1};
    scene.camera.projection = Projection::kOrthographic;
    scene.camera.height = kSide;
    scene.camera.position = {0, 0, 100};
    scene.camera.look_at = {0, 0, 0};
    *texture =
        AddTexture(&scene, kTexels, kTexels, [&](int x, int y) { return Rgb(values(x, y)); });
    Texture& mapped = scene.textures[0];
    mapped.mapping = MappingKind::kUv;
    mapped.sampling.filter = TextureFilter::kNearest;
    mapped.sampling.wrap_u = mapped.sampling.wrap_v = wrap;
    const double half = kSide / 2.0, turns = kSide * texels_per_pixel / kTexels;
    Mesh mesh{.positions = {{-half, -half, 0}, {half, -half, 0}, {half, half, 0}, {-half, half, 0}},
              .uvs = {{0, 0}, {turns, 0}, {turns, turns}, {0, turns}},
              .triangles = {0, 1, 2, 0, 2, 3},
              .material = {0}};
    scene.meshes.push_back(mesh);
    scene.materials.emplace_back().model = LambertMaterial{Rgb(0)};
    return scene;
  }

  // The exact mean of the map over each pixel: texels by their areas in it.
  std::vector<double> Means() const {
    std::vector<double> means(size_t{kSide} * kSide);
    const auto wrapped = [&](int texel) {
      const int period = texel / kTexels, in_period = texel % kTexels;
      return wrap == Wrap::kMirror && period % 2 == 1 ? kTexels - 1 - in_period : in_period;
    };
    const auto length = [&](int pixel, int texel) {  // of the texel in the pixel
      const double from = std::max<double>(pixel, texel / texels_per_pixel);
      return std::min<double>(pixel + 1, (texel + 1) / texels_per_pixel) - from;
    };
    const auto first = [&](int pixel) { return static_cast<int>(pixel * texels_per_pixel); };
    for (int y = 0; y < kSide; ++y) {
      for (int x = 0; x < kSide; ++x) {
        double sum = 0;
        for (int j = first(y); j / texels_per_pixel < y + 1; ++j) {
          for (int i = first(x); i / texels_per_pixel < x + 1; ++i) {
            sum += std::max(length(x, i), 0.0) * std::max(length(y, j), 0.0) *
                   values(wrapped(i), wrapped(j));
          }
        }
        means[static_cast<size_t>((kSide - 1 - y) * kSide + x)] = sum;
      }
    }
    return means;
  }
};

// A picture that has these values in all channels.
Image GreyPicture(const std::vector<double>& values) {
  Image image;
  image.channels.resize(3);
  for (auto& channel : image.channels) channel.samples.assign(values.begin(), values.end());
  return image;
}

// Nothing is beyond the error but what is told, which is little more than the pixels that have rare
// texels: they take the samples of which some hit, and the others settle early. `around`: how many
// texels around a pixel are looked at with its own.
void CheckExactly(const Scene& scene, const std::vector<double>& truth, double max_error,
                  double around = 0) {
  const Shares shares = SharesOf(scene, GreyPicture(truth), max_error);
  const double darkest = *std::min_element(truth.begin(), truth.end());
  const auto bright = std::count_if(truth.begin(), truth.end(),
                                    [&](double value) { return value > darkest + 1e-9; });
  const double searched = (1 + around) * (1 + around);  // pixels
  CAPTURE(max_error, shares.untold, shares.told, bright);
  CHECK(shares.untold <= 0.05);
  CHECK(shares.told <= searched * static_cast<double>(bright) / (kSide * kSide));
}

TEST_CASE("few bright texels of an emission map, many to a pixel, are found") {
  for (const uint32_t seed : {1u, 2u, 3u}) {
    for (const double scale : {15.7, 70.3}) {
      if (scale > 64 && seed > 1) continue;  // it takes long
      for (const Wrap wrap : {Wrap::kRepeat, Wrap::kMirror}) {
        // One in about four pixels has one.
        const auto of = static_cast<uint32_t>(4 * scale * scale);
        const MappedSquare square{scale, Dots(seed, of, 1, 0), wrap};
        TextureId map;
        Scene scene = square.Make(&map);
        const double emission = 0.4 * scale * scale;
        scene.materials[0].emission = Rgb(emission);
        scene.materials[0].emission_map = map;
        std::vector<double> truth = square.Means();
        for (double& value : truth) value *= emission;
        CAPTURE(seed, scale, static_cast<int>(wrap));
        // Of so many texels squares of 8x8 are looked at that overlap the pixel.
        const double around = scale * scale > 4096 ? 8 / scale : 0;
        CheckExactly(scene, truth, 0.05, around);
        CheckExactly(scene, truth, 0.2, around);
      }
    }
  }
}

TEST_CASE("few bright texels of a colour map are found") {
  for (const uint32_t seed : {4u, 5u}) {
    const MappedSquare square{9.3, Dots(seed, 400, 1, 0.02), Wrap::kRepeat};
    TextureId map;
    Scene scene = square.Make(&map);
    scene.materials[0].model = LambertMaterial{Rgb(0.9), map};
    scene.lights = {Named("ambient", AmbientLight{Rgb(8)})};
    std::vector<double> truth = square.Means();
    for (double& value : truth) value *= 0.9 * 8;
    CheckExactly(scene, truth, 0.05);
  }
}

TEST_CASE("small holes and small leaves of a cut-out are found") {
  for (const uint32_t seed : {6u, 7u}) {
    for (const bool holes : {true, false}) {
      const double common = holes ? 1 : 0;
      const MappedSquare square{17.3, Dots(seed, 1200, 1 - common, common), Wrap::kRepeat};
      TextureId map;
      Scene scene = square.Make(&map);
      scene.materials[0].opacity_map = map;
      const double leaf = holes ? 0 : 90;
      scene.background = Rgb(holes ? 90 : 0);
      scene.materials[0].emission = Rgb(leaf);
      std::vector<double> truth = square.Means();
      for (double& value : truth) value = holes ? 90 * (1 - value) : 90 * value;
      CAPTURE(seed, holes);
      CheckExactly(scene, truth, 0.1);
    }
  }
}

// Pictures whose truth is that of many samples: of the rarest texels here, 1/450 of a pixel, 36
// hits of 16384, whose error is below a fifth of the wanted one.
void CheckSampled(const Scene& scene, double max_error, double most_told) {
  const Shares shares = SharesOf(scene, Truth(scene, 1 << 14), max_error);
  CAPTURE(shares.untold, shares.told);
  CHECK(shares.untold <= 0.05);
  CHECK(shares.told <= most_told);
}

// A map of dots around a sphere that fills the picture: texels from a tenth of a pixel on.
TEST_CASE("few bright texels on a sphere are found") {
  Scene scene = OneSphere(LambertMaterial{Rgb(0)}, kSide);
  const TextureId map = AddTexture(&scene, 1024, 512, [](int x, int y) {
    std::mt19937 random(static_cast<uint32_t>(x + 1024 * y));
    return Rgb(random() % 900 == 0 ? 1 : 0);
  });
  scene.textures[0].sampling.filter = TextureFilter::kNearest;
  scene.materials[0].emission = Rgb(100);
  scene.materials[0].emission_map = map;
  CheckSampled(scene, 0.1, 0.5);
}

// Smooth dots, which reflect a lamp thousands of times as brightly as the rest.
TEST_CASE("few smooth texels of a roughness map are found") {
  MetallicRoughnessMaterial metal{.metallic = 1, .roughness = 1};
  const MappedSquare square{11.3, Dots(8, 500, 0.1, 0.8), Wrap::kRepeat};
  TextureId map;
  Scene scene = square.Make(&map);
  metal.metallic_roughness_map = map;
  scene.materials[0].model = metal;
  scene.lights = {Named("sun", DirectionalLight{Vec3d(0, 0, -1), Rgb(1)})};
  CheckSampled(scene, 0.1, 0.4);
}

// A direction so many degrees from the square's normal.
Vec3d Leaning(double degrees) {
  return {std::sin(degrees * M_PI / 180), 0, std::cos(degrees * M_PI / 180)};
}

std::shared_ptr<const MipChain> TwoTexels(const MapValues& values, const Rgb& rare,
                                          const Rgb& common) {
  std::vector<float> texels;
  for (int i = 0; i < kTexels * kTexels; ++i) {
    const Rgb& texel = values(i % kTexels, i / kTexels) > 0 ? rare : common;
    for (int c = 0; c < 3; ++c) texels.push_back(static_cast<float>(texel[c]));
  }
  return std::make_shared<const MipChain>(MakeMipChain(kTexels, kTexels, 3, std::move(texels)));
}

// The radiance of a square that one texel covers wholly: that of any pixel.
double OneTexelRadiance(Scene scene, const Rgb& texel) {
  scene.images[0].texels = std::make_shared<const MipChain>(MakeMipChain(
      1, 1, 3,
      {static_cast<float>(texel.x), static_cast<float>(texel.y), static_cast<float>(texel.z)}));
  scene.image.spp = 1;
  return RenderImage(scene, {}, nullptr).channels[0].samples[0];
}

// A map of two kinds of texels under a sun that is 40 degrees from the view: exactly, as all points
// of the square are seen and lit alike.
void CheckMapUnderSun(uint32_t seed, const Rgb& rare, const Rgb& common, double irradiance,
                      const std::function<void(Material*, TextureId)>& use) {
  for (const double scale : {15.7, 70.3}) {
    const MappedSquare square{scale, Dots(seed, static_cast<uint32_t>(4 * scale * scale), 1, 0)};
    TextureId map;
    Scene scene = square.Make(&map);
    scene.images[0].texels = TwoTexels(square.values, rare, common);
    use(&scene.materials[0], map);
    scene.lights = {Named("sun", DirectionalLight{-Leaning(40), Rgb(irradiance)})};
    const double of_rare = OneTexelRadiance(scene, rare),
                 of_common = OneTexelRadiance(scene, common);
    std::vector<double> truth = square.Means();
    for (double& value : truth) value = of_common + (of_rare - of_common) * value;
    CAPTURE(scale, of_rare, of_common);
    // The rare texels matter.
    CHECK((of_rare - of_common) / (scale * scale) > 2 * 0.1 * std::max(of_common, 0.05));
    CheckExactly(scene, truth, 0.1, scale > 64 ? 8 / scale : 0);
  }
}

// The texel of a normal map that leans so.
Rgb NormalTexel(const Vec3d& normal) { return (normal + Vec3d(1)) / 2; }

// Dots that mirror the sun, in a level map that does not.
TEST_CASE("few texels of a normal map that mirror a light are found") {
  const Rgb rare = NormalTexel(Leaning(20)), level = NormalTexel(Leaning(0));
  for (const double roughness : {0.05, 0.1}) {
    CheckMapUnderSun(10, rare, level, 30, [&](Material* material, TextureId map) {
      material->model = MetallicRoughnessMaterial{.metallic = 1, .roughness = roughness};
      material->normal_map = {map, 1, NormalMap::Convention::kLiteral};
    });
  }
  CheckMapUnderSun(11, rare, level, 300, [](Material* material, TextureId map) {
    MetallicRoughnessMaterial coated{.base_color = Rgb(0.02),
                                     .roughness = 1,
                                     .coat = 1,
                                     .coat_roughness = 0.1,
                                     .coat_normal_map = {map, 1, NormalMap::Convention::kLiteral}};
    material->model = coated;
  });
}

// The flank of a wide lobe is bright where the sharp ones around it do not reach.
TEST_CASE("few rough texels among smooth ones are found, and matte ones in metal") {
  CheckMapUnderSun(12, Rgb(0.002), Rgb(1), 1e5, [](Material* material, TextureId map) {
    PhongMaterial phong{.model = PhongModel::kBlinnPhong,
                        .kd = Rgb(0),
                        .ks = Rgb(0.5),
                        .shininess = 2000,
                        .shininess_map = map};
    material->model = phong;
  });
  CheckMapUnderSun(13, Rgb(1, 1, 0), Rgb(1), 3e4, [](Material* material, TextureId map) {
    MetallicRoughnessMaterial metal{
        .metallic = 1, .roughness = 0.05, .metallic_roughness_map = map};
    material->model = metal;
  });
}

// Every texel leans at random, as flakes in paint do: the brightest of a pixel does not explain it.
TEST_CASE("of pixels of flakes no more settle beyond the error than is allowed") {
  for (const double degrees : {8.0, 20.0}) {
    std::mt19937 random(21);
    std::normal_distribution<double> lean(0, std::tan(degrees * M_PI / 180));
    std::vector<float> texels;
    for (int i = 0; i < kTexels * kTexels; ++i) {
      const double x = lean(random), y = lean(random);
      const Rgb texel = NormalTexel(Vec3d(x, y, 1).normalized());
      for (int c = 0; c < 3; ++c) texels.push_back(static_cast<float>(texel[c]));
    }
    const auto chain = std::make_shared<const MipChain>(MakeMipChain(kTexels, kTexels, 3, texels));
    const auto make = [&](const MappedSquare& square, int side) {
      TextureId map;
      Scene scene = square.Make(&map);
      scene.image.width = scene.image.height = side;
      scene.images[0].texels = chain;
      scene.materials[0].model = MetallicRoughnessMaterial{.metallic = 1, .roughness = 0.1};
      scene.materials[0].normal_map = {map, 1, NormalMap::Convention::kLiteral};
      scene.lights = {Named("sun", DirectionalLight{-Leaning(40), Rgb(3)})};
      return scene;
    };
    // A pixel a texel: the map's radiance.
    Scene fine = make({kTexels / double{kSide}, [](int, int) { return 0.0; }}, kTexels);
    fine.image.spp = 1;
    const Image radiance = RenderImage(fine, {}, nullptr);
    const MappedSquare square{
        11.3, [&](int x, int y) -> double {
          const int row = kTexels - 1 - y;
          return radiance.channels[0].samples[static_cast<size_t>(row * kTexels + x)];
        }};
    const Shares shares = SharesOf(make(square, kSide), GreyPicture(square.Means()), 0.1);
    CAPTURE(degrees, shares.untold, shares.told);
    CHECK(shares.told < 0.6);
    CHECK(shares.untold < 0.05 * (1 - shares.told));
  }
}

// The same sun as a part of a sky, and a lamp of some size.
TEST_CASE("few texels of a normal map that mirror an area light or a sky's sun are found") {
  auto sky = std::make_shared<SkyPicture>();
  sky->width = 512;
  sky->height = 256;
  sky->rgb.assign(size_t{512} * 256 * 3, 0.01f);
  const auto [u, v] = LatLongFromDirection(Leaning(40));
  const auto sun = static_cast<size_t>(v * 256) * 512 + static_cast<size_t>(u * 512);
  std::fill_n(sky->rgb.begin() + static_cast<ptrdiff_t>(3 * sun), 3, 6600.0f);
  const auto environment =
      EnvironmentLight{.sky = PictureSky{sky, Rgb(1)}, .rotate_deg = 0, .background = false};
  const SphereAreaLight lamp{Leaning(40) * 900, 10, Rgb(2600), false};
  for (const Light& light : {Named("sky", environment), Named("lamp", lamp)}) {
    const MappedSquare square{70.3, Dots(14, 20000, 1, 0), Wrap::kRepeat};
    TextureId map;
    Scene scene = square.Make(&map);
    scene.images[0].texels =
        TwoTexels(square.values, NormalTexel(Leaning(20)), NormalTexel(Leaning(0)));
    scene.materials[0].model = MetallicRoughnessMaterial{.metallic = 1, .roughness = 0.1};
    scene.materials[0].normal_map = {map, 1, NormalMap::Convention::kLiteral};
    scene.lights = {light};
    CAPTURE(light.name);
    CheckSampled(scene, 0.1, 0.35);
  }
}

TEST_CASE("few bright texels of the sky behind are found") {
  auto picture = std::make_shared<SkyPicture>();
  picture->width = 4096;
  picture->height = 2048;
  std::mt19937 random(9);
  for (int i = 0; i < 4096 * 2048; ++i) {
    const float value = random() % 1500 == 0 ? 300.0f : 0.05f;
    for (int c = 0; c < 3; ++c) picture->rgb.push_back(value);
  }
  Scene scene;
  scene.image.width = scene.image.height = kSide;
  scene.camera.position = {0, 0, 0};
  scene.camera.look_at = {1, 0.2, 0.3};
  scene.camera.fov_y_deg = 60;
  scene.lights = {Named(
      "sky",
      EnvironmentLight{.sky = PictureSky{picture, Rgb(1)}, .rotate_deg = 30, .background = true})};
  CheckSampled(scene, 0.1, 0.35);
}

}  // namespace
}  // namespace nacre
