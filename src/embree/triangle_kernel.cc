// SPDX-License-Identifier: Apache-2.0
// embree/triangle_kernel.cc: the double test of a packet of rays against one triangle.
//
// Embree's own triangle test is watertight, but its float edges depend on the instruction set and
// on which rays share a packet, and so would the picture.
#include <cmath>

#include "embree/embree_packet.h"
#include "embree/primitives.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "embree/triangle_kernel.cc"
#include "hwy/foreach_target.h"

#include "base/vec3-inl.h"
#include "visibility/occlusion-inl.h"
#include "visibility/triangle_test-inl.h"

HWY_BEFORE_NAMESPACE();
namespace nacre::HWY_NAMESPACE {
namespace {
namespace hn = hwy::HWY_NAMESPACE;

struct Corners {
  Vec3d a, b, c;
};

HWY_INLINE Corners CornersOf(const TraceGeometry& geometry, uint32_t triangle) {
  const auto& indices = geometry.triangles[triangle];
  return {geometry.positions[indices[0]], geometry.positions[indices[1]],
          geometry.positions[indices[2]]};
}

template <class D, class V = hn::Vec<D>>
HWY_INLINE TriangleHitV<D> TestLanes(D d, const Packet& packet, int lane, const Corners& corners) {
  const auto& shear = packet.shear;
  const Vec3V<V> origin = Origin(d, packet, lane);
  return TestTriangle(d, Sub(SetVec3(d, corners.a), origin), Sub(SetVec3(d, corners.b), origin),
                      Sub(SetVec3(d, corners.c), origin), Direction(d, packet, lane),
                      hn::Load(d, packet.inverse_dd + lane),
                      RayShearV<V>{Load3(d, shear, lane), Load3(d, shear + 3, lane)});
}

// The lanes of `hits` that are not in a hole of the mesh. Not inlined, because few scenes have
// holes.
template <class D>
HWY_NOINLINE hn::Mask<D> OutsideHoles(D d, const TraceGeometry& geometry, const CutOut& holes,
                                      uint32_t triangle, const Vec3V<hn::Vec<D>>& weights,
                                      hn::Mask<D> hits) {
  alignas(64) double lanes[3][hn::MaxLanes(D())];
  hn::Store(weights.x, d, lanes[0]);
  hn::Store(weights.y, d, lanes[1]);
  hn::Store(weights.z, d, lanes[2]);
  uint32_t solid = 0;
  for (uint32_t bits = BitsOfMask(d, hits); bits != 0; bits &= bits - 1) {
    const int lane = __builtin_ctz(bits);
    const bool is_solid = IsSolidAt(holes, geometry.positions, geometry.triangles[triangle],
                                    {lanes[0][lane], lanes[1][lane], lanes[2][lane]});
    solid |= static_cast<uint32_t>(is_solid) << lane;
  }
  return MaskOfBits(d, solid, 0);
}

HWY_INLINE const CutOut* HolesOf(const TraceGeometry& geometry, uint32_t triangle) {
  return geometry.cut_outs.empty() ? nullptr : FindCutOut(geometry.cut_outs, triangle);
}

// Whether the triangle has only a front side. Few scenes other than models have such triangles.
HWY_INLINE bool IsSingleSided(const TraceGeometry& geometry, uint32_t triangle) {
  return !geometry.single_sided.empty() && geometry.single_sided[triangle] != 0;
}

constexpr double kUnit = 0x1p-53;

// A triangle's plane, for distances of points from it.
struct Plane {
  Vec3d normal;         // e1 x e2, not normalised
  double size1, size2;  // |e1|_1 and |e2|_1: the error of `normal` is 4 u times their product
};

Plane PlaneOf(const Corners& corners) {
  const Vec3d e1 = corners.b - corners.a, e2 = corners.c - corners.a;
  return {e1.cross(e2), std::abs(e1.x) + std::abs(e1.y) + std::abs(e1.z),
          std::abs(e2.x) + std::abs(e2.y) + std::abs(e2.z)};
}

// Whether points are no farther from the plane than `error` times |e1|_1 |e2|_1 / |normal|. `to_a`
// are the vectors from the points to corner a.
template <class D, class V = hn::Vec<D>>
HWY_INLINE hn::Mask<D> WithinOfPlane(D d, const Plane& plane, const Vec3V<V>& to_a, V error) {
  const V scaled_distance = hn::Abs(Dot(to_a, SetVec3(d, plane.normal)));
  return hn::Le(scaled_distance, hn::Mul(hn::Set(d, plane.size1 * plane.size2), error));
}

// The lanes whose origin lies on the triangle's plane within the rounding error: their ray starts
// on this surface (on a neighbour, or on the same triangle given twice), which does not occlude it.
//
// The distance times |normal| is to_a . normal. With u = 2^-53, E = |e1|_1 |e2|_1 and R the upper
// bound of the coordinates of the primitive that the ray starts on, the origin is off by at most 4
// u R, its difference to a corner by another u |to_a|, the normal by 4 u E and the dot product by
// 3 u |to_a| E: altogether at most 12 u E (R + |to_a|_1).
template <class D, class V = hn::Vec<D>>
HWY_INLINE hn::Mask<D> StartsOnPlane(D d, const Packet& packet, int lane, const Vec3V<V>& to_a,
                                     const Plane& plane) {
  const V extent = hn::Add(hn::Load(d, packet.start_extent + lane), SumOfAbs(to_a));
  return WithinOfPlane(d, plane, to_a, hn::Mul(hn::Set(d, 16 * kUnit), extent));
}

HWY_INLINE void IntersectTriangle(const TraceGeometry& geometry, uint32_t triangle, uint32_t lanes,
                                  Packet* to) {
  Packet& packet = *to;
  const Corners corners = CornersOf(geometry, triangle);
  const uint32_t primitive = geometry.SphereCount() + triangle;
  const bool single_sided = IsSingleSided(geometry, triangle);
  const CutOut* const holes = packet.holes_are_solid ? nullptr : HolesOf(geometry, triangle);
  const hn::ScalableTag<double> d;
  const int step = static_cast<int>(hn::Lanes(d));
  for (int lane = 0; lane < packet.width; lane += step) {
    const auto active = MaskOfBits(d, lanes, lane);
    if (hn::AllFalse(d, active)) continue;
    const auto hit = TestLanes(d, packet, lane, corners);
    auto met = hn::And(active, hit.hit);
    if (single_sided) {
      if (hn::AllFalse(d, met)) continue;
      met = hn::And(met, ComesFromFront(d, hit, Direction(d, packet, lane)));
    }
    if (holes != nullptr) {
      met = hn::And(met, hn::Le(hit.t, hn::Load(d, packet.best_t + lane)));
      if (hn::AllFalse(d, met)) continue;
      met = OutsideHoles(d, geometry, *holes, triangle, hit.weights, met);
    }
    if (packet.from_surfaces) {
      const auto to_a = Sub(SetVec3(d, corners.a), Origin(d, packet, lane));
      met = hn::AndNot(StartsOnPlane(d, packet, lane, to_a, PlaneOf(corners)), met);
    }
    RecordClosest(d, &packet, lane, met, hit.t, primitive);
  }
}

void IntersectTriangles(const RTCIntersectFunctionNArguments* args) {
  EmbreePacket& embree = PacketOf(args->context);
  const auto& primitives = *static_cast<const TrianglePrimitives*>(args->geometryUserPtr);
  const uint32_t lanes = ActiveLanes(embree, args->valid, args->rayhit, args->N);
  const uint32_t* const first = &primitives.first[args->primID];
  for (uint32_t triangle = first[0]; triangle < first[1]; ++triangle) {
    IntersectTriangle(*primitives.geometry, triangle, lanes, &embree.packet);
  }
  ReturnDepths(embree, args->valid, args->rayhit, args->N);
}

// The lanes whose end lies on the plane within the rounding error: the light lies on this surface.
//
// The end is off by at most 22 u R, as for spheres (EndsOnSphere), where R is the sum of the
// origin's, the end's and the camera's coordinates, of the vector to the corner and of the edges.
// The corners are off by 25 u R: a transform's sines and cosines, and the nine products that it is
// made of, by 6 u each, on three coordinates, and 7 u for the sums and the camera. With the
// evaluation's 12 u R this is at most 59 u E R altogether. The shape of another light in the
// light's plane is also lifted out of it, by 512 u of its world coordinates and the camera's
// (LiftFromItsPlane of scene/light_shapes.cc), together at most 1024 u R.
template <class D, class V = hn::Vec<D>>
HWY_INLINE hn::Mask<D> EndsOnPlane(D d, const ShadowRaysV<D>& rays, const Vec3V<V>& to_a,
                                   const Plane& plane) {
  const Vec3V<V> from_end = Sub(to_a, ToEnd(rays));
  const V extent = hn::Add(hn::Add(EndExtent(d, rays), SumOfAbs(from_end)),
                           hn::Set(d, plane.size1 + plane.size2));
  const auto on =
      WithinOfPlane(d, plane, from_end, hn::Mul(hn::Set(d, (64 + 1024) * kUnit), extent));
  return hn::And(hn::Lt(rays.t_max, hn::Inf(d)), on);
}

// The lanes whose ray starts or ends on the triangle's plane, within rounding.
template <class D>
HWY_INLINE hn::Mask<D> TouchesPlane(D d, const Packet& packet, int lane, const Corners& corners) {
  const Plane plane = PlaneOf(corners);
  const ShadowRaysV<D> rays = ShadowRaysOf(d, packet, lane);
  const auto to_a = Sub(SetVec3(d, corners.a), rays.origin);
  return hn::Or(StartsOnPlane(d, packet, lane, to_a, plane), EndsOnPlane(d, rays, to_a, plane));
}

HWY_NOINLINE void OccludeByTriangle(const TraceGeometry& geometry, uint32_t triangle,
                                    uint32_t lanes, Packet* to) {
  Packet& packet = *to;
  const Corners corners = CornersOf(geometry, triangle);
  lanes &= ~StartingLanes(packet, geometry.SphereCount() + triangle);
  const bool single_sided = IsSingleSided(geometry, triangle);
  const CutOut* const holes = HolesOf(geometry, triangle);
  const hn::ScalableTag<double> d;
  const int step = static_cast<int>(hn::Lanes(d));
  uint32_t occluded = 0;
  for (int lane = 0; lane < packet.width; lane += step) {
    const auto active = MaskOfBits(d, lanes, lane);
    if (hn::AllFalse(d, active)) continue;
    const auto hit = TestLanes(d, packet, lane, corners);
    const auto within = hn::And(hit.hit, hn::Lt(hit.t, hn::Load(d, packet.t_max + lane)));
    auto met = hn::And(active, within);
    if (hn::AllFalse(d, met)) continue;
    if (single_sided) {
      // Shadow rays run towards the light: if one hits a front, the light comes from behind, and
      // passes through.
      met = hn::AndNot(ComesFromFront(d, hit, Direction(d, packet, lane)), met);
      if (hn::AllFalse(d, met)) continue;
    }
    if (holes != nullptr) {
      met = OutsideHoles(d, geometry, *holes, triangle, hit.weights, met);
    }
    occluded |= BitsOfMask(d, hn::AndNot(TouchesPlane(d, packet, lane, corners), met)) << lane;
  }
  RecordOccluded(&packet, occluded);
}

void OccludedByTriangles(const RTCOccludedFunctionNArguments* args) {
  EmbreePacket& embree = PacketOf(args->context);
  Packet& packet = embree.packet;
  const auto& primitives = *static_cast<const TrianglePrimitives*>(args->geometryUserPtr);
  const TraceGeometry& geometry = *primitives.geometry;
  const uint32_t* const first = &primitives.first[args->primID];
  // Early out for triangles of the light itself, on which rays only end: without it mesh_lights and
  // area_lights take 1.3 times as long. The two triangles of a pair belong to one mesh.
  if (packet.target.Contains(geometry.SphereCount() + first[0])) return;
  const uint32_t lanes = ActiveLanes(embree, args->valid, args->ray, args->N);
  for (uint32_t triangle = first[0]; triangle < first[1]; ++triangle) {
    OccludeByTriangle(geometry, triangle, lanes & ~packet.occluded, &packet);
  }
  ReturnDepths(embree, args->valid, args->ray, args->N);
}

PrimitiveCallbacks Callbacks() { return {&IntersectTriangles, &OccludedByTriangles}; }

}  // namespace
}  // namespace nacre::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace nacre {
HWY_EXPORT(Callbacks);

TrianglePrimitives MakeTrianglePrimitives(const TraceGeometry* geometry) {
  TrianglePrimitives primitives;
  primitives.geometry = geometry;
  const auto& triangles = geometry->triangles;
  const auto share_an_edge = [](const auto& a, const auto& b) {
    int common = 0;
    for (const uint32_t corner : a) common += corner == b[0] || corner == b[1] || corner == b[2];
    return common >= 2;
  };
  primitives.first.reserve(triangles.size() / 2 + 1);
  for (size_t i = 0; i < triangles.size(); ++i) {
    primitives.first.push_back(static_cast<uint32_t>(i));
    if (i + 1 < triangles.size() && share_an_edge(triangles[i], triangles[i + 1])) ++i;
  }
  primitives.first.push_back(static_cast<uint32_t>(triangles.size()));
  return primitives;
}

PrimitiveCallbacks TriangleCallbacks() { return HWY_DYNAMIC_DISPATCH(Callbacks)(); }
}  // namespace nacre
#endif
