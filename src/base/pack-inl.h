// SPDX-License-Identifier: Apache-2.0
// base/pack-inl.h: some lanes of vectors, kept one after another and put back later: what only they
// need is then done for them alone.
#if defined(NACRE_BASE_PACK_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef NACRE_BASE_PACK_INL_H_
#undef NACRE_BASE_PACK_INL_H_
#else
#define NACRE_BASE_PACK_INL_H_
#endif

#include <cstddef>
#include <cstdint>

#include "base/lane_sets.h"
#include "base/target_ops-inl.h"

HWY_BEFORE_NAMESPACE();
namespace nacre {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Lane i of the result is lane lanes[i] of v.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V LanesAt(D d, V v, const uint8_t* HWY_RESTRICT lanes) {
  static_assert(hn::MaxLanes(D()) <= kSetLanes);
  const hn::RebindToSigned<D> di;
  const hn::Rebind<uint8_t, D> d8;
  return hn::TableLookupLanes(v, hn::IndicesFromVec(d, hn::PromoteTo(di, hn::LoadU(d8, lanes))));
}

// Bytes that tell a set of a vector's lanes. Highway asks for eight to be there.
template <class D>
HWY_INLINE size_t LaneBytes(D d) {
  return (hn::Lanes(d) + 7) / 8;
}
template <class D>
HWY_INLINE size_t LaneBytes(hn::WideTag<D>) {
  return 2 * LaneBytes(D());
}

// Stores the lanes of `mask` one after another from to[0] on, and which they are to kept[0...];
// returns how many. A whole vector is stored, whose rest means nothing.
template <class D, class V = hn::Vec<D>>
HWY_INLINE size_t Pack(D d, V v, hn::Mask<D> mask, float* HWY_RESTRICT to,
                       uint8_t* HWY_RESTRICT kept) {
  hn::StoreMaskBits(d, mask, kept);
  if constexpr (kSplitsFloats<V>) {
    hn::StoreU(hn::Compress(v, mask), d, to);
  } else {
    hn::StoreU(LanesAt(d, v, kLanesOfSets[kept[0]].lanes), d, to);
  }
  return hn::CountTrue(d, mask);
}

template <class D, class V = hn::Vec<D>>
HWY_INLINE size_t Pack(hn::WideTag<D>, const hn::Wide<V>& v, const hn::Wide<hn::Mask<D>>& mask,
                       float* HWY_RESTRICT to, uint8_t* HWY_RESTRICT kept) {
  const size_t low = Pack(D(), v.low, mask.low, to, kept);
  return low + Pack(D(), v.high, mask.high, to + low, kept + LaneBytes(D()));
}

// The next packed numbers, from **packed on, in the lanes that kept[0...] tell, and 0 in the
// others; moves *packed behind them. A whole vector is loaded.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V Unpack(D d, const uint8_t* HWY_RESTRICT kept, const float* HWY_RESTRICT* packed) {
  const auto mask = hn::LoadMaskBits(d, kept);
  const V next = hn::LoadU(d, *packed);
  *packed += hn::CountTrue(d, mask);
  if constexpr (kSplitsFloats<V>) {
    return UnpackLanes(next, mask);
  } else {
    return hn::IfThenElseZero(mask, LanesAt(d, next, kPlacesInSets[kept[0]].lanes));
  }
}

template <class D, class V = hn::Vec<D>>
HWY_INLINE hn::Wide<V> Unpack(hn::WideTag<D>, const uint8_t* HWY_RESTRICT kept,
                              const float* HWY_RESTRICT* packed) {
  const V low = Unpack(D(), kept, packed);
  return {low, Unpack(D(), kept + LaneBytes(D()), packed)};
}

}  // namespace HWY_NAMESPACE
}  // namespace nacre
HWY_AFTER_NAMESPACE();
#endif
