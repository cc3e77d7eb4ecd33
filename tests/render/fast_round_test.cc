// SPDX-License-Identifier: Apache-2.0
// tests/render/fast_round_test.cc: disks and spheres in their fast mode: off from samples by about
// what the plan tells, and the same light as polygons that look like them.
#include <algorithm>
#include <cmath>
#include <memory>

#include "base/basis.h"
#include "catch.h"
#include "render/fast_pictures.h"
#include "render/render.h"
#include "targets.h"

namespace nacre {
namespace {

SphereAreaLight Ball() {
  SphereAreaLight ball;
  ball.center = Vec3d(2, 1.5, 2);
  ball.radius = 0.7;
  ball.radiance = Rgb(5, 4, 3);
  ball.visible = false;
  return ball;
}

DiskAreaLight Plate() {
  DiskAreaLight plate;
  plate.center = Vec3d(2, 1.5, 2);
  plate.facing = Vec3d(-2, -1, -1.5);
  plate.radius = 0.9;
  plate.radiance = Rgb(5, 4, 3);
  plate.visible = false;
  return plate;
}

// A regular polygon of as much area.
MeshAreaLight PolygonOf(const DiskAreaLight& disk, uint32_t corners) {
  const Basis<double> basis = BasisAbout(disk.facing.normalized());
  const double angle = 2 * M_PI / corners;
  const double radius = disk.radius * std::sqrt(angle / std::sin(angle));
  Mesh mesh;
  for (uint32_t i = 0; i < corners; ++i) {
    const double t = angle * i;
    mesh.positions.push_back(disk.center +
                             (basis.x * std::cos(t) + basis.y * std::sin(t)) * radius);
    if (i >= 2) mesh.triangles.insert(mesh.triangles.end(), {0, i - 1, i});
  }
  return {.mesh = std::make_shared<const Mesh>(std::move(mesh)),
          .radiance = disk.radiance,
          .visible = false};
}

TEST_CASE("round lights' transformed cosines are off from samples by about what the plan tells") {
  for (const LightKind& light : {LightKind(Ball()), LightKind(Plate())}) {
    for (const double roughness : {0.15, 0.4, 0.8}) {
      CheckTold(light, roughness);
    }
  }
}

TEST_CASE("a disk is the polygon of many corners to transformed cosines") {
  DiskAreaLight edge_on = Plate();
  edge_on.facing = Vec3d(-1, -1, 1.2);
  for (const DiskAreaLight& disk : {Plate(), edge_on}) {
    for (const double roughness : {0.2, 0.7}) {
      const Scene round = FastSphere(roughness, disk),
                  flat = FastSphere(roughness, PolygonOf(disk, 64));
      REQUIRE(MakePlan(flat, {}).fast_lights.size() == 1);
      ForEachTarget([&](Target) {
        const Image a = RenderFast(round), b = RenderFast(flat);
        double largest = 0;
        for (size_t i = 0; i < a.data.pixel_count(); ++i) {
          const double got = At(a, "specular.R", i), expected = At(b, "specular.R", i);
          largest = std::max(largest, expected);
          // Its rim is within 64^-2 of the radius of the disk's, on both sides of it.
          CHECK(std::abs(got - expected) <= 2e-3);
        }
        CHECK(largest > 0.4);
      });
    }
  }
}

TEST_CASE("a sphere is the disk that it looks like to transformed cosines") {
  // From one point: the middle of the picture, seen through a long lens.
  SphereAreaLight ball = Ball();
  ball.center = Vec3d(1.2, 0.4, 2.2);
  const Vec3d point(0, 0, 1);
  const Vec3d way = ball.center - point;
  const double distance = way.length(), sin = ball.radius / distance;
  DiskAreaLight disk = Plate();
  disk.center = point + way * (1 - sin * sin);
  disk.facing = -way;
  disk.radius = ball.radius * std::sqrt(1 - sin * sin);
  for (const double roughness : {0.2, 0.5, 0.9}) {
    Scene a = FastSphere(roughness, ball), b = FastSphere(roughness, disk);
    for (Scene* scene : {&a, &b}) {
      scene->camera.height = 1e-4;
      scene->image.width = scene->image.height = 1;
    }
    ForEachTarget([&](Target) {
      const double got = At(RenderFast(a), "specular.R", 0),
                   of_disk = At(RenderFast(b), "specular.R", 0);
      CHECK(got > 0.02);
      CHECK(std::abs(got - of_disk) <= 1e-4 * of_disk);  // the pixel's width
    });
  }
}

TEST_CASE("nothing shines from inside a sphere or from behind a disk") {
  SphereAreaLight around = Ball();
  around.center = Vec3d(0, 0, 0);
  around.radius = 30;
  DiskAreaLight behind = Plate();
  behind.facing = -behind.facing;
  for (const LightKind& light : {LightKind(around), LightKind(behind)}) {
    const Scene scene = FastSphere(0.5, light);
    ForEachTarget([&](Target) {
      const Image image = RenderFast(scene);
      const auto& red = image.Find("specular.R")->samples;
      CHECK(*std::max_element(red.begin(), red.end()) == 0);
    });
  }
  behind.two_sided = true;
  const Image both = RenderFast(FastSphere(0.5, behind));
  CHECK(*std::max_element(both.Find("specular.R")->samples.begin(),
                          both.Find("specular.R")->samples.end()) > 0.5);
}

}  // namespace
}  // namespace nacre
