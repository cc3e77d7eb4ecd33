// SPDX-License-Identifier: Apache-2.0
// visibility/exact_lanes-inl.h: the exact tests of a packet of camera rays, one vector of lanes at
// a time.
#if defined(NACRE_VISIBILITY_EXACT_LANES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef NACRE_VISIBILITY_EXACT_LANES_INL_H_
#undef NACRE_VISIBILITY_EXACT_LANES_INL_H_
#else
#define NACRE_VISIBILITY_EXACT_LANES_INL_H_
#endif

#include "visibility/camera_packet-inl.h"
#include "visibility/projected_sphere_test-inl.h"
#include "visibility/sphere_test-inl.h"
#include "visibility/surface-inl.h"

HWY_BEFORE_NAMESPACE();
namespace nacre {
namespace HWY_NAMESPACE {
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
  const auto to_center = kPerspective ? center : Sub(center, LoadLanes(packet.exact_varying, lane));
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
  const auto backward = Negated(LoadLanes(packet.exact_varying, lane));
  const auto hit = TestProjected(d, projected, backward, hn::Load(d, packet.exact_dd + lane));
  const auto root = hn::Sqrt(hit.discriminant);
  return {hn::Ge(hit.discriminant, hn::Zero(d)), ProjectedDepth(center, radius, backward, root),
          ProjectedNormal(hit.offset, BackToHit(root, hit.back), Scale(backward, inverse_length),
                          inverse_length),
          radius};
}

HWY_INLINE void StoreAll(const ExactHits& hits, int lane, CameraPacket* packet) {
  const CameraDouble d;
  Store3(hits.normal, d, packet->normal[0] + lane, packet->normal[1] + lane,
         packet->normal[2] + lane);
  hn::Store(hits.signed_radius, d, packet->signed_radius + lane);
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
    const auto center = LoadLanes(packet->center, lane);
    const auto radius = hn::Load(d, packet->radius + lane);
    const uint32_t projected = bits & packet->projected >> lane;
    if (!kPerspective || projected != bits) {
      const ExactHits hits = GeneralHits<kPerspective>(frame, *packet, lane, center, radius);
      packet->hit |= (BitsOfMask(d, hits.hit) & bits & ~projected) << lane;
      StoreAll(hits, lane, packet);
    }
    if (kPerspective && projected != 0) {
      const ProjectedSphereV<hn::Vec<CameraDouble>> sphere{
          LoadLanes(packet->projected_center, lane), LoadLanes(packet->projected_error, lane),
          hn::Load(d, packet->projected_scale + lane)};
      const ExactHits hits = ProjectedHits(*packet, lane, sphere, center, radius);
      packet->hit |= (BitsOfMask(d, hits.hit) & projected) << lane;
      StoreMasked(hits, MaskOfBits(d, projected, 0), lane, packet);
    }
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace nacre
HWY_AFTER_NAMESPACE();
#endif
