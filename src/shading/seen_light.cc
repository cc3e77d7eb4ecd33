// SPDX-License-Identifier: Apache-2.0
#include "shading/seen_light.h"

#include <algorithm>
#include <cmath>

#include "light/ellipse_irradiance.h"
#include "light/irradiance.h"

namespace nacre {

TriangleLight<double> SeenLight::Triangle(size_t i) const {
  TriangleLight<double> triangle = light_.mesh->triangles[i];
  triangle.corner += light_.place - point_;
  return triangle;
}

Vec3d SeenLight::Sample(double u0, double u1) const {
  if (light_.form == SampledForm::kSphere) return SampleLight(Sphere(), u0, u1).to_light;
  if (light_.form == SampledForm::kDisk) return SampleLight(Disk(), u0, u1).to_light;
  if (light_.form == SampledForm::kRectangle) return SampleLight(Rectangle(), u0, u1).to_light;
  const CdfPick pick = PickIndex(light_.mesh->by_area, u0);
  return SampleLight(Triangle(pick.index), pick.rest, u1).to_light;
}

double SeenLight::MeshDensity(const Vec3d& direction) const {
  FindMeetings(*light_.mesh, point_ - light_.place, direction, &meetings_);
  double density = 0;
  const MeshLightMeeting* nearest = nullptr;
  for (const MeshLightMeeting& meeting : meetings_) {
    density += light_.mesh->probabilities[meeting.triangle] *
               LightPdf(Triangle(meeting.triangle), direction);
    if (nearest == nullptr || meeting.t < nearest->t) nearest = &meeting;
  }
  if (nearest == nullptr) return 0;
  return Emits((direction ^ light_.mesh->crosses[nearest->triangle]) < 0) ? density : 0;
}

double SeenLight::Density(const Vec3d& direction) const {
  if (light_.form == SampledForm::kMesh) return MeshDensity(direction);
  if (light_.form == SampledForm::kSphere) {
    return IsInside(Sphere()) ? 0 : LightPdf(Sphere(), direction);
  }
  if (!Emits((direction ^ light_.normal) < 0)) return 0;
  return light_.form == SampledForm::kDisk ? LightPdf(Disk(), direction)
                                           : LightPdf(Rectangle(), direction);
}

double SeenLight::Share(const LtcNumbers& numbers, const Basis<double>& frame) const {
  const Vec3d up(0, 0, 1);
  const auto map = [&](const Vec3d& v) { return numbers.Apply(frame.ToLocal(v)); };
  const auto round = [&](const EllipseLight& e) {
    return Irradiance(EllipseLight{map(e.centre), map(e.x), map(e.y)}, up) / M_PI;
  };
  if (light_.form == SampledForm::kSphere) {
    const SphereLight<double> sphere = Sphere();
    return sphere.centre.length() > sphere.radius ? round(EllipseOf(sphere)) : 0;
  }
  if (light_.form == SampledForm::kDisk) {
    return Emits((Disk().centre ^ light_.normal) < 0) ? round(EllipseOf(Disk())) : 0;
  }
  const auto share = [&](auto piece, const Vec3d& facing) {
    if (!Emits((piece.corner ^ facing) < 0)) return 0.0;
    piece.corner = map(piece.corner);
    piece.edge_x = map(piece.edge_x);
    piece.edge_y = map(piece.edge_y);
    return std::max(Irradiance(piece, up), 0.0) / M_PI;
  };
  if (light_.form == SampledForm::kRectangle) return share(Rectangle(), light_.normal);
  double sum = 0;
  for (size_t i = 0; i < light_.mesh->triangles.size(); ++i) {
    sum += share(Triangle(i), light_.mesh->crosses[i]);
  }
  return sum;
}

}  // namespace nacre
