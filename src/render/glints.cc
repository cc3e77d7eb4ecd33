// SPDX-License-Identifier: Apache-2.0
#include "render/glints.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "render/highlights.h"

namespace nacre {
namespace {

// The eye or a light relative to a sphere's centre.
struct PolarPoint {
  Vec3d direction;  // unit
  double distance;  // kInfiniteDistance if directional
};

PolarPoint PolarFrom(const Vec3d& center, const Vec3d& point) {
  const Vec3d to = point - center;
  const double distance = to.length();
  return {to / distance, distance};
}

// For a sphere of `radius`, a point P at `distance` from its centre, and the point of the sphere
// whose normal makes `angle` with the direction from the centre to P: the angle of incidence,
// between the normal and the direction to P; its derivative by `angle`; and the distance to P.
struct Incidence {
  double angle, slope, length;
};

Incidence IncidenceAt(double radius, double distance, double angle) {
  if (distance == kInfiniteDistance) return {angle, 1, kInfiniteDistance};
  const double along = distance * std::cos(angle) - radius, across = distance * std::sin(angle);
  const double length2 = along * along + across * across;
  return {std::atan2(across, along), 1 + radius * along / length2, std::sqrt(length2)};
}

// The point of mirror reflection on the sphere, on the arc between the directions to the eye and to
// a light, where both have the same angle of incidence (Alhazen's problem). The difference of the
// angles increases along the arc, so that Newton's method, safeguarded by bisection, finds it.
struct MirrorPoint {
  double from_eye;  // the angle at the sphere's centre from the direction to the eye
  Incidence eye, light;
};

MirrorPoint FindMirrorPoint(double radius, double to_eye, double to_light, double arc) {
  constexpr int kMaxSteps = 60;
  double low = 0, high = arc, at = arc / 2;
  MirrorPoint point{};
  for (int i = 0; i < kMaxSteps; ++i) {
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

void AddGlint(const FramePlan& plan, const Projector& projector, const TileCandidate& candidate,
              const HighlightLight& shown, double max_area, std::vector<Glint>* glints) {
  const TraceSphere& sphere = candidate.sphere;
  const PolarPoint light = shown.directional ? PolarPoint{shown.position, kInfiniteDistance}
                                             : PolarFrom(sphere.center, shown.position);
  const PolarPoint eye = projector.perspective ? PolarFrom(sphere.center, {0, 0, 0})
                                               : PolarPoint{-projector.forward, kInfiniteDistance};
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
  const FilmPoint peak = ProjectPoint(projector, place);
  const uint32_t material = MaterialAt(plan.surfaces, candidate.primitive, peak.x).index;
  const double lobe = HalfVectorWidth(plan.surfaces, plan.adaptive.highlights, material);
  if (lobe == kInfiniteDistance) return;
  // How fast the angle between the normal and the half vector grows per unit length on the sphere.
  // The normal turns by 1 / radius; the half vector turns the opposite way, because the directions
  // to eye and light change: by the mean of their inverse distances, times the cosine in the plane
  // of incidence and divided by it perpendicular to that plane.
  const double half_turn = (1 / mirror.eye.length + 1 / mirror.light.length) / 2;
  const double normal_turn = 1 / sphere.radius;
  const double turns = (normal_turn + half_turn * cosine) * (normal_turn + half_turn / cosine);
  const double of_light = HalfVectorTurn(shown, mirror.light.length);
  const double width2 = lobe * lobe + of_light * of_light;
  const double scale = PixelsPerLength(projector, place);
  const double facing = projector.perspective ? cosine * mirror.eye.length / depth : cosine;
  const double area = M_PI * width2 / turns * scale * scale * facing;
  if (!(area > 0 && area < max_area)) return;
  const FilmPoint center = ProjectPoint(projector, sphere.center);
  const double dx = center.x - peak.x, dy = center.y - peak.y, way = std::hypot(dx, dy);
  const double step = 4 * std::sqrt(width2 / turns) * scale;
  // If the peak is at the centre, any direction leads to a point beside the highlight.
  const double part = way > 0 ? std::min(step / way, 1.0) : 0;
  glints->push_back({candidate.primitive, material, shown.number, peak.x, peak.y, area,
                     way > 0 ? dx * part : step, way > 0 ? dy * part : 0});
}

// A cheap test that succeeds for most spheres: whether all highlights on the sphere are wider than
// `least` pixels.
bool HasOnlyWideHighlights(const Projector& projector, const TraceSphere& sphere, double width,
                           double least) {
  constexpr double kSlack = 8;  // for grazing angles and near lights
  const double distance = sphere.center.length();
  if (projector.perspective && distance < 2 * sphere.radius) return false;
  const double depth = projector.perspective ? distance + sphere.radius : 1;
  return width * sphere.radius * projector.inverse_pixel / depth > kSlack * least;
}

}  // namespace

void AddGlints(const FramePlan& plan, const Projector& projector, const TileCandidate& candidate,
               double max_area, std::vector<Glint>* glints) {
  if (candidate.around_camera) return;
  const TraceSphere& sphere = candidate.sphere;
  if (!plan.surfaces.splits) {
    const double width = HalfVectorWidth(plan.surfaces, plan.adaptive.highlights,
                                         MaterialAt(plan.surfaces, candidate.primitive, 0).index);
    if (width == kInfiniteDistance || (width == 0 && plan.direct.lights.sampled.empty())) return;
    if (HasOnlyWideHighlights(projector, sphere, width, std::sqrt(max_area))) return;
  }
  for (const HighlightLight& light : plan.adaptive.highlights.lights) {
    AddGlint(plan, projector, candidate, light, max_area, glints);
  }
}

}  // namespace nacre
