// SPDX-License-Identifier: Apache-2.0
// shading/fast_area_kernel.cc: the part of lobes that area lights fill, by linearly transformed
// cosines. Scalar twin: ShareOf of fast_area.cc.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "shading/fast_area_kernel.cc"
#include "hwy/foreach_target.h"

#include "hwy/highway.h"

#include "base/target_ops-inl.h"
#include "light/irradiance-inl.h"
#include "light/ltc.h"
#include "light/mesh_outline-inl.h"
#include "shading/fast_area.h"
#include "shading/soa-inl.h"

HWY_BEFORE_NAMESPACE();
namespace nacre {
namespace HWY_NAMESPACE {
namespace {
namespace hn = hwy::HWY_NAMESPACE;

using D = hn::ScalableTag<float>;
using V = hn::Vec<D>;

constexpr size_t kMaxLanes = 64 / sizeof(float);

HWY_INLINE Vec3V<V> Set3(const Vec3d& v) {
  const D d;
  return {hn::Set(d, static_cast<float>(v.x)), hn::Set(d, static_cast<float>(v.y)),
          hn::Set(d, static_cast<float>(v.z))};
}

// From hits i... to a point of the light, formed in double.
HWY_INLINE Vec3V<V> Offset(const SampledLight& light, const HitBatch& hits, const Vec3d& point,
                           size_t i) {
  const D d;
  const Vec3d place = light.place + point;
  return {SubtractAndRound(d, place.x, hits.position.x.data() + i),
          SubtractAndRound(d, place.y, hits.position.y.data() + i),
          SubtractAndRound(d, place.z, hits.position.z.data() + i)};
}

// The matrices of hits.
struct MatrixV {
  V xx, xz, zx, zz;

  HWY_INLINE Vec3V<V> Map(const Vec3V<V>& v) const {
    return {hn::MulAdd(xx, v.x, hn::Mul(xz, v.z)), v.y, hn::MulAdd(zx, v.x, hn::Mul(zz, v.z))};
  }
};

HWY_INLINE MatrixV MatrixAt(const LtcRow& row, const float* cosines) {
  const D d;
  alignas(64) float numbers[4][kMaxLanes];
  for (size_t k = 0; k < hn::Lanes(d); ++k) {
    const LtcNumbers at = AtView(row, cosines[k]);
    numbers[0][k] = at.xx;
    numbers[1][k] = at.xz;
    numbers[2][k] = at.zx;
    numbers[3][k] = at.zz;
  }
  return {hn::Load(d, numbers[0]), hn::Load(d, numbers[1]), hn::Load(d, numbers[2]),
          hn::Load(d, numbers[3])};
}

// The frame of hits, and the matrices of their views, for both parts of the lobe.
struct LobeFrameV {
  Vec3V<V> x, y, normal;
  MatrixV one, schlick;

  HWY_INLINE Vec3V<V> ToLocal(const Vec3V<V>& v) const {
    return {FusedDot(x, v), FusedDot(y, v), FusedDot(normal, v)};
  }
};

struct SharesV {
  V one, schlick;
};

// Views along the normal have any x: their matrices are round.
HWY_INLINE LobeFrameV FrameAt(const LtcRows& rows, const Surface& surface, size_t i) {
  const D d;
  LobeFrameV frame;
  frame.normal = LoadSoa(d, surface.normal, i);
  const Vec3V<V>& n = frame.normal;
  const Vec3V<V> view = LoadSoa(d, surface.to_view, i);
  const V n_dot_v = FusedDot(n, view);
  const V zero = hn::Zero(d), one = hn::Set(d, 1.0f);
  const auto steep = hn::Gt(hn::Abs(n.x), hn::Set(d, 0.7f));
  const Vec3V<V> other{hn::IfThenElse(steep, zero, one), hn::IfThenElse(steep, one, zero), zero};
  const Vec3V<V> across = AddScaled(view, n, hn::Neg(n_dot_v));
  const Vec3V<V> any = AddScaled(other, n, hn::Neg(FusedDot(n, other)));
  const auto has_side = hn::Gt(FusedDot(across, across), hn::Set(d, 1e-10f));
  const Vec3V<V> chosen = Select(has_side, across, any);
  frame.x = Scale(chosen, hn::Div(one, Length(chosen)));
  frame.y = FusedCross(n, frame.x);
  alignas(64) float cosines[kMaxLanes];
  hn::Store(n_dot_v, d, cosines);
  frame.one = MatrixAt(rows.one, cosines);
  frame.schlick = MatrixAt(rows.schlick, cosines);
  return frame;
}

// Adds those of one flat piece of the light. Parallelograms stay what they are under the matrix.
template <class Shape>
HWY_INLINE void AddPiece(const SampledLight& light, const Shape& piece, const Vec3V<V>& facing,
                         const LobeFrameV& frame, SharesV* sum) {
  const D d;
  const V zero = hn::Zero(d);
  const auto front = hn::Lt(FusedDot(piece.corner, facing), zero);
  if (!light.two_sided && hn::AllFalse(d, front)) return;
  const Vec3V<V> corner = frame.ToLocal(piece.corner), edge_x = frame.ToLocal(piece.edge_x),
                 edge_y = frame.ToLocal(piece.edge_y);
  const auto share = [&](const MatrixV& m) HWY_ATTR {
    const Shape mapped{m.Map(corner), m.Map(edge_x), m.Map(edge_y)};
    const V value = hn::Max(Irradiance(d, mapped, {zero, zero, hn::Set(d, 1.0f)}), zero);
    return light.two_sided ? value : hn::IfThenElseZero(front, value);
  };
  sum->one = hn::Add(sum->one, share(frame.one));
  sum->schlick = hn::Add(sum->schlick, share(frame.schlick));
}

// Those of a whole convex mesh, by its outline, which is convex still after the matrix.
HWY_INLINE SharesV OutlineShares(const SampledLight& light, const HitBatch& hits,
                                 const LobeFrameV& frame, size_t i) {
  const D d;
  const V zero = hn::Zero(d), one = hn::Set(d, 1.0f);
  const MeshOutline& outline = light.mesh->outline;
  V faces[kMostClosedTriangles];
  V orientation = hn::Set(d, -1.0f);
  for (size_t k = 0; k < outline.faces.size(); ++k) {
    const OutlineFace& face = outline.faces[k];
    const Vec3V<V> offset = Offset(light, hits, outline.corners[face.corner], i);
    const V height = FusedDot(offset, Set3(face.cross));
    faces[k] = light.two_sided ? one : hn::IfThenElseZero(hn::Lt(height, zero), one);
    if (light.two_sided) orientation = height;
  }
  const Vec3V<V> first = frame.ToLocal(Offset(light, hits, outline.corners[0], i));
  const auto share = [&](const MatrixV& m) HWY_ATTR {
    SeenCornersV<V> seen;
    seen.first = m.Map(first);
    for (size_t k = 0; k < outline.corners.size(); ++k) {
      seen.offset[k] = m.Map(frame.ToLocal(Set3(outline.corners[k] - outline.corners[0])));
      seen.way[k] = UnitDifference(d, seen.first, seen.offset[k]);
    }
    return Irradiance(d, outline, seen, faces, orientation, {zero, zero, one});
  };
  return {share(frame.one), share(frame.schlick)};
}

void SharesT(const LtcRows& rows, const SampledLight& light, const LobeRange& range,
             LobeShares* shares) {
  const D d;
  for (size_t i = range.begin; i < range.end; i += hn::Lanes(d)) {
    const LobeFrameV frame = FrameAt(rows, range.surface, i);
    SharesV sum{hn::Zero(d), hn::Zero(d)};
    if (light.form == SampledForm::kRectangle) {
      const RectangleLightV<V> rectangle{Offset(light, range.hits, Vec3d(0), i), Set3(light.edge_x),
                                         Set3(light.edge_y)};
      AddPiece(light, rectangle, Set3(light.normal), frame, &sum);
    } else if (!light.mesh->outline.edges.empty()) {
      sum = OutlineShares(light, range.hits, frame, i);
    } else {
      for (size_t k = 0; k < light.mesh->triangles.size(); ++k) {
        const TriangleLight<double>& triangle = light.mesh->triangles[k];
        const TriangleLightV<V> seen{Offset(light, range.hits, triangle.corner, i),
                                     Set3(triangle.edge_x), Set3(triangle.edge_y)};
        AddPiece(light, seen, Set3(light.mesh->crosses[k]), frame, &sum);
      }
    }
    const V inverse_pi = hn::Set(d, 2 / kTwoPi);
    const auto mask = hn::FirstN(d, range.end - i);
    hn::BlendedStore(hn::Mul(sum.one, inverse_pi), mask, d, shares->one.data() + i);
    hn::BlendedStore(hn::Mul(sum.schlick, inverse_pi), mask, d, shares->schlick.data() + i);
  }
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace nacre
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace nacre {
HWY_EXPORT(SharesT);

void TransformedReflectance(const SampledLight& light, const ShadingMaterial& material,
                            const LobeRange& range, LobeShares* shares, Soa3<float>* reflected) {
  const double alpha = std::get<MicrofacetModel>(material.model).alpha;
  HWY_DYNAMIC_DISPATCH(SharesT)(MakeLtcRows(std::sqrt(alpha)), light, range, shares);
  FastReflectance(material, range, reflected, &shares->grazing);
  const auto weigh = [&](const AlignedArray<float>& grazing, AlignedArray<float>* value) {
    for (size_t i = range.begin; i < range.end; ++i) {
      (*value)[i] = ((*value)[i] - grazing[i]) * shares->one[i] + grazing[i] * shares->schlick[i];
    }
  };
  weigh(shares->grazing.x, &reflected->x);
  weigh(shares->grazing.y, &reflected->y);
  weigh(shares->grazing.z, &reflected->z);
}

}  // namespace nacre
#endif
