// SPDX-License-Identifier: Apache-2.0
// visibility/fill_packet-inl.h: rounds a packet of a batch's rays to float, and keeps with them
// what their proposals and the exact tests need.
#if defined(NACRE_VISIBILITY_FILL_PACKET_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef NACRE_VISIBILITY_FILL_PACKET_INL_H_
#undef NACRE_VISIBILITY_FILL_PACKET_INL_H_
#else
#define NACRE_VISIBILITY_FILL_PACKET_INL_H_
#endif

#include "base/power_of_two-inl.h"
#include "visibility/packet-inl.h"
#include "visibility/triangle_test-inl.h"

HWY_BEFORE_NAMESPACE();
namespace nacre {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Components that Embree replaces by 1e-18 before it takes their reciprocals, and a few more, are
// 0: it does so whatever their sign, and a packet's frustum of those that are negative is then
// empty. What that moves a ray by is far less than what rounding it does.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V FlushTiny(D d, V component) {
  return hn::IfThenElseZero(hn::Gt(hn::Abs(component), hn::Set(d, 0x1p-56)), component);
}

// Rounds the rays to float. Their directions are first divided by a power of two, so that the
// largest component is in [1, 2] and no product leaves float's range.
template <class D>
HWY_INLINE void FillLanes(D d, hn::Vec<D> t_max, int lane, Packet* packet) {
  using V = hn::Vec<D>;
  const hn::Rebind<float, D> df;
  const auto store = [&](V v, float* to) { hn::StoreU(hn::DemoteTo(df, v), df, to + lane); };
  RTCRayN* rays = packet->ray_n();
  const unsigned width = packet->Width();

  const Vec3V<V> origin = Origin(d, *packet, lane);
  const Vec3V<V> direction = Direction(d, *packet, lane);
  const V inverse_dd = hn::Div(hn::Set(d, 1.0), FusedDot(direction, direction));
  const V largest =
      hn::Max(hn::Max(hn::Abs(direction.x), hn::Abs(direction.y)), hn::Abs(direction.z));
  const auto scale = PowerOfTwo(d, largest);
  const Vec3V<V> scaled = Scale(direction, scale.inverse);
  const auto scaled_inverse_dd =
      hn::DemoteTo(df, hn::Mul(hn::Mul(inverse_dd, scale.power), scale.power));
  hn::Store(inverse_dd, d, packet->inverse_dd + lane);
  hn::Store(scale.power, d, packet->t_scale + lane);
  store(origin.x, &RTCRayN_org_x(rays, width, 0));
  store(origin.y, &RTCRayN_org_y(rays, width, 0));
  store(origin.z, &RTCRayN_org_z(rays, width, 0));
  store(FlushTiny(d, scaled.x), &RTCRayN_dir_x(rays, width, 0));
  store(FlushTiny(d, scaled.y), &RTCRayN_dir_y(rays, width, 0));
  store(FlushTiny(d, scaled.z), &RTCRayN_dir_z(rays, width, 0));
  hn::StoreU(UpperDepth(d, t_max, scale.power), df, packet->tfar() + lane);
  hn::StoreU(scaled_inverse_dd, df, packet->ray_inverse_dd + lane);
  hn::StoreU(hn::Mul(hn::Sqrt(scaled_inverse_dd), hn::Set(df, 1 + 0x1p-22f)), df,
             packet->ray_inverse_length + lane);
  store(hn::Mul(SumOfAbs(origin), hn::Set(d, 32 * kFloatUnit)), packet->origin_error);
  if (!packet->geometry->triangles.empty()) {
    const RayShearV<V> shear = MakeShear(d, direction);
    Store3(shear.x_axis, d, packet->shear[0] + lane, packet->shear[1] + lane,
           packet->shear[2] + lane);
    Store3(shear.y_axis, d, packet->shear[3] + lane, packet->shear[4] + lane,
           packet->shear[5] + lane);
  }
}

// The packet of a batch's rays from `first` on; lanes past `count` hold none.
template <class Batch>
HWY_INLINE void FillPacket(const Batch& batch, size_t first, Packet* packet) {
  packet->origin_x = batch.origin.x.data() + first;
  packet->origin_y = batch.origin.y.data() + first;
  packet->origin_z = batch.origin.z.data() + first;
  packet->direction_x = batch.direction.x.data() + first;
  packet->direction_y = batch.direction.y.data() + first;
  packet->direction_z = batch.direction.z.data() + first;
  const hn::ScalableTag<double> d;
  const int step = static_cast<int>(hn::Lanes(d));
  for (int lane = 0; lane < packet->width; lane += step) {
    FillLanes(d, hn::Load(d, packet->t_max + lane), lane, packet);
  }
  for (int lane = 0; lane < packet->width; ++lane) {
    packet->valid[lane] = first + static_cast<size_t>(lane) < batch.count ? -1 : 0;
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace nacre
HWY_AFTER_NAMESPACE();
#endif
