// SPDX-License-Identifier: Apache-2.0
// Normal maps on meshes: the frame is interpolated between the corners, not the faces'.
#include "scene/tangents.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "scene/mesh.h"
#include "scene/sphere_mesh.h"
#include "targets.h"
#include "textured_scenes.h"

namespace nacre {
namespace {

// What an 8-bit texel of the literal convention says.
Vec3d Decoded(const Rgb& texel) {
  const Rgb held = Held(texel);
  return {2 * held.x - 1, 2 * held.y - 1, 2 * held.z - 1};
}

// The mesh, seen by parallel rays along `forward`, with a normal map of one value all over.
Scene TiltedMesh(const Mesh& mesh, const Vec3d& forward, const Rgb& texel, bool with_map = true) {
  Scene scene;
  scene.image.width = scene.image.height = 64;
  scene.image.spp = 1;
  scene.camera.projection = Projection::kOrthographic;
  scene.camera.position = forward * -5;
  scene.camera.height = 2;
  Material material{.model = LambertMaterial{}};
  scene.materials = {material};
  scene.meshes = {mesh};
  scene.meshes[0].material = {0};
  if (!with_map) return scene;
  const TextureId id = AddConstant(&scene, texel);
  scene.textures[id.index].mapping = MappingKind::kUv;
  scene.materials[0].normal_map.texture = id;
  scene.materials[0].normal_map.convention = NormalMap::Convention::kLiteral;
  return scene;
}

// The normals of the pixels that hit something; 0 elsewhere.
std::vector<Vec3d> NormalsOf(const Scene& scene) {
  const Image image = RenderImage(scene, {.threads = 1, .layers = {"N"}});
  std::vector<Vec3d> normals;
  for (size_t i = 0; i < image.data.pixel_count(); ++i) {
    const auto value = [&](const char* name) { return double{image.Find(name)->samples[i]}; };
    normals.emplace_back(value("N.X"), value("N.Y"), value("N.Z"));
  }
  return normals;
}

// 13 degrees: no viewer here mirrors below the surface, for whom the normal would be bent.
const Rgb kTilt(150.0 / 255, 110.0 / 255, 250.0 / 255);

// How far, in radians, the normals of a sphere of faces under a constant tilt are from what the
// tilt makes of the interpolated ones on a sphere: `worst`; and how far from one pixel to the next
// that error changes.
struct SphereError {
  double worst = 0, step = 0;
};
SphereError ErrorOfSphere(int segments) {
  const Mesh mesh = MakeMesh(UvSphere{Vec3d(0), 1, segments, segments / 2});
  const Vec3d forward(1, 0, 0);  // the seam is behind
  const std::vector<Vec3d> plain = NormalsOf(TiltedMesh(mesh, forward, kTilt, false));
  const std::vector<Vec3d> tilted = NormalsOf(TiltedMesh(mesh, forward, kTilt));
  const Vec3d tilt = Decoded(kTilt);
  SphereError error;
  Vec3d last(0);
  size_t counted = 0;
  for (size_t i = 0; i < plain.size(); ++i) {
    const Vec3d& n = plain[i];
    // Well inside the outline and away from the poles, where no tangent field is smooth.
    if (n.length() < 0.5 || -n.x < 0.6 || std::abs(n.y) > 0.7) {
      last = Vec3d(0);
      continue;
    }
    ++counted;
    const Vec3d east = Vec3d(0, 1, 0).cross(n).normalized(), north = n.cross(east);
    const Vec3d expected = (east * tilt.x + north * tilt.y + n * tilt.z).normalized();
    const Vec3d off = tilted[i] - expected;
    error.worst = std::max(error.worst, off.length());
    if (last != Vec3d(0)) error.step = std::max(error.step, (off - last).length());
    last = off;
  }
  CHECK(counted > 800);
  return error;
}

TEST_CASE("a constant tilt leaves a sphere of faces as smooth as its normals are") {
  SphereError before{1, 1};
  for (const int segments : {16, 32, 64}) {
    CAPTURE(segments);
    const SphereError error = ErrorOfSphere(segments);
    const double h = 2 * M_PI / segments;
    // Interpolation errs by the square of the angle between vertices; the faces' own tangents err
    // by that angle, with a step of as much at each edge.
    CHECK(error.worst < 0.3 * h * h);
    CHECK(error.step < 0.25 * h * h);
    CHECK(error.worst < before.worst / 3);
    before = error;
  }
}

// A triangle whose corners' normals and tangents differ; u and v say something else than they do.
Mesh TwistedTriangle(double sign) {
  Mesh mesh{
      .positions = {{-1, -1, 0}, {1, -1, 0}, {-1, 1, 0}},
      .normals = {Vec3d(0.2, 0, 1), Vec3d(-0.3, 0.1, 1), Vec3d(0, 0.4, 1)},
      .tangents = {{Vec3d(0.2, 1, 0.1), sign}, {Vec3d(1, 1, 0), sign}, {Vec3d(-0.3, 1, 0), sign}}};
  for (Vec3d& normal : mesh.normals) normal.normalize();
  for (Tangent& tangent : mesh.tangents) tangent.direction.normalize();
  mesh.uvs = {{0, 0}, {1, 0}, {0, 1}};
  mesh.triangles = {0, 1, 2};
  return mesh;
}

TEST_CASE("the frame is interpolated as it is, on every target and from either side") {
  const Vec3d tilt = Decoded(kTilt);
  ForEachTarget([&](Target) {
    for (const double sign : {1.0, -1.0}) {
      const Mesh mesh = TwistedTriangle(sign);
      for (const double side : {1.0, -1.0}) {
        const std::vector<Vec3d> normals = NormalsOf(TiltedMesh(mesh, Vec3d(0, 0, -side), kTilt));
        size_t counted = 0;
        for (size_t i = 0; i < normals.size(); ++i) {
          if (normals[i].length() < 0.5) continue;
          ++counted;
          // The centre of the pixel; seen from behind x runs the other way.
          const double x = side * ((static_cast<double>(i % 64) + 0.5) / 32 - 1);
          const double y = 1 - (static_cast<double>(i / 64) + 0.5) / 32;
          const std::array<double, 3> weights = {-(x + y) / 2, (x + 1) / 2, (y + 1) / 2};
          Vec3d n(0), t(0);
          for (size_t k = 0; k < 3; ++k) {
            n += mesh.normals[k] * weights[k];
            t += mesh.tangents[k].direction * weights[k];
          }
          const Vec3d b = n.cross(t) * sign;
          const Vec3d expected = (t * tilt.x + b * tilt.y + n * tilt.z).normalized() * side;
          // Rounded to float: 3 components by 2^-24 each.
          CHECK((normals[i] - expected).length() < 1.1e-7);
        }
        CHECK(counted > 1500);
      }
    }
  });
}

TEST_CASE("tangents of a file take the place of those that its coordinates have") {
  Mesh mesh{.positions = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}}};
  mesh.normals.assign(4, Vec3d(0, 0, 1));
  mesh.uvs = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  mesh.triangles = {0, 1, 2, 0, 2, 3};
  const Rgb lean(1, 127.5 / 255, 1);  // (1, 0, 1) to the rounding of a float
  const size_t middle = 32 * 64 + 32;
  const auto normal_of = [&](const Mesh& shown) {
    return NormalsOf(TiltedMesh(shown, Vec3d(0, 0, -1), lean))[middle];
  };
  const double half = std::sqrt(0.5);
  CHECK((normal_of(mesh) - Vec3d(half, 0, half)).length() < 3e-7);
  mesh.tangents.assign(4, {Vec3d(0, 1, 0), -1});
  CHECK((normal_of(mesh) - Vec3d(0, half, half)).length() < 3e-7);
  // Face normals have no use for them: those were for the vertices' normals.
  mesh.interpolation = Interpolation::kFaceted;
  CHECK((normal_of(mesh) - Vec3d(half, 0, half)).length() < 3e-7);
}

TEST_CASE("a place without tangents keeps its normal") {
  Mesh mesh = TwistedTriangle(1);
  mesh.tangents.clear();
  mesh.uvs.assign(3, Vec2d(0.5, 0.5));
  const std::vector<Vec3d> plain = NormalsOf(TiltedMesh(mesh, Vec3d(0, 0, -1), kTilt, false));
  const std::vector<Vec3d> mapped = NormalsOf(TiltedMesh(mesh, Vec3d(0, 0, -1), kTilt));
  for (size_t i = 0; i < plain.size(); ++i) CHECK((plain[i] - mapped[i]).length() < 1.1e-7);
}

}  // namespace
}  // namespace nacre
