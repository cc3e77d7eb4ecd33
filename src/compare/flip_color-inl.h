// SPDX-License-Identifier: Apache-2.0
// compare/flip_color-inl.h: the colour spaces and differences of FLIP on SIMD vectors of floats.
// Scalar twin: flip_color.h.
//
// The opponent colours lack the twin's scales and offsets: luminance Y / Yn in [0, 1], red_green X
// / Xn - Y / Yn, blue_yellow Y / Yn - Z / Zn. The filters do not need these, as they are linear and
// their weights sum to 1.
#if defined(NACRE_COMPARE_FLIP_COLOR_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef NACRE_COMPARE_FLIP_COLOR_INL_H_
#undef NACRE_COMPARE_FLIP_COLOR_INL_H_
#else
#define NACRE_COMPARE_FLIP_COLOR_INL_H_
#endif

#include "base/math-inl.h"
#include "compare/flip_color.h"

HWY_BEFORE_NAMESPACE();
namespace nacre {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

template <class V>
struct FlipOpponent {
  V luminance, red_green, blue_yellow;
};

template <class V>
struct FlipLab {
  V lightness, a, b;
};

// Smaller than any nonzero difference, but normal, as logarithms and reciprocal roots require.
inline constexpr float kFlipTiny = 1e-36f;

template <class D, class V = hn::Vec<D>>
HWY_INLINE V FlipDot(D d, const flip::Triple& k, V x, V y, V z) {
  const auto set = [&](double value) HWY_ATTR { return hn::Set(d, static_cast<float>(value)); };
  return hn::MulAdd(set(k[2]), z, hn::MulAdd(set(k[1]), y, hn::Mul(set(k[0]), x)));
}

// Combines rows of the matrices in double, to avoid cancellation in float.
constexpr flip::Triple WhiteRow(size_t i) {
  flip::Triple row = flip::kXyzFromRgb[i];
  for (double& value : row) value /= flip::kWhite[i];
  return row;
}
constexpr flip::Triple Difference(const flip::Triple& a, const flip::Triple& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

template <class D, class V = hn::Vec<D>>
HWY_INLINE FlipOpponent<V> OpponentFromRgb(D d, V r, V g, V b) {
  constexpr flip::Triple kY = WhiteRow(1);
  constexpr flip::Triple kRedGreen = Difference(WhiteRow(0), kY);
  constexpr flip::Triple kBlueYellow = Difference(kY, WhiteRow(2));
  return {FlipDot(d, kY, r, g, b), FlipDot(d, kRedGreen, r, g, b),
          FlipDot(d, kBlueYellow, r, g, b)};
}

// The cube root of x in [0.001, 2], within 1 ulp. The initial guess for x^(-1/3), within 4 %,
// divides the exponent, and thus the bits, by -3. Two third-order steps refine it, and a Newton
// step gives the root itself.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V CubeRoot(D d, V x) {
  const hn::RebindToSigned<D> di;
  const V third_of_bits =
      hn::MulAdd(hn::ConvertTo(d, hn::BitCast(di, x)), hn::Set(d, static_cast<float>(-1.0 / 3)),
                 hn::Set(d, static_cast<float>(0x54a2fa8c)));
  V root = hn::BitCast(d, hn::ConvertTo(di, third_of_bits));
  for (int step = 0; step < 2; ++step) {
    const V error = hn::NegMulAdd(hn::Mul(hn::Mul(root, root), root), x, hn::Set(d, 1.0f));
    const V change = hn::MulAdd(error, hn::Set(d, static_cast<float>(2.0 / 9)),
                                hn::Set(d, static_cast<float>(1.0 / 3)));
    root = hn::MulAdd(hn::Mul(root, error), change, root);
  }
  const V square = hn::Mul(root, root);
  const V rounded = hn::Mul(x, square);
  const V rest = hn::NegMulAdd(hn::Mul(rounded, rounded), rounded, x);
  return hn::MulAdd(hn::Mul(rest, square), hn::Set(d, static_cast<float>(1.0 / 3)), rounded);
}

template <class D, class V = hn::Vec<D>>
HWY_INLINE FlipLab<V> SeenColor(D d, const FlipOpponent<V>& opponent) {
  const auto set = [&](double value) HWY_ATTR { return hn::Set(d, static_cast<float>(value)); };
  constexpr flip::Matrix kRgbFromWhite = [] {
    flip::Matrix m = flip::kRgbFromXyz;
    for (flip::Triple& row : m) {
      for (size_t i = 0; i < 3; ++i) row[i] *= flip::kWhite[i];
    }
    return m;
  }();
  const V y = opponent.luminance;
  const V x = hn::Add(y, opponent.red_green), z = hn::Sub(y, opponent.blue_yellow);
  const V red = FlipDot(d, kRgbFromWhite[0], x, y, z);
  const V green = FlipDot(d, kRgbFromWhite[1], x, y, z);
  const V blue = FlipDot(d, kRgbFromWhite[2], x, y, z);
  const auto clip = [&](V value) HWY_ATTR { return hn::Min(hn::Max(value, hn::Zero(d)), set(1)); };
  const V r = clip(red), g = clip(green), b = clip(blue);
  // Where nothing is clipped, converting forth and back would only add rounding errors.
  const auto is_shown = hn::And(hn::And(hn::Eq(r, red), hn::Eq(g, green)), hn::Eq(b, blue));
  const auto f = [&](const flip::Triple& row, V unclipped) HWY_ATTR {
    constexpr double kDelta = 6.0 / 29;
    const V t = hn::IfThenElse(is_shown, unclipped, FlipDot(d, row, r, g, b));
    const V linear = hn::MulAdd(t, set(1 / (3 * kDelta * kDelta)), set(4.0 / 29));
    const V dark = set(kDelta * kDelta * kDelta);
    return hn::IfThenElse(hn::Gt(t, dark), CubeRoot(d, hn::Max(t, dark)), linear);
  };
  const V fx = f(WhiteRow(0), x), fy = f(WhiteRow(1), y), fz = f(WhiteRow(2), z);
  const V lightness = hn::MulSub(fy, set(116), set(16));
  return {lightness, hn::Mul(hn::Mul(lightness, set(5)), hn::Sub(fx, fy)),
          hn::Mul(hn::Mul(lightness, set(2)), hn::Sub(fy, fz))};
}

// sqrt(a^2 + b^2), but 1e-18 instead of 0.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V FlipNorm(D d, V a, V b) {
  return SquareRoot(d, hn::Max(hn::MulAdd(a, a, hn::Mul(b, b)), hn::Set(d, kFlipTiny)));
}

// x^exponent for x >= 0; 0 for x = 0.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V FlipPower(D d, V x, V exponent) {
  const V power = Exp2(d, hn::Mul(Log2(d, hn::Max(x, hn::Set(d, kFlipTiny))), exponent));
  return hn::IfThenElseZero(hn::Gt(x, hn::Zero(d)), power);
}

// Constants that are the same for all pixels.
struct FlipScale {
  explicit FlipScale(double largest)
      : knee(static_cast<float>(flip::kShareOfMax * largest)),
        below(static_cast<float>(flip::kShareOfRange / (flip::kShareOfMax * largest))),
        above(static_cast<float>((1 - flip::kShareOfRange) /
                                 (largest - flip::kShareOfMax * largest))) {}
  float knee, below, above;
};

template <class D, class V = hn::Vec<D>>
HWY_INLINE V ColorError(D d, const FlipScale& scale, const FlipLab<V>& p, const FlipLab<V>& q) {
  const V da = hn::Sub(p.a, q.a), db = hn::Sub(p.b, q.b);
  const V square = hn::MulAdd(da, da, hn::Mul(db, db));
  const V chroma = SquareRoot(d, hn::Max(square, hn::Set(d, kFlipTiny)));
  const V distance = hn::Add(hn::Abs(hn::Sub(p.lightness, q.lightness)),
                             hn::IfThenElseZero(hn::Gt(square, hn::Zero(d)), chroma));
  const V error = FlipPower(d, distance, hn::Set(d, static_cast<float>(flip::kColorExponent)));
  const V knee = hn::Set(d, scale.knee);
  const V high = hn::MulAdd(hn::Sub(error, knee), hn::Set(d, scale.above),
                            hn::Set(d, static_cast<float>(flip::kShareOfRange)));
  return hn::IfThenElse(hn::Lt(error, knee), hn::Mul(error, hn::Set(d, scale.below)),
                        hn::Min(high, hn::Set(d, 1.0f)));
}

template <class D, class V = hn::Vec<D>>
HWY_INLINE V FeatureError(D d, V edges, V points) {
  const V larger = hn::Max(hn::Abs(edges), hn::Abs(points));
  const V scaled = hn::Mul(larger, hn::Set(d, static_cast<float>(0.5 * std::numbers::sqrt2)));
  return SquareRoot(d, hn::Max(scaled, hn::Set(d, kFlipTiny)));
}

}  // namespace HWY_NAMESPACE
}  // namespace nacre
HWY_AFTER_NAMESPACE();
#endif
