#include "render/shadow_cull.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace nacre {
namespace {

// Nothing is certain within this of a tangent: far more than the roundings of the tests.
constexpr double kMargin = 1e-9;

// True if every camera ray surely starts outside the sphere.
bool CameraIsOutside(const Camera& camera, const Sphere& sphere) {
  const Vec3d offset = sphere.center - camera.position;
  const double clear = sphere.radius * (1 + kMargin);
  if (camera.projection == Projection::kPerspective) return offset.length() > clear;
  const Vec3d forward = (camera.look_at - camera.position).normalized();
  return std::abs(offset ^ forward) > clear;  // wholly before or behind the image plane
}

// Whether `blocker` may come between `light`, a direction towards it, and the lit half of `sphere`:
// what lies over the plane through its centre, within the cylinder about it.
bool MayBlock(const Sphere& blocker, const Sphere& sphere, const Vec3d& to_light) {
  const Vec3d offset = blocker.center - sphere.center;
  const double along = offset ^ to_light;
  const Vec3d across = offset - to_light * along;
  const double margin = kMargin * (offset.length() + blocker.radius + sphere.radius);
  return along + blocker.radius > -margin &&
         across.length() < blocker.radius + sphere.radius + margin;
}

// The same for a light at a point: within the cone about the sphere, and nearer than its tangents,
// up to where its surface is lit. Rays end at the light.
bool MayBlock(const Sphere& blocker, const Sphere& sphere, const Vec3d& light,
              double light_margin) {
  const Vec3d to_sphere = sphere.center - light;
  const Vec3d to_blocker = blocker.center - light;
  const double sphere_distance = to_sphere.length();
  const double blocker_distance = to_blocker.length();
  if (sphere_distance <= sphere.radius + light_margin) return true;
  if (blocker_distance <= blocker.radius + light_margin) return true;
  const double tangent =
      std::sqrt((sphere_distance - sphere.radius) * (sphere_distance + sphere.radius));
  const double margin = kMargin * (sphere_distance + blocker_distance);
  if (blocker_distance - blocker.radius > tangent + margin) return false;
  const double angle = std::atan2(to_sphere.cross(to_blocker).length(), to_sphere.dot(to_blocker));
  const double sizes =
      std::asin(sphere.radius / sphere_distance) + std::asin(blocker.radius / blocker_distance);
  // asin is steep where a sphere is touched: the square root of a rounding there.
  return angle < sizes + 1e-6;
}

std::optional<Vec3d> PositionOf(const Light& light) {
  if (const auto* point = std::get_if<PointLight>(&light.kind)) return point->position;
  if (const auto* spot = std::get_if<SpotLight>(&light.kind)) return spot->position;
  return std::nullopt;
}

}  // namespace

std::vector<uint8_t> FindShadowed(const Scene& scene, const Light& light) {
  const std::vector<Sphere>& spheres = scene.spheres;
  if (!scene.meshes.empty() || spheres.size() > kMaxCulledSpheres) return {};
  const bool outside = std::all_of(spheres.begin(), spheres.end(), [&](const Sphere& sphere) {
    return CameraIsOutside(scene.camera, sphere);
  });
  if (!outside) return {};
  const std::optional<Vec3d> position = PositionOf(light);
  Vec3d to_light(0, 0, 0);
  if (const auto* sun = std::get_if<DirectionalLight>(&light.kind)) {
    to_light = -sun->direction_of_travel.normalized();
  }
  std::vector<uint8_t> shadowed(spheres.size(), 0);
  for (size_t i = 0; i < spheres.size(); ++i) {
    for (size_t j = 0; j < spheres.size() && shadowed[i] == 0; ++j) {
      if (i == j) continue;
      const bool may =
          position ? MayBlock(spheres[j], spheres[i], *position, kMargin * (position->length() + 1))
                   : MayBlock(spheres[j], spheres[i], to_light);
      shadowed[i] = may ? 1 : 0;
    }
  }
  return shadowed;
}

}  // namespace nacre
