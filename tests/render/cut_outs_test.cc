// SPDX-License-Identifier: Apache-2.0
// Holes in meshes: the same pictures as of what is left, for every ray.
#include <algorithm>
#include <cmath>

#include "pictures.h"
#include "scene/validate.h"
#include "stage.h"
#include "targets.h"
#include "textured_scenes.h"

namespace nacre {
namespace {

constexpr int kTexels = 5;
bool IsSolid(int x, int y) { return (x + y) % 2 == 0; }

// A sheet with square holes, by its map.
Scene Masked(const Light& light) {
  Scene scene = StageScene({light});
  scene.image.spp = 16;
  const TextureId id =
      AddTexture(&scene, kTexels, kTexels, [](int x, int y) { return Rgb(IsSolid(x, y) ? 1 : 0); });
  Texture& texture = scene.textures[id.index];
  texture.mapping = MappingKind::kUv;
  texture.sampling.filter = TextureFilter::kNearest;
  scene.materials[1].opacity_map = id;
  scene.meshes.push_back(Sheet(1.5, -1.5, 1.5, -1.5, 1.5, {1}));
  return scene;
}

// What is left of it, piece by piece.
Scene Pieces(const Light& light) {
  Scene scene = StageScene({light});
  scene.image.spp = 16;
  const auto at = [](int i) { return -1.5 + 3.0 * i / kTexels; };
  for (int y = 0; y < kTexels; ++y) {
    for (int x = 0; x < kTexels; ++x) {
      if (!IsSolid(x, y)) continue;
      scene.meshes.push_back(Sheet(1.5, at(x), at(x + 1), at(y), at(y + 1), {1}));
    }
  }
  return scene;
}

TEST_CASE("a sheet with holes is its pieces: seen, lit and in the way of every light") {
  ForEachTarget([](Target target) {
    for (const Light& light : LightsAbove()) {
      CAPTURE(light.name);
      RenderSettings settings{.threads = 1};
      if (target != SupportedTargets().front()) settings.region = {15, 10, 45, 30};
      settings.layers = {"N", "P", "Z", "albedo"};
      const Image masked = RenderImage(Masked(light), settings);
      const Image pieces = RenderImage(Pieces(light), settings);
      REQUIRE(masked.channels.size() == pieces.channels.size());
      size_t holes = 0;
      for (size_t c = 0; c < masked.channels.size(); ++c) {
        CAPTURE(masked.channels[c].name);
        const auto &a = masked.channels[c].samples, &b = pieces.channels[c].samples;
        size_t differing = 0;
        for (size_t i = 0; i < a.size(); ++i) {
          // The corners' coordinates round differently: a few 2^-24 of results.
          const double scale = std::max({std::abs(double{a[i]}), std::abs(double{b[i]}), 1e-3});
          const bool same = a[i] == b[i] || std::abs(double{a[i]} - double{b[i]}) < 1e-6 * scale;
          differing += same ? 0 : 1;
        }
        CHECK(differing == 0);
      }
      // The test could fail: the sheet without holes is another picture.
      Scene whole = Masked(light);
      whole.materials[1].opacity_map = {};
      const Image solid = RenderImage(whole, settings);
      for (size_t i = 0; i < solid.data.pixel_count(); ++i) {
        const float difference = masked.Find("R")->samples[i] - solid.Find("R")->samples[i];
        holes += std::abs(difference) > 0.01f ? 1 : 0;
      }
      CHECK(holes > masked.data.pixel_count() / 20);
    }
  });
}

TEST_CASE("pictures with holes have the same bits by threads, tiles, intersectors and crops") {
  Scene scene = Masked(LightsAbove()[0]);
  for (const Light& light : LightsAbove()) {
    if (light.name != "point") scene.lights.push_back(light);
  }
  scene.textures[0].sampling.filter = TextureFilter::kTrilinear;
  RenderSettings settings{.threads = 1, .layers = {"all"}};
  const Image whole = RenderImage(scene, settings);
  settings.threads = 3;
  settings.tile_size = 7;
  for (const auto intersector : {IntersectorChoice::kAuto, IntersectorChoice::kEmbree}) {
    settings.intersector = intersector;
    CheckSameBits(RenderImage(scene, settings), whole);
  }
  settings.region = {13, 9, 47, 33};
  const Image part = RenderImage(scene, settings);
  for (int y = 9; y < 33; ++y) {
    for (int x = 13; x < 47; ++x) {
      const auto from = static_cast<size_t>((y - 9) * 34 + x - 13);
      const auto to = static_cast<size_t>(y * 60 + x);
      REQUIRE(part.Find("R")->samples[from] == whole.Find("R")->samples[to]);
    }
  }
}

// The share of a sheet that fills the picture which is there.
double ShareThere(const std::function<void(Scene*)>& change) {
  Scene scene;
  scene.image.width = scene.image.height = 64;
  scene.image.spp = 1;
  scene.camera.projection = Projection::kOrthographic;
  scene.camera.position = Vec3d(0, 5, 0);
  scene.camera.look_at = Vec3d(0, 0, 0);
  scene.camera.up = Vec3d(0, 0, 1);
  scene.camera.height = 2;
  scene.materials.emplace_back().model = LambertMaterial{};
  scene.meshes = {Sheet(0, -1, 1, -1, 1, {0})};
  change(&scene);
  const Image image = RenderImage(scene, {});
  double sum = 0;
  for (const float alpha : image.Find("A")->samples) sum += double{alpha};
  return sum / 4096;
}

// A ramp of 64 texels, i/63 at the i-th.
TextureId AddRamp(Scene* scene, TextureFilter filter) {
  const TextureId id = AddTexture(scene, 64, 1, [](int x, int) { return Rgb(x / 63.0); });
  Texture& texture = scene->textures[id.index];
  texture.mapping = MappingKind::kUv;
  texture.sampling.filter = filter;
  texture.sampling.wrap_u = Wrap::kClamp;
  return id;
}

TEST_CASE("the cutoff is against the opacity times its map times the vertices'") {
  CHECK(ShareThere([](Scene*) {}) == 1);
  CHECK(ShareThere([](Scene* s) { s->materials[0].opacity = 0.5; }) == 1);  // at the cutoff: there
  CHECK(ShareThere([](Scene* s) { s->materials[0].opacity = 0.49; }) == 0);
  CHECK(ShareThere([](Scene* s) { s->materials[0].opacity_cutoff = 1; }) == 1);
  CHECK(ShareThere([](Scene* s) { s->materials[0].opacity_cutoff = 1.5; }) == 0);
  for (const TextureFilter filter :
       {TextureFilter::kNearest, TextureFilter::kBilinear, TextureFilter::kTrilinear}) {
    const auto share = [&](double opacity, double cutoff) {
      return ShareThere([&](Scene* s) {
        s->materials[0].opacity_map = AddRamp(s, filter);
        s->materials[0].opacity = opacity;
        s->materials[0].opacity_cutoff = cutoff;
      });
    };
    // Pixels are as wide as texels, their centres the texels'.
    CHECK(share(1, 0.5) == 0.5);                    // from 32/63 on
    CHECK(share(1, Held(21.0 / 63)) == 43.0 / 64);  // the texel at the cutoff is there
    CHECK(share(0.5, 0.25) == 0.5);
    CHECK(share(1, 0) == 1);
  }
  const auto by_vertices = [](Scene* s) { s->meshes[0].opacities = {0, 1, 1, 0}; };
  CHECK(ShareThere(by_vertices) == 0.5);
  CHECK(ShareThere([&](Scene* s) {
          by_vertices(s);
          s->materials[0].opacity = 0.8;  // x from 5/8 of the way on
        }) == 24.0 / 64);
}

TEST_CASE("holes are those of the image itself, however small it is seen") {
  // A checker of single texels: its mean, half, would be there all over.
  const auto share = [](TextureFilter filter) {
    return ShareThere([&](Scene* s) {
      const TextureId id = AddTexture(s, 64, 64, [](int x, int y) { return Rgb((x + y) % 2); });
      s->textures[id.index].mapping = MappingKind::kUv;
      s->textures[id.index].sampling.filter = filter;
      s->textures[id.index].scale = Vec2d(10.5, 10.5);
      s->materials[0].opacity_map = id;
      s->materials[0].opacity_cutoff = 0.51;
    });
  };
  // A pixel is 10.5 texels wide: the grid of centres meets every part of a texel evenly.
  CHECK(share(TextureFilter::kNearest) == Approx(0.5).margin(0.03));
  CHECK(share(TextureFilter::kTrilinear) == Approx(0.5).margin(0.05));
}

TEST_CASE("holes by other mappings and second coordinates") {
  const auto planar = [](Scene* s) {
    s->materials[0].opacity_map = AddRamp(s, TextureFilter::kNearest);
    s->textures[0].mapping = MappingKind::kPlanar;
    s->textures[0].center = Vec3d(0, 3, 0);
  };
  CHECK(ShareThere(planar) == 0.5);
  CHECK(ShareThere([&](Scene* s) {
          planar(s);
          s->textures[0].size = 0.5;  // the ramp over the middle half
        }) == 0.5);
  const auto second = [](Scene* s) {
    s->materials[0].opacity_map = AddRamp(s, TextureFilter::kNearest);
    s->textures[0].second_uvs = true;
    s->meshes[0].second_uvs = {{0, 0}, {0.5, 0}, {0.5, 1}, {0, 1}};
  };
  CHECK(ShareThere(second) == 0);
}

TEST_CASE("a mesh without normals of its own is seen through its holes from either side") {
  const auto share = [](double side) {
    return ShareThere([&](Scene* s) {
      s->materials[0].opacity_map = AddRamp(s, TextureFilter::kNearest);
      s->camera.position = Vec3d(0, 5 * side, 0);
    });
  };
  CHECK(share(1) == 0.5);
  CHECK(share(-1) == 0.5);
}

TEST_CASE("spheres and splits have no holes, and say so") {
  Scene scene = Masked(LightsAbove()[0]);
  CHECK(Validate(scene).empty());
  Scene ball = scene;
  ball.spheres[0].material = {1};
  CHECK(Validate(ball).size() == 1);
  Scene split = scene;
  split.materials.emplace_back().model = SplitMaterial{{0.5}, {{0}, {1}}};
  split.meshes[0].material = {2};
  CHECK(Validate(split).size() == 1);
}

}  // namespace
}  // namespace nacre
