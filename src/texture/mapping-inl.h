// SPDX-License-Identifier: Apache-2.0
// texture/mapping-inl.h: from points on an object to (u, v), on vectors of doubles. Scalar twin:
// mapping.h.
#if defined(NACRE_TEXTURE_MAPPING_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef NACRE_TEXTURE_MAPPING_INL_H_
#undef NACRE_TEXTURE_MAPPING_INL_H_
#else
#define NACRE_TEXTURE_MAPPING_INL_H_
#endif

#include <cmath>

#include "hwy/contrib/math/math-inl.h"

#include "base/vec3-inl.h"
#include "texture/mapping.h"

HWY_BEFORE_NAMESPACE();
namespace nacre::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

template <class V>
struct MappedV {
  V u, v;
  Vec3V<V> du, dv;
};

// The angle of (x, y) from the x axis, in [0, pi], for y >= 0. It is 0 for the origin.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V AngleAbove(D d, V y, V x) {
  const V width = hn::Abs(x);
  const V larger = hn::Max(width, y), smaller = hn::Min(width, y);
  const auto any = hn::Gt(larger, hn::Zero(d));
  const V ratio = hn::Div(smaller, hn::IfThenElse(any, larger, hn::Set(d, 1.0)));
  const V octant = hn::Atan(d, ratio);
  const V quadrant = hn::IfThenElse(hn::Gt(y, width), hn::Sub(hn::Set(d, M_PI_2), octant), octant);
  return hn::IfThenElse(hn::Lt(x, hn::Zero(d)), hn::Sub(hn::Set(d, M_PI), quadrant), quadrant);
}

template <class D, class V = hn::Vec<D>>
HWY_INLINE void MapLongitude(D d, const Vec3V<V>& p, V axis2, V* u, Vec3V<V>* du) {
  const V zero = hn::Zero(d), turn = hn::Set(d, 2 * M_PI);
  const V above = AngleAbove(d, hn::Abs(p.y), p.x);
  const V phi = hn::IfThenElse(hn::Lt(p.y, zero), hn::Sub(turn, above), above);
  *u = hn::Mul(phi, hn::Set(d, 1 / (2 * M_PI)));
  const V scale = hn::Div(hn::Set(d, 1 / (2 * M_PI)), axis2);
  *du = {hn::Neg(hn::Mul(p.y, scale)), hn::Mul(p.x, scale), zero};
}

template <class D, class V = hn::Vec<D>>
HWY_INLINE V AxisDistance2(D d, const Vec3V<V>& p) {
  return hn::Max(hn::MulAdd(p.x, p.x, hn::Mul(p.y, p.y)), hn::Set(d, kMinAxisDistance2));
}

template <class D, class V = hn::Vec<D>>
HWY_INLINE MappedV<V> MapSpherical(D d, const Vec3V<V>& p) {
  MappedV<V> mapped;
  const V axis2 = AxisDistance2(d, p);
  const V axis = hn::Sqrt(axis2);
  MapLongitude(d, p, axis2, &mapped.u, &mapped.du);
  mapped.v = hn::Mul(AngleAbove(d, axis, p.z), hn::Set(d, M_1_PI));
  const V scale = hn::Div(hn::Set(d, M_1_PI), hn::MulAdd(p.z, p.z, axis2));
  const V inverse_axis = hn::Div(hn::Set(d, 1.0), axis);
  const V outward = hn::Mul(hn::Mul(p.z, scale), inverse_axis);
  mapped.dv = {hn::Mul(p.x, outward), hn::Mul(p.y, outward), hn::Neg(hn::Mul(axis, scale))};
  return mapped;
}

template <class D, class V = hn::Vec<D>>
HWY_INLINE MappedV<V> MapCylindrical(D d, const Vec3V<V>& p) {
  MappedV<V> mapped;
  MapLongitude(d, p, AxisDistance2(d, p), &mapped.u, &mapped.du);
  const V half = hn::Set(d, 0.5);
  mapped.v = hn::MulAdd(p.z, half, half);
  mapped.dv = {hn::Zero(d), hn::Zero(d), half};
  return mapped;
}

template <class D, class V = hn::Vec<D>>
HWY_INLINE MappedV<V> MapPlanar(D d, const Vec3V<V>& p) {
  const V zero = hn::Zero(d), half = hn::Set(d, 0.5);
  return {hn::MulAdd(p.x, half, half),
          hn::MulAdd(p.y, half, half),
          {half, zero, zero},
          {zero, half, zero}};
}

template <class D, class V = hn::Vec<D>>
HWY_INLINE MappedV<V> MapCube(D d, const Vec3V<V>& p) {
  const V zero = hn::Zero(d), half = hn::Set(d, 0.5), one = hn::Set(d, 1.0);
  const V ax = hn::Abs(p.x), ay = hn::Abs(p.y), az = hn::Abs(p.z);
  const auto on_x = hn::And(hn::Ge(ax, ay), hn::Ge(ax, az));
  const auto on_y = hn::AndNot(on_x, hn::Ge(ay, az));
  const V largest = hn::IfThenElse(on_x, ax, hn::IfThenElse(on_y, ay, az));
  const V major = hn::IfThenElse(on_x, p.x, hn::IfThenElse(on_y, p.y, p.z));
  const V sign = hn::IfThenElse(hn::Lt(major, zero), hn::Neg(one), one);
  const auto any = hn::Gt(largest, zero);
  const V scale = hn::IfThenElseZero(any, hn::Div(half, hn::IfThenElse(any, largest, one)));
  // s' is -+z, x or +-x, and t' is -y, +-z or -y. s_x, s_z, t_y and t_z are their gradients.
  const V s_x = hn::IfThenElseZero(hn::Not(on_x), hn::IfThenElse(on_y, one, sign));
  const V s_z = hn::IfThenElseZero(on_x, hn::Neg(sign));
  const V t_y = hn::IfThenElse(on_y, zero, hn::Neg(one));
  const V t_z = hn::IfThenElseZero(on_y, sign);
  const V s = hn::Mul(hn::MulAdd(p.x, s_x, hn::Mul(p.z, s_z)), scale);
  const V t = hn::Mul(hn::MulAdd(p.y, t_y, hn::Mul(p.z, t_z)), scale);
  // s and t decrease with m: by -sign s / m along the major axis.
  const V fall = hn::Neg(hn::Mul(sign, hn::Add(scale, scale)));
  const V fall_s = hn::Mul(fall, s), fall_t = hn::Mul(fall, t);
  const auto gradient = [&](V x, V y, V z, V along) HWY_ATTR {
    const V on_major_x = hn::IfThenElseZero(on_x, along);
    const V on_major_y = hn::IfThenElseZero(on_y, along);
    const V on_major_z = hn::IfThenElseZero(hn::Not(hn::Or(on_x, on_y)), along);
    return Vec3V<V>{hn::MulAdd(x, scale, on_major_x), hn::MulAdd(y, scale, on_major_y),
                    hn::MulAdd(z, scale, on_major_z)};
  };
  return {hn::Add(s, half), hn::Add(t, half), gradient(s_x, zero, s_z, fall_s),
          gradient(zero, t_y, t_z, fall_t)};
}

template <class D, class V = hn::Vec<D>>
HWY_INLINE MappedV<V> MapPoint(D d, MappingKind kind, const Vec3V<V>& p) {
  switch (kind) {
    case MappingKind::kCylindrical:
      return MapCylindrical(d, p);
    case MappingKind::kPlanar:
      return MapPlanar(d, p);
    case MappingKind::kCube:
      return MapCube(d, p);
    default:
      return MapSpherical(d, p);
  }
}

}  // namespace nacre::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
