// SPDX-License-Identifier: Apache-2.0
// shading/soa-inl.h: loads and stores Vec3V from and to the arrays of a batch.
#if defined(NACRE_SHADING_SOA_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef NACRE_SHADING_SOA_INL_H_
#undef NACRE_SHADING_SOA_INL_H_
#else
#define NACRE_SHADING_SOA_INL_H_
#endif

#include "base/vec3-inl.h"
#include "hit/batch.h"

HWY_BEFORE_NAMESPACE();
namespace nacre {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Loads entries i... of a whole vector, which may extend past the batch: arrays are padded.
template <class D, class V = hn::Vec<D>>
HWY_INLINE Vec3V<V> LoadSoa(D d, const Soa3<hn::TFromD<D>>& soa, size_t i) {
  return LoadU3(d, soa.x.data() + i, soa.y.data() + i, soa.z.data() + i);
}

template <class D, class V = hn::Vec<D>>
HWY_INLINE void StoreSoa(D d, const Vec3V<V>& v, size_t i, Soa3<hn::TFromD<D>>* to) {
  hn::StoreU(v.x, d, to->x.data() + i);
  hn::StoreU(v.y, d, to->y.data() + i);
  hn::StoreU(v.z, d, to->z.data() + i);
}

// Stores the lanes of `mask` only.
template <class D, class V = hn::Vec<D>>
HWY_INLINE void BlendedStoreSoa(D d, const Vec3V<V>& v, hn::Mask<D> mask, size_t i,
                                Soa3<hn::TFromD<D>>* to) {
  hn::BlendedStore(v.x, mask, d, to->x.data() + i);
  hn::BlendedStore(v.y, mask, d, to->y.data() + i);
  hn::BlendedStore(v.z, mask, d, to->z.data() + i);
}

// Loads floats as a vector of doubles.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V PromoteAt(D d, const AlignedArray<float>& from, size_t i) {
  return hn::PromoteTo(d, hn::LoadU(hn::Rebind<float, D>(), from.data() + i));
}

template <class D, class V = hn::Vec<D>>
HWY_INLINE Vec3V<V> PromoteSoa(D d, const Soa3<float>& from, size_t i) {
  return {PromoteAt(d, from.x, i), PromoteAt(d, from.y, i), PromoteAt(d, from.z, i)};
}

}  // namespace HWY_NAMESPACE
}  // namespace nacre
HWY_AFTER_NAMESPACE();
#endif
