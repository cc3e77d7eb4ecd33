// SPDX-License-Identifier: Apache-2.0
// color/tone-inl.h: tone operators on SIMD vectors. Scalar twins: color/tone.h and color/agx.h.
//
// Each is a functor that maps r, g and b, vectors of floats, in place from [0, inf] to [0, 1]. For
// kernels and their tests.
#if defined(NACRE_COLOR_TONE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef NACRE_COLOR_TONE_INL_H_
#undef NACRE_COLOR_TONE_INL_H_
#else
#define NACRE_COLOR_TONE_INL_H_
#endif

#include "hwy/contrib/math/math-inl.h"
#include "hwy/highway.h"

#include "color/agx.h"

HWY_BEFORE_NAMESPACE();
namespace nacre::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// The operator that applies a curve to each channel.
template <class Curve>
struct ChannelTone {
  Curve curve;

  template <class D, class V>
  HWY_INLINE void operator()(D d, V& r, V& g, V& b) const {
    r = curve(d, r);
    g = curve(d, g);
    b = curve(d, b);
  }
};

struct NoneCurve {
  template <class D, class V>
  HWY_INLINE V operator()(D d, V x) const {
    return hn::Min(x, hn::Set(d, 1.0f));
  }
};
using NoneTone = ChannelTone<NoneCurve>;

// x as the ratio u / v of two numbers in [0, 1], one of which is 1; v = 0 at infinity. Rational
// curves of x are homogeneous in u and v and cannot overflow.
template <class D, class V>
HWY_INLINE V RatioNumerator(D d, V x) {
  return hn::Min(x, hn::Set(d, 1.0f));
}
template <class D, class V>
HWY_INLINE V RatioDenominator(D d, V x) {
  const V one = hn::Set(d, 1.0f);
  return hn::Min(hn::Div(one, x), one);
}

struct ReinhardCurve {
  template <class D, class V>
  HWY_INLINE V operator()(D d, V x) const {
    const V u = RatioNumerator(d, x);
    return hn::Div(u, hn::Add(u, RatioDenominator(d, x)));
  }
};
using ReinhardTone = ChannelTone<ReinhardCurve>;

struct ReinhardExtendedCurve {
  explicit ReinhardExtendedCurve(double white_point)
      : white(static_cast<float>(white_point)),
        inverse_square(static_cast<float>(1 / (white_point * white_point))) {}

  template <class D, class V>
  HWY_INLINE V operator()(D d, V x) const {
    const V one = hn::Set(d, 1.0f);
    const V below = hn::Min(x, hn::Set(d, white));
    const V numerator = hn::Mul(below, hn::MulAdd(below, hn::Set(d, inverse_square), one));
    return hn::Min(hn::Div(numerator, hn::Add(one, below)), one);
  }

  float white;
  float inverse_square;
};
using ReinhardExtendedTone = ChannelTone<ReinhardExtendedCurve>;

struct AcesCurve {
  template <class D, class V>
  HWY_INLINE V operator()(D d, V x) const {
    const V u = RatioNumerator(d, x);
    const V v = RatioDenominator(d, x);
    // Numerator and denominator are multiplied by 100, so that the coefficients are exact.
    const auto set = [&](float value) HWY_ATTR { return hn::Set(d, value); };
    const V numerator = hn::Mul(u, hn::MulAdd(set(251), u, hn::Mul(set(3), v)));
    const V linear = hn::MulAdd(set(243), u, hn::Mul(set(59), v));
    const V denominator = hn::MulAdd(u, linear, hn::Mul(hn::Mul(set(14), v), v));
    return hn::Min(hn::Div(numerator, denominator), set(1));
  }
};
using AcesTone = ChannelTone<AcesCurve>;

// The scalar twin's formulas over one common denominator: with q = peak + headroom - start,
// a = q - headroom^2 = q new_peak, e = 0.15 q (peak - new_peak), the result is
// a (x q + e peak) / (q peak (q + e)).
struct NeutralTone {
  template <class D, class V>
  HWY_INLINE void operator()(D d, V& r, V& g, V& b) const {
    constexpr double kStart = 0.8 - 0.04, kHeadroom = 1 - kStart;
    const auto set = [&](double value) HWY_ATTR { return hn::Set(d, static_cast<float>(value)); };
    // Above this, the result is within 2^-26 of white. The limit keeps products of four finite.
    const V largest = set(1e9);
    r = hn::Min(r, largest);
    g = hn::Min(g, largest);
    b = hn::Min(b, largest);
    const V lowest = hn::Min(hn::Min(r, g), b);
    const V kept =
        hn::IfThenElse(hn::Lt(lowest, set(0.08)), hn::Mul(hn::Mul(set(6.25), lowest), lowest),
                       hn::Sub(lowest, set(0.04)));
    r = hn::Add(hn::Sub(r, lowest), kept);
    g = hn::Add(hn::Sub(g, lowest), kept);
    b = hn::Add(hn::Sub(b, lowest), kept);
    const V peak = hn::Max(hn::Max(r, g), b);
    const V start = set(kStart);
    const V high = hn::Max(peak, start);  // a valid peak for dark pixels, whose result is not used
    const V q = hn::Add(high, set(kHeadroom - kStart));
    const V a = hn::Sub(q, set(kHeadroom * kHeadroom));
    const V e = hn::Mul(set(0.15), hn::MulSub(high, q, a));
    const V k = hn::Div(a, hn::Mul(hn::Mul(q, high), hn::Add(q, e)));
    const V white = hn::Mul(e, high);
    const auto compressed = hn::Ge(peak, start);
    const auto compress = [&](V x) HWY_ATTR {
      const V mixed = hn::Min(hn::Mul(k, hn::MulAdd(x, q, white)), set(1));
      return hn::IfThenElse(compressed, mixed, x);
    };
    r = compress(r);
    g = compress(g);
    b = compress(b);
  }
};

struct AgxTone {
  template <class D, class V>
  HWY_INLINE void operator()(D d, V& r, V& g, V& b) const {
    const V limit = hn::Set(d, 1e6f);
    Transform(d, agx::kInset, hn::Min(r, limit), hn::Min(g, limit), hn::Min(b, limit), &r, &g, &b);
    Transform(d, agx::kOutset, Curve(d, r), Curve(d, g), Curve(d, b), &r, &g, &b);
    r = Linearise(d, r);
    g = Linearise(d, g);
    b = Linearise(d, b);
  }

  template <class D, class V>
  static HWY_INLINE void Transform(D d, const agx::Matrix& matrix, V r, V g, V b, V* out_r,
                                   V* out_g, V* out_b) {
    const auto row = [&](const double(&k)[3]) HWY_ATTR {
      const V first = hn::Mul(hn::Set(d, static_cast<float>(k[0])), r);
      return hn::MulAdd(hn::Set(d, static_cast<float>(k[2])), b,
                        hn::MulAdd(hn::Set(d, static_cast<float>(k[1])), g, first));
    };
    *out_r = row(matrix.m[0]);
    *out_g = row(matrix.m[1]);
    *out_b = row(matrix.m[2]);
  }

  // x^exponent for x > 0.
  template <class D, class V>
  static HWY_INLINE V Power(D d, V x, V exponent) {
    return hn::Exp(d, hn::Mul(hn::Log(d, x), exponent));
  }

  // Logarithmic encoding and sigmoid of one channel. Not inlined, like Linearise: six copies of
  // their exponentials and logarithms are no faster and take minutes to compile.
  template <class D, class V>
  static HWY_NOINLINE V Curve(D d, V x) {
    const auto set = [&](double value) HWY_ATTR { return hn::Set(d, static_cast<float>(value)); };
    constexpr double kStopsPerLog = 1.4426950408889634 / agx::kStops;  // log2(e)
    const V clamped = hn::Min(hn::Max(x, set(agx::kDarkest)), set(agx::kBrightest));
    // The logarithm is relative to middle grey, so that s is the difference from the pivot without
    // cancellation.
    const V s = hn::Mul(hn::Log(d, hn::Mul(clamped, set(1 / agx::kMiddleGrey))), set(kStopsPerLog));
    const V a = hn::Abs(s);
    const V cube = hn::Mul(hn::Mul(a, a), a);
    const auto toe = hn::Lt(s, hn::Zero(d));
    const V term =
        hn::IfThenElse(toe, hn::Mul(set(agx::kToe), cube),
                       hn::Mul(set(agx::kShoulder), hn::Mul(cube, hn::Sqrt(hn::Sqrt(a)))));
    const V exponent = hn::IfThenElse(toe, set(-1.0 / 3), set(-4.0 / 13));
    const V power = Power(d, hn::Add(term, set(1)), exponent);
    return hn::MulAdd(hn::Add(s, s), power, set(0.5));
  }

  // The light of a display of power kDisplayPower. x is clamped to at least 1e-9, whose light is
  // 3e-20 of white's, code 0; there the code is 0 anyway.
  template <class D, class V>
  static HWY_NOINLINE V Linearise(D d, V x) {
    const V encoded = hn::Min(hn::Max(x, hn::Set(d, 1e-9f)), hn::Set(d, 1.0f));
    const V light = Power(d, encoded, hn::Set(d, static_cast<float>(agx::kDisplayPower)));
    return hn::Min(light, hn::Set(d, 1.0f));
  }
};

}  // namespace nacre::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
