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

using FloatTag = hn::ScalableTag<float>;
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
  const hn::ScalableTag<double> dd;
  const auto from = hn::Set(dd, light);
  return RoundPair(d, hn::Sub(from, hn::LoadU(dd, position + i)),
                   hn::Sub(from, hn::LoadU(dd, position + i + hn::Lanes(dd))));
}

HWY_INLINE LightV DirectionalAt(FloatTag d, const ShadingLight& light) {
  const auto component = [&](double value)
                             HWY_ATTR { return hn::Set(d, static_cast<float>(value)); };
  return {{component(light.to_light.x), component(light.to_light.y), component(light.to_light.z)},
          hn::Set(d, 1.0f)};
}

template <LightForm kForm>
HWY_INLINE LightV PositionalAt(FloatTag d, const ShadingLight& light, const Soa3<double>& position,
                               size_t i) {
  const Vec3V<FloatV> offset{OffsetFrom(d, position.x.data(), i, light.position.x),
                             OffsetFrom(d, position.y.data(), i, light.position.y),
                             OffsetFrom(d, position.z.data(), i, light.position.z)};
  const FloatV squared = FusedDot(offset, offset);
  const auto apart = hn::Ge(squared, hn::Set(d, std::numeric_limits<float>::min()));
  const FloatV inverse = hn::IfThenElseZero(apart, ReciprocalSqrt(d, squared));
  const Vec3V<FloatV> to_light = Scale(offset, inverse);
  if constexpr (kForm == LightForm::kInverseSquare) {
    const FloatV falloff = hn::Mul(inverse, inverse);
    return {to_light, hn::Mul(falloff, hn::Set(d, light.inverse_quadratic))};
  } else {
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
