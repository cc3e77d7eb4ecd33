// SPDX-License-Identifier: Apache-2.0
// shading/soa-inl.h: vectors of three floats out of the arrays of a batch, and into them.
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

// Entries i... of a vector's worth, which may reach past the batch: arrays are padded.
template <class D, class V = hn::Vec<D>>
HWY_INLINE Vec3V<V> LoadSoa(D d, const Soa3<float>& soa, size_t i) {
  return LoadU3(d, soa.x.data() + i, soa.y.data() + i, soa.z.data() + i);
}

template <class D, class V = hn::Vec<D>>
HWY_INLINE void StoreSoa(D d, const Vec3V<V>& v, size_t i, Soa3<float>* to) {
  hn::StoreU(v.x, d, to->x.data() + i);
  hn::StoreU(v.y, d, to->y.data() + i);
  hn::StoreU(v.z, d, to->z.data() + i);
}

}  // namespace HWY_NAMESPACE
}  // namespace nacre
HWY_AFTER_NAMESPACE();
#endif
