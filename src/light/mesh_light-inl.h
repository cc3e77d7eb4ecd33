// SPDX-License-Identifier: Apache-2.0
// light/mesh_light-inl.h: the triangles of a mesh light that a vector of rays hits. Scalar twin:
// FindMeshLightHits of mesh_light.h, bit for bit. The rays traverse the tree together: a box is
// entered, and a triangle tested, if any of them needs it.
#if defined(NACRE_LIGHT_MESH_LIGHT_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef NACRE_LIGHT_MESH_LIGHT_INL_H_
#undef NACRE_LIGHT_MESH_LIGHT_INL_H_
#else
#define NACRE_LIGHT_MESH_LIGHT_INL_H_
#endif

#include <limits>

#include "base/geometry-inl.h"
#include "light/mesh_light.h"

HWY_BEFORE_NAMESPACE();
namespace nacre {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Rays, relative to the light's origin, in double. `inverse`: reciprocals of the directions.
template <class V>
struct LightRaysV {
  Vec3V<V> point, direction, inverse;
};

template <class D, class V = hn::Vec<D>>
HWY_INLINE LightRaysV<V> MakeLightRays(D d, const Vec3V<V>& point, const Vec3V<V>& direction) {
  const auto inverse = [d](V x) HWY_ATTR {
    const V one = hn::Set(d, 1.0);
    const auto along = hn::Eq(x, hn::Zero(d));
    return hn::IfThenElse(along, hn::Set(d, kSlabInfinity),
                          hn::Div(one, hn::IfThenElse(along, one, x)));
  };
  return {point, direction, {inverse(direction.x), inverse(direction.y), inverse(direction.z)}};
}

template <class D, class V = hn::Vec<D>>
HWY_INLINE auto IntersectsBox(D d, const MeshLightNode& box, const LightRaysV<V>& rays) {
  V near = hn::Zero(d), far = hn::Set(d, std::numeric_limits<double>::infinity());
  const auto cut = [&](double low, double high, V point, V inverse) HWY_ATTR {
    const V a = hn::Mul(hn::Sub(hn::Set(d, low), point), inverse);
    const V b = hn::Mul(hn::Sub(hn::Set(d, high), point), inverse);
    near = hn::Max(near, hn::Min(a, b));
    far = hn::Min(far, hn::Max(a, b));
  };
  cut(box.low.x, box.high.x, rays.point.x, rays.inverse.x);
  cut(box.low.y, box.high.y, rays.point.y, rays.inverse.y);
  cut(box.low.z, box.high.z, rays.point.z, rays.inverse.z);
  return hn::Le(near, hn::Mul(far, hn::Set(d, kSlabRounding)));
}

// Hits of rays on a triangle: t in units of the direction, valid where `hit`; and the product of
// the direction and the triangle's normal, negative where a ray meets its front.
template <class M, class V>
struct MeshLightHitV {
  M hit;
  V t, towards;
};

template <class D, class V = hn::Vec<D>>
HWY_INLINE MeshLightHitV<hn::Mask<D>, V> IntersectLightTriangle(D d, const TriangleLight<double>& t,
                                                                const Vec3d& cross,
                                                                const LightRaysV<V>& rays) {
  const V zero = hn::Zero(d);
  const Vec3V<V> corner = Sub(SetVec3(d, t.corner), rays.point);
  const Vec3V<V> normal = SetVec3(d, cross);
  const V towards = Dot(rays.direction, normal);
  const Vec3V<V> across = Cross(corner, rays.direction);
  const V along_y = Dot(across, SetVec3(d, t.edge_y)), along_x = Dot(across, SetVec3(d, t.edge_x));
  const auto back = hn::Lt(towards, zero);
  const V x = hn::IfThenElse(back, hn::Neg(along_y), along_y);
  const V y = hn::IfThenElse(back, along_x, hn::Neg(along_x));
  const V size = hn::Abs(towards);
  const auto in_angle = hn::And(hn::Ge(x, zero), hn::Ge(y, zero));
  const auto line_hit = hn::And(hn::And(in_angle, hn::Le(hn::Add(x, y), size)), hn::Gt(size, zero));
  if (hn::AllFalse(d, line_hit)) return {line_hit, zero, towards};
  const V t_hit = hn::Div(Dot(corner, normal), hn::IfThenElse(line_hit, towards, hn::Set(d, 1.0)));
  return {hn::And(line_hit, hn::Gt(t_hit, zero)), t_hit, towards};
}

// Calls found(triangle, hit) for the triangles that any lane's ray hits.
template <class D, class V, class Found>
HWY_INLINE void ForEachMeshLightHit(D d, const MeshLight& light, const LightRaysV<V>& rays,
                                    const Found& found) {
  uint32_t stack[kMeshLightStack];
  size_t size = 0;
  stack[size++] = 0;
  while (size > 0) {
    const MeshLightNode& node = light.tree[stack[--size]];
    if (hn::AllFalse(d, IntersectsBox(d, node, rays))) continue;
    if (node.child != 0) {
      stack[size++] = node.child;
      stack[size++] = node.child + 1;
      continue;
    }
    for (uint32_t i = node.begin; i < node.end; ++i) {
      const auto hit = IntersectLightTriangle(d, light.triangles[i], light.crosses[i], rays);
      if (!hn::AllFalse(d, hit.hit)) found(i, hit);
    }
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace nacre
HWY_AFTER_NAMESPACE();
#endif
