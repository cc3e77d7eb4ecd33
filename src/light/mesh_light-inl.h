// SPDX-License-Identifier: Apache-2.0
// light/mesh_light-inl.h: finds the triangles of a mesh light that rays hit. Scalar twin, bit for
// bit: FindMeshLightHits of mesh_light.h. Rays to a light go to all parts of it, so each ray
// traverses the tree by itself: a vector holds the boxes of a node, or the triangles of a leaf.
#if defined(NACRE_LIGHT_MESH_LIGHT_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef NACRE_LIGHT_MESH_LIGHT_INL_H_
#undef NACRE_LIGHT_MESH_LIGHT_INL_H_
#else
#define NACRE_LIGHT_MESH_LIGHT_INL_H_
#endif

#include <cstddef>
#include <cstdint>
#include <limits>

#include "base/vec3-inl.h"
#include "light/mesh_light.h"

HWY_BEFORE_NAMESPACE();
namespace nacre::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Rays in the form in which they are tested against the boxes of the tree, in floats: relative to
// the light's origin, and with the point nearest to it as the ray's origin, so that the floats'
// errors are relative to the light's size, however far away a ray starts.
//
// Instead of one ray origin there are two, with a margin between them: a point beside a triangle
// that the exact test may accept must not lie outside the triangle's box, nor be lost by rounding.
// R is the light's radius, p the point where the ray starts. In units of 2^-24 R, floats lose at
// most 1 in the origin, 2 in the difference to a side of a box, which is up to 2 R, and 4 in its
// product with the rounded inverse. In units of 2^-53 |p|, doubles lose less than 4 in the origin,
// and the exact test accepts points less than 12 beside a triangle, or more only if the ray is
// nearly parallel to an edge, where its last bits decide. The margin is twice that.
inline constexpr double kLightBoxMargin = 16 * 0x1p-24, kLightDistanceMargin = 32 * 0x1p-53;

struct LightBoxRays {
  static constexpr size_t kMaxLanes = HWY_MAX_BYTES / sizeof(double);
  // For each axis, the origin plus and minus the margin, and the inverse of the direction.
  alignas(64) float plus[3][kMaxLanes], minus[3][kMaxLanes], inverse[3][kMaxLanes];
  alignas(64) float start[kMaxLanes];  // where the ray starts, in units of the direction
};

// Sets `rays`. `direction` are unit vectors, up to the rounding to float. Returns the lanes whose
// ray meets the ball around the light.
template <class D, class V = hn::Vec<D>>
HWY_INLINE hn::Mask<D> MakeLightBoxRays(D d, const MeshLight& light, const Vec3V<V>& point,
                                        const Vec3V<V>& direction, LightBoxRays* rays) {
  const hn::Rebind<float, D> df;
  const V zero = hn::Zero(d);
  const V forward =
      hn::Max(hn::Div(hn::Neg(Dot(point, direction)), Dot(direction, direction)), zero);
  const Vec3V<V> nearest = Add(point, Scale(direction, forward));
  const V size = hn::Add(hn::Add(hn::Abs(point.x), hn::Abs(point.y)), hn::Abs(point.z));
  const V margin = hn::Add(hn::Set(d, light.radius * kLightBoxMargin),
                           hn::Mul(size, hn::Set(d, kLightDistanceMargin)));
  const auto store = [&](V v, float* to) HWY_ATTR { hn::Store(hn::DemoteTo(df, v), df, to); };
  const auto axis = [&](int c, V at, V along) HWY_ATTR {
    store(hn::Add(at, margin), rays->plus[c]);
    store(hn::Sub(at, margin), rays->minus[c]);
    // A ray parallel to a slab never lies in its planes: the margin lies between.
    const V size_along = hn::Max(hn::Abs(along), hn::Set(d, 1e-30));
    store(hn::Div(hn::CopySign(hn::Set(d, 1.0), along), size_along), rays->inverse[c]);
  };
  axis(0, nearest.x, direction.x);
  axis(1, nearest.y, direction.y);
  axis(2, nearest.z, direction.z);
  // No part of the light lies before -4 R, where floats still resolve the margin.
  store(hn::Sub(hn::Max(hn::Neg(forward), hn::Set(d, -4 * light.radius)), margin), rays->start);
  const V reach = hn::Add(hn::Set(d, light.radius), hn::Add(margin, margin));
  return hn::Le(Dot(nearest, nearest), hn::Mul(reach, reach));
}

// The boxes of the node that ray `lane` meets, as a bit mask.
HWY_INLINE uint32_t IntersectBoxes(const MeshLightNode& node, const LightBoxRays& rays,
                                   size_t lane) {
  const hn::CappedTag<float, kMeshLightWidth> d;
  uint32_t bits = 0;
  for (size_t i = 0; i < kMeshLightWidth; i += hn::Lanes(d)) {
    auto near = hn::Set(d, rays.start[lane]);
    auto far = hn::Set(d, std::numeric_limits<float>::infinity());
    for (int c = 0; c < 3; ++c) {
      const auto inverse = hn::Set(d, rays.inverse[c][lane]);
      const float plus = rays.plus[c][lane], minus = rays.minus[c][lane];
      const bool back = rays.inverse[c][lane] < 0;
      const auto enter = hn::Sub(hn::Load(d, (back ? node.high[c] : node.low[c]) + i),
                                 hn::Set(d, back ? minus : plus));
      const auto leave = hn::Sub(hn::Load(d, (back ? node.low[c] : node.high[c]) + i),
                                 hn::Set(d, back ? plus : minus));
      near = hn::Max(near, hn::Mul(enter, inverse));
      far = hn::Min(far, hn::Mul(leave, inverse));
    }
    alignas(8) uint8_t bytes[8] = {};
    hn::StoreMaskBits(d, hn::Le(near, far), bytes);
    bits |= (bytes[0] | uint32_t{bytes[1]} << 8) << i;
  }
  return bits & ((uint32_t{1} << node.count) - 1);
}

// Calls found(triangle, t, towards) for the triangles of the leaf that the ray hits. t is in units
// of the direction; `towards` is the dot product of the direction and the triangle's normal (not
// normalised), negative where the ray meets the front.
template <class Found>
HWY_INLINE void ForEachLeafHit(const MeshLightLeaf& leaf, const Vec3d& point,
                               const Vec3d& direction, const Found& found) {
  const hn::CappedTag<double, kMeshLightLeaf> d;
  using V = hn::Vec<decltype(d)>;
  const V zero = hn::Zero(d);
  const Vec3V<V> along = SetVec3(d, direction), from = SetVec3(d, point);
  for (size_t i = 0; i < kMeshLightLeaf; i += hn::Lanes(d)) {
    const Vec3V<V> corner = Sub(Load3(d, leaf.corner, i), from);
    const Vec3V<V> normal = Load3(d, leaf.cross, i);
    const V towards = Dot(along, normal);
    const Vec3V<V> across = Cross(corner, along);
    const V along_y = Dot(across, Load3(d, leaf.edge_y, i)),
            along_x = Dot(across, Load3(d, leaf.edge_x, i));
    const auto back = hn::Lt(towards, zero);
    const V x = hn::IfThenElse(back, hn::Neg(along_y), along_y);
    const V y = hn::IfThenElse(back, along_x, hn::Neg(along_x));
    const V size = hn::Abs(towards);
    const auto in_angle = hn::And(hn::Ge(x, zero), hn::Ge(y, zero));
    const auto line_hit =
        hn::And(hn::And(in_angle, hn::Le(hn::Add(x, y), size)), hn::Gt(size, zero));
    if (hn::AllFalse(d, line_hit)) continue;
    alignas(64) double distances[kMeshLightLeaf], products[kMeshLightLeaf];
    alignas(8) uint8_t bits[8] = {};
    hn::Store(Dot(corner, normal), d, distances);
    hn::Store(towards, d, products);
    hn::StoreMaskBits(d, line_hit, bits);
    for (uint32_t lanes = bits[0]; lanes != 0; lanes &= lanes - 1) {
      const size_t k = hwy::Num0BitsBelowLS1Bit_Nonzero32(lanes);
      const double t = distances[k] / products[k];  // few lanes: a vector takes longer
      if (t > 0) found(leaf.triangle[i + k], t, products[k]);
    }
  }
}

// Calls found(triangle, t, towards), as ForEachLeafHit does, for all triangles that ray `lane` of
// the rays hits; `point` and `direction` are that ray in double.
template <class Found>
HWY_INLINE void ForEachMeshLightHit(const MeshLight& light, const LightBoxRays& rays, size_t lane,
                                    const Vec3d& point, const Vec3d& direction,
                                    const Found& found) {
  uint32_t stack[kMeshLightStack];
  size_t size = 0;
  stack[size++] = 0;
  // Leaves are put on the stack, too, so that triangles are met in the order of the tree.
  constexpr uint32_t kLeafBit = 0x80000000u;
  while (size > 0) {
    const uint32_t top = stack[--size];
    if ((top & kLeafBit) != 0) {
      ForEachLeafHit(light.leaves[top & ~kLeafBit], point, direction, found);
      continue;
    }
    const MeshLightNode& node = light.nodes[top];
    for (uint32_t bits = IntersectBoxes(node, rays, lane); bits != 0;) {
      const auto last = static_cast<uint32_t>(31 - hwy::Num0BitsAboveMS1Bit_Nonzero32(bits));
      bits ^= 1u << last;
      stack[size++] = node.child[last] | ((node.leaves >> last & 1) != 0 ? kLeafBit : 0);
    }
  }
}

}  // namespace nacre::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
