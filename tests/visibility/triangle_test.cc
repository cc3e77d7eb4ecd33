// SPDX-License-Identifier: Apache-2.0
// tests/visibility/triangle_test.cc: one triangle: what lies before and behind it.
#include "catch.h"
#include "hit/batch.h"
#include "targets.h"
#include "visibility/rays.h"

namespace nacre {
namespace {

TEST_CASE("a triangle beyond the light casts no shadow") {
  Scene scene;
  Mesh mesh;  // in the plane x + y + z = 1, seen from the corner of its box
  mesh.positions = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  mesh.triangles = {0, 1, 2};
  scene.meshes = {mesh};
  const Vec3d origin(0.125, 0.125, 0.125), to_plane(0.25, 0.25, 0.125);
  // Both lights before and lights behind the triangle lie in its box.
  std::vector<ShadowRay> rays;
  for (const double length : {0.5, 0.999999, 1.000001, 2.0}) {
    rays.push_back({{origin, to_plane * length}, 1, kNoPrimitive});
  }
  ForEachTarget([&](Target) {
    CHECK(TraceShadows(Intersector(scene, Vec3d(0)), rays) ==
          std::vector<bool>{false, false, true, true});
  });
}

TEST_CASE("a shading normal turns to the viewer, whichever way it and the triangle were given") {
  for (const double side : {1.0, -1.0}) {
    for (const std::vector<uint32_t>& winding : {std::vector<uint32_t>{0, 1, 2}, {0, 2, 1}}) {
      Scene scene;
      Mesh mesh{.positions = {{-9, -9, -5}, {9, -9, -5}, {0, 9, -5}}};
      mesh.normals.assign(3, Vec3d(0, 0.6, 0.8) * side);
      mesh.triangles = winding;
      scene.meshes = {mesh};
      ForEachTarget([&](Target) {
        const auto surfaces =
            TraceSurfaces(Intersector(scene, Vec3d(0)), {{Vec3d(0), Vec3d(0, 0, -1)}});
        REQUIRE(surfaces.size() == 1);
        CHECK((surfaces[0].normal - Vec3d(0, 0.6, 0.8)).length() < 1e-12);
      });
    }
  }
}

}  // namespace
}  // namespace nacre
