// SPDX-License-Identifier: Apache-2.0
// visibility/many-inl.h: a packet of camera rays against the spheres of its cells, of which each
// may hit several.
//
// Most rays are proposed one sphere at most, for spheres rarely lie one behind the other's edge:
// the exact test need be asked once for them, each lane about a sphere of its own, however many
// spheres the packet has. The others are traced sphere by sphere, nearest first.
#if defined(NACRE_VISIBILITY_MANY_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef NACRE_VISIBILITY_MANY_INL_H_
#undef NACRE_VISIBILITY_MANY_INL_H_
#else
#define NACRE_VISIBILITY_MANY_INL_H_
#endif

#include <limits>

#include "visibility/exact_lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace nacre {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

HWY_INLINE float LargestDepth(const CameraPacket& packet) {
  const CameraFloat d;
  auto largest = hn::Load(d, packet.depth);
  for (size_t i = hn::Lanes(d); i < kCameraPacket; i += hn::Lanes(d)) {
    largest = hn::Max(largest, hn::Load(d, packet.depth + i));
  }
  return hn::GetLane(hn::MaxOfLanes(d, largest));
}

HWY_INLINE float SmallestLength(const CameraPacket& packet) {
  const CameraFloat d;
  auto smallest = hn::Load(d, packet.dd);
  for (size_t i = hn::Lanes(d); i < kCameraPacket; i += hn::Lanes(d)) {
    smallest = hn::Min(smallest, hn::Load(d, packet.dd + i));
  }
  return std::sqrt(hn::GetLane(hn::MinOfLanes(d, smallest))) * (1 - 0x1p-20f);
}

// Candidates come nearest first: those beyond every lane's hit end it. t |direction| of a hit is
// its distance from the camera, and t |direction|^2 its depth.
template <bool kPerspective>
HWY_INLINE void TraceCell(const CameraFrame& frame, const std::vector<TileCandidate>& candidates,
                          CameraPacket* packet) {
  const float length = SmallestLength(*packet);
  float depth = LargestDepth(*packet);
  for (const TileCandidate& candidate : candidates) {
    if (candidate.near * length > depth) return;
    if ((candidate.pixel_rows & packet->pixel_rows) == 0) continue;
    if (TestOneOfMany<kPerspective>(frame, candidate, packet)) depth = LargestDepth(*packet);
  }
}

// Lanes by what they are proposed.
struct Proposals {
  uint32_t one = 0;   // a single sphere, the packet's
  uint32_t many = 0;  // several
};

// Beyond so many lanes with several spheres, the packet is better off without asking first.
inline constexpr int kFewLanes = 4;

template <bool kPerspective>
HWY_INLINE Proposals ProposeSpheres(const CameraFrame& frame,
                                    const std::vector<TileCandidate>* begin,
                                    const std::vector<TileCandidate>* end, CameraPacket* packet) {
  const int step = static_cast<int>(hn::Lanes(CameraDouble()));
  uint32_t any = 0, many = 0;
  for (; begin != end; ++begin) {
    for (const TileCandidate& candidate : *begin) {
      if ((candidate.pixel_rows & packet->pixel_rows) == 0) continue;
      const uint32_t lanes = ProposedLanes<kPerspective, true>(frame, candidate, *packet);
      for (int lane = 0; lane < kCameraPacket; lane += step) {
        const uint32_t fresh = (lanes & ~any) >> lane & ((1u << step) - 1);
        if (fresh != 0) SetSphere(candidate, lane, fresh, packet);
      }
      // Not where the same sphere comes from the next cell.
      for (uint32_t again = lanes & any & ~many; again != 0; again &= again - 1) {
        const int lane = __builtin_ctz(again);
        if (packet->primitive[lane] != candidate.primitive) many |= 1u << lane;
      }
      any |= lanes;
      if (__builtin_popcount(many) > kFewLanes) return {0, packet->lanes};
    }
  }
  return {any & ~many, many};
}

// No hit counts in any other lane.
HWY_INLINE void LeaveLanes(uint32_t lanes, CameraPacket* packet) {
  const CameraFloat d;
  const float infinity = std::numeric_limits<float>::infinity();
  packet->lanes = lanes;
  for (size_t i = 0; i < kCameraPacket; i += hn::Lanes(d)) {
    const auto left = MaskOfBits(d, lanes, static_cast<int>(i));
    hn::Store(hn::IfThenElse(left, hn::Set(d, infinity), hn::Set(d, -infinity)), d,
              packet->depth + i);
  }
}

// Traces the packet's rays against the cells that its pixels lie in.
template <bool kPerspective>
HWY_INLINE void TracePacket(const CameraFrame& frame, const std::vector<TileCandidate>* begin,
                            const std::vector<TileCandidate>* end, CameraPacket* packet) {
  FillFloatRays<kPerspective>(frame, packet);
  packet->hit = 0;
  packet->exact = 0;
  LeaveLanes(packet->lanes, packet);
  const Proposals proposals = ProposeSpheres<kPerspective>(frame, begin, end, packet);
  if (proposals.one != 0) TestProposed<kPerspective>(frame, proposals.one, packet);
  if (proposals.many == 0) return;
  LeaveLanes(proposals.many, packet);
  std::fill_n(packet->t, kCameraPacket, std::numeric_limits<double>::infinity());
  for (; begin != end; ++begin) TraceCell<kPerspective>(frame, *begin, packet);
}

}  // namespace HWY_NAMESPACE
}  // namespace nacre
HWY_AFTER_NAMESPACE();
#endif
