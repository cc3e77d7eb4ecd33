// SPDX-License-Identifier: Apache-2.0
// shading/light_at-inl.h: direction and irradiance of a punctual light at a packet of hits.
#if defined(NACRE_SHADING_LIGHT_AT_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef NACRE_SHADING_LIGHT_AT_INL_H_
#undef NACRE_SHADING_LIGHT_AT_INL_H_
#else
#define NACRE_SHADING_LIGHT_AT_INL_H_
#endif

#include <algorithm>
#include <limits>

#include "base/target_ops-inl.h"
#include "base/vec3-inl.h"
#include "light/punctual-inl.h"
#include "shading/light.h"
#include "shading/surface.h"

HWY_BEFORE_NAMESPACE();
namespace nacre {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using FloatTag = hn::ScalableTag<float>;
using FloatV = hn::Vec<FloatTag>;

// The direction l = offset times inverse_length. It is computed only where it is needed as such:
// n.l and l + v take fewer operations and roundings without it, in shorter dependency chains.
struct TowardV {
  Vec3V<FloatV> offset;
  FloatV inverse_length;

  HWY_INLINE FloatV Dot(const Vec3V<FloatV>& v) const {
    return hn::Mul(FusedDot(v, offset), inverse_length);
  }
  HWY_INLINE Vec3V<FloatV> Plus(const Vec3V<FloatV>& v) const {
    return MulAdd3(offset, inverse_length, v);
  }
  HWY_INLINE Vec3V<FloatV> Minus(const Vec3V<FloatV>& v) const {
    return MulSub3(offset, inverse_length, v);
  }
  HWY_INLINE Vec3V<FloatV> Direction() const { return Scale(offset, inverse_length); }
};

// The direction to a light, and its irradiance perpendicular to that direction, whichever way the
// surface faces. A light at the hit itself, or farther away than the square root of float's range,
// has an irradiance of 0 and a meaningless direction.
struct LightV {
  TowardV toward;
  FloatV irradiance;
};

// The offset from hits i... to a positional light, from the hits' positions. It is computed in
// double and rounded to float: a light close to a far-away or huge surface keeps its direction.
HWY_INLINE Vec3V<FloatV> OffsetByPosition(FloatTag d, const ShadingLight& light,
                                          const HitBatch& hits, size_t i) {
  return {SubtractAndRound(d, light.position.x, hits.position.x.data() + i),
          SubtractAndRound(d, light.position.y, hits.position.y.data() + i),
          SubtractAndRound(d, light.position.z, hits.position.z.data() + i)};
}

// The offset from hits to a positional light, from the hits' normals, for hits on spheres that are
// far from the light (ShadingLight::from_spheres). `center` is the offset from the spheres' centres
// to the light.
HWY_INLINE Vec3V<FloatV> OffsetByNormal(const Vec3V<FloatV>& center, FloatV radius,
                                        const Vec3V<FloatV>& normal) {
  return {hn::NegMulAdd(radius, normal.x, center.x), hn::NegMulAdd(radius, normal.y, center.y),
          hn::NegMulAdd(radius, normal.z, center.z)};
}

// OffsetByNormal for hits that are all on the same sphere.
HWY_INLINE auto OffsetsFromSphere(FloatTag d, const ShadingLight& light, const HitBatch& hits) {
  const SphereOffset& from = light.from_spheres[hits.primitive[0]];
  const Vec3V<FloatV> center{hn::Set(d, from.offset.x), hn::Set(d, from.offset.y),
                             hn::Set(d, from.offset.z)};
  const FloatV radius = hn::Set(d, from.radius);
  return [center, radius](FloatTag, size_t, const Vec3V<FloatV>& normal)
             HWY_ATTR { return OffsetByNormal(center, radius, normal); };
}

// OffsetByNormal for hits on any spheres, with the same bits.
HWY_INLINE auto OffsetsFromSpheres(const ShadingLight& light, const HitBatch& hits) {
  return [&](FloatTag d, size_t i, const Vec3V<FloatV>& normal) HWY_ATTR {
    constexpr size_t kMostLanes = kVectorBytes / sizeof(float);
    alignas(64) float x[kMostLanes], y[kMostLanes], z[kMostLanes], radius[kMostLanes];
    for (size_t lane = 0; lane < hn::Lanes(d); ++lane) {
      const size_t hit = std::min(i + lane, hits.count - 1);
      const SphereOffset& from = light.from_spheres[hits.primitive[hit]];
      x[lane] = from.offset.x;
      y[lane] = from.offset.y;
      z[lane] = from.offset.z;
      radius[lane] = from.radius;
    }
    const Vec3V<FloatV> center{hn::Load(d, x), hn::Load(d, y), hn::Load(d, z)};
    return OffsetByNormal(center, hn::Load(d, radius), normal);
  };
}

// Calls use(offset), where offset(d, i, normal) is the offset from hits i... to a positional light,
// in the form that suits the batch, so that constants that its hits share stay in registers.
template <class Use>
HWY_INLINE void VisitOffsets(FloatTag d, const ShadingLight& light, const HitBatch& hits,
                             const Use& use) {
  if (light.from_spheres.empty()) {
    use([&](FloatTag tag, size_t i, const Vec3V<FloatV>&)
            HWY_ATTR { return OffsetByPosition(tag, light, hits, i); });
  } else if (hits.one_primitive) {
    use(OffsetsFromSphere(d, light, hits));
  } else {
    use(OffsetsFromSpheres(light, hits));
  }
}

HWY_INLINE LightV DirectionalAt(FloatTag d, const ShadingLight& light) {
  const auto component = [&](double value)
                             HWY_ATTR { return hn::Set(d, static_cast<float>(value)); };
  const FloatV one = hn::Set(d, 1.0f);
  return {{{component(light.to_light.x), component(light.to_light.y), component(light.to_light.z)},
           one},
          one};
}

// A light of any positional form at `offset` from the hits. For a spot light the cone is left out.
template <LightForm kForm>
HWY_INLINE LightV PositionalAt(FloatTag d, const ShadingLight& light, const Vec3V<FloatV>& offset) {
  const FloatV squared = FusedDot(offset, offset);
  const auto apart = hn::Ge(squared, hn::Set(d, std::numeric_limits<float>::min()));
  const FloatV inverse = hn::IfThenElseZero(apart, ReciprocalSqrt(d, squared));
  if constexpr (kForm == LightForm::kInverseSquare) {
    return {{offset, inverse}, hn::Mul(inverse, inverse)};
  } else {
    const FloatV distance = hn::IfThenElseZero(apart, hn::Mul(squared, inverse));
    return {{offset, inverse}, AttenuationFactor(d, light.attenuation, distance)};
  }
}

// A spot light's factor at hits i... The angles are computed in double, from double positions: the
// factor falls to 0 at the cutoff, where it cancels in float, and cones may be narrow.
HWY_INLINE FloatV SpotFactorAt(FloatTag d, const ShadingLight& light, const HitBatch& hits,
                               size_t i) {
  const hn::ScalableTag<double> dd;
  const hn::Rebind<float, decltype(dd)> half;
  constexpr size_t kMostLanes = kVectorBytes / sizeof(float);
  alignas(64) float t[kMostLanes], one_minus_cos[kMostLanes], cosine[kMostLanes];
  const auto one = hn::Set(dd, 1.0);
  const auto place = SetVec3(dd, light.position), axis = SetVec3(dd, light.axis);
  for (size_t lane = 0; lane < hn::Lanes(d); lane += hn::Lanes(dd)) {
    const size_t k = i + lane;
    const auto away = Sub(LoadU3(dd, hits.position.x.data() + k, hits.position.y.data() + k,
                                 hits.position.z.data() + k),
                          place);
    const auto squared = FusedDot(away, away);
    const auto apart = hn::Gt(squared, hn::Zero(dd));  // else there is no direction
    const auto inverse = hn::Div(one, hn::Sqrt(hn::IfThenElse(apart, squared, one)));
    const auto off_axis = Sub(Scale(away, inverse), axis);
    const auto angle = hn::Mul(FusedDot(off_axis, off_axis), hn::Set(dd, 0.5));
    hn::Store(hn::DemoteTo(half, PenumbraParameter(dd, light.cone, angle)), half, t + lane);
    hn::Store(hn::DemoteTo(half, angle), half, one_minus_cos + lane);
    hn::Store(hn::DemoteTo(half, hn::Sub(one, angle)), half, cosine + lane);
  }
  return SpotFactor(d, light.cone, hn::Load(d, t), hn::Load(d, one_minus_cos), hn::Load(d, cosine));
}

}  // namespace HWY_NAMESPACE
}  // namespace nacre
HWY_AFTER_NAMESPACE();
#endif
