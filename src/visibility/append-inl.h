// SPDX-License-Identifier: Apache-2.0
// visibility/append-inl.h: writes the hits of a group of lanes behind those that a batch has.
#if defined(NACRE_VISIBILITY_APPEND_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef NACRE_VISIBILITY_APPEND_INL_H_
#undef NACRE_VISIBILITY_APPEND_INL_H_
#else
#define NACRE_VISIBILITY_APPEND_INL_H_
#endif

#include <array>
#include <bit>
#include <cstdint>

#include "visibility/camera_packet-inl.h"
#include "visibility/surface-inl.h"

HWY_BEFORE_NAMESPACE();
namespace nacre {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// The most lanes that doubles fill.
inline constexpr uint32_t kMaxDoubles = kVectorBytes / sizeof(double);

// The lanes of each set of bits, in their order; then the first of them again, whose values are
// those of a hit.
struct SetLanes {
  uint8_t lanes[kMaxDoubles];
};

inline constexpr auto kSetLanes = [] {
  std::array<SetLanes, 1 << kMaxDoubles> sets{};
  for (uint32_t bits = 0; bits < sets.size(); ++bits) {
    const int first = bits == 0 ? 0 : std::countr_zero(bits);
    for (uint8_t& lane : sets[bits].lanes) lane = static_cast<uint8_t>(first);
    size_t count = 0;
    for (uint8_t lane = 0; lane < kMaxDoubles; ++lane) {
      if ((bits >> lane & 1) != 0) sets[bits].lanes[count++] = lane;
    }
  }
  return sets;
}();

// Appends the lanes of `bits` to arrays that are `count` long. What lies behind them, up to a whole
// vector, may be overwritten.
//
// Not by Highway's Compress: GCC 12 copies its table, 2 KiB, to the stack at every call. Nor by
// CompressStore: the instruction behind it is microcode on Zen 4.
class Appender {
 public:
  HWY_INLINE Appender(size_t count, uint32_t bits)
      : count_(count), all_(bits == (1u << hn::Lanes(CameraDouble())) - 1) {
    const hn::Rebind<uint8_t, CameraDouble> d8;
    lanes32_ = hn::PromoteTo(D32(), hn::LoadU(d8, kSetLanes[bits].lanes));
    lanes64_ = hn::PromoteTo(D64(), lanes32_);
  }

  template <class D, class T>
  HWY_INLINE void operator()(D d, hn::Vec<D> value, AlignedArray<T>* to) const {
    hn::StoreU(all_ ? value : hn::TableLookupLanes(value, Order(d)), d, to->data() + count_);
  }

  template <class D, class T>
  HWY_INLINE void Append3(D d, const Vec3V<hn::Vec<D>>& value, Soa3<T>* to) const {
    (*this)(d, value.x, &to->x);
    (*this)(d, value.y, &to->y);
    (*this)(d, value.z, &to->z);
  }

 private:
  using D32 = hn::Rebind<uint32_t, CameraDouble>;
  using D64 = hn::Rebind<uint64_t, CameraDouble>;

  template <class D>
  HWY_INLINE auto Order(D d) const {
    if constexpr (sizeof(hn::TFromD<D>) == sizeof(double)) {
      return hn::IndicesFromVec(d, lanes64_);
    } else {
      return hn::IndicesFromVec(d, lanes32_);
    }
  }

  size_t count_;
  bool all_;
  hn::Vec<D32> lanes32_;
  hn::Vec<D64> lanes64_;
};

// Appends all of a group's hits but their primitives, with which the hits will be counted. `ray` is
// that of the first lane.
template <class V>
HWY_INLINE void AppendSurface(const SurfaceV<CameraDouble, V>& surface, const Vec3V<V>& to_view,
                              uint32_t bits, size_t ray, const HitsTo& to) {
  const CameraDouble d;
  const hn::Rebind<float, CameraDouble> df;
  const hn::Rebind<uint32_t, CameraDouble> du;
  HitBatch& hits = *to.hits;
  const Appender append(hits.count, bits);
  append.Append3(d, surface.position, &hits.position);
  append.Append3(df, Demote3(d, surface.normal), &to.directions->normal);
  append.Append3(df, Demote3(d, to_view), &to.directions->to_view);
  if (to.exact) {
    append.Append3(d, surface.normal, &hits.normal);
    append.Append3(d, to_view, &hits.to_view);
  }
  // Not Iota from `ray` on: that takes the lanes through memory one by one.
  append(du, hn::Add(hn::Iota(du, 0), hn::Set(du, static_cast<uint32_t>(ray))), &hits.ray);
}

// Appends the primitives of lanes that all hit the same, and with them counts the hits.
HWY_INLINE void AppendPrimitive(uint32_t primitive, uint32_t bits, HitBatch* hits) {
  const hn::Rebind<uint32_t, CameraDouble> du;
  hn::StoreU(hn::Set(du, primitive), du, hits->primitive.data() + hits->count);
  if (hits->primitive[0] != primitive) hits->one_primitive = false;
  hits->count += static_cast<size_t>(__builtin_popcount(bits));
}

// The same of lanes that may hit one each.
HWY_INLINE void AppendPrimitives(const uint32_t* primitives, uint32_t bits, HitBatch* hits) {
  const hn::Rebind<uint32_t, CameraDouble> du;
  const auto each = hn::Load(du, primitives);
  const uint32_t first = hits->count == 0 ? primitives[std::countr_zero(bits)] : hits->primitive[0];
  if ((BitsOfMask(du, hn::Ne(each, hn::Set(du, first))) & bits) != 0) hits->one_primitive = false;
  Appender(hits->count, bits)(du, each, &hits->primitive);
  hits->count += static_cast<size_t>(__builtin_popcount(bits));
}

}  // namespace HWY_NAMESPACE
}  // namespace nacre
HWY_AFTER_NAMESPACE();
#endif
