// SPDX-License-Identifier: Apache-2.0
// shading/lobe_kernel.cc: samples directions from the lobes of surfaces, and computes their pdfs.
#include <algorithm>
#include <variant>

#include "base/overloaded.h"
#include "shading/lobe_sample.h"
#include "shading/measured_model.h"
#include "shading/models_at_hit.h"
#include "shading/scalar_bsdf.h"
#include "shading/user_model.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "shading/lobe_kernel.cc"
#include "hwy/foreach_target.h"

#include "hwy/highway.h"

#include "brdf/ggx_anisotropic-inl.h"
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

// Stores the direction of(i) for each packet of hits, in lanes of the range only: a packet may
// reach into the next one.
template <class Of>
HWY_INLINE void ForEachPacket(const MaterialHits& at, Soa3<float>* to, const Of& of) {
  const D d;
  for (size_t i = at.begin; i < at.end; i += hn::Lanes(d)) {
    const auto mask = hn::FirstN(d, at.end - i);
    BlendedStoreSoa(d, of(i), mask, i, to);
  }
}

void SampleCosinesT(const MaterialHits& at, const float* u, const float* v, Soa3<float>* to_light) {
  const D d;
  ForEachPacket(at, to_light, [&](size_t i) HWY_ATTR {
    return SampleCosine(d, LoadSoa(D(), at.surface.normal, i), hn::LoadU(d, u + i),
                        hn::LoadU(d, v + i));
  });
}

// The product is not fused, so that every target gives the same bits.
void CosinePdfsT(const MaterialHits& at, const Soa3<float>& to_light, float* pdf) {
  const D d;
  const V by_pi = hn::Set(d, static_cast<float>(M_1_PI));
  for (size_t i = at.begin; i < at.end; i += hn::Lanes(d)) {
    const V n_dot_l = Dot(LoadSoa(d, at.surface.normal, i), LoadSoa(d, to_light, i));
    hn::BlendedStore(hn::Mul(n_dot_l, by_pi), hn::FirstN(d, at.end - i), d, pdf + i);
  }
}

HWY_INLINE V NumberAt(float number, size_t) { return hn::Set(D(), number); }
HWY_INLINE V NumberAt(const float* numbers, size_t i) { return hn::LoadU(D(), numbers + i); }

HWY_INLINE V ExponentAt(const PhongExponent& exponent, size_t i) {
  return exponent.by_hit != nullptr ? NumberAt(exponent.by_hit, i) : NumberAt(exponent.uniform, i);
}

template <class Number>
HWY_INLINE V MaxChannel(const Number (&rgb)[3], size_t i) {
  return hn::Max(hn::Max(NumberAt(rgb[0], i), NumberAt(rgb[1], i)), NumberAt(rgb[2], i));
}

// The probability of sampling the multiple-scattering lobe (Kulla and Conty's) rather than the
// single-scattering one, in proportion to the estimated albedo of each lobe; and the spread of the
// former.
template <class Number>
class KullaContyShares {
 public:
  KullaContyShares(const MicrofacetNumbers<Number>& lobe, const Surface& surface)
      : lobe_(lobe),
        multiple_(surface.multiple.data()),
        form_(lobe.model.albedo.lobe.shape.form),
        spread_(KullaContySpread(lobe.model.albedo.lobe.shape)) {}

  // The probability of sampling Kulla and Conty's lobe, which is 1 where the other is a mirror's.
  HWY_INLINE V Share(size_t i) const {
    const D d;
    const V zero = hn::Zero(d), one = hn::Set(d, 1.0f);
    const V scale = NumberAt(lobe_.multiple, i);
    const V f0 = MaxChannel(lobe_.f0, i), f90 = NumberAt(lobe_.f90, i);
    const auto loses = hn::Gt(scale, zero);
    const V loss = hn::Min(hn::IfThenElseZero(loses, hn::Div(hn::LoadU(d, multiple_ + i),
                                                             hn::IfThenElse(loses, scale, one))),
                           one);
    // The mean of Schlick's curve approximates that of all Fresnel curves.
    const V f_average = hn::MulAdd(hn::Sub(f90, f0), hn::Set(d, 1.0f / 21), f0);
    const V single = hn::Mul(hn::Mul(f_average, hn::Sub(one, loss)), NumberAt(lobe_.not_delta, i));
    const V multiple = hn::Mul(MaxChannel(lobe_.f_multiple, i), loss);
    const auto any = hn::Gt(multiple, zero);
    const V sum = hn::IfThenElse(any, hn::Add(multiple, single), one);
    return hn::IfThenElseZero(any, hn::Div(multiple, sum));
  }

  HWY_INLINE V Spread(size_t i) const {
    const D d;
    if (lobe_.fit == nullptr) return hn::Set(d, spread_);
    // KullaContySpread of the hit's AlbedoShape: `offset` is the fit's first entry, `k` its third.
    const float* const entry = lobe_.fit + i;
    const V offset = hn::LoadU(d, entry);
    if (form_ == AlbedoForm::kLossLinear) return hn::Div(offset, hn::Set(d, 6.0f));
    const V k = hn::LoadU(d, entry + 2 * HitParameters::kStride);
    const V width =
        form_ == AlbedoForm::kMasked ? hn::Add(k, k) : hn::Div(offset, hn::Set(d, 3.0f));
    return hn::Mul(width, width);
  }

 private:
  const MicrofacetNumbers<Number>& lobe_;
  const float* multiple_;
  AlbedoForm form_;
  float spread_;
};

// The alphas of hits i...
HWY_INLINE GgxAlphasV<V> AlphasAt(const AnisotropicLobes& lobes, size_t i) {
  const D d;
  HWY_ALIGN float x[hn::MaxLanes(d)], y[hn::MaxLanes(d)];
  for (size_t k = 0; k < hn::Lanes(d); ++k) {
    x[k] = static_cast<float>(lobes.At(i + k).alpha.x);
    y[k] = static_cast<float>(lobes.At(i + k).alpha.y);
  }
  return MakeGgxAlphas(d, hn::Load(d, x), hn::Load(d, y));
}

template <class Number>
HWY_INLINE Vec3V<V> SampleVisible(const MicrofacetNumbers<Number>& lobe, const Surface& surface,
                                  size_t i, V u0, V u1) {
  const D d;
  const Vec3V<V> normal = LoadSoa(d, surface.normal, i), to_view = LoadSoa(d, surface.to_view, i);
  if (lobe.lobes.first == nullptr) {
    return SampleGgxVisible(d, normal, to_view, NumberAt(lobe.alpha, i), u0, u1);
  }
  const BasisV<V> frame = LobeFrame(d, normal, LoadSoa(d, surface.tangent, i));
  return SampleGgxVisible(d, frame, to_view, AlphasAt(lobe.lobes, i), u0, u1);
}

template <class Number>
void SampleGgxOf(const MicrofacetNumbers<Number>& lobe, const MaterialHits& at, const float* u,
                 const float* v, Soa3<float>* to_light) {
  const D d;
  const V one = hn::Set(d, 1.0f), zero = hn::Zero(d);
  if (lobe.model.compensation != Compensation::kKullaConty) {
    ForEachPacket(at, to_light, [&](size_t i) HWY_ATTR {
      return SampleVisible(lobe, at.surface, i, hn::LoadU(d, u + i), hn::LoadU(d, v + i));
    });
    return;
  }
  const KullaContyShares<Number> shares(lobe, at.surface);
  const V below_one = hn::Set(d, 1 - 0x1p-24f);
  ForEachPacket(at, to_light, [&](size_t i) HWY_ATTR {
    const Vec3V<V> normal = LoadSoa(D(), at.surface.normal, i);
    const V u0 = hn::LoadU(d, u + i), u1 = hn::LoadU(d, v + i);
    const V share = shares.Share(i), rest = hn::Sub(one, share);
    const auto multiple = hn::Lt(u0, share);
    // Rescales u0 to [0, 1) for the chosen lobe.
    const V divisor = hn::IfThenElse(multiple, share, rest);
    const V offset = hn::IfThenElse(multiple, zero, share);
    const V again =
        hn::Min(hn::Div(hn::Sub(u0, offset), hn::IfThenElse(hn::Gt(divisor, zero), divisor, one)),
                below_one);
    const Vec3V<V> single = SampleVisible(lobe, at.surface, i, again, u1);
    if (hn::AllFalse(d, multiple)) return single;
    return Select(multiple, SampleKullaConty(d, normal, shares.Spread(i), again, u1), single);
  });
}

constexpr auto& SampleGgxT = SampleGgxOf<float>;
constexpr auto& SampleGgxMapsT = SampleGgxOf<float*>;

// Phong's lobe is about the mirrored view direction, Blinn's half vector about the normal.
void SamplePhongT(PhongModel model, const PhongExponent& exponent, const MaterialHits& at,
                  const float* u, const float* v, Soa3<float>* to_light) {
  const D d;
  const bool blinn = model == PhongModel::kBlinnPhong;
  ForEachPacket(at, to_light, [&](size_t i) HWY_ATTR {
    const Vec3V<V> normal = LoadSoa(D(), at.surface.normal, i);
    const Vec3V<V> to_view = LoadSoa(D(), at.surface.to_view, i);
    const V u0 = hn::LoadU(d, u + i), u1 = hn::LoadU(d, v + i);
    const V n = ExponentAt(exponent, i);
    return blinn ? SampleBlinnLobe(d, normal, to_view, n, u0, u1)
                 : SamplePhongLobe(d, normal, to_view, n, u0, u1);
  });
}

template <class Number>
void GgxPdfOf(const MicrofacetNumbers<Number>& lobe, const MaterialHits& at,
              const LightBatch& light, const SharpLobeTerms* sharp, float* pdf) {
  const D d;
  const bool kulla_conty = lobe.model.compensation == Compensation::kKullaConty;
  const KullaContyShares<Number> shares(lobe, at.surface);
  for (size_t i = at.begin; i < at.end; i += hn::Lanes(d)) {
    const V alpha = NumberAt(lobe.alpha, i);
    const AnglesV<V> angles =
        ComputeAngles(d, LoadSoa(D(), at.surface.normal, i), LoadSoa(D(), light.light_vector, i),
                      LoadSoa(D(), at.surface.to_view, i));
    V distribution = GgxDistribution(d, angles, alpha);
    if (sharp != nullptr) {
      const V exact = hn::LoadU(d, sharp->distribution.data() + i);
      distribution = hn::IfThenElse(hn::Ge(exact, hn::Zero(d)), exact, distribution);
    }
    V value = GgxVisiblePdf(d, distribution, angles.n_dot_v, alpha);
    if (sharp != nullptr && lobe.lobes.first != nullptr) {
      const V root = hn::LoadU(d, sharp->view_root.data() + i);
      const V sum = hn::Add(hn::Max(angles.n_dot_v, hn::Zero(d)), root);
      value = hn::Div(distribution, hn::Add(sum, sum));
    }
    if (kulla_conty) {
      const V share = shares.Share(i);
      const V single = hn::Mul(hn::Sub(hn::Set(d, 1.0f), share), value);
      const V multiple = hn::Mul(share, KullaContyPdf(d, angles.n_dot_l, shares.Spread(i)));
      value = hn::Add(single, hn::IfThenElseZero(hn::Gt(share, hn::Zero(d)), multiple));
    }
    hn::BlendedStore(value, hn::FirstN(d, at.end - i), d, pdf + i);
  }
}

constexpr auto& GgxPdfT = GgxPdfOf<float>;
constexpr auto& GgxPdfMapsT = GgxPdfOf<float*>;

void PhongPdfT(PhongModel model, const PhongExponent& exponents, const MaterialHits& at,
               const LightBatch& light, const SharpLobeTerms* sharp, float* pdf) {
  const D d;
  const bool blinn = model == PhongModel::kBlinnPhong;
  for (size_t i = at.begin; i < at.end; i += hn::Lanes(d)) {
    const Vec3V<V> normal = LoadSoa(D(), at.surface.normal, i),
                   to_light = LoadSoa(D(), light.light_vector, i);
    const Vec3V<V> to_view = LoadSoa(D(), at.surface.to_view, i);
    const AnglesV<V> angles = ComputeAngles(d, normal, to_light, to_view);
    LobeCosineV<V> cosine = blinn
                                ? BlinnSquaredCosine(d, angles)
                                : PhongCosine(d, SquaredFromReflection(normal, to_light, to_view));
    if (sharp != nullptr) {
      const V exact = hn::LoadU(d, sharp->one_minus_cos.data() + i);
      const auto is_sharp = hn::Ge(exact, hn::Zero(d));  // wide lobes have -1
      cosine = {hn::IfThenElse(is_sharp, exact, cosine.one_minus_c),
                hn::IfThenElse(is_sharp, hn::LoadU(d, sharp->cos.data() + i), cosine.c)};
    }
    const V exponent = ExponentAt(exponents, i);
    const V lobe = blinn ? BlinnLobe(d, cosine, exponent) : PhongLobe(d, cosine, exponent);
    const V value =
        blinn ? BlinnLobePdf(d, lobe, angles, exponent) : PhongLobePdf(d, lobe, exponent);
    hn::BlendedStore(value, hn::FirstN(d, at.end - i), d, pdf + i);
  }
}

void MirrorDirectionsT(const MaterialHits& at, Soa3<float>* to_light) {
  ForEachPacket(at, to_light, [&](size_t i) HWY_ATTR {
    return Mirrored(LoadSoa(D(), at.surface.to_view, i), LoadSoa(D(), at.surface.normal, i));
  });
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace nacre
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace nacre {
HWY_EXPORT(SampleCosinesT);
HWY_EXPORT(CosinePdfsT);
HWY_EXPORT(SampleGgxT);
HWY_EXPORT(SampleGgxMapsT);
HWY_EXPORT(SamplePhongT);
HWY_EXPORT(GgxPdfT);
HWY_EXPORT(GgxPdfMapsT);
HWY_EXPORT(PhongPdfT);
HWY_EXPORT(MirrorDirectionsT);

namespace {

bool HasLobe(const PhongFamilyModel& phong) { return phong.specular.length2() > 0; }
// A mirror has a lobe to sample only if Kulla and Conty's compensation adds one.
bool HasLobe(const MicrofacetModel& microfacet) {
  const bool multiple =
      microfacet.compensation == Compensation::kKullaConty && microfacet.multiple > 0;
  return microfacet.f90 > 0 && (!microfacet.delta || multiple);
}

PhongExponent ExponentOf(const PhongFamilyModel& phong, const HitParameters* maps) {
  return {static_cast<float>(phong.shininess),
          maps != nullptr ? ColumnsIn<PhongConstants<float*>>(maps->constants).shininess : nullptr};
}

// Sets the model's Fresnel curve and shadowing to those of hit i.
void TakeHit(const ShadingMaterial& material, const HitParameters& t, size_t i,
             MicrofacetModel* model) {
  for (int c = 0; c < 3; ++c) {
    VisitChannel(material, t, c, [&](const auto& channel) {
      const MicrofacetColors at = channel.Colors(i);
      model->metallic = at.metallic;
      model->dielectric_f0[c] = at.dielectric_f0;
      model->dielectric_f90 = at.dielectric_f90;
      model->metal_f0[c] = at.metal_f0;
      model->f82_slope[c] = at.f82_slope;
    });
  }
  model->schlick_k = SchlickK<double>(model->shadowing, NumbersOf(t, MappedNumber::kWidth)[i]);
}

}  // namespace

bool HasSampledLobe(const ShadingMaterial& material) {
  return std::visit(
      Overloaded{[](const PhongFamilyModel& phong) { return HasLobe(phong); },
                 [](const MicrofacetModel& model) { return HasLobe(model); },
                 [](const UserModel& model) { return bool{model.brdf->sample}; },
                 [](const MeasuredModel&) { return true; }, [](const auto&) { return false; }},
      material.model);
}

void SampleCosines(const MaterialHits& at, const float* u, const float* v, Soa3<float>* to_light) {
  HWY_DYNAMIC_DISPATCH(SampleCosinesT)(at, u, v, to_light);
}

void CosinePdfs(const MaterialHits& at, const Soa3<float>& to_light, float* pdf) {
  HWY_DYNAMIC_DISPATCH(CosinePdfsT)(at, to_light, pdf);
}

void SampleLobe(const MaterialHits& at, const float* u, const float* v, ShadeScratch* scratch,
                Soa3<float>* to_light) {
  if (!HasSampledLobe(at.material)) return;
  if (const auto* user = std::get_if<UserModel>(&at.material.model)) {
    return SampleUser(*user, at, u, v, scratch, to_light);
  }
  if (const auto* measured = std::get_if<MeasuredModel>(&at.material.model)) {
    return SampleMeasured(*measured, at, u, v, to_light);
  }
  const HitParameters* const maps = at.Maps();
  if (const auto* phong = std::get_if<PhongFamilyModel>(&at.material.model)) {
    return HWY_DYNAMIC_DISPATCH(SamplePhongT)(phong->model, ExponentOf(*phong, maps), at, u, v,
                                              to_light);
  }
  const auto& model = std::get<MicrofacetModel>(at.material.model);
  if (maps != nullptr) {
    return HWY_DYNAMIC_DISPATCH(SampleGgxMapsT)(NumbersOfHits(at.material, *maps), at, u, v,
                                                to_light);
  }
  HWY_DYNAMIC_DISPATCH(SampleGgxT)(NumbersOfModel(model), at, u, v, to_light);
}

void LobePdf(const MaterialHits& at, const LightBatch& light, ShadeScratch* scratch, float* pdf) {
  if (!HasSampledLobe(at.material)) {
    std::fill(pdf + at.begin, pdf + at.end, 0.0f);
    return;
  }
  if (const auto* user = std::get_if<UserModel>(&at.material.model)) {
    return UserPdf(*user, at, light, scratch, pdf);
  }
  if (const auto* measured = std::get_if<MeasuredModel>(&at.material.model)) {
    return MeasuredPdf(*measured, at, light, pdf);
  }
  static const ShadingLight kGiven{.form = LightForm::kGiven};
  const LitHits lit{at, kGiven, &light, nullptr, false};
  const HitParameters* const maps = at.Maps();
  if (const auto* phong = std::get_if<PhongFamilyModel>(&at.material.model)) {
    return HWY_DYNAMIC_DISPATCH(PhongPdfT)(phong->model, ExponentOf(*phong, maps), at, light,
                                           FormSharpTerms(*phong, lit, &scratch->sharp), pdf);
  }
  const auto& model = std::get<MicrofacetModel>(at.material.model);
  const SharpLobeTerms* const sharp = FormSharpTerms(model, lit, &scratch->sharp);
  if (maps != nullptr) {
    return HWY_DYNAMIC_DISPATCH(GgxPdfMapsT)(NumbersOfHits(at.material, *maps), at, light, sharp,
                                             pdf);
  }
  HWY_DYNAMIC_DISPATCH(GgxPdfT)(NumbersOfModel(model), at, light, sharp, pdf);
}

bool IsMirror(const MaterialHits& at, size_t hit) {
  const auto* model = std::get_if<MicrofacetModel>(&at.material.model);
  if (model == nullptr || !at.material.by_hit.model) return HasDeltaLobe(at.material);
  using Columns = MicrofacetConstants<float*>;
  return NumberIn(at.textures->constants, &Columns::not_delta, hit) == 0;
}

bool AnyMirror(const MaterialHits& at) {
  if (!at.material.by_hit.model) return HasDeltaLobe(at.material);
  for (size_t i = at.begin; i < at.end; ++i) {
    if (IsMirror(at, i)) return true;
  }
  return false;
}

void MirrorDirections(const MaterialHits& at, Soa3<float>* to_light) {
  HWY_DYNAMIC_DISPATCH(MirrorDirectionsT)(at, to_light);
}

void MirrorReflectances(const MaterialHits& at, Soa3<float>* reflectance) {
  auto at_hit = std::get<MicrofacetModel>(at.material.model);
  for (size_t i = at.begin; i < at.end; ++i) {
    if (at.material.by_hit.model) TakeHit(at.material, *at.textures, i, &at_hit);
    SetVector(MirrorReflectance(at_hit, NDotV(at.surface, i)), i, reflectance);
  }
}

}  // namespace nacre
#endif
