// shading/light_kernel.cc: direction and irradiance of punctual lights at the hits of a batch,
// and the rounding of the hits' directions to float.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "shading/light_kernel.cc"
#include "hwy/foreach_target.h"

#include <algorithm>

#include "hwy/highway.h"

#include "light/punctual-inl.h"
#include "shading/range-inl.h"

HWY_BEFORE_NAMESPACE();
namespace nacre {
namespace HWY_NAMESPACE {

using DoubleTag = hn::ScalableTag<double>;
using DoubleV = hn::Vec<DoubleTag>;
using HalfFloatTag = hn::Rebind<float, DoubleTag>;  // as many floats as a vector has doubles

// to[i] = from[i] for the batch's padded length.
void RoundToFloat(const AlignedArray<double>& from, size_t count, AlignedArray<float>* to) {
  const DoubleTag dd;
  const HalfFloatTag df;
  for (size_t i = 0; i < count; i += hn::Lanes(dd)) {
    hn::StoreU(hn::DemoteTo(df, hn::LoadU(dd, from.data() + i)), df, to->data() + i);
  }
}

void RoundToFloat3(const Soa3<double>& from, size_t count, Soa3<float>* to) {
  RoundToFloat(from.x, count, &to->x);
  RoundToFloat(from.y, count, &to->y);
  RoundToFloat(from.z, count, &to->z);
}

void PrepareSurfaceT(const HitBatch& hits, Surface* surface) {
  RoundToFloat3(hits.normal, hits.count, &surface->normal);
  RoundToFloat3(hits.to_view, hits.count, &surface->to_view);
}

// offset[i] = light - position[i], and the same rounded to float: the difference is formed in
// double, so a light close to a far-away or huge surface keeps its direction.
void SubtractFrom(double light, const AlignedArray<double>& position, size_t count,
                  AlignedArray<double>* offset, AlignedArray<float>* rounded) {
  const DoubleTag dd;
  const HalfFloatTag df;
  const DoubleV from = hn::Set(dd, light);
  for (size_t i = 0; i < count; i += hn::Lanes(dd)) {
    const DoubleV difference = hn::Sub(from, hn::LoadU(dd, position.data() + i));
    hn::StoreU(difference, dd, offset->data() + i);
    hn::StoreU(hn::DemoteTo(df, difference), df, rounded->data() + i);
  }
}

// The irradiance counts only where the surface faces the light.
HWY_INLINE FloatV FacingOnly(FloatTag d, const Surface& surface, const Vec3V<FloatV>& to_light,
                             size_t i, FloatV irradiance) {
  const Soa3<float>& n = surface.normal;
  const FloatV n_dot_l =
      FusedDot(LoadU3(d, n.x.data() + i, n.y.data() + i, n.z.data() + i), to_light);
  return hn::IfThenElseZero(hn::Gt(n_dot_l, hn::Zero(d)), irradiance);
}

void EvaluateDirectional(const LightUniforms& light, const HitBatch& hits, const Surface& surface,
                         LightBatch* result) {
  const FloatTag d;
  std::fill_n(result->offset.x.data(), hits.count, light.to_light[0]);
  std::fill_n(result->offset.y.data(), hits.count, light.to_light[1]);
  std::fill_n(result->offset.z.data(), hits.count, light.to_light[2]);
  const auto rounded = [&](int c)
                           HWY_ATTR { return hn::Set(d, static_cast<float>(light.to_light[c])); };
  const Vec3V<FloatV> to_light{rounded(0), rounded(1), rounded(2)};
  const FloatV one = hn::Set(d, 1.0f);
  for (size_t i = 0; i < hits.count; i += hn::Lanes(d)) {
    hn::Store(to_light.x, d, result->to_light.x.data() + i);
    hn::Store(to_light.y, d, result->to_light.y.data() + i);
    hn::Store(to_light.z, d, result->to_light.z.data() + i);
    hn::Store(FacingOnly(d, surface, to_light, i, one), d, result->irradiance.data() + i);
  }
}

template <bool kSpot>
void EvaluatePositional(const LightUniforms& light, const HitBatch& hits, const Surface& surface,
                        LightBatch* result) {
  const FloatTag d;
  Soa3<float>& l = result->to_light;
  SubtractFrom(light.position[0], hits.position.x, hits.count, &result->offset.x, &l.x);
  SubtractFrom(light.position[1], hits.position.y, hits.count, &result->offset.y, &l.y);
  SubtractFrom(light.position[2], hits.position.z, hits.count, &result->offset.z, &l.z);
  const FloatV one = hn::Set(d, 1.0f);
  const FloatV zero = hn::Zero(d);
  const Vec3V<FloatV> axis{hn::Set(d, light.axis[0]), hn::Set(d, light.axis[1]),
                           hn::Set(d, light.axis[2])};
  for (size_t i = 0; i < hits.count; i += hn::Lanes(d)) {
    const Vec3V<FloatV> offset = LoadU3(d, l.x.data() + i, l.y.data() + i, l.z.data() + i);
    const FloatV distance = hn::Sqrt(FusedDot(offset, offset));
    // A light exactly at the hit has no direction; its attenuation is 0 there.
    const FloatV scale = hn::Div(one, hn::IfThenElse(hn::Gt(distance, zero), distance, one));
    const Vec3V<FloatV> to_light = Scale(offset, scale);
    FloatV irradiance = AttenuationFactor(d, light.attenuation, distance);
    if constexpr (kSpot) {
      const FloatV cos_angle = hn::Neg(FusedDot(axis, to_light));
      irradiance = hn::Mul(irradiance, SpotFactor(d, light.cone, cos_angle));
    }
    hn::Store(to_light.x, d, l.x.data() + i);
    hn::Store(to_light.y, d, l.y.data() + i);
    hn::Store(to_light.z, d, l.z.data() + i);
    hn::Store(FacingOnly(d, surface, to_light, i, irradiance), d, result->irradiance.data() + i);
  }
}

void EvaluateLightKernelT(const LightUniforms& light, const HitBatch& hits, const Surface& surface,
                          LightBatch* result) {
  switch (light.kind) {
    case LightUniforms::Kind::kDirectional:
      return EvaluateDirectional(light, hits, surface, result);
    case LightUniforms::Kind::kPoint:
      return EvaluatePositional<false>(light, hits, surface, result);
    case LightUniforms::Kind::kSpot:
      return EvaluatePositional<true>(light, hits, surface, result);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace nacre
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace nacre {
HWY_EXPORT(PrepareSurfaceT);
HWY_EXPORT(EvaluateLightKernelT);

void PrepareSurface(const HitBatch& hits, Surface* surface) {
  HWY_DYNAMIC_DISPATCH(PrepareSurfaceT)(hits, surface);
}

void EvaluateLightKernel(const LightUniforms& light, const HitBatch& hits, const Surface& surface,
                         LightBatch* result) {
  HWY_DYNAMIC_DISPATCH(EvaluateLightKernelT)(light, hits, surface, result);
}
}  // namespace nacre
#endif
