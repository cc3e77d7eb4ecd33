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
namespace nacre::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

template <class V>
struct RayShearV {
  Vec3V<V> x_axis;
  Vec3V<V> y_axis;
};

// The axes that directions are sheared onto: those of their largest components.
template <class D, class V = hn::Vec<D>>
struct ShearAxisV {
  hn::Mask<D> x, y;  // else z

  HWY_INLINE V Pick(V if_x, V if_y, V if_z) const {
    return hn::IfThenElse(x, if_x, hn::IfThenElse(y, if_y, if_z));
  }
};

template <class D, class V = hn::Vec<D>>
HWY_INLINE ShearAxisV<D> ShearAxis(D, const Vec3V<V>& direction) {
  const V x = hn::Abs(direction.x), y = hn::Abs(direction.y), z = hn::Abs(direction.z);
  const auto along_x = hn::And(hn::Ge(x, y), hn::Ge(x, z));
  return {along_x, hn::AndNot(along_x, hn::Ge(y, z))};
}

template <class D, class V = hn::Vec<D>>
HWY_INLINE RayShearV<V> MakeShear(D d, const Vec3V<V>& direction) {
  const V zero = hn::Zero(d);
  const V one = hn::Set(d, 1.0);
  const ShearAxisV<D> axis = ShearAxis(d, direction);
  const auto pick = [&](V if_x, V if_y, V if_z) { return axis.Pick(if_x, if_y, if_z); };
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
  V area;  // of the projection, twice; its sign is exact, and depends on the winding
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
  result.area = sum;
  return result;
}

// The lanes whose rays come from the triangle's front, the side from which its corners run
// counter-clockwise, if they hit it.
template <class D, class V = hn::Vec<D>>
HWY_INLINE hn::Mask<D> ComesFromFront(D d, const TriangleHitV<D>& hit, const Vec3V<V>& direction) {
  const V along = ShearAxis(d, direction).Pick(direction.x, direction.y, direction.z);
  return hn::Eq(hn::CopySign(along, hit.area), along);
}

}  // namespace nacre::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
