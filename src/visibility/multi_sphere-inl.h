// SPDX-License-Identifier: Apache-2.0
// visibility/multi_sphere-inl.h: a packet of camera rays against the spheres of its cells, where
// each ray may hit several spheres.
//
// Spheres rarely overlap in the image along a ray, so most rays pass the float test of at most one
// sphere. For these, a single exact test in which each lane has its own sphere is enough, however
// many spheres the packet meets. The other rays are tested sphere by sphere, nearest first.
#if defined(NACRE_VISIBILITY_MULTI_SPHERE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef NACRE_VISIBILITY_MULTI_SPHERE_INL_H_
#undef NACRE_VISIBILITY_MULTI_SPHERE_INL_H_
#else
#define NACRE_VISIBILITY_MULTI_SPHERE_INL_H_
#endif

#include <cmath>
#include <limits>

#include "visibility/camera_packet-inl.h"
#include "visibility/projected_sphere_test-inl.h"
#include "visibility/sphere_test-inl.h"

HWY_BEFORE_NAMESPACE();
namespace nacre::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Hits of one vector of rays.
struct ExactHits {
  hn::Mask<CameraDouble> hit;
  hn::Vec<CameraDouble> t;
  Vec3V<hn::Vec<CameraDouble>> normal;
  hn::Vec<CameraDouble> signed_radius;
};

// Hits by the general test, for any spheres.
template <bool kPerspective>
HWY_INLINE ExactHits GeneralHits(const CameraFrame& frame, const CameraPacket& packet, int lane,
                                 const Vec3V<hn::Vec<CameraDouble>>& center,
                                 hn::Vec<CameraDouble> radius) {
  const CameraDouble d;
  const auto to_center = kPerspective ? center : Sub(center, Load3(d, packet.exact_varying, lane));
  const auto direction = ExactDirection<kPerspective>(d, frame, lane, packet);
  const auto dd = hn::Load(d, packet.exact_dd + lane);
  const auto hit = TestSphere(d, to_center, direction, hn::Div(hn::Set(d, 1.0), dd), radius);
  const auto root = hn::IfThenElse(hit.inside, hit.root, hn::Neg(hit.root));
  const auto signed_radius = SignedRadius(radius, root);
  return {hit.hit, hit.t,
          SphereNormal(d, ScaledCenterToHit(direction, root, hit.moment), dd, signed_radius),
          signed_radius};
}

// Hits by the projected test.
HWY_INLINE ExactHits ProjectedHits(const CameraPacket& packet, int lane,
                                   const ProjectedSphereV<hn::Vec<CameraDouble>>& projected,
                                   const Vec3V<hn::Vec<CameraDouble>>& center,
                                   hn::Vec<CameraDouble> radius) {
  const CameraDouble d;
  const auto inverse_length = hn::Load(d, packet.inverse_length + lane);
  const auto backward = Negated(Load3(d, packet.exact_varying, lane));
  const auto hit = TestProjected(d, projected, backward, hn::Load(d, packet.exact_dd + lane));
  const auto root = hn::Sqrt(hit.discriminant);
  return {hn::Ge(hit.discriminant, hn::Zero(d)), ProjectedDepth(center, radius, backward, root),
          ProjectedNormal(hit.offset, BackToHit(root, hit.back), Scale(backward, inverse_length),
                          inverse_length),
          radius};
}

HWY_INLINE void StoreMasked(const ExactHits& hits, hn::Mask<CameraDouble> lanes, int lane,
                            CameraPacket* packet) {
  const CameraDouble d;
  const auto store = [&](hn::Vec<CameraDouble> value, double* to) HWY_ATTR {
    hn::Store(hn::IfThenElse(lanes, value, hn::Load(d, to + lane)), d, to + lane);
  };
  store(hits.normal.x, packet->normal[0]);
  store(hits.normal.y, packet->normal[1]);
  store(hits.normal.z, packet->normal[2]);
  store(hits.signed_radius, packet->signed_radius);
}

// Records those hits that are nearer than the lane's nearest so far or, at the same distance, have
// the lower primitive id.
HWY_INLINE void KeepNearer(const ExactHits& hits, hn::Mask<CameraDouble> proposed,
                           const TileCandidate& candidate, int lane, CameraPacket* packet) {
  const CameraDouble d;
  const auto found = hn::And(proposed, hits.hit);
  const auto best = hn::Load(d, packet->t + lane);
  auto nearer = hn::And(found, hn::Lt(hits.t, best));
  uint32_t bits = BitsOfMask(d, nearer);
  uint32_t ties = BitsOfMask(d, hn::And(found, hn::Eq(hits.t, best)));
  for (; ties != 0; ties &= ties - 1) {
    const int tie = __builtin_ctz(ties);
    if (candidate.primitive < packet->primitive[lane + tie]) bits |= 1u << tie;
  }
  if (bits == 0) return;
  nearer = MaskOfBits(d, bits, 0);
  const auto t = hn::IfThenElse(nearer, hits.t, best);
  hn::Store(t, d, packet->t + lane);
  StoreMasked(hits, nearer, lane, packet);
  const hn::Rebind<float, CameraDouble> df;
  hn::StoreU(UpperDepth(d, t, hn::Load(d, packet->exact_dd + lane)), df, packet->depth + lane);
  packet->hit |= bits << lane;
  SetSphere(candidate, lane, bits, packet);
}

// Tests the packet against a candidate and keeps its nearest hits. Returns false if the float test
// proposed no lane.
template <bool kPerspective>
HWY_INLINE bool TestCandidate(const CameraFrame& frame, const TileCandidate& candidate,
                              CameraPacket* packet) {
  const uint32_t lanes = ProposedLanes<kPerspective, false>(frame, candidate, *packet);
  if (lanes == 0) return false;
  const CameraDouble d;
  const auto center = SetVec3(d, candidate.sphere.center);
  const auto radius = hn::Set(d, candidate.sphere.radius);
  const int step = static_cast<int>(hn::Lanes(d));
  for (int lane = 0; lane < kCameraPacket; lane += step) {
    const auto proposed = MaskOfBits(d, lanes, lane);
    if (hn::AllFalse(d, proposed)) continue;
    if ((packet->exact >> lane & 1) == 0) {
      FillExactRays<kPerspective>(d, frame, lane, packet);
      packet->exact |= 1u << lane;
    }
    const ExactHits hits =
        kPerspective && candidate.projected != nullptr
            ? ProjectedHits(*packet, lane, SetProjectedSphere(d, *candidate.projected), center,
                            radius)
            : GeneralHits<kPerspective>(frame, *packet, lane, center, radius);
    KeepNearer(hits, proposed, candidate, lane, packet);
  }
  return true;
}

// Runs the exact tests of the lanes in `single`, each against the sphere that the packet holds for
// it.
template <bool kPerspective>
HWY_INLINE void TestProposed(const CameraFrame& frame, uint32_t single, CameraPacket* packet) {
  const CameraDouble d;
  const int step = static_cast<int>(hn::Lanes(d));
  for (int lane = 0; lane < kCameraPacket; lane += step) {
    const uint32_t bits = (single >> lane) & ((1u << step) - 1);
    if (bits == 0) continue;
    FillExactRays<kPerspective>(d, frame, lane, packet);
    packet->exact |= 1u << lane;
    const auto center = Load3(d, packet->center, lane);
    const auto radius = hn::Load(d, packet->radius + lane);
    const uint32_t projected = bits & packet->projected >> lane;
    if (!kPerspective || projected != bits) {
      const ExactHits hits = GeneralHits<kPerspective>(frame, *packet, lane, center, radius);
      packet->hit |= (BitsOfMask(d, hits.hit) & bits & ~projected) << lane;
      Store3(hits.normal, d, packet->normal, lane);
      hn::Store(hits.signed_radius, d, packet->signed_radius + lane);
    }
    if (kPerspective && projected != 0) {
      const ProjectedSphereV<hn::Vec<CameraDouble>> sphere{
          Load3(d, packet->projected_center, lane), Load3(d, packet->projected_error, lane),
          hn::Load(d, packet->projected_scale + lane)};
      const ExactHits hits = ProjectedHits(*packet, lane, sphere, center, radius);
      packet->hit |= (BitsOfMask(d, hits.hit) & projected) << lane;
      StoreMasked(hits, MaskOfBits(d, projected, 0), lane, packet);
    }
  }
}

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

}  // namespace nacre::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
