// shading/sky_kernel.cc: what skies show along directions, and their irradiance.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "shading/sky_kernel.cc"
#include "hwy/foreach_target.h"

#include "hwy/highway.h"

#include "base/trig-inl.h"
#include "base/vec3-inl.h"
#include "shading/area_kernels.h"

HWY_BEFORE_NAMESPACE();
namespace nacre {
namespace HWY_NAMESPACE {
namespace {
namespace hn = hwy::HWY_NAMESPACE;

using D = hn::ScalableTag<float>;
using V = hn::Vec<D>;

HWY_INLINE V Set(double value) { return hn::Set(D(), static_cast<float>(value)); }

HWY_INLINE Vec3V<V> Set3(const Vec3f& v) { return {Set(v.x), Set(v.y), Set(v.z)}; }

HWY_INLINE Vec3V<V> Load(const Soa3<float>& soa, size_t i) {
  return LoadU3(D(), soa.x.data() + i, soa.y.data() + i, soa.z.data() + i);
}

HWY_INLINE void Store(const Vec3V<V>& v, size_t i, Soa3<float>* to) {
  const D d;
  hn::StoreU(v.x, d, to->x.data() + i);
  hn::StoreU(v.y, d, to->y.data() + i);
  hn::StoreU(v.z, d, to->z.data() + i);
}

// horizon + (zenith - horizon) up + (ground - horizon) down.
HWY_INLINE Vec3V<V> Mix(const ShadingSky& sky, V horizon, V up, V down) {
  const Vec3V<V> low = Set3(sky.horizon);
  const Vec3V<V> to_zenith = Sub(Set3(sky.zenith), low), to_ground = Sub(Set3(sky.ground), low);
  return Add(Scale(low, horizon), Add(Scale(to_zenith, up), Scale(to_ground, down)));
}

void EvaluateGradientT(const ShadingSky& sky, const Soa3<float>& directions, size_t count,
                       Soa3<float>* radiance) {
  const D d;
  const V zero = hn::Zero(d), one = hn::Set(d, 1.0f);
  for (size_t i = 0; i < count; i += hn::Lanes(d)) {
    const V y = hn::Min(hn::Max(hn::LoadU(d, directions.y.data() + i), hn::Neg(one)), one);
    Store(Mix(sky, one, hn::Max(y, zero), hn::Max(hn::Neg(y), zero)), i, radiance);
  }
}

void EvaluateQuadraticT(const ShadingSky& sky, const Soa3<float>& directions, size_t count,
                        Soa3<float>* radiance) {
  const D d;
  for (size_t i = 0; i < count; i += hn::Lanes(d)) {
    const V c = FusedDot(Set3(sky.axis), Load(directions, i));
    const V slope = hn::MulAdd(c, Set(sky.quadratic), Set(sky.linear));
    // Rounding may leave a touch less than 0 where the quadratic has its root.
    const V value = hn::Max(hn::MulAdd(slope, c, Set(sky.constant)), hn::Zero(d));
    Store({value, value, value}, i, radiance);
  }
}

// The integral of max(y, 0) n.l over the hemisphere about n, y the height of l: of the cosine c
// between n and +y, 2/3 (sin + (pi - angle) cos).
HWY_INLINE V UpperIrradiance(V c) {
  const D d;
  const V one = hn::Set(d, 1.0f);
  const V sin = hn::Sqrt(hn::Max(hn::Mul(hn::Sub(one, c), hn::Add(one, c)), hn::Zero(d)));
  const V supplement = Atan2Upper(d, sin, hn::Neg(c));
  return hn::Mul(Set(2.0 / 3), hn::MulAdd(supplement, c, sin));
}

void GradientIrradianceT(const ShadingSky& sky, const Surface& surface, size_t count,
                         Soa3<float>* irradiance) {
  const D d;
  const V one = hn::Set(d, 1.0f);
  for (size_t i = 0; i < count; i += hn::Lanes(d)) {
    const V c = hn::Min(hn::Max(hn::LoadU(d, surface.normal.y.data() + i), hn::Neg(one)), one);
    Store(Mix(sky, Set(M_PI), UpperIrradiance(c), UpperIrradiance(hn::Neg(c))), i, irradiance);
  }
}

// Ramamoorthi and Hanrahan 2001: the cosine's weights pi, 2 pi/3 and pi/4 of degrees 0 to 2.
void QuadraticIrradianceT(const ShadingSky& sky, const Surface& surface, size_t count,
                          Soa3<float>* irradiance) {
  const D d;
  const V even = Set(M_PI * (sky.constant + sky.quadratic / 4.0));
  for (size_t i = 0; i < count; i += hn::Lanes(d)) {
    const V c = FusedDot(Set3(sky.axis), Load(surface.normal, i));
    const V slope = hn::MulAdd(c, Set(M_PI / 4 * sky.quadratic), Set(2 * M_PI / 3 * sky.linear));
    const V value = hn::MulAdd(slope, c, even);
    Store({value, value, value}, i, irradiance);
  }
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace nacre
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace nacre {
HWY_EXPORT(EvaluateGradientT);
HWY_EXPORT(EvaluateQuadraticT);
HWY_EXPORT(GradientIrradianceT);
HWY_EXPORT(QuadraticIrradianceT);

void EvaluateSky(const SampledLight& light, const Soa3<float>& directions, size_t count,
                 Soa3<float>* radiance) {
  if (light.form == SampledForm::kGradientSky) {
    return HWY_DYNAMIC_DISPATCH(EvaluateGradientT)(light.sky, directions, count, radiance);
  }
  HWY_DYNAMIC_DISPATCH(EvaluateQuadraticT)(light.sky, directions, count, radiance);
}

void SkyIrradiance(const SampledLight& light, const Surface& surface, size_t count,
                   Soa3<float>* irradiance) {
  if (light.form == SampledForm::kGradientSky) {
    return HWY_DYNAMIC_DISPATCH(GradientIrradianceT)(light.sky, surface, count, irradiance);
  }
  HWY_DYNAMIC_DISPATCH(QuadraticIrradianceT)(light.sky, surface, count, irradiance);
}
}  // namespace nacre
#endif
