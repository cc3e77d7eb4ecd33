// SPDX-License-Identifier: Apache-2.0
// visibility/sphere_kernel.cc: a float test proposes the rays of a packet that may hit a sphere,
// and the double test decides.
#include "visibility/sphere_kernel.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "visibility/sphere_kernel.cc"
#include "hwy/foreach_target.h"

#include "base/geometry-inl.h"
#include "visibility/occlusion-inl.h"
#include "visibility/sphere_packet-inl.h"

HWY_BEFORE_NAMESPACE();
namespace nacre {
namespace HWY_NAMESPACE {
namespace {
namespace hn = hwy::HWY_NAMESPACE;

void IntersectSphere(const RTCIntersectFunctionNArguments* args) {
  Packet& packet = PacketOf(args->context);
  const auto& geometry = *static_cast<const TraceGeometry*>(args->geometryUserPtr);
  const TraceSphere& sphere = geometry.spheres[args->primID];
  const uint32_t lanes = ActiveLanes(packet, args->valid, args->rayhit, args->N);
  IntersectLanes(sphere, args->primID, lanes, &packet);
  ReturnDepths(packet, args->valid, args->rayhit, args->N);
}

// The lanes whose ray starts on this sphere, or on one that coincides with it.
template <class D>
HWY_INLINE hn::Mask<D> StartsOn(D d, const Packet& packet, int lane, const TraceSphere& sphere) {
  const auto same = [&](int i, double value) HWY_ATTR {
    return hn::Eq(hn::Load(d, packet.start_sphere[i] + lane), hn::Set(d, value));
  };
  return hn::And(hn::And(same(0, sphere.center.x), same(1, sphere.center.y)),
                 hn::And(same(2, sphere.center.z), same(3, sphere.radius)));
}

void OccludedBySphere(const RTCOccludedFunctionNArguments* args) {
  Packet& packet = PacketOf(args->context);
  if (packet.target.Contains(args->primID)) return;
  const auto& geometry = *static_cast<const TraceGeometry*>(args->geometryUserPtr);
  const TraceSphere& sphere = geometry.spheres[args->primID];
  uint32_t lanes = ActiveLanes(packet, args->valid, args->ray, args->N);
  lanes &= ProposedLanes(hn::CappedTag<float, kMaxPacketWidth>(), packet, sphere);
  if (lanes == 0) return;
  const hn::ScalableTag<double> d;
  const int step = static_cast<int>(hn::Lanes(d));
  uint32_t occluded = 0;
  for (int lane = 0; lane < packet.width; lane += step) {
    const auto proposed = MaskOfBits(d, lanes, lane);
    if (hn::AllFalse(d, proposed)) continue;
    const auto rays = ShadowRaysOf(d, packet, lane);
    const auto to_center = Sub(SetVec3(d, sphere.center), rays.origin);
    const auto radius = hn::Set(d, sphere.radius);
    const auto hit = TestSphere(d, to_center, rays.direction, rays.inverse_dd, radius);
    const auto in_the_way = InTheWay(d, rays, to_center, radius, hit,
                                     StartsOn(d, packet, lane, sphere), packet.outward);
    occluded |= BitsOfMask(d, hn::And(proposed, in_the_way)) << lane;
  }
  RecordOccluded(&packet, occluded);
  ReturnDepths(packet, args->valid, args->ray, args->N);
}

PrimitiveCallbacks Callbacks() { return {&IntersectSphere, &OccludedBySphere}; }

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace nacre
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace nacre {
HWY_EXPORT(Callbacks);
PrimitiveCallbacks SphereCallbacks() { return HWY_DYNAMIC_DISPATCH(Callbacks)(); }
}  // namespace nacre
#endif
