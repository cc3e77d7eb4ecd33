// SPDX-License-Identifier: Apache-2.0
// visibility/camera_packet-inl.h: the state of a packet of camera rays while it is tested against a
// tile's candidates: rays in float for the conservative test, rays in double for the exact test,
// and each lane's nearest hit so far. The float test proposes lanes, the exact test decides.
#if defined(NACRE_VISIBILITY_CAMERA_PACKET_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef NACRE_VISIBILITY_CAMERA_PACKET_INL_H_
#undef NACRE_VISIBILITY_CAMERA_PACKET_INL_H_
#else
#define NACRE_VISIBILITY_CAMERA_PACKET_INL_H_
#endif

#include "base/aligned.h"
#include "base/target_ops-inl.h"
#include "base/vec3-inl.h"
#include "visibility/packet-inl.h"
#include "visibility/tile_candidates.h"

HWY_BEFORE_NAMESPACE();
namespace nacre::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

inline constexpr int kCameraPacket = 16;
using CameraDouble = hn::CappedTag<double, kCameraPacket>;
using CameraFloat = hn::CappedTag<float, kCameraPacket>;

// One vector varies from ray to ray, corner + x step_x + y step_y of the frame: the direction if
// the camera is perspective, the origin if it is orthographic. The other one is the same for all
// rays.
struct CameraPacket {
  uint32_t lanes;        // lanes that hold rays, as bits
  uint32_t pixel_rows;   // pixel rows of their cells that the rays may lie in, as bits
  const double* film_x;  // film positions: the packet's piece of the batch
  const double* film_y;
  // In float: the varying vectors, and the directions' squared lengths.
  alignas(kVectorBytes) float varying[3][kCameraPacket];
  alignas(kVectorBytes) float dd[kCameraPacket];
  // In double. Filled for the groups of lanes that any float test proposed a lane of, whose first
  // lanes are the bits of `exact`.
  uint32_t exact;
  alignas(kVectorBytes) double exact_varying[3][kCameraPacket];
  alignas(kVectorBytes) double exact_dd[kCameraPacket];
  alignas(kVectorBytes) double inverse_length[kCameraPacket];  // 1 / |direction|
  // The nearest hits so far of the lanes in `hit`.
  uint32_t hit;
  alignas(kVectorBytes) float depth[kCameraPacket];  // limit of t |direction|^2, rounded up
  alignas(kVectorBytes) double t[kCameraPacket];
  alignas(kVectorBytes) double normal[3][kCameraPacket];      // on the ray's side
  alignas(kVectorBytes) double signed_radius[kCameraPacket];  // SignedRadius
  // The sphere of each lane: the one that it was proposed for, later the one that it hit. Lanes in
  // `projected` use the projected test.
  alignas(kVectorBytes) uint32_t primitive[kCameraPacket] = {};
  alignas(kVectorBytes) double center[3][kCameraPacket] = {};
  alignas(kVectorBytes) double radius[kCameraPacket] = {};
  uint32_t projected = 0;
  alignas(kVectorBytes) double projected_center[3][kCameraPacket] = {};
  alignas(kVectorBytes) double projected_error[3][kCameraPacket] = {};
  alignas(kVectorBytes) double projected_scale[kCameraPacket] = {};
};

// Stores the candidate as the sphere of the lanes in `bits`, of the group that begins at `lane`.
// Whole vectors are stored because they are soon loaded as such (store forwarding).
HWY_INLINE void SetSphere(const TileCandidate& candidate, int lane, uint32_t bits,
                          CameraPacket* packet) {
  const auto set = [&](auto d, auto value, auto* to) HWY_ATTR {
    hn::Store(hn::IfThenElse(MaskOfBits(d, bits, 0), hn::Set(d, value), hn::Load(d, to + lane)), d,
              to + lane);
  };
  const CameraDouble d;
  const auto set3 = [&](const Vec3d& v, double(&to)[3][kCameraPacket]) HWY_ATTR {
    for (int c = 0; c < 3; ++c) set(d, v[c], to[c]);
  };
  set3(candidate.sphere.center, packet->center);
  set(d, candidate.sphere.radius, packet->radius);
  set(hn::Rebind<uint32_t, CameraDouble>(), candidate.primitive, packet->primitive);
  packet->projected &= ~(bits << lane);
  if (candidate.projected == nullptr) return;
  packet->projected |= bits << lane;
  set3(candidate.projected->center, packet->projected_center);
  set3(candidate.projected->rounding_error, packet->projected_error);
  set(d, candidate.projected->scale, packet->projected_scale);
}

// Loads doubles and rounds them to a vector of floats.
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
    Vec3V<hn::Vec<CameraFloat>> varying;
    varying.x = hn::MulAdd(step_y.x, y, hn::MulAdd(step_x.x, x, corner.x));
    varying.y = hn::MulAdd(step_y.y, y, hn::MulAdd(step_x.y, x, corner.y));
    varying.z = hn::MulAdd(step_y.z, y, hn::MulAdd(step_x.z, x, corner.z));
    Store3(varying, d, packet->varying, i);
    hn::Store(kPerspective ? FusedDot(varying, varying) : hn::Set(d, 1.0f), d, packet->dd + i);
  }
}

// The float test: returns the lanes whose ray passes the candidate's centre within its radius bound
// and, unless the depth is ignored, does so in front of the camera and not beyond the lane's depth.
// They include all lanes that truly hit the sphere, because the bound covers the rounding
// (RadiusBound).
//
// The distance of the centre from the line is |to_center x direction| / |direction|, so nothing is
// divided. Along the line, too, both conditions leave a slack of the radius bound.
template <bool kPerspective, bool kIgnoreDepth>
HWY_INLINE uint32_t ProposedLanes(const CameraFrame& frame, const TileCandidate& candidate,
                                  const CameraPacket& packet) {
  const CameraFloat d;
  using V = hn::Vec<CameraFloat>;
  const Vec3V<V> center{hn::Set(d, candidate.center[0]), hn::Set(d, candidate.center[1]),
                        hn::Set(d, candidate.center[2])};
  const V radius2 = hn::Set(d, candidate.radius_bound * candidate.radius_bound);
  uint32_t lanes = 0;
  for (size_t i = 0; i < kCameraPacket; i += hn::Lanes(d)) {
    const Vec3V<V> varying = Load3(d, packet.varying, i);
    const Vec3V<V> to_center = kPerspective ? center : Sub(center, varying);
    const Vec3V<V> direction = kPerspective ? varying : SetVec3(d, frame.forward);
    const Vec3V<V> cross = FusedCross(to_center, direction);
    const V limit = hn::Mul(radius2, hn::Load(d, packet.dd + i));
    auto proposed = hn::Le(FusedDot(cross, cross), limit);
    if constexpr (!kIgnoreDepth) {
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

// Fills in the double rays of the lanes from `lane` on, computed with the operations of
// MakeCameraRays.
template <bool kPerspective, class D>
HWY_INLINE void FillExactRays(D d, const CameraFrame& frame, int lane, CameraPacket* packet) {
  using V = hn::Vec<D>;
  const V x = hn::LoadU(d, packet->film_x + lane);
  const V y = hn::LoadU(d, packet->film_y + lane);
  const Vec3V<V> varying = MulAdd3(SetVec3(d, frame.step_y), y,
                                   MulAdd3(SetVec3(d, frame.step_x), x, SetVec3(d, frame.corner)));
  const Vec3V<V> direction = kPerspective ? varying : SetVec3(d, frame.forward);
  const V dd = FusedDot(direction, direction);
  Store3(varying, d, packet->exact_varying, lane);
  hn::Store(dd, d, packet->exact_dd + lane);
  hn::Store(InverseLength(d, dd), d, packet->inverse_length + lane);
}

template <bool kPerspective, class D>
HWY_INLINE Vec3V<hn::Vec<D>> ExactDirection(D d, const CameraFrame& frame, int lane,
                                            const CameraPacket& packet) {
  if constexpr (!kPerspective) return SetVec3(d, frame.forward);
  return Load3(d, packet.exact_varying, lane);
}

}  // namespace nacre::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
