// SPDX-License-Identifier: Apache-2.0
// visibility/append-inl.h: appends the hits of a group of lanes to a batch.
#if defined(NACRE_VISIBILITY_APPEND_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef NACRE_VISIBILITY_APPEND_INL_H_
#undef NACRE_VISIBILITY_APPEND_INL_H_
#else
#define NACRE_VISIBILITY_APPEND_INL_H_
#endif

#include <bit>
#include <cstdint>

#include "base/compact_lanes.h"
#include "base/prefetch.h"
#include "hit/batch.h"
#include "visibility/camera_packet-inl.h"

HWY_BEFORE_NAMESPACE();
namespace nacre::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// The lanes of one vector of a packet form a group.
inline constexpr int kGroupLanes = static_cast<int>(hn::MaxLanes(CameraDouble()));
inline constexpr uint32_t kAllOfGroup = (1u << kGroupLanes) - 1;

// Compacts a vector: moves the lanes in `bits` to its front, in their order.
class CompactLanes {
  using D32 = hn::Rebind<uint32_t, CameraDouble>;
  using D64 = hn::Rebind<uint64_t, CameraDouble>;

 public:
  HWY_INLINE explicit CompactLanes(uint32_t bits) {
    const hn::Rebind<uint8_t, CameraDouble> d8;
    lanes32_ = hn::PromoteTo(D32(), hn::LoadU(d8, kCompactedLanes[bits].lanes));
    lanes64_ = hn::PromoteTo(D64(), lanes32_);
  }

  HWY_INLINE hn::Vec<CameraDouble> operator()(hn::Vec<CameraDouble> v) const {
    return hn::TableLookupLanes(v, hn::IndicesFromVec(CameraDouble(), lanes64_));
  }
  HWY_INLINE hn::Vec<D32> operator()(hn::Vec<D32> v) const {
    return hn::TableLookupLanes(v, hn::IndicesFromVec(D32(), lanes32_));
  }
  HWY_INLINE Vec3V<hn::Vec<CameraDouble>> operator()(const Vec3V<hn::Vec<CameraDouble>>& v) const {
    return {(*this)(v.x), (*this)(v.y), (*this)(v.z)};
  }

 private:
  hn::Vec<D32> lanes32_;
  hn::Vec<D64> lanes64_;
};

// Appends hits to a batch, one group of lanes at a time. It stores whole vectors: entries behind
// the last hit are overwritten.
class HitWriter {
 public:
  HWY_INLINE explicit HitWriter(const HitOutput& to)
      : to_(to),
        count_(to.hits->count),
        ray_(to.hits->ray.data()),
        primitive_(to.hits->primitive.data()),
        position_(PointersTo(&to.hits->position)),
        normal_(PointersTo(&to.directions->normal)),
        to_view_(PointersTo(&to.directions->to_view)) {}

  // Appends a group's hits without their primitives: call Primitive or Primitives afterwards, which
  // count the hits. `first_ray` is the index of the first lane's ray. position() computes the
  // positions, if they are wanted, after the directions are stored, because it needs their
  // registers.
  template <class V, class Position>
  HWY_INLINE void Surfaces(Vec3V<V> normal, Vec3V<V> to_view, const Position& position,
                           uint32_t bits, uint32_t first_ray) const {
    const CameraDouble d;
    const hn::Rebind<float, CameraDouble> df;
    const D32 du;
    const bool all = bits == kAllOfGroup;
    // Iota(du, first_ray) would go through memory.
    auto rays = hn::Add(hn::Iota(du, 0), hn::Set(du, first_ray));
    // Vectors are compacted before the stores, so that there is one set of stores for both cases:
    // with two sets GCC keeps their common addresses in mask registers.
    if (!all) {
      const CompactLanes compact(bits);
      normal = compact(normal);
      to_view = compact(to_view);
      rays = compact(rays);
    }
    StoreAtEnd(df, Demote3(d, normal), normal_);
    StoreAtEnd(df, Demote3(d, to_view), to_view_);
    if (to_.positions) {
      const Vec3V<V> at = position();
      StoreAtEnd(d, all ? at : CompactLanes(bits)(at), position_);
    }
    if (to_.exact_directions) {
      StoreAtEnd(d, normal, PointersTo(&to_.hits->normal));
      StoreAtEnd(d, to_view, PointersTo(&to_.hits->to_view));
    }
    StoreAtEnd(du, rays, ray_);
  }

  // Appends the primitive that all lanes in `bits` have hit, and counts the hits.
  HWY_INLINE void Primitive(uint32_t primitive, uint32_t bits) {
    const D32 du;
    StoreAtEnd(du, hn::Set(du, primitive), primitive_);
    Count(primitive_[0] == primitive, bits);
  }

  // Appends the primitives of lanes that may have hit different ones, and counts the hits.
  HWY_INLINE void Primitives(const uint32_t* primitives, uint32_t bits) {
    const D32 du;
    const auto each = hn::Load(du, primitives);
    const uint32_t first = count_ == 0 ? primitives[std::countr_zero(bits)] : primitive_[0];
    const bool same = (BitsOfMask(du, hn::Ne(each, hn::Set(du, first))) & bits) == 0;
    StoreAtEnd(du, CompactLanes(bits)(each), primitive_);
    Count(same, bits);
  }

 private:
  using D32 = hn::Rebind<uint32_t, CameraDouble>;

  template <class D, class T = hn::TFromD<D>>
  HWY_INLINE void StoreAtEnd(D d, hn::Vec<D> value, T* to) const {
    PrefetchToWrite(to + count_);
    hn::StoreU(value, d, to + count_);
  }

  template <class D, class T>
  HWY_INLINE void StoreAtEnd(D d, const Vec3V<hn::Vec<D>>& value, const Pointers3<T>& to) const {
    StoreAtEnd(d, value.x, to.x());
    StoreAtEnd(d, value.y, to.y());
    StoreAtEnd(d, value.z, to.z());
  }

  HWY_INLINE void Count(bool same_primitive, uint32_t bits) {
    if (!same_primitive) to_.hits->one_primitive = false;
    count_ += static_cast<size_t>(__builtin_popcount(bits));
    to_.hits->count = count_;
  }

  const HitOutput to_;
  size_t count_;
  uint32_t* const ray_;
  uint32_t* const primitive_;
  const Pointers3<double> position_;
  const Pointers3<float> normal_, to_view_;
};

}  // namespace nacre::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
