// SPDX-License-Identifier: Apache-2.0
// shading/fast_area_kernel.cc: the part of lobes that area lights fill, by linearly transformed
// cosines: of rectangles and meshes. Scalar twin: SeenLight::Share of seen_light.h.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "shading/fast_area_kernel.cc"
#include "hwy/foreach_target.h"

#include "hwy/highway.h"

#include "light/ltc-inl.h"
#include "shading/fast_area_kernels.h"
#include "shading/seen-inl.h"

HWY_BEFORE_NAMESPACE();
namespace nacre {
namespace HWY_NAMESPACE {
namespace {
namespace hn = hwy::HWY_NAMESPACE;

using D = hn::ScalableTag<float>;
using V = hn::Vec<D>;

struct SharesV {
  V one, schlick;
};

// Adds those of one flat piece of the light. Parallelograms stay what they are under the matrix.
template <class Shape>
HWY_INLINE void AddPiece(const SampledLight& light, const Shape& piece, const Vec3V<V>& facing,
                         const LobeFrameV<V>& frame, SharesV* sum) {
  const D d;
  const V zero = hn::Zero(d);
  const auto front = hn::Lt(FusedDot(piece.corner, facing), zero);
  if (!light.two_sided && hn::AllFalse(d, front)) return;
  const Vec3V<V> corner = frame.ToLocal(piece.corner), edge_x = frame.ToLocal(piece.edge_x),
                 edge_y = frame.ToLocal(piece.edge_y);
  const auto share = [&](const MatrixV<V>& m) HWY_ATTR {
    const Shape mapped{m.Map(corner), m.Map(edge_x), m.Map(edge_y)};
    const V value = hn::Max(Irradiance(d, mapped, {zero, zero, hn::Set(d, 1.0f)}), zero);
    return light.two_sided ? value : hn::IfThenElseZero(front, value);
  };
  sum->one = hn::Add(sum->one, share(frame.one));
  sum->schlick = hn::Add(sum->schlick, share(frame.schlick));
}

// Those of a whole convex mesh, by its outline, which is convex still after the matrix.
HWY_INLINE SharesV OutlineShares(const SampledLight& light, const HitBatch& hits,
                                 const LobeFrameV<V>& frame, size_t i) {
  const D d;
  SeenFaces faces;
  FindFaces(light, hits, i, &faces);
  const Vec3V<V> up{hn::Zero(d), hn::Zero(d), hn::Set(d, 1.0f)};
  const auto share = [&](const MatrixV<V>& m) HWY_ATTR {
    return OutlineIrradiance(light, hits, i, faces, up, [&](const Vec3V<V>& offset) HWY_ATTR {
      return m.Map(frame.ToLocal(offset));
    });
  };
  return {share(frame.one), share(frame.schlick)};
}

void SharesT(const LtcRows& rows, const SampledLight& light, const LobeRange& range,
             LobeShares* shares) {
  const D d;
  for (size_t i = range.begin; i < range.end; i += hn::Lanes(d)) {
    const LobeFrameV<V> frame =
        FrameAt(d, rows, LoadSoa(d, range.surface.normal, i), LoadSoa(d, range.surface.to_view, i));
    SharesV sum{hn::Zero(d), hn::Zero(d)};
    if (light.form == SampledForm::kRectangle) {
      const RectangleLightV<V> rectangle{Offset(light, range.hits, Vec3d(0), i), Set3(light.edge_x),
                                         Set3(light.edge_y)};
      AddPiece(light, rectangle, Set3(light.normal), frame, &sum);
    } else if (!light.mesh->outline.edges.empty()) {
      sum = OutlineShares(light, range.hits, frame, i);
    } else {
      for (size_t k = 0; k < light.mesh->triangles.size(); ++k) {
        AddPiece(light, SeenTriangle(light, range.hits, k, i), Set3(light.mesh->crosses[k]), frame,
                 &sum);
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

void FlatShares(const LtcRows& rows, const SampledLight& light, const LobeRange& range,
                LobeShares* shares) {
  HWY_DYNAMIC_DISPATCH(SharesT)(rows, light, range, shares);
}

}  // namespace nacre
#endif
