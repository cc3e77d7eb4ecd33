// SPDX-License-Identifier: Apache-2.0
// visibility/projected_sphere_test-inl.h: the ray-sphere test in the film plane, on SIMD vectors.
// Scalar twin, with the derivation: visibility/projected_sphere_test.h.
#if defined(NACRE_VISIBILITY_PROJECTED_SPHERE_TEST_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef NACRE_VISIBILITY_PROJECTED_SPHERE_TEST_INL_H_
#undef NACRE_VISIBILITY_PROJECTED_SPHERE_TEST_INL_H_
#else
#define NACRE_VISIBILITY_PROJECTED_SPHERE_TEST_INL_H_
#endif

#include "base/vec3-inl.h"
#include "visibility/projected_sphere_test.h"

HWY_BEFORE_NAMESPACE();
namespace nacre::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// The same sphere in all lanes, or one in each.
template <class V>
struct ProjectedSphereV {
  Vec3V<V> center;
  Vec3V<V> rounding_error;
  V scale;
};

template <class D, class V = hn::Vec<D>>
HWY_INLINE ProjectedSphereV<V> SetProjectedSphere(D d, const ProjectedSphere& sphere) {
  return {SetVec3(d, sphere.center), SetVec3(d, sphere.rounding_error), hn::Set(d, sphere.scale)};
}

template <class V>
struct ProjectedHitV {
  Vec3V<V> offset;
  V back;          // offset . backward
  V discriminant;  // the ray's line meets the sphere if this is not below 0
};

// `backward` is the negated direction, and dd the square of its length. Up to signs, the bits are
// those of the scalar twin.
template <class D, class V = hn::Vec<D>>
HWY_INLINE ProjectedHitV<V> TestProjected(D d, const ProjectedSphereV<V>& sphere,
                                          const Vec3V<V>& backward, V dd) {
  const auto offset = [&](V component, V center, V rounding_error) HWY_ATTR {
    return hn::NegMulAdd(hn::Add(component, center), sphere.scale, rounding_error);
  };
  ProjectedHitV<V> hit;
  hit.offset = {offset(backward.x, sphere.center.x, sphere.rounding_error.x),
                offset(backward.y, sphere.center.y, sphere.rounding_error.y),
                offset(backward.z, sphere.center.z, sphere.rounding_error.z)};
  const auto& [x, y, z] = hit.offset;
  const V within = hn::NegMulAdd(z, z, hn::NegMulAdd(y, y, hn::NegMulAdd(x, x, hn::Set(d, 1.0))));
  hit.back = FusedDot(hit.offset, backward);
  hit.discriminant = hn::MulAdd(dd, within, hn::Mul(hit.back, hit.back));
  return hit;
}

// The distance from the ray's point at the centre's depth back to the hit, times |direction|.
// `root` is the square root of the discriminant.
template <class V>
HWY_INLINE V BackToHit(V root, V back) {
  return hn::Sub(root, back);
}

template <class V>
HWY_INLINE Vec3V<V> ProjectedNormal(const Vec3V<V>& offset, V back_to_hit, const Vec3V<V>& to_view,
                                    V inverse_length) {
  return MulAdd3(to_view, hn::Mul(back_to_hit, inverse_length), offset);
}

// The hit's t.
template <class V>
HWY_INLINE V ProjectedDepth(const Vec3V<V>& center, V radius, const Vec3V<V>& backward, V root) {
  const V product = hn::Sub(FusedDot(center, center), hn::Mul(radius, radius));
  return hn::Div(product, hn::MulSub(radius, root, FusedDot(center, backward)));
}

template <class D>
struct ProjectedDepthV {
  hn::Mask<D> hit;
  hn::Vec<D> t;
};

// The projected test where only the depth of the hit is needed.
template <class D, class V = hn::Vec<D>>
HWY_INLINE ProjectedDepthV<D> TestProjectedDepth(D d, const ProjectedSphere& projected,
                                                 const TraceSphere& sphere,
                                                 const Vec3V<V>& direction) {
  const Vec3V<V> backward = Negated(direction);
  const auto hit =
      TestProjected(d, SetProjectedSphere(d, projected), backward, FusedDot(direction, direction));
  return {hn::Ge(hit.discriminant, hn::Zero(d)),
          ProjectedDepth(SetVec3(d, sphere.center), hn::Set(d, sphere.radius), backward,
                         hn::Sqrt(hit.discriminant))};
}

}  // namespace nacre::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
