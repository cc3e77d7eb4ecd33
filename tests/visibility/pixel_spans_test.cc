// SPDX-License-Identifier: Apache-2.0
// tests/visibility/pixel_spans_test.cc: no sample outside of a sphere's spans hits it.
#include <cmath>

#include "catch.h"
#include "targets.h"
#include "visibility/rays.h"
#include "visibility/sphere_bins.h"
#include "visibility/tile_kernel.h"

namespace nacre {
namespace {

constexpr int kWidth = 64, kHeight = 48;

// A perspective camera at the origin with a random orientation; `tangent` is that of half its
// vertical field of view.
CameraFrame RandomFrame(Random* random, double tangent) {
  CameraFrame frame;
  frame.projection = Projection::kPerspective;
  frame.forward = random->Direction();
  const Vec3d right = frame.forward.cross(random->Direction()).normalized();
  const double pixel = 2 * tangent / kHeight;
  frame.step_x = right * pixel;
  frame.step_y = frame.forward.cross(right) * pixel;
  frame.corner = frame.forward - (frame.step_x * kWidth + frame.step_y * kHeight) / 2;
  return frame;
}

Vec3d Through(const CameraFrame& frame, double x, double y) {
  return frame.corner + frame.step_x * x + frame.step_y * y;
}

// A sphere that projects to a point on or near the film, of a size from a hundredth of a pixel to
// the whole film.
Sphere RandomSphere(const CameraFrame& frame, double tangent, Random* random) {
  const double distance = random->Magnitude(1e-3, 1e6);
  const double x = random->Uniform(-10, kWidth + 10);
  const double y = random->Uniform(-10, kHeight + 10);
  return MakeSphere(Through(frame, x, y) * distance,
                    distance * tangent * random->Magnitude(2e-4, 1));
}

bool Hits(const Sphere& sphere, const Vec3d& direction) {
  return TestSphere(sphere.center, direction, sphere.radius).hit;
}

// Checks every pixel's samples against the spans of its tile; returns how many pixels these have.
size_t CheckSpans(const CameraFrame& frame, const Scene& scene, double margin, const Window& tile,
                  const TileCandidates& candidates) {
  std::vector<const PixelSpan*> of_pixel(tile.pixel_count());
  size_t pixels = 0;
  for (const PixelSpan& span : candidates.spans) {
    REQUIRE(span.first + span.count <= tile.pixel_count());
    REQUIRE(span.first / kWidth == (span.first + span.count - 1) / kWidth);
    for (uint32_t i = 0; i < span.count; ++i) of_pixel[span.first + i] = &span;
    pixels += span.count;
  }
  size_t wrong = 0;
  for (size_t i = 0; i < of_pixel.size(); ++i) {
    const double x = tile.x0 + static_cast<double>(i % kWidth);
    const double y = tile.y0 + static_cast<double>(i / kWidth);
    const PixelSpan* const span = of_pixel[i];
    if (span != nullptr && span->single_sphere == nullptr) continue;
    for (int k = 0; k < 25; ++k) {
      const double right = k % 5 / 4.0, down = k / 5 / 4.0;  // from 0 to 1
      const Vec3d direction = Through(frame, x - margin + right * (1 + 2 * margin),
                                      y - margin + down * (1 + 2 * margin));
      for (uint32_t s = 0; s < scene.spheres.size(); ++s) {
        const bool allowed = span != nullptr && span->single_sphere->primitive == s;
        wrong += !allowed && Hits(scene.spheres[s], direction) ? 1 : 0;
      }
    }
  }
  CHECK(wrong == 0);
  return pixels;
}

// Spheres in front of a camera with a random orientation; returns the number of pixels in spans.
size_t CheckRandomSpheres(double tangent, int round, Random* random) {
  const CameraFrame frame = RandomFrame(random, tangent);
  constexpr double kMargins[] = {0, 1.5, kPixelCenterMargin};
  const double margin = kMargins[round % 3];
  Scene scene;
  for (int i = 0; i < 1 + round % 11; ++i) {
    scene.spheres.push_back(RandomSphere(frame, tangent, random));
  }
  Intersector intersector(scene, Vec3d(0), {.tree = false});
  REQUIRE(intersector.BinForCamera(frame, {0, 0, kWidth, kHeight}, margin));
  CAPTURE(round, tangent);
  size_t pixels = 0;
  ForEachTarget([&](Target) {
    for (int y = 0; y < kHeight; y += kCellSize) {
      const Window tile{0, y, kWidth, y + kCellSize};
      TileCandidates candidates;
      intersector.EnterTile(tile, TileRays::kSamples, &candidates);
      pixels += CheckSpans(frame, scene, margin, tile, candidates);
    }
  });
  return pixels;
}

TEST_CASE("no sample outside a sphere's span hits it") {
  Random random(21);
  size_t pixels = 0;
  for (int round = 0; round < 80; ++round) {
    pixels += CheckRandomSpheres(random.Magnitude(1e-6, 10), round, &random);
  }
  CHECK(pixels > 10000);  // enough to matter
}

// The pixels' width is a few, or a few thousand, rounding errors of a direction of length 1.
TEST_CASE("nor under a lens of a billionth of a degree and less") {
  Random random(23);
  size_t pixels = 0;
  for (int round = 0; round < 40; ++round) {
    pixels += CheckRandomSpheres(random.Magnitude(1e-14, 1e-11), round, &random);
  }
  CHECK(pixels > 10000);  // enough to matter
}

// The near end of its outline is in the picture, the far end up to a billion pixels away.
TEST_CASE("a sphere that nearly touches the camera's plane has whole spans") {
  constexpr int kSide = 4000;
  CameraFrame frame;
  frame.projection = Projection::kPerspective;
  frame.forward = {0, 0, -1};
  frame.step_x = {0.5358983848622454 / kSide, 0, 0};  // 30 degrees
  frame.step_y = {0, -0.5358983848622454 / kSide, 0};
  frame.corner = frame.forward - (frame.step_x + frame.step_y) * (kSide / 2.0);
  for (const double gap : {1e-7, 1.1e-6, 1e-5, 1e-4, 1e-3}) {
    Scene scene;
    scene.spheres = {MakeSphere({0.75, 0.75, -(1 + gap)}, 1)};
    Intersector intersector(scene, Vec3d(0), {.tree = false});
    REQUIRE(intersector.BinForCamera(frame, {0, 0, kSide, kSide}, 0));
    CAPTURE(gap);
    size_t pixels = 0;
    for (int y = 1664; y < 1712; y += kCellSize) {
      for (int x = 2240; x < 2400; x += kWidth) {  // about (2311, 1689)
        const Window tile{x, y, x + kWidth, y + kCellSize};
        TileCandidates candidates;
        if (!intersector.EnterTile(tile, TileRays::kSamples, &candidates)) continue;
        pixels += CheckSpans(frame, scene, 0, tile, candidates);
      }
    }
    CHECK(pixels > 1000);
  }
}

// The spans of a sphere in front of the camera hold only pixels that the outline covers. Compared
// with the outline at the middle of a row's height they extend by less than a pixel at either end,
// except in the rows at its top and bottom.
TEST_CASE("a sphere's spans are no wider than its outline") {
  Random random(22);
  for (int round = 0; round < 40; ++round) {
    const bool centers = round % 2 == 1;
    const CameraFrame frame = RandomFrame(&random, 1);
    Scene scene;
    scene.spheres = {MakeSphere(Through(frame, 30.3, 24.2) * 5, 1.1)};
    Intersector intersector(scene, Vec3d(0), {.tree = false});
    const double margin = centers ? kPixelCenterMargin : 0;
    REQUIRE(intersector.BinForCamera(frame, {0, 0, kWidth, kHeight}, margin));
    for (int y = 0; y < kHeight; y += kCellSize) {
      TileCandidates candidates;
      intersector.EnterTile({0, y, kWidth, y + kCellSize}, TileRays::kSamples, &candidates);
      for (const PixelSpan& span : candidates.spans) {
        REQUIRE(span.single_sphere != nullptr);
        const auto row = y + static_cast<int>(span.first / kWidth);
        uint32_t hit = 0;
        for (uint32_t i = 0; i < span.count; ++i) {
          bool any = false;
          for (int k = 0; k < 64 && !any; ++k) {
            const double right = centers ? 0.5 : k % 8 / 7.0, down = centers ? 0.5 : k / 8 / 7.0;
            any =
                Hits(scene.spheres[0], Through(frame, span.first % kWidth + i + right, row + down));
          }
          hit += any ? 1 : 0;
        }
        CAPTURE(row, span.count, hit);
        // Allows for corners between the 64 points, and for the outline's margin.
        CHECK(span.count <= hit + (centers ? 1 : 2));
      }
    }
  }
}

}  // namespace
}  // namespace nacre
