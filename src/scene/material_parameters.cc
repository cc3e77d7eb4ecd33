// SPDX-License-Identifier: Apache-2.0
#include "scene/material_parameters.h"

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
constexpr MaterialParameter Number(std::string_view name, const Range& range) {
  return {name, false, range,
          [](const Material& material) {
            const double value = FieldOf<kMember>(material);
            return Rgb(value, value, value);
          },
          [](Material& material, const Rgb& value) { FieldOf<kMember>(material) = value.x; }};
}

template <auto kMember>
constexpr MaterialParameter Color(std::string_view name, const Range& range) {
  return {name, true, range, [](const Material& material) { return FieldOf<kMember>(material); },
          [](Material& material, const Rgb& value) { FieldOf<kMember>(material) = value; }};
}

// `options` in the order of the enumeration.
template <auto kMember>
constexpr MaterialChoice Choice(std::string_view name, std::span<const std::string_view> options) {
  return {name, options,
          [](const Material& material) { return static_cast<size_t>(FieldOf<kMember>(material)); },
          [](Material& material, size_t option) {
            auto& field = FieldOf<kMember>(material);
            field = static_cast<std::remove_reference_t<decltype(field)>>(option);
          }};
}

template <auto kMember>
constexpr MaterialMap Map(std::string_view name, MapUse use) {
  return {name, use, [](const Material& material) { return FieldOf<kMember>(material); },
          [](Material& material, TextureId id) { FieldOf<kMember>(material) = id; }};
}

// The roughness of a base: the lobe's unless it is set. One out of range is the lobe's fault alone.
template <class Struct>
constexpr MaterialParameter BaseRoughness() {
  return {"diffuse_roughness", false, limits::kUnit,
          [](const Material& material) {
            const auto& model = std::get<Struct>(material.model);
            const double lobe = limits::kUnit.Contains(model.roughness) ? model.roughness : 0;
            return Rgb(model.diffuse_roughness.value_or(lobe));
          },
          [](Material& material, const Rgb& value) {
            std::get<Struct>(material.model).diffuse_roughness = value.x;
          }};
}

constexpr MaterialParameter kEmission = Color<&Material::emission>("emission", limits::kRadiance);
constexpr MaterialParameter kOpacity = Number<&Material::opacity>("opacity", limits::kUnit);
constexpr MaterialParameter kOpacityCutoff =
    Number<&Material::opacity_cutoff>("opacity_cutoff", limits::kOpacityCutoff);

constexpr std::array kLambertParameters = {
    Color<&LambertMaterial::albedo>("albedo", limits::kUnit),
    kEmission,
    kOpacity,
    kOpacityCutoff,
};

constexpr std::array kOrenNayarParameters = {
    Color<&OrenNayarMaterial::albedo>("albedo", limits::kUnit),
    Number<&OrenNayarMaterial::roughness>("roughness", limits::kUnit),
    kEmission,
    kOpacity,
    kOpacityCutoff,
};

constexpr std::array kBurleyParameters = {
    Color<&BurleyMaterial::albedo>("albedo", limits::kUnit),
    Number<&BurleyMaterial::roughness>("roughness", limits::kUnit),
    kEmission,
    kOpacity,
    kOpacityCutoff,
};

constexpr std::array kPhongParameters = {
    Color<&PhongMaterial::color>("color", limits::kUnit),
    Color<&PhongMaterial::ka>("ka", limits::kUnit),
    Color<&PhongMaterial::kd>("kd", limits::kUnit),
    Color<&PhongMaterial::ks>("ks", limits::kUnit),
    Number<&PhongMaterial::shininess>("shininess", limits::kExponent),
    kEmission,
    kOpacity,
    kOpacityCutoff,
};

constexpr std::array kMetallicRoughnessParameters = {
    Color<&MetallicRoughnessMaterial::base_color>("base_color", limits::kUnit),
    Number<&MetallicRoughnessMaterial::metallic>("metallic", limits::kUnit),
    Number<&MetallicRoughnessMaterial::roughness>("roughness", limits::kUnit),
    Color<&MetallicRoughnessMaterial::dielectric_f0>("dielectric_f0", limits::kUnit),
    Number<&MetallicRoughnessMaterial::specular>("specular", limits::kUnit),
    Color<&MetallicRoughnessMaterial::f82_tint>("f82_tint", limits::kUnit),
    BaseRoughness<MetallicRoughnessMaterial>(),
    kEmission,
    kOpacity,
    kOpacityCutoff,
};

constexpr std::array kConductorParameters = {
    Color<&ConductorMaterial::eta>("eta", limits::kEta),
    Color<&ConductorMaterial::k>("k", limits::kExtinction),
    Number<&ConductorMaterial::roughness>("roughness", limits::kUnit),
    kEmission,
    kOpacity,
    kOpacityCutoff,
};

constexpr std::array kDielectricParameters = {
    Color<&DielectricMaterial::base_color>("base_color", limits::kUnit),
    Number<&DielectricMaterial::ior>("ior", limits::kIor),
    Number<&DielectricMaterial::roughness>("roughness", limits::kUnit),
    BaseRoughness<DielectricMaterial>(),
    kEmission,
    kOpacity,
    kOpacityCutoff,
};

constexpr std::array<std::string_view, 2> kConventions = {"classic", "radiometric"};
constexpr std::array<std::string_view, 3> kShadowings = {"height_correlated", "separable",
                                                         "schlick_direct"};
constexpr std::array<std::string_view, 3> kCompensations = {"turquin", "kulla_conty", "none"};
constexpr std::array<std::string_view, 3> kCouplings = {"albedo_scaled", "one_minus_fresnel",
                                                        "none"};
constexpr std::array<std::string_view, 3> kDiffuseForms = {"lambert", "oren_nayar", "burley"};
constexpr std::array<std::string_view, 3> kConductorFresnels = {"exact", "f82_tint", "schlick"};
constexpr std::array<std::string_view, 2> kDielectricFresnels = {"exact", "schlick"};

constexpr std::array<std::string_view, 5> kConductorNames = {"gold", "silver", "copper", "iron",
                                                             "aluminium"};
constexpr std::array<std::string_view, 3> kDielectricNames = {"glass", "water", "diamond"};

Rgb ToRgb(const std::array<double, 3>& rgb) { return {rgb[0], rgb[1], rgb[2]}; }

// Measured indices of refraction by name (brdf/presets.h).
constexpr MaterialChoice kConductorPreset = {
    "preset", kConductorNames, nullptr, [](Material& material, size_t option) {
      const IndexPreset& preset = *FindIndexPreset(kConductorNames[option]);
      auto& conductor = std::get<ConductorMaterial>(material.model);
      conductor.eta = ToRgb(preset.eta);
      conductor.k = ToRgb(preset.k);
    }};
constexpr MaterialChoice kDielectricPreset = {
    "preset", kDielectricNames, nullptr, [](Material& material, size_t option) {
      const IndexPreset& preset = *FindIndexPreset(kDielectricNames[option]);
      std::get<DielectricMaterial>(material.model).ior = preset.eta[0];
    }};

constexpr std::array kPhongChoices = {
    Choice<&PhongMaterial::convention>("convention", kConventions)};
constexpr std::array kMetallicRoughnessChoices = {
    Choice<&MetallicRoughnessMaterial::shadowing>("shadowing", kShadowings),
    Choice<&MetallicRoughnessMaterial::compensation>("compensation", kCompensations),
    Choice<&MetallicRoughnessMaterial::diffuse_coupling>("diffuse_coupling", kCouplings),
    Choice<&MetallicRoughnessMaterial::diffuse>("diffuse", kDiffuseForms)};
constexpr std::array kConductorChoices = {
    kConductorPreset, Choice<&ConductorMaterial::shadowing>("shadowing", kShadowings),
    Choice<&ConductorMaterial::compensation>("compensation", kCompensations),
    Choice<&ConductorMaterial::fresnel>("fresnel", kConductorFresnels)};
constexpr std::array kDielectricChoices = {
    kDielectricPreset,
    Choice<&DielectricMaterial::shadowing>("shadowing", kShadowings),
    Choice<&DielectricMaterial::compensation>("compensation", kCompensations),
    Choice<&DielectricMaterial::diffuse_coupling>("diffuse_coupling", kCouplings),
    Choice<&DielectricMaterial::diffuse>("diffuse", kDiffuseForms),
    Choice<&DielectricMaterial::fresnel>("fresnel", kDielectricFresnels)};

constexpr MaterialMap kEmissionMap = Map<&Material::emission_map>("emission_map", MapUse::kColor);
constexpr MaterialMap kOpacityMap = Map<&Material::opacity_map>("opacity_map", MapUse::kOpacity);
constexpr std::array kLambertMaps = {
    Map<&LambertMaterial::albedo_map>("albedo_map", MapUse::kColor), kEmissionMap, kOpacityMap};
constexpr std::array kOrenNayarMaps = {
    Map<&OrenNayarMaterial::albedo_map>("albedo_map", MapUse::kColor), kEmissionMap, kOpacityMap};
constexpr std::array kBurleyMaps = {Map<&BurleyMaterial::albedo_map>("albedo_map", MapUse::kColor),
                                    kEmissionMap, kOpacityMap};
constexpr std::array kPhongMaps = {
    Map<&PhongMaterial::diffuse_map>("diffuse_map", MapUse::kColor),
    Map<&PhongMaterial::specular_map>("specular_map", MapUse::kColor),
    Map<&PhongMaterial::shininess_map>("shininess_map", MapUse::kData), kEmissionMap, kOpacityMap};
constexpr std::array kMetallicRoughnessMaps = {
    Map<&MetallicRoughnessMaterial::base_color_map>("base_color_map", MapUse::kColor),
    Map<&MetallicRoughnessMaterial::metallic_roughness_map>("metallic_roughness_map",
                                                            MapUse::kTwoData),
    Map<&MetallicRoughnessMaterial::specular_map>("specular_map", MapUse::kData),
    Map<&MetallicRoughnessMaterial::specular_color_map>("specular_color_map", MapUse::kColor),
    kEmissionMap,
    kOpacityMap};
constexpr std::array kConductorMaps = {
    Map<&ConductorMaterial::roughness_map>("roughness_map", MapUse::kData), kEmissionMap,
    kOpacityMap};
constexpr std::array kDielectricMaps = {
    Map<&DielectricMaterial::base_color_map>("base_color_map", MapUse::kColor),
    Map<&DielectricMaterial::roughness_map>("roughness_map", MapUse::kData), kEmissionMap,
    kOpacityMap};

template <typename Model>
Material Make() {
  Material material;
  material.model = Model{};
  return material;
}

template <PhongModel kModel>
Material MakePhong() {
  Material material;
  material.model = PhongMaterial{.model = kModel};
  return material;
}

// Sheets. The normalised Phong lobes are bright: more than a tenth of ks is white on the screen.
constexpr std::string_view kExponentAxis = "shininess=4:256:4:log";
constexpr std::string_view kKsAxis = "ks=0:0.1:6";
constexpr std::string_view kRoughnessAxis = "roughness=0.1:0.9:5";
constexpr std::string_view kMatteAxis = "roughness=0:1:5";
constexpr std::string_view kAlbedoAxis = "albedo=0.1:0.9:5";

// The Phong family first and in the order of its enumeration: see ModelOf.
constexpr std::array<MaterialModel, 9> kModels = {{
    {"phong", MakePhong<PhongModel::kPhong>, kPhongParameters, kPhongChoices, kPhongMaps,
     kExponentAxis, kKsAxis},
    {"modified_phong", MakePhong<PhongModel::kModifiedPhong>, kPhongParameters, kPhongChoices,
     kPhongMaps, kExponentAxis, kKsAxis},
    {"blinn_phong", MakePhong<PhongModel::kBlinnPhong>, kPhongParameters, kPhongChoices, kPhongMaps,
     kExponentAxis, kKsAxis},
    {"lambert",
     Make<LambertMaterial>,
     kLambertParameters,
     {},
     kLambertMaps,
     "emission=0:0.2:3",
     kAlbedoAxis},
    {"oren_nayar",
     Make<OrenNayarMaterial>,
     kOrenNayarParameters,
     {},
     kOrenNayarMaps,
     kMatteAxis,
     kAlbedoAxis},
    {"burley", Make<BurleyMaterial>, kBurleyParameters, {}, kBurleyMaps, kMatteAxis, kAlbedoAxis},
    {"metallic_roughness", Make<MetallicRoughnessMaterial>, kMetallicRoughnessParameters,
     kMetallicRoughnessChoices, kMetallicRoughnessMaps, kRoughnessAxis, "metallic=0:1:5"},
    {"conductor", Make<ConductorMaterial>, kConductorParameters, kConductorChoices, kConductorMaps,
     kRoughnessAxis, "preset=gold,silver,copper,iron,aluminium"},
    {"dielectric", Make<DielectricMaterial>, kDielectricParameters, kDielectricChoices,
     kDielectricMaps, kRoughnessAxis, "ior=1.1,1.33,1.5,1.8,2.4"},
}};

}  // namespace

std::span<const MaterialModel> MaterialModels() { return kModels; }

const MaterialModel* FindModel(std::string_view name) {
  for (const MaterialModel& model : kModels) {
    if (model.name == name) return &model;
  }
  return nullptr;
}

const MaterialModel* ModelOf(const Material& material) {
  if (const auto* phong = std::get_if<PhongMaterial>(&material.model)) {
    return &kModels[static_cast<size_t>(phong->model)];
  }
  if (std::holds_alternative<LambertMaterial>(material.model)) return &kModels[3];
  if (std::holds_alternative<OrenNayarMaterial>(material.model)) return &kModels[4];
  if (std::holds_alternative<BurleyMaterial>(material.model)) return &kModels[5];
  if (std::holds_alternative<MetallicRoughnessMaterial>(material.model)) return &kModels[6];
  if (std::holds_alternative<ConductorMaterial>(material.model)) return &kModels[7];
  if (std::holds_alternative<DielectricMaterial>(material.model)) return &kModels[8];
  return nullptr;
}

bool CutsHoles(const Material& material) {
  return material.opacity_map.valid() || material.opacity < material.opacity_cutoff;
}

const MaterialParameter* FindParameter(const MaterialModel& model, std::string_view name) {
  for (const MaterialParameter& parameter : model.parameters) {
    if (parameter.name == name) return &parameter;
  }
  return nullptr;
}

}  // namespace nacre
