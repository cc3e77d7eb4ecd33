// SPDX-License-Identifier: Apache-2.0
// tests/scene/displace_test.cc: displaced surfaces and their normals.
#include "scene/displace.h"

#include <cmath>
#include <functional>
#include <memory>

#include "catch.h"
#include "scene/mesh.h"
#include "scene/texture_mapping.h"

namespace nacre {
namespace {

// A scene with one texture of `of(u, v)` at the centres of its texels.
Scene WithHeights(int width, int height, const std::function<double(double, double)>& of) {
  std::vector<float> values;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      values.push_back(static_cast<float>(of((x + 0.5) / width, (y + 0.5) / height)));
    }
  }
  Scene scene;
  scene.images = {
      {"heights",
       std::make_shared<const MipChain>(MakeMipChain(width, height, 1, std::move(values))), 0.5f}};
  Texture texture{.image = ImageId{0}};
  texture.sampling.wrap_v = Wrap::kClamp;
  scene.textures = {texture};
  return scene;
}

struct Worst {
  double depth = 0;   // of the faces' middles below the sphere that they stand for
  double normal = 0;  // of vertex normals
  double vertex = 0;
};

// Of a unit sphere displaced by a constant 0.25, against the sphere of radius 1.25.
Worst ConstantHeight(int segments) {
  const Scene scene = WithHeights(4, 2, [](double, double) { return 0.5; });
  const Sphere sphere{{1, 2, 3}, 1, {0}};
  Mesh mesh = TessellateSphere(sphere, segments);
  Displace(scene, {.texture = TextureId{0}, .distance = 0.5}, &mesh);
  Worst worst;
  for (size_t i = 0; i < mesh.positions.size(); ++i) {
    const Vec3d from = mesh.positions[i] - sphere.center;
    worst.vertex = std::max(worst.vertex, std::abs(from.length() - 1.25));
    worst.normal = std::max(worst.normal, (mesh.normals[i] - from.normalized()).length());
  }
  for (size_t i = 0; i < mesh.triangles.size(); i += 3) {
    Vec3d middle(0, 0, 0);
    for (size_t k = 0; k < 3; ++k) middle += mesh.positions[mesh.triangles[i + k]] / 3;
    worst.depth = std::max(worst.depth, 1.25 - (middle - sphere.center).length());
    CHECK(FaceNormal(mesh, i / 3).dot(middle - sphere.center) > 0);  // outside is outside
  }
  return worst;
}

TEST_CASE("a constant height makes a sphere a larger one, to the square of the edges") {
  const Worst coarse = ConstantHeight(32), fine = ConstantHeight(64);
  CHECK(fine.vertex < 1e-15 * 8);
  CHECK(fine.depth > 0);
  CHECK(coarse.depth / fine.depth == Approx(4).epsilon(0.05));
  // Vertex normals are averages of faces: their error falls at least as fast as the edges.
  CHECK(coarse.normal / fine.normal > 1.9);
  CHECK(fine.normal < 0.03);
}

TEST_CASE("a displaced surface has the normals of its new shape") {
  // h = 0.1 (1 + sin(2 pi u)) / 2: the normal is along P (1 + h) - grad h.
  const double distance = 0.1;
  const Scene scene =
      WithHeights(4096, 1, [](double u, double) { return 0.5 + 0.5 * std::sin(2 * M_PI * u); });
  const auto worst_of = [&](int segments) {
    Mesh mesh = TessellateSphere({{0, 0, 0}, 1, {0}}, segments);
    const std::vector<Vec3d> before = mesh.positions;
    Displace(scene, {.texture = TextureId{0}, .distance = distance}, &mesh);
    double worst = 0, turned = 0;
    for (size_t i = 0; i < before.size(); ++i) {
      const Vec3d p = before[i];
      const double ring = std::sqrt(p.x * p.x + p.z * p.z);
      if (ring < 0.5) continue;  // towards the poles the longitude's slope has no bound
      const double phi = std::atan2(-p.x, -p.z);
      const double h = distance * (0.5 + 0.5 * std::sin(phi));
      const Vec3d along = Vec3d(p.z, 0, -p.x) / ring;
      const Vec3d gradient = along * (distance * 0.5 * std::cos(phi) / ring);
      const Vec3d normal = (p * (1 + h) - gradient).normalized();
      worst = std::max(worst, mesh.normals[i].cross(normal).length());
      turned = std::max(turned, mesh.normals[i].cross(p).length());
    }
    CHECK(turned > 0.05);  // the old normals are off by this
    return worst;
  };
  const double coarse = worst_of(64), fine = worst_of(128);
  CHECK(fine < 0.01);
  CHECK(coarse / fine > 1.9);
}

TEST_CASE("a displaced sphere stays closed at its seam and its poles") {
  const Scene scene =
      WithHeights(16, 8, [](double u, double v) { return std::sin(40 * u) * std::cos(30 * v); });
  Mesh mesh = TessellateSphere({{0, 0, 0}, 1, {0}}, 32);
  const std::vector<Vec3d> before = mesh.positions;
  Displace(scene, {.texture = TextureId{0}, .distance = 0.2}, &mesh);
  size_t together = 0;
  for (size_t i = 0; i < before.size(); ++i) {
    for (size_t k = 0; k < i; ++k) {
      if (before[i] != before[k]) continue;
      ++together;
      CHECK(mesh.positions[i] == mesh.positions[k]);
      CHECK(mesh.normals[i] == mesh.normals[k]);
    }
  }
  CHECK(together > 32);
}

TEST_CASE("a sphere's coordinates are those of the spherical mapping") {
  const Mesh mesh = TessellateSphere({{0, 0, 0}, 1, {0}}, 24);
  Texture texture{.mapping = MappingKind::kSpherical};
  for (size_t i = 0; i < mesh.positions.size(); ++i) {
    const Vec2d uv = MapToTexture(texture, mesh.positions[i]);
    CHECK(uv.y == Approx(mesh.uvs[i].y).margin(1e-14));
    if (std::abs(mesh.normals[i].y) > 0.999) continue;  // a pole has every longitude
    const double turns = uv.x - mesh.uvs[i].x;
    CHECK(std::abs(turns - std::round(turns)) < 1e-14);
  }
}

}  // namespace
}  // namespace nacre
