// SPDX-License-Identifier: Apache-2.0
// shading/lobe_kernel.cc: directions chosen by what surfaces reflect, and their densities.
#include <algorithm>
#include <variant>

#include "base/overloaded.h"
#include "shading/lobe_sample.h"
#include "shading/mapped.h"
#include "shading/scalar_material.h"
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

// Probability of sampling the multiple-scattering lobe (Kulla and Conty's) in the place of the
// single-scattering one, proportional to the estimated albedo of each lobe; and its spread.
class KullaContyShares {
 public:
  KullaContyShares(const MicrofacetModel& model, const Surface& surface, const HitTextures* maps,
                   bool own_fits)
      : multiple_(surface.multiple.data()),
        maps_(maps),
        fit_(own_fits ? maps->fit.data() : nullptr),
        form_(model.albedo.lobe.shape.form),
        spread_(KullaContySpread(model.albedo.lobe.shape)),
        scale_(static_cast<float>(model.multiple)),
        f90_(static_cast<float>(model.f90)),
        not_delta_(model.delta ? 0.0f : 1.0f) {
    for (int c = 0; c < 3; ++c) {
      f0_ = std::max(f0_, static_cast<float>(model.f0[c]));
      f_multiple_ = std::max(f_multiple_, static_cast<float>(model.f_multiple[c]));
    }
  }

  // The probability of a sample of Kulla and Conty's lobe: all where the other one is a mirror's.
  HWY_INLINE V Share(size_t i) const {
    const D d;
    const V zero = hn::Zero(d), one = hn::Set(d, 1.0f);
    V scale, f0, f90, f_multiple, not_delta;
    if (maps_ != nullptr) {
      scale = hn::LoadU(d, maps_->multiple_scale.data() + i);
      f0 = MaxChannel(maps_->f0, i);
      f90 = hn::LoadU(d, maps_->f90.data() + i);
      f_multiple = MaxChannel(maps_->f_multiple, i);
      not_delta = hn::LoadU(d, maps_->not_delta.data() + i);
    } else {
      scale = hn::Set(d, scale_);
      f0 = hn::Set(d, f0_);
      f90 = hn::Set(d, f90_);
      f_multiple = hn::Set(d, f_multiple_);
      not_delta = hn::Set(d, not_delta_);
    }
    const auto loses = hn::Gt(scale, zero);
    const V loss = hn::Min(hn::IfThenElseZero(loses, hn::Div(hn::LoadU(d, multiple_ + i),
                                                             hn::IfThenElse(loses, scale, one))),
                           one);
    // The mean of Schlick's curve stands for that of all.
    const V f_average = hn::MulAdd(hn::Sub(f90, f0), hn::Set(d, 1.0f / 21), f0);
    const V single = hn::Mul(hn::Mul(f_average, hn::Sub(one, loss)), not_delta);
    const V multiple = hn::Mul(f_multiple, loss);
    const auto any = hn::Gt(multiple, zero);
    const V sum = hn::IfThenElse(any, hn::Add(multiple, single), one);
    return hn::IfThenElseZero(any, hn::Div(multiple, sum));
  }

  HWY_INLINE V Spread(size_t i) const {
    const D d;
    if (fit_ == nullptr) return hn::Set(d, spread_);
    // KullaContySpread of the hit's AlbedoShape: `offset` is the fit's first entry, `k` its third.
    const V offset = hn::LoadU(d, fit_ + i);
    if (form_ == AlbedoForm::kLossLinear) return hn::Div(offset, hn::Set(d, 6.0f));
    const V k = hn::LoadU(d, fit_ + i + 2 * HitTextures::kFitStride);
    const V width =
        form_ == AlbedoForm::kMasked ? hn::Add(k, k) : hn::Div(offset, hn::Set(d, 3.0f));
    return hn::Mul(width, width);
  }

 private:
  static HWY_INLINE V MaxChannel(const Soa3<float>& soa, size_t i) {
    const Vec3V<V> v = LoadSoa(D(), soa, i);
    return hn::Max(hn::Max(v.x, v.y), v.z);
  }

  const float* multiple_;
  const HitTextures* maps_;  // null: all hits have the model's numbers
  const float* fit_;         // null: all hits have the model's spread
  AlbedoForm form_;
  float spread_, scale_, f90_, not_delta_;
  float f0_ = 0, f_multiple_ = 0;  // of the largest channel
};

void SampleGgxT(const MicrofacetModel& model, const float* by_hit, bool own_fits,
                const LobeRange& range, const float* u, const float* v, Soa3<float>* to_light) {
  const D d;
  const Width width = WidthOf(model.delta ? 1 : model.alpha, by_hit);
  const V one = hn::Set(d, 1.0f), zero = hn::Zero(d);
  if (model.compensation != Compensation::kKullaConty) {
    ForEachPacket(range.begin, range.end, to_light, [&](size_t i) HWY_ATTR {
      return SampleGgxVisible(d, LoadSoa(D(), range.surface.normal, i),
                              LoadSoa(D(), range.surface.to_view, i), width.At(i),
                              hn::LoadU(d, u + i), hn::LoadU(d, v + i));
    });
    return;
  }
  const KullaContyShares shares(model, range.surface, by_hit != nullptr ? range.textures : nullptr,
                                own_fits);
  const V below_one = hn::Set(d, 1 - 0x1p-24f);
  ForEachPacket(range.begin, range.end, to_light, [&](size_t i) HWY_ATTR {
    const Vec3V<V> normal = LoadSoa(D(), range.surface.normal, i);
    const V u0 = hn::LoadU(d, u + i), u1 = hn::LoadU(d, v + i);
    const V share = shares.Share(i), rest = hn::Sub(one, share);
    const auto multiple = hn::Lt(u0, share);
    // Rescales u0 to [0, 1) for the chosen lobe.
    const V divisor = hn::IfThenElse(multiple, share, rest);
    const V offset = hn::IfThenElse(multiple, zero, share);
    const V again =
        hn::Min(hn::Div(hn::Sub(u0, offset), hn::IfThenElse(hn::Gt(divisor, zero), divisor, one)),
                below_one);
    const Vec3V<V> single =
        SampleGgxVisible(d, normal, LoadSoa(D(), range.surface.to_view, i), width.At(i), again, u1);
    if (hn::AllFalse(d, multiple)) return single;
    return Select(multiple, SampleKullaConty(d, normal, shares.Spread(i), again, u1), single);
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

void GgxDensityT(const MicrofacetModel& model, const float* by_hit, bool own_fits,
                 const LobeRange& range, const LightBatch& light, const float* narrow,
                 float* density) {
  const D d;
  const Width width = WidthOf(model.delta ? 1 : model.alpha, by_hit);
  const bool kulla_conty = model.compensation == Compensation::kKullaConty;
  const KullaContyShares shares(model, range.surface, by_hit != nullptr ? range.textures : nullptr,
                                own_fits);
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
    V value = GgxVisiblePdf(d, distribution, angles.n_dot_v, alpha);
    if (kulla_conty) {
      const V share = shares.Share(i);
      const V single = hn::Mul(hn::Sub(hn::Set(d, 1.0f), share), value);
      const V multiple = hn::Mul(share, KullaContyPdf(d, angles.n_dot_l, shares.Spread(i)));
      value = hn::Add(single, hn::IfThenElseZero(hn::Gt(share, hn::Zero(d)), multiple));
    }
    hn::BlendedStore(value, hn::FirstN(d, range.end - i), d, density + i);
  }
}

void PhongDensityT(const PhongFamilyModel& phong, const float* by_hit, const LobeRange& range,
                   const LightBatch& light, const NarrowLobes* narrow, float* density) {
  const D d;
  const Width width = WidthOf(phong.shininess, by_hit);
  const bool blinn = phong.model == PhongModel::kBlinnPhong;
  const V one = hn::Set(d, 1.0f);
  const V half_pi_inverse = hn::Set(d, 0.159154943f);  // 1 / 2 pi
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
    const V scaled = hn::Mul(hn::Mul(half_pi_inverse, hn::Add(exponent, one)), lobe);
    V value = blinn ? scaled : PhongLobePdf(d, lobe, exponent);
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
// Of a mirror, what Kulla and Conty give back is one.
bool HasLobe(const MicrofacetModel& microfacet) {
  const bool multiple =
      microfacet.compensation == Compensation::kKullaConty && microfacet.multiple > 0;
  return microfacet.f90 > 0 && (!microfacet.delta || multiple);
}

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

// Overwrites the model's Fresnel parameters by the hit's, which are the same to the bit where maps
// are constant.
void ApplyMappedFresnel(const HitTextures& t, size_t i, MicrofacetModel* model) {
  const auto at = [i](const Soa3<double>& soa) { return Rgb(soa.x[i], soa.y[i], soa.z[i]); };
  model->metallic = t.metallic[i];
  model->dielectric_f0 = at(t.exact_dielectric_f0);
  model->dielectric_f90 = t.exact_dielectric_f90[i];
  model->metal_f0 = at(t.exact_metal_f0);
  model->f82_slope = at(t.exact_slope);
  model->schlick_k = SchlickK<double>(model->shadowing, t.width[i]);
}

// What a mirror's shadowing leaves: all, but for the lesson's curve, whose k is 1/8 there (Karis
// 2013); Turquin's compensation gives back of that what the reflectance at normal incidence says.
// Kulla and Conty's is a lobe of its own.
Rgb MirrorAt(const MicrofacetModel& model, double cosine) {
  const Rgb fresnel = FresnelOf(model, cosine, 1 - cosine);
  if (model.shadowing != Shadowing::kSchlickDirect) return fresnel;
  const double g1 = cosine / (cosine * (1 - model.schlick_k) + model.schlick_k);
  const double single = g1 * g1;
  if (model.compensation != Compensation::kTurquin) return fresnel * single;
  return fresnel * single + TurquinTerm(model, cosine, 1 - cosine) * (1 - single);
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
  const bool mapped = by_hit != nullptr;
  if (const auto* phong = std::get_if<PhongFamilyModel>(&material.model)) {
    return HWY_DYNAMIC_DISPATCH(SamplePhongT)(*phong, by_hit, range, u, v, to_light);
  }
  HWY_DYNAMIC_DISPATCH(SampleGgxT)
  (std::get<MicrofacetModel>(material.model), by_hit, mapped && HasOwnFits(material), range, u, v,
   to_light);
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
  (model, by_hit, mapped && HasOwnFits(material), hits, light,
   narrow != nullptr ? narrow->first.data() : nullptr, density);
}

bool IsMirror(const ShadingMaterial& material, const LobeRange& range, size_t hit) {
  const auto* model = std::get_if<MicrofacetModel>(&material.model);
  if (model == nullptr || !HasMappedModel(material)) return HasDeltaLobe(material);
  return range.textures->not_delta[hit] == 0;
}

bool AnyMirror(const ShadingMaterial& material, const LobeRange& range) {
  if (!HasMappedModel(material)) return HasDeltaLobe(material);
  for (size_t i = range.begin; i < range.end; ++i) {
    if (IsMirror(material, range, i)) return true;
  }
  return false;
}

void MirrorDirections(const LobeRange& range, Soa3<float>* to_light) {
  HWY_DYNAMIC_DISPATCH(MirrorDirectionsT)(range, to_light);
}

void MirrorReflectance(const ShadingMaterial& material, const LobeRange& range,
                       Soa3<float>* reflectance) {
  auto at_hit = std::get<MicrofacetModel>(material.model);
  const Soa3<float>& n = range.surface.normal;
  const Soa3<float>& v = range.surface.to_view;
  const bool mapped = HasMappedModel(material);
  for (size_t i = range.begin; i < range.end; ++i) {
    const double n_dot_v =
        double{n.x[i]} * v.x[i] + double{n.y[i]} * v.y[i] + double{n.z[i]} * v.z[i];
    if (mapped) ApplyMappedFresnel(*range.textures, i, &at_hit);
    const Rgb mirrored = MirrorAt(at_hit, std::clamp(n_dot_v, 0.0, 1.0));
    reflectance->x[i] = static_cast<float>(mirrored.x);
    reflectance->y[i] = static_cast<float>(mirrored.y);
    reflectance->z[i] = static_cast<float>(mirrored.z);
  }
}

}  // namespace nacre
#endif
