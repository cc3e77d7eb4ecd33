// SPDX-License-Identifier: Apache-2.0
// tests/shading/spot_test.cc: a spot's penumbra next to the cutoff, where it falls to 0 and a
// difference of rounded cosines would leave nothing right of it, of cones of all widths.
#include <cmath>

#include "catch.h"
#include "shading/shade.h"
#include "shading/soa_at.h"
#include "targets.h"

namespace nacre {
namespace {

using Long = long double;
constexpr Long kPi = 3.14159265358979323846264338327950288L;

Long OneMinusCos(Long radians) {
  const Long sine = std::sin(radians / 2);
  return 2 * sine * sine;
}

// The angle at the light between its axis and a point, in long double.
Long AngleAt(const Vec3d& light, const Vec3d& axis, const Vec3d& point) {
  const Long d[3] = {Long{point.x} - light.x, Long{point.y} - light.y, Long{point.z} - light.z};
  const Long a[3] = {axis.x, axis.y, axis.z};
  const Long x = a[1] * d[2] - a[2] * d[1], y = a[2] * d[0] - a[0] * d[2],
             z = a[0] * d[1] - a[1] * d[0];
  return std::atan2(std::sqrt(x * x + y * y + z * z), a[0] * d[0] + a[1] * d[1] + a[2] * d[2]);
}

struct Cone {
  double cutoff_deg, inner_deg, exponent;
  SpotEdge edge;
};

Long FactorAt(const Cone& cone, Long angle) {
  const Long cutoff = cone.cutoff_deg * kPi / 180, inner = cone.inner_deg * kPi / 180;
  if (angle >= cutoff) return 0;
  Long t = 1;
  if (angle > inner) {
    t = (OneMinusCos(cutoff) - OneMinusCos(angle)) / (OneMinusCos(cutoff) - OneMinusCos(inner));
  }
  const Long edge = cone.edge == SpotEdge::kSquare ? t * t : t * t * (3 - 2 * t);
  if (cone.exponent == 0) return edge;
  return angle < kPi / 2 ? edge * std::pow(std::cos(angle), Long{cone.exponent}) : 0;
}

// Points at angles that approach the cutoff from inside by steps of a half, and some beyond it.
void FillHits(const Vec3d& light, const Vec3d& axis, const Cone& cone, HitBatch* hits) {
  const Vec3d side = axis.cross(Vec3d(0.3, 0.8, -0.1)).normalized();
  const Vec3d up = axis.cross(side);
  const double cutoff = cone.cutoff_deg * M_PI / 180;
  hits->count = 0;
  for (int step = -3; step < 40; ++step) {
    const double share = step < 0 ? 1 + 0.01 * step * step : 1 - std::exp2(-step);
    const double angle = std::min(cutoff * share, M_PI), turn = 1.7 * step;
    const Vec3d direction =
        axis * std::cos(angle) + (side * std::cos(turn) + up * std::sin(turn)) * std::sin(angle);
    SetAt(hits->count, light + direction * 7.3, &hits->position);
    SetAt(hits->count, -direction, &hits->normal);
    SetAt(hits->count, -direction, &hits->to_view);
    ++hits->count;
  }
}

void CheckCone(const Cone& cone) {
  CAPTURE(cone.cutoff_deg, cone.inner_deg, cone.exponent, cone.edge == SpotEdge::kSquare);
  SpotLight spot{.position = Vec3d(0.3, 4.1, -2.7),
                 .direction_of_travel = Vec3d(0.5, -0.7, 0.4),
                 .intensity = Rgb(1),
                 .attenuation = {.constant = 1, .linear = 0, .quadratic = 0},
                 .cutoff_deg = cone.cutoff_deg,
                 .inner_deg = cone.inner_deg,
                 .exponent = cone.exponent,
                 .edge = cone.edge};
  Light light{.kind = spot};
  const ShadingLight prepared = PrepareLight(light, {0, 0, 0});
  HitBatch hits;
  FillHits(spot.position, prepared.axis, cone, &hits);
  Surface surface;
  PrepareSurface(hits, &surface);
  LightBatch got;
  EvaluateLight(prepared, hits, surface, &got);
  const double cutoff = cone.cutoff_deg * M_PI / 180, inner = cone.inner_deg * M_PI / 180;
  const Long width = OneMinusCos(cutoff) - OneMinusCos(inner);
  size_t lit = 0;
  for (size_t i = 0; i < hits.count; ++i) {
    const Vec3d point(hits.position.x[i], hits.position.y[i], hits.position.z[i]);
    const Long angle = AngleAt(spot.position, prepared.axis, point);
    const Long exact = FactorAt(cone, angle);
    lit += exact > 0;
    // Directions from doubles are off by 4 roundings in each component, and so is 1 - cos by that
    // times the sine, or by as little of itself; the cutoff's own by 4 of itself. t is off by that
    // over its width, the factor by twice as much of its slope.
    const Long off = 4 * 0x1p-53L * (std::sin(angle) + OneMinusCos(cutoff));
    // Whether a hard edge is before or behind such a point, rounding decides.
    if (width == 0 && std::abs(OneMinusCos(cutoff) - OneMinusCos(angle)) <= 2 * off) continue;
    const Long t_off = width > 0 ? 2 * off / width : 0;
    const Long t = width > 0 ? (OneMinusCos(cutoff) - OneMinusCos(angle)) / width : 1;
    const Long slope = 6 * std::min(std::max(t, Long{0}) + t_off, Long{1});
    // What floats add: t, its square, the line, the product and the attenuation, each a rounding
    // or three; the power those of its logarithm and exponential, as Phong's lobe.
    // The cosine, 1 less that, errs by as much absolutely, which counts where it is nearly 0.
    const Long power =
        cone.exponent == 0
            ? 0
            : cone.exponent * (OneMinusCos(angle) * 3 + 8 * 0x1p-29L / std::abs(std::cos(angle))) +
                  4;
    const Long tolerance = slope * t_off + (12 + power) * 0x1p-24L * exact + 0x1p-126L;
    CAPTURE(i, static_cast<double>(angle / cutoff), got.irradiance[i], static_cast<double>(exact));
    CHECK(std::abs(got.irradiance[i] - exact) <= tolerance);
  }
  CHECK(lit >= 27);  // of the narrowest cone, doubles tell no more of the steps apart
}

TEST_CASE("a spot's penumbra is right up to its cutoff, however narrow the cone") {
  ForEachTarget([](Target) {
    for (const double cutoff : {90.0, 60.0, 30.0, 5.0, 0.5, 0.01, 1e-4, 1e-6}) {
      for (const double inner : {0.0, 0.5, 0.9, 0.999, 1.0}) {
        for (const double exponent : {0.0, 1.0, 40.0}) {
          for (const SpotEdge edge : {SpotEdge::kSmoothstep, SpotEdge::kSquare}) {
            CheckCone({cutoff, cutoff * inner, exponent, edge});
          }
        }
      }
    }
    CheckCone({150, 120, 0, SpotEdge::kSmoothstep});
    CheckCone({0.2, 0.1, 1e5, SpotEdge::kSmoothstep});  // the exponent as sharp as the cone
  });
}

}  // namespace
}  // namespace nacre
