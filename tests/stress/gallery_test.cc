// SPDX-License-Identifier: Apache-2.0
// tests/stress/gallery_test.cc: the stability gallery, in small pictures, on every target; and that
// the comparison which judges it can fail.
#include "stress/gallery.h"

#include <cmath>
#include <limits>
#include <map>

#include "catch.h"
#include "render/render.h"
#include "targets.h"
#include "visibility/refine_kernel.h"

namespace nacre {
namespace {

constexpr int kWidth = 320;

Image Render(const Scene& scene, int threads = 0) {
  return RenderImage(scene, {.threads = threads, .layers = {"N", "Z", "id.object"}});
}

TEST_CASE("the stability gallery is right") {
  for (const GalleryScene& entry : GalleryScenes()) {
    CAPTURE(entry.name, entry.shows);
    const Scene scene = LoadGalleryScene(entry.name, kWidth);
    const TruthPicture truth = RenderTruth(scene);
    std::map<Products, Image> first;  // of the targets that make the same of products
    Image image;
    ForEachTarget([&](Target) {
      image = Render(scene);
      const Comparison c = Compare(scene, image, truth);
      CHECK(c.false_hits == 0);
      CHECK(c.false_misses == 0);
      CHECK(c.wrong_objects == 0);
      CHECK(c.not_finite == 0);
      CHECK(c.normal_error <= kNormalBound);
      CHECK(c.doubtful <= c.pixels / 10000);
      // A float's rounding, and one more for what led to it.
      CHECK(c.depth_error <= 2 * 0x1p-24);
      CHECK(c.of_bound <= 1);
      // On nothing else of the target do surfaces depend.
      const Image& like = first.try_emplace(TargetProducts(), image).first->second;
      for (const char* channel : {"N.X", "N.Y", "N.Z", "Z", "id.object"}) {
        const bool same = image.Find(channel)->samples == like.Find(channel)->samples;
        CHECK(same);
      }
    });
    const Image alone = Render(scene, 1);
    for (const Channel& channel : image.channels) {
      const bool same = channel.samples == alone.Find(channel.name)->samples;
      CHECK(same);
    }
  }
}

std::vector<float>& Samples(Image* image, const char* name) {
  return const_cast<Channel*>(image->Find(name))->samples;
}

TEST_CASE("the comparison finds what is wrong") {
  const Scene scene = LoadGalleryScene("planet", 96);
  const TruthPicture truth = RenderTruth(scene);
  const Image right = Render(scene);
  REQUIRE(Compare(scene, right, truth).GeometryHolds());
  REQUIRE(Compare(scene, right, truth).RadianceHolds());
  size_t ground = 0;  // a pixel that shows something
  while (truth.pixels[ground].object == 0 || truth.pixels[ground].doubt != kCertain) ++ground;
  const auto spoiled = [&](const char* channel, size_t pixel, float value) {
    Image image = right;
    Samples(&image, channel)[pixel] = value;
    return Compare(scene, image, truth);
  };
  CHECK(spoiled("id.object", 0, 1).false_hits == 1);
  CHECK(spoiled("id.object", ground, 0).false_misses == 1);
  CHECK(spoiled("id.object", ground, 9).wrong_objects == 1);
  CHECK(spoiled("R", 5, std::numeric_limits<float>::quiet_NaN()).not_finite == 1);
  CHECK(spoiled("B", 5, -1e-9f).not_finite == 1);
  const float normal = right.Find("N.Y")->samples[ground];
  CHECK(spoiled("N.Y", ground, normal + 4e-7f).normal_error > kNormalBound);
  const float green = right.Find("G")->samples[ground];
  CHECK_FALSE(spoiled("G", ground, green * (1 + 5e-5f)).RadianceHolds());
  const float depth = right.Find("Z")->samples[ground];
  CHECK(spoiled("Z", ground, depth * (1 + 1e-6f)).depth_error > 5e-7);
}

}  // namespace
}  // namespace nacre
