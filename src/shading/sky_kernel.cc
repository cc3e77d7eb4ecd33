// SPDX-License-Identifier: Apache-2.0
// shading/sky_kernel.cc: the radiance of skies along directions, and their irradiance.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "shading/sky_kernel.cc"
#include "hwy/foreach_target.h"

#include "hwy/highway.h"

#include "light/environment-inl.h"
#include "light/sky-inl.h"
#include "shading/area_kernels.h"
#include "shading/soa-inl.h"

HWY_BEFORE_NAMESPACE();
namespace nacre {
namespace HWY_NAMESPACE {
namespace {
namespace hn = hwy::HWY_NAMESPACE;

using D = hn::ScalableTag<float>;
using V = hn::Vec<D>;

// to[i] = of(from[i]) for vectors of three.
template <class Of>
HWY_INLINE void ForEach(const Soa3<float>& from, size_t count, Soa3<float>* to, const Of& of) {
  for (size_t i = 0; i < count; i += hn::Lanes(D()))
    StoreSoa(D(), of(LoadSoa(D(), from, i)), i, to);
}

void NormalizeDirectionsT(const Soa3<double>& directions, size_t count, Soa3<float>* unit) {
  const hn::ScalableTag<double> dd;
  const hn::Rebind<float, decltype(dd)> d;
  for (size_t i = 0; i < count; i += hn::Lanes(dd)) {
    const auto v = Demote3(dd, LoadSoa(dd, directions, i));
    const auto inverse = hn::Div(hn::Set(d, 1.0f), hn::Sqrt(FusedDot(v, v)));
    StoreSoa(d, Scale(v, inverse), i, unit);
  }
}

// v rotated about +y by the angle with this cosine and sine.
HWY_INLINE Vec3V<V> Turn(const Vec3V<V>& v, double cosine, double sine) {
  const D d;
  const V c = hn::Set(d, static_cast<float>(cosine)), s = hn::Set(d, static_cast<float>(sine));
  return {hn::MulAdd(v.x, c, hn::Mul(v.z, s)), v.y, hn::MulSub(v.z, c, hn::Mul(v.x, s))};
}

void EvaluatePicture(const ShadingSky& sky, const Soa3<float>& directions, size_t count,
                     Soa3<float>* radiance, float* pdf) {
  const D d;
  for (size_t i = 0; i < count; i += hn::Lanes(d)) {
    const Vec3V<V> turned = Turn(LoadSoa(D(), directions, i), sky.cos_rotation, -sky.sin_rotation);
    const EnvironmentTexelV<V> texel = TexelAt(d, *sky.picture, turned);
    StoreSoa(D(), {texel.red, texel.green, texel.blue}, i, radiance);
    if (pdf != nullptr) hn::StoreU(texel.pdf, d, pdf + i);
  }
}

void EvaluateSkyT(const SampledLight& light, const Soa3<float>& directions, size_t count,
                  Soa3<float>* radiance, float* pdf) {
  const D d;
  const ShadingSky& sky = light.sky;
  if (light.form == SampledForm::kPictureSky) {
    return EvaluatePicture(sky, directions, count, radiance, pdf);
  }
  if (light.form == SampledForm::kGradientSky) {
    const GradientSkyTerms<float>&r = sky.gradient[0], &g = sky.gradient[1], &b = sky.gradient[2];
    return ForEach(directions, count, radiance, [&](const Vec3V<V>& l) HWY_ATTR {
      return Vec3V<V>{Radiance(d, r, l), Radiance(d, g, l), Radiance(d, b, l)};
    });
  }
  ForEach(directions, count, radiance, [&](const Vec3V<V>& l) HWY_ATTR {
    // Rounding may make the value slightly negative where the quadratic has its root.
    const V value = hn::Max(Radiance(d, sky.quadratic, l), hn::Zero(d));
    return Vec3V<V>{value, value, value};
  });
}

void SampleSkyT(const ShadingSky& sky, const UnitPoints& points, size_t count,
                LightDirections* directions) {
  const D d;
  for (size_t i = 0; i < count; i += hn::Lanes(d)) {
    const EnvironmentSampleV<V> sample =
        SampleEnvironment(d, *sky.picture, points.u_bits.data() + i, points.v_bits.data() + i);
    StoreSoa(D(), Turn(sample.to_light, sky.cos_rotation, sky.sin_rotation), i,
             &directions->to_light);
    StoreSoa(D(), {sample.texel.red, sample.texel.green, sample.texel.blue}, i,
             &directions->radiance);
    hn::StoreU(sample.texel.pdf, d, directions->pdf.data() + i);
  }
}

void SkyIrradianceT(const SampledLight& light, const Surface& surface, size_t count,
                    Soa3<float>* irradiance) {
  const D d;
  const ShadingSky& sky = light.sky;
  if (light.form == SampledForm::kGradientSky) {
    const GradientSkyTerms<float>&r = sky.gradient[0], &g = sky.gradient[1], &b = sky.gradient[2];
    return ForEach(surface.normal, count, irradiance, [&](const Vec3V<V>& n) HWY_ATTR {
      return Vec3V<V>{Irradiance(d, r, n), Irradiance(d, g, n), Irradiance(d, b, n)};
    });
  }
  ForEach(surface.normal, count, irradiance, [&](const Vec3V<V>& n) HWY_ATTR {
    const V value = Irradiance(d, sky.quadratic, n);
    return Vec3V<V>{value, value, value};
  });
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace nacre
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace nacre {
HWY_EXPORT(NormalizeDirectionsT);
HWY_EXPORT(EvaluateSkyT);
HWY_EXPORT(SampleSkyT);
HWY_EXPORT(SkyIrradianceT);

void NormalizeDirections(const Soa3<double>& directions, size_t count, Soa3<float>* unit) {
  HWY_DYNAMIC_DISPATCH(NormalizeDirectionsT)(directions, count, unit);
}

void SampleSky(const SampledLight& light, const UnitPoints& points, size_t count,
               LightDirections* directions) {
  HWY_DYNAMIC_DISPATCH(SampleSkyT)(light.sky, points, count, directions);
}

void EvaluateSky(const SampledLight& light, const Soa3<float>& directions, size_t count,
                 Soa3<float>* radiance, float* pdf) {
  HWY_DYNAMIC_DISPATCH(EvaluateSkyT)(light, directions, count, radiance, pdf);
}

void SkyIrradiance(const SampledLight& light, const Surface& surface, size_t count,
                   Soa3<float>* irradiance) {
  HWY_DYNAMIC_DISPATCH(SkyIrradianceT)(light, surface, count, irradiance);
}
}  // namespace nacre
#endif
