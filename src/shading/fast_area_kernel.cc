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

// The frame of hits, and the matrices of their views.
struct LobeFrameV {
  Vec3V<V> x, y, normal;
  V xx, xz, zx, zz;

  HWY_INLINE Vec3V<V> Map(const Vec3V<V>& v) const {
    const V along_x = FusedDot(x, v), along_z = FusedDot(normal, v);
    return {hn::MulAdd(xx, along_x, hn::Mul(xz, along_z)), FusedDot(y, v),
            hn::MulAdd(zx, along_x, hn::Mul(zz, along_z))};
  }
};

// Views along the normal have any x: their matrices are round.
HWY_INLINE LobeFrameV FrameAt(const LtcRow& row, const Surface& surface, size_t i) {
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
  alignas(64) float cosines[kMaxLanes], numbers[4][kMaxLanes];
  hn::Store(n_dot_v, d, cosines);
  for (size_t k = 0; k < hn::Lanes(d); ++k) {
    const LtcNumbers at = AtView(row, cosines[k]);
    numbers[0][k] = at.xx;
    numbers[1][k] = at.xz;
    numbers[2][k] = at.zx;
    numbers[3][k] = at.zz;
  }
  frame.xx = hn::Load(d, numbers[0]);
  frame.xz = hn::Load(d, numbers[1]);
  frame.zx = hn::Load(d, numbers[2]);
  frame.zz = hn::Load(d, numbers[3]);
  return frame;
}

// Of one flat piece of the light. Parallelograms stay what they are under the matrix.
template <class Shape>
HWY_INLINE V PieceShare(const SampledLight& light, const Shape& piece, const Vec3V<V>& facing,
                        const LobeFrameV& frame) {
  const D d;
  const V zero = hn::Zero(d);
  const auto front = hn::Lt(FusedDot(piece.corner, facing), zero);
  if (!light.two_sided && hn::AllFalse(d, front)) return zero;
  const Shape mapped{frame.Map(piece.corner), frame.Map(piece.edge_x), frame.Map(piece.edge_y)};
  const V value = hn::Max(Irradiance(d, mapped, {zero, zero, hn::Set(d, 1.0f)}), zero);
  return light.two_sided ? value : hn::IfThenElseZero(front, value);
}

void ShareT(const LtcRow& row, const SampledLight& light, const LobeRange& range, float* share) {
  const D d;
  for (size_t i = range.begin; i < range.end; i += hn::Lanes(d)) {
    const LobeFrameV frame = FrameAt(row, range.surface, i);
    V sum = hn::Zero(d);
    if (light.form == SampledForm::kRectangle) {
      const RectangleLightV<V> rectangle{Offset(light, range.hits, Vec3d(0), i), Set3(light.edge_x),
                                         Set3(light.edge_y)};
      sum = PieceShare(light, rectangle, Set3(light.normal), frame);
    } else {
      for (size_t k = 0; k < light.mesh->triangles.size(); ++k) {
        const TriangleLight<double>& triangle = light.mesh->triangles[k];
        const TriangleLightV<V> seen{Offset(light, range.hits, triangle.corner, i),
                                     Set3(triangle.edge_x), Set3(triangle.edge_y)};
        sum = hn::Add(sum, PieceShare(light, seen, Set3(light.mesh->crosses[k]), frame));
      }
    }
    const V whole = hn::Mul(sum, hn::Set(d, 2 / kTwoPi));
    hn::BlendedStore(whole, hn::FirstN(d, range.end - i), d, share + i);
  }
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace nacre
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace nacre {
HWY_EXPORT(ShareT);

void TransformedShare(const SampledLight& light, const ShadingMaterial& material,
                      const LobeRange& range, float* share) {
  const double alpha = std::get<MicrofacetModel>(material.model).alpha;
  HWY_DYNAMIC_DISPATCH(ShareT)(MakeLtcRow(std::sqrt(alpha)), light, range, share);
}

}  // namespace nacre
#endif
