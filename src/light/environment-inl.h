// SPDX-License-Identifier: Apache-2.0
// light/environment-inl.h: an environment's image on SIMD vectors. Scalar twin: environment.h.
//
// Look-ups are done lane by lane: a texel is three floats side by side, and sampling one takes
// random reads of tables, which gathers do not speed up.
#if defined(NACRE_LIGHT_ENVIRONMENT_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef NACRE_LIGHT_ENVIRONMENT_INL_H_
#undef NACRE_LIGHT_ENVIRONMENT_INL_H_
#else
#define NACRE_LIGHT_ENVIRONMENT_INL_H_
#endif

#include <cmath>
#include <cstddef>
#include <limits>

#include "base/trig-inl.h"
#include "base/vec3-inl.h"
#include "light/environment.h"

HWY_BEFORE_NAMESPACE();
namespace nacre::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

inline constexpr size_t kMaxEnvironmentLanes = 2 * 64 / sizeof(float);

template <class D, class V = hn::Vec<D>>
HWY_INLINE LatLong<V> LatLongFromDirection(D d, const Vec3V<V>& direction) {
  const V zero = hn::Zero(d);
  const V one = hn::Set(d, 1.0f);
  const V turns = hn::Set(d, static_cast<float>(M_1_PI / 2));
  const V half_turns = hn::Set(d, static_cast<float>(M_1_PI));
  const V turn = hn::Mul(Atan2Upper(d, hn::Abs(direction.x), hn::Neg(direction.z)), turns);
  const V u = hn::IfThenElse(hn::Lt(direction.x, zero), hn::Sub(one, turn), turn);
  const V r = hn::Sqrt(hn::MulAdd(direction.x, direction.x, hn::Mul(direction.z, direction.z)));
  return {hn::IfThenElseZero(hn::Lt(u, one), u),
          hn::Mul(Atan2Upper(d, r, direction.y), half_turns)};
}

template <class V>
struct EnvironmentTexelV {
  V red, green, blue, pdf;
};

using EnvironmentLanes = float[4][kMaxEnvironmentLanes];  // red, green, blue and pdf

HWY_INLINE void StoreTexel(const EnvironmentMap& map, size_t index, size_t lane,
                           EnvironmentLanes& lanes) {
  const Vec3f& texel = map.texels[static_cast<ptrdiff_t>(index)];
  lanes[0][lane] = texel.x;
  lanes[1][lane] = texel.y;
  lanes[2][lane] = texel.z;
}

// Returns the texels that StoreTexel has stored for all lanes, with the pdf of TexelOf.
template <class D, class V = hn::Vec<D>>
HWY_INLINE EnvironmentTexelV<V> LoadTexels(D d, const EnvironmentMap& map,
                                           EnvironmentLanes& lanes) {
  using DD = hn::ScalableTag<double>;
  const DD dd;
  const hn::Rebind<float, DD> df;
  const auto smallest = hn::Set(df, std::numeric_limits<float>::min());
  for (size_t i = 0; i < hn::Lanes(d); i += hn::Lanes(dd)) {
    const auto term = [&](size_t c) HWY_ATTR {
      const auto value = hn::Load(df, lanes[c] + i);
      const auto seen = hn::IfThenElseZero(hn::Ge(value, smallest), value);
      return hn::Mul(hn::Set(dd, kLuminanceWeights[c]), hn::PromoteTo(dd, seen));
    };
    const auto luminance = hn::Add(hn::Add(term(0), term(1)), term(2));
    const auto rounded = hn::PromoteTo(dd, hn::DemoteTo(df, luminance));
    hn::Store(hn::DemoteTo(df, hn::Div(rounded, hn::Set(dd, map.sum))), df, lanes[3] + i);
  }
  return {hn::Load(d, lanes[0]), hn::Load(d, lanes[1]), hn::Load(d, lanes[2]),
          map.is_black ? hn::Zero(d) : hn::Load(d, lanes[3])};
}

// The radiance of these directions, and the pdf with which they are sampled.
template <class D, class V = hn::Vec<D>>
HWY_INLINE EnvironmentTexelV<V> TexelAt(D d, const EnvironmentMap& map, const Vec3V<V>& direction) {
  const LatLong<V> at = LatLongFromDirection(d, direction);
  alignas(64) float u[kMaxEnvironmentLanes], v[kMaxEnvironmentLanes];
  hn::Store(hn::Mul(at.u, hn::Set(d, static_cast<float>(map.width))), d, u);
  hn::Store(hn::Mul(at.v, hn::Set(d, static_cast<float>(map.height))), d, v);
  alignas(64) EnvironmentLanes lanes;
  for (size_t i = 0; i < hn::Lanes(d); ++i) {
    const int x = HWY_MIN(static_cast<int>(u[i]), map.width - 1);
    const int y = HWY_MIN(static_cast<int>(v[i]), map.height - 1);
    const auto texel =
        static_cast<size_t>(y) * static_cast<size_t>(map.width) + static_cast<size_t>(x);
    StoreTexel(map, texel, i, lanes);
  }
  return LoadTexels(d, map, lanes);
}

template <class V>
struct EnvironmentSampleV {
  Vec3V<V> to_light;
  EnvironmentTexelV<V> texel;
};

// One sample per lane, from numbers with 32 random bits: the 24 bits of a float would not reach dim
// texels next to a sun.
template <class D, class V = hn::Vec<D>>
HWY_INLINE EnvironmentSampleV<V> SampleEnvironment(D d, const EnvironmentMap& map,
                                                   const uint32_t* HWY_RESTRICT bits0,
                                                   const uint32_t* HWY_RESTRICT bits1) {
  const V zero = hn::Zero(d);
  const V one = hn::Set(d, 1.0f);
  if (map.is_black) return {{zero, one, zero}, {zero, zero, zero, zero}};
  alignas(64) float u[kMaxEnvironmentLanes], heights[kMaxEnvironmentLanes];
  alignas(64) float signs[kMaxEnvironmentLanes];
  alignas(64) EnvironmentLanes lanes;
  for (size_t i = 0; i < hn::Lanes(d); ++i) {
    const EnvironmentPick pick = PickTexel(map, bits0[i] * 0x1p-32, bits1[i] * 0x1p-32);
    StoreTexel(map, pick.texel, i, lanes);
    u[i] = static_cast<float>(pick.u);
    heights[i] = static_cast<float>(pick.one_minus_cos);
    signs[i] = static_cast<float>(pick.sign);
  }
  const V t = hn::Load(d, heights);
  const V sin = hn::Sqrt(hn::Mul(t, hn::Sub(hn::Set(d, 2.0f), t)));
  const SinCosV<V> phi = SinCosTurns(d, hn::Load(d, u));
  return {{hn::Mul(phi.sin, sin), hn::Mul(hn::Load(d, signs), hn::Sub(one, t)),
           hn::Neg(hn::Mul(phi.cos, sin))},
          LoadTexels(d, map, lanes)};
}

}  // namespace nacre::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
