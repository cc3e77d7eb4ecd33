// SPDX-License-Identifier: Apache-2.0
// shading/light_at-inl.h: what a light is at a packet of hits: its direction and its irradiance.
#if defined(NACRE_SHADING_LIGHT_AT_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef NACRE_SHADING_LIGHT_AT_INL_H_
#undef NACRE_SHADING_LIGHT_AT_INL_H_
#else
#define NACRE_SHADING_LIGHT_AT_INL_H_
#endif

#include <limits>

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

// Direction and irradiance perpendicular to it, whichever way the surface faces. A light at the
// hit itself, or farther off than the root of float's range, has no irradiance and a direction
// that means nothing.
struct LightV {
  Vec3V<FloatV> to_light;
  FloatV irradiance;
};

// light - position[i...], formed in double, rounded to float: a light close to a far-away or huge
// surface keeps its direction.
HWY_INLINE FloatV OffsetFrom(FloatTag d, const double* HWY_RESTRICT position, size_t i,
                             double light) {
  return SubtractAndRound(d, light, position + i);
}

HWY_INLINE LightV DirectionalAt(FloatTag d, const ShadingLight& light) {
  const auto component = [&](double value)
                             HWY_ATTR { return hn::Set(d, static_cast<float>(value)); };
  return {{component(light.to_light.x), component(light.to_light.y), component(light.to_light.z)},
          hn::Set(d, 1.0f)};
}

// Direction and irradiance of an inverse-square light at `offset` from the hits.
HWY_INLINE LightV InverseSquareAt(FloatTag d, const Vec3V<FloatV>& offset, FloatV scale) {
  const FloatV squared = FusedDot(offset, offset);
  const auto apart = hn::Ge(squared, hn::Set(d, std::numeric_limits<float>::min()));
  const FloatV inverse = hn::IfThenElseZero(apart, ReciprocalSqrt(d, squared));
  return {Scale(offset, inverse), hn::Mul(hn::Mul(inverse, inverse), scale)};
}

template <LightForm kForm>
HWY_INLINE LightV PositionalAt(FloatTag d, const ShadingLight& light, const Soa3<double>& position,
                               size_t i) {
  const Vec3V<FloatV> offset{OffsetFrom(d, position.x.data(), i, light.position.x),
                             OffsetFrom(d, position.y.data(), i, light.position.y),
                             OffsetFrom(d, position.z.data(), i, light.position.z)};
  if constexpr (kForm == LightForm::kInverseSquare) {
    return InverseSquareAt(d, offset, hn::Set(d, light.inverse_quadratic));
  } else {
    const FloatV squared = FusedDot(offset, offset);
    const auto apart = hn::Ge(squared, hn::Set(d, std::numeric_limits<float>::min()));
    const FloatV inverse = hn::IfThenElseZero(apart, ReciprocalSqrt(d, squared));
    const Vec3V<FloatV> to_light = Scale(offset, inverse);
    const FloatV distance = hn::IfThenElseZero(apart, hn::Mul(squared, inverse));
    FloatV irradiance = AttenuationFactor(d, light.attenuation, distance);
    if constexpr (kForm == LightForm::kSpot) {
      const Vec3V<FloatV> axis{hn::Set(d, light.axis.x), hn::Set(d, light.axis.y),
                               hn::Set(d, light.axis.z)};
      const FloatV cos_angle = hn::Neg(FusedDot(axis, to_light));
      irradiance = hn::Mul(irradiance, SpotFactor(d, light.cone, cos_angle));
    }
    return {to_light, irradiance};
  }
}

// PositionalAt<kInverseSquare> with what all packets share in registers.
class PointLightV {
 public:
  PointLightV(FloatTag d, const ShadingLight& light, const Soa3<double>& position)
      : x_(position.x.data()),
        y_(position.y.data()),
        z_(position.z.data()),
        from_(light.position),
        scale_(hn::Set(d, light.inverse_quadratic)) {}

  HWY_INLINE LightV At(FloatTag d, size_t i) const {
    const Vec3V<FloatV> offset{OffsetFrom(d, x_, i, from_.x), OffsetFrom(d, y_, i, from_.y),
                               OffsetFrom(d, z_, i, from_.z)};
    return InverseSquareAt(d, offset, scale_);
  }

 private:
  const double* HWY_RESTRICT x_;
  const double* HWY_RESTRICT y_;
  const double* HWY_RESTRICT z_;
  Vec3d from_;
  FloatV scale_;
};

// The light of a batch's hits i..., evaluated before or, in its two most frequent forms, here.
// Vectors, not structs, are what the branches choose: GCC takes a struct that they choose through
// memory.
HWY_INLINE LightV LightAt(FloatTag d, const LightOnBatch& light, const HitBatch& hits, size_t i) {
  FloatV x, y, z, irradiance;
  if (light.evaluated != nullptr) {
    const Soa3<float>& l = light.evaluated->to_light;
    x = hn::LoadU(d, l.x.data() + i);
    y = hn::LoadU(d, l.y.data() + i);
    z = hn::LoadU(d, l.z.data() + i);
    irradiance = hn::LoadU(d, light.evaluated->irradiance.data() + i);
  } else if (light.light->form == LightForm::kDirectional) {
    const LightV at = DirectionalAt(d, *light.light);
    x = at.to_light.x;
    y = at.to_light.y;
    z = at.to_light.z;
    irradiance = at.irradiance;
  } else {
    const LightV at = PositionalAt<LightForm::kInverseSquare>(d, *light.light, hits.position, i);
    x = at.to_light.x;
    y = at.to_light.y;
    z = at.to_light.z;
    irradiance = at.irradiance;
  }
  return {{x, y, z}, irradiance};
}

}  // namespace HWY_NAMESPACE
}  // namespace nacre
HWY_AFTER_NAMESPACE();
#endif
