// SPDX-License-Identifier: Apache-2.0
// base/wide-inl.h: two vectors as one, for all operations that shading uses. Kernels written for
// Wide interleave the instructions of two packets: a shading formula is one long chain of dependent
// operations, and a processor's out-of-order window does not hold two of these one after the other.
//
// The functions overload Highway's own, as those for vector groups do on some targets, so that code
// that is generic in its tag D accepts a WideTag like any other.
#if defined(NACRE_BASE_WIDE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef NACRE_BASE_WIDE_INL_H_
#undef NACRE_BASE_WIDE_INL_H_
#else
#define NACRE_BASE_WIDE_INL_H_
#endif

#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace hwy {
namespace HWY_NAMESPACE {

// A vector or a mask: the lanes of `low`, followed by those of `high`.
template <class V>
struct Wide {
  V low, high;
};

template <class D>
struct WideTag {
  using T = TFromD<D>;
  template <class NewT>
  using Rebind = WideTag<typename D::template Rebind<NewT>>;
};

template <class D>
HWY_INLINE size_t Lanes(WideTag<D>) {
  return 2 * Lanes(D());
}

template <class D>
HWY_INLINE Wide<Vec<D>> Zero(WideTag<D>) {
  return {Zero(D()), Zero(D())};
}

template <class D>
HWY_INLINE Wide<Vec<D>> Set(WideTag<D>, TFromD<D> value) {
  const Vec<D> all = Set(D(), value);
  return {all, all};
}

template <class D>
HWY_INLINE Wide<Vec<D>> Load(WideTag<D>, const TFromD<D>* HWY_RESTRICT from) {
  return {Load(D(), from), Load(D(), from + Lanes(D()))};
}

template <class D, class V>
HWY_INLINE void Store(const Wide<V>& v, WideTag<D>, TFromD<D>* HWY_RESTRICT to) {
  Store(v.low, D(), to);
  Store(v.high, D(), to + Lanes(D()));
}

template <class D>
HWY_INLINE Wide<Vec<D>> LoadU(WideTag<D>, const TFromD<D>* HWY_RESTRICT from) {
  return {LoadU(D(), from), LoadU(D(), from + Lanes(D()))};
}

template <class D, class V>
HWY_INLINE void StoreU(const Wide<V>& v, WideTag<D>, TFromD<D>* HWY_RESTRICT to) {
  StoreU(v.low, D(), to);
  StoreU(v.high, D(), to + Lanes(D()));
}

template <class D, class V, class M>
HWY_INLINE void BlendedStore(const Wide<V>& v, const Wide<M>& mask, WideTag<D>,
                             TFromD<D>* HWY_RESTRICT to) {
  BlendedStore(v.low, mask.low, D(), to);
  BlendedStore(v.high, mask.high, D(), to + Lanes(D()));
}

template <class D, class M>
HWY_INLINE bool AllTrue(WideTag<D>, const Wide<M>& mask) {
  return AllTrue(D(), mask.low) && AllTrue(D(), mask.high);
}

template <class D>
HWY_INLINE Wide<Mask<D>> FirstN(WideTag<D>, size_t count) {
  const size_t half = Lanes(D());
  return {FirstN(D(), count), FirstN(D(), count > half ? count - half : 0)};
}

template <class V>
HWY_INLINE auto MaskFromVec(const Wide<V>& v) {
  return Wide<decltype(MaskFromVec(v.low))>{MaskFromVec(v.low), MaskFromVec(v.high)};
}

template <class D, class V>
HWY_INLINE Wide<Vec<D>> BitCast(WideTag<D>, const Wide<V>& v) {
  return {BitCast(D(), v.low), BitCast(D(), v.high)};
}

template <class D, class V>
HWY_INLINE Wide<Vec<D>> ConvertTo(WideTag<D>, const Wide<V>& v) {
  return {ConvertTo(D(), v.low), ConvertTo(D(), v.high)};
}

template <int kBits, class V>
HWY_INLINE Wide<V> ShiftLeft(const Wide<V>& v) {
  return {ShiftLeft<kBits>(v.low), ShiftLeft<kBits>(v.high)};
}

template <int kBits, class V>
HWY_INLINE Wide<V> ShiftRight(const Wide<V>& v) {
  return {ShiftRight<kBits>(v.low), ShiftRight<kBits>(v.high)};
}

#define NACRE_WIDE_UNARY(op)                \
  template <class V>                        \
  HWY_INLINE Wide<V> op(const Wide<V>& v) { \
    return {op(v.low), op(v.high)};         \
  }
#define NACRE_WIDE_BINARY(op)                                 \
  template <class V>                                          \
  HWY_INLINE Wide<V> op(const Wide<V>& a, const Wide<V>& b) { \
    return {op(a.low, b.low), op(a.high, b.high)};            \
  }
#define NACRE_WIDE_TERNARY(op)                                                  \
  template <class V>                                                            \
  HWY_INLINE Wide<V> op(const Wide<V>& a, const Wide<V>& b, const Wide<V>& c) { \
    return {op(a.low, b.low, c.low), op(a.high, b.high, c.high)};               \
  }
#define NACRE_WIDE_COMPARISON(op)                                                  \
  template <class V>                                                               \
  HWY_INLINE auto op(const Wide<V>& a, const Wide<V>& b) {                         \
    return Wide<decltype(op(a.low, b.low))>{op(a.low, b.low), op(a.high, b.high)}; \
  }
#define NACRE_WIDE_CHOICE(op)                                    \
  template <class M, class V>                                    \
  HWY_INLINE Wide<V> op(const Wide<M>& mask, const Wide<V>& v) { \
    return {op(mask.low, v.low), op(mask.high, v.high)};         \
  }

NACRE_WIDE_UNARY(Neg)
NACRE_WIDE_UNARY(Abs)
NACRE_WIDE_UNARY(Sqrt)
NACRE_WIDE_UNARY(ApproximateReciprocal)
NACRE_WIDE_UNARY(ApproximateReciprocalSqrt)
NACRE_WIDE_BINARY(Add)
NACRE_WIDE_BINARY(Sub)
NACRE_WIDE_BINARY(Mul)
NACRE_WIDE_BINARY(Div)
NACRE_WIDE_BINARY(Min)
NACRE_WIDE_BINARY(Max)
NACRE_WIDE_BINARY(And)
NACRE_WIDE_TERNARY(MulAdd)
NACRE_WIDE_TERNARY(MulSub)
NACRE_WIDE_TERNARY(NegMulAdd)
NACRE_WIDE_COMPARISON(Eq)
NACRE_WIDE_COMPARISON(Gt)
NACRE_WIDE_COMPARISON(Ge)
NACRE_WIDE_COMPARISON(Lt)
NACRE_WIDE_CHOICE(IfThenElseZero)
NACRE_WIDE_CHOICE(IfThenZeroElse)

#undef NACRE_WIDE_UNARY
#undef NACRE_WIDE_BINARY
#undef NACRE_WIDE_TERNARY
#undef NACRE_WIDE_COMPARISON
#undef NACRE_WIDE_CHOICE

template <class M, class V>
HWY_INLINE Wide<V> IfThenElse(const Wide<M>& mask, const Wide<V>& yes, const Wide<V>& no) {
  return {IfThenElse(mask.low, yes.low, no.low), IfThenElse(mask.high, yes.high, no.high)};
}

}  // namespace HWY_NAMESPACE
}  // namespace hwy
HWY_AFTER_NAMESPACE();
#endif
