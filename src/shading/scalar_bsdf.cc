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
#include "brdf/ggx_anisotropic.h"
#include "brdf/lobe_sampling.h"
#include "brdf/measured.h"
#include "brdf/phong.h"
#include "shading/anisotropic_lobe.h"
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

// The frame of a lobe: tangent, bitangent and normal. Models without anisotropic lobes read only
// the normal.
using Frame = Basis<double>;

Reflection ReflectModel(const MatteModel& model, const Frame& frame, const Vec3d& l,
                        const Vec3d& v) {
  const Angles<double> a = ComputeAngles(frame.z, l, v);
  Reflection out;
  for (int c = 0; c < 3; ++c) {
    out.diffuse[c] =
        model.diffuse[c] * a.n_dot_l * SpreadOf(model.form, a, model.roughness, model.ratio[c]);
  }
  return out;
}

Reflection ReflectModel(const PhongFamilyModel& model, const Frame& frame, const Vec3d& l,
                        const Vec3d& v) {
  const Vec3d& n = frame.z;
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
    case FresnelForm::kThinFilm: {
      const auto reflected = [&](const FresnelTable& table) {
        return 1 - FresnelTableLoss(table, v_dot_h)[static_cast<size_t>(c)];
      };
      return {(1 - metallic) * model.dielectric_scale[c] * reflected(model.film->dielectric),
              metallic * model.metal_scale * reflected(model.film->metal)};
    }
    case FresnelForm::kOpenPbr:
      return {(1 - metallic) * model.dielectric_scale[c] *
                  FresnelCoatedDielectric(v_dot_h, one_minus_vh, model.dielectric),
              metallic * model.metal_scale *
                  FresnelF82(v_dot_h, one_minus_vh, model.metal_f0[c], model.f82_slope[c])};
  }
  return {};
}

// The fraction of the light of channel c that reaches the base and leaves it again.
double BaseShare(const MicrofacetModel& model, const LobeCosines& l, const LobeCosines& v,
                 double fresnel, int c) {
  switch (model.coupling) {
    case DiffuseCoupling::kAlbedoScaled: {
      const double out = 1 - CoverAlbedo(model, v, c);
      return model.reciprocal ? out * (1 - CoverAlbedo(model, l, c)) : out;
    }
    case DiffuseCoupling::kOneMinusFresnel:
      return 1 - fresnel;
    case DiffuseCoupling::kNone:
      break;
  }
  return 1;
}

GgxTerms TermsOf(const MicrofacetModel& model, const FrameAngles<double>& a) {
  if (!model.anisotropic) {
    const Angles<double>& isotropic = a;
    return {GgxDistribution(isotropic, model.alpha), VisibilityOf(model, a.n_dot_l, a.n_dot_v)};
  }
  const GgxAlphas<double>& alpha = model.anisotropic->alpha;
  return {GgxDistribution(a, alpha), model.shadowing == Shadowing::kSeparable
                                         ? VisibilitySeparable(a, alpha)
                                         : VisibilityHeightCorrelated(a, alpha)};
}

Reflection ReflectModel(const MicrofacetModel& model, const Frame& frame, const Vec3d& l,
                        const Vec3d& v) {
  const FrameAngles<double> a = ComputeAngles(frame, l, v);
  const LobeCosines to_light = CosinesTo(frame, l), to_view = CosinesTo(frame, v);
  const Rgb fresnel = FresnelOf(model, VDotH(a), OneMinusVDotH(a));
  const Rgb turquin = TurquinTerm(model, VDotH(a), OneMinusVDotH(a));
  const auto [distribution, visibility] = TermsOf(model, a);
  const double lobe = distribution * visibility;
  const double loss_v = LossOf(model, to_view), loss_l = LossOf(model, to_light);
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
    const double share = BaseShare(model, to_light, to_view, fresnel[c], c);
    out.diffuse[c] = share * model.diffuse[c] * spread * a.n_dot_l;
  }
  return out;
}

Reflection ReflectModel(const UserModel& model, const Frame& frame, const Vec3d& l,
                        const Vec3d& v) {
  return ReflectUser(model, frame.z, l, v);
}

Reflection ReflectModel(const MeasuredModel& model, const Frame& frame, const Vec3d& l,
                        const Vec3d& v) {
  return {Rgb(0), EvaluateMeasured(*model.brdf, model.interpolation, frame, l, v)};
}

Reflection ReflectModel(const std::monostate&, const Frame&, const Vec3d&, const Vec3d&) {
  return {};
}

Reflection ReflectModel(const ShadingMaterial& material, const Frame& frame, const Vec3d& l,
                        const Vec3d& v) {
  return std::visit([&](const auto& model) { return ReflectModel(model, frame, l, v); },
                    material.model);
}

Frame FrameOf(const ShadingMaterial& material, const Vec3d& normal,
              const std::optional<Vec3d>& tangent) {
  const auto* const model = std::get_if<MicrofacetModel>(&material.model);
  const auto* const measured = std::get_if<MeasuredModel>(&material.model);
  const bool is_anisotropic =
      measured != nullptr ? !measured->brdf->isotropic : model != nullptr && model->anisotropic;
  if (!is_anisotropic) return {{}, {}, normal};
  return LobeFrame(normal, tangent ? *tangent : DefaultTangent(material, normal));
}

// Of a viewer whose cosine rounding, or an interpolated normal, may put below 0.
LobeCosines ViewIn(const Frame& frame, const Vec3d& v) {
  LobeCosines at = CosinesTo(frame, v);
  at.n = std::clamp(at.n, 0.0, 1.0);
  return at;
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
Rgb MirroredLobe(const ShadingMaterial& material, const StackNormals& normals, const Frame& frame,
                 const Vec3d& l, const Vec3d& v) {
  if (!normals.unmapped) return Rgb(0, 0, 0);
  const Vec3d& n = frame.z;
  const Vec3d below = MirroredAtHorizon(*normals.unmapped, l);
  if (!IsAbove(n, below, v)) return Rgb(0, 0, 0);
  Reflection reflected = ReflectModel(material, frame, below, v);
  const LayerAngles angles = LayerAnglesOf(n, below, v);
  for (const LayerModel& layer : material.layers) {
    if (LiesOverCoats(layer)) continue;
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
  const auto use_layers = [&](bool over_coats) {
    LayerAngles angles = LayerAnglesOf(n, l, v);
    if (!over_coats && !IsAbove(n, l, v)) return;
    // Coats with other normals may face the light where the model does not.
    angles.n_dot_l = std::max(angles.n_dot_l, 0.0);
    angles.n_dot_v = std::max(angles.n_dot_v, 0.0);
    for (size_t k = 0; k < material.layers.size(); ++k) {
      const LayerModel& layer = material.layers[k];
      if (LiesOverCoats(layer) != over_coats) continue;
      const LayerReflection terms = EvaluateLayer(layer, angles);
      StackLevel level{NameOf(layer), k, {}, Rgb(terms.below)};
      ComponentOf(KindOf(layer), level.own) = terms.lobe;
      use(level);
    }
  };
  const Frame frame = FrameOfModel(material, normals);
  if (IsAbove(n, l, v)) {
    use(StackLevel{"model", 0, ReflectModel(material, frame, l, v), Rgb(0, 0, 0)});
  }
  use_layers(false);
  const Rgb mirrored = MirroredLobe(material, normals, frame, l, v);
  if (!IsBlack(mirrored)) use(StackLevel{kMirroredLevel, 0, {Rgb(0), mirrored}, Rgb(1)});
  for (size_t k = 0; k < material.coats.size(); ++k) {
    const ShadingMaterial& coat = *material.coats[k];
    const Frame of_coat = FrameOfCoat(material, normals, k);
    const Vec3d& m = of_coat.z;
    Reflection own = IsAbove(m, l, v) ? ReflectModel(coat, of_coat, l, v) : Reflection{};
    own.specular += MirroredLobe(coat, normals, of_coat, l, v);
    use(StackLevel{"coat", k, own, TransmittedByCoat(coat, ViewIn(of_coat, v), CosineTo(m, l))});
  }
  use_layers(true);
}

// --- Sampling.

// The lobes that GGX and Kulla and Conty's compensation sample, as lobe_kernel.cc does.
double KullaContyChance(const MicrofacetModel& model, const LobeCosines& v) {
  if (model.compensation != Compensation::kKullaConty || !(model.multiple > 0)) return 0;
  const double loss = LossOf(model, v);
  const double f0 = LargestChannel(model.f0);
  const double single = (f0 + (model.f90 - f0) / 21) * (1 - loss) * (model.delta ? 0 : 1);
  return Fraction(LargestChannel(model.f_multiple) * loss, single);
}

Vec3d SampleUnmirrored(const ShadingMaterial& material, const Frame& frame, const Vec3d& v,
                       double u0, double u1) {
  const Vec3d& n = frame.z;
  if (const auto* user = std::get_if<UserModel>(&material.model)) {
    return SampleUser(*user, n, v, u0, u1);
  }
  if (const auto* measured = std::get_if<MeasuredModel>(&material.model)) {
    return SampleMeasured(*measured->brdf, frame, v, u0, u1);
  }
  if (const auto* phong = std::get_if<PhongFamilyModel>(&material.model)) {
    return phong->model == PhongModel::kBlinnPhong
               ? SampleBlinnLobe(n, v, phong->shininess, u0, u1)
               : SamplePhongLobe(n, v, phong->shininess, u0, u1);
  }
  const auto& model = std::get<MicrofacetModel>(material.model);
  Chooser chooser(u0);
  if (chooser.Takes(KullaContyChance(model, ViewIn(frame, v)))) {
    const double spread = KullaContySpread(model.albedo.lobe.shape);
    return SampleKullaConty(n, spread, chooser.rest(), u1);
  }
  if (model.anisotropic) {
    return SampleGgxVisible(frame, v, model.anisotropic->alpha, chooser.rest(), u1);
  }
  return SampleGgxVisible(n, v, model.alpha, chooser.rest(), u1);
}

// Samples the model's glossy lobe.
Vec3d SampleLobeOf(const ShadingMaterial& material, const StackNormals& normals, const Frame& frame,
                   const Vec3d& v, double u0, double u1) {
  const Vec3d l = SampleUnmirrored(material, frame, v, u0, u1);
  return RaisedAboveHorizon(normals, frame.z, l);
}

double UnmirroredPdf(const ShadingMaterial& material, const Frame& frame, const Vec3d& v,
                     const Vec3d& l) {
  const Vec3d& n = frame.z;
  if (const auto* user = std::get_if<UserModel>(&material.model)) return UserPdf(*user, n, v, l);
  if (const auto* measured = std::get_if<MeasuredModel>(&material.model)) {
    return MeasuredPdf(*measured->brdf, frame, v, l);
  }
  if (const auto* phong = std::get_if<PhongFamilyModel>(&material.model)) {
    return phong->model == PhongModel::kBlinnPhong ? BlinnLobePdf(n, v, l, phong->shininess)
                                                   : PhongLobePdf(n, v, l, phong->shininess);
  }
  const auto& model = std::get<MicrofacetModel>(material.model);
  const double chance = KullaContyChance(model, ViewIn(frame, v));
  const double visible = model.anisotropic
                             ? GgxVisiblePdf(ComputeAngles(frame, l, v), model.anisotropic->alpha)
                             : GgxVisiblePdf(n, v, l, model.alpha);
  const double single = (1 - chance) * visible;
  if (chance == 0) return single;
  return single + chance * KullaContyPdf(n ^ l, double{KullaContySpread(model.albedo.lobe.shape)});
}

// The pdf of SampleLobeOf, whose directions below the horizon are mirrored in it.
double LobePdfOf(const ShadingMaterial& material, const StackNormals& normals, const Frame& frame,
                 const Vec3d& v, const Vec3d& l) {
  if (!HasSampledLobe(material)) return 0;
  return WithMirroredPdf(normals, frame.z, l, [&](const Vec3d& to_light) {
    return UnmirroredPdf(material, frame, v, to_light);
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
    const LobeCosines of_coat = ViewIn(FrameOfCoat(material, normals, k), v);
    coats.push_back({CoatAlbedo(coat, of_coat), TransmittedByCoat(coat, of_coat, of_coat.n),
                     HasDeltaLobe(coat)});
  }
  const ModelAlbedos albedos = AlbedosOf(material, ViewIn(FrameOfModel(material, normals), v));
  StackChances chances;
  chances.kind = ChancesOfKinds(material.layers, n_dot_v, albedos, coats, mirrors);
  double diffuse = BaseAlbedo(material), glossy = albedos.glossy;
  for (const LayerModel& layer : material.layers) {
    double& below = KindOf(layer) == LobeKind::kDiffuse ? diffuse : glossy;
    const LayerChance with = ChanceOf(layer, n_dot_v, below);
    chances.layers.push_back(with.chance);
    below = with.albedo;
  }
  FindCoatChances(coats, glossy, chances.coats);
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
      return SampleLobeOf(*material.coats[k], normals, FrameOfCoat(material, normals, k), v,
                          chooser.rest(), u1);
    }
  }
  for (size_t k = material.layers.size(); k-- > 0;) {
    if (KindOf(material.layers[k]) != kind || !chooser.Takes(chances.layers[k])) continue;
    const Vec3d l = SampleLayer(material.layers[k], n, v, chooser.rest(), u1);
    return kind == LobeKind::kGlossy ? RaisedAboveHorizon(normals, n, l) : l;
  }
  if (kind == LobeKind::kDiffuse) return SampleCosine(n, chooser.rest(), u1);
  return SampleLobeOf(material, normals, FrameOfModel(material, normals), v, chooser.rest(), u1);
}

double KindPdf(const ShadingMaterial& material, const StackNormals& normals,
               const StackChances& chances, LobeKind kind, const Vec3d& v, const Vec3d& l) {
  const Vec3d& n = normals.model;
  double pdf = 0, left = 1;
  for (size_t k = kind == LobeKind::kGlossy ? material.coats.size() : 0; k-- > 0;) {
    if (!(chances.coats[k] > 0)) continue;
    pdf += left * chances.coats[k] *
           LobePdfOf(*material.coats[k], normals, FrameOfCoat(material, normals, k), v, l);
    left *= 1 - chances.coats[k];
  }
  for (size_t k = material.layers.size(); k-- > 0;) {
    if (KindOf(material.layers[k]) != kind) continue;
    const auto layer_pdf = [&](const Vec3d& to_light) {
      return LayerPdf(material.layers[k], LayerAnglesOf(n, to_light, v));
    };
    pdf += left * chances.layers[k] *
           (kind == LobeKind::kGlossy ? WithMirroredPdf(normals, n, l, layer_pdf) : layer_pdf(l));
    left *= 1 - chances.layers[k];
  }
  if (!(left > 0)) return pdf;
  const double of_model = kind == LobeKind::kDiffuse
                              ? CosinePdf(n ^ l)
                              : LobePdfOf(material, normals, FrameOfModel(material, normals), v, l);
  return pdf + left * of_model;
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
  for (const LayerModel& layer : material.layers) {
    if (level > 0 && !LiesOverCoats(layer)) continue;
    reflectance *= LayerAlbedo(layer, CosineTo(normals.model, v)).below;
  }
  const Vec3d l = Mirrored(v, n);
  for (size_t k = level; k < material.coats.size(); ++k) {
    const Frame of_coat = FrameOfCoat(material, normals, k);
    reflectance *=
        TransmittedByCoat(*material.coats[k], ViewIn(of_coat, v), CosineTo(of_coat.z, l));
  }
  return {l, reflectance / chance, chance, LobeKind::kDelta};
}

}  // namespace

GgxTerms GgxTermsOf(const MicrofacetModel& model, const Basis<double>& frame, const Vec3d& to_light,
                    const Vec3d& to_view) {
  return TermsOf(model, ComputeAngles(frame, to_light, to_view));
}

Basis<double> FrameOfModel(const ShadingMaterial& material, const StackNormals& normals) {
  return FrameOf(material, normals.model, normals.tangent);
}

Basis<double> FrameOfCoat(const ShadingMaterial& material, const StackNormals& normals, size_t k) {
  std::optional<Vec3d> tangent;
  if (!normals.coat_tangents.empty()) tangent = normals.coat_tangents[k];
  return FrameOf(*material.coats[k], normals.coat(k), tangent);
}

Vec3d DefaultTangent(const ShadingMaterial& material, const Vec3d& normal) {
  return RotatedTangent(normal, LobeFrame(normal, Vec3d(1, 0, 0)).x, material.tangent_turn);
}

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
