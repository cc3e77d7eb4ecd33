// SPDX-License-Identifier: Apache-2.0
#include "shading/sampled_light.h"

#include <cmath>
#include <variant>

#include "base/overloaded.h"
#include "scene/light_shapes.h"

namespace nacre {
namespace {

void Prepare(const SphereAreaLight& sphere, const Vec3d& camera, SampledLight* light) {
  light->form = SampledForm::kSphere;
  light->color = sphere.radiance;
  light->place = sphere.center - camera;
  light->radius = sphere.radius;
}

void Prepare(const RectangleAreaLight& rectangle, const Vec3d& camera, SampledLight* light) {
  const RectangleCorners corners = CornersOf(rectangle);
  light->form = SampledForm::kRectangle;
  light->color = rectangle.radiance;
  light->place = corners.corner - camera;
  light->edge_x = corners.edge_x;
  light->edge_y = corners.edge_y;
  light->normal = rectangle.facing.normalized();
  light->two_sided = rectangle.two_sided;
}

void Prepare(const MeshAreaLight& area, const Vec3d& camera, KeptTables* kept,
             SampledLight* light) {
  const LightBall ball = BallAround(area.mesh->positions);
  light->form = SampledForm::kMesh;
  light->color = area.radiance;
  light->place = ball.center - camera;
  light->radius = ball.radius;
  light->two_sided = area.two_sided;
  light->mesh = TableOf(
      area.mesh,
      [&] { return MakeMeshLight(area.mesh->positions, area.mesh->triangles, ball.center); },
      &kept->mesh_lights);
}

void Prepare(const DiskAreaLight& disk, const Vec3d& camera, SampledLight* light) {
  light->form = SampledForm::kDisk;
  light->color = disk.radiance;
  light->place = disk.center - camera;
  light->normal = disk.facing.normalized();
  light->radius = disk.radius;
  light->two_sided = disk.two_sided;
}

// Rotates a vector about +y, right-handed.
Vec3d Turn(const Vec3d& v, double cosine, double sine) {
  return {v.x * cosine + v.z * sine, v.y, v.z * cosine - v.x * sine};
}

EnvironmentMap MakeMap(const std::shared_ptr<const SkyPicture>& picture, int threads) {
  // The map refers to the picture's own memory, because a copy would take as much again.
  static_assert(sizeof(Vec3f) == 3 * sizeof(float));
  const auto* const texels = reinterpret_cast<const Vec3f*>(picture->rgb.data());
  return MakeEnvironmentMap(picture->width, picture->height,
                            std::shared_ptr<const Vec3f[]>(picture, texels), threads);
}

void Prepare(const EnvironmentLight& environment, int threads, KeptTables* kept,
             SampledLight* light) {
  ShadingSky& to = light->sky;
  const double angle = environment.rotate_deg * M_PI / 180;
  to.cos_rotation = std::cos(angle);
  to.sin_rotation = std::sin(angle);
  std::visit(
      Overloaded{[&](const ConstantSky& sky) {
                   light->form = SampledForm::kConstantSky;
                   light->color = sky.radiance;
                 },
                 [&](const GradientSky& sky) {
                   light->form = SampledForm::kGradientSky;
                   light->color = Rgb(1, 1, 1);
                   for (int c = 0; c < 3; ++c) {
                     to.gradient[static_cast<size_t>(c)] = {static_cast<float>(sky.zenith[c]),
                                                            static_cast<float>(sky.horizon[c]),
                                                            static_cast<float>(sky.ground[c])};
                   }
                 },
                 [&](const QuadraticSky& sky) {
                   light->form = SampledForm::kQuadraticSky;
                   light->color = sky.radiance;
                   const Vec3d axis = sky.axis.normalized();
                   to.quadratic = {Vec3f(Turn(axis, to.cos_rotation, to.sin_rotation)),
                                   static_cast<float>(sky.constant), static_cast<float>(sky.linear),
                                   static_cast<float>(sky.quadratic)};
                 },
                 [&](const PictureSky& sky) {
                   light->form = SampledForm::kPictureSky;
                   light->color = sky.scale;
                   to.picture = TableOf(
                       sky.picture, [&] { return MakeMap(sky.picture, threads); }, &kept->skies);
                 }},
      environment.sky);
}

}  // namespace

SampledLight PrepareSampledLight(const Light& light, const Vec3d& camera_position, KeptTables* kept,
                                 int threads) {
  SampledLight prepared;
  std::visit(
      Overloaded{
          [&](const EnvironmentLight& environment) {
            Prepare(environment, threads, kept, &prepared);
          },
          [&](const SphereAreaLight& area) { Prepare(area, camera_position, &prepared); },
          [&](const RectangleAreaLight& area) { Prepare(area, camera_position, &prepared); },
          [&](const DiskAreaLight& area) { Prepare(area, camera_position, &prepared); },
          [&](const MeshAreaLight& area) { Prepare(area, camera_position, kept, &prepared); },
          [](const auto&) {}},
      light.kind);
  return prepared;
}

}  // namespace nacre
