// SPDX-License-Identifier: Apache-2.0
#include "render/glints.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "render/highlights.h"

namespace nacre {
namespace {

constexpr double kFarAway = std::numeric_limits<double>::infinity();

// The eye or a light as a sphere's centre sees it.
struct SeenPoint {
  Vec3d direction;  // unit
  double distance;  // may be infinite
};

SeenPoint SeenFrom(const Vec3d& center, const Vec3d& point) {
  const Vec3d to = point - center;
  const double distance = to.length();
  return {to / distance, distance};
}

// A point of a sphere of `radius`, at an angle from the direction to a point: the angle between
// the normal there and the way to the point, how that changes with the former, and the way's
// length.
struct Incidence {
  double angle, slope, length;
};

Incidence IncidenceAt(double radius, double distance, double angle) {
  if (distance == kFarAway) return {angle, 1, kFarAway};
  const double along = distance * std::cos(angle) - radius, across = distance * std::sin(angle);
  const double length2 = along * along + across * across;
  return {std::atan2(across, along), 1 + radius * along / length2, std::sqrt(length2)};
}

// Where on the arc between the directions to the eye and to a light both are seen under the same
// angle: Alhazen's problem for a point outside the sphere. The difference of the angles grows along
// the arc, so that Newton's steps, kept between what is known to be too little and too much, find
// it.
struct MirrorPoint {
  double from_eye;  // the angle at the sphere's centre
  Incidence eye, light;
};

MirrorPoint FindMirrorPoint(double radius, double to_eye, double to_light, double arc) {
  constexpr int kMostSteps = 60;
  double low = 0, high = arc, at = arc / 2;
  MirrorPoint point{};
  for (int i = 0; i < kMostSteps; ++i) {
    point = {at, IncidenceAt(radius, to_eye, at), IncidenceAt(radius, to_light, arc - at)};
    const double excess = point.eye.angle - point.light.angle;
    (excess < 0 ? low : high) = at;
    const double step = excess / (point.eye.slope + point.light.slope);
    if (std::abs(step) <= 1e-15 * arc) break;
    const double next = at - step;
    at = next > low && next < high ? next : (low + high) / 2;
  }
  return point;
}

SeenPoint LightSeenFrom(const Vec3d& center, const HighlightLight& light) {
  if (light.far) return {light.place, kFarAway};
  return SeenFrom(center, light.place);
}

void AddGlint(const FramePlan& plan, const Projector& projector, const TileCandidate& candidate,
              const HighlightLight& shown, double largest, std::vector<Glint>* glints) {
  const TraceSphere& sphere = candidate.sphere;
  const SeenPoint light = LightSeenFrom(sphere.center, shown);
  const SeenPoint eye = projector.perspective ? SeenFrom(sphere.center, {0, 0, 0})
                                              : SeenPoint{-projector.forward, kFarAway};
  if (!(light.distance > sphere.radius)) return;
  const Vec3d across = light.direction - eye.direction * light.direction.dot(eye.direction);
  const double sine = across.length();
  const double arc = std::atan2(sine, light.direction.dot(eye.direction));
  const MirrorPoint mirror = FindMirrorPoint(sphere.radius, eye.distance, light.distance, arc);
  const double cosine = std::cos(mirror.eye.angle);
  if (!(cosine > 0)) return;
  const Vec3d normal = sine > 0 ? eye.direction * std::cos(mirror.from_eye) +
                                      across * (std::sin(mirror.from_eye) / sine)
                                : eye.direction;
  const Vec3d place = sphere.center + normal * sphere.radius;
  const double depth = place.dot(projector.forward);
  if (!(depth > 0)) return;
  const FilmPlace peak = ProjectPoint(projector, place);
  const uint32_t material = MaterialAt(plan.surfaces, candidate.primitive, peak.x).index;
  const double lobe = HalfVectorWidth(plan.surfaces, plan.adaptive, material);
  if (lobe == kFarAway) return;
  // By how much the normal turns away from the half vector along a step on the sphere: the normal
  // itself, and the half vector the other way, as the ways to eye and light turn. Twice the mean of
  // the ways' inverse lengths is the latter in the plane of both, times the cosine; across that
  // plane, over it.
  const double ways = (1 / mirror.eye.length + 1 / mirror.light.length) / 2;
  const double bend = 1 / sphere.radius;
  const double turns = (bend + ways * cosine) * (bend + ways / cosine);
  // A light's angular radius turns the half vector by half as much.
  const double of_light = shown.radius / mirror.light.length / 2;
  const double width2 = lobe * lobe + of_light * of_light;
  const double scale = ScaleAt(projector, place);
  const double facing = projector.perspective ? cosine * mirror.eye.length / depth : cosine;
  const double area = M_PI * width2 / turns * scale * scale * facing;
  if (!(area > 0 && area < largest)) return;
  const FilmPlace center = ProjectPoint(projector, sphere.center);
  const double dx = center.x - peak.x, dy = center.y - peak.y, way = std::hypot(dx, dy);
  const double step = 4 * std::sqrt(width2 / turns) * scale;
  // Of a sphere that is lit from the camera, any way is inwards.
  const double part = way > 0 ? std::min(step / way, 1.0) : 0;
  glints->push_back({candidate.primitive, material, shown.number, peak.x, peak.y, area,
                     way > 0 ? dx * part : step, way > 0 ? dy * part : 0});
}

// Whether all highlights on the sphere are wider than `least` pixels, unless they are seen at a
// grazing angle or the light is near: a test that costs little and does for most spheres.
bool ShowsWide(const Projector& projector, const TraceSphere& sphere, double width, double least) {
  constexpr double kSlack = 8;  // for these
  const double distance = sphere.center.length();
  if (projector.perspective && distance < 2 * sphere.radius) return false;
  const double depth = projector.perspective ? distance + sphere.radius : 1;
  return width * sphere.radius * projector.inverse_pixel / depth > kSlack * least;
}

}  // namespace

void AddGlints(const FramePlan& plan, const Projector& projector, const TileCandidate& candidate,
               double largest, std::vector<Glint>* glints) {
  if (candidate.around_camera) return;
  const TraceSphere& sphere = candidate.sphere;
  if (!plan.surfaces.splits) {
    const double width = HalfVectorWidth(plan.surfaces, plan.adaptive,
                                         MaterialAt(plan.surfaces, candidate.primitive, 0).index);
    if (width == kFarAway || (width == 0 && plan.direct.sampled_lights.empty())) return;
    if (ShowsWide(projector, sphere, width, std::sqrt(largest))) return;
  }
  for (const HighlightLight& light : plan.adaptive.lights) {
    AddGlint(plan, projector, candidate, light, largest, glints);
  }
}

}  // namespace nacre
