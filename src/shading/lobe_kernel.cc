// SPDX-License-Identifier: Apache-2.0
// shading/lobe_kernel.cc: directions chosen by what surfaces reflect, and their densities.
#include <algorithm>
#include <variant>

#include "base/overloaded.h"
#include "brdf/fresnel.h"
#include "shading/lobe_sample.h"
#include "shading/mapped.h"
#include "shading/texture_kernels.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "shading/lobe_kernel.cc"
#include "hwy/foreach_target.h"

#include "hwy/highway.h"

#include "brdf/lobe_sampling-inl.h"
#include "shading/kernels.h"
#include "shading/soa-inl.h"

HWY_BEFORE_NAMESPACE();
namespace nacre {
namespace HWY_NAMESPACE {
namespace {
namespace hn = hwy::HWY_NAMESPACE;

using D = hn::ScalableTag<float>;
using V = hn::Vec<D>;

// Calls at(i) for each packet of hits and stores the direction that it gives, in lanes of the
// range only: a packet may reach into the next one.
template <class At>
HWY_INLINE void ForEachPacket(size_t begin, size_t end, Soa3<float>* to, const At& at) {
  const D d;
  for (size_t i = begin; i < end; i += hn::Lanes(d)) {
    const auto mask = hn::FirstN(d, end - i);
    const Vec3V<V> direction = at(i);
    hn::BlendedStore(direction.x, mask, d, to->x.data() + i);
    hn::BlendedStore(direction.y, mask, d, to->y.data() + i);
    hn::BlendedStore(direction.z, mask, d, to->z.data() + i);
  }
}

void SampleCosineT(const Surface& surface, size_t count, const float* u, const float* v,
                   Soa3<float>* to_light) {
  const D d;
  ForEachPacket(0, count, to_light, [&](size_t i) HWY_ATTR {
    return SampleCosine(d, LoadSoa(D(), surface.normal, i), hn::LoadU(d, u + i),
                        hn::LoadU(d, v + i));
  });
}

// The width of a material's lobe: its own, or that of each hit by a map.
struct Width {
  float uniform;
  const float* by_hit;  // or null

  HWY_INLINE V At(size_t i) const {
    const D d;
    return by_hit != nullptr ? hn::LoadU(d, by_hit + i) : hn::Set(d, uniform);
  }
};

HWY_INLINE Width WidthOf(double uniform, const float* by_hit) {
  return {static_cast<float>(uniform), by_hit};
}

void SampleGgxT(double alpha, const float* by_hit, const LobeRange& range, const float* u,
                const float* v, Soa3<float>* to_light) {
  const D d;
  const Width width = WidthOf(alpha, by_hit);
  ForEachPacket(range.begin, range.end, to_light, [&](size_t i) HWY_ATTR {
    // Interpolated normals may lean away from the viewer: there is no lobe, and no density.
    return SampleGgxVisible(d, LoadSoa(D(), range.surface.normal, i),
                            LoadSoa(D(), range.surface.to_view, i), width.At(i),
                            hn::LoadU(d, u + i), hn::LoadU(d, v + i));
  });
}

// Phong's lobe is about the mirrored view direction, Blinn's half vector about the normal.
void SamplePhongT(const PhongFamilyModel& phong, const float* by_hit, const LobeRange& range,
                  const float* u, const float* v, Soa3<float>* to_light) {
  const D d;
  const Width width = WidthOf(phong.shininess, by_hit);
  const bool blinn = phong.model == PhongModel::kBlinnPhong;
  ForEachPacket(range.begin, range.end, to_light, [&](size_t i) HWY_ATTR {
    const Vec3V<V> normal = LoadSoa(D(), range.surface.normal, i);
    const Vec3V<V> to_view = LoadSoa(D(), range.surface.to_view, i);
    const V u0 = hn::LoadU(d, u + i), u1 = hn::LoadU(d, v + i);
    return blinn ? SampleBlinnLobe(d, normal, to_view, width.At(i), u0, u1)
                 : SamplePhongLobe(d, normal, to_view, width.At(i), u0, u1);
  });
}

// GgxVisiblePdf of any distribution.
HWY_INLINE V VisibleDensity(V distribution, V n_dot_v, V alpha) {
  const D d;
  const auto above = hn::Gt(n_dot_v, hn::Zero(d));
  const V sum = hn::Add(n_dot_v, SmithRoot(d, n_dot_v, alpha));
  const V twice = hn::IfThenElse(above, hn::Add(sum, sum), hn::Set(d, 1.0f));
  return hn::IfThenElseZero(above, hn::Div(distribution, twice));
}

void GgxDensityT(const MicrofacetModel& model, const float* by_hit, const LobeRange& range,
                 const LightBatch& light, const float* narrow, float* density) {
  const D d;
  const Width width = WidthOf(model.alpha, by_hit);
  for (size_t i = range.begin; i < range.end; i += hn::Lanes(d)) {
    const V alpha = width.At(i);
    const AnglesV<V> angles =
        ComputeAngles(d, LoadSoa(D(), range.surface.normal, i), LoadSoa(D(), light.to_light, i),
                      LoadSoa(D(), range.surface.to_view, i));
    V distribution = GgxDistribution(d, angles, alpha);
    if (narrow != nullptr) {
      const V exact = hn::LoadU(d, narrow + i);
      distribution = hn::IfThenElse(hn::Ge(exact, hn::Zero(d)), exact, distribution);
    }
    hn::BlendedStore(VisibleDensity(distribution, angles.n_dot_v, alpha),
                     hn::FirstN(d, range.end - i), d, density + i);
  }
}

void PhongDensityT(const PhongFamilyModel& phong, const float* by_hit, const LobeRange& range,
                   const LightBatch& light, const NarrowLobes* narrow, float* density) {
  const D d;
  const Width width = WidthOf(phong.shininess, by_hit);
  const bool blinn = phong.model == PhongModel::kBlinnPhong;
  const V one = hn::Set(d, 1.0f);
  const V scale = hn::Set(d, static_cast<float>(M_1_PI / 2));
  const V smallest = hn::Set(d, 0x1p-60f);
  for (size_t i = range.begin; i < range.end; i += hn::Lanes(d)) {
    const Vec3V<V> normal = LoadSoa(D(), range.surface.normal, i),
                   to_light = LoadSoa(D(), light.to_light, i);
    const Vec3V<V> to_view = LoadSoa(D(), range.surface.to_view, i);
    const AnglesV<V> angles = ComputeAngles(d, normal, to_light, to_view);
    LobeCosineV<V> cosine = blinn
                                ? BlinnSquaredCosine(d, angles)
                                : PhongCosine(d, SquaredFromReflection(normal, to_light, to_view));
    if (narrow != nullptr) {
      const V exact = hn::LoadU(d, narrow->first.data() + i);
      const auto is_narrow = hn::Ge(exact, hn::Zero(d));  // others have -1
      cosine = {hn::IfThenElse(is_narrow, exact, cosine.one_minus_c),
                hn::IfThenElse(is_narrow, hn::LoadU(d, narrow->second.data() + i), cosine.c)};
    }
    const V exponent = width.At(i);
    const V lobe = blinn ? BlinnLobe(d, cosine, exponent) : PhongLobe(d, cosine, exponent);
    V value = hn::Mul(hn::Mul(scale, hn::Add(exponent, one)), lobe);
    // |u| = 2 v.h: the density of h over 4 v.h is that of l.
    const V u_length = hn::Sqrt(hn::Max(angles.u_squared, smallest));
    if (blinn) value = hn::Div(value, hn::Add(u_length, u_length));
    hn::BlendedStore(value, hn::FirstN(d, range.end - i), d, density + i);
  }
}

void MirrorDirectionsT(const LobeRange& range, Soa3<float>* to_light) {
  ForEachPacket(range.begin, range.end, to_light, [&](size_t i) HWY_ATTR {
    return Mirrored(LoadSoa(D(), range.surface.to_view, i), LoadSoa(D(), range.surface.normal, i));
  });
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace nacre
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace nacre {
HWY_EXPORT(SampleCosineT);
HWY_EXPORT(SampleGgxT);
HWY_EXPORT(SamplePhongT);
HWY_EXPORT(GgxDensityT);
HWY_EXPORT(PhongDensityT);
HWY_EXPORT(MirrorDirectionsT);

namespace {

bool HasLobe(const PhongFamilyModel& phong) { return phong.specular.length2() > 0; }
bool HasLobe(const MicrofacetModel& microfacet) { return !microfacet.delta && microfacet.f90 > 0; }

const ShadingLight& GivenLight() {
  static const ShadingLight kGiven{.form = LightForm::kGiven};
  return kGiven;
}

// The lobe's width at each hit, if a map gives it; else null.
const float* WidthByHit(const ShadingMaterial& material, const LobeRange& range) {
  return HasMappedModel(material) ? range.textures->alpha.data() : nullptr;
}

// The terms of narrow lobes along a light's directions, or null if no hit has one.
const NarrowLobes* Narrow(const MicrofacetModel& model, bool mapped, const LobeRange& hits,
                          const ShadeRange& range, NarrowLobes* scratch) {
  if (mapped) {
    const double* const alpha = hits.textures->double_alpha.data();
    const auto is_narrow = [](double a) { return a >= 0; };
    if (std::none_of(alpha + hits.begin, alpha + hits.end, is_narrow)) return nullptr;
    NarrowGgxMaps(alpha, range, scratch);
  } else {
    if (!model.double_terms) return nullptr;
    NarrowGgx(model.alpha, range, scratch);
  }
  return scratch;
}

const NarrowLobes* Narrow(const PhongFamilyModel& phong, bool mapped, const LobeRange& hits,
                          const ShadeRange& range, NarrowLobes* scratch) {
  if (mapped) {
    const double* const width = hits.textures->width.data();
    const auto is_narrow = [](double n) { return n > kDoubleTermsShininess; };
    if (std::none_of(width + hits.begin, width + hits.end, is_narrow)) return nullptr;
    NarrowPhongMaps(phong.model, width, range, scratch);
  } else {
    if (!phong.double_terms) return nullptr;
    NarrowPhong(phong.model, range, scratch);
  }
  return scratch;
}

// The model's Fresnel curve at the cosine of the angle of incidence, exactly.
double FresnelAt(const MicrofacetModel& model, double cosine, int channel) {
  const double rest = 1 - cosine;
  switch (model.fresnel) {
    case FresnelForm::kSchlick:
      return FresnelSchlick(model.f0[channel], model.f90, Power5(rest));
    case FresnelForm::kF82:
      return FresnelF82(cosine, rest, model.f0[channel], model.f90, model.f82_slope[channel]);
    case FresnelForm::kDielectric:
      return FresnelDielectric(cosine, rest, model.eta[0]);
    case FresnelForm::kConductor:
      return FresnelConductor(cosine, rest, model.eta[channel], model.k[channel]);
  }
  return 0;
}

// What a mirror's shadowing leaves: all, but for the lesson's curve, whose k is 1/8 there (Karis
// 2013); Turquin's compensation gives back of that what the reflectance at normal incidence says.
double MirrorAt(const MicrofacetModel& model, double cosine, int channel) {
  const double fresnel = FresnelAt(model, cosine, channel);
  if (model.shadowing != Shadowing::kSchlickDirect || !(cosine > 0)) return fresnel;
  const double g1 = cosine / (cosine * (1 - model.schlick_k) + model.schlick_k);
  const double single = g1 * g1;
  if (model.compensation != Compensation::kTurquin) return fresnel * single;
  return fresnel * single * (1 + model.f0[channel] * (1 - single) / single);
}

}  // namespace

bool HasSampledLobe(const ShadingMaterial& material) {
  return std::visit(Overloaded{[](const PhongFamilyModel& phong) { return HasLobe(phong); },
                               [](const MicrofacetModel& model) { return HasLobe(model); },
                               [](const auto&) { return false; }},
                    material.model);
}

bool DiffuseIsFlat(const ShadingMaterial& material) {
  if (material.turned) return false;  // the surface's own horizon cuts the light
  if (std::holds_alternative<RoughMatteModel>(material.model)) return false;
  const auto* model = std::get_if<MicrofacetModel>(&material.model);
  if (model == nullptr) return true;
  if (model->base_form != DiffuseForm::kLambert) return false;
  return model->coupling == DiffuseCoupling::kNone ||
         (model->coupling == DiffuseCoupling::kAlbedoScaled &&
          model->compensation != Compensation::kKullaConty);
}

void SampleCosine(const Surface& surface, size_t count, const float* u, const float* v,
                  Soa3<float>* to_light) {
  HWY_DYNAMIC_DISPATCH(SampleCosineT)(surface, count, u, v, to_light);
}

void SampleLobe(const ShadingMaterial& material, const LobeRange& range, const float* u,
                const float* v, Soa3<float>* to_light) {
  if (!HasSampledLobe(material)) return;
  const float* const by_hit = WidthByHit(material, range);
  if (const auto* phong = std::get_if<PhongFamilyModel>(&material.model)) {
    return HWY_DYNAMIC_DISPATCH(SamplePhongT)(*phong, by_hit, range, u, v, to_light);
  }
  const double alpha = std::get<MicrofacetModel>(material.model).alpha;
  HWY_DYNAMIC_DISPATCH(SampleGgxT)(alpha, by_hit, range, u, v, to_light);
}

void LobeDensity(const ShadingMaterial& material, const LobeRange& hits, const LightBatch& light,
                 NarrowLobes* scratch, float* density) {
  if (!HasSampledLobe(material)) {
    std::fill(density + hits.begin, density + hits.end, 0.0f);
    return;
  }
  const LightOnBatch given{&GivenLight(), &light};
  const ShadeRange range{hits.hits, hits.surface, {&given, 1}, hits.begin, hits.end, nullptr};
  const float* const by_hit = WidthByHit(material, hits);
  const bool mapped = by_hit != nullptr;
  if (const auto* phong = std::get_if<PhongFamilyModel>(&material.model)) {
    const NarrowLobes* const narrow = Narrow(*phong, mapped, hits, range, scratch);
    return HWY_DYNAMIC_DISPATCH(PhongDensityT)(*phong, by_hit, hits, light, narrow, density);
  }
  const auto& model = std::get<MicrofacetModel>(material.model);
  const NarrowLobes* const narrow = Narrow(model, mapped, hits, range, scratch);
  HWY_DYNAMIC_DISPATCH(GgxDensityT)
  (model, by_hit, hits, light, narrow != nullptr ? narrow->first.data() : nullptr, density);
}

void MirrorDirections(const LobeRange& range, Soa3<float>* to_light) {
  HWY_DYNAMIC_DISPATCH(MirrorDirectionsT)(range, to_light);
}

void MirrorReflectance(const ShadingMaterial& material, const LobeRange& range,
                       Soa3<float>* reflectance) {
  const auto& model = std::get<MicrofacetModel>(material.model);
  const Soa3<float>& n = range.surface.normal;
  const Soa3<float>& v = range.surface.to_view;
  for (size_t i = range.begin; i < range.end; ++i) {
    const double cosine =
        double{n.x[i]} * v.x[i] + double{n.y[i]} * v.y[i] + double{n.z[i]} * v.z[i];
    const double clamped = std::clamp(cosine, 0.0, 1.0);
    reflectance->x[i] = static_cast<float>(MirrorAt(model, clamped, 0));
    reflectance->y[i] = static_cast<float>(MirrorAt(model, clamped, 1));
    reflectance->z[i] = static_cast<float>(MirrorAt(model, clamped, 2));
  }
}

}  // namespace nacre
#endif
