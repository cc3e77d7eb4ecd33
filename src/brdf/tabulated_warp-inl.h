// SPDX-License-Identifier: Apache-2.0
// brdf/tabulated_warp-inl.h: tabulated densities and their warps on SIMD vectors, by gathers.
// Scalar twin: tabulated_warp.h.
#if defined(NACRE_BRDF_TABULATED_WARP_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef NACRE_BRDF_TABULATED_WARP_INL_H_
#undef NACRE_BRDF_TABULATED_WARP_INL_H_
#else
#define NACRE_BRDF_TABULATED_WARP_INL_H_
#endif

#include <limits>

#include "hwy/highway.h"

#include "brdf/tabulated_warp.h"

HWY_BEFORE_NAMESPACE();
namespace nacre::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

template <class D>
using IndexTag = hn::RebindToSigned<D>;
template <class D>
using IndexV = hn::Vec<IndexTag<D>>;

template <class D>
HWY_INLINE IndexV<D> SetIndex(D, size_t i) {
  return hn::Set(IndexTag<D>(), static_cast<int32_t>(i));
}

// The whole part of x, at least 0 and at most `last`, also of numbers that are none: gathers must
// stay in their tables.
template <class D, class V = hn::Vec<D>>
HWY_INLINE IndexV<D> ToIndex(D d, V x, size_t last) {
  const IndexTag<D> di;
  return hn::Min(hn::Max(hn::ConvertTo(di, x), hn::Zero(di)), SetIndex(d, last));
}

template <class D, class V = hn::Vec<D>>
HWY_INLINE V Clamp01(D d, V x) {
  return hn::Min(hn::Max(x, hn::Zero(d)), hn::Set(d, 1.0f));
}

template <class V>
HWY_INLINE V LerpV(V a, V b, V t) {
  return hn::MulAdd(hn::Sub(b, a), t, a);
}

// The largest index for which of(index) <= x, among the first of two neighbours, or 0.
template <class D, class V = hn::Vec<D>, class Of>
HWY_INLINE IndexV<D> FindInterval(D d, size_t count, V x, const Of& of) {
  const IndexTag<D> di;
  IndexV<D> found = hn::Zero(di);
  if (count < 3) return found;
  size_t first = 1;
  while (2 * first <= count - 2) first *= 2;
  const IndexV<D> last = SetIndex(d, count - 2);
  for (size_t step = first; step > 0; step /= 2) {
    const IndexV<D> next = hn::Add(found, SetIndex(d, step));
    const IndexV<D> inside = hn::Min(next, last);
    const auto below = hn::RebindMask(di, hn::Le(of(inside), x));
    found = hn::IfThenElse(hn::And(below, hn::Eq(inside, next)), next, found);
  }
  return found;
}

template <class D>
struct BetweenNodesV {
  IndexV<D> index;
  hn::Vec<D> fraction;
};

template <class D, class V = hn::Vec<D>>
HWY_INLINE BetweenNodesV<D> FindAngle(D d, const std::vector<float>& angles, V angle) {
  if (angles.size() < 2) return {hn::Zero(IndexTag<D>()), hn::Zero(d)};
  const float* const from = angles.data();
  const IndexV<D> i = FindInterval(
      d, angles.size(), angle, [&](IndexV<D> k) HWY_ATTR { return hn::GatherIndex(d, from, k); });
  const V first = hn::GatherIndex(d, from, i), second = hn::GatherIndex(d, from + 1, i);
  return {i, Clamp01(d, hn::Div(hn::Sub(angle, first), hn::Sub(second, first)))};
}

template <class D>
struct SlicesV {
  IndexV<D> index[4];
  hn::Vec<D> weight[4];
  size_t count;
};

template <class D, class V = hn::Vec<D>>
HWY_INLINE SlicesV<D> SlicesAt(D d, const SliceAngles& angles, V phi, V theta) {
  const V one = hn::Set(d, 1.0f);
  const BetweenNodesV<D> t = FindAngle(d, angles.theta, theta), p = FindAngle(d, angles.phi, phi);
  const bool two_phis = angles.phi.size() > 1, two_thetas = angles.theta.size() > 1;
  SlicesV<D> slices;
  slices.count = 0;
  for (size_t row = 0; row < (two_phis ? 2u : 1u); ++row) {
    const V of_row = row == 0 ? hn::Sub(one, p.fraction) : p.fraction;
    const IndexV<D> first = hn::Add(
        hn::Mul(hn::Add(p.index, SetIndex(d, row)), SetIndex(d, angles.theta.size())), t.index);
    slices.index[slices.count] = first;
    slices.weight[slices.count++] = hn::Mul(of_row, hn::Sub(one, t.fraction));
    if (!two_thetas) continue;
    slices.index[slices.count] = hn::Add(first, SetIndex(d, 1));
    slices.weight[slices.count++] = hn::Mul(of_row, t.fraction);
  }
  return slices;
}

template <class D, class V = hn::Vec<D>>
HWY_INLINE V BlendSlices(D d, const SlicesV<D>& slices, const float* table, size_t stride,
                         IndexV<D> at) {
  const IndexV<D> of_slice = SetIndex(d, stride);
  V sum = hn::Zero(d);
  for (size_t s = 0; s < slices.count; ++s) {
    const IndexV<D> entry = hn::Add(hn::Mul(slices.index[s], of_slice), at);
    sum = hn::MulAdd(slices.weight[s], hn::GatherIndex(d, table, entry), sum);
  }
  return sum;
}

template <class D, class V = hn::Vec<D>>
HWY_INLINE BetweenNodesV<D> FindNode(D d, size_t count, V x) {
  const V scaled = hn::Mul(Clamp01(d, x), hn::Set(d, static_cast<float>(count - 1)));
  const IndexV<D> i = ToIndex(d, scaled, count - 2);
  return {i, hn::Sub(scaled, hn::ConvertTo(d, i))};
}

// Bilinear between four nodes around `at`, which node(index) gives.
template <class D, class Node>
HWY_INLINE auto BilinearAt(D d, IndexV<D> at, size_t width, hn::Vec<D> x, hn::Vec<D> y,
                           const Node& node) {
  const IndexV<D> one = SetIndex(d, 1), next = hn::Add(at, SetIndex(d, width));
  return LerpV(LerpV(node(at), node(hn::Add(at, one)), x),
               LerpV(node(next), node(hn::Add(next, one)), x), y);
}

template <class V>
struct SquarePointV {
  V x, y;
};

template <class D, class V = hn::Vec<D>>
HWY_INLINE V BilinearOfSlices(D d, const SlicesV<D>& slices, const float* table, size_t stride,
                              size_t width, size_t height, const SquarePointV<V>& p) {
  const BetweenNodesV<D> i = FindNode(d, width, p.x), j = FindNode(d, height, p.y);
  const IndexV<D> at = hn::Add(hn::Mul(j.index, SetIndex(d, width)), i.index);
  return BilinearAt(d, at, width, i.fraction, j.fraction,
                    [&](IndexV<D> k) HWY_ATTR { return BlendSlices(d, slices, table, stride, k); });
}

template <class D, class V = hn::Vec<D>>
HWY_INLINE V WarpDensity(D d, const TabulatedWarp& warp, const SlicesV<D>& slices,
                         const SquarePointV<V>& p) {
  return BilinearOfSlices(d, slices, warp.density.data(), warp.width * warp.height, warp.width,
                          warp.height, p);
}

template <class D, class V = hn::Vec<D>>
HWY_INLINE V LinearIntegral(D d, V a, V b, V t) {
  return hn::Mul(t, hn::MulAdd(hn::Mul(hn::Sub(b, a), t), hn::Set(d, 0.5f), a));
}

template <class D, class V = hn::Vec<D>>
HWY_INLINE V InvertLinear(D d, V a, V b, V integral) {
  const V two_integral = hn::Add(integral, integral);
  const V root =
      hn::Sqrt(hn::Max(hn::MulAdd(two_integral, hn::Sub(b, a), hn::Mul(a, a)), hn::Zero(d)));
  const V sum = hn::Max(hn::Add(a, root), hn::Set(d, std::numeric_limits<float>::min()));
  return Clamp01(d, hn::Div(two_integral, sum));
}

// The row and its neighbour, of which WarpInverse and WarpForward need the same.
template <class D>
struct WarpTables {
  const TabulatedWarp& warp;
  const SlicesV<D>& slices;

  HWY_INLINE hn::Vec<D> Along(D d, IndexV<D> k) const {
    return BlendSlices(d, slices, warp.along_row.data(), warp.width * warp.height, k);
  }
  HWY_INLINE hn::Vec<D> Density(D d, IndexV<D> k) const {
    return BlendSlices(d, slices, warp.density.data(), warp.width * warp.height, k);
  }
  HWY_INLINE hn::Vec<D> UpToRow(D d, IndexV<D> k) const {
    return BlendSlices(d, slices, warp.up_to_row.data(), warp.height, k);
  }
};

template <class D, class V = hn::Vec<D>>
HWY_INLINE SquarePointV<V> WarpInverse(D d, const TabulatedWarp& warp, const SlicesV<D>& slices,
                                       const SquarePointV<V>& p) {
  const WarpTables<D> tables{warp, slices};
  const IndexV<D> width = SetIndex(d, warp.width), one = SetIndex(d, 1);
  const BetweenNodesV<D> i = FindNode(d, warp.width, p.x), j = FindNode(d, warp.height, p.y);
  const IndexV<D> row = hn::Mul(j.index, width), next = hn::Add(row, width);
  const V of_row = tables.Along(d, hn::Sub(next, one));
  const V of_next = tables.Along(d, hn::Sub(hn::Add(next, width), one));
  const V by_rows = hn::Set(d, 1.0f / static_cast<float>(warp.height - 1));
  const V by_columns = hn::Set(d, 1.0f / static_cast<float>(warp.width - 1));
  const V y = hn::MulAdd(LinearIntegral(d, of_row, of_next, j.fraction), by_rows,
                         tables.UpToRow(d, j.index));
  const IndexV<D> at = hn::Add(row, i.index), below = hn::Add(at, width);
  const V a = LerpV(tables.Density(d, at), tables.Density(d, below), j.fraction);
  const V b = LerpV(tables.Density(d, hn::Add(at, one)), tables.Density(d, hn::Add(below, one)),
                    j.fraction);
  const V x = hn::MulAdd(LinearIntegral(d, a, b, i.fraction), by_columns,
                         LerpV(tables.Along(d, at), tables.Along(d, below), j.fraction));
  const V total = LerpV(of_row, of_next, j.fraction);
  const auto any = hn::Gt(total, hn::Zero(d));
  return {hn::IfThenElse(any, hn::Div(x, hn::IfThenElse(any, total, hn::Set(d, 1.0f))), p.x), y};
}

template <class D, class V = hn::Vec<D>>
HWY_INLINE SquarePointV<V> WarpForward(D d, const TabulatedWarp& warp, const SlicesV<D>& slices,
                                       const SquarePointV<V>& u) {
  const WarpTables<D> tables{warp, slices};
  const IndexV<D> width = SetIndex(d, warp.width), one = SetIndex(d, 1);
  const V rows = hn::Set(d, static_cast<float>(warp.height - 1));
  const V columns = hn::Set(d, static_cast<float>(warp.width - 1));
  const IndexV<D> j =
      FindInterval(d, warp.height, u.y, [&](IndexV<D> k) HWY_ATTR { return tables.UpToRow(d, k); });
  const IndexV<D> row = hn::Mul(j, width), next = hn::Add(row, width);
  const V of_row = tables.Along(d, hn::Sub(next, one));
  const V of_next = tables.Along(d, hn::Sub(hn::Add(next, width), one));
  const V y = InvertLinear(d, of_row, of_next, hn::Mul(hn::Sub(u.y, tables.UpToRow(d, j)), rows));
  const auto along_here = [&](IndexV<D> k) HWY_ATTR {
    return LerpV(tables.Along(d, hn::Add(row, k)), tables.Along(d, hn::Add(next, k)), y);
  };
  const V target = hn::Mul(u.x, LerpV(of_row, of_next, y));
  const IndexV<D> i = FindInterval(d, warp.width, target, along_here);
  const IndexV<D> at = hn::Add(row, i), below = hn::Add(next, i);
  const V a = LerpV(tables.Density(d, at), tables.Density(d, below), y);
  const V b = LerpV(tables.Density(d, hn::Add(at, one)), tables.Density(d, hn::Add(below, one)), y);
  const V x = InvertLinear(d, a, b, hn::Mul(hn::Sub(target, along_here(i)), columns));
  return {hn::Div(hn::Add(hn::ConvertTo(d, i), x), columns),
          hn::Div(hn::Add(hn::ConvertTo(d, j), y), rows)};
}

}  // namespace nacre::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
