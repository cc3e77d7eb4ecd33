// SPDX-License-Identifier: Apache-2.0
#include "shading/scalar_bsdf.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <variant>

#include "brdf/burley.h"
#include "brdf/eon.h"
#include "brdf/fresnel.h"
#include "brdf/ggx.h"
#include "brdf/lobe_sampling.h"
#include "brdf/phong.h"
#include "shading/lobe_chances.h"
#include "shading/lobe_sample.h"
#include "shading/user_model.h"

namespace nacre {
namespace {

// A diffuse model's reflection over Lambert's. `ratio` is EonMultipleRatio of the channel's colour.
double SpreadOf(DiffuseForm form, const Angles<double>& a, double roughness, double ratio) {
  switch (form) {
    case DiffuseForm::kOrenNayar:
      return M_PI * (EonSingle(a.n_dot_l, a.n_dot_v, 1 - a.lv_squared / 2, roughness) +
                     ratio * EonMultiple(a.n_dot_l, a.n_dot_v, roughness));
    case DiffuseForm::kBurley:
      return M_PI * BurleyDiffuse(a, roughness);
    case DiffuseForm::kLambert:
      break;
  }
  return 1;
}

Reflection ReflectModel(const MatteModel& model, const Vec3d& n, const Vec3d& l, const Vec3d& v) {
  const Angles<double> a = ComputeAngles(n, l, v);
  Reflection out;
  for (int c = 0; c < 3; ++c) {
    out.diffuse[c] =
        model.diffuse[c] * a.n_dot_l * SpreadOf(model.form, a, model.roughness, model.ratio[c]);
  }
  return out;
}

Reflection ReflectModel(const PhongFamilyModel& model, const Vec3d& n, const Vec3d& l,
                        const Vec3d& v) {
  const double n_dot_l = n ^ l;
  const double lobe = model.model == PhongModel::kBlinnPhong
                          ? BlinnLobe(ComputeAngles(n, l, v), model.shininess)
                          : PhongLobe(n, l, v, model.shininess);
  const double weight = model.model == PhongModel::kModifiedPhong ? n_dot_l : 1;
  return {model.diffuse * n_dot_l, model.specular * (lobe * weight)};
}

// Fresnel's term of dielectric and metal for one channel, each times its share of the mix.
struct FresnelShares {
  double dielectric = 0, metal = 0;
};

FresnelShares SharesOf(const MicrofacetModel& model, double v_dot_h, double one_minus_vh, int c) {
  const double metallic = model.metallic;
  switch (model.fresnel) {
    case FresnelForm::kSchlick:
    case FresnelForm::kF82:
      return {(1 - metallic) * FresnelSchlick(model.dielectric_f0[c], model.dielectric_f90,
                                              Power5(one_minus_vh)),
              metallic * FresnelF82(v_dot_h, one_minus_vh, model.metal_f0[c], model.f82_slope[c])};
    case FresnelForm::kDielectric:
      return {.dielectric = FresnelDielectric(v_dot_h, one_minus_vh, model.eta[c])};
    case FresnelForm::kConductor:
      return {.metal = FresnelConductor(v_dot_h, one_minus_vh, model.eta[c], model.k[c])};
  }
  return {};
}

// The fraction of the light of channel c that reaches the base and leaves it again.
double BaseShare(const MicrofacetModel& model, const Angles<double>& a, double fresnel, int c) {
  switch (model.coupling) {
    case DiffuseCoupling::kAlbedoScaled: {
      const double out = 1 - CoverAlbedo(model, a.n_dot_v, c);
      const bool reciprocal = model.compensation == Compensation::kKullaConty;
      return reciprocal ? out * (1 - CoverAlbedo(model, a.n_dot_l, c)) : out;
    }
    case DiffuseCoupling::kOneMinusFresnel:
      return 1 - fresnel;
    case DiffuseCoupling::kNone:
      break;
  }
  return 1;
}

Reflection ReflectModel(const MicrofacetModel& model, const Vec3d& n, const Vec3d& l,
                        const Vec3d& v) {
  const Angles<double> a = ComputeAngles(n, l, v);
  const Rgb fresnel = FresnelOf(model, VDotH(a), OneMinusVDotH(a));
  const Rgb turquin = TurquinTerm(model, VDotH(a), OneMinusVDotH(a));
  const double lobe = GgxDistribution(a, model.alpha) * VisibilityOf(model, a.n_dot_l, a.n_dot_v);
  const double loss_v = AlbedoLoss(model.albedo.lobe, a.n_dot_v);
  const double loss_l = AlbedoLoss(model.albedo.lobe, a.n_dot_l);
  Reflection out;
  for (int c = 0; c < 3; ++c) {
    double specular = fresnel[c] * lobe;
    if (model.compensation == Compensation::kTurquin) {
      specular += turquin[c] * lobe * loss_v / (1 - loss_v);
    } else if (model.compensation == Compensation::kKullaConty) {
      specular += model.f_multiple[c] * model.multiple * loss_v * loss_l;
    }
    out.specular[c] = specular * a.n_dot_l;
    const double spread = SpreadOf(model.base_form, a, model.base_roughness, model.base_ratio[c]);
    out.diffuse[c] = BaseShare(model, a, fresnel[c], c) * model.diffuse[c] * spread * a.n_dot_l;
  }
  return out;
}

Reflection ReflectModel(const UserModel& model, const Vec3d& n, const Vec3d& l, const Vec3d& v) {
  return ReflectUser(model, n, l, v);
}

Reflection ReflectModel(const std::monostate&, const Vec3d&, const Vec3d&, const Vec3d&) {
  return {};
}

Reflection ReflectModel(const ShadingMaterial& material, const Vec3d& n, const Vec3d& l,
                        const Vec3d& v) {
  return std::visit([&](const auto& model) { return ReflectModel(model, n, l, v); },
                    material.model);
}

bool IsAbove(const Vec3d& n, const Vec3d& l, const Vec3d& v) { return (n ^ l) > 0 && (n ^ v) > 0; }

double CosineTo(const Vec3d& n, const Vec3d& v) { return std::clamp(n ^ v, 0.0, 1.0); }

// The light's direction mirrored in the surface without normal maps.
Vec3d MirroredAtHorizon(const Vec3d& unmapped, const Vec3d& l) {
  return l - unmapped * (2 * (unmapped ^ l));
}

bool IsBelowHorizon(const StackNormals& normals, const Vec3d& l) {
  return normals.unmapped && !((*normals.unmapped ^ l) > 0);
}

// A sample of a glossy lobe, mirrored in the horizon if it is below.
Vec3d RaisedAboveHorizon(const StackNormals& normals, const Vec3d& n, const Vec3d& l) {
  return IsBelowHorizon(normals, l) && (n ^ l) > 0 ? MirroredAtHorizon(*normals.unmapped, l) : l;
}

// The pdf of such samples, of which pdf(l) is that of the lobe.
template <class Pdf>
double WithMirroredPdf(const StackNormals& normals, const Vec3d& n, const Vec3d& l,
                       const Pdf& pdf) {
  if (!normals.unmapped) return pdf(l);
  if (IsBelowHorizon(normals, l)) return (n ^ l) > 0 ? 0 : pdf(l);
  const Vec3d below = MirroredAtHorizon(*normals.unmapped, l);
  return (n ^ below) > 0 ? pdf(l) + pdf(below) : pdf(l);
}

// The glossy light that a model with layers reflects from l mirrored in the horizon.
Rgb MirroredLobe(const ShadingMaterial& material, const StackNormals& normals, const Vec3d& n,
                 const Vec3d& l, const Vec3d& v) {
  if (!normals.unmapped) return Rgb(0, 0, 0);
  const Vec3d below = MirroredAtHorizon(*normals.unmapped, l);
  if (!IsAbove(n, below, v)) return Rgb(0, 0, 0);
  Reflection reflected = ReflectModel(material, n, below, v);
  const Angles<double> angles = ComputeAngles(n, below, v);
  for (const LayerModel& layer : material.layers) {
    const LayerReflection terms = EvaluateLayer(layer, angles);
    reflected.specular *= terms.below;
    ComponentOf(KindOf(layer), reflected) += terms.lobe;
  }
  return reflected.specular;
}

// Calls use(level) from the bottom up.
template <class Use>
void ForEachLevel(const ShadingMaterial& material, const StackNormals& normals, const Vec3d& l,
                  const Vec3d& v, const Use& use) {
  if (IsBelowHorizon(normals, l)) return;
  const Vec3d& n = normals.model;
  if (IsAbove(n, l, v)) {
    use(StackLevel{"model", 0, ReflectModel(material, n, l, v), Rgb(0, 0, 0)});
    const Angles<double> angles = ComputeAngles(n, l, v);
    for (size_t k = 0; k < material.layers.size(); ++k) {
      const LayerModel& layer = material.layers[k];
      const LayerReflection terms = EvaluateLayer(layer, angles);
      StackLevel level{NameOf(layer), k, {}, Rgb(terms.below)};
      ComponentOf(KindOf(layer), level.own) = terms.lobe;
      use(level);
    }
  }
  const Rgb mirrored = MirroredLobe(material, normals, n, l, v);
  if (!IsBlack(mirrored)) use(StackLevel{kMirroredLevel, 0, {Rgb(0), mirrored}, Rgb(1)});
  for (size_t k = 0; k < material.coats.size(); ++k) {
    const ShadingMaterial& coat = *material.coats[k];
    const Vec3d& m = normals.coat(k);
    Reflection own = IsAbove(m, l, v) ? ReflectModel(coat, m, l, v) : Reflection{};
    own.specular += MirroredLobe(coat, normals, m, l, v);
    use(StackLevel{"coat", k, own, TransmittedByCoat(coat, CosineTo(m, v))});
  }
}

// --- Sampling.

// The lobes that GGX and Kulla and Conty's compensation sample, as lobe_kernel.cc does.
double KullaContyChance(const MicrofacetModel& model, double n_dot_v) {
  if (model.compensation != Compensation::kKullaConty || !(model.multiple > 0)) return 0;
  const double loss = AlbedoLoss(model.albedo.lobe, n_dot_v);
  const double f0 = LargestChannel(model.f0);
  const double single = (f0 + (model.f90 - f0) / 21) * (1 - loss) * (model.delta ? 0 : 1);
  return Fraction(LargestChannel(model.f_multiple) * loss, single);
}

Vec3d SampleUnmirrored(const ShadingMaterial& material, const Vec3d& n, const Vec3d& v, double u0,
                       double u1) {
  if (const auto* user = std::get_if<UserModel>(&material.model)) {
    return SampleUser(*user, n, v, u0, u1);
  }
  if (const auto* phong = std::get_if<PhongFamilyModel>(&material.model)) {
    return phong->model == PhongModel::kBlinnPhong
               ? SampleBlinnLobe(n, v, phong->shininess, u0, u1)
               : SamplePhongLobe(n, v, phong->shininess, u0, u1);
  }
  const auto& model = std::get<MicrofacetModel>(material.model);
  Chooser chooser(u0);
  if (chooser.Takes(KullaContyChance(model, CosineTo(n, v)))) {
    const double spread = KullaContySpread(model.albedo.lobe.shape);
    return SampleKullaConty(n, spread, chooser.rest(), u1);
  }
  return SampleGgxVisible(n, v, model.alpha, chooser.rest(), u1);
}

// Samples the model's glossy lobe.
Vec3d SampleLobeOf(const ShadingMaterial& material, const StackNormals& normals, const Vec3d& n,
                   const Vec3d& v, double u0, double u1) {
  const Vec3d l = SampleUnmirrored(material, n, v, u0, u1);
  return RaisedAboveHorizon(normals, n, l);
}

double UnmirroredPdf(const ShadingMaterial& material, const Vec3d& n, const Vec3d& v,
                     const Vec3d& l) {
  if (const auto* user = std::get_if<UserModel>(&material.model)) return UserPdf(*user, n, v, l);
  if (const auto* phong = std::get_if<PhongFamilyModel>(&material.model)) {
    return phong->model == PhongModel::kBlinnPhong ? BlinnLobePdf(n, v, l, phong->shininess)
                                                   : PhongLobePdf(n, v, l, phong->shininess);
  }
  const auto& model = std::get<MicrofacetModel>(material.model);
  const double chance = KullaContyChance(model, CosineTo(n, v));
  const double single = (1 - chance) * GgxVisiblePdf(n, v, l, model.alpha);
  if (chance == 0) return single;
  return single + chance * KullaContyPdf(n ^ l, double{KullaContySpread(model.albedo.lobe.shape)});
}

// The pdf of SampleLobeOf, whose directions below the horizon are mirrored in it.
double LobePdfOf(const ShadingMaterial& material, const StackNormals& normals, const Vec3d& n,
                 const Vec3d& v, const Vec3d& l) {
  if (!HasSampledLobe(material)) return 0;
  return WithMirroredPdf(normals, n, l, [&](const Vec3d& to_light) {
    return UnmirroredPdf(material, n, v, to_light);
  });
}

// The probabilities in a stack at one view direction.
struct StackChances {
  KindChances kind;
  std::array<double, kMostCoats> coats{};  // of each coat among the glossy lobes up to it
  std::vector<double> layers;              // of each layer among the lobes of its kind up to it
};

StackChances ChancesOf(const ShadingMaterial& material, const StackNormals& normals, const Vec3d& v,
                       bool mirrors) {
  const double n_dot_v = CosineTo(normals.model, v);
  std::vector<CoatInView> coats;
  for (size_t k = 0; k < material.coats.size(); ++k) {
    const ShadingMaterial& coat = *material.coats[k];
    const double n_dot_v_of_coat = CosineTo(normals.coat(k), v);
    coats.push_back({CoatAlbedo(coat, n_dot_v_of_coat), TransmittedByCoat(coat, n_dot_v_of_coat),
                     HasDeltaLobe(coat)});
  }
  const ModelAlbedos albedos = AlbedosOf(material, n_dot_v);
  StackChances chances;
  chances.kind = ChancesOfKinds(material.layers, n_dot_v, albedos, coats, mirrors);
  FindCoatChances(coats, albedos.glossy, chances.coats);
  for (const LayerModel& layer : material.layers) {
    const bool diffuse = KindOf(layer) == LobeKind::kDiffuse;
    const double below = diffuse ? BaseAlbedo(material) : albedos.glossy;
    chances.layers.push_back(LayerChance(layer, n_dot_v, below));
  }
  return chances;
}

// Samples the lobes of one kind, without mirrors.
Vec3d SampleKind(const ShadingMaterial& material, const StackNormals& normals,
                 const StackChances& chances, LobeKind kind, const Vec3d& v, double u0, double u1) {
  Chooser chooser(u0);
  const Vec3d& n = normals.model;
  if (kind == LobeKind::kGlossy) {
    for (size_t k = material.coats.size(); k-- > 0;) {
      if (!chooser.Takes(chances.coats[k])) continue;
      return SampleLobeOf(*material.coats[k], normals, normals.coat(k), v, chooser.rest(), u1);
    }
  }
  for (size_t k = material.layers.size(); k-- > 0;) {
    if (KindOf(material.layers[k]) != kind || !chooser.Takes(chances.layers[k])) continue;
    const Vec3d l = SampleLayer(material.layers[k], n, v, chooser.rest(), u1);
    return kind == LobeKind::kGlossy ? RaisedAboveHorizon(normals, n, l) : l;
  }
  return kind == LobeKind::kDiffuse ? SampleCosine(n, chooser.rest(), u1)
                                    : SampleLobeOf(material, normals, n, v, chooser.rest(), u1);
}

double KindPdf(const ShadingMaterial& material, const StackNormals& normals,
               const StackChances& chances, LobeKind kind, const Vec3d& v, const Vec3d& l) {
  const Vec3d& n = normals.model;
  double pdf = 0, left = 1;
  for (size_t k = kind == LobeKind::kGlossy ? material.coats.size() : 0; k-- > 0;) {
    if (!(chances.coats[k] > 0)) continue;
    pdf += left * chances.coats[k] * LobePdfOf(*material.coats[k], normals, normals.coat(k), v, l);
    left *= 1 - chances.coats[k];
  }
  for (size_t k = material.layers.size(); k-- > 0;) {
    if (KindOf(material.layers[k]) != kind) continue;
    const auto layer_pdf = [&](const Vec3d& to_light) {
      return LayerPdf(material.layers[k], ComputeAngles(n, to_light, v));
    };
    pdf += left * chances.layers[k] *
           (kind == LobeKind::kGlossy ? WithMirroredPdf(normals, n, l, layer_pdf) : layer_pdf(l));
    left *= 1 - chances.layers[k];
  }
  if (!(left > 0)) return pdf;
  return pdf + left * (kind == LobeKind::kDiffuse ? CosinePdf(n ^ l)
                                                  : LobePdfOf(material, normals, n, v, l));
}

double PdfOf(const ShadingMaterial& material, const StackNormals& normals,
             const StackChances& chances, const Vec3d& v, const Vec3d& l) {
  double pdf = 0;
  for (const LobeKind kind : {LobeKind::kDiffuse, LobeKind::kGlossy}) {
    const double chance = kind == LobeKind::kDiffuse ? chances.kind.diffuse : chances.kind.glossy;
    if (chance > 0) pdf += chance * KindPdf(material, normals, chances, kind, v, l);
  }
  return pdf;
}

// A sample of the mirror at a level: of the model (0) or of a coat (1 + k).
ReflectionSample SampleMirrorAt(size_t level, const ShadingMaterial& material,
                                const StackNormals& normals, const Vec3d& v, double chance) {
  const Vec3d& n = level == 0 ? normals.model : normals.coat(level - 1);
  const ShadingMaterial& mirror = level == 0 ? material : *material.coats[level - 1];
  const double n_dot_v = CosineTo(n, v);
  Rgb reflectance = MirrorReflectance(std::get<MicrofacetModel>(mirror.model), n_dot_v);
  if (level == 0) {
    for (const LayerModel& layer : material.layers) {
      reflectance *= LayerAlbedo(layer, n_dot_v).below;
    }
  }
  for (size_t k = level; k < material.coats.size(); ++k) {
    reflectance *= TransmittedByCoat(*material.coats[k], CosineTo(normals.coat(k), v));
  }
  return {Mirrored(v, n), reflectance / chance, chance, LobeKind::kDelta};
}

}  // namespace

Reflection Reflect(const ShadingMaterial& material, const StackNormals& normals,
                   const Vec3d& to_light, const Vec3d& to_view) {
  Reflection sum;
  ForEachLevel(material, normals, to_light, to_view, [&](const StackLevel& level) {
    sum = {sum.diffuse * level.below + level.own.diffuse,
           sum.specular * level.below + level.own.specular};
  });
  return sum;
}

std::vector<StackLevel> ReflectByLevel(const ShadingMaterial& material, const StackNormals& normals,
                                       const Vec3d& to_light, const Vec3d& to_view) {
  std::vector<StackLevel> levels;
  ForEachLevel(material, normals, to_light, to_view,
               [&](const StackLevel& level) { levels.push_back(level); });
  return levels;
}

ReflectionSample SampleReflection(const ShadingMaterial& material, const StackNormals& normals,
                                  const Vec3d& to_view, double u0, double u1, bool mirrors) {
  const StackChances chances = ChancesOf(material, normals, to_view, mirrors);
  Chooser chooser(u0);
  const size_t chosen = ChooseKind(chances.kind, &chooser);
  if (chosen >= kMirrorChosen) {
    const size_t level = chosen - kMirrorChosen;
    return SampleMirrorAt(level, material, normals, to_view, chances.kind.mirror[level]);
  }
  ReflectionSample sample;
  sample.kind = chosen == kGlossyChosen ? LobeKind::kGlossy : LobeKind::kDiffuse;
  sample.to_light =
      SampleKind(material, normals, chances, sample.kind, to_view, chooser.rest(), u1);
  sample.pdf = PdfOf(material, normals, chances, to_view, sample.to_light);
  if (sample.pdf > 0) {
    sample.weight = Reflect(material, normals, sample.to_light, to_view).Sum() / sample.pdf;
  }
  return sample;
}

double ReflectionPdf(const ShadingMaterial& material, const StackNormals& normals,
                     const Vec3d& to_view, const Vec3d& to_light, bool mirrors) {
  return PdfOf(material, normals, ChancesOf(material, normals, to_view, mirrors), to_view,
               to_light);
}

Rgb MirrorReflectance(const MicrofacetModel& model, double n_dot_v) {
  const Rgb fresnel = FresnelOf(model, n_dot_v, 1 - n_dot_v);
  if (model.shadowing != Shadowing::kSchlickDirect) return fresnel;
  const double g1 = n_dot_v / (n_dot_v * (1 - model.schlick_k) + model.schlick_k);
  const double single = g1 * g1;
  if (model.compensation != Compensation::kTurquin) return fresnel * single;
  return fresnel * single + TurquinTerm(model, n_dot_v, 1 - n_dot_v) * (1 - single);
}

Rgb FresnelOf(const MicrofacetModel& model, double v_dot_h, double one_minus_vh) {
  Rgb fresnel;
  for (int c = 0; c < 3; ++c) {
    const auto [dielectric, metal] = SharesOf(model, v_dot_h, one_minus_vh, c);
    fresnel[c] = dielectric + metal;
  }
  return fresnel;
}

Rgb TurquinTerm(const MicrofacetModel& model, double v_dot_h, double one_minus_vh) {
  Rgb term;
  for (int c = 0; c < 3; ++c) {
    const auto [dielectric, metal] = SharesOf(model, v_dot_h, one_minus_vh, c);
    term[c] = model.dielectric_f0[c] * dielectric + model.metal_f0[c] * metal;
  }
  return term;
}

double VisibilityOf(const MicrofacetModel& model, double n_dot_l, double n_dot_v) {
  switch (model.shadowing) {
    case Shadowing::kHeightCorrelated:
      return VisibilityHeightCorrelated(n_dot_l, n_dot_v, model.alpha);
    case Shadowing::kSeparable:
      return VisibilitySeparable(n_dot_l, n_dot_v, model.alpha);
    case Shadowing::kSchlickDirect:
    case Shadowing::kSchlickIbl:
      break;
  }
  return VisibilitySchlick(n_dot_l, n_dot_v, model.schlick_k);
}

}  // namespace nacre
