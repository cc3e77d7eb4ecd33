// SPDX-License-Identifier: Apache-2.0
// visibility/camera_packet-inl.h: a packet of camera rays on its way through a tile's candidates:
// float rays that propose, double rays that decide, and the best hit of each lane so far.
#if defined(NACRE_VISIBILITY_CAMERA_PACKET_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef NACRE_VISIBILITY_CAMERA_PACKET_INL_H_
#undef NACRE_VISIBILITY_CAMERA_PACKET_INL_H_
#else
#define NACRE_VISIBILITY_CAMERA_PACKET_INL_H_
#endif

#include "base/geometry-inl.h"
#include "visibility/inverse_length-inl.h"
#include "visibility/packet-inl.h"
#include "visibility/sphere_test-inl.h"
#include "visibility/tile_kernel.h"

HWY_BEFORE_NAMESPACE();
namespace nacre {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

inline constexpr int kCameraPacket = 16;
using CameraDouble = hn::CappedTag<double, kCameraPacket>;
using CameraFloat = hn::CappedTag<float, kCameraPacket>;

// Each ray has a vector of its own, its direction (perspective) or its origin (orthographic):
// corner + x step_x + y step_y of the frame. The other vector is the same for all.
struct CameraPacket {
  uint32_t lanes;        // that hold rays, as bits
  uint32_t pixel_rows;   // of their cells that the rays may lie in, as bits
  const double* film_x;  // the packet's piece of the batch
  const double* film_y;
  // In float, for proposals: the own vectors, and the squared length of the directions.
  alignas(kVectorBytes) float own[3][kCameraPacket];
  alignas(kVectorBytes) float dd[kCameraPacket];
  // In double, for the groups of lanes that some sphere was proposed for.
  uint32_t exact;
  alignas(kVectorBytes) double exact_own[3][kCameraPacket];
  alignas(kVectorBytes) double exact_dd[kCameraPacket];
  alignas(kVectorBytes) double inverse_length[kCameraPacket];  // of the direction
  alignas(kVectorBytes) double inverse_dd[kCameraPacket];
  // The best hits so far, of the lanes in `hit`.
  uint32_t hit;
  alignas(kVectorBytes) float depth[kCameraPacket];  // no hit beyond this t |direction|^2 counts
  alignas(kVectorBytes) double t[kCameraPacket];
  alignas(kVectorBytes) double root[kCameraPacket];  // negative where the ray starts outside
  alignas(kVectorBytes) double moment[3][kCameraPacket];
  // The spheres that the lanes are proposed, then hit.
  alignas(kVectorBytes) uint32_t primitive[kCameraPacket] = {};
  alignas(kVectorBytes) double center[3][kCameraPacket] = {};
  alignas(kVectorBytes) double radius[kCameraPacket] = {};
};

// The candidate becomes the sphere of the lanes in `bits`, of the group from `lane` on. Whole
// vectors are stored: they are read as such soon.
HWY_INLINE void SetSphere(const TileCandidate& candidate, int lane, uint32_t bits,
                          CameraPacket* packet) {
  const auto set = [&](auto d, auto value, auto* to) HWY_ATTR {
    hn::Store(hn::IfThenElse(MaskOfBits(d, bits, 0), hn::Set(d, value), hn::Load(d, to + lane)), d,
              to + lane);
  };
  const CameraDouble d;
  set(d, candidate.sphere.center.x, packet->center[0]);
  set(d, candidate.sphere.center.y, packet->center[1]);
  set(d, candidate.sphere.center.z, packet->center[2]);
  set(d, candidate.sphere.radius, packet->radius);
  set(hn::Rebind<uint32_t, CameraDouble>(), candidate.primitive, packet->primitive);
}

HWY_INLINE Vec3V<hn::Vec<CameraDouble>> Centers(const CameraPacket& packet, int lane) {
  return Load3(CameraDouble(), packet.center[0] + lane, packet.center[1] + lane,
               packet.center[2] + lane);
}

// A vector of floats from doubles.
HWY_INLINE hn::Vec<CameraFloat> LoadRounded(const double* from) {
  const CameraFloat d;
#if HWY_TARGET == HWY_SCALAR
  return hn::Set(d, static_cast<float>(*from));
#else
  const CameraDouble dd;
  const hn::Half<CameraFloat> half;
  return hn::Combine(d, hn::DemoteTo(half, hn::LoadU(dd, from + hn::Lanes(dd))),
                     hn::DemoteTo(half, hn::LoadU(dd, from)));
#endif
}

template <bool kPerspective>
HWY_INLINE void FillFloatRays(const CameraFrame& frame, CameraPacket* packet) {
  const CameraFloat d;
  const auto corner = SetVec3(d, frame.corner);
  const auto step_x = SetVec3(d, frame.step_x);
  const auto step_y = SetVec3(d, frame.step_y);
  for (size_t i = 0; i < kCameraPacket; i += hn::Lanes(d)) {
    const auto x = LoadRounded(packet->film_x + i);
    const auto y = LoadRounded(packet->film_y + i);
    Vec3V<hn::Vec<CameraFloat>> own;
    own.x = hn::MulAdd(step_y.x, y, hn::MulAdd(step_x.x, x, corner.x));
    own.y = hn::MulAdd(step_y.y, y, hn::MulAdd(step_x.y, x, corner.y));
    own.z = hn::MulAdd(step_y.z, y, hn::MulAdd(step_x.z, x, corner.z));
    Store3(own, d, packet->own[0] + i, packet->own[1] + i, packet->own[2] + i);
    hn::Store(kPerspective ? FusedDot(own, own) : hn::Set(d, 1.0f), d, packet->dd + i);
  }
}

// The lanes whose float rays pass within the candidate's reach of its centre and, unless the
// candidate is the only one, do so in front of the camera and before their depth. They include all
// that hit it truly: GatherTile makes the reach.
//
// The distance of the centre from the line is |to_center x direction| / |direction|, so nothing is
// divided; along the line both other conditions leave a slack of the reach, too.
template <bool kPerspective, bool kAlone>
HWY_INLINE uint32_t ProposedLanes(const CameraFrame& frame, const TileCandidate& candidate,
                                  const CameraPacket& packet) {
  const CameraFloat d;
  using V = hn::Vec<CameraFloat>;
  const Vec3V<V> center{hn::Set(d, candidate.center[0]), hn::Set(d, candidate.center[1]),
                        hn::Set(d, candidate.center[2])};
  const V reach2 = hn::Set(d, candidate.reach * candidate.reach);
  uint32_t lanes = 0;
  for (size_t i = 0; i < kCameraPacket; i += hn::Lanes(d)) {
    const Vec3V<V> own = Load3(d, packet.own[0] + i, packet.own[1] + i, packet.own[2] + i);
    const Vec3V<V> to_center = kPerspective ? center : Sub(center, own);
    const Vec3V<V> direction = kPerspective ? own : SetVec3(d, frame.forward);
    const Vec3V<V> cross = FusedCross(to_center, direction);
    const V limit = hn::Mul(reach2, hn::Load(d, packet.dd + i));
    auto proposed = hn::Le(FusedDot(cross, cross), limit);
    if constexpr (!kAlone) {
      const V along = FusedDot(to_center, direction);
      const V beyond = hn::Sub(along, hn::Load(d, packet.depth + i));
      const V zero = hn::Zero(d);
      const auto ahead = hn::Or(hn::Gt(along, zero), hn::Le(hn::Mul(along, along), limit));
      const auto near_enough = hn::Or(hn::Le(beyond, zero), hn::Le(hn::Mul(beyond, beyond), limit));
      proposed = hn::And(proposed, hn::And(ahead, near_enough));
    }
    lanes |= BitsOfMask(d, proposed) << i;
  }
  return lanes & packet.lanes;
}

// The own vectors, in double, of the lanes from `lane` on: by the operations of MakeCameraRays.
template <class D>
HWY_INLINE Vec3V<hn::Vec<D>> ExactOwn(D d, const CameraFrame& frame, int lane,
                                      const CameraPacket& packet) {
  const auto x = hn::LoadU(d, packet.film_x + lane);
  const auto y = hn::LoadU(d, packet.film_y + lane);
  return MulAdd3(SetVec3(d, frame.step_y), y,
                 MulAdd3(SetVec3(d, frame.step_x), x, SetVec3(d, frame.corner)));
}

// The double rays of the lanes from `lane` on.
template <bool kPerspective, class D>
HWY_INLINE void FillExactRays(D d, const CameraFrame& frame, int lane, CameraPacket* packet) {
  using V = hn::Vec<D>;
  const Vec3V<V> own = ExactOwn(d, frame, lane, *packet);
  const Vec3V<V> direction = kPerspective ? own : SetVec3(d, frame.forward);
  const V dd = FusedDot(direction, direction);
  Store3(own, d, packet->exact_own[0] + lane, packet->exact_own[1] + lane,
         packet->exact_own[2] + lane);
  hn::Store(dd, d, packet->exact_dd + lane);
  hn::Store(InverseLength(d, dd), d, packet->inverse_length + lane);
  hn::Store(hn::Div(hn::Set(d, 1.0), dd), d, packet->inverse_dd + lane);
}

template <bool kPerspective, class D>
HWY_INLINE Vec3V<hn::Vec<D>> ExactDirection(D d, const CameraFrame& frame, int lane,
                                            const CameraPacket& packet) {
  if constexpr (!kPerspective) return SetVec3(d, frame.forward);
  return Load3(d, packet.exact_own[0] + lane, packet.exact_own[1] + lane,
               packet.exact_own[2] + lane);
}

// Keeps the hits that come before the best ones: those nearer, and among equals the lower id.
HWY_INLINE void KeepNearer(const SphereHitV<CameraDouble>& hit, hn::Mask<CameraDouble> proposed,
                           const TileCandidate& candidate, int lane, CameraPacket* packet) {
  const CameraDouble d;
  const auto found = hn::And(proposed, hit.hit);
  const auto best = hn::Load(d, packet->t + lane);
  auto nearer = hn::And(found, hn::Lt(hit.t, best));
  uint32_t bits = BitsOfMask(d, nearer);
  uint32_t ties = BitsOfMask(d, hn::And(found, hn::Eq(hit.t, best)));
  for (; ties != 0; ties &= ties - 1) {
    const int tie = __builtin_ctz(ties);
    if (candidate.primitive < packet->primitive[lane + tie]) bits |= 1u << tie;
  }
  if (bits == 0) return;
  nearer = MaskOfBits(d, bits, 0);
  const auto keep = [&](hn::Vec<CameraDouble> value, double* to) HWY_ATTR {
    hn::Store(hn::IfThenElse(nearer, value, hn::Load(d, to + lane)), d, to + lane);
  };
  keep(hit.t, packet->t);
  keep(hn::IfThenElse(hit.inside, hit.root, hn::Neg(hit.root)), packet->root);
  keep(hit.moment.x, packet->moment[0]);
  keep(hit.moment.y, packet->moment[1]);
  keep(hit.moment.z, packet->moment[2]);
  const hn::Rebind<float, CameraDouble> df;
  hn::StoreU(UpperDepth(d, hn::Load(d, packet->t + lane), hn::Load(d, packet->exact_dd + lane)), df,
             packet->depth + lane);
  packet->hit |= bits << lane;
  SetSphere(candidate, lane, bits, packet);
}

// One of several candidates.
template <bool kPerspective>
HWY_INLINE bool TestOneOfMany(const CameraFrame& frame, const TileCandidate& candidate,
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
    const auto to_center =
        kPerspective ? center
                     : Sub(center, Load3(d, packet->exact_own[0] + lane,
                                         packet->exact_own[1] + lane, packet->exact_own[2] + lane));
    const auto direction = ExactDirection<kPerspective>(d, frame, lane, *packet);
    const auto hit =
        TestSphere(d, to_center, direction, hn::Load(d, packet->inverse_dd + lane), radius);
    KeepNearer(hit, proposed, candidate, lane, packet);
  }
  return true;
}

}  // namespace HWY_NAMESPACE
}  // namespace nacre
HWY_AFTER_NAMESPACE();
#endif
