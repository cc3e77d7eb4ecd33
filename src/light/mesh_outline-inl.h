// SPDX-License-Identifier: Apache-2.0
// light/mesh_outline-inl.h: the irradiance of convex meshes on SIMD vectors, by their outlines: the
// sum over the edges of all triangles that face the point, in which edges shared by two of them
// cancel. polygon_irradiance.h derives the terms of an edge, and why they come in two forms.
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
namespace nacre::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// A mesh's corners relative to shaded points: the first corner, and the offsets from it to all
// corners, in space and projected to the unit sphere.
template <class V>
struct OutlineCornersV {
  Vec3V<V> first;
  std::array<Vec3V<V>, kMaxOutlineCorners> offset, unit_offset;
};

// An edge of the mesh from `a` to `b`, oriented so that the face that the point sees is on its
// left; and whether it belongs to the silhouette: the point sees one of its faces and not the
// other.
template <class M, class V>
struct SilhouetteEdgeV {
  M is_silhouette;
  Vec3V<V> a, b;
};

template <class D, class V = hn::Vec<D>>
HWY_INLINE auto FindSilhouetteEdge(D d, const OutlineEdge& edge, const V* faces,
                                   const std::array<Vec3V<V>, kMaxOutlineCorners>& corners) {
  const V zero = hn::Zero(d);
  const V left = faces[edge.left];
  const V right = edge.right == kNoFace ? zero : faces[edge.right];
  const auto ahead = hn::Gt(left, zero);
  return SilhouetteEdgeV<hn::Mask<D>, V>{hn::Ne(left, right),
                                         Select(ahead, corners[edge.from], corners[edge.to]),
                                         Select(ahead, corners[edge.to], corners[edge.from])};
}

template <class M, class V>
HWY_INLINE EdgeSumsV<V> Select(M mask, const EdgeSumsV<V>& yes, const EdgeSumsV<V>& no) {
  return {hn::IfThenElse(mask, yes.chords, no.chords),
          hn::IfThenElse(mask, yes.sectors, no.sectors), Select(mask, yes.enters, no.enters),
          Select(mask, yes.leaves, no.leaves)};
}

// The general sum, needed where the horizon clips the outline of some lanes, or nearly does.
// `orientation` is negative where the outline runs around the light's front.
template <class D, class V = hn::Vec<D>, class M>
HWY_INLINE V SumCutOutline(D d, const MeshOutline& outline, const OutlineCornersV<V>& seen,
                           const V* faces, V orientation, M needs_sectors, const Vec3V<V>& pivot,
                           const Vec3V<V>& normal) {
  const V zero = hn::Zero(d);
  V overhead = hn::Set(d, 1.0f);  // 1 where the normal meets the light
  const Vec3V<V> none{zero, zero, zero};
  EdgeSumsV<V> sums{zero, zero, none, none};
  for (const OutlineEdge& edge : outline.edges) {
    const auto silhouette = FindSilhouetteEdge(d, edge, faces, seen.offset);
    if (hn::AllFalse(d, silhouette.is_silhouette)) continue;
    EdgeSumsV<V> more = sums;
    AddEdge(d, seen.first, pivot, silhouette.a, silhouette.b, normal, &more);
    sums = Select(silhouette.is_silhouette, more, sums);
    const V side =
        TripleProduct(normal, Add(seen.first, silhouette.a), Sub(silhouette.b, silhouette.a));
    const auto inside = hn::Gt(hn::Mul(orientation, side), zero);
    overhead =
        hn::IfThenElse(silhouette.is_silhouette, hn::IfThenElseZero(inside, overhead), overhead);
  }
  return CutPolygonSum(d, sums, pivot, normal, needs_sectors, overhead);
}

// faces[i] is 1 where face i of the mesh emits towards the point, and 0 elsewhere.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V Irradiance(D d, const MeshOutline& outline, const OutlineCornersV<V>& seen,
                        const V* faces, V orientation, const Vec3V<V>& normal) {
  const V zero = hn::Zero(d);
  const Vec3V<V> pivot = Scale(seen.first, InverseIfPositive(d, Length(seen.first)));
  const auto horizon =
      FindHorizon(d, seen.unit_offset.data(), outline.corners.size(), pivot, normal);
  if (hn::AllFalse(d, horizon.visible)) return zero;
  V sum = zero;
  if (hn::AllFalse(d, hn::And(horizon.needs_sectors, horizon.visible))) {
    for (const OutlineEdge& edge : outline.edges) {
      const auto silhouette = FindSilhouetteEdge(d, edge, faces, seen.unit_offset);
      if (hn::AllFalse(d, silhouette.is_silhouette)) continue;
      const V value = EdgeIrradiance(d, pivot, silhouette.a, silhouette.b, normal);
      sum = hn::Add(sum, hn::IfThenElseZero(silhouette.is_silhouette, value));
    }
  } else {
    sum = SumCutOutline(d, outline, seen, faces, orientation, horizon.needs_sectors, pivot, normal);
  }
  return IrradianceOfSum(d, horizon.visible, sum);
}

}  // namespace nacre::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
