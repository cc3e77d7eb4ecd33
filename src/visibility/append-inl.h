// SPDX-License-Identifier: Apache-2.0
// visibility/append-inl.h: writes the hits of a group of lanes behind those that a batch has.
#if defined(NACRE_VISIBILITY_APPEND_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef NACRE_VISIBILITY_APPEND_INL_H_
#undef NACRE_VISIBILITY_APPEND_INL_H_
#else
#define NACRE_VISIBILITY_APPEND_INL_H_
#endif

#include <bit>
#include <cstdint>

#include "base/lane_sets.h"
#include "visibility/camera_packet-inl.h"
#include "visibility/surface-inl.h"

HWY_BEFORE_NAMESPACE();
namespace nacre {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Stores the lanes of `bits`. What lies behind them, up to a whole vector, may be overwritten.
class Appender {
 public:
  HWY_INLINE explicit Appender(uint32_t bits)
      : all_(bits == (1u << hn::Lanes(CameraDouble())) - 1) {
    const hn::Rebind<uint8_t, CameraDouble> d8;
    lanes32_ = hn::PromoteTo(D32(), hn::LoadU(d8, kLanesOfSets[bits].lanes));
    lanes64_ = hn::PromoteTo(D64(), lanes32_);
  }

  template <class D, class T>
  HWY_INLINE void operator()(D d, hn::Vec<D> value, T* to) const {
    hn::StoreU(all_ ? value : hn::TableLookupLanes(value, Order(d)), d, to);
  }

  template <class D, class T>
  HWY_INLINE void operator()(D d, const Vec3V<hn::Vec<D>>& value, const Pointers3<T>& to) const {
    (*this)(d, value.x, to.x());
    (*this)(d, value.y, to.y());
    (*this)(d, value.z, to.z());
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

  bool all_;
  hn::Vec<D32> lanes32_;
  hn::Vec<D64> lanes64_;
};

// Appends hits, group of lanes by group, to those that a batch has.
class HitWriter {
 public:
  HWY_INLINE explicit HitWriter(const HitsTo& to)
      : to_(to),
        count_(to.hits->count),
        ray_(to.hits->ray.data() + count_),
        primitive_(to.hits->primitive.data() + count_),
        position_(From(PointersTo(&to.hits->position), count_)),
        normal_(From(PointersTo(&to.directions->normal), count_)),
        to_view_(From(PointersTo(&to.directions->to_view), count_)) {}

  // All of a group's hits but their primitives, with which the hits will be counted. `ray` is that
  // of the first lane.
  template <class V>
  HWY_INLINE void Surfaces(const SurfaceV<CameraDouble, V>& surface, const Vec3V<V>& to_view,
                           uint32_t bits, size_t ray) const {
    const CameraDouble d;
    const hn::Rebind<float, CameraDouble> df;
    const D32 du;
    const Appender append(bits);
    if (to_.positions) append(d, surface.position, position_);
    append(df, Demote3(d, surface.normal), normal_);
    append(df, Demote3(d, to_view), to_view_);
    if (to_.exact) {
      append(d, surface.normal, From(PointersTo(&to_.hits->normal), count_));
      append(d, to_view, From(PointersTo(&to_.hits->to_view), count_));
    }
    // Not Iota from `ray` on: that takes the lanes through memory one by one.
    append(du, hn::Add(hn::Iota(du, 0), hn::Set(du, static_cast<uint32_t>(ray))), ray_);
  }

  // The primitives of lanes that all hit the same, and with them counts the hits.
  HWY_INLINE void Primitive(uint32_t primitive, uint32_t bits) {
    const D32 du;
    hn::StoreU(hn::Set(du, primitive), du, primitive_);
    Count(to_.hits->primitive[0] == primitive, bits);
  }

  // The same of lanes that may hit one each.
  HWY_INLINE void Primitives(const uint32_t* primitives, uint32_t bits) {
    const D32 du;
    const auto each = hn::Load(du, primitives);
    const uint32_t first =
        count_ == 0 ? primitives[std::countr_zero(bits)] : to_.hits->primitive[0];
    const bool same = (BitsOfMask(du, hn::Ne(each, hn::Set(du, first))) & bits) == 0;
    const Appender append(bits);
    append(du, each, primitive_);
    Count(same, bits);
  }

 private:
  using D32 = hn::Rebind<uint32_t, CameraDouble>;

  HWY_INLINE void Count(bool same_primitive, uint32_t bits) {
    if (!same_primitive) to_.hits->one_primitive = false;
    const auto more = static_cast<size_t>(__builtin_popcount(bits));
    count_ += more;
    to_.hits->count = count_;
    ray_ += more;
    primitive_ += more;
    position_.first += more;
    normal_.first += more;
    to_view_.first += more;
  }

  template <typename T>
  static HWY_INLINE Pointers3<T> From(const Pointers3<T>& arrays, size_t i) {
    return {arrays.first + i};
  }

  const HitsTo to_;
  size_t count_;
  uint32_t* ray_;
  uint32_t* primitive_;
  Pointers3<double> position_;
  Pointers3<float> normal_, to_view_;
};

}  // namespace HWY_NAMESPACE
}  // namespace nacre
HWY_AFTER_NAMESPACE();
#endif
