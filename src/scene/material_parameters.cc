// SPDX-License-Identifier: Apache-2.0
#include "scene/material_parameters.h"

#include <algorithm>
#include <array>
#include <type_traits>
#include <variant>

#include "brdf/presets.h"

namespace nacre {
namespace {

template <typename Struct, typename Field>
Struct StructOf(Field Struct::*);

// The field that a pointer to member names, in the material itself or in its model.
template <auto kMember, typename AnyMaterial>
auto& FieldOf(AnyMaterial& material) {
  using Struct = decltype(StructOf(kMember));
  if constexpr (std::is_same_v<Struct, Material>) {
    return material.*kMember;
  } else {
    return std::get<Struct>(material.model).*kMember;
  }
}

template <auto kMember>
constexpr MaterialParameter Number(std::string_view name, const Range& range,
                                   std::string_view meaning, std::string_view layer = {}) {
  return {name,
          false,
          range,
          [](const Material& material) {
            const double value = FieldOf<kMember>(material);
            return Rgb(value, value, value);
          },
          [](Material& material, const Rgb& value) { FieldOf<kMember>(material) = value.x; },
          meaning,
          layer};
}

template <auto kMember>
constexpr MaterialParameter Color(std::string_view name, const Range& range,
                                  std::string_view meaning, std::string_view layer = {}) {
  return {name,
          true,
          range,
          [](const Material& material) { return FieldOf<kMember>(material); },
          [](Material& material, const Rgb& value) { FieldOf<kMember>(material) = value; },
          meaning,
          layer};
}

// `options` are in the order of the enumeration.
template <auto kMember>
constexpr MaterialChoice Choice(std::string_view name, std::span<const std::string_view> options,
                                std::string_view meaning) {
  return {name, options,
          [](const Material& material) { return static_cast<size_t>(FieldOf<kMember>(material)); },
          [](Material& material, size_t option) {
            auto& field = FieldOf<kMember>(material);
            field = static_cast<std::remove_reference_t<decltype(field)>>(option);
          },
          meaning};
}

// The parameter `kMember` as the target of a map: a colour is multiplied by the texel's colour, a
// number by the given channel of the texel.
template <auto kMember>
constexpr MapTarget Target(MappedNumber number, int channel = 0, double most = limits::kUnit.max) {
  using Struct = decltype(StructOf(kMember));
  constexpr bool kIsColor = std::is_same_v<decltype(std::declval<Struct>().*kMember), Rgb&&>;
  return {number, kIsColor, channel,
          [](const Material& material) { return Rgb(FieldOf<kMember>(material)); }, most};
}

// A map without targets is looked up elsewhere (MaterialMap::target_count).
template <auto kMember, class... Targets>
constexpr MaterialMap Map(std::string_view name, MapUse use, std::string_view meaning,
                          const Targets&... targets) {
  return {name,
          use,
          [](const Material& material) { return FieldOf<kMember>(material); },
          [](Material& material, TextureId id) { FieldOf<kMember>(material) = id; },
          meaning,
          {targets...},
          sizeof...(targets)};
}

// The roughness of a diffuse base, which is the lobe's unless it is set. If the lobe's is out of
// range, this returns 0, so that the fault is reported for the lobe only.
template <class Struct>
constexpr MaterialParameter BaseRoughness() {
  return {"diffuse_roughness",
          false,
          limits::kUnit,
          [](const Material& material) {
            const auto& model = std::get<Struct>(material.model);
            const double lobe = limits::kUnit.Contains(model.roughness) ? model.roughness : 0;
            return Rgb(model.diffuse_roughness.value_or(lobe));
          },
          [](Material& material, const Rgb& value) {
            std::get<Struct>(material.model).diffuse_roughness = value.x;
          },
          "Roughness of a base that is not lambert. Absent: that of the lobe, \"roughness\"."};
}

// Descriptions that several models share.
constexpr std::string_view kRoughnessMeaning =
    "Perceptual roughness: alpha is its square. Below 2^-20 (9.5e-7) the surface is a perfect "
    "mirror.";
constexpr std::string_view kOpenPbrAnisotropyMeaning =
    "How much narrower the lobe is across the tangent than along it: 1 minus the ratio of both "
    "alphas, the mean of whose squares is roughness^4.";
constexpr std::string_view kNotRendered = "Kept, but not rendered.";
constexpr std::string_view kTangentMeaning =
    "Turns the tangent about the normal, counter-clockwise in degrees. It is that of the normal "
    "map's coordinates, else of the mesh's own, else the direction around the y axis, as on a "
    "turned part.";
constexpr std::string_view kShadowingMeaning =
    "Shadowing and masking of microfacets. height_correlated: Smith's, height-correlated (Heitz "
    "2014). separable: Smith's, as the product of two terms. schlick_direct: Schlick's "
    "approximation of that with k = (roughness + 1)^2 / 8, meant for direct light (Karis 2013). "
    "schlick_ibl: the same with k = roughness^2 / 2, meant for image-based light.";
constexpr std::string_view kCompensationMeaning =
    "Energy compensation: what replaces the light that bounces more than once between "
    "microfacets. turquin: the lobe is scaled (Turquin 2019). kulla_conty: a second lobe (Kulla "
    "and Conty 2017), reciprocal. none: that light is lost, up to 59 %.";
constexpr std::string_view kCouplingMeaning =
    "How much light reaches the diffuse base. albedo_scaled: what the albedo of the dielectric's "
    "lobe leaves, so that a white surface reflects exactly all light, at every metallic. "
    "one_minus_fresnel: 1 - F(v.h), as in many lessons; in metallic_roughness F is that of "
    "dielectric and metal mixed, which makes partial metals too dark. none: all of it.";
constexpr std::string_view kSheenScalingMeaning =
    "What the sheen leaves to the layers below. reciprocal: 1 - m E of viewer or light, whichever "
    "is less, as KHR_materials_sheen: light is lost, of a white surface up to 14 %. conserving: "
    "1 - m E of the viewer, as OpenPBR and MaterialX layer by albedo: a white surface reflects all "
    "light, but light and viewer cannot change places.";
constexpr std::string_view kDiffuseMeaning =
    "Reflection model of the diffuse base. oren_nayar: EON (Portsmouth et al. 2025), which "
    "conserves energy. burley: Burley 2012, which does not.";

constexpr MaterialParameter kEmission =
    Color<&Material::emission>("emission", limits::kRadiance, "Emitted radiance.", "emission");
constexpr MaterialParameter kOpacity = Number<&Material::opacity>(
    "opacity", limits::kUnit,
    "Meshes only: the surface exists where its opacity, times the map, is at least opacity_cutoff; "
    "elsewhere all rays pass through. Nothing is semi-transparent.");
constexpr MaterialParameter kOpacityCutoff = Number<&Material::opacity_cutoff>(
    "opacity_cutoff", limits::kOpacityCutoff, "As glTF's alphaCutoff. Above 1 no surface is left.");

// The parameters of a model, followed by those of all materials.
template <class... Own>
constexpr auto WithCommon(const Own&... own) {
  return std::array{own..., kEmission, kOpacity, kOpacityCutoff};
}

// Where `emission` is not all that a map of emission multiplies, the map does not go with it.
template <size_t kCount>
constexpr auto KeepEmissionMap(std::array<MaterialParameter, kCount> rows) {
  for (MaterialParameter& row : rows) {
    if (row.name == kEmission.name) row.layer = {};
  }
  return rows;
}

constexpr auto kLambertParameters =
    WithCommon(Color<&LambertMaterial::albedo>("albedo", limits::kUnit, "Reflectance."));

constexpr auto kOrenNayarParameters =
    WithCommon(Color<&OrenNayarMaterial::albedo>("albedo", limits::kUnit, "Reflectance."),
               Number<&OrenNayarMaterial::roughness>("roughness", limits::kUnit,
                                                     "The model's own roughness. 0: Lambert."));

constexpr auto kBurleyParameters = WithCommon(
    Color<&BurleyMaterial::albedo>("albedo", limits::kUnit, "Reflectance."),
    Number<&BurleyMaterial::roughness>(
        "roughness", limits::kUnit,
        "Perceptual roughness. Towards grazing angles darker below 0.5, brighter above."));

constexpr auto kPhongParameters = WithCommon(
    Color<&PhongMaterial::color>("color", limits::kUnit, "Multiplies ka and kd."),
    Color<&PhongMaterial::ka>("ka", limits::kUnit, "Ambient coefficient."),
    Color<&PhongMaterial::kd>("kd", limits::kUnit, "Diffuse coefficient."),
    Color<&PhongMaterial::ks>("ks", limits::kUnit, "Specular coefficient."),
    Number<&PhongMaterial::shininess>(
        "shininess", limits::kExponent,
        "Exponent n of the highlight. With n = 0 the lobe is 1 in all directions, also behind its "
        "axis (0^0 is 1); any n above 0 leaves nothing there."));

constexpr auto kMetallicRoughnessParameters = WithCommon(
    Color<&MetallicRoughnessMaterial::base_color>(
        "base_color", limits::kUnit,
        "Diffuse colour of a dielectric; reflectance of a metal at normal incidence."),
    Number<&MetallicRoughnessMaterial::metallic>(
        "metallic", limits::kUnit,
        "0: dielectric, 1: metal. In between, what the two reflect is blended, as in glTF 2.0."),
    Number<&MetallicRoughnessMaterial::roughness>("roughness", limits::kUnit, kRoughnessMeaning),
    Number<&MetallicRoughnessMaterial::anisotropy>(
        "anisotropy", limits::kUnit,
        "How much wider the lobe is along the tangent than across it (KHR_materials_anisotropy): "
        "alpha along it is roughness^2 + (1 - roughness^2) anisotropy^2."),
    Number<&MetallicRoughnessMaterial::anisotropy_rotation_deg>("anisotropy_rotation_deg",
                                                                limits::kAngleDeg, kTangentMeaning),
    Color<&MetallicRoughnessMaterial::dielectric_f0>(
        "dielectric_f0", limits::kUnit,
        "Reflectance of the dielectric at normal incidence; for an index of refraction it is "
        "((ior - 1) / (ior + 1))^2."),
    Number<&MetallicRoughnessMaterial::specular>(
        "specular", limits::kUnit,
        "Strength of the dielectric's specular reflection, at all angles. 0: none, a matte "
        "surface. Metals are not affected."),
    Color<&MetallicRoughnessMaterial::f82_tint>(
        "f82_tint", limits::kUnit,
        "Factor on the reflectance of a metal at 81.8 degrees (cosine 1/7): the dip of real metals "
        "before grazing angles (Kutz et al. 2021). 1: Schlick's curve."),
    BaseRoughness<MetallicRoughnessMaterial>(),
    Number<&MetallicRoughnessMaterial::coat>(
        "coat", limits::kUnit,
        "Strength of a clear coat over all of this: a dielectric lobe of its own. The layers below "
        "get the light that its albedo leaves.",
        "coat"),
    Number<&MetallicRoughnessMaterial::coat_roughness>("coat_roughness", limits::kUnit,
                                                       kRoughnessMeaning),
    Number<&MetallicRoughnessMaterial::coat_ior>(
        "coat_ior", limits::kIor,
        "Index of refraction of the coat, which gives F0 of Schlick's curve; below 1.34 less is "
        "reflected at grazing angles, too. 1: no coat."),
    Number<&MetallicRoughnessMaterial::iridescence>(
        "iridescence", limits::kUnit,
        "The fraction of the surface that a thin film covers (KHR_materials_iridescence).",
        "iridescence"),
    Number<&MetallicRoughnessMaterial::iridescence_ior>("iridescence_ior", limits::kFilmIor,
                                                        "Index of refraction of the film."),
    Number<&MetallicRoughnessMaterial::iridescence_thickness_nm>(
        "iridescence_thickness_nm", limits::kFilmThicknessNm, "Thickness of the film in nm."),
    Number<&MetallicRoughnessMaterial::iridescence_thickness_minimum_nm>(
        "iridescence_thickness_minimum_nm", limits::kFilmThicknessNm,
        "Thickness of the film where iridescence_thickness_map is 0. Without a map nothing."),
    Color<&MetallicRoughnessMaterial::sheen_color>(
        "sheen_color", limits::kUnit,
        "Colour of the sheen, the fuzz of velvet, which is bright at grazing angles (Estevez and "
        "Kulla 2017). The layers below get the light that its albedo leaves. 0: none.",
        "sheen"),
    Number<&MetallicRoughnessMaterial::sheen_roughness>(
        "sheen_roughness", limits::kUnit,
        "Roughness of the sheen: alpha is its square. The larger, the farther from the outline it "
        "shows; 0: nowhere.",
        "sheen"));

constexpr auto kConductorParameters = WithCommon(
    Color<&ConductorMaterial::eta>("eta", limits::kEta,
                                   "Real part of the complex index of refraction."),
    Color<&ConductorMaterial::k>("k", limits::kExtinction,
                                 "Extinction coefficient: its imaginary part."),
    Number<&ConductorMaterial::roughness>("roughness", limits::kUnit, kRoughnessMeaning));

constexpr auto kDielectricParameters = WithCommon(
    Color<&DielectricMaterial::base_color>("base_color", limits::kUnit,
                                           "Reflectance of the diffuse base."),
    Number<&DielectricMaterial::ior>("ior", limits::kIor, "Index of refraction."),
    Number<&DielectricMaterial::roughness>("roughness", limits::kUnit, kRoughnessMeaning),
    BaseRoughness<DielectricMaterial>());

// An option of OpenPBR that is a number, which rules set, too.
constexpr MaterialParameter kFilmFade = {
    "film_fade_nm",
    false,
    limits::kFilmThicknessNm,
    [](const Material& material) {
      return Rgb(std::get<OpenPbrMaterial>(material.model).options.film_fade_nm);
    },
    [](Material& material, const Rgb& value) {
      std::get<OpenPbrMaterial>(material.model).options.film_fade_nm = value.x;
    },
    "Films thinner than this, in nm, fade to no film. 0: none does; a metal then jumps where its "
    "film gets a thickness of 0 or a weight of 0, because its index is guessed."};

constexpr auto kOpenPbrParameters = KeepEmissionMap(WithCommon(
    Number<&OpenPbrMaterial::base_weight>("base_weight", limits::kUnit, "Multiplies base_color."),
    Color<&OpenPbrMaterial::base_color>(
        "base_color", limits::kUnit,
        "Diffuse colour of the dielectric; reflectance of the metal at normal incidence."),
    Number<&OpenPbrMaterial::base_metalness>("base_metalness", limits::kUnit,
                                             "0: dielectric, 1: metal; in between a mix of both."),
    Number<&OpenPbrMaterial::base_diffuse_roughness>(
        "base_diffuse_roughness", limits::kUnit,
        "Roughness of the diffuse base (EON, Portsmouth et al. 2025). 0: Lambert."),
    Number<&OpenPbrMaterial::specular_weight>(
        "specular_weight", limits::kOpenPbrWeight,
        "Scales the dielectric's reflectance at normal incidence, by changing its index "
        "(specular_weight_rule), and all that a metal reflects, at most once."),
    Color<&OpenPbrMaterial::specular_color>(
        "specular_color", limits::kUnit,
        "Multiplies the dielectric's reflection. Of a metal, the factor on its reflectance at 81.8 "
        "degrees (F82-tint, Kutz et al. 2021)."),
    Number<&OpenPbrMaterial::specular_roughness>("specular_roughness", limits::kUnit,
                                                 kRoughnessMeaning),
    Number<&OpenPbrMaterial::specular_roughness_anisotropy>(
        "specular_roughness_anisotropy", limits::kUnit, kOpenPbrAnisotropyMeaning),
    Number<&OpenPbrMaterial::specular_ior>("specular_ior", limits::kOpenPbrIor,
                                           "Index of refraction of the dielectric base."),
    Number<&OpenPbrMaterial::specular_haze>(
        "specular_haze", limits::kUnit,
        "Version 1.2: the share of the lobe that is wider. Kept, but not rendered, which a note "
        "says."),
    Number<&OpenPbrMaterial::specular_haze_spread>("specular_haze_spread", limits::kUnit,
                                                   kNotRendered),
    Number<&OpenPbrMaterial::specular_retroreflectivity>(
        "specular_retroreflectivity", limits::kUnit,
        "Version 1.2: the share that is reflected back to the light. Kept, but not rendered, which "
        "a note says."),
    Number<&OpenPbrMaterial::coat_weight>("coat_weight", limits::kUnit,
                                          "The fraction of the base that a dielectric coat covers.",
                                          "coat"),
    Color<&OpenPbrMaterial::coat_color>(
        "coat_color", limits::kUnit,
        "Transmittance of the coat's medium, there and back at normal incidence."),
    Number<&OpenPbrMaterial::coat_roughness>("coat_roughness", limits::kUnit, kRoughnessMeaning),
    Number<&OpenPbrMaterial::coat_roughness_anisotropy>("coat_roughness_anisotropy", limits::kUnit,
                                                        kOpenPbrAnisotropyMeaning),
    Number<&OpenPbrMaterial::coat_ior>("coat_ior", limits::kOpenPbrIor,
                                       "Index of refraction of the coat."),
    Number<&OpenPbrMaterial::coat_darkening>(
        "coat_darkening", limits::kUnit,
        "How much light that is reflected inside the coat darkens the base. 1: as physics has it; "
        "0: not at all."),
    Number<&OpenPbrMaterial::fuzz_weight>(
        "fuzz_weight", limits::kUnit,
        "The fraction of all of this that fuzz covers, fibres that stand upright (Zeltner et al. "
        "2022).",
        "fuzz"),
    Color<&OpenPbrMaterial::fuzz_color>("fuzz_color", limits::kUnit,
                                        "Colour of what the fuzz reflects. What lies below gets "
                                        "the rest of the light in grey."),
    Number<&OpenPbrMaterial::fuzz_roughness>(
        "fuzz_roughness", limits::kUnit,
        "0: thin fibres, whose sheen shows at grazing angles; 1: dust."),
    Number<&OpenPbrMaterial::subsurface_weight>(
        "subsurface_weight", limits::kUnit,
        "The share of the dielectric's base that is a subsurface. It is shown as a diffuse base of "
        "subsurface_color: light comes out where it went in.",
        "subsurface"),
    Color<&OpenPbrMaterial::subsurface_color>("subsurface_color", limits::kUnit,
                                              "Diffuse colour of the subsurface."),
    Number<&OpenPbrMaterial::subsurface_radius>("subsurface_radius", limits::kOpenPbrLength,
                                                kNotRendered),
    Color<&OpenPbrMaterial::subsurface_radius_scale>("subsurface_radius_scale", limits::kUnit,
                                                     kNotRendered),
    Number<&OpenPbrMaterial::subsurface_scatter_anisotropy>(
        "subsurface_scatter_anisotropy", limits::kScatterAnisotropy, kNotRendered),
    Number<&OpenPbrMaterial::transmission_weight>(
        "transmission_weight", limits::kUnit,
        "The share of the base through which light passes. Kept, but not rendered: the base is "
        "opaque, which a note says.",
        "transmission"),
    Color<&OpenPbrMaterial::transmission_color>("transmission_color", limits::kUnit, kNotRendered),
    Number<&OpenPbrMaterial::transmission_depth>("transmission_depth", limits::kOpenPbrLength,
                                                 kNotRendered),
    Color<&OpenPbrMaterial::transmission_scatter>("transmission_scatter", limits::kUnit,
                                                  kNotRendered),
    Number<&OpenPbrMaterial::transmission_scatter_anisotropy>(
        "transmission_scatter_anisotropy", limits::kScatterAnisotropy, kNotRendered),
    Number<&OpenPbrMaterial::transmission_dispersion_scale>("transmission_dispersion_scale",
                                                            limits::kUnit, kNotRendered),
    Number<&OpenPbrMaterial::transmission_dispersion_abbe_number>(
        "transmission_dispersion_abbe_number", limits::kAbbeNumber, kNotRendered),
    Number<&OpenPbrMaterial::thin_film_weight>(
        "thin_film_weight", limits::kUnit,
        "The fraction of the base that a thin film covers, below the coat.", "thin_film"),
    Number<&OpenPbrMaterial::thin_film_thickness>("thin_film_thickness", limits::kFilmThicknessUm,
                                                  "Thickness of the film in micrometres."),
    Number<&OpenPbrMaterial::thin_film_ior>("thin_film_ior", limits::kFilmIor,
                                            "Index of refraction of the film."),
    kFilmFade,
    Number<&OpenPbrMaterial::emission_weight>("emission_weight", limits::kUnit,
                                              "Multiplies emission_luminance."),
    Number<&OpenPbrMaterial::emission_luminance>("emission_luminance", limits::kRadiance,
                                                 "Emitted radiance where emission_color is 1, in "
                                                 "the unit of the scene's lights. It is added "
                                                 "to emission."),
    Color<&OpenPbrMaterial::emission_color>("emission_color", limits::kRadiance,
                                            "Multiplies emission_luminance; may exceed 1."),
    Number<&OpenPbrMaterial::geometry_tangent_deg>("geometry_tangent_deg", limits::kAngleDeg,
                                                   kTangentMeaning),
    Number<&OpenPbrMaterial::geometry_coat_tangent_deg>(
        "geometry_coat_tangent_deg", limits::kAngleDeg, "The same for the coat.")));

constexpr auto kMeasuredParameters = WithCommon();

constexpr std::array<std::string_view, 2> kMeasuredInterpolations = {"linear", "nearest"};
constexpr std::array<std::string_view, 2> kConventions = {"classic", "radiometric"};
constexpr std::array<std::string_view, 4> kShadowings = {"height_correlated", "separable",
                                                         "schlick_direct", "schlick_ibl"};
constexpr std::array<std::string_view, 3> kCompensations = {"turquin", "kulla_conty", "none"};
constexpr std::array<std::string_view, 3> kCouplings = {"albedo_scaled", "one_minus_fresnel",
                                                        "none"};
constexpr std::array<std::string_view, 2> kSheenScalings = {"reciprocal", "conserving"};
constexpr std::array<std::string_view, 3> kDiffuseForms = {"lambert", "oren_nayar", "burley"};
constexpr std::array<std::string_view, 3> kConductorFresnels = {"exact", "f82_tint", "schlick"};
constexpr std::array<std::string_view, 2> kDielectricFresnels = {"exact", "schlick"};

constexpr std::array<std::string_view, 5> kConductorNames = {"gold", "silver", "copper", "iron",
                                                             "aluminium"};
constexpr std::array<std::string_view, 3> kDielectricNames = {"glass", "water", "diamond"};

Rgb ToRgb(const std::array<double, 3>& rgb) { return {rgb[0], rgb[1], rgb[2]}; }

// Measured indices of refraction by name (brdf/presets.h).
constexpr MaterialChoice kConductorPreset = {
    "preset", kConductorNames, nullptr,
    [](Material& material, size_t option) {
      const IndexPreset& preset = *FindIndexPreset(kConductorNames[option]);
      auto& conductor = std::get<ConductorMaterial>(material.model);
      conductor.eta = ToRgb(preset.eta);
      conductor.k = ToRgb(preset.k);
    },
    "Sets eta and k to measured values."};
constexpr MaterialChoice kDielectricPreset = {
    "preset", kDielectricNames, nullptr,
    [](Material& material, size_t option) {
      const IndexPreset& preset = *FindIndexPreset(kDielectricNames[option]);
      std::get<DielectricMaterial>(material.model).ior = preset.eta[0];
    },
    "Sets ior to a measured value."};

constexpr std::array<std::string_view, 2> kSideNames = {"double", "single"};
constexpr MaterialChoice kSides = Choice<&Material::single_sided>(
    "sides", kSideNames,
    "Meshes only. single: triangles have fronts alone, as with glTF's doubleSided false; from "
    "behind, rays of the camera and light pass through.");

constexpr std::array kMatteChoices = {kSides};
constexpr std::string_view kConventionMeaning =
    "radiometric: kd / pi, and lobes normalised so that ks is the share that they reflect of light "
    "from along the normal. Under light from everywhere, seen along the normal, modified_phong "
    "reflects ks, too, but phong ks (n + 2) / (n + 1) and blinn_phong from 1.13 ks (n = 32) to 2 "
    "ks (n = 0): they have no n.l, and gain energy, of light at grazing angles without bound; "
    "render notes what exceeds 1. classic: the equations as lessons write them, without these "
    "factors; the coefficients are not reflectances.";
constexpr std::array kPhongChoices = {
    Choice<&PhongMaterial::convention>("convention", kConventions, kConventionMeaning), kSides};
constexpr std::array<std::string_view, 4> kIridescenceModels = {"spectral", "belcour_barla",
                                                                "lines", "gltf"};
constexpr std::array kMetallicRoughnessChoices = {
    Choice<&MetallicRoughnessMaterial::shadowing>("shadowing", kShadowings, kShadowingMeaning),
    Choice<&MetallicRoughnessMaterial::compensation>("compensation", kCompensations,
                                                     kCompensationMeaning),
    Choice<&MetallicRoughnessMaterial::diffuse_coupling>("diffuse_coupling", kCouplings,
                                                         kCouplingMeaning),
    Choice<&MetallicRoughnessMaterial::diffuse>("diffuse", kDiffuseForms, kDiffuseMeaning),
    Choice<&MetallicRoughnessMaterial::sheen_scaling>("sheen_scaling", kSheenScalings,
                                                      kSheenScalingMeaning),
    Choice<&MetallicRoughnessMaterial::iridescence_model>(
        "iridescence_model", kIridescenceModels,
        "The colours of the film. gltf: the formula of KHR_materials_iridescence. spectral: Airy's "
        "sum of all reflections, integrated over the spectrum. belcour_barla: the fit of Belcour "
        "and Barla 2017 to that. lines: Airy's sum at 620, 540 and 450 nm."),
    kSides};
constexpr std::array kConductorChoices = {
    kConductorPreset,
    Choice<&ConductorMaterial::shadowing>("shadowing", kShadowings, kShadowingMeaning),
    Choice<&ConductorMaterial::compensation>("compensation", kCompensations, kCompensationMeaning),
    Choice<&ConductorMaterial::fresnel>(
        "fresnel", kConductorFresnels,
        "exact: Fresnel's equations. f82_tint: a curve through their values at 0 and 81.8 degrees. "
        "schlick: through the value at 0."),
    kSides};
constexpr std::array kDielectricChoices = {
    kDielectricPreset,
    Choice<&DielectricMaterial::shadowing>("shadowing", kShadowings, kShadowingMeaning),
    Choice<&DielectricMaterial::compensation>("compensation", kCompensations, kCompensationMeaning),
    Choice<&DielectricMaterial::diffuse_coupling>("diffuse_coupling", kCouplings, kCouplingMeaning),
    Choice<&DielectricMaterial::diffuse>("diffuse", kDiffuseForms, kDiffuseMeaning),
    Choice<&DielectricMaterial::fresnel>("fresnel", kDielectricFresnels,
                                         "exact: Fresnel's equations. schlick: Schlick's curve "
                                         "through their value at normal incidence."),
    kSides};

// Sets all parameters and options of OpenPBR (scene/open_pbr.h).
constexpr std::array<std::string_view, 2> kVersions = {"1.1", "1.2"};
constexpr MaterialChoice kVersionChoice = {
    "version", kVersions, nullptr,
    [](Material& material, size_t option) {
      material.model = DefaultsOf(static_cast<OpenPbrVersion>(option));
    },
    "The version of the specification that gives rules and defaults. 1.2 is a branch, as of "
    "2026-04: rules are spec_1_2, emission_weight is 0 and emission_luminance 1000."};

// Sets all options.
constexpr std::array<std::string_view, 4> kRules = {"spec_1_1", "spec_1_2", "materialx", "adobe"};
constexpr MaterialChoice kRulesChoice = {
    "rules", kRules, nullptr,
    [](Material& material, size_t option) {
      std::get<OpenPbrMaterial>(material.model).options =
          OptionsOf(static_cast<OpenPbrRules>(option));
    },
    "Sets all options below as one implementation has them: the specification, the branch of its "
    "next version, MaterialX's graph, or Adobe's library."};

template <auto kMember>
constexpr MaterialChoice Option(std::string_view name, std::span<const std::string_view> options,
                                std::string_view meaning) {
  return {name, options,
          [](const Material& material) {
            return static_cast<size_t>(std::get<OpenPbrMaterial>(material.model).options.*kMember);
          },
          [](Material& material, size_t option) {
            auto& field = std::get<OpenPbrMaterial>(material.model).options.*kMember;
            field = static_cast<std::remove_reference_t<decltype(field)>>(option);
          },
          meaning};
}

constexpr std::array<std::string_view, 3> kWeightRules = {"index", "index_reflect_only", "factor"};
constexpr std::array<std::string_view, 4> kCoatFresnels = {"refract_cosine", "invert_ratio",
                                                           "index_lerp", "none"};
constexpr std::array<std::string_view, 4> kRoughenings = {"spec", "adobe", "fit261", "none"};
constexpr std::array<std::string_view, 4> kDarkenings = {"spec", "spec12", "materialx", "adobe"};
constexpr std::array<std::string_view, 2> kAbsorptions = {"path", "normal"};
constexpr std::array<std::string_view, 4> kPartials = {"exponent_then_lerp", "lerp_then_exponent",
                                                       "per_crossing", "whole_product"};
constexpr std::array<std::string_view, 2> kLayerings = {"view", "reciprocal"};
constexpr std::array<std::string_view, 3> kTintsBelow = {"untinted", "complementary",
                                                         "max_channel"};
constexpr std::array<std::string_view, 3> kFilms = {"spectral", "belcour_barla", "lines"};
constexpr std::array<std::string_view, 3> kFilmMetals = {"gulbrandsen_f82", "gulbrandsen_tint",
                                                         "real_index"};
constexpr std::array<std::string_view, 2> kCoatMetals = {"unchanged", "gulbrandsen"};
constexpr std::array<std::string_view, 2> kFilmOutsides = {"coat", "air"};
constexpr std::array<std::string_view, 2> kAlphaLimits = {"none", "one"};
constexpr std::array<std::string_view, 4> kEmissionsThrough = {"coat_path", "coat_color",
                                                               "base_factors", "materialx"};
constexpr std::array<std::string_view, 2> kYesNo = {"no", "yes"};
constexpr std::array kOpenPbrChoices = {
    kVersionChoice,
    kRulesChoice,
    Option<&OpenPbrOptions::specular_weight_rule>(
        "specular_weight_rule", kWeightRules,
        "How specular_weight acts on the dielectric. index: by changing the index. "
        "index_reflect_only: in reflection alone. factor: multiplies the reflection."),
    Option<&OpenPbrOptions::coat_fresnel>(
        "coat_fresnel", kCoatFresnels,
        "Fresnel's curve of the dielectric below the coat. refract_cosine: of base over coat, for "
        "light that the coat refracts. invert_ratio: of a mix of both ratios of indices, inverted "
        "where the coat is denser. index_lerp: of base over a mix of the indices of air and coat. "
        "none: as in air."),
    Option<&OpenPbrOptions::coat_metal>(
        "coat_metal", kCoatMetals,
        "The metal below the coat. unchanged: as in air. gulbrandsen: its reflectance at normal "
        "incidence is that of its index (film_metal) over the coat's; the factor at 81.8 degrees "
        "stays."),
    Option<&OpenPbrOptions::coat_roughening>(
        "coat_roughening", kRoughenings,
        "How a rough coat widens highlights below it. spec: (r^4 + 2 c^4)^(1/4). adobe: "
        "(r^4 + (1 - 1 / n) c^4)^(1/4), and fuzz widens the coat. fit261: the fit of issue 261 of "
        "the specification."),
    Option<&OpenPbrOptions::coat_darkening_rule>(
        "coat_darkening_rule", kDarkenings,
        "How light that is reflected inside the coat darkens the base."),
    Option<&OpenPbrOptions::coat_absorption>(
        "coat_absorption", kAbsorptions,
        "path: along the refracted paths. normal: as at normal incidence, at every angle."),
    Option<&OpenPbrOptions::coat_partial>(
        "coat_partial", kPartials, "What a coat that covers a fraction of the base leaves to it."),
    Option<&OpenPbrOptions::layering>(
        "layering", kLayerings,
        "What the dielectric leaves to its diffuse base. view: 1 - E of the viewer. reciprocal: "
        "the same of light and viewer, over the mean; with kulla_conty alone."),
    Option<&OpenPbrOptions::smith>("smith", kShadowings, kShadowingMeaning),
    Option<&OpenPbrOptions::compensation>("compensation", kCompensations, kCompensationMeaning),
    Option<&OpenPbrOptions::alpha_max>("alpha_max", kAlphaLimits,
                                       "The largest alpha that anisotropy may make."),
    Option<&OpenPbrOptions::specular_tint_below>(
        "specular_tint_below", kTintsBelow,
        "The reflectance by which the base gets less light where specular_color tints it."),
    Option<&OpenPbrOptions::film>(
        "film", kFilms,
        "The colours of thin films. spectral: Airy's sum, integrated over the spectrum. "
        "belcour_barla: the fit of Belcour and Barla 2017 to that, as MaterialX has it. lines: "
        "Airy's sum at 620, 540 and 450 nm."),
    Option<&OpenPbrOptions::film_metal>(
        "film_metal", kFilmMetals,
        "The complex index that a metal below a film is taken to have. gulbrandsen_f82: "
        "Gulbrandsen "
        "2014, of base_color and the reflectance at 81.8 degrees. gulbrandsen_tint: of base_color "
        "and specular_color. real_index: without absorption, of base_color."),
    Option<&OpenPbrOptions::film_outside>(
        "film_outside", kFilmOutsides,
        "What lies above a film. coat: the coat, where there is one. air: air, always."),
    Option<&OpenPbrOptions::emission_through>(
        "emission_through", kEmissionsThrough,
        "What the coat leaves of emission. coat_path: one crossing of its medium. coat_color: "
        "coat_color. base_factors: one crossing, less what coat and fuzz reflect, and the coat's "
        "darkening. materialx: coat_color (1 - F0) (1 - (1 - n.v)^5)."),
    Option<&OpenPbrOptions::base_weight_in_rho>(
        "base_weight_in_rho", kYesNo,
        "Whether base_weight and 1 - base_metalness multiply the colour before light bounces "
        "between rough facets."),
    kSides};

constexpr std::array kMeasuredChoices = {
    Choice<&MeasuredMaterial::interpolation>(
        "interpolation", kMeasuredInterpolations,
        "How a MERL table is looked up. linear: between the centres of its cells, in the angles of "
        "Rusinkiewicz 1998, of which theta_half goes by its square root. nearest: the cell that "
        "contains the directions, as the database's own program; highlights show steps. EPFL's "
        "files are always linear."),
    kSides};

constexpr MaterialMap kEmissionMap = Map<&Material::emission_map>(
    "emission_map", MapUse::kColor, "Multiplies emission.",
    MapTarget{MappedNumber::kEmission, true, 0, &EmissionOf, limits::kRadiance.max});
constexpr MaterialMap kOpacityMap = Map<&Material::opacity_map>(
    "opacity_map", MapUse::kOpacity,
    "Multiplies opacity: the image's alpha, or its first channel where the texture's encoding is "
    "linear. Looked up in the full-resolution image, never in a mip level.");
template <class Struct>
constexpr MaterialMap AlbedoMap() {
  return Map<&Struct::albedo_map>("albedo_map", MapUse::kColor, "Multiplies albedo.",
                                  Target<&Struct::albedo>(MappedNumber::kColor));
}
template <class Struct>
constexpr MaterialMap BaseColorMap() {
  return Map<&Struct::base_color_map>("base_color_map", MapUse::kColor, "Multiplies base_color.",
                                      Target<&Struct::base_color>(MappedNumber::kColor));
}
template <class Struct>
constexpr MaterialMap RoughnessMap() {
  return Map<&Struct::roughness_map>("roughness_map", MapUse::kData, "Multiplies roughness.",
                                     Target<&Struct::roughness>(MappedNumber::kWidth));
}
constexpr std::array kLambertMaps = {AlbedoMap<LambertMaterial>(), kEmissionMap, kOpacityMap};
constexpr std::array kOrenNayarMaps = {AlbedoMap<OrenNayarMaterial>(), kEmissionMap, kOpacityMap};
constexpr std::array kBurleyMaps = {AlbedoMap<BurleyMaterial>(), kEmissionMap, kOpacityMap};
constexpr std::array kPhongMaps = {
    Map<&PhongMaterial::diffuse_map>("diffuse_map", MapUse::kColor, "Multiplies color.",
                                     Target<&PhongMaterial::color>(MappedNumber::kColor)),
    Map<&PhongMaterial::specular_map>("specular_map", MapUse::kColor, "Multiplies ks.",
                                      Target<&PhongMaterial::ks>(MappedNumber::kSpecularColor)),
    Map<&PhongMaterial::shininess_map>(
        "shininess_map", MapUse::kData, "Multiplies shininess.",
        Target<&PhongMaterial::shininess>(MappedNumber::kWidth, 0, limits::kExponent.max)),
    kEmissionMap, kOpacityMap};
constexpr MapTarget kFilmThicknessTarget = {
    MappedNumber::kFilmThickness,
    false,
    1,
    [](const Material& material) {
      return Rgb(std::get<MetallicRoughnessMaterial>(material.model).iridescence_thickness_nm);
    },
    limits::kFilmThicknessNm.max,
    [](const Material& material) {
      return std::get<MetallicRoughnessMaterial>(material.model).iridescence_thickness_minimum_nm;
    }};
constexpr std::array kMetallicRoughnessMaps = {
    BaseColorMap<MetallicRoughnessMaterial>(),
    Map<&MetallicRoughnessMaterial::metallic_roughness_map>(
        "metallic_roughness_map", MapUse::kTwoData,
        "Green multiplies roughness, blue metallic, as in glTF.",
        Target<&MetallicRoughnessMaterial::roughness>(MappedNumber::kWidth, 1),
        Target<&MetallicRoughnessMaterial::metallic>(MappedNumber::kMetallic, 2)),
    Map<&MetallicRoughnessMaterial::anisotropy_map>(
        "anisotropy_map", MapUse::kTwoData,
        "Blue multiplies anisotropy; red and green are the direction in which the lobe is wider, "
        "as in glTF.",
        Target<&MetallicRoughnessMaterial::anisotropy>(MappedNumber::kAnisotropy, 2)),
    Map<&MetallicRoughnessMaterial::specular_map>(
        "specular_map", MapUse::kData,
        "Its first channel multiplies specular; in glTF it is alpha (a texture's encoding).",
        Target<&MetallicRoughnessMaterial::specular>(MappedNumber::kSpecular)),
    Map<&MetallicRoughnessMaterial::specular_color_map>(
        "specular_color_map", MapUse::kColor, "Multiplies dielectric_f0.",
        Target<&MetallicRoughnessMaterial::dielectric_f0>(MappedNumber::kSpecularColor)),
    kEmissionMap,
    kOpacityMap,
    Map<&MetallicRoughnessMaterial::iridescence_map>(
        "iridescence_map", MapUse::kData, "Its first channel multiplies iridescence.",
        Target<&MetallicRoughnessMaterial::iridescence>(MappedNumber::kFilm)),
    Map<&MetallicRoughnessMaterial::iridescence_thickness_map>(
        "iridescence_thickness_map", MapUse::kTwoData,
        "Its green channel interpolates the thickness, from iridescence_thickness_minimum_nm to "
        "iridescence_thickness_nm, as in glTF.",
        kFilmThicknessTarget),
    Map<&MetallicRoughnessMaterial::coat_map>("coat_map", MapUse::kData,
                                              "Its first channel multiplies coat."),
    Map<&MetallicRoughnessMaterial::coat_roughness_map>(
        "coat_roughness_map", MapUse::kTwoData,
        "Its green channel multiplies coat_roughness, as in glTF."),
    Map<&MetallicRoughnessMaterial::sheen_color_map>(
        "sheen_color_map", MapUse::kColor, "Multiplies sheen_color.",
        Target<&MetallicRoughnessMaterial::sheen_color>(MappedNumber::kSheenColor)),
    Map<&MetallicRoughnessMaterial::sheen_roughness_map>(
        "sheen_roughness_map", MapUse::kData,
        "Its first channel multiplies sheen_roughness; in glTF it is alpha (a texture's encoding).",
        Target<&MetallicRoughnessMaterial::sheen_roughness>(MappedNumber::kSheenRoughness))};
constexpr std::array kConductorMaps = {RoughnessMap<ConductorMaterial>(), kEmissionMap,
                                       kOpacityMap};
constexpr std::array kDielectricMaps = {BaseColorMap<DielectricMaterial>(),
                                        RoughnessMap<DielectricMaterial>(), kEmissionMap,
                                        kOpacityMap};

constexpr std::array kOpenPbrMaps = {
    BaseColorMap<OpenPbrMaterial>(),
    Map<&OpenPbrMaterial::base_metalness_map>(
        "base_metalness_map", MapUse::kData, "Multiplies base_metalness.",
        Target<&OpenPbrMaterial::base_metalness>(MappedNumber::kMetallic)),
    Map<&OpenPbrMaterial::specular_color_map>(
        "specular_color_map", MapUse::kColor, "Multiplies specular_color.",
        Target<&OpenPbrMaterial::specular_color>(MappedNumber::kSpecularColor)),
    Map<&OpenPbrMaterial::specular_roughness_map>(
        "specular_roughness_map", MapUse::kData, "Multiplies specular_roughness.",
        Target<&OpenPbrMaterial::specular_roughness>(MappedNumber::kUncoatedWidth)),
    Map<&OpenPbrMaterial::fuzz_color_map>(
        "fuzz_color_map", MapUse::kColor, "Multiplies fuzz_color.",
        Target<&OpenPbrMaterial::fuzz_color>(MappedNumber::kSheenColor)),
    Map<&OpenPbrMaterial::fuzz_roughness_map>(
        "fuzz_roughness_map", MapUse::kData, "Multiplies fuzz_roughness.",
        Target<&OpenPbrMaterial::fuzz_roughness>(MappedNumber::kSheenRoughness)),
    kEmissionMap,
    kOpacityMap};

constexpr std::array kMeasuredMaps = {kEmissionMap, kOpacityMap};

constexpr std::array kNormalMaps = {MaterialNormalMap{
    "normal_map", [](Material& material) -> NormalMap& { return material.normal_map; }, ""}};
constexpr std::array kMetallicRoughnessNormalMaps = {
    kNormalMaps[0],
    MaterialNormalMap{"coat_normal_map",
                      [](Material& material) -> NormalMap& {
                        return std::get<MetallicRoughnessMaterial>(material.model).coat_normal_map;
                      },
                      "Of the coat, which normal_map does not affect."}};

template <typename Model>
Material Make() {
  return {.model = Model{}};
}

template <typename Model>
bool Holds(const Material& material) {
  return std::holds_alternative<Model>(material.model);
}

template <PhongModel kModel>
Material MakePhong() {
  return {.model = PhongMaterial{.model = kModel}};
}

template <PhongModel kModel>
bool HoldsPhong(const Material& material) {
  const auto* const phong = std::get_if<PhongMaterial>(&material.model);
  return phong != nullptr && phong->model == kModel;
}

// The default axes of `nacre grid`. The normalised Phong lobes are bright: with ks above 0.1 a
// highlight is white on the screen.
constexpr std::string_view kExponentAxis = "shininess=4:256:4:log";
constexpr std::string_view kKsAxis = "ks=0:0.1:6";
constexpr std::string_view kRoughnessAxis = "roughness=0.1:0.9:5";
constexpr std::string_view kMatteAxis = "roughness=0:1:5";
constexpr std::string_view kAlbedoAxis = "albedo=0.1:0.9:5";

constexpr std::array<MaterialModel, 11> kModels = {{
    {"phong", "Phong: highlight (r.v)^n where the light is above the surface",
     MakePhong<PhongModel::kPhong>, HoldsPhong<PhongModel::kPhong>, kPhongParameters, kPhongChoices,
     kPhongMaps, kNormalMaps, kExponentAxis, kKsAxis},
    {"modified_phong", "Modified Phong: highlight (r.v)^n n.l",
     MakePhong<PhongModel::kModifiedPhong>, HoldsPhong<PhongModel::kModifiedPhong>,
     kPhongParameters, kPhongChoices, kPhongMaps, kNormalMaps, kExponentAxis, kKsAxis},
    {"blinn_phong", "Blinn-Phong: highlight (n.h)^n where the light is above the surface",
     MakePhong<PhongModel::kBlinnPhong>, HoldsPhong<PhongModel::kBlinnPhong>, kPhongParameters,
     kPhongChoices, kPhongMaps, kNormalMaps, kExponentAxis, kKsAxis},
    {"lambert", "Lambert: perfectly diffuse", Make<LambertMaterial>, Holds<LambertMaterial>,
     kLambertParameters, kMatteChoices, kLambertMaps, kNormalMaps, "emission=0:0.2:3", kAlbedoAxis},
    {"oren_nayar",
     "Oren-Nayar: rough and diffuse, as clay or the moon; the EON form (Portsmouth et al. 2025), "
     "which conserves energy",
     Make<OrenNayarMaterial>, Holds<OrenNayarMaterial>, kOrenNayarParameters, kMatteChoices,
     kOrenNayarMaps, kNormalMaps, kMatteAxis, kAlbedoAxis},
    {"burley",
     "Burley: Disney's diffuse term of 2012, which reflects up to 1.56 times the light that grazes "
     "it",
     Make<BurleyMaterial>, Holds<BurleyMaterial>, kBurleyParameters, kMatteChoices, kBurleyMaps,
     kNormalMaps, kMatteAxis, kAlbedoAxis},
    {"metallic_roughness",
     "Metallic-roughness as in glTF 2.0: GGX lobes with Schlick's Fresnel, over a diffuse base",
     Make<MetallicRoughnessMaterial>, Holds<MetallicRoughnessMaterial>,
     kMetallicRoughnessParameters, kMetallicRoughnessChoices, kMetallicRoughnessMaps,
     kMetallicRoughnessNormalMaps, kRoughnessAxis, "metallic=0:1:5"},
    {"conductor",
     "Conductor: a bare metal of complex index of refraction eta - i k, with a GGX lobe",
     Make<ConductorMaterial>, Holds<ConductorMaterial>, kConductorParameters, kConductorChoices,
     kConductorMaps, kNormalMaps, kRoughnessAxis, "preset=gold,silver,copper,iron,aluminium"},
    {"dielectric",
     "Dielectric: a GGX lobe over a diffuse base. Nothing is transmitted: over a black base it "
     "shows the reflection of glass alone",
     Make<DielectricMaterial>, Holds<DielectricMaterial>, kDielectricParameters, kDielectricChoices,
     kDielectricMaps, kNormalMaps, kRoughnessAxis, "ior=1.1,1.33,1.5,1.8,2.4"},
    {"open_pbr",
     "OpenPBR Surface 1.1.1 (or version 1.2's branch): a coat over a mix of metal and "
     "glossy-diffuse dielectric; choices of "
     "implementations by name (rules)",
     Make<OpenPbrMaterial>, Holds<OpenPbrMaterial>, kOpenPbrParameters, kOpenPbrChoices,
     kOpenPbrMaps, kNormalMaps, "specular_roughness=0.1:0.9:5", "base_metalness=0:1:5"},
    {"measured",
     "Measured: the table of a file, a .binary of the MERL database or a .bsdf of EPFL's (file)",
     Make<MeasuredMaterial>, Holds<MeasuredMaterial>, kMeasuredParameters, kMeasuredChoices,
     kMeasuredMaps, kNormalMaps, "emission=0:0.2:3", "interpolation=linear,nearest"},
}};

// The row of this name, or nullptr.
template <class Row>
const Row* FindRow(std::span<const Row> rows, std::string_view name) {
  const auto found = std::ranges::find(rows, name, &Row::name);
  return found != rows.end() ? &*found : nullptr;
}

}  // namespace

std::span<const MaterialModel> MaterialModels() { return kModels; }

const MaterialModel* FindModel(std::string_view name) { return FindRow(MaterialModels(), name); }

const MaterialModel* ModelOf(const Material& material) {
  const auto found = std::ranges::find_if(
      kModels, [&](const MaterialModel& model) { return model.holds(material); });
  return found != kModels.end() ? &*found : nullptr;
}

Rgb EmissionOf(const Material& material) {
  const auto* const open_pbr = std::get_if<OpenPbrMaterial>(&material.model);
  if (open_pbr == nullptr) return material.emission;
  const double luminance = open_pbr->emission_weight * open_pbr->emission_luminance;
  return material.emission + open_pbr->emission_color * luminance;
}

std::vector<TextureId> TexturesOf(const Material& material) {
  std::vector<TextureId> ids;
  const auto add = [&](TextureId id) {
    if (id.valid()) ids.push_back(id);
  };
  if (const MaterialModel* const model = ModelOf(material)) {
    for (const MaterialMap& map : model->maps) add(map.get(material));
    for (const MaterialNormalMap& row : model->normal_maps) {
      add(NormalMapOf(row, material).texture);
    }
  }
  add(material.bump_map.texture);
  return ids;
}

Material WithoutMaps(const Material& material) {
  Material without = material;
  if (const MaterialModel* const model = ModelOf(material)) {
    for (const MaterialMap& map : model->maps) map.set(without, TextureId{});
    for (const MaterialNormalMap& row : model->normal_maps) row.of(without) = {};
  }
  without.bump_map = {};
  without.vertex_colors = VertexColors::kNone;
  return without;
}

bool CutsHoles(const Material& material) {
  return material.opacity_map.valid() || material.opacity < material.opacity_cutoff;
}

const MaterialParameter* FindParameter(const MaterialModel& model, std::string_view name) {
  return FindRow(model.parameters, name);
}

}  // namespace nacre
