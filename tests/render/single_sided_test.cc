// SPDX-License-Identifier: Apache-2.0
// Pictures of single-sided meshes: of closed ones those of double-sided ones, and where a back is
// turned to the camera or to a light, those without the mesh.
#include <algorithm>
#include <cmath>

#include "pictures.h"
#include "render/render.h"
#include "scene/sphere_mesh.h"
#include "scene/validate.h"
#include "stage.h"
#include "targets.h"
#include "textured_scenes.h"

namespace nacre {
namespace {

// A square over the stage's middle. Its front is above, or below.
Mesh Board(double height, bool faces_up) {
  Mesh mesh = Sheet(height, -1, 1, -1, 1, {1});
  if (!faces_up) std::reverse(mesh.triangles.begin(), mesh.triangles.end());
  return mesh;
}

Scene SingleSidedStage(const std::vector<Light>& lights) {
  Scene scene = StageScene(lights);
  scene.materials[1].model = MetallicRoughnessMaterial{.base_color = Rgb(0.2, 0.5, 0.6)};
  scene.materials[1].single_sided = true;
  return scene;
}

Image Picture(const Scene& scene, IntersectorChoice intersector, double max_error = 0) {
  return RenderImage(scene, {.threads = 1,
                             .layers = {"N", "P", "Z", "albedo"},
                             .intersector = intersector,
                             .max_error = max_error});
}

TEST_CASE("a board whose back is above is not there; with its front above it is as any other") {
  ForEachTarget([](Target) {
    for (const Light& light : LightsAbove()) {
      for (const auto intersector : {IntersectorChoice::kTiles, IntersectorChoice::kEmbree}) {
        CAPTURE(light.name);
        const Scene empty = SingleSidedStage({light});
        Scene down = empty, up = empty, both = empty;
        down.meshes.push_back(Board(1.5, false));
        up.meshes.push_back(Board(1.5, true));
        both.meshes.push_back(Board(1.5, true));
        both.materials[1].single_sided = false;
        CheckSameBits(Picture(down, intersector), Picture(empty, intersector));
        const Image shown = Picture(up, intersector);
        CheckSameBits(shown, Picture(both, intersector));
        // Which shows both sides of what is not culled.
        Scene all = down;
        all.image.culling = false;
        Scene other = down;
        other.materials[1].single_sided = false;
        const Image seen = Picture(all, intersector);
        CheckSameBits(seen, Picture(other, intersector));
        CHECK_FALSE(SameBits(seen, Picture(empty, intersector)));
        CHECK_FALSE(SameBits(shown, Picture(empty, intersector)));
      }
    }
  });
}

TEST_CASE("closed single-sided meshes have the bits of double-sided ones, under every light") {
  Scene scene = SingleSidedStage(LightsAbove());
  scene.meshes.push_back(MakeMesh(Icosphere{Vec3d(-1, 0.8, 0.6), 0.7, 2}));
  scene.meshes.back().material = {1};
  scene.meshes.push_back(MakeMesh(UvSphere{Vec3d(0, 2, -1), 0.5, 12, 6}));
  scene.meshes.back().material = {1};
  scene.meshes.back().normals.clear();
  scene.meshes.back().uvs.clear();
  Scene both = scene;
  both.materials[1].single_sided = false;
  for (const double max_error : {0.0, 0.1}) {
    CAPTURE(max_error);
    CheckSameBits(Picture(scene, IntersectorChoice::kAuto, max_error),
                  Picture(both, IntersectorChoice::kAuto, max_error));
  }
}

TEST_CASE("an inverted hull is an outline, and shades nothing that is within it") {
  Scene scene;
  scene.image.width = scene.image.height = 64;
  scene.image.spp = 1;
  scene.camera.projection = Projection::kOrthographic;
  scene.camera.position = Vec3d(0, 0, 5);
  scene.camera.height = 2.4;
  scene.materials.resize(2);
  scene.materials[0].model = LambertMaterial{Rgb(0.8)};
  scene.materials[0].single_sided = true;
  scene.materials[1].model = LambertMaterial{Rgb(0)};
  scene.materials[1].single_sided = true;
  scene.lights = {Named("sun", DirectionalLight{Vec3d(0.3, -0.4, -1), Rgb(2)})};
  scene.meshes = {MakeMesh(Icosphere{Vec3d(0), 1, 4})};
  scene.meshes[0].material = {0};
  const Image alone = Picture(scene, IntersectorChoice::kEmbree);
  Mesh hull = MakeMesh(Icosphere{Vec3d(0), 1.1, 4});
  for (size_t i = 0; i < hull.triangles.size(); i += 3) {
    std::swap(hull.triangles[i + 1], hull.triangles[i + 2]);
  }
  for (Vec3d& normal : hull.normals) normal = -normal;
  hull.material = {1};
  scene.meshes.push_back(hull);
  const Image outlined = Picture(scene, IntersectorChoice::kEmbree);
  size_t ring = 0;
  for (int y = 0; y < 64; ++y) {
    for (int x = 0; x < 64; ++x) {
      const auto i = static_cast<size_t>(64 * y + x);
      const double distance = std::hypot(x - 31.5, y - 31.5) * 2.4 / 64;
      const auto at = [&](const Image& image, const char* channel) {
        return image.Find(channel)->samples[i];
      };
      if (distance < 0.98) {
        REQUIRE(at(outlined, "R") == at(alone, "R"));
      } else if (distance > 1.01 && distance < 1.08) {
        ++ring;
        REQUIRE(at(outlined, "R") == 0);
        REQUIRE(at(outlined, "A") == 1);
        REQUIRE(at(alone, "A") == 0);
      }
    }
  }
  CHECK(ring > 100);
}

TEST_CASE("single-sided materials are of meshes, and of whole ones") {
  Scene scene = SingleSidedStage(LightsAbove());
  scene.meshes.push_back(Board(1, true));
  CHECK(Validate(scene).empty());
  Scene ball = scene;
  ball.spheres[0].material = {1};
  REQUIRE(Validate(ball).size() == 1);
  CHECK(Validate(ball)[0].what == "it is single-sided, which only meshes are");
  Scene split = scene;
  split.materials.emplace_back().model = SplitMaterial{{0.5}, {{0}, {1}}};
  split.meshes[0].material = {2};
  REQUIRE(Validate(split).size() == 1);
  CHECK(Validate(split)[0].what.starts_with("it is single-sided"));
}

}  // namespace
}  // namespace nacre
