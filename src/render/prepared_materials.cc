// SPDX-License-Identifier: Apache-2.0
#include "render/prepared_materials.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <variant>

#include "base/float_mode.h"
#include "base/overloaded.h"
#include "base/parallel.h"
#include "brdf/burley.h"
#include "brdf/phong.h"

namespace nacre {
namespace {

constexpr double kPrintedGain = 1.005;  // less would be printed as 1.00

MaterialTraits TraitsOf(const Material& material, const ShadingMaterial& prepared,
                        double phong_gain) {
  MaterialTraits traits = ShadowingTrait(material);
  const auto add = [&](bool has, MaterialTrait trait) {
    if (has) traits |= static_cast<MaterialTraits>(trait);
  };
  const auto any_coat = [&](const auto& has) {
    return std::any_of(prepared.coats.begin(), prepared.coats.end(),
                       [&](const auto& coat) { return has(*coat); });
  };
  add(std::holds_alternative<SplitMaterial>(material.model), MaterialTrait::kSplit);
  add(material.emits_in_front_only, MaterialTrait::kEmitsInFrontOnly);
  add(!IsBlack(EmissionOf(material)), MaterialTrait::kEmits);
  add(!prepared.coats.empty(), MaterialTrait::kCoated);
  add(prepared.scene_material != nullptr ||
          any_coat([](const ShadingMaterial& coat) { return coat.scene_material != nullptr; }),
      MaterialTrait::kTextured);
  add(HasDoubleTerms(prepared) || any_coat(HasDoubleTerms), MaterialTrait::kDoubleTerms);
  add(HasDeltaLobe(prepared), MaterialTrait::kMirror);
  if (const auto* const open_pbr = std::get_if<OpenPbrMaterial>(&material.model)) {
    add(open_pbr->transmission_weight > 0, MaterialTrait::kTransmits);
    add(open_pbr->specular_haze > 0 || open_pbr->specular_retroreflectivity > 0,
        MaterialTrait::kHazy);
  }
  add(any_coat(HasDeltaLobe), MaterialTrait::kCoatMirror);
  add(std::holds_alternative<UserModel>(prepared.model), MaterialTrait::kUserModel);
  add(std::holds_alternative<MeasuredModel>(prepared.model), MaterialTrait::kMeasured);
  add(BurleyGain(prepared) > 1, MaterialTrait::kBurleyGain);
  add(phong_gain >= kPrintedGain, MaterialTrait::kPhongGain);
  return traits;
}

void Prepare(const Scene& scene, bool in_ambient, size_t i, PreparedMaterials* to) {
  to->all[i] = PrepareMaterial(scene.materials[i], in_ambient);
  to->phong_gains[i] = PhongGain(scene.materials[i]);
  to->traits[i] = TraitsOf(scene.materials[i], to->all[i], to->phong_gains[i]);
}

void CollectTraits(PreparedMaterials* materials) {
  materials->any = 0;
  for (const MaterialTraits traits : materials->traits) materials->any |= traits;
}

}  // namespace

void PrepareMaterials(const Scene& scene, bool in_ambient, int threads,
                      PreparedMaterials* materials) {
  const size_t count = scene.materials.size();
  materials->all.resize(count + 1);
  materials->black = {static_cast<uint32_t>(count)};
  materials->all[count] = {};
  materials->all[count].model = MatteModel{.diffuse = Rgb(0, 0, 0)};
  materials->traits.resize(count);
  materials->phong_gains.resize(count);
  constexpr size_t kPiece = 16;  // some take a millisecond, of fits (material.cc)
  ParallelFor((count + kPiece - 1) / kPiece, threads, [&](size_t piece) {
    const DefaultFloatMode mode;  // colours may be denormal
    const size_t end = std::min(count, (piece + 1) * kPiece);
    for (size_t i = piece * kPiece; i < end; ++i) Prepare(scene, in_ambient, i, materials);
  });
  CollectTraits(materials);
}

void PrepareMaterials(const Scene& scene, bool in_ambient, std::span<const uint32_t> changed,
                      PreparedMaterials* materials) {
  for (const uint32_t i : changed) Prepare(scene, in_ambient, i, materials);
  CollectTraits(materials);
}

MaterialTraits ShadowingTrait(const Material& material) {
  const auto trait = [](Shadowing shadowing) {
    return static_cast<MaterialTraits>(MaterialTrait::kFirstShadowing)
           << static_cast<int>(shadowing);
  };
  return std::visit(
      [&](const auto& model) {
        if constexpr (requires { model.shadowing; }) return trait(model.shadowing);
        if constexpr (requires { model.options.smith; }) return trait(model.options.smith);
        return MaterialTraits{0};
      },
      material.model);
}

double BurleyGain(const ShadingMaterial& material) {
  const auto gain = [](const Rgb& diffuse, double roughness) {
    return LargestChannel(diffuse) * M_PI * BurleyGrazingAlbedo(roughness);
  };
  return std::visit(Overloaded{[&](const MatteModel& matte) {
                                 const bool burley = matte.form == DiffuseForm::kBurley;
                                 return burley ? gain(matte.diffuse, matte.roughness) : 0.0;
                               },
                               [&](const MicrofacetModel& model) {
                                 // If the term is scaled by what the lobe's albedo leaves, which
                                 // vanishes at grazing angles, it cannot reflect more light than it
                                 // receives.
                                 const bool burley = model.base_form == DiffuseForm::kBurley &&
                                                     model.coupling == DiffuseCoupling::kNone;
                                 return burley ? gain(model.diffuse, model.base_roughness) : 0.0;
                               },
                               [](const auto&) { return 0.0; }},
                    material.model);
}

double PhongGain(const Material& material) {
  const auto* phong = std::get_if<PhongMaterial>(&material.model);
  if (phong == nullptr || phong->convention != PhongConvention::kRadiometric) return 0;
  double lobe = 1;
  // A map may reduce the exponent to 0, which widens the lobe.
  const double shininess = phong->shininess_map.valid() ? 0 : phong->shininess;
  if (phong->model == PhongModel::kPhong) lobe = PhongFurnace(shininess);
  if (phong->model == PhongModel::kBlinnPhong) lobe = BlinnFurnace(shininess);
  return LargestChannel(phong->kd * phong->color + phong->ks * lobe);
}

}  // namespace nacre
