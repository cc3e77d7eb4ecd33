// SPDX-License-Identifier: Apache-2.0
#include "render/outline_coverage.h"

#include <algorithm>
#include <cmath>

namespace nacre {
namespace {

// No radius of curvature is smaller, in pixels. Within a pixel the outline then turns by 10 degrees
// at most and, followed along the axis that it is closer to, stays within 55 degrees of it. As a
// function of that axis its nearest singularity, where it would turn back, is 1.4 pixels off, and
// the error of five nodes on a pixel falls as 7.7^-10.
constexpr double kLeastRadius = 8;

// Gauss-Legendre nodes and weights on [-1, 1].
constexpr int kNodes = 5;
constexpr double kNode[kNodes] = {-0.90617984593866399, -0.53846931010568309, 0,
                                  0.53846931010568309, 0.90617984593866399};
constexpr double kWeight[kNodes] = {0.23692688505618909, 0.47862867049936647, 0.56888888888888889,
                                    0.47862867049936647, 0.23692688505618909};

// Whether the outline is closer to the y axis; else it is followed along x.
bool IsSteep(const OutlineForm& outline) { return std::abs(outline.x) > std::abs(outline.y); }

// The same with x for y.
OutlineForm Turned(const OutlineForm& f) { return {f.yy, f.xy, f.xx, f.y, f.x, f.one}; }

// The root nearer to 0 of a t^2 + 2 b t + c, for a curve that passes on both sides of it.
double NearRoot(double a, double b, double c) {
  const double root = std::sqrt(std::max(b * b - a * c, 0.0));
  return -c / (b + std::copysign(root, b));
}

// Places along an axis, in ascending order.
struct Cuts {
  double at[6];
  int count = 0;

  void Insert(double place) {
    int i = count++;
    for (; i > 0 && at[i - 1] > place; --i) at[i] = at[i - 1];
    at[i] = place;
  }
};

// Inserts the roots of a s^2 + 2 b s + c within reach of 0.
void InsertRoots(double a, double b, double c, double reach, Cuts* cuts) {
  const double discriminant = b * b - a * c;
  if (!(discriminant > 0)) return;
  const double q = -(b + std::copysign(std::sqrt(discriminant), b));
  for (const double root : {q / a, c / q}) {
    if (std::abs(root) < reach) cuts->Insert(root);
  }
}

}  // namespace

// A ray through the place o hits where |c x o|^2 <= r^2 |o|^2, seen in perspective, or where
// |(c - o) x forward|^2 <= r^2. In this form nothing cancels but what the outline is made of.
OutlineForm OutlineAround(const CameraFrame& frame, const TraceSphere& sphere, double film_x,
                          double film_y) {
  const Vec3d own = frame.corner + frame.step_x * film_x + frame.step_y * film_y;
  const double r2 = sphere.radius * sphere.radius;
  Vec3d across, across_x, across_y;
  OutlineForm form{0, 0, 0, 0, 0, r2};
  if (frame.projection == Projection::kPerspective) {
    across = sphere.center.cross(own);
    across_x = sphere.center.cross(frame.step_x);
    across_y = sphere.center.cross(frame.step_y);
    form = {r2 * frame.step_x.length2(), r2 * frame.step_x.dot(frame.step_y),
            r2 * frame.step_y.length2(), r2 * own.dot(frame.step_x),
            r2 * own.dot(frame.step_y),  r2 * own.length2()};
  } else {
    across = (sphere.center - own).cross(frame.forward);
    across_x = -frame.step_x.cross(frame.forward);
    across_y = -frame.step_y.cross(frame.forward);
  }
  form.xx -= across_x.length2();
  form.xy -= across_x.dot(across_y);
  form.yy -= across_y.length2();
  form.x -= across.dot(across_x);
  form.y -= across.dot(across_y);
  form.one -= across.length2();
  return form;
}

// With its value g in the middle, and the eigenvalues -p >= -q of its square part, the ellipse's
// half-axes are sqrt(g / p) and sqrt(g / q), and its least radius of curvature is the square of the
// shorter one over the longer one.
bool BendsLittle(const OutlineForm& f) {
  const double determinant = f.xx * f.yy - f.xy * f.xy;
  if (!(f.xx < 0 && determinant > 0)) return false;
  const double middle =
      f.one - (f.x * f.x * f.yy - 2 * f.x * f.y * f.xy + f.y * f.y * f.xx) / determinant;
  const double mean = -(f.xx + f.yy) / 2;
  const double spread = std::hypot((f.xx - f.yy) / 2, f.xy);
  const double larger = mean + spread, smaller = determinant / larger;
  return middle * smaller >= kLeastRadius * kLeastRadius * larger * larger;
}

double CoveredShare(const OutlineForm& outline, double reach) {
  const OutlineForm f = IsSteep(outline) ? Turned(outline) : outline;
  // Where it crosses the square's sides, its height is cut off.
  Cuts cuts;
  for (const double side : {-reach, reach}) {
    cuts.Insert(side);
    InsertRoots(f.xx, f.x + f.xy * side, f.one + side * (2 * f.y + f.yy * side), reach, &cuts);
  }
  double area = 0;
  for (int i = 0; i + 1 < cuts.count; ++i) {
    const double half = (cuts.at[i + 1] - cuts.at[i]) / 2;
    const double middle = (cuts.at[i + 1] + cuts.at[i]) / 2;
    for (int k = 0; k < kNodes; ++k) {
      const double s = middle + half * kNode[k];
      const double edge = NearRoot(f.yy, f.y + f.xy * s, f.one + s * (2 * f.x + f.xx * s));
      const double height = f.y > 0 ? reach - edge : edge + reach;
      area += half * kWeight[k] * std::clamp(height, 0.0, 2 * reach);
    }
  }
  return area / (4 * reach * reach);
}

// Half-way from the outline to the side of the square that lies farthest inside, where that side
// does.
FilmStep CoveredPlace(const OutlineForm& outline, double reach) {
  const bool steep = IsSteep(outline);
  const OutlineForm f = steep ? Turned(outline) : outline;
  const double side = std::copysign(reach, f.y);
  const double along = std::clamp(-(f.x + f.xy * side) / f.xx, -reach, reach);
  const double edge = NearRoot(f.yy, f.y + f.xy * along, f.one + along * (2 * f.x + f.xx * along));
  const double across = (std::clamp(edge, -reach, reach) + side) / 2;
  return steep ? FilmStep{across, along} : FilmStep{along, across};
}

}  // namespace nacre
