// SPDX-License-Identifier: Apache-2.0
// tests/shading/hit_frames_test.cc: what hits know of their surface beside its normal: the tangent,
// and the footprint of the ray.
#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <vector>

#include "catch.h"
#include "scene/mesh.h"
#include "scene/sphere_mesh.h"
#include "scene/texture_mapping.h"
#include "shading/textures.h"
#include "targets.h"

namespace nacre {
namespace {

// A sphere, or a mesh in its place, with a normal map that leaves normals as they are.
Scene MappedScene(MappingKind mapping, const Vec3d& eye) {
  Scene scene;
  scene.camera.position = eye;
  Material material{.model = LambertMaterial{}};
  material.normal_map.texture = {0};
  scene.materials = {material};
  scene.images = {
      {"level", std::make_shared<const MipChain>(MakeMipChain(1, 1, 3, {0.5, 0.5, 1})), 0.5f}};
  scene.textures = {Texture{.image = ImageId{0}, .mapping = mapping}};
  return scene;
}

struct Point {
  Vec3d position, normal;  // in world space
  uint32_t primitive = 0;
};

// The hits of rays from the eye.
struct MappedHits {
  HitBatch hits;
  Surface surface;
  HitParameters maps;

  void LookUp(const Scene& scene, const std::vector<Point>& points,
              const RayFootprints& footprints) {
    hits.count = points.size();
    // Kernels read whole vectors.
    for (size_t i = 0; i < points.size() + kBatchPadding; ++i) {
      const Point& point = points[std::min(i, points.size() - 1)];
      const Vec3d position = point.position - scene.camera.position;
      SetVector(position, i, &hits.position);
      SetVector(point.normal, i, &hits.normal);
      SetVector(-position.normalized(), i, &hits.to_view);
      hits.primitive[i] = point.primitive;
    }
    PrepareSurface(hits, &surface);
    KeptTables tables;
    const TextureScene textures = PrepareTextures(scene, 1, 1, &tables);
    ShadingMaterial material = PrepareMaterial(scene.materials[0]);
    material.by_hit.tangent = true;  // also of materials that do not ask for it
    TextureHits({textures, material, 0, points.size(), hits, surface, maps, footprints});
  }
};

const CameraFrame kCamera{Projection::kPerspective, {0, 0, -1}, {}, {1e-3, 0, 0}, {0, -1e-3, 0}};

// Whether the tangent at a hit is unit and across its normal, to the rounding of float.
bool IsUnitTangent(const MappedHits& at, size_t i) {
  const Vec3d t = VectorAt(at.surface.tangent, i), n = VectorAt(at.hits.normal, i);
  return std::abs(t.length() - 1) < 1e-6 && std::abs(t ^ n) < 1e-6;
}

TEST_CASE("tangents of spheres run along the parallels, up to the poles") {
  const auto at = std::make_unique<MappedHits>();
  ForEachTarget([&](Target) {
    Scene scene = MappedScene(MappingKind::kSpherical, {0, 0, 6});
    scene.spheres = {{Vec3d(0), 1, {0}}};
    const MappingFrame frame = FrameOf(scene.textures[0]);
    std::vector<Point> points;
    std::vector<Vec3d> expected;
    for (const double radius : {0.9, 0.5, 1e-3, 1e-8, 1e-15, 1e-100, 1e-160, 1e-300, 0.0}) {
      for (const double pole : {1.0, -1.0}) {
        for (int k = 0; k < 8; ++k) {
          const double turn = (k + 0.3) / 4 * std::numbers::pi;
          const Vec3d east = frame.y * std::cos(turn) - frame.x * std::sin(turn);
          const Vec3d out = frame.x * std::cos(turn) + frame.y * std::sin(turn);
          const Vec3d normal =
              out * radius + frame.z * (pole * std::sqrt((1 - radius) * (1 + radius)));
          points.push_back({normal, normal});
          // The axes of the frame may be rounded: nearer to the pole, points have other longitudes.
          expected.push_back(radius > 1e-9 ? east : Vec3d(0));
        }
      }
    }
    at->LookUp(scene, points, {&kCamera});
    for (size_t i = 0; i < points.size(); ++i) {
      CAPTURE(i);
      REQUIRE(IsUnitTangent(*at, i));
      // 1e-16 of rounding in the frame over the least distance from the axis.
      if (expected[i].length() > 0) {
        CHECK((VectorAt(at->surface.tangent, i) - expected[i]).length() < 1e-6);
      }
    }
  });
}

TEST_CASE("tangents of meshes are those of MikkTSpace, between the corners") {
  const auto at = std::make_unique<MappedHits>();
  ForEachTarget([&](Target) {
    Scene scene = MappedScene(MappingKind::kUv, {0, 0, 6});
    const Mesh mesh = MakeMesh(UvSphere{Vec3d(0), 1, 12, 6});
    scene.meshes = {mesh};
    scene.meshes[0].material = {0};
    const CornerTangents made = MakeTangents(mesh, mesh.uvs, {}, 1);
    constexpr std::array kWeights = {0.2, 0.3, 0.5};
    std::vector<Point> points;
    std::vector<Vec3d> expected;
    for (size_t first = 0; first < mesh.triangles.size(); first += 3) {
      Vec3d position(0), normal(0), tangent(0);
      for (size_t k = 0; k < 3; ++k) {
        position += mesh.positions[mesh.triangles[first + k]] * kWeights[k];
        normal += mesh.normals[mesh.triangles[first + k]] * kWeights[k];
        tangent += made.tangents[made.corners[first + k]].direction * kWeights[k];
      }
      normal.normalize();
      points.push_back({position, normal, static_cast<uint32_t>(first / 3)});
      expected.push_back((tangent - normal * (normal ^ tangent)).normalized());
    }
    at->LookUp(scene, points, {&kCamera});
    for (size_t i = 0; i < points.size(); ++i) {
      CAPTURE(i);
      REQUIRE(IsUnitTangent(*at, i));
      // Triangles that are seen from behind have the frame of the front, mirrored.
      const Vec3d tangent = VectorAt(at->surface.tangent, i);
      CHECK(std::min((tangent - expected[i]).length(), (tangent + expected[i]).length()) < 1e-6);
    }
  });
}

TEST_CASE("anisotropic lobes without maps lie around the y axis, turned, from both sides") {
  const auto at = std::make_unique<MappedHits>();
  ForEachTarget([&](Target) {
    for (const bool inside : {false, true}) {
      for (const bool mesh : {false, true}) {
        for (const double turn_deg : {0.0, 30.0, 90.0, -45.0}) {
          CAPTURE(inside, mesh, turn_deg);
          Scene scene;
          scene.camera.position = {0, 0, inside ? 0.1 : 6};
          scene.materials = {{.model = MetallicRoughnessMaterial{
                                  .anisotropy = 0.5, .anisotropy_rotation_deg = turn_deg}}};
          if (mesh) {
            scene.meshes = {MakeMesh(UvSphere{Vec3d(0), 1, 12, 6})};
            scene.meshes[0].uvs.clear();
            scene.meshes[0].material = {0};
          } else {
            scene.spheres = {{Vec3d(0), 1, {0}}};
          }
          std::vector<Point> points;
          for (int k = 0; k < 20; ++k) {
            const double turn = (k + 0.3) / 10 * std::numbers::pi, height = k / 11.0 - 0.9;
            const double width = std::sqrt((1 - height) * (1 + height));
            const Vec3d out(width * std::sin(turn), height, width * std::cos(turn));
            points.push_back({out, inside ? -out : out, 0});
          }
          at->LookUp(scene, points, {&kCamera});
          const double angle = turn_deg / 180 * std::numbers::pi;
          for (size_t i = 0; i < points.size(); ++i) {
            const Vec3d out = points[i].position;
            const Vec3d east = (Vec3d(0, 1, 0) % out).normalized(), north = out % east;
            const Vec3d expected = east * std::cos(angle) + north * std::sin(angle);
            const Vec3d tangent = VectorAt(at->surface.tangent, i);
            CAPTURE(i, tangent, expected);
            // A line has no sign.
            CHECK(std::min((tangent - expected).length(), (tangent + expected).length()) < 1e-6);
          }
        }
      }
    }
  });
}

// How far (u, v) moves in a pixel, as the matrix J J^T of the Jacobian J, which does not depend on
// the choice of the pixel's axes.
std::array<double, 3> FootprintOf(const HitParameters& maps, size_t i) {
  const double ux = maps.du_dx[i], uy = maps.du_dy[i], vx = maps.dv_dx[i], vy = maps.dv_dy[i];
  return {ux * ux + uy * uy, ux * vx + uy * vy, vx * vx + vy * vy};
}

void CheckEqual(const std::array<double, 3>& a, const std::array<double, 3>& b) {
  // The terms are rounded to float before they are squared.
  const double scale = std::max(b[0], b[2]);
  for (size_t k = 0; k < 3; ++k) CHECK(std::abs(a[k] - b[k]) < 1e-6 * scale);
}

TEST_CASE("a cone as wide as a camera's pixel has its footprint, and knows no camera") {
  const auto at = std::make_unique<MappedHits>();
  ForEachTarget([&](Target) {
    // In the middle of the film pixels are perpendicular to their rays: the hits are where the ray
    // along -z meets spheres that lie more and more aside.
    std::vector<Point> points;
    Scene scene = MappedScene(MappingKind::kSpherical, {0, 0, 6});
    for (const double aside : {0.0, 0.1, 0.4, 0.7, 0.9, 0.99}) {
      const Vec3d center(-0.8 * aside, 0.6 * aside, 0);
      const Vec3d position(0, 0, std::sqrt((1 - aside) * (1 + aside)));
      points.push_back({position, position - center, static_cast<uint32_t>(scene.spheres.size())});
      scene.spheres.push_back({center, 1, {0}});
    }
    at->LookUp(scene, points, {&kCamera});
    std::vector<std::array<double, 3>> of_camera;
    for (size_t i = 0; i < points.size(); ++i) of_camera.push_back(FootprintOf(at->maps, i));
    std::vector<double> diameters(kBatchCapacity, 0);
    for (size_t i = 0; i < points.size(); ++i) {
      diameters[i] = (6 - points[i].position.z) * kCamera.step_x.length();
    }
    at->LookUp(scene, points, {nullptr, diameters.data()});
    for (size_t i = 0; i < points.size(); ++i) {
      CAPTURE(i);
      CheckEqual(FootprintOf(at->maps, i), of_camera[i]);
    }
    // The same rays from farther away, as of a path that has been reflected.
    scene.camera.position = {0, 0, 30};
    at->LookUp(scene, points, {nullptr, diameters.data()});
    for (size_t i = 0; i < points.size(); ++i) {
      CAPTURE(i);
      CheckEqual(FootprintOf(at->maps, i), of_camera[i]);
    }
    for (double& diameter : diameters) diameter *= 3;
    at->LookUp(scene, points, {nullptr, diameters.data()});
    for (size_t i = 0; i < points.size(); ++i) {
      CAPTURE(i);
      std::array<double, 3> wider = of_camera[i];
      for (double& term : wider) term *= 9;
      CheckEqual(FootprintOf(at->maps, i), wider);
    }
  });
}

}  // namespace
}  // namespace nacre
