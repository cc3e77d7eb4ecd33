// SPDX-License-Identifier: Apache-2.0
// visibility/fill_packet-inl.h: fills packets with a batch's rays: rounded to float, with the terms
// that the exact tests need.
#if defined(NACRE_VISIBILITY_FILL_PACKET_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef NACRE_VISIBILITY_FILL_PACKET_INL_H_
#undef NACRE_VISIBILITY_FILL_PACKET_INL_H_
#else
#define NACRE_VISIBILITY_FILL_PACKET_INL_H_
#endif

#include <algorithm>

#include "base/math-inl.h"
#include "hit/batch.h"
#include "visibility/packet-inl.h"
#include "visibility/triangle_test-inl.h"

HWY_BEFORE_NAMESPACE();
namespace nacre::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Flushes to 0 the components that Embree would replace by 1e-18 before it takes their reciprocals,
// and somewhat larger ones: Embree ignores their sign, and the frustum of a packet with negative
// ones would be empty. This moves a ray by far less than rounding it does.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V FlushTiny(D d, V component) {
  return hn::IfThenElseZero(hn::Gt(hn::Abs(component), hn::Set(d, 0x1p-56)), component);
}

// Rounds the rays to float, but for their origins. Their directions are first divided by a power of
// two, so that the largest component is in [1, 2] and no product leaves float's range.
template <class D>
HWY_INLINE void FillLanes(D d, hn::Vec<D> t_max, int lane, Packet* packet) {
  using V = hn::Vec<D>;
  const hn::Rebind<float, D> df;
  const auto store = [&](V v, float* to) { hn::StoreU(hn::DemoteTo(df, v), df, to + lane); };
  const FloatRays& rays = packet->floats;

  const Vec3V<V> direction = Direction(d, *packet, lane);
  const V inverse_dd = hn::Div(hn::Set(d, 1.0), FusedDot(direction, direction));
  const V largest =
      hn::Max(hn::Max(hn::Abs(direction.x), hn::Abs(direction.y)), hn::Abs(direction.z));
  const auto scale = PowerOfTwo(d, largest);
  const Vec3V<V> scaled = Scale(direction, scale.inverse);
  hn::Store(inverse_dd, d, packet->inverse_dd + lane);
  hn::Store(scale.power, d, packet->t_scale + lane);
  store(FlushTiny(d, scaled.x), rays.direction[0]);
  store(FlushTiny(d, scaled.y), rays.direction[1]);
  store(FlushTiny(d, scaled.z), rays.direction[2]);
  hn::StoreU(UpperDepth(d, t_max, scale.power), df, rays.depth + lane);
  if (!packet->geometry->triangles.empty()) {
    const RayShearV<V> shear = MakeShear(d, direction);
    Store3(shear.x_axis, d, packet->shear, lane);
    Store3(shear.y_axis, d, packet->shear + 3, lane);
  }
}

// Fills the packet with the batch's rays from `first` on, which end at packet->t_max. Lanes past
// `count` hold no rays.
template <class Batch>
HWY_INLINE void FillPacket(const Batch& batch, size_t first, Packet* packet) {
  for (int c = 0; c < 3; ++c) {
    packet->origin[c] = ChannelOf(batch.origin, c).data() + first;
    packet->direction[c] = ChannelOf(batch.direction, c).data() + first;
  }
  const hn::ScalableTag<double> d;
  const int step = static_cast<int>(hn::Lanes(d));
  for (int lane = 0; lane < packet->width; lane += step) {
    FillLanes(d, hn::Load(d, packet->t_max + lane), lane, packet);
  }
  const auto left = static_cast<int>(std::min<size_t>(batch.count - first, kMaxPacketWidth));
  packet->lanes = (1u << std::min(left, packet->width)) - 1;
}

// An upper bound of the coordinates that a point on the primitive was computed from.
HWY_INLINE double Reach(const TraceGeometry& geometry, uint32_t primitive) {
  if (primitive == kNoPrimitive) return 0;
  if (primitive < geometry.SphereCount()) {
    const TraceSphere& sphere = geometry.spheres[primitive];
    return nacre::SumOfAbs(sphere.center) + sphere.radius;
  }
  double extent = 0;
  for (const uint32_t vertex : geometry.triangles[primitive - geometry.SphereCount()]) {
    extent = std::max(extent, nacre::SumOfAbs(geometry.positions[vertex]));
  }
  return extent;
}

// `starts` are the primitives that the batch's rays start on.
HWY_INLINE void FillStarts(const AlignedArray<uint32_t>& starts, size_t first, Packet* packet) {
  const TraceGeometry& geometry = *packet->geometry;
  for (int lane = 0; lane < packet->width; ++lane) {
    const bool holds_ray = (packet->lanes >> lane & 1) != 0;
    const uint32_t start = holds_ray ? starts[first + static_cast<size_t>(lane)] : kNoPrimitive;
    packet->start[lane] = start;
    const bool on_sphere = start < geometry.SphereCount();
    packet->start_spheres.Set(static_cast<size_t>(lane),
                              on_sphere ? geometry.spheres[start] : kNoSphere);
    packet->start_extent[lane] = geometry.triangles.empty() ? 0 : Reach(geometry, start);
  }
}

// Fills the packet for the rays' first hits that are nearer than hits->t.
HWY_INLINE void FillClosest(const RayBatch& rays, size_t first, ClosestHits* hits, Packet* packet) {
  packet->view = rays.view;
  packet->best_t = hits->t.data() + first;
  packet->best_primitive = hits->primitive.data() + first;
  packet->t_max = packet->best_t;
  FillPacket(rays, first, packet);
  packet->holes_are_solid = rays.holes_are_solid;
  packet->from_surfaces = rays.from_surfaces;
  packet->own_after = rays.own_after.data() + first;
  if (rays.from_surfaces) FillStarts(rays.start, first, packet);
}

// Fills the packet with shadow rays, but those that are known to be occluded are not traced.
HWY_INLINE void FillShadowPacket(const ShadowRayBatch& rays, size_t first, Packet* packet) {
  packet->t_max = rays.t_max.data() + first;
  packet->own_after = rays.own_after.data() + first;
  packet->target = rays.target;
  packet->camera_extent = rays.camera_extent;
  FillPacket(rays, first, packet);
  packet->occluded = 0;
  for (int lane = 0; lane < packet->width; ++lane) {
    const bool occluded = rays.occluded[first + static_cast<size_t>(lane)] != 0;
    packet->occluded |= static_cast<uint32_t>(occluded) << lane;
  }
  packet->lanes &= ~packet->occluded;
  packet->from_surfaces = true;
  FillStarts(rays.primitive, first, packet);
}

}  // namespace nacre::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
