// SPDX-License-Identifier: Apache-2.0
// visibility/triangle_test-inl.h: the watertight ray-triangle test on SIMD vectors. Scalar twin,
// with the derivation: visibility/triangle_test.h.
#if defined(NACRE_VISIBILITY_TRIANGLE_TEST_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef NACRE_VISIBILITY_TRIANGLE_TEST_INL_H_
#undef NACRE_VISIBILITY_TRIANGLE_TEST_INL_H_
#else
#define NACRE_VISIBILITY_TRIANGLE_TEST_INL_H_
#endif

#include "visibility/two_product-inl.h"

HWY_BEFORE_NAMESPACE();
namespace nacre {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

template <class V>
struct RayShearV {
  Vec3V<V> x_axis;
  Vec3V<V> y_axis;
};

template <class D, class V = hn::Vec<D>>
HWY_INLINE RayShearV<V> MakeShear(D d, const Vec3V<V>& direction) {
  const V zero = hn::Zero(d);
  const V one = hn::Set(d, 1.0);
  const V x = hn::Abs(direction.x), y = hn::Abs(direction.y), z = hn::Abs(direction.z);
  const auto along_x = hn::And(hn::Ge(x, y), hn::Ge(x, z));
  const auto along_y = hn::AndNot(along_x, hn::Ge(y, z));
  const auto pick = [&](V if_x, V if_y, V if_z) {
    return hn::IfThenElse(along_x, if_x, hn::IfThenElse(along_y, if_y, if_z));
  };
  const V along = pick(direction.x, direction.y, direction.z);
  const V kx = hn::Neg(hn::Div(pick(direction.y, direction.z, direction.x), along));
  const V ky = hn::Neg(hn::Div(pick(direction.z, direction.x, direction.y), along));
  return {{pick(kx, zero, one), pick(one, kx, zero), pick(zero, one, kx)},
          {pick(ky, one, zero), pick(zero, ky, one), pick(one, zero, ky)}};
}

template <class D, class V = hn::Vec<D>>
struct TriangleHitV {
  hn::Mask<D> hit;
  V t;
  Vec3V<V> weights;
};

// inverse_dd is 1 / |direction|^2.
template <class D, class V = hn::Vec<D>>
HWY_INLINE TriangleHitV<D> TestTriangle(D d, const Vec3V<V>& a, const Vec3V<V>& b,
                                        const Vec3V<V>& c, const Vec3V<V>& direction, V inverse_dd,
                                        const RayShearV<V>& shear) {
  const V zero = hn::Zero(d);
  const V ax = Dot(a, shear.x_axis), ay = Dot(a, shear.y_axis);
  const V bx = Dot(b, shear.x_axis), by = Dot(b, shear.y_axis);
  const V cx = Dot(c, shear.x_axis), cy = Dot(c, shear.y_axis);
  const V u = DifferenceOfProducts(d, cx, by, cy, bx);
  const V v = DifferenceOfProducts(d, ax, cy, ay, cx);
  const V w = DifferenceOfProducts(d, bx, ay, by, ax);
  const V sum = hn::Add(hn::Add(u, v), w);
  const auto front = hn::And(hn::And(hn::Ge(u, zero), hn::Ge(v, zero)), hn::Ge(w, zero));
  const auto back = hn::And(hn::And(hn::Le(u, zero), hn::Le(v, zero)), hn::Le(w, zero));
  const auto line_hit = hn::AndNot(hn::Eq(sum, zero), hn::Or(front, back));
  const V inverse_sum = hn::Div(hn::Set(d, 1.0), sum);
  TriangleHitV<D>
      result;  // filled member by member: GCC 12 copies nested aggregates through memory
  result.weights.x = hn::Mul(u, inverse_sum);
  result.weights.y = hn::Mul(v, inverse_sum);
  result.weights.z = hn::Mul(w, inverse_sum);
  const Vec3V<V> depths{Dot(a, direction), Dot(b, direction), Dot(c, direction)};
  result.t = hn::Mul(Dot(depths, result.weights), inverse_dd);
  result.hit = hn::And(line_hit, hn::Gt(result.t, zero));
  return result;
}

}  // namespace HWY_NAMESPACE
}  // namespace nacre
HWY_AFTER_NAMESPACE();
#endif
