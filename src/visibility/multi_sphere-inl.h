// SPDX-License-Identifier: Apache-2.0
// visibility/multi_sphere-inl.h: a packet of camera rays against the spheres of its cells, where
// each ray may hit several spheres.
//
// Spheres rarely overlap in the image along a ray, so most rays pass the float test of at most one
// sphere. For these, a single exact test in which each lane has its own sphere is enough, however
// many spheres the packet meets. The other rays are tested sphere by sphere, nearest first.
// spheres the packet meets. The other rays are tested sphere by sphere, nearest first.
#if defined(NACRE_VISIBILITY_MULTI_SPHERE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef NACRE_VISIBILITY_MULTI_SPHERE_INL_H_
#undef NACRE_VISIBILITY_MULTI_SPHERE_INL_H_
#else
#define NACRE_VISIBILITY_MULTI_SPHERE_INL_H_
#endif

#include <cmath>
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

// Candidates are sorted nearest first, so the loop ends at the first one beyond every lane's hit.
// A hit's distance from the camera is t |direction|, and its depth here t |direction|^2.
template <bool kPerspective>
HWY_INLINE void TraceCell(const CameraFrame& frame, const std::vector<TileCandidate>& candidates,
                          CameraPacket* packet) {
  const float length = SmallestLength(*packet);
  float depth = LargestDepth(*packet);
  for (const TileCandidate& candidate : candidates) {
    if (candidate.near * length > depth) return;
    if ((candidate.pixel_rows & packet->pixel_rows) == 0) continue;
    if (TestCandidate<kPerspective>(frame, candidate, packet)) depth = LargestDepth(*packet);
  }
}

// Lanes, as bits, by the number of spheres whose float test they pass.
struct Proposals {
  uint32_t single = 0;  // one sphere, which is stored in the packet
  uint32_t several = 0;
};

// With more lanes than these in Proposals::several, testing all lanes sphere by sphere is faster.
inline constexpr int kMaxSeveralLanes = 4;

template <bool kPerspective>
HWY_INLINE Proposals ProposeSpheres(const CameraFrame& frame,
                                    const std::vector<TileCandidate>* begin,
                                    const std::vector<TileCandidate>* end, CameraPacket* packet) {
  const int step = static_cast<int>(hn::Lanes(CameraDouble()));
  uint32_t any = 0, several = 0;
  for (; begin != end; ++begin) {
    for (const TileCandidate& candidate : *begin) {
      if ((candidate.pixel_rows & packet->pixel_rows) == 0) continue;
      const uint32_t lanes = ProposedLanes<kPerspective, true>(frame, candidate, *packet);
      for (int lane = 0; lane < kCameraPacket; lane += step) {
        const uint32_t fresh = (lanes & ~any) >> lane & ((1u << step) - 1);
        if (fresh != 0) SetSphere(candidate, lane, fresh, packet);
      }
      // A sphere may be listed in two cells.
      for (uint32_t again = lanes & any & ~several; again != 0; again &= again - 1) {
        const int lane = __builtin_ctz(again);
        if (packet->primitive[lane] != candidate.primitive) several |= 1u << lane;
      }
      any |= lanes;
      if (__builtin_popcount(several) > kMaxSeveralLanes) return {0, packet->lanes};
    }
  }
  return {any & ~several, several};
}

// Restricts the packet to these lanes: in all others no hit is near enough to count.
HWY_INLINE void KeepLanes(uint32_t lanes, CameraPacket* packet) {
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
  KeepLanes(packet->lanes, packet);
  const Proposals proposals = ProposeSpheres<kPerspective>(frame, begin, end, packet);
  if (proposals.single != 0) TestProposed<kPerspective>(frame, proposals.single, packet);
  if (proposals.several == 0) return;
  KeepLanes(proposals.several, packet);
  std::fill_n(packet->t, kCameraPacket, std::numeric_limits<double>::infinity());
  for (; begin != end; ++begin) TraceCell<kPerspective>(frame, *begin, packet);
}

}  // namespace HWY_NAMESPACE
}  // namespace nacre
HWY_AFTER_NAMESPACE();
#endif
