// SPDX-License-Identifier: Apache-2.0
// shading/measured_kernel.cc: measured BRDFs: reflection, samples and pdfs of hits.
#include "shading/lobe_width.h"
#include "shading/measured_model.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "shading/measured_kernel.cc"
#include "hwy/foreach_target.h"

#include "hwy/highway.h"

#include "brdf/measured-inl.h"
#include "shading/packets-inl.h"

HWY_BEFORE_NAMESPACE();
namespace nacre {
namespace HWY_NAMESPACE {
namespace {

// Tangents are those of the surface; isotropic BRDFs do not read them.
HWY_INLINE Vec3V<FloatV> TangentAt(FloatTag d, const MeasuredBrdf& brdf, const Surface& surface,
                                   size_t i) {
  return brdf.isotropic ? LoadSoa(d, surface.normal, i) : LoadSoa(d, surface.tangent, i);
}

struct MeasuredHits {
  using Incident = IncidentV;
  const MeasuredBrdf& brdf;
  const MeasuredInterpolation interpolation;
  const Surface& surface;
  float color[3];

  HWY_INLINE ReflectedV Reflect(FloatTag d, const PacketV& p, const IncidentV& in) const {
    const FloatV zero = hn::Zero(d);
    const RgbV value =
        EvaluateMeasured(d, brdf, interpolation, p.normal, TangentAt(d, brdf, surface, p.i),
                         in.toward.Direction(), p.to_view);
    const RgbV light = Scale(SetRgb(d, color), in.irradiance);
    return {{ScaledPart(RgbV{zero, zero, zero}, zero)}, {value, light}};
  }
};

void ShadeMeasuredT(const MeasuredModel& model, const LitHits& lit) {
  MeasuredHits hits{*model.brdf, model.interpolation, lit.surface, {}};
  for (int c = 0; c < 3; ++c) hits.color[c] = static_cast<float>(lit.light.color[c]);
  ShadePackets(FloatTag(), hits, lit);
}

void SampleMeasuredT(const MeasuredModel& model, const MaterialHits& at, const float* u,
                     const float* v, Soa3<float>* to_light) {
  const FloatTag d;
  for (size_t i = at.begin; i < at.end; i += hn::Lanes(d)) {
    const Vec3V<FloatV> sample = SampleMeasured(
        d, *model.brdf, LoadSoa(d, at.surface.normal, i), TangentAt(d, *model.brdf, at.surface, i),
        LoadSoa(d, at.surface.to_view, i), hn::LoadU(d, u + i), hn::LoadU(d, v + i));
    BlendedStoreSoa(d, sample, hn::FirstN(d, at.end - i), i, to_light);
  }
}

void MeasuredPdfT(const MeasuredModel& model, const MaterialHits& at, const LightBatch& light,
                  float* pdf) {
  const FloatTag d;
  for (size_t i = at.begin; i < at.end; i += hn::Lanes(d)) {
    const FloatV value = MeasuredPdf(
        d, *model.brdf, LoadSoa(d, at.surface.normal, i), TangentAt(d, *model.brdf, at.surface, i),
        LoadSoa(d, at.surface.to_view, i), LoadSoa(d, light.light_vector, i));
    hn::BlendedStore(value, hn::FirstN(d, at.end - i), d, pdf + i);
  }
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace nacre
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace nacre {
HWY_EXPORT(ShadeMeasuredT);
HWY_EXPORT(SampleMeasuredT);
HWY_EXPORT(MeasuredPdfT);

void ShadeMeasured(const MeasuredModel& model, const LitHits& lit) {
  HWY_DYNAMIC_DISPATCH(ShadeMeasuredT)(model, lit);
}

void SampleMeasured(const MeasuredModel& model, const MaterialHits& at, const float* u,
                    const float* v, Soa3<float>* to_light) {
  HWY_DYNAMIC_DISPATCH(SampleMeasuredT)(model, at, u, v, to_light);
}

void MeasuredPdf(const MeasuredModel& model, const MaterialHits& at, const LightBatch& light,
                 float* pdf) {
  HWY_DYNAMIC_DISPATCH(MeasuredPdfT)(model, at, light, pdf);
}

double MeasuredLobeWidth(const MeasuredModel& model) {
  return FindLobeWidth([&](const LobeWidthPairs& pairs, auto* values) {
    const Basis<double> frame = BasisAbout(pairs.normal);
    for (size_t k = 0; k < pairs.to_light.size(); ++k) {
      const Vec3d& l = pairs.to_light[k];
      (*values)[k] =
          EvaluateMeasured(*model.brdf, model.interpolation, frame, l, pairs.to_view) / l.z;
    }
  });
}

}  // namespace nacre
#endif
