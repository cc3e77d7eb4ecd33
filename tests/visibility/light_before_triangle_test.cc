// tests/visibility/light_before_triangle_test.cc: a light in front of a triangle is not in its
// shadow, though both lie in the triangle's box.
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
  const Vec3d origin(0.125, 0.125, 0.125), to_plane(0.25, 0.25, 0.125);  // met exactly at t = 1
  std::vector<ShadowRay> rays;
  for (const double length : {0.5, 0.999999, 1.0, 1.000001, 2.0}) {
    rays.push_back({{origin, to_plane * length}, 1, kNoPrimitive});
  }
  ForEachTarget([&](Target) {
    CHECK(TraceShadows(Intersector(scene, Vec3d(0)), rays) ==
          std::vector<bool>{false, false, false, true, true});
  });
}

}  // namespace
}  // namespace nacre
