// SPDX-License-Identifier: Apache-2.0
// tests/render/sphere_projections_test.cc: which outlines a part of the film may see.
#include "render/sphere_projections.h"

#include <cmath>
#include <initializer_list>

#include "catch.h"
#include "render/camera.h"

namespace nacre {
namespace {

// 200 x 200 pixels, a unit each, or in perspective a fiftieth of a unit at distance 1.
CameraFrame Frame(Projection projection) {
  Camera camera{.projection = projection,
                .position = {0, 0, 10},
                .fov_y_deg = 2 * std::atan(2.0) * 180 / std::acos(-1.0),
                .height = 200};
  return MakeCameraFrame(camera, 200, 200);
}

TileCandidates Candidates(std::initializer_list<TraceSphere> spheres) {
  TileCandidates candidates;
  std::vector<TileCandidate>& cell = candidates.cells.emplace_back();
  for (const TraceSphere& sphere : spheres) {
    TileCandidate& candidate = cell.emplace_back();
    candidate.sphere = sphere;
    candidate.around_camera = sphere.center.length() < sphere.radius;
  }
  return candidates;
}

VisibleOutlines Around(const CameraFrame& frame, const TileCandidates& candidates, double x,
                       double y) {
  const auto projections = ProjectSpheres(frame, candidates);
  REQUIRE(projections);
  return FindVisibleOutlines(frame, *projections, x, y, 0.5);
}

TEST_CASE("outlines are seen where they are") {
  for (const Projection projection : {Projection::kPerspective, Projection::kOrthographic}) {
    const CameraFrame frame = Frame(projection);
    CAPTURE(static_cast<int>(projection));
    const bool perspective = projection == Projection::kPerspective;
    const TraceSphere near{{0, 0, -50}, 15};
    const double edge = 100 + (perspective ? 50 * 15 / std::sqrt(50.0 * 50 - 15 * 15) : 15);
    const TileCandidates only_sphere = Candidates({near});
    CHECK(Around(frame, only_sphere, edge, 100).any);
    CHECK(Around(frame, only_sphere, edge, 100).only_sphere != nullptr);
    CHECK(Around(frame, only_sphere, edge + 0.4, 100).any);
    CHECK(Around(frame, only_sphere, edge - 0.4, 100).any);
    CHECK_FALSE(Around(frame, only_sphere, edge + 1.5, 100).any);
    CHECK_FALSE(Around(frame, only_sphere, edge - 1.5, 100).any);
    CHECK_FALSE(Around(frame, only_sphere, 100, 100).any);

    // Another one behind it, whose outline it hides, and one whose picture holds it.
    const TraceSphere hidden{{0, 0, -200}, 10}, behind{{0, 0, -200}, 150};
    const double hidden_edge = 100 + (perspective ? 50 * 10 / std::sqrt(200.0 * 200 - 100) : 10);
    CHECK(Around(frame, Candidates({hidden}), hidden_edge, 100).any);
    CHECK_FALSE(Around(frame, Candidates({near, hidden}), hidden_edge, 100).any);
    CHECK_FALSE(Around(frame, Candidates({hidden, near}), hidden_edge, 100).any);
    for (const auto& candidates : {Candidates({near, behind}), Candidates({behind, near})}) {
      CHECK(Around(frame, candidates, edge, 100).any);
      CHECK(Around(frame, candidates, edge, 100).only_sphere == nullptr);
    }
  }
}

TEST_CASE("a sphere around the camera is seen everywhere and has no outline") {
  const CameraFrame frame = Frame(Projection::kPerspective);
  const TraceSphere around{{0, 0, 1}, 50}, before{{0, 0, -10}, 8};
  const double edge = 100 + 50 * 8.0 / 6.0;  // tan(asin(0.8)) = 8 / 6
  CHECK_FALSE(Around(frame, Candidates({around}), 30, 40).any);
  CHECK(Around(frame, Candidates({around, before}), edge, 100).any);
  CHECK(Around(frame, Candidates({around, before}), edge, 100).only_sphere == nullptr);
}

TEST_CASE("parallel rays that begin inside a sphere see its outline where they do") {
  const CameraFrame frame = Frame(Projection::kOrthographic);
  CHECK(Around(frame, Candidates({{{0, 0, -16}, 15}}), 115, 100).only_sphere != nullptr);
  const TileCandidates cut = Candidates({{{0, 0, -1}, 15}});
  CHECK(Around(frame, cut, 115, 100).any);
  CHECK(Around(frame, cut, 115, 100).only_sphere == nullptr);
  // They see its back, behind what is in it.
  const TileCandidates inside = Candidates({{{0, 0, -1}, 15}, {{0, 0, -5}, 2}});
  CHECK(Around(frame, inside, 102, 100).any);
  const TileCandidates behind = Candidates({{{0, 0, 9}, 15}});  // 12 = sqrt(15^2 - 9^2)
  CHECK_FALSE(Around(frame, behind, 115, 100).any);
  CHECK(Around(frame, behind, 112, 100).any);
  CHECK(Around(frame, behind, 112, 100).only_sphere == nullptr);
}

TEST_CASE("the horizon is seen where it is, and hides what is below it") {
  const CameraFrame frame = Frame(Projection::kPerspective);
  const double radius = 1e6, height = 1.7;
  const TraceSphere ground{{0, -radius - height, 0}, radius}, ball{{0, -1.2, -10}, 0.5};
  // Its dip is sqrt(2 height / radius), 0.09 pixels below the middle: above it, too, pixels see it.
  const TileCandidates candidates = Candidates({ground});
  CHECK(Around(frame, candidates, 60, 99.8).any);
  CHECK(Around(frame, candidates, 60, 100.3).any);
  CHECK_FALSE(Around(frame, candidates, 60, 99.5).any);
  CHECK_FALSE(Around(frame, candidates, 60, 100.7).any);
  CHECK_FALSE(Around(frame, candidates, 60, 98).any);
  CHECK_FALSE(Around(frame, candidates, 60, 102).any);
  CHECK_FALSE(Around(frame, candidates, 60, 102).background);
  CHECK(Around(frame, candidates, 60, 98).background);
  // Of two spheres none is only_sphere.
  const double top = 100 + 50 * (0.12 - 0.05);
  CHECK(Around(frame, Candidates({ground, ball}), 100, top).any);
  CHECK(Around(frame, Candidates({ground, ball}), 100, top).only_sphere == nullptr);
}

TEST_CASE("many spheres are not looked through") {
  const TraceSphere sphere{{0, 0, -10}, 1};
  const CameraFrame frame = Frame(Projection::kPerspective);
  CHECK(ProjectSpheres(frame, Candidates({sphere, sphere, sphere})));
  CHECK_FALSE(ProjectSpheres(
      frame, Candidates({sphere, sphere, sphere, sphere, sphere, sphere, sphere, sphere, sphere})));
}

}  // namespace
}  // namespace nacre
