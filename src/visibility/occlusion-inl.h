// visibility/occlusion-inl.h: whether a sphere is in the way of shadow rays, in double: what every
// way of finding candidates asks in the end.
#if defined(NACRE_VISIBILITY_OCCLUSION_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef NACRE_VISIBILITY_OCCLUSION_INL_H_
#undef NACRE_VISIBILITY_OCCLUSION_INL_H_
#else
#define NACRE_VISIBILITY_OCCLUSION_INL_H_
#endif

#include "visibility/geometry.h"
#include "visibility/sphere_test-inl.h"

HWY_BEFORE_NAMESPACE();
namespace nacre {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Rays, one a lane, for which a sphere may be in the way at 0 < t < t_max.
template <class D, class V = hn::Vec<D>>
struct ShadowRaysV {
  Vec3V<V> origin, direction;
  V inverse_dd;  // 1 / |direction|^2
  V t_max;
};

// From the sphere itself, or one that coincides with it, one root is 0, and the other twice the
// way to the closest approach: negative for a ray that leaves outward, whatever the rounding of
// its origin. `own`: the lanes that start there; with `outward` it is never in their way.
template <class D>
HWY_INLINE hn::Mask<D> InTheWay(D d, const SphereHitV<D>& hit, hn::Mask<D> own, bool outward,
                                hn::Vec<D> t_max) {
  const auto zero = hn::Zero(d);
  const auto t = hn::IfThenElse(own, hn::Add(hit.closest, hit.closest), hit.t);
  const auto met_own = outward ? hn::Lt(zero, zero) : hn::And(own, hn::Gt(t, zero));
  const auto met = hn::Or(met_own, hn::AndNot(own, hit.hit));
  return hn::And(met, hn::Lt(t, t_max));
}

}  // namespace HWY_NAMESPACE
}  // namespace nacre
HWY_AFTER_NAMESPACE();
#endif
