// SPDX-License-Identifier: Apache-2.0
#include "scene/light_shapes.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <variant>

#include <Imath/ImathBox.h>

#include "scene/primitives.h"
#include "scene/scene_with_lights.h"

namespace nacre {
namespace {

// The number of corners of a disk's polygon: 1 - cos(pi / n) is below 5e-6.
constexpr uint32_t kDiskCorners = 1024;

template <class AreaLight>
MaterialId AddMaterial(const std::string& name, const AreaLight& light, bool two_sided,
                       Scene* scene) {
  Material& material = scene->materials.emplace_back();
  material.name = "light " + name;
  material.emission = light.radiance;
  material.emits_in_front_only = !two_sided;
  material.model = LambertMaterial{Rgb(0, 0, 0)};
  return {static_cast<uint32_t>(scene->materials.size() - 1)};
}

Mesh MakeMesh(const RectangleAreaLight& light) {
  const auto [corner, x, y] = CornersOf(light);
  return {.positions = {corner, corner + x, corner + x + y, corner + y},
          .triangles = {0, 1, 2, 0, 2, 3}};
}

Mesh MakeMesh(const DiskAreaLight& light) {
  Vec3d x, y;
  MakeTangents(light.facing, &x, &y);
  Mesh mesh;
  mesh.positions.reserve(kDiskCorners);
  for (uint32_t i = 0; i < kDiskCorners; ++i) {
    const double angle = 2 * M_PI * i / kDiskCorners;
    mesh.positions.push_back(light.center +
                             (x * std::cos(angle) + y * std::sin(angle)) * light.radius);
  }
  // Each pass cuts off every second of the corners that are left. Its triangles are about equal in
  // size, and none is a needle, as in a fan around one corner.
  for (uint32_t step = 1; step < kDiskCorners; step *= 2) {
    for (uint32_t i = 0; i + step < kDiskCorners; i += 2 * step) {
      const uint32_t last = (i + 2 * step) % kDiskCorners;
      if (last == i) continue;  // only two corners are left
      mesh.triangles.insert(mesh.triangles.end(), {i, i + step, last});
    }
  }
  return mesh;
}

Mesh MakeMesh(const MeshAreaLight& light) {
  return {.positions = light.mesh->positions, .triangles = light.mesh->triangles};
}

// An upper bound of how far apart two planes that coincide may be for rays of the camera. It covers
// the rounding of the coordinates of camera and shapes when shapes are made, when they are taken
// relative to the camera, and in the depth of a hit: some 300 2^-53 of the coordinates for shapes
// without needles.
double PlaneRounding(const std::vector<Vec3d>& positions, const Vec3d& camera) {
  double extent = 0;
  for (const Vec3d& p : positions) extent = std::max(extent, SumOfAbs(p));
  return 0x1p-44 * (extent + SumOfAbs(camera));
}

// The unit normal of a mesh whose triangles all lie in one plane and face the same way; nullopt for
// other meshes.
std::optional<Vec3d> NormalOfFlat(const Mesh& mesh, double rounding) {
  Vec3d normal(0), from(0);
  double size2 = 0;  // of the largest triangle, whose normal is the most accurate
  const auto corner = [&](size_t i) { return mesh.positions[mesh.triangles[i]]; };
  const auto cross = [&](size_t i) {
    return (corner(i + 1) - corner(i)).cross(corner(i + 2) - corner(i));
  };
  for (size_t i = 0; i < mesh.triangles.size(); i += 3) {
    const Vec3d n = cross(i);
    if (n.length2() <= size2) continue;
    size2 = n.length2();
    normal = n.normalized();
    from = corner(i);
  }
  if (size2 == 0) return std::nullopt;
  for (const Vec3d& p : mesh.positions) {
    if (std::abs((p - from).dot(normal)) > rounding) return std::nullopt;
  }
  for (size_t i = 0; i < mesh.triangles.size(); i += 3) {
    if (cross(i).dot(normal) < 0) return std::nullopt;
  }
  return normal;
}

// Moves a flat light in front of surfaces in its plane, as when it is let into a floor or a
// ceiling: by more than rounding errors could hide, and by far less than can be seen.
void LiftFromItsPlane(const Vec3d& camera, Mesh* mesh) {
  const double rounding = PlaneRounding(mesh->positions, camera);
  const std::optional<Vec3d> normal = NormalOfFlat(*mesh, rounding);
  if (!normal) return;
  for (Vec3d& p : mesh->positions) p += *normal * rounding;
}

// If the light has the shape of a mesh, calls use(light, mesh) with that, placed for the camera.
template <class Use>
void VisitMeshLight(const Light& light, const Camera& camera, const Use& use) {
  std::visit(
      [&](const auto& kind) {
        if constexpr (requires { MakeMesh(kind); }) {
          Mesh mesh = MakeMesh(kind);
          LiftFromItsPlane(camera.position, &mesh);
          use(kind, std::move(mesh));
        }
      },
      light.kind);
}

// Places the meshes of lights, which are the last ones, for the camera of `scene`.
void MoveLightMeshes(const Scene& scene, SceneWithLights* with) {
  size_t next = scene.meshes.size();
  for (size_t i = 0; i < scene.lights.size(); ++i) {
    if (with->primitives[i].end <= with->scene.spheres.size()) continue;
    VisitMeshLight(scene.lights[i], scene.camera, [&](const auto&, Mesh mesh) {
      with->scene.meshes[next++].positions = std::move(mesh.positions);
    });
  }
}

}  // namespace

RectangleCorners CornersOf(const RectangleAreaLight& light) {
  const Vec3d normal = light.facing.normalized();
  const Vec3d right = light.up.normalized().cross(normal).normalized();
  const Vec3d edge_x = right * light.width;
  const Vec3d edge_y = normal.cross(right) * light.height;
  return {light.center - edge_x / 2 - edge_y / 2, edge_x, edge_y};
}

void MakeTangents(const Vec3d& normal, Vec3d* tangent_x, Vec3d* tangent_y) {
  const Vec3d n = normal.normalized();
  const Vec3d helper = std::abs(n.x) < 0.5 ? Vec3d(1, 0, 0) : Vec3d(0, 1, 0);
  *tangent_x = helper.cross(n).normalized();
  *tangent_y = n.cross(*tangent_x);
}

LightBall BallAround(const std::vector<Vec3d>& positions) {
  Imath::Box3d box;
  for (const Vec3d& p : positions) box.extendBy(p);
  LightBall ball{box.center(), 0};
  for (const Vec3d& p : positions) ball.radius = std::max(ball.radius, (p - ball.center).length());
  return ball;
}

std::optional<LightBall> VisibleBall(const Light& light) {
  if (const auto* sphere = std::get_if<SphereAreaLight>(&light.kind)) {
    if (sphere->visible) return LightBall{sphere->center, sphere->radius};
  } else if (const auto* rectangle = std::get_if<RectangleAreaLight>(&light.kind)) {
    if (rectangle->visible) {
      return LightBall{rectangle->center, std::hypot(rectangle->width, rectangle->height) / 2};
    }
  } else if (const auto* disk = std::get_if<DiskAreaLight>(&light.kind)) {
    if (disk->visible) return LightBall{disk->center, disk->radius};
  } else if (const auto* mesh = std::get_if<MeshAreaLight>(&light.kind)) {
    if (mesh->visible) return BallAround(mesh->mesh->positions);
  }
  return std::nullopt;
}

SceneWithLights AddLightShapes(const Scene& scene, const std::vector<bool>& shown) {
  SceneWithLights result{scene, {}};
  Scene& with = result.scene;
  result.primitives.resize(scene.lights.size());
  for (size_t i = 0; i < scene.lights.size(); ++i) {
    const auto* sphere = std::get_if<SphereAreaLight>(&scene.lights[i].kind);
    if (sphere == nullptr || !shown[i]) continue;
    const auto number = static_cast<uint32_t>(with.spheres.size());
    result.primitives[i] = {number, number + 1};
    with.spheres.push_back(
        {sphere->center, sphere->radius, AddMaterial(scene.lights[i].name, *sphere, false, &with)});
  }
  auto next = static_cast<uint32_t>(with.spheres.size() + CountTriangles(scene));
  for (size_t i = 0; i < scene.lights.size(); ++i) {
    if (!shown[i]) continue;
    VisitMeshLight(scene.lights[i], scene.camera, [&](const auto& light, Mesh mesh) {
      mesh.name = "light " + scene.lights[i].name;
      mesh.material = AddMaterial(scene.lights[i].name, light, light.two_sided, &with);
      const auto triangles = static_cast<uint32_t>(mesh.triangles.size() / 3);
      result.primitives[i] = {next, next + triangles};
      next += triangles;
      with.meshes.push_back(std::move(mesh));
    });
  }
  return result;
}

void UpdateAllButShapes(const Scene& scene, SceneWithLights* with) {
  Scene& to = with->scene;
  if (scene.camera.position != to.camera.position) MoveLightMeshes(scene, with);
  to.camera = scene.camera;
  to.image = scene.image;
  to.images = scene.images;
  to.textures = scene.textures;
  to.lights = scene.lights;
  to.background = scene.background;
}

}  // namespace nacre
