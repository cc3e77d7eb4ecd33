// SPDX-License-Identifier: Apache-2.0
#include "render/outline_coverage.h"

#include <algorithm>
#include <cmath>

namespace nacre {
namespace {

// The smallest radius of curvature, in pixels. Within a pixel the outline then turns by at most 10
// degrees, and stays within 55 degrees of the axis that it is closer to. As a function along that
// axis, its nearest singularity, where the outline turns back, is 1.4 pixels away, so that the
// error of Gauss-Legendre quadrature with five nodes on a pixel is of the order of 7.7^-10.
constexpr double kMinCurvatureRadius = 8;

// Gauss-Legendre nodes and weights on [-1, 1].
constexpr int kNodes = 5;
constexpr double kNode[kNodes] = {-0.90617984593866399, -0.53846931010568309, 0,
                                  0.53846931010568309, 0.90617984593866399};
constexpr double kWeight[kNodes] = {0.23692688505618909, 0.47862867049936647, 0.56888888888888889,
                                    0.47862867049936647, 0.23692688505618909};

// Whether the outline is closer to the y axis than to the x axis.
bool IsSteep(const OutlineForm& outline) { return std::abs(outline.x) > std::abs(outline.y); }

// The form with x and y exchanged.
OutlineForm Transposed(const OutlineForm& f) { return {f.yy, f.xy, f.xx, f.y, f.x, f.one}; }

// The root of a t^2 + 2 b t + c that is nearer to 0.
double RootNearZero(double a, double b, double c) {
  const double root = std::sqrt(std::max(b * b - a * c, 0.0));
  return -c / (b + std::copysign(root, b));
}

// Positions along an axis, in ascending order.
struct Breakpoints {
  double at[6];
  int count = 0;

  void Insert(double place) {
    int i = count++;
    for (; i > 0 && at[i - 1] > place; --i) at[i] = at[i - 1];
    at[i] = place;
  }
};

// Inserts the roots of a s^2 + 2 b s + c whose absolute values are less than `half_side`.
void InsertRoots(double a, double b, double c, double half_side, Breakpoints* breakpoints) {
  const double discriminant = b * b - a * c;
  if (!(discriminant > 0)) return;
  const double q = -(b + std::copysign(std::sqrt(discriminant), b));
  for (const double root : {q / a, c / q}) {
    if (std::abs(root) < half_side) breakpoints->Insert(root);
  }
}

}  // namespace

// A ray through the point o of the film hits a sphere of centre c where |c x o|^2 <= r^2 |o|^2
// (perspective), or |(c - o) x forward|^2 <= r^2 (orthographic). In this form only the differences
// that define the outline cancel.
OutlineForm MakeOutlineForm(const CameraFrame& frame, const TraceSphere& sphere, double film_x,
                            double film_y) {
  const Vec3d direction = frame.corner + frame.step_x * film_x + frame.step_y * film_y;
  const double r2 = sphere.radius * sphere.radius;
  Vec3d across, across_x, across_y;
  OutlineForm form{0, 0, 0, 0, 0, r2};
  if (frame.projection == Projection::kPerspective) {
    across = sphere.center.cross(direction);
    across_x = sphere.center.cross(frame.step_x);
    across_y = sphere.center.cross(frame.step_y);
    form = {r2 * frame.step_x.length2(),      r2 * frame.step_x.dot(frame.step_y),
            r2 * frame.step_y.length2(),      r2 * direction.dot(frame.step_x),
            r2 * direction.dot(frame.step_y), r2 * direction.length2()};
  } else {
    across = (sphere.center - direction).cross(frame.forward);
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

// With the form's value g at the ellipse's centre and the eigenvalues -p >= -q of its quadratic
// part, the half-axes are sqrt(g / p) and sqrt(g / q). The smallest radius of curvature is the
// square of the shorter one divided by the longer one.
bool IsGentlyCurved(const OutlineForm& f) {
  const double determinant = f.xx * f.yy - f.xy * f.xy;
  if (!(f.xx < 0 && determinant > 0)) return false;
  const double middle =
      f.one - (f.x * f.x * f.yy - 2 * f.x * f.y * f.xy + f.y * f.y * f.xx) / determinant;
  const double mean = -(f.xx + f.yy) / 2;
  const double spread = std::hypot((f.xx - f.yy) / 2, f.xy);
  const double larger = mean + spread, smaller = determinant / larger;
  return middle * smaller >= kMinCurvatureRadius * kMinCurvatureRadius * larger * larger;
}

double CoveredShare(const OutlineForm& outline, double half_side) {
  const OutlineForm f = IsSteep(outline) ? Transposed(outline) : outline;
  // The integrand is not smooth where the outline crosses the upper and lower sides: integrate from
  // crossing to crossing.
  Breakpoints breakpoints;
  for (const double side : {-half_side, half_side}) {
    breakpoints.Insert(side);
    InsertRoots(f.xx, f.x + f.xy * side, f.one + side * (2 * f.y + f.yy * side), half_side,
                &breakpoints);
  }
  double area = 0;
  for (int i = 0; i + 1 < breakpoints.count; ++i) {
    const double half = (breakpoints.at[i + 1] - breakpoints.at[i]) / 2;
    const double middle = (breakpoints.at[i + 1] + breakpoints.at[i]) / 2;
    for (int k = 0; k < kNodes; ++k) {
      const double s = middle + half * kNode[k];
      const double edge = RootNearZero(f.yy, f.y + f.xy * s, f.one + s * (2 * f.x + f.xx * s));
      const double height = f.y > 0 ? half_side - edge : edge + half_side;
      area += half * kWeight[k] * std::clamp(height, 0.0, 2 * half_side);
    }
  }
  return area / (4 * half_side * half_side);
}

// Half-way between the outline and the side of the square that is on the covered side of it, at the
// position along that side that lies deepest inside the sphere.
Vec2d OffsetIntoCovered(const OutlineForm& outline, double half_side) {
  const bool steep = IsSteep(outline);
  const OutlineForm f = steep ? Transposed(outline) : outline;
  const double side = std::copysign(half_side, f.y);
  const double along = std::clamp(-(f.x + f.xy * side) / f.xx, -half_side, half_side);
  const double edge =
      RootNearZero(f.yy, f.y + f.xy * along, f.one + along * (2 * f.x + f.xx * along));
  const double across = (std::clamp(edge, -half_side, half_side) + side) / 2;
  return steep ? Vec2d(across, along) : Vec2d(along, across);
}

}  // namespace nacre
