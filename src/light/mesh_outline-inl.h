// SPDX-License-Identifier: Apache-2.0
// light/mesh_outline-inl.h: the irradiance of convex meshes on SIMD vectors, by their outlines:
// the sum of their triangles', without the edges that two of them share. The terms, and why they
// come in two forms: polygon_irradiance.h.
#if defined(NACRE_LIGHT_MESH_OUTLINE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef NACRE_LIGHT_MESH_OUTLINE_INL_H_
#undef NACRE_LIGHT_MESH_OUTLINE_INL_H_
#else
#define NACRE_LIGHT_MESH_OUTLINE_INL_H_
#endif

#include <array>

#include "light/mesh_outline.h"
#include "light/polygon_irradiance-inl.h"

HWY_BEFORE_NAMESPACE();
namespace nacre {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// A mesh's corners as points see them: where the first is, and from there the ways to all, in
// space and on the unit sphere.
template <class V>
struct SeenCornersV {
  Vec3V<V> first;
  std::array<Vec3V<V>, kMostOutlineCorners> offset, way;
};

// What the corners say about a surface: whether the light is cut by its horizon or low over it, so
// that its irradiance asks for the terms of SectorIrradiance, and whether it is visible at all.
template <class M>
struct HorizonV {
  M visible, special;
};

template <class D, class V = hn::Vec<D>>
HWY_INLINE auto FindHorizon(D d, const SeenCornersV<V>& seen, size_t count, const Vec3V<V>& pivot,
                            const Vec3V<V>& normal) {
  const V zero = hn::Zero(d);
  V size2 = zero, highest = zero, lowest = zero;
  for (size_t i = 0; i < count; ++i) {
    const V height = FusedDot(normal, Add(pivot, seen.way[i]));
    size2 = hn::Max(size2, FusedDot(seen.way[i], seen.way[i]));
    highest = hn::Max(highest, height);
    lowest = hn::Min(lowest, height);
  }
  const V highest2 = hn::Mul(highest, highest);
  const auto low = hn::Or(hn::Lt(hn::Mul(highest2, highest2), size2), hn::Lt(lowest, zero));
  return HorizonV<hn::Mask<D>>{hn::Gt(highest, zero), low};
}

// An edge of the mesh, and where it is one of the outline: from `a` to `b` for points that see its
// left face, from `b` to `a` for those that see its right one.
template <class M, class V>
struct BorderV {
  M on;
  Vec3V<V> a, b;
};

template <class D, class V = hn::Vec<D>>
HWY_INLINE auto FindBorder(D d, const OutlineEdge& edge, const V* faces,
                           const std::array<Vec3V<V>, kMostOutlineCorners>& corners) {
  const V zero = hn::Zero(d);
  const V left = faces[edge.left];
  const V right = edge.right == kNoFace ? zero : faces[edge.right];
  const auto ahead = hn::Gt(left, zero);
  return BorderV<hn::Mask<D>, V>{hn::Ne(left, right),
                                 Select(ahead, corners[edge.from], corners[edge.to]),
                                 Select(ahead, corners[edge.to], corners[edge.from])};
}

template <class M, class V>
HWY_INLINE EdgeSumsV<V> Select(M mask, const EdgeSumsV<V>& yes, const EdgeSumsV<V>& no) {
  return {hn::IfThenElse(mask, yes.chords, no.chords),
          hn::IfThenElse(mask, yes.sectors, no.sectors), Select(mask, yes.enters, no.enters),
          Select(mask, yes.leaves, no.leaves)};
}

// The general sum, where the horizon cuts the outline of some lanes, or nearly. `orientation` is
// negative where the outline goes round the light's front.
template <class D, class V = hn::Vec<D>, class M>
HWY_INLINE V SumCutOutline(D d, const MeshOutline& outline, const SeenCornersV<V>& seen,
                           const V* faces, V orientation, M special, const Vec3V<V>& pivot,
                           const Vec3V<V>& normal) {
  const V zero = hn::Zero(d);
  V around = hn::Set(d, 1.0f);
  const Vec3V<V> none{zero, zero, zero};
  EdgeSumsV<V> sums{zero, zero, none, none};
  for (const OutlineEdge& edge : outline.edges) {
    const auto border = FindBorder(d, edge, faces, seen.offset);
    if (NoneOf(d, border.on)) continue;
    EdgeSumsV<V> more = sums;
    AddEdge(d, seen.first, pivot, border.a, border.b, normal, &more);
    sums = Select(border.on, more, sums);
    const V side = TripleProduct(normal, Add(seen.first, border.a), Sub(border.b, border.a));
    const auto inside = hn::Gt(hn::Mul(orientation, side), zero);
    around = hn::IfThenElse(border.on, hn::IfThenElseZero(inside, around), around);
  }
  const V closed = hn::Add(sums.chords, EdgeIrradiance(d, pivot, sums.leaves, sums.enters, normal));
  const auto by_sectors = hn::And(special, hn::Eq(around, zero));
  return hn::IfThenElse(by_sectors, sums.sectors, closed);
}

// faces[i] is 1 where face i of the mesh shines towards the point, and 0 elsewhere.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V Irradiance(D d, const MeshOutline& outline, const SeenCornersV<V>& seen,
                        const V* faces, V orientation, const Vec3V<V>& normal) {
  const V zero = hn::Zero(d);
  const V half = hn::Set(d, 0.5f);
  const V most = hn::Set(d, kTwoPi / 2);
  const Vec3V<V> pivot = Scale(seen.first, InverseIfPositive(d, Length(seen.first)));
  const auto horizon = FindHorizon(d, seen, outline.corners.size(), pivot, normal);
  if (NoneOf(d, horizon.visible)) return zero;
  V sum = zero;
  if (NoneOf(d, hn::And(horizon.special, horizon.visible))) {
    for (const OutlineEdge& edge : outline.edges) {
      const auto border = FindBorder(d, edge, faces, seen.way);
      if (NoneOf(d, border.on)) continue;
      const V value = EdgeIrradiance(d, pivot, border.a, border.b, normal);
      sum = hn::Add(sum, hn::IfThenElseZero(border.on, value));
    }
  } else {
    sum = SumCutOutline(d, outline, seen, faces, orientation, horizon.special, pivot, normal);
  }
  return hn::IfThenElseZero(horizon.visible, hn::Min(hn::Mul(half, hn::Abs(sum)), most));
}

}  // namespace HWY_NAMESPACE
}  // namespace nacre
HWY_AFTER_NAMESPACE();
#endif
