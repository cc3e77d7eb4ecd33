// SPDX-License-Identifier: Apache-2.0
// embree/sphere_kernel.cc: the double test of a packet of rays against one sphere.
#include "embree/embree_packet.h"
#include "embree/primitives.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "embree/sphere_kernel.cc"
#include "hwy/foreach_target.h"

#include "visibility/sphere_packet-inl.h"

HWY_BEFORE_NAMESPACE();
namespace nacre::HWY_NAMESPACE {
namespace {
namespace hn = hwy::HWY_NAMESPACE;

void IntersectSphere(const RTCIntersectFunctionNArguments* args) {
  EmbreePacket& embree = PacketOf(args->context);
  const auto& geometry = *static_cast<const TraceGeometry*>(args->geometryUserPtr);
  const TraceSphere& sphere = geometry.spheres[args->primID];
  const uint32_t lanes = ActiveLanes(embree, args->valid, args->rayhit, args->N);
  IntersectLanes(sphere, args->primID, lanes, &embree.packet);
  ReturnDepths(embree, args->valid, args->rayhit, args->N);
}

void OccludedBySphere(const RTCOccludedFunctionNArguments* args) {
  EmbreePacket& embree = PacketOf(args->context);
  if (embree.packet.target.Contains(args->primID)) return;
  const auto& geometry = *static_cast<const TraceGeometry*>(args->geometryUserPtr);
  const TraceSphere& sphere = geometry.spheres[args->primID];
  OccludeLanes(sphere, ActiveLanes(embree, args->valid, args->ray, args->N), &embree.packet);
  ReturnDepths(embree, args->valid, args->ray, args->N);
}

PrimitiveCallbacks Callbacks() { return {&IntersectSphere, &OccludedBySphere}; }

}  // namespace
}  // namespace nacre::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace nacre {
HWY_EXPORT(Callbacks);
PrimitiveCallbacks SphereCallbacks() { return HWY_DYNAMIC_DISPATCH(Callbacks)(); }
}  // namespace nacre
#endif
