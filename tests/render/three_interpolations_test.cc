// SPDX-License-Identifier: Apache-2.0
// tests/render/three_interpolations_test.cc: the picture of flat, Gouraud and Phong shading side by
// side: the same faces and light, and the nearer to the sphere the more is done per pixel.
#include <algorithm>
#include <cmath>
#include <set>

#include "catch.h"
#include "render/render.h"
#include "scene_io/load_scene.h"

namespace nacre {
namespace {

constexpr int kApart = 260;  // pixels between neighbours: 2.6 of 6 units over 600 rows

// One of the three thirds, about its sphere, which fills 250 pixels.
struct Third {
  const Image& image;
  int third;

  double At(const char* channel, int x, int y) const {
    const int column = 400 + (third - 1) * kApart + x, row = 300 + y;
    return image.Find(channel)
        ->samples[static_cast<size_t>(row) * 800 + static_cast<size_t>(column)];
  }
};

constexpr int kHalf = 126;

template <class Body>
void ForEachPixel(const Body& body) {
  for (int y = -kHalf; y < kHalf; ++y) {
    for (int x = -kHalf; x < kHalf; ++x) body(x, y);
  }
}

// The root of the mean square of the difference from the sphere, and the largest.
struct Apart {
  double rms, worst;
};

Apart FromSphere(const Third& mesh, const Third& sphere) {
  double squares = 0, count = 0, worst = 0;
  ForEachPixel([&](int x, int y) {
    if (mesh.At("A", x, y) < 1 || sphere.At("A", x, y) < 1) return;
    const double difference = mesh.At("G", x, y) - sphere.At("G", x, y);
    squares += difference * difference;
    worst = std::max(worst, std::abs(difference));
    count += 1;
  });
  REQUIRE(count > 40000);
  return {std::sqrt(squares / count), worst};
}

TEST_CASE("flat, Gouraud and Phong in one picture of 800 by 600") {
  Scene scene = LoadScene(NACRE_SOURCE_DIR "/scenes/flat_gouraud_phong.json");
  REQUIRE(scene.image.width == 800);
  REQUIRE(scene.image.height == 600);
  REQUIRE(scene.meshes.size() == 3);
  CHECK(scene.meshes[0].interpolation == Interpolation::kFlat);
  CHECK(scene.meshes[1].interpolation == Interpolation::kGouraud);
  CHECK(scene.meshes[2].interpolation == Interpolation::kPhong);
  scene.image.spp = 1;
  const Image meshes = RenderImage(scene, {});
  Scene round = scene;
  round.meshes.clear();
  for (const double x : {-2.6, 0.0, 2.6}) round.spheres.push_back({Vec3d(x, 0, 0), 1.25, {0}});
  const Image spheres = RenderImage(round, {});
  std::set<double> colors[3];
  int different = 0;
  ForEachPixel([&](int x, int y) {
    for (int i = 0; i < 3; ++i) {
      const Third third{meshes, i};
      // One outline: the places differ by whole pixels, and by a rounding of 2.6.
      different += third.At("A", x, y) != Third{meshes, 1}.At("A", x, y) ? 1 : 0;
      if (third.At("A", x, y) == 1) colors[i].insert(third.At("G", x, y));
    }
  });
  CHECK(different <= 10);
  // Half of 320 faces, more or less, are towards the camera: one colour each.
  CHECK(colors[0].size() > 80);
  CHECK(colors[0].size() <= 200);
  CHECK(colors[1].size() > 5000);
  CHECK(colors[2].size() > 5000);
  const Apart flat = FromSphere({meshes, 0}, {spheres, 0});
  const Apart gouraud = FromSphere({meshes, 1}, {spheres, 1});
  const Apart phong = FromSphere({meshes, 2}, {spheres, 2});
  CAPTURE(flat.rms, gouraud.rms, phong.rms, flat.worst, gouraud.worst, phong.worst);
  CHECK(phong.rms < gouraud.rms / 2);
  CHECK(gouraud.rms < 0.9 * flat.rms);  // a highlight of few vertices is most of both
  CHECK(phong.worst < gouraud.worst);
  CHECK(gouraud.worst < flat.worst);
}

}  // namespace
}  // namespace nacre
