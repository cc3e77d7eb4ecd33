// SPDX-License-Identifier: Apache-2.0
// shading/light_at-inl.h: what a light is at a packet of hits: its direction and its irradiance.
#if defined(NACRE_SHADING_LIGHT_AT_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef NACRE_SHADING_LIGHT_AT_INL_H_
#undef NACRE_SHADING_LIGHT_AT_INL_H_
#else
#define NACRE_SHADING_LIGHT_AT_INL_H_
#endif

#include <algorithm>
#include <cstdint>
#include <limits>

#include "base/geometry-inl.h"
#include "base/target_ops-inl.h"
#include "base/vec3-inl.h"
#include "light/punctual-inl.h"
#include "shading/shade.h"

HWY_BEFORE_NAMESPACE();
namespace nacre {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using FloatTag = ShadeTag<float>;
using FloatV = hn::Vec<FloatTag>;

// The direction l = offset times inverse_length. It is formed only where it is needed as such: n.l
// and l + v take fewer operations and roundings without, in shorter chains.
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

// Where a light is and its irradiance perpendicular to that direction, whichever way the surface
// faces. A light at the hit itself, or farther off than the root of float's range, has no
// irradiance and a direction that means nothing.
struct LightV {
  TowardV toward;
  FloatV irradiance;
};

// Where a positional light lies from hits i... with these normals: three ways to find out. Formed
// in double from the hits' positions and rounded to float: a light close to a far-away or huge
// surface keeps its direction.
class FromPositions {
 public:
  static constexpr bool kApart = false;  // a light may be at the hit itself
  FromPositions(const ShadingLight& light, const HitBatch& hits)
      : x_(hits.position.x.data()),
        y_(hits.position.y.data()),
        z_(hits.position.z.data()),
        light_(light.position) {}

  HWY_INLINE Vec3V<FloatV> At(FloatTag d, size_t i, const Vec3V<FloatV>&) const {
    return {SubtractAndRound(d, light_.x, x_ + i), SubtractAndRound(d, light_.y, y_ + i),
            SubtractAndRound(d, light_.z, z_ + i)};
  }

 private:
  const double* HWY_RESTRICT x_;
  const double* HWY_RESTRICT y_;
  const double* HWY_RESTRICT z_;
  Vec3d light_;
};

HWY_INLINE Vec3V<FloatV> FromCenter(const Vec3V<FloatV>& offset, FloatV radius,
                                    const Vec3V<FloatV>& normal) {
  return {hn::NegMulAdd(radius, normal.x, offset.x), hn::NegMulAdd(radius, normal.y, offset.y),
          hn::NegMulAdd(radius, normal.z, offset.z)};
}

// By ShadingLight::from_spheres, of hits that are all on one sphere.
class FromOneSphere {
 public:
  static constexpr bool kApart = true;
  FromOneSphere(FloatTag d, const ShadingLight& light, const HitBatch& hits) {
    const SphereOffset& from = light.from_spheres[hits.primitive[0]];
    center_ = {hn::Set(d, from.offset.x), hn::Set(d, from.offset.y), hn::Set(d, from.offset.z)};
    radius_ = hn::Set(d, from.radius);
  }

  HWY_INLINE Vec3V<FloatV> At(FloatTag, size_t, const Vec3V<FloatV>& normal) const {
    return FromCenter(center_, radius_, normal);
  }

 private:
  Vec3V<FloatV> center_;
  FloatV radius_;
};

// The same bits, of hits on any spheres.
class FromSpheres {
 public:
  static constexpr bool kApart = true;
  FromSpheres(const ShadingLight& light, const HitBatch& hits)
      : spheres_(light.from_spheres.data()), primitive_(hits.primitive.data()), end_(hits.count) {}

  HWY_INLINE Vec3V<FloatV> At(FloatTag d, size_t i, const Vec3V<FloatV>& normal) const {
    constexpr size_t kMostLanes = 2 * kVectorBytes / sizeof(float);
    alignas(64) float x[kMostLanes], y[kMostLanes], z[kMostLanes], radius[kMostLanes];
    for (size_t lane = 0; lane < hn::Lanes(d); ++lane) {
      const SphereOffset& from = spheres_[primitive_[std::min(i + lane, end_ - 1)]];
      x[lane] = from.offset.x;
      y[lane] = from.offset.y;
      z[lane] = from.offset.z;
      radius[lane] = from.radius;
    }
    return FromCenter({hn::Load(d, x), hn::Load(d, y), hn::Load(d, z)}, hn::Load(d, radius),
                      normal);
  }

 private:
  const SphereOffset* HWY_RESTRICT spheres_;
  const uint32_t* HWY_RESTRICT primitive_;
  size_t end_;
};

// Calls with_offset(way) with the way that suits the hits.
template <class WithOffset>
HWY_INLINE void VisitOffset(FloatTag d, const ShadingLight& light, const HitBatch& hits,
                            const WithOffset& with_offset) {
  if (light.from_spheres.empty()) {
    with_offset(FromPositions(light, hits));
  } else if (hits.one_primitive) {
    with_offset(FromOneSphere(d, light, hits));
  } else {
    with_offset(FromSpheres(light, hits));
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

// 1 / the root of a light's squared distance, 0 for a light at the hit itself; `apart`: none is.
template <bool kApart>
HWY_INLINE FloatV InverseDistance(FloatTag d, FloatV squared) {
  const FloatV inverse = ReciprocalSqrt(d, squared);
  if constexpr (kApart) return inverse;
  return hn::IfThenElseZero(hn::Ge(squared, hn::Set(d, std::numeric_limits<float>::min())),
                            inverse);
}

// An inverse-square light at `offset` from the hits.
template <bool kApart>
HWY_INLINE LightV InverseSquareAt(FloatTag d, const Vec3V<FloatV>& offset) {
  const FloatV inverse = InverseDistance<kApart>(d, FusedDot(offset, offset));
  return {{offset, inverse}, hn::Mul(inverse, inverse)};
}

// Of a light of any positional form at `offset` from the hits; of a spot without its cone.
template <LightForm kForm>
HWY_INLINE LightV PositionalAt(FloatTag d, const ShadingLight& light, const Vec3V<FloatV>& offset) {
  if constexpr (kForm == LightForm::kInverseSquare) {
    return InverseSquareAt<false>(d, offset);
  } else {
    const FloatV squared = FusedDot(offset, offset);
    const auto apart = hn::Ge(squared, hn::Set(d, std::numeric_limits<float>::min()));
    const FloatV inverse = hn::IfThenElseZero(apart, ReciprocalSqrt(d, squared));
    const FloatV distance = hn::IfThenElseZero(apart, hn::Mul(squared, inverse));
    return {{offset, inverse}, AttenuationFactor(d, light.attenuation, distance)};
  }
}

// A spot's factor at hits i... Their angles are formed in double, from double positions: the factor
// falls to 0 at the cutoff, where it cancels in float, and cones may be narrow.
HWY_INLINE FloatV SpotFactorAt(FloatTag d, const ShadingLight& light, const HitBatch& hits,
                               size_t i) {
  const hn::ScalableTag<double> dd;
  const hn::Rebind<float, decltype(dd)> half;
  constexpr size_t kMostLanes = 2 * kVectorBytes / sizeof(float);
  alignas(64) float t[kMostLanes], one_minus_cos[kMostLanes], cosine[kMostLanes];
  const auto one = hn::Set(dd, 1.0);
  const auto place = SetVec3(dd, light.position), axis = SetVec3(dd, light.axis);
  for (size_t lane = 0; lane < hn::Lanes(d); lane += hn::Lanes(dd)) {
    const size_t k = i + lane;
    const auto away = Sub(LoadU3(dd, hits.position.x.data() + k, hits.position.y.data() + k,
                                 hits.position.z.data() + k),
                          place);
    const auto squared = FusedDot(away, away);
    const auto apart = hn::Gt(squared, hn::Zero(dd));  // else there is no direction, and no light
    const auto inverse = hn::Div(one, hn::Sqrt(hn::IfThenElse(apart, squared, one)));
    const auto off_axis = Sub(Scale(away, inverse), axis);
    const auto angle = hn::Mul(FusedDot(off_axis, off_axis), hn::Set(dd, 0.5));
    hn::Store(hn::DemoteTo(half, PenumbraParameter(dd, light.cone, angle)), half, t + lane);
    hn::Store(hn::DemoteTo(half, angle), half, one_minus_cos + lane);
    hn::Store(hn::DemoteTo(half, hn::Sub(one, angle)), half, cosine + lane);
  }
  return SpotFactor(d, light.cone, hn::Load(d, t), hn::Load(d, one_minus_cos), hn::Load(d, cosine));
}

// PositionalAt<kInverseSquare> with what all packets share in registers.
template <class Offset>
class PointLightV {
 public:
  explicit PointLightV(const Offset& offset) : offset_(offset) {}

  HWY_INLINE LightV At(FloatTag d, size_t i, const Vec3V<FloatV>& normal) const {
    return InverseSquareAt<Offset::kApart>(d, offset_.At(d, i, normal));
  }

 private:
  Offset offset_;
};

// The light of a batch's hits i..., evaluated before or, in its two most frequent forms, here.
// Vectors, not structs, are what the branches choose: GCC takes a struct that they choose through
// memory.
HWY_INLINE LightV LightAt(FloatTag d, const LightOnBatch& light, const HitBatch& hits, size_t i,
                          const Vec3V<FloatV>& normal) {
  FloatV x, y, z, inverse_length, irradiance;
  if (light.evaluated != nullptr) {
    const Soa3<float>& l = light.evaluated->to_light;
    x = hn::LoadU(d, l.x.data() + i);
    y = hn::LoadU(d, l.y.data() + i);
    z = hn::LoadU(d, l.z.data() + i);
    inverse_length = light.light->form == LightForm::kGiven
                         ? hn::Set(d, 1.0f)
                         : hn::LoadU(d, light.evaluated->inverse_length.data() + i);
    irradiance = hn::LoadU(d, light.evaluated->irradiance.data() + i);
  } else if (light.light->form == LightForm::kDirectional) {
    const LightV at = DirectionalAt(d, *light.light);
    x = at.toward.offset.x;
    y = at.toward.offset.y;
    z = at.toward.offset.z;
    inverse_length = at.toward.inverse_length;
    irradiance = at.irradiance;
  } else {
    const Vec3V<FloatV> offset = light.light->from_spheres.empty()
                                     ? FromPositions(*light.light, hits).At(d, i, normal)
                                     : FromSpheres(*light.light, hits).At(d, i, normal);
    const LightV at = PositionalAt<LightForm::kInverseSquare>(d, *light.light, offset);
    x = at.toward.offset.x;
    y = at.toward.offset.y;
    z = at.toward.offset.z;
    inverse_length = at.toward.inverse_length;
    irradiance = at.irradiance;
  }
  return {{{x, y, z}, inverse_length}, irradiance};
}

}  // namespace HWY_NAMESPACE
}  // namespace nacre
HWY_AFTER_NAMESPACE();
#endif
