// SPDX-License-Identifier: Apache-2.0
// tests/render/outline_coverage_test.cc: the share of a pixel that a sphere covers.
#include "render/outline_coverage.h"

#include <cmath>
#include <numbers>
#include <random>

#include "catch.h"
#include "render/camera.h"
#include "scene/scene.h"

namespace nacre {
namespace {

struct View {
  CameraFrame frame;
  TraceSphere sphere;  // from the camera
};

// Spheres of some tens to some hundreds of pixels, off the film's middle, near and far.
View MakeView(Projection projection, std::mt19937* random) {
  std::uniform_real_distribution<double> uniform(0, 1);
  Scene scene;
  scene.image.width = 640;
  scene.image.height = 480;
  scene.camera.position = {0, 0, 0};
  scene.camera.look_at = {uniform(*random) - 0.5, uniform(*random) - 0.5, -1};
  scene.camera.projection = projection;
  scene.camera.fov_y_deg = 20 + 60 * uniform(*random);
  scene.camera.height = 2;
  View view{MakeCameraFrame(scene.camera, scene.image.width, scene.image.height), {}};
  const double distance = std::pow(10.0, 8 * uniform(*random) - 2);
  const double x = 640 * uniform(*random), y = 480 * uniform(*random);
  const CameraFrame& frame = view.frame;
  const Vec3d own = frame.corner + frame.step_x * x + frame.step_y * y;
  if (projection == Projection::kPerspective) {
    view.sphere = {own.normalized() * distance, distance * (0.04 + 0.5 * uniform(*random))};
  } else {
    view.sphere = {own + frame.forward * distance, 0.05 + uniform(*random)};
  }
  return view;
}

// How far the ray passes from the sphere's centre, in radii.
double Beside(const View& view, double x, double y) {
  const CameraFrame& frame = view.frame;
  const Vec3d own = frame.corner + frame.step_x * x + frame.step_y * y;
  const bool perspective = frame.projection == Projection::kPerspective;
  const Vec3d direction = perspective ? own : frame.forward;
  const Vec3d to_center = perspective ? view.sphere.center : view.sphere.center - own;
  return to_center.cross(direction).length() / (direction.length() * view.sphere.radius);
}

bool Hits(const View& view, double x, double y) { return Beside(view, x, y) <= 1; }

// By columns, or by rows where the outline is closer to these, in each of which the outline is
// found by bisection: it crosses each once at most.
double ShareByLines(const View& view, double x, double y, double reach) {
  constexpr int kLines = 2000;
  const double change_x = Beside(view, x + 0.1, y) - Beside(view, x - 0.1, y);
  const double change_y = Beside(view, x, y + 0.1) - Beside(view, x, y - 0.1);
  const bool by_columns = std::abs(change_y) > std::abs(change_x);
  double sum = 0;
  for (int i = 0; i < kLines; ++i) {
    const double line = reach * (2 * (i + 0.5) / kLines - 1);
    const auto hits = [&](double place) {
      return (by_columns ? Beside(view, x + line, y + place) : Beside(view, x + place, y + line)) <=
             1;
    };
    double low = -reach, high = reach;
    const bool at_low = hits(low), at_high = hits(high);
    if (at_low == at_high) {
      sum += at_low ? 1 : 0;
      continue;
    }
    for (int k = 0; k < 40; ++k) {
      const double middle = (low + high) / 2;
      (hits(middle) == at_low ? low : high) = middle;
    }
    const double below = (low + reach) / (2 * reach);
    sum += at_low ? below : 1 - below;
  }
  return sum / kLines;
}

// Places on the film that the outline passes closely.
template <class Take>
void VisitOutlines(Projection projection, const Take& take) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> uniform(-0.7, 0.7);
  for (int i = 0; i < 300; ++i) {
    const View view = MakeView(projection, &random);
    // From the middle of the picture outward until the ray misses.
    const OutlineForm form = MakeOutlineForm(view.frame, view.sphere, 320, 240);
    if (!IsGentlyCurved(form)) continue;
    const double determinant = form.xx * form.yy - form.xy * form.xy;
    const double middle_x = 320 + (form.y * form.xy - form.x * form.yy) / determinant;
    const double middle_y = 240 + (form.x * form.xy - form.y * form.xx) / determinant;
    REQUIRE(Hits(view, middle_x, middle_y));
    const double angle = 2 * std::numbers::pi * i / 300;
    double inside = 0, outside = 1e7;
    for (int k = 0; k < 60; ++k) {
      const double middle = (inside + outside) / 2;
      const bool hits =
          Hits(view, middle_x + std::cos(angle) * middle, middle_y + std::sin(angle) * middle);
      (hits ? inside : outside) = middle;
    }
    take(view, middle_x + std::cos(angle) * inside + uniform(random),
         middle_y + std::sin(angle) * inside + uniform(random));
  }
}

// Lines are wrong by less than 1e-6 together: the outline's slope is less than 2 and its bend less
// than 1, by 2 / 2000^2 each where it enters or leaves the square, by less elsewhere.
TEST_CASE("the covered share of a pixel is that of its lines") {
  for (const Projection projection : {Projection::kPerspective, Projection::kOrthographic}) {
    int count = 0, partial = 0;
    VisitOutlines(projection, [&](const View& view, double x, double y) {
      for (const double reach : {0.5, 0.2}) {
        const OutlineForm outline = MakeOutlineForm(view.frame, view.sphere, x, y);
        if (!IsGentlyCurved(outline)) continue;
        const double share = CoveredShare(outline, reach);
        CAPTURE(x, y, reach, view.sphere.center.length(), view.sphere.radius);
        CHECK(std::abs(share - ShareByLines(view, x, y, reach)) < 1e-6);
        ++count;
        partial += share > 0 && share < 1 ? 1 : 0;
      }
    });
    CHECK(count > 300);
    CHECK(partial > count / 3);
  }
}

// An ellipse's area is pi g / sqrt(determinant), g the value in its middle. Each of its pixels may
// err by 1e-8.
TEST_CASE("the covered shares of all pixels add up to the ellipse") {
  std::mt19937 random(6);
  for (const Projection projection : {Projection::kPerspective, Projection::kOrthographic}) {
    int count = 0;
    for (int i = 0; i < 20; ++i) {
      const View view = MakeView(projection, &random);
      const OutlineForm f = MakeOutlineForm(view.frame, view.sphere, 320, 240);
      if (!IsGentlyCurved(f)) continue;
      const double determinant = f.xx * f.yy - f.xy * f.xy;
      const double x = 320 + (f.y * f.xy - f.x * f.yy) / determinant;
      const double y = 240 + (f.x * f.xy - f.y * f.xx) / determinant;
      const OutlineForm middle = MakeOutlineForm(view.frame, view.sphere, x, y);
      const double half_x = std::sqrt(-middle.one * f.yy / determinant) + 1;
      const double half_y = std::sqrt(-middle.one * f.xx / determinant) + 1;
      if (half_x * half_y > 1e6) continue;
      double sum = 0;
      int on_outline = 0;
      for (double py = std::floor(y - half_y); py <= y + half_y; ++py) {
        for (double px = std::floor(x - half_x); px <= x + half_x; ++px) {
          int corners = 0;
          for (const double dx : {0.0, 1.0}) {
            for (const double dy : {0.0, 1.0}) corners += Hits(view, px + dx, py + dy) ? 1 : 0;
          }
          const OutlineForm form = MakeOutlineForm(view.frame, view.sphere, px + 0.5, py + 0.5);
          // How far off the outline is, but for its bend.
          const double off = std::abs(form.one) / (2 * std::hypot(form.x, form.y));
          if (off > 1) {
            sum += corners == 4 ? 1 : 0;
            continue;
          }
          sum += CoveredShare(form, 0.5);
          ++on_outline;
        }
      }
      CAPTURE(x, y, half_x, half_y);
      const double area = std::numbers::pi * middle.one / std::sqrt(determinant);
      CHECK(std::abs(sum - area) < 1e-8 * on_outline + 1e-12 * area);
      ++count;
    }
    CHECK(count >= 5);
  }
}

TEST_CASE("outlines that bend much are told from those that do not") {
  Scene scene;
  scene.image.width = 200;
  scene.image.height = 200;
  scene.camera.projection = Projection::kOrthographic;
  scene.camera.height = 200;  // a unit is a pixel
  scene.camera.position = {0, 0, 10};
  const CameraFrame frame = MakeCameraFrame(scene.camera, scene.image.width, scene.image.height);
  CHECK(IsGentlyCurved(MakeOutlineForm(frame, {{0, 0, -10}, 8.1}, 50, 60)));
  CHECK_FALSE(IsGentlyCurved(MakeOutlineForm(frame, {{0, 0, -10}, 7.9}, 50, 60)));
}

}  // namespace
}  // namespace nacre
