// SPDX-License-Identifier: Apache-2.0
// tests/render/adaptive_test.cc: pictures to a wanted error: that it holds, what it costs, and what
// a block's bits may not depend on.
#include <algorithm>
#include <cmath>

#include "pictures.h"
#include "render/camera.h"
#include "render/outline_coverage.h"
#include "render/render.h"
#include "render/white_level.h"
#include "scene_io/load_scene.h"
#include "targets.h"

namespace nacre {
namespace {

MaterialId Add(Scene* scene, decltype(Material::model) model) {
  scene->materials.push_back(Material{.model = std::move(model)});
  return {static_cast<uint32_t>(scene->materials.size() - 1)};
}

// Highlights narrower than a pixel and wide ones, shadows, a terminator, spheres in front of one
// another and smaller than a pixel.
Scene MakeScene() {
  Scene scene;
  scene.camera.position = {0, 0, 9};
  scene.camera.fov_y_deg = 30;
  scene.image.width = 120;
  scene.image.height = 88;
  scene.background = {0.05, 0.06, 0.1};
  PhongMaterial phong{.shininess = 800};
  for (const double roughness : {0.1, 0.3, 0.7}) {
    MetallicRoughnessMaterial metal{.metallic = 1, .roughness = roughness};
    const MaterialId id = Add(&scene, metal);
    scene.spheres.push_back({{2.2 * (roughness - 0.35) * 3, 1.1, 0}, 0.9, id});
  }
  const MaterialId shiny = Add(&scene, phong);
  const MaterialId matte = Add(&scene, LambertMaterial{{0.7, 0.6, 0.5}});
  scene.spheres.push_back({{-1.4, -1, 0.5}, 1, shiny});
  scene.spheres.push_back({{0.3, -0.9, 1.5}, 0.5, matte});
  scene.spheres.push_back({{1.8, -1.2, 0}, 1, matte});
  scene.spheres.push_back({{2.5, 0, 2}, 0.004, shiny});
  Light key{.kind = PointLight{.position = {4, 5, 8}, .intensity = {300, 290, 270}}};
  Light sun{.kind = DirectionalLight{Vec3d(2, -1, -1), {0.4, 0.5, 0.8}}};
  scene.lights = {key, sun};
  return scene;
}

RenderSettings Adaptive(double max_error) { return {.max_error = max_error}; }

Image Truth(Scene scene, int spp = 4096) {
  scene.image.spp = spp;
  scene.image.seed = 99;
  return RenderImage(scene, {}, nullptr);
}

// The share of pixels whose R, G and B are all within the wanted error of the truth.
double ShareWithin(const Image& image, const Image& truth, double max_error) {
  size_t within = 0;
  const size_t pixels = truth.channels[0].samples.size();
  for (size_t i = 0; i < pixels; ++i) {
    bool all = true;
    for (size_t c = 0; c < 3; ++c) {
      const double value = image.channels[c].samples[i];
      const double wanted = truth.channels[c].samples[i];
      all = all && std::abs(value - wanted) <= max_error * std::max(std::abs(wanted), 0.05);
    }
    within += all ? 1 : 0;
  }
  return static_cast<double>(within) / static_cast<double>(pixels);
}

// 95 % is what the interval promises. The truth's own error, of 4096 samples, is about a hundredth
// of the smallest one here: relative errors fall from 1e-3 at 256 samples by 0.6 a doubling.
TEST_CASE("95 % of the pixels are within the wanted error") {
  for (const PixelFilter filter :
       {PixelFilter{FilterKind::kBox, 1}, PixelFilter{FilterKind::kGaussian, 3},
        PixelFilter{FilterKind::kMitchell, 4}}) {
    Scene scene = MakeScene();
    scene.image.filter = filter;
    const Image truth = Truth(scene);
    for (const double max_error : {0.2, 0.05, 0.01}) {
      CAPTURE(static_cast<int>(filter.kind), max_error);
      RenderStats stats;
      const Image image = RenderImage(scene, Adaptive(max_error), &stats);
      CHECK(ShareWithin(image, truth, max_error) >= 0.95);
      CHECK(stats.camera_rays > 0);
    }
  }
}

// Some of MakeScene's highlights are a hundred times brighter than white. The truth's error is a
// hundredth of that of a tenth of its samples.
TEST_CASE("highlights are as exact as white") {
  const Scene scene = MakeScene();
  const Image truth = Truth(scene, 65536);
  const double white = WhiteLevel(scene);
  for (const double max_error : {0.2, 0.05}) {
    const Image image = RenderImage(scene, Adaptive(max_error), nullptr);
    size_t brighter = 0, within = 0;
    double worst = 0;
    for (size_t c = 0; c < 3; ++c) {
      const std::vector<float>&a = image.channels[c].samples, &b = truth.channels[c].samples;
      for (size_t i = 0; i < b.size(); ++i) {
        if (!(b[i] > white)) continue;
        const double error = std::abs(double{a[i]} - b[i]);
        ++brighter;
        within += error <= max_error * white ? 1 : 0;
        worst = std::max(worst, error);
      }
    }
    CAPTURE(max_error, white, brighter, within, worst);
    CHECK(brighter > 50);
    CHECK(static_cast<double>(within) >= 0.95 * static_cast<double>(brighter));
  }
}

// By a power of two, so that all roundings are the same; nothing is near kDarkest.
TEST_CASE("what a picture costs does not depend on how bright it is") {
  const auto rendered = [](double brightness, RenderStats* stats) {
    Scene scene = MakeScene();
    scene.background *= brightness;
    std::get<PointLight>(scene.lights[0].kind).intensity *= brightness;
    std::get<DirectionalLight>(scene.lights[1].kind).irradiance *= brightness;
    scene.lights.push_back(Named("ambient", AmbientLight{Rgb(0.01) * brightness}));
    return RenderImage(scene, Adaptive(0.05), stats);
  };
  RenderStats dark, bright;
  const Image one = rendered(1 << 10, &dark), other = rendered(1 << 20, &bright);
  CHECK(dark.camera_rays == bright.camera_rays);
  CHECK(dark.unsettled_pixels == bright.unsettled_pixels);
  size_t wrong = 0;
  for (size_t i = 0; i < one.channels[0].samples.size(); ++i) {
    wrong += one.channels[0].samples[i] * 1024 == other.channels[0].samples[i] ? 0 : 1;
  }
  CHECK(wrong == 0);
}

TEST_CASE("a smaller error takes more samples") {
  uint64_t last = 0;
  for (const double max_error : {0.5, 0.1, 0.02}) {
    RenderStats stats;
    RenderImage(MakeScene(), Adaptive(max_error), &stats);
    CHECK(stats.camera_rays > last);
    last = stats.camera_rays;
  }
  // And never many more than are allowed.
  RenderSettings settings = Adaptive(1e-6);
  settings.max_samples = 32;
  RenderStats stats;
  const Scene scene = MakeScene();
  RenderImage(scene, settings, &stats);
  CHECK(stats.unsettled_pixels > 0);
  CHECK(stats.camera_rays <= (32u + 1) * 120 * 88);
}

TEST_CASE("the samples of pixels are counted as they are taken") {
  const Scene scene = MakeScene();
  RenderSettings settings = Adaptive(0.05);
  settings.max_samples = 100;
  RenderStats whole;
  RenderImage(scene, settings, &whole);
  const PixelSampleCounts& counts = whole.pixel_samples;
  CHECK(counts.pixels == 120 * 88);
  CHECK(counts.fewest == 0);
  CHECK(counts.most == 128);  // of 4, 8, 16, ... the first that is no less than was asked for
  // What is traced beside them: centres of pixels that then take samples, and hits that are sought.
  CHECK(counts.samples <= whole.camera_rays);
  CHECK(counts.samples + 2 * counts.pixels > whole.camera_rays);
  // Parts of the picture, which do not end where cells do, take what the whole takes there.
  PixelSampleCounts parts;
  for (const Window& part :
       {Window{0, 0, 120, 13}, Window{0, 13, 45, 88}, Window{45, 13, 120, 88}}) {
    settings.region = part;
    RenderStats stats;
    RenderImage(scene, settings, &stats);
    CHECK(stats.pixel_samples.pixels == part.pixel_count());
    parts.Add(stats.pixel_samples);
  }
  CHECK(parts.samples == counts.samples);
  CHECK(parts.fewest == counts.fewest);
  CHECK(parts.most == counts.most);
  // The middle of a smooth sphere: one sample each, at the centre.
  Scene smooth = OneSphere(LambertMaterial{Rgb(0.9)}, 120);
  smooth.lights = {Named("ambient", AmbientLight{Rgb(1, 1, 1)})};
  settings.region = {56, 40, 64, 48};
  RenderStats stats;
  RenderImage(smooth, settings, &stats);
  CHECK(stats.pixel_samples.samples == 64);
  CHECK(stats.pixel_samples.most == 1);
  RenderImage(smooth, {}, &stats);
  CHECK(stats.pixel_samples.samples == stats.pixel_samples.pixels * stats.pixel_samples.most);
  CHECK(stats.pixel_samples.fewest == static_cast<uint32_t>(smooth.image.spp));
}

TEST_CASE("a smooth picture stops at the pixels' centres") {
  Scene scene = MakeScene();
  scene.lights.resize(1);
  scene.lights[0].kind = PointLight{.position = {40, 50, 80}, .intensity = {9e3, 9e3, 9e3}};
  scene.spheres = {{{0, 0, 0}, 30, Add(&scene, LambertMaterial{{0.5, 0.5, 0.5}})}};
  scene.camera.position = {0, 0, 60};
  RenderStats stats;
  const Image image = RenderImage(scene, Adaptive(0.01), &stats);
  CHECK(stats.camera_rays == uint64_t{120} * 88);
  CHECK(ShareWithin(image, Truth(scene), 0.01) == 1);
  CHECK(image.channels[0].samples[44 * 120 + 60] > 0.05);
  // A highlight that its pixels resolve, but bends too much from one to the next.
  MetallicRoughnessMaterial metal{.metallic = 1, .roughness = 0.4};
  scene.spheres[0].material = Add(&scene, metal);
  RenderSettings settings = Adaptive(2e-5);
  settings.max_samples = 16;
  RenderImage(scene, settings, &stats);
  CHECK(stats.camera_rays > uint64_t{120} * 88);
}

TEST_CASE("shadows that fall between the pixels' centres are found") {
  Scene scene = MakeScene();
  scene.lights.resize(1);
  const Vec3d light(40, 50, 80);
  scene.lights[0].kind = PointLight{.position = light, .intensity = {9e3, 9e3, 9e3}};
  scene.spheres = {{{0, 0, 0}, 30, Add(&scene, LambertMaterial{{0.5, 0.5, 0.5}})}};
  scene.camera.position = {0, 0, 60};
  // Out of sight, each with a shadow of a third of a pixel's radius.
  constexpr int kShadows = 20;
  for (int i = 0; i < kShadows; ++i) {
    const Vec3d place = Vec3d(-6 + 0.61 * i, -3 + 1.37 * (i % 5), 30).normalized() * 30;
    scene.spheres.push_back({place + (light - place) * 0.4, 0.036, {0}});
  }
  const Image truth = Truth(scene);
  const Image image = RenderImage(scene, Adaptive(0.02), nullptr);
  scene.spheres.resize(1);
  const Image without = RenderImage(scene, {}, nullptr);
  int shadowed = 0, missed = 0;
  for (size_t i = 0; i < truth.channels[0].samples.size(); ++i) {
    const float wanted = truth.channels[0].samples[i];
    if (wanted > 0.9f * without.channels[0].samples[i]) continue;
    ++shadowed;
    missed += std::abs(image.channels[0].samples[i] - wanted) > 0.1f * wanted ? 1 : 0;
  }
  CHECK(shadowed >= kShadows);
  // A pixel's first 16 samples all miss a tenth of it in 1 of 5 cases, a third in 1 of 600.
  CHECK(missed <= shadowed / 4);
}

size_t CountCovered(const Image& image) {
  const std::vector<float>& covered = image.Find("A")->samples;
  return static_cast<size_t>(
      std::count_if(covered.begin(), covered.end(), [](float a) { return a > 0; }));
}

// Student's t with three degrees of freedom lies beyond four times its 95 % interval in 0.1 % of
// cases.
TEST_CASE("outlines that all samples of a pixel may miss are not forgotten") {
  Scene scene = MakeScene();
  scene.image.width = 240;
  scene.image.height = 176;
  for (const PixelFilter filter :
       {PixelFilter{FilterKind::kBox, 1}, PixelFilter{FilterKind::kGaussian, 3}}) {
    scene.image.filter = filter;
    const Image truth = Truth(scene);
    for (const double max_error : {0.05, 0.01}) {
      const Image image = RenderImage(scene, Adaptive(max_error), nullptr);
      const double pixels = static_cast<double>(truth.channels[0].samples.size());
      const double beyond = (1 - ShareWithin(image, truth, 4 * max_error)) * pixels;
      CAPTURE(static_cast<int>(filter.kind), max_error);
      CHECK(beyond < 0.001 * static_cast<double>(CountCovered(truth)));
    }
  }
}

// A sphere of one radiance everywhere, before a background of another.
TEST_CASE("pixels on an outline weigh what hits by the share that is covered") {
  Scene scene = OneSphere(LambertMaterial{Rgb(0.5)}, 120);
  scene.lights = {Named("ambient", AmbientLight{Rgb(1, 1, 1)})};
  scene.background = {0.125, 0.125, 0.125};  // a float
  const double of_sphere = 0.5;
  const double max_error = 0.02;
  const CameraFrame frame = MakeCameraFrame(scene.camera, 120, 120);
  const TraceSphere sphere{scene.spheres[0].center - scene.camera.position,
                           scene.spheres[0].radius};
  RenderSettings settings = Adaptive(max_error);
  settings.layers = {"Z", "id.object"};
  const Image image = RenderImage(scene, settings, nullptr);
  int partial = 0;
  for (int y = 0; y < 120; ++y) {
    for (int x = 0; x < 120; ++x) {
      const OutlineForm outline = MakeOutlineForm(frame, sphere, x + 0.5, y + 0.5);
      REQUIRE(IsGentlyCurved(outline));
      if (std::abs(outline.one) > 2 * std::hypot(outline.x, outline.y)) continue;
      const double share = CoveredShare(outline, 0.5);
      partial += share > 0 && share < 1 ? 1 : 0;
      const auto at = static_cast<size_t>(y * 120 + x);
      const double wanted = 0.125 + share * (of_sphere - 0.125);
      const double alpha = image.Find("A")->samples[at], red = image.Find("R")->samples[at];
      CAPTURE(x, y, share);
      // Floats below 1 are rounded by 3e-8, a share errs by 1e-8.
      CHECK(std::abs(alpha - share) < 5e-8);
      CHECK(std::abs(red - wanted) < 5e-8);
      // However little is covered, it is known what by.
      CHECK((image.Find("id.object")->samples[at] == 1) == (alpha > 0));
      CHECK((image.Find("Z")->samples[at] > 0) == (alpha > 0));
    }
  }
  CHECK(partial > 200);
}

double RootMeanSquare(const Image& image, const Image& truth) {
  const std::vector<float>&a = image.Find("R")->samples, &b = truth.Find("R")->samples;
  double sum = 0;
  for (size_t i = 0; i < a.size(); ++i) sum += (double{a[i]} - b[i]) * (double{a[i]} - b[i]);
  return std::sqrt(sum / static_cast<double>(a.size()));
}

// The edge of a bright sphere before black: its pixels stop far from what a black one wants.
TEST_CASE("a pixel that has converged keeps no neighbour going") {
  Scene scene = OneSphere(LambertMaterial{Rgb(0.9)});
  EnvironmentLight sky{.sky = ConstantSky{Rgb(1)}, .rotate_deg = 0, .background = false};
  scene.lights = {Named("sky", sky)};
  RenderSettings settings = Adaptive(0.5);
  settings.max_samples = 4096;
  RenderStats stats;
  RenderImage(scene, settings, &stats);
  CHECK(stats.unsettled_pixels == 0);
  // Outlines before a dark background, and all kinds of lobes.
  Scene grid = LoadScene(NACRE_SOURCE_DIR "/scenes/material_grid.json");
  grid.image.width = 480;
  grid.image.height = 270;
  settings.max_error = 0.03;
  RenderImage(grid, settings, &stats);
  CHECK(stats.unsettled_pixels == 0);
}

// The error of n samples falls as n^-3/4 at edges and as n^-3/2 where the picture is smooth: four
// replicates of a quarter of them have between 1.4 and 4 times that of all in one pattern (2.5
// here). Levels that are patterns of their own had 6: the first ones, of few samples, leave an
// error that falls as 1 / n.
TEST_CASE("samples to an error are as good as a pattern of as many") {
  Scene scene = MakeScene();
  scene.lights.resize(1);
  for (Material& material : scene.materials) material.model = LambertMaterial{Rgb(0.8)};
  scene.image.spp = 2048;
  const Image truth = Truth(scene, 16384), uniform = RenderImage(scene, {});
  RenderSettings settings = Adaptive(1e-9);
  settings.max_samples = 2048;
  const double ratio =
      RootMeanSquare(RenderImage(scene, settings), truth) / RootMeanSquare(uniform, truth);
  CAPTURE(ratio);
  CHECK(ratio < 4);
}

TEST_CASE("a block's bits depend on the scene and its place alone") {
  const Scene scene = MakeScene();
  RenderSettings settings = Adaptive(0.05);
  settings.layers = {"N", "Z", "id.object", "diffuse", "specular"};
  const Image whole = RenderImage(scene, settings, nullptr);
  SECTION("threads") {
    settings.threads = 1;
    CHECK(SameBits(RenderImage(scene, settings, nullptr), whole));
  }
  SECTION("intersectors") {
    settings.intersector = IntersectorChoice::kEmbree;
    CHECK(SameBits(RenderImage(scene, settings, nullptr), whole));
  }
  SECTION("layers") {
    const Image beauty = RenderImage(scene, Adaptive(0.05), nullptr);
    for (size_t c = 0; c < 4; ++c) CHECK(beauty.channels[c].samples == whole.channels[c].samples);
  }
  SECTION("crops") {
    // Edges that cut blocks, cells and strips.
    settings.region = {13, 7, 62, 81};
    const Image crop = RenderImage(scene, settings, nullptr);
    size_t wrong = 0;
    for (size_t c = 0; c < whole.channels.size(); ++c) {
      for (int y = settings.region.y0; y < settings.region.y1; ++y) {
        for (int x = settings.region.x0; x < settings.region.x1; ++x) {
          const auto in_crop = static_cast<size_t>(
              (y - settings.region.y0) * settings.region.width() + x - settings.region.x0);
          const auto in_whole = static_cast<size_t>(y * scene.image.width + x);
          wrong += crop.channels[c].samples[in_crop] != whole.channels[c].samples[in_whole];
        }
      }
    }
    CHECK(wrong == 0);
  }
}

TEST_CASE("meshes and targets sample to an error, too") {
  Scene scene = MakeScene();
  Mesh mesh{.positions = {{-2, -0.9, 1.5}, {-1, -0.9, 2}, {-1.5, 0.2, 1.4}},
            .triangles = {0, 1, 2},
            .material = {3}};
  scene.meshes.push_back(mesh);
  const Image truth = Truth(scene);
  ForEachTarget([&](Target) {
    CHECK(ShareWithin(RenderImage(scene, Adaptive(0.05), nullptr), truth, 0.05) >= 0.95);
  });
}

}  // namespace
}  // namespace nacre
