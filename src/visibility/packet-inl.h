// SPDX-License-Identifier: Apache-2.0
// visibility/packet-inl.h: operations that the tests of a packet against spheres and triangles
// share: loading its rays, and recording exact hits.
#if defined(NACRE_VISIBILITY_PACKET_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef NACRE_VISIBILITY_PACKET_INL_H_
#undef NACRE_VISIBILITY_PACKET_INL_H_
#else
#define NACRE_VISIBILITY_PACKET_INL_H_
#endif

#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstring>
#include <limits>

#include "visibility/packet.h"
#include "visibility/two_product-inl.h"

HWY_BEFORE_NAMESPACE();
namespace nacre::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Masks of at most 16 lanes are converted to bits and back through memory. They are never loaded
// wider than they were stored: such a load cannot be forwarded from the store buffer, and stalls.
// The first byte must have the lowest lanes.
static_assert(std::endian::native == std::endian::little);

template <class D>
HWY_INLINE uint32_t BitsOfMask(D d, hn::Mask<D> mask) {
  static_assert(hn::MaxLanes(D()) <= 16);
  uint8_t bytes[8];
  hn::StoreMaskBits(d, mask, bytes);
  if constexpr (hn::MaxLanes(D()) <= 8) return bytes[0];
  uint16_t bits;
  std::memcpy(&bits, bytes, sizeof(bits));
  return bits;
}

// The mask of the lanes from `first` on.
template <class D>
HWY_INLINE hn::Mask<D> MaskOfBits(D d, uint32_t bits, int first) {
  static_assert(hn::MaxLanes(D()) <= 16);
  const auto own = static_cast<uint16_t>((bits >> first) & ((1u << hn::Lanes(d)) - 1));
  uint8_t bytes[8];
  std::memcpy(bytes, &own, sizeof(own));
  return hn::LoadMaskBits(d, bytes);
}

template <class D>
HWY_INLINE Vec3V<hn::Vec<D>> Origin(D d, const Packet& packet, int lane) {
  return Load3(d, packet.origin, lane);
}

template <class D>
HWY_INLINE Vec3V<hn::Vec<D>> Direction(D d, const Packet& packet, int lane) {
  return Load3(d, packet.direction, lane);
}

// The depth limits in float that belong to t, never lower. Demoting is off by at most half a unit
// in the last place or, near the smallest floats, by one.
template <class D, class V = hn::Vec<D>>
HWY_INLINE auto UpperDepth(D /*d*/, V t, V t_scale) {
  const hn::Rebind<float, D> df;
  const auto depth = hn::DemoteTo(df, hn::Mul(t, t_scale));
  return hn::Add(hn::Mul(depth, hn::Set(df, 1 + 0x1p-22f)),
                 hn::Set(df, std::numeric_limits<float>::min()));
}

// Records the hits (t, primitive), at the lanes from `lane` on, that are nearer than the best so
// far or, at the same t, have a lower id. The traversal need not look farther than them.
template <class D, class V = hn::Vec<D>>
HWY_INLINE void RecordClosest(D d, Packet* packet, int lane, hn::Mask<D> hit, V t,
                              uint32_t primitive) {
  const V best = hn::Load(d, packet->best_t + lane);
  uint32_t ties = BitsOfMask(d, hn::And(hit, hn::Eq(t, best)));
  for (; ties != 0; ties &= ties - 1) {
    uint32_t& other = packet->best_primitive[lane + __builtin_ctz(ties)];
    other = std::min(other, primitive);
  }
  const auto nearer = hn::And(hit, hn::Lt(t, best));
  uint32_t bits = BitsOfMask(d, nearer);
  if (bits == 0) return;
  const V new_best = hn::IfThenElse(nearer, t, best);
  hn::Store(new_best, d, packet->best_t + lane);
  const hn::Rebind<float, D> df;
  hn::StoreU(UpperDepth(d, new_best, hn::Load(d, packet->t_scale + lane)), df,
             packet->floats.depth + lane);
  for (; bits != 0; bits &= bits - 1)
    packet->best_primitive[lane + __builtin_ctz(bits)] = primitive;
}

// The lanes, as bits, of the rays that start on this primitive.
HWY_INLINE uint32_t StartingLanes(const Packet& packet, uint32_t primitive) {
  uint32_t lanes = 0;
  for (int i = 0; i < packet.width; ++i) {
    lanes |= static_cast<uint32_t>(packet.start[i] == primitive) << i;
  }
  return lanes;
}

// Marks the lanes of `bits` as occluded. As in Embree, a limit of -infinity stands for that.
HWY_INLINE void RecordOccluded(Packet* packet, uint32_t bits) {
  packet->occluded |= bits;
  for (; bits != 0; bits &= bits - 1) {
    packet->floats.depth[__builtin_ctz(bits)] = -std::numeric_limits<float>::infinity();
  }
}

}  // namespace nacre::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
