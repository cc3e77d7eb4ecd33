// SPDX-License-Identifier: Apache-2.0
// brdf/fresnel_table-inl.h: tabulated reflectance on SIMD vectors of floats; the lanes share one
// table. Scalar twin: brdf/fresnel_table.h.
#if defined(NACRE_BRDF_FRESNEL_TABLE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef NACRE_BRDF_FRESNEL_TABLE_INL_H_
#undef NACRE_BRDF_FRESNEL_TABLE_INL_H_
#else
#define NACRE_BRDF_FRESNEL_TABLE_INL_H_
#endif

#include "base/vec3-inl.h"
#include "brdf/fresnel_table.h"

HWY_BEFORE_NAMESPACE();
namespace nacre::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// The sum of four consecutive rows of each lane, from row `first` on, times w0 to w3. Whole rows
// are loaded lane by lane, which takes 3.0 ns a hit with AVX-512 (Zen 4) where gathers of single
// coefficients take 4.9, and 3.3 instead of 5.5 with AVX2.
template <class D, class VI, class V = hn::Vec<D>>
HWY_INLINE Vec3V<V> SumRows(D d, const float* HWY_RESTRICT rows, VI first, V w0, V w1, V w2, V w3) {
  const hn::RebindToSigned<D> di;
  constexpr size_t kRow = FresnelTable::kRow;
  if constexpr (hn::MaxLanes(d) >= kRow) {
    const hn::CappedTag<float, kRow> row;
    HWY_ALIGN int32_t index[hn::MaxLanes(d)];
    HWY_ALIGN float weights[4][hn::MaxLanes(d)];
    HWY_ALIGN float sums[kRow * hn::MaxLanes(d)];
    hn::Store(first, di, index);
    hn::Store(w0, d, weights[0]);
    hn::Store(w1, d, weights[1]);
    hn::Store(w2, d, weights[2]);
    hn::Store(w3, d, weights[3]);
    for (size_t i = 0; i < hn::Lanes(d); ++i) {
      const float* HWY_RESTRICT from = rows + kRow * static_cast<size_t>(index[i]);
      const auto near = hn::MulAdd(hn::Set(row, weights[1][i]), hn::LoadU(row, from + kRow),
                                   hn::Mul(hn::Set(row, weights[0][i]), hn::LoadU(row, from)));
      const auto far =
          hn::MulAdd(hn::Set(row, weights[2][i]), hn::LoadU(row, from + 2 * kRow),
                     hn::Mul(hn::Set(row, weights[3][i]), hn::LoadU(row, from + 3 * kRow)));
      hn::Store(hn::Add(near, far), row, sums + kRow * i);
    }
    Vec3V<V> sum;
    V unused;
    hn::LoadInterleaved4(d, sums, sum.x, sum.y, sum.z, unused);
    return sum;
  } else {
    const auto index = hn::ShiftLeft<2>(first);
    const auto channel = [&](const float* HWY_RESTRICT from) HWY_ATTR {
      const V near = hn::MulAdd(w1, hn::GatherIndex(d, from + kRow, index),
                                hn::Mul(w0, hn::GatherIndex(d, from, index)));
      const V far = hn::MulAdd(w2, hn::GatherIndex(d, from + 2 * kRow, index),
                               hn::Mul(w3, hn::GatherIndex(d, from + 3 * kRow, index)));
      return hn::Add(near, far);
    };
    return {channel(rows), channel(rows + 1), channel(rows + 2)};
  }
}

// 1 - R of each channel, clamped to [0, 1].
template <class D, class V = hn::Vec<D>>
HWY_INLINE Vec3V<V> FresnelTableLoss(D d, const FresnelTable& table, V v_dot_h) {
  const hn::RebindToSigned<D> di;
  const V zero = hn::Zero(d);
  const V one = hn::Set(d, 1.0f);
  const V two = hn::Set(d, 2.0f);
  const V distance = hn::Sub(v_dot_h, hn::Set(d, table.corner));
  const V root = hn::CopySign(hn::Sqrt(hn::Abs(distance)), distance);
  const V unbounded = hn::MulAdd(hn::Set(d, table.scale), root, hn::Set(d, table.start));
  const V end = hn::Set(d, static_cast<float>(table.intervals));
  const V position = hn::Min(hn::Max(unbounded, zero), end);
  const V first = hn::Min(hn::Floor(position), hn::Sub(end, one));
  const V t = hn::Sub(position, first);
  const V u = hn::Sub(one, t);
  const V sixth = hn::Set(d, 1.0f / 6);
  const V factor =
      hn::Mul(hn::MulAdd(hn::Set(d, table.slope), v_dot_h, hn::Set(d, table.constant)), sixth);
  // The weights of FindSplineWeights, times 6.
  const V t2 = hn::Mul(t, t);
  const V u2 = hn::Mul(u, u);
  const V w0 = hn::Mul(u2, u);
  const V w1 = hn::MulAdd(hn::Mul(hn::Set(d, 3.0f), t2), hn::Sub(t, two), hn::Set(d, 4.0f));
  const V w2 = hn::MulAdd(hn::Mul(hn::Set(d, 3.0f), u2), hn::Sub(u, two), hn::Set(d, 4.0f));
  const V w3 = hn::Mul(t2, t);
  const Vec3V<V> sum =
      SumRows(d, table.coefficients.data(), hn::ConvertTo(di, first), w0, w1, w2, w3);
  const auto clamped = [&](V spline) HWY_ATTR {
    return hn::Min(hn::Max(hn::Mul(spline, factor), zero), one);
  };
  return {clamped(sum.x), clamped(sum.y), clamped(sum.z)};
}

}  // namespace nacre::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
