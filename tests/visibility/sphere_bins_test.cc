// SPDX-License-Identifier: Apache-2.0
// tests/visibility/sphere_bins_test.cc: spheres binned for camera rays: boxes by the SIMD kernel,
// and bins that follow spheres that change.
#include "visibility/sphere_bins.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "catch.h"
#include "targets.h"
#include "visibility/rays.h"

namespace nacre {
namespace {

template <class T>
std::vector<T> Copy(const HugeArray<T>& array) {
  return {array.begin(), array.end()};
}

TEST_CASE("bins of spheres that have changed are those that are made anew") {
  Random random(71);
  Scene scene = RandomSpheres(&random, 500);
  const Vec3d eye(0.1, 0, 0.3);
  CameraFrame frame;  // along -z
  frame.projection = GENERATE(Projection::kPerspective, Projection::kOrthographic);
  frame.forward = {0, 0, -1};
  const double pixel = frame.projection == Projection::kPerspective ? 0.01 : 0.04;
  frame.step_x = {pixel, 0, 0};
  frame.step_y = {0, -pixel, 0};
  frame.corner = frame.forward - (frame.step_x * 200 + frame.step_y * 100) / 2;
  const Window window{16, 0, 150, 90};
  const double margin = GENERATE(kPixelCenterMargin, 1.5);
  TraceGeometry geometry = MakeTraceGeometry(scene, eye);
  SphereBins bins;
  REQUIRE(BinSpheres(geometry, frame, window, margin, 1u << 20, 2, &bins));
  size_t changes = 0, inside = 0;
  for (int step = 0; step < 60; ++step) {
    // One or more, some of which come in view or leave it, or lie about the camera.
    const int count = step % 4 == 0 ? 5 : 1;
    for (int i = 0; i < count; ++i) {
      const auto k = static_cast<size_t>(random.Uniform(0, 500));
      scene.spheres[k] = MakeSphere(random.InBox({-6, -4, -7}, {6, 4, 2}),
                                    random.Magnitude(0.01, step % 10 == 0 ? 3 : 0.3));
    }
    if (step == 30 || step == 40) {
      scene.spheres[7] = MakeSphere(eye + Vec3d(0.2, 0, 0), step == 30 ? 0.25 : 0.15);
    }
    const auto changed = ChangeSpheres(scene, 8, 2, &geometry);
    REQUIRE(changed);
    const std::vector<uint32_t> before = Copy(bins.spheres);
    if (step == 0) REQUIRE_FALSE(ChangeBins(*changed, before.size() / 2, &bins));
    REQUIRE(ChangeBins(*changed, 1u << 20, &bins));
    changes += Copy(bins.spheres) != before ? 1 : 0;
    SphereBins fresh;
    REQUIRE(BinSpheres(MakeTraceGeometry(scene, eye), frame, window, margin, 1u << 20, 1, &fresh));
    REQUIRE(bins.end == fresh.end);
    REQUIRE(Copy(bins.spheres) == Copy(fresh.spheres));
    REQUIRE(Copy(bins.pixel_rows) == Copy(fresh.pixel_rows));
    REQUIRE(geometry.extent == MakeTraceGeometry(scene, eye).extent);
    REQUIRE(geometry.eye_outside == MakeTraceGeometry(scene, eye).eye_outside);
    inside += geometry.eye_outside ? 0 : 1;
  }
  CHECK(changes > 20);
  CHECK(inside > 0);
  CHECK(inside < 60);
}

// What overlaps the bounds of Project: the twin of the kernel.
SphereBox::Range Overlapped(double low, double high, int begin, int size, int count) {
  const double first = std::max((low - begin) / size, 0.0);
  const double last = std::min((high - begin) / size, count - 1.0);
  if (!(last >= 0 && first < count)) return {1, 0};
  return {static_cast<uint16_t>(first), static_cast<uint16_t>(last)};
}

TEST_CASE("boxes of spheres are those of their projections on every target") {
  Random random(72);
  const auto projection = GENERATE(Projection::kPerspective, Projection::kOrthographic);
  const double pixel = GENERATE(1e-9, 0.01, 0.3);  // of slope, or of length
  const Window window = GENERATE(Window{16, 0, 150, 90}, Window{0, 32, 16, 48});
  const double margin = GENERATE(kPixelCenterMargin, 0.0, 1.5);
  const Vec3d forward = random.Direction();  // so that no product is one with 0 or 1
  const Vec3d right = forward.cross(random.Direction()).normalized();
  const Vec3d down = forward.cross(right);
  std::vector<TraceSphere> spheres(1001);  // of no multiple of a vector
  for (TraceSphere& sphere : spheres) {
    const double depth = random.Magnitude(1e-3, 1e6);
    const auto across = [&] { return random.Uniform(-150, 300) * pixel * depth; };
    sphere.center = right * across() + down * across() + forward * depth;
    sphere.radius = depth * random.Magnitude(1e-6, 10);
    if (random.Uniform(0, 1) < 0.2) sphere.center = random.InBox({-2, -2, -2}, {2, 2, 2});
    // It touches the camera's plane.
    if (random.Uniform(0, 1) < 0.1) sphere.radius = std::abs(sphere.center.dot(forward));
  }
  SphereBins made;
  CameraFrame frame;
  frame.projection = projection;
  frame.forward = forward;
  frame.step_x = right * pixel;
  frame.step_y = down * pixel;
  frame.corner = frame.forward - (frame.step_x * 166 + frame.step_y * 96) / 2;
  REQUIRE(BinSpheres({}, frame, window, margin, 1u << 20, 1, &made));
  std::vector<SphereBox> expected;
  for (const TraceSphere& sphere : spheres) {
    const ProjectedBounds b = Project(made.projector, sphere);
    expected.push_back({{1, 0}, {1, 0}});
    if (!b.visible) continue;
    expected.back() = {Overlapped(b.x0 - margin, b.x1 + margin, window.x0, kCellSize, made.columns),
                       Overlapped(b.y0 - margin, b.y1 + margin, window.y0, 1, window.height())};
  }
  // Counted once, whatever targets there are: most spheres are beside one of the windows.
  CHECK(std::count_if(expected.begin(), expected.end(), [](const SphereBox& box) {
          return box.columns.first <= box.columns.last && box.rows.first <= box.rows.last;
        }) >= 30);
  ForEachTarget([&](Target) {
    std::vector<SphereBox> boxes(spheres.size());
    FindBoxes(made, spheres.data(), spheres.size(), boxes.data());
    for (size_t i = 0; i < spheres.size(); ++i) {
      INFO(i);
      REQUIRE(boxes[i].columns.first == expected[i].columns.first);
      REQUIRE(boxes[i].columns.last == expected[i].columns.last);
      REQUIRE(boxes[i].rows.first == expected[i].rows.first);
      REQUIRE(boxes[i].rows.last == expected[i].rows.last);
    }
  });
}

}  // namespace
}  // namespace nacre
