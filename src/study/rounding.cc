// SPDX-License-Identifier: Apache-2.0
#include "study/rounding.h"

#include <algorithm>
#include <cmath>

#include "base/float_mode.h"
#include "brdf/ggx.h"
#include "study/picture.h"
#include "study/reflection.h"
#include "visibility/sphere_test.h"

namespace nacre {
namespace {

using Long3 = Imath::Vec3<long double>;

// Computed from the distance of the centre to the line, with one correction step. With 64-bit
// mantissas it is accurate to 1e-12 rad.
std::optional<Vec3d> TrueNormal(const Long3& center, const Long3& direction) {
  const long double dd = direction.dot(direction);
  const long double closest = center.dot(direction) / dd;
  Long3 perpendicular = center - direction * closest;
  perpendicular -= direction * (perpendicular.dot(direction) / dd);
  const long double square = 1 - perpendicular.dot(perpendicular);
  if (square < 0) return std::nullopt;
  return Vec3d(-perpendicular - direction * std::sqrt(square / dd));
}

template <typename Real>
std::optional<Vec3d> TextbookNormal(const Imath::Vec3<Real>& center,
                                    const Imath::Vec3<Real>& direction) {
  const Real a = direction.dot(direction);
  const Real b = -2 * center.dot(direction);
  const Real c = center.dot(center) - 1;
  const Real discriminant = b * b - 4 * a * c;
  if (discriminant < 0) return std::nullopt;
  const Real t = (-b - std::sqrt(discriminant)) / (2 * a);
  return Vec3d(direction * t - center).normalized();
}

template <typename Real>
std::optional<Vec3d> StableNormal(const Imath::Vec3<Real>& center,
                                  const Imath::Vec3<Real>& direction) {
  const SphereHit<Real> hit = TestSphere(center, direction, Real(1));
  if (!hit.hit) return std::nullopt;
  return Vec3d(CenterToHit(hit, direction)).normalized();
}

double AngleBetween(const Vec3d& a, const Vec3d& b) { return 2 * std::asin((a - b).length() / 2); }

const Vec3d kToView(0, 0, 1);
const Vec3d kToLight = Vec3d(0.7, 0.2, 0.6).normalized();

// D V n.l with the textbook form of D's denominator. Masking is in double, as it is not tested
// here.
template <typename Real>
double TextbookGgx(const Vec3d& normal, double alpha) {
  using Vec = Imath::Vec3<Real>;
  const Vec half = (Vec(kToLight) + Vec(kToView)).normalized();
  const Real n_dot_h = Vec(normal).dot(half);
  const Real alpha2 = static_cast<Real>(alpha) * static_cast<Real>(alpha);
  const Real denominator = n_dot_h * n_dot_h * (alpha2 - 1) + 1;
  const Real d = alpha2 / (static_cast<Real>(M_PI) * denominator * denominator);
  const double n_dot_l = normal.dot(kToLight);
  return double{d} * VisibilityHeightCorrelated(n_dot_l, normal.dot(kToView), alpha) * n_dot_l;
}

}  // namespace

std::optional<Vec3d> HitNormal(HitForm form, const Vec3d& center, const Vec3d& direction) {
  switch (form) {
    case HitForm::kTextbookFloat:
      return TextbookNormal(Vec3f(center), Vec3f(direction));
    case HitForm::kTextbookDouble:
      return TextbookNormal(center, direction);
    case HitForm::kStableFloat:
      return StableNormal(Vec3f(center), Vec3f(direction));
    case HitForm::kNacre:
      break;
  }
  return StableNormal(center, direction);
}

HitError MeasureHits(HitForm form, double distance) {
  constexpr int kSide = 81;
  const Vec3d center = Vec3d(0.3, -0.2, -1).normalized() * distance;
  const Vec3d right = (center % Vec3d(0, 1, 0)).normalized();
  const Vec3d up = (right % center).normalized();
  HitError error;
  int hits = 0;
  double squares = 0;
  for (int i = 0; i < kSide * kSide; ++i) {
    // Avoids any symmetry, and covers 1.01 radii.
    const double x = 2.02 * ((i % kSide) + 0.37) / kSide - 1.01;
    const double y = 2.02 * ((i / kSide) + 0.61) / kSide - 1.01;
    const Vec3d direction = center + right * x + up * y;
    const std::optional<Vec3d> truth = TrueNormal(Long3(center), Long3(direction));
    const std::optional<Vec3d> got = HitNormal(form, center, direction);
    error.wrong += got.has_value() != truth.has_value();
    if (!got || !truth) continue;
    ++hits;
    const double angle = AngleBetween(*got, *truth);
    squares += angle * angle;
  }
  error.wrong /= kSide * kSide;
  error.normal = hits > 0 ? std::sqrt(squares / hits) : 0;
  return error;
}

double MeasureGgx(GgxForm form, double roughness) {
  constexpr int kSide = 15;
  const FlushDenormals flush;
  const ShadingMaterial prepared =
      PrepareMaterial(MaterialOf(MetallicRoughnessMaterial{.base_color = Rgb(1),
                                                           .metallic = 1,
                                                           .roughness = roughness,
                                                           .compensation = Compensation::kNone}));
  const double alpha = AlphaFromRoughness(roughness);
  const Vec3d half = (kToLight + kToView).normalized();
  const Vec3d across = (half % Vec3d(0, 1, 0)).normalized();
  const Vec3d along = half % across;
  double largest = 0;
  for (int i = 0; i < kSide * kSide; ++i) {
    const double x = 6 * ((i % kSide) + 0.37) / kSide - 3;
    const double y = 6 * ((i / kSide) + 0.61) / kSide - 3;
    const Vec3d normal = (half + (across * x + along * y) * alpha).normalized();
    const double truth = Reflect(prepared, normal, kToLight, kToView).specular.x;
    if (!(truth > 0)) continue;
    const double got = form == GgxForm::kTextbookFloat ? TextbookGgx<float>(normal, alpha)
                       : form == GgxForm::kTextbookDouble
                           ? TextbookGgx<double>(normal, alpha)
                           : ReflectByKernel(prepared, normal, kToLight, kToView).specular.x;
    largest = std::max(largest, std::abs(got / truth - 1));
  }
  return largest;
}

}  // namespace nacre
