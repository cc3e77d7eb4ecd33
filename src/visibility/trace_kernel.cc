// visibility/trace_kernel.cc: rounds packets of rays to float for Embree and starts its queries.
#include "visibility/trace_kernel.h"

#include <algorithm>
#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "visibility/trace_kernel.cc"
#include "hwy/foreach_target.h"

#include "visibility/packet-inl.h"
#include "visibility/triangle_test-inl.h"

HWY_BEFORE_NAMESPACE();
namespace nacre {
namespace HWY_NAMESPACE {
namespace {
namespace hn = hwy::HWY_NAMESPACE;

// What stays the same for all packets of a batch.
HWY_INLINE void InitPacket(const TraceScene& scene, Packet* packet) {
  InitContext(&packet->context);
  packet->width = scene.packet_width;
  packet->scene = scene.scene;
  packet->geometry = scene.geometry;
  const unsigned width = packet->Width();
  RTCRayN* rays = packet->ray_n();
  auto* hits = RTCRayHitN_HitN(reinterpret_cast<RTCRayHitN*>(&packet->rays), width);
  for (unsigned i = 0; i < width; ++i) {
    RTCRayN_tnear(rays, width, i) = 0;
    RTCRayN_time(rays, width, i) = 0;
    RTCRayN_mask(rays, width, i) = ~0u;
    RTCRayN_id(rays, width, i) = i;
    RTCRayN_flags(rays, width, i) = 0;
    RTCHitN_geomID(hits, width, i) = RTC_INVALID_GEOMETRY_ID;
    RTCHitN_instID(hits, width, i, 0) = RTC_INVALID_GEOMETRY_ID;
  }
}

template <class V>
struct PowerOfTwoV {
  V power, inverse;
};

// The power of two 2^e in v > 0, for which v / 2^e is in [1, 2), and 2^-e.
template <class D, class V = hn::Vec<D>>
HWY_INLINE PowerOfTwoV<V> PowerOfTwo(D d, V v) {
  const hn::Rebind<uint64_t, D> du;
  const auto exponent = hn::And(hn::BitCast(du, v), hn::Set(du, 0x7ff0000000000000u));
  const auto negated = hn::Sub(hn::Set(du, 0x7fe0000000000000u), exponent);
  return {hn::BitCast(d, exponent), hn::BitCast(d, negated)};
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
  const V inverse_dd = hn::Div(hn::Set(d, 1.0), Dot(direction, direction));
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
  store(scaled.x, &RTCRayN_dir_x(rays, width, 0));
  store(scaled.y, &RTCRayN_dir_y(rays, width, 0));
  store(scaled.z, &RTCRayN_dir_z(rays, width, 0));
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
    const auto t_max = packet->t_max != nullptr
                           ? hn::Load(d, packet->t_max + lane)
                           : hn::Set(d, std::numeric_limits<double>::infinity());
    FillLanes(d, t_max, lane, packet);
  }
  for (int lane = 0; lane < packet->width; ++lane) {
    packet->valid[lane] = first + static_cast<size_t>(lane) < batch.count ? -1 : 0;
  }
}

void Closest(const TraceScene& scene, const RayBatch& rays, ClosestHits* hits) {
  Packet packet;
  InitPacket(scene, &packet);
  const size_t width = packet.Width();
  for (size_t first = 0; first < rays.count; first += width) {
    packet.best_t = hits->t.data() + first;
    packet.best_primitive = hits->primitive.data() + first;
    std::fill_n(packet.best_t, width, std::numeric_limits<double>::infinity());
    std::fill_n(packet.best_primitive, width, kNoPrimitive);
    FillPacket(rays, first, &packet);
    IntersectPacket(packet.width, packet.valid, packet.scene, &packet.context, &packet.rays);
  }
}

// Bounds the coordinates that a point on the primitive was computed from.
HWY_INLINE double Reach(const TraceGeometry& geometry, uint32_t primitive) {
  const auto sum_of_abs = [](const Vec3d& v) {
    return std::abs(v.x) + std::abs(v.y) + std::abs(v.z);
  };
  if (primitive == kNoPrimitive) return 0;
  if (primitive < geometry.SphereCount()) {
    const TraceSphere& sphere = geometry.spheres[primitive];
    return sum_of_abs(sphere.center) + sphere.radius;
  }
  double reach = 0;
  for (const uint32_t vertex : geometry.triangles[primitive - geometry.SphereCount()]) {
    reach = std::max(reach, sum_of_abs(geometry.positions[vertex]));
  }
  return reach;
}

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

HWY_INLINE void FillStarts(const ShadowRayBatch& rays, size_t first, Packet* packet) {
  const TraceGeometry& geometry = *packet->geometry;
  for (int lane = 0; lane < packet->width; ++lane) {
    const bool holds_ray = packet->valid[lane] != 0;
    const uint32_t start =
        holds_ray ? rays.primitive[first + static_cast<size_t>(lane)] : kNoPrimitive;
    packet->start[lane] = start;
    const bool on_sphere = start < geometry.SphereCount();
    const TraceSphere sphere = on_sphere ? geometry.spheres[start] : TraceSphere{Vec3d(kNan), kNan};
    packet->start_sphere[0][lane] = sphere.center.x;
    packet->start_sphere[1][lane] = sphere.center.y;
    packet->start_sphere[2][lane] = sphere.center.z;
    packet->start_sphere[3][lane] = sphere.radius;
    packet->start_reach[lane] = geometry.triangles.empty() ? 0 : Reach(geometry, start);
  }
}

void Occluded(const TraceScene& scene, ShadowRayBatch* rays) {
  Packet packet;
  InitPacket(scene, &packet);
  const size_t width = packet.Width();
  for (size_t first = 0; first < rays->count; first += width) {
    packet.t_max = rays->t_max.data() + first;
    packet.occluded = 0;
    FillPacket(*rays, first, &packet);
    FillStarts(*rays, first, &packet);
    OccludedPacket(packet.width, packet.valid, packet.scene, &packet.context, &packet.rays);
    for (size_t lane = 0; lane < width; ++lane) {
      rays->occluded[first + lane] = (packet.occluded >> lane) & 1;
    }
  }
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace nacre
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace nacre {
HWY_EXPORT(Closest);
HWY_EXPORT(Occluded);

void TraceClosest(const TraceScene& scene, const RayBatch& rays, ClosestHits* hits) {
  HWY_DYNAMIC_DISPATCH(Closest)(scene, rays, hits);
}

void TraceOccluded(const TraceScene& scene, ShadowRayBatch* rays) {
  HWY_DYNAMIC_DISPATCH(Occluded)(scene, rays);
}
}  // namespace nacre
#endif
