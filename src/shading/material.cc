// SPDX-License-Identifier: Apache-2.0
#include "shading/material.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "base/error.h"
#include "base/memo.h"
#include "base/overloaded.h"
#include "brdf/eon.h"
#include "brdf/fresnel.h"
#include "brdf/ggx.h"
#include "brdf/multi_scatter.h"
#include "brdf/phong.h"
#include "scene/coat.h"
#include "scene/material_parameters.h"
#include "shading/derive.h"
#include "shading/open_pbr.h"
#include "shading/thin_film.h"

namespace nacre {
namespace {

Rgb EonRatio(const Rgb& albedo, double roughness) {
  return MakeRgb([&](int c) { return EonMultipleRatio(albedo[c], roughness); });
}

MatteModel MakeMatte(DiffuseForm form, const Rgb& albedo, double roughness) {
  MatteModel model{.form = form,
                   .diffuse = MakeRgb([&](int c) { return DeriveDiffuse(albedo[c]); }),
                   .roughness = roughness};
  if (form == DiffuseForm::kOrenNayar) model.ratio = EonRatio(albedo, roughness);
  return model;
}

MatteModel MakeModel(const LambertMaterial& material) {
  return MakeMatte(DiffuseForm::kLambert, material.albedo, 0);
}

MatteModel MakeModel(const OrenNayarMaterial& material) {
  return MakeMatte(DiffuseForm::kOrenNayar, material.albedo, material.roughness);
}

MatteModel MakeModel(const BurleyMaterial& material) {
  return MakeMatte(DiffuseForm::kBurley, material.albedo, material.roughness);
}

PhongFamilyModel MakeModel(const PhongMaterial& material) {
  PhongFamilyModel model;
  model.model = material.model;
  model.shininess = material.shininess;
  model.double_terms = material.shininess > kDoubleTermsShininess;
  const double scale = DerivePhongScale(material.model, material.convention, material.shininess);
  for (int c = 0; c < 3; ++c) {
    const PhongChannel at =
        DerivePhong(material.convention, material.kd[c], material.color[c], material.ks[c], scale);
    model.diffuse[c] = at.diffuse;
    model.specular[c] = at.specular;
  }
  return model;
}

// Makes what all microfacet materials have in common. The caller adds the Fresnel curve and the
// base.
template <class Microfacet>
MicrofacetModel MakeLobe(const Microfacet& material) {
  MicrofacetModel model{};
  model.shadowing = material.shadowing;
  model.compensation = material.compensation;
  model.coupling = DiffuseCoupling::kNone;
  const LobeWidth width = DeriveWidth(material.shadowing, material.roughness);
  PutWidth(width, Rounded(), &model.constants);
  model.alpha = width.alpha;
  model.schlick_k = width.schlick_k;
  model.delta = width.delta;
  model.double_terms = width.sharp_alpha >= 0;
  model.albedo.lobe = MakeAlbedoFit(material.shadowing, material.roughness);
  return model;
}

// Sets the form of the diffuse base. EON at roughness 0 is Lambertian.
template <class Microfacet>
void PrepareBase(const Microfacet& material, MicrofacetModel* model) {
  model->base_roughness = material.diffuse_roughness.value_or(material.roughness);
  model->base_form = material.diffuse;
  if (model->base_form != DiffuseForm::kOrenNayar) return;
  model->base_ratio = EonRatio(material.base_color, model->base_roughness);
  if (model->base_roughness == 0) model->base_form = DiffuseForm::kLambert;
}

AlbedoAverages AveragesOf(const MicrofacetModel& model, int channel) {
  if (model.anisotropic) return AveragesOf(model, *model.anisotropic, channel);
  const AlbedoFit& lobe = model.albedo.lobe;
  const double dielectric = model.film ? model.film->albedo.average[channel] : model.albedo.average;
  return {lobe.e_average, lobe.schlick_average, dielectric};
}

// Schlick's forms of shadowing are refused with anisotropy (scene/validate.cc).
template <class Microfacet>
bool IsAnisotropicLobe(const Microfacet& material, const MicrofacetModel& model) {
  return IsAnisotropic(material) && (model.shadowing == Shadowing::kHeightCorrelated ||
                                     model.shadowing == Shadowing::kSeparable);
}

// Makes the lobe anisotropic if the material is. The Fresnel curve must already be set.
template <class Microfacet>
void MakeAnisotropic(const Microfacet& material, double roughness, bool by_hit,
                     MicrofacetModel* model) {
  if (!IsAnisotropicLobe(material, *model)) return;
  const GgxAlphas<double> alpha = AlphasOf(material, roughness, AnisotropyOf(material));
  const LobeWidth width = DeriveWidth(alpha);
  PutWidth(width, Rounded(), &model->constants);
  model->alpha = width.alpha;
  model->delta = width.delta;
  model->double_terms = true;
  if (by_hit && HasExactCurve(model->fresnel)) {
    const auto alphas = [&, anisotropy = AnisotropyOf(material)](double r) {
      return AlphasOf(material, r, anisotropy);
    };
    std::vector<AnisotropicFresnelCurves> curves;
    if (model->film) {
      curves = MakeAnisotropicTableCurves(model->shadowing, alphas, model->film->dielectric,
                                          model->film->bend);
    } else {
      curves = {MakeAnisotropicFresnelCurves(model->shadowing, alphas, model->albedo.curve)};
    }
    model->anisotropic_curves =
        std::make_shared<const std::vector<AnisotropicFresnelCurves>>(std::move(curves));
  }
  model->anisotropic =
      std::make_shared<const AnisotropicLobe>(MakeAnisotropicLobe(*model, alpha, roughness));
}

// What a dielectric's fits depend on.
struct DielectricFitKey {
  Shadowing shadowing;
  double roughness;
  CoatedDielectric<double> curve;

  bool operator==(const DielectricFitKey&) const = default;
};

// Fits are kept: materials of a scene often share index and roughness, and both stay when a user
// changes a colour.
FresnelAlbedoFit DielectricFitOf(Shadowing shadowing, double roughness,
                                 const CoatedDielectric<double>& curve) {
  static Memo<DielectricFitKey, FresnelAlbedoFit> memo;
  return *memo.Get({shadowing, roughness, curve},
                   [&] { return MakeDielectricAlbedoFit(shadowing, roughness, curve); });
}

std::shared_ptr<const DielectricCurves> DielectricCurvesOf(Shadowing shadowing,
                                                           const CoatedDielectric<double>& curve) {
  static Memo<DielectricFitKey, DielectricCurves> memo;
  return memo.Get({shadowing, 0, curve}, [&] { return MakeDielectricCurves(shadowing, curve); });
}

template <class Microfacet>
FilmUse FilmUseOf(const Microfacet& material, const MicrofacetModel& model, double roughness,
                  bool roughness_by_hit) {
  return {.shadowing = model.shadowing,
          .roughness = roughness,
          .roughness_by_hit = roughness_by_hit,
          .is_anisotropic = IsAnisotropicLobe(material, model)};
}

// Puts the model under a film, whose tables are to be set.
void TakeFilm(std::shared_ptr<const ThinFilmLobe> film, MicrofacetModel* model) {
  if (film == nullptr) return;
  model->film = std::move(film);
  model->fresnel = FresnelForm::kThinFilm;
  model->dielectric_f_average = model->film->dielectric_average;
  model->metal_f_average = model->film->metal_average;
}

// The colours of a channel below the model's film, if it has one.
MicrofacetColors BelowFilm(const MicrofacetModel& model, const MicrofacetColors& at, int c) {
  if (!model.film) return at;
  const auto at_normal = [&](const FresnelTable& table) {
    return 1 - FresnelTableLoss(table, 1.0)[static_cast<size_t>(c)];
  };
  return DeriveUnderFilm(at, at_normal(model.film->dielectric), at_normal(model.film->metal));
}

// Sets the model's colours; of_channel(c) are those of a channel. The averages of both Fresnel
// curves, which Kulla and Conty's compensation needs, must already be set in the model.
template <class OfChannel>
void TakeColors(const OfChannel& of_channel, MicrofacetModel* model) {
  const bool kulla_conty = model->compensation == Compensation::kKullaConty;
  MicrofacetConstants<float>* const constants = &model->constants;
  if (kulla_conty) model->multiple = KullaContyScale(AveragesOf(*model, 0).one);
  Rounded()(model->multiple, constants->multiple);
  Rounded()(model->base_roughness, constants->base.roughness);
  for (int c = 0; c < 3; ++c) {
    const MicrofacetColors at = of_channel(c);
    const MixedCurve mix = MixCurves(at);
    PutCurve(at, c, Rounded(), constants);
    PutOpenPbr(at, c, Rounded(), constants);
    Rounded()(model->base_ratio[c], constants->base.ratio[c]);
    model->metallic = at.metallic;
    model->diffuse[c] = at.diffuse;
    model->dielectric_f0[c] = at.dielectric_f0;
    model->dielectric_f90 = at.dielectric_f90;
    model->metal_f0[c] = at.metal_f0;
    model->f82_slope[c] = at.f82_slope;
    model->dielectric_scale[c] = at.dielectric_scale;
    model->metal_scale = at.metal_scale;
    model->cover[c] = at.cover;
    model->f0[c] = mix.f0;
    model->f90 = MixedF90(at.dielectric_f90, at.metallic);
    if (!kulla_conty && !model->reciprocal) continue;
    const KullaContyChannel multiple =
        DeriveKullaConty(*model, at, {model->dielectric_f_average[c], model->metal_f_average[c]},
                         AveragesOf(*model, c));
    PutKullaConty(multiple, c, Rounded(), constants);
    model->diffuse[c] = multiple.diffuse;
    model->dielectric_f_multiple[c] = multiple.dielectric_f_multiple;
    model->f_multiple[c] = multiple.f_multiple;
  }
}

// Sets the coupling to the base, which is reciprocal where the lobe is.
template <class Microfacet>
void CoupleBase(const Microfacet& material, MicrofacetModel* model) {
  model->coupling = material.diffuse_coupling;
  model->reciprocal = model->coupling == DiffuseCoupling::kAlbedoScaled &&
                      model->compensation == Compensation::kKullaConty;
  PrepareBase(material, model);
}

// `base_by_hit`: whether base_color differs by hit by vertex colours.
MicrofacetModel MakeModel(const MetallicRoughnessMaterial& material, bool base_by_hit) {
  MicrofacetModel model = MakeLobe(material);
  CoupleBase(material, &model);
  // The tint has no effect on a material that is not metallic.
  const bool tinted = material.metallic > 0 && material.f82_tint != Rgb(1);
  const Rgb tint = tinted ? material.f82_tint : Rgb(1);
  model.fresnel = tinted ? FresnelForm::kF82 : FresnelForm::kSchlick;
  const bool maps_metallic = material.metallic_roughness_map.valid();
  model.film_by_hit = FilmVaries(material, base_by_hit);
  if (material.iridescence > 0 && !model.film_by_hit) {
    FilmUse use = FilmUseOf(material, model, material.roughness,
                            maps_metallic || material.anisotropy_map.valid());
    use.dielectric = material.metallic < 1 || maps_metallic;
    use.metal = material.metallic > 0;
    TakeFilm(MakeThinFilmLobe(material, use), &model);
  }
  MakeAnisotropic(material, material.roughness, maps_metallic || material.anisotropy_map.valid(),
                  &model);
  const auto of_channel = [&](int c) {
    return BelowFilm(model,
                     DeriveMetallicRoughness(material.base_color[c], material.metallic,
                                             material.dielectric_f0[c], material.specular, tint[c]),
                     c);
  };
  for (int c = 0; c < 3 && !model.film; ++c) {
    const CurveAverages average = DeriveAverages(of_channel(c));
    model.dielectric_f_average[c] = average.dielectric;
    model.metal_f_average[c] = average.metal;
  }
  TakeColors(of_channel, &model);
  return model;
}

MicrofacetModel MakeModel(const ConductorMaterial& material) {
  const double one_minus_seventh = 6.0 / 7;  // 1 - the cosine at which F82 matches the exact curve
  MicrofacetModel model = MakeLobe(material);
  model.eta = material.eta;
  model.k = material.k;
  model.fresnel = FresnelForm::kConductor;
  const Rgb f0 = MakeRgb([&](int c) { return FresnelF0(material.eta[c], material.k[c]); });
  Rgb slope(0, 0, 0);
  if (material.fresnel == ConductorFresnel::kF82Tint) {
    model.fresnel = FresnelForm::kF82;
    slope = MakeRgb([&](int c) {
      return F82Slope(f0[c], FresnelConductor(1 - one_minus_seventh, one_minus_seventh,
                                              material.eta[c], material.k[c]));
    });
  } else if (material.fresnel == ConductorFresnel::kSchlick) {
    model.fresnel = FresnelForm::kSchlick;
  }
  if (model.compensation == Compensation::kKullaConty) {
    model.metal_f_average = MakeRgb([&](int c) {
      return model.fresnel == FresnelForm::kConductor
                 ? AverageConductor(material.eta[c], material.k[c])
                 : AverageF82(f0[c], slope[c]);
    });
  }
  TakeColors([&](int c) { return DeriveConductor(f0[c], slope[c]); }, &model);
  return model;
}

MicrofacetModel MakeModel(const DielectricMaterial& material) {
  MicrofacetModel model = MakeLobe(material);
  const bool exact = material.fresnel == DielectricFresnel::kExact;
  CoupleBase(material, &model);
  model.eta = Rgb(material.ior);
  const double f0 = FresnelF0(material.ior, 0.0);
  model.fresnel = exact ? FresnelForm::kDielectric : FresnelForm::kSchlick;
  if (exact) {
    model.albedo = DielectricFitOf(material.shadowing, material.roughness, {material.ior});
    if (material.roughness_map.valid()) {
      model.curves = DielectricCurvesOf(material.shadowing, {material.ior});
    }
  }
  if (model.compensation == Compensation::kKullaConty) {
    model.dielectric_f_average = Rgb(exact ? AverageDielectric(material.ior) : AverageSchlick(f0));
  }
  TakeColors([&](int c) { return DeriveDielectric(material.base_color[c], f0); }, &model);
  return model;
}

MicrofacetModel MakeModel(const OpenPbrMaterial& material, bool base_by_hit) {
  const OpenPbrOptions& options = material.options;
  struct Lobe {
    Shadowing shadowing;
    Compensation compensation;
    double roughness;
  };
  const Lobe lobe{options.smith, options.compensation, RoughnessBelowCoat(material)};
  MicrofacetModel model = MakeLobe(lobe);
  model.fresnel = FresnelForm::kOpenPbr;
  model.coupling = DiffuseCoupling::kAlbedoScaled;
  model.reciprocal =
      options.layering == Layering::kReciprocal && options.compensation != Compensation::kTurquin;
  model.base_roughness = material.base_diffuse_roughness;
  if (model.base_roughness > 0) {
    model.base_form = DiffuseForm::kOrenNayar;
    const double in_rho = WeightInRho(material, material.base_metalness);
    model.base_ratio = EonRatio(material.base_color * in_rho, model.base_roughness);
  }
  model.is_dielectric = material.base_metalness == 0 || material.specular_weight == 0;
  model.dielectric = DielectricOf(material);
  const bool maps_roughness = material.specular_roughness_map.valid();
  if (material.thin_film_weight > 0) {
    FilmUse use = FilmUseOf(material, model, lobe.roughness, maps_roughness);
    use.dielectric = material.base_metalness < 1 || material.base_metalness_map.valid();
    use.metal = !model.is_dielectric;
    use.metal_by_hit = MetalVariesBelowFilm(material, base_by_hit);
    TakeFilm(MakeThinFilmLobe(material, use), &model);
  }
  if (!model.film) {
    model.albedo = DielectricFitOf(lobe.shadowing, lobe.roughness, model.dielectric);
  }
  if (maps_roughness && !model.film) {
    model.curves = DielectricCurvesOf(lobe.shadowing, model.dielectric);
  }
  MakeAnisotropic(material, lobe.roughness, maps_roughness, &model);
  const double f0 = FresnelCoatedDielectric(1.0, 0.0, model.dielectric);
  const Rgb& tint = material.specular_color;
  const auto of_channel = [&](int c) {
    const OpenPbrChannel at{material.base_color[c], material.base_metalness,
                            material.subsurface_color[c], tint[c], LargestChannel(tint)};
    const MicrofacetColors colors = DeriveOpenPbr(material, at, f0);
    return BelowFilm(
        model,
        ChangesMetal(material) ? WithMetalBelowCoat(material, at.specular_color, colors) : colors,
        c);
  };
  if (model.compensation == Compensation::kKullaConty && !model.film) {
    model.dielectric_f_average = Rgb(AverageDielectric(model.dielectric));
    model.metal_f_average = MakeRgb([&](int c) { return DeriveAverages(of_channel(c)).metal; });
  }
  TakeColors(of_channel, &model);
  return model;
}

void FindMaps(const Material& material, ShadingMaterial* prepared) {
  prepared->by_hit.parameters = material.vertex_colors != VertexColors::kNone;
  prepared->by_hit.model = material.vertex_colors == VertexColors::kBase;
  if (const MaterialModel* const model = ModelOf(material)) {
    for (const MaterialMap& map : model->maps) {
      if (!map.get(material).valid()) continue;
      for (const MapTarget& target : TargetsOf(map)) {
        prepared->by_hit.parameters = true;
        if (target.number != MappedNumber::kEmission) prepared->by_hit.model = true;
        if (target.number == MappedNumber::kWidth ||
            target.number == MappedNumber::kUncoatedWidth ||
            target.number == MappedNumber::kAnisotropy) {
          prepared->by_hit.width = true;
        }
      }
    }
  }
  prepared->by_hit.normal =
      material.normal_map.texture.valid() || material.bump_map.texture.valid();
  prepared->by_hit.tangent = IsAnisotropic(material);
  if (prepared->by_hit.tangent) prepared->tangent_turn = TangentTurnOf(material).rotation;
  if (prepared->by_hit.parameters || prepared->by_hit.normal || prepared->by_hit.tangent) {
    prepared->scene_material = &material;
  }
}

// A black base, such as a metal's, reflects nothing, so how it is coupled to the lobe does not
// matter: the coupling is dropped if it would need an albedo. The coupling by Fresnel's curve is
// kept, because the curve's value is at hand and the kernels of most materials use it.
void SkipBlackBase(ShadingMaterial* prepared) {
  auto* const model = std::get_if<MicrofacetModel>(&prepared->model);
  if (model == nullptr || prepared->by_hit.parameters || model->diffuse != Rgb(0)) return;
  if (model->coupling == DiffuseCoupling::kAlbedoScaled) model->coupling = DiffuseCoupling::kNone;
  model->base_form = DiffuseForm::kLambert;
}

}  // namespace

namespace {

// Prepares a material without its coat.
ShadingMaterial PrepareUncoated(const Material& material) {
  ShadingMaterial prepared{};
  prepared.emission = EmissionOf(material);
  const auto take_shown = [&](const auto& of_channel) {
    for (int c = 0; c < 3; ++c) {
      const ShownColors shown = of_channel(c);
      prepared.albedo[c] = shown.albedo;
      prepared.of_ambient[c] = shown.of_ambient;
    }
  };
  const auto matte = [&](const auto& material_of) {
    prepared.model = MakeModel(material_of);
    take_shown([&](int c) { return DeriveShown(material_of.albedo[c]); });
  };
  std::visit(
      Overloaded{
          [&](const LambertMaterial& lambert) { matte(lambert); },
          [&](const OrenNayarMaterial& rough) { matte(rough); },
          [&](const BurleyMaterial& burley) { matte(burley); },
          [&](const PhongMaterial& phong) {
            prepared.model = MakeModel(phong);
            take_shown(
                [&](int c) { return DerivePhongShown(phong.color[c], phong.kd[c], phong.ka[c]); });
          },
          [&](const MetallicRoughnessMaterial& metallic_roughness) {
            prepared.model =
                MakeModel(metallic_roughness, material.vertex_colors == VertexColors::kBase);
            take_shown([&](int c) { return DeriveShown(metallic_roughness.base_color[c]); });
          },
          [&](const ConductorMaterial& conductor) {
            const MicrofacetModel model = MakeModel(conductor);
            prepared.model = model;
            take_shown([&](int c) {
              return ShownColors{model.f0[c], AverageConductor(conductor.eta[c], conductor.k[c])};
            });
          },
          [&](const DielectricMaterial& dielectric) {
            const double gloss = AverageDielectric(dielectric.ior);
            prepared.model = MakeModel(dielectric);
            take_shown(
                [&](int c) { return DeriveDielectricShown(dielectric.base_color[c], gloss); });
          },
          [&](const OpenPbrMaterial& open_pbr) {
            prepared.model = MakeModel(open_pbr, material.vertex_colors == VertexColors::kBase);
            prepared.emission_through = open_pbr.options.emission_through;
            const Rgb color = DiffuseColor(open_pbr);
            take_shown([&](int c) { return DeriveShown(color[c]); });
          },
          [&](const MeasuredMaterial& measured) {
            prepared.model = MatteModel{.diffuse = Rgb(0)};  // without a file
            if (!measured.brdf) return;
            prepared.model = MeasuredModel{measured.brdf, measured.interpolation};
            const Rgb& albedo = measured.brdf->mean_albedo;
            take_shown([&](int c) { return DeriveShown(std::min(albedo[c], 1.0)); });
          },
          [](const SplitMaterial&) {}},
      material.model);
  if (material.user) prepared.model = UserModel{material.user};
  prepared.layers = MakeLayers(material);
  FindMaps(material, &prepared);
  return prepared;
}

// Sets `prepared`. To be called once the couplings of the model are final.
void FinishModel(ShadingMaterial* prepared) {
  auto* const microfacet = std::get_if<MicrofacetModel>(&prepared->model);
  if (microfacet == nullptr) return;
  microfacet->prepared = microfacet->compensation != Compensation::kNone ||
                         microfacet->coupling == DiffuseCoupling::kAlbedoScaled;
}

}  // namespace

namespace {

CoatTransmission TransmissionOf(const Coat& coat, const Material& below) {
  if (const auto* open_pbr = std::get_if<OpenPbrMaterial>(&below.model)) {
    return TransmissionOf(*open_pbr);
  }
  return {.weight = StrengthOf(coat.material), .color = coat.color};
}

}  // namespace

std::shared_ptr<const ShadingMaterial> MakeShadingCoat(const Coat& coat, const Material& below) {
  const auto own = std::make_shared<const Material>(coat.material);
  // SkipBlackBase is not called: the coat's base is black, but 1 - the coat's albedo is needed as
  // the coat's transmittance.
  ShadingMaterial prepared = PrepareUncoated(*own);
  prepared.own = own;
  prepared.transmission = TransmissionOf(coat, below);
  FinishModel(&prepared);
  return std::make_shared<const ShadingMaterial>(std::move(prepared));
}

ShadingMaterial PrepareMaterial(const Material& material, bool in_ambient) {
  ShadingMaterial prepared = PrepareUncoated(material);
  prepared.in_ambient = in_ambient;
  SkipBlackBase(&prepared);
  FinishModel(&prepared);
  for (const Coat& coat : CoatsOf(material))
    prepared.coats.push_back(MakeShadingCoat(coat, material));
  // The stack's buffers have room for no more (bsdf.cc).
  if (prepared.coats.size() > kMostCoats || prepared.layers.size() > kMostLayers) {
    throw Error(ExitCode::kInternal, "material \"" + material.name + "\"",
                "too many coats or layers");
  }
  // The ambient light that coats and layers reflect, and the emission that they transmit, depend on
  // the view direction of the hit.
  const bool coated = !prepared.coats.empty();
  const bool hides_emission =
      coated || (prepared.emission_through == EmissionThrough::kBaseFactors &&
                 std::any_of(prepared.layers.begin(), prepared.layers.end(), LiesOverCoats));
  if (((coated || !prepared.layers.empty()) && in_ambient) ||
      (hides_emission && !IsBlack(prepared.emission))) {
    prepared.by_hit.parameters = true;
    prepared.scene_material = &material;
  }
  return prepared;
}

ShadingMaterial PrepareWithoutMaps(const Material& material) {
  const Material without = WithoutMaps(material);
  ShadingMaterial prepared = PrepareMaterial(without);
  // What hits may still have of their own is a tangent, and the emission that coats let through.
  prepared.scene_material = nullptr;
  prepared.by_hit.parameters = false;
  return prepared;
}

Rgb CoatAlbedo(const ShadingMaterial& coat, const LobeCosines& v) {
  const auto& model = std::get<MicrofacetModel>(coat.model);
  return MakeRgb([&](int c) { return std::min(CoverAlbedo(model, v, c), 1.0); });
}

Rgb TransmittedByCoat(const ShadingMaterial& coat, const LobeCosines& v, double n_dot_l) {
  return TransmittedByCoat(coat.transmission, CoatAlbedo(coat, v), v.n, n_dot_l);
}

namespace {

LobeAlbedos AlbedosOfLobe(const MicrofacetModel& model, const LobeCosines& x) {
  if (model.anisotropic) return AlbedosOfLobe(model, *model.anisotropic, x);
  const AlbedoFit& lobe = model.albedo.lobe;
  LobeAlbedos albedos{AlbedoOne(lobe, x.n), AlbedoLoss(lobe, x.n), {}};
  if (model.film) {
    albedos.curve = TableAlbedo(model.film->albedo, lobe, model.film->dielectric, x.n);
  } else {
    albedos.curve = Rgb(HasExactCurve(model.fresnel) ? AlbedoFresnel(model.albedo, x.n)
                                                     : AlbedoSchlick(lobe, x.n));
  }
  return albedos;
}

}  // namespace

double LossOf(const MicrofacetModel& model, const LobeCosines& x) {
  return model.anisotropic ? AlbedosOfLobe(model, *model.anisotropic, x).loss
                           : AlbedoLoss(model.albedo.lobe, x.n);
}

double CoverAlbedo(const MicrofacetModel& model, const LobeCosines& v, int channel) {
  const double f0 = model.dielectric_f0[channel];
  const auto [one, loss, curves] = AlbedosOfLobe(model, v);
  const double curve = curves[channel];
  const double single =
      HasExactCurve(model.fresnel) ? curve : f0 * (one - curve) + model.dielectric_f90 * curve;
  switch (model.compensation) {
    case Compensation::kTurquin:
      return model.cover[channel] * single * (1 + f0 * loss / one);
    case Compensation::kKullaConty:
      return model.cover[channel] * (single + model.dielectric_f_multiple[channel] * loss);
    case Compensation::kNone:
      break;
  }
  return model.cover[channel] * single;
}

bool HasDoubleTerms(const ShadingMaterial& material) {
  if (material.scene_material != nullptr) return true;  // mappings need the exact normal, too
  return std::visit(
      Overloaded{[](const PhongFamilyModel& phong) { return phong.double_terms; },
                 [](const MicrofacetModel& microfacet) { return microfacet.double_terms; },
                 [](const UserModel&) { return true; }, [](const auto&) { return false; }},
      material.model);
}

bool HasDeltaLobe(const ShadingMaterial& material) {
  const auto* microfacet = std::get_if<MicrofacetModel>(&material.model);
  return microfacet != nullptr && microfacet->delta && microfacet->f90 > 0;
}

bool HasMirror(const ShadingMaterial& material) {
  return HasDeltaLobe(material) ||
         std::any_of(material.coats.begin(), material.coats.end(),
                     [](const auto& coat) { return HasDeltaLobe(*coat); });
}

bool HasAnisotropicLobe(const ShadingMaterial& material) {
  const auto* microfacet = std::get_if<MicrofacetModel>(&material.model);
  const auto* measured = std::get_if<MeasuredModel>(&material.model);
  if (measured != nullptr && !measured->brdf->isotropic) return true;
  return (microfacet != nullptr && microfacet->anisotropic) ||
         std::any_of(material.coats.begin(), material.coats.end(),
                     [](const auto& coat) { return HasAnisotropicLobe(*coat); });
}

}  // namespace nacre
