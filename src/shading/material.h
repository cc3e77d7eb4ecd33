// SPDX-License-Identifier: Apache-2.0
// shading/material.h: materials as the kernels want them: numbers of the scene turned into the
// constants of each reflection model, once per plan and in double.
#pragma once

#include <memory>
#include <variant>
#include <vector>

#include "brdf/albedo.h"
#include "scene/material.h"
#include "scene/user_brdf.h"
#include "shading/constants.h"
#include "shading/layer.h"

namespace nacre {

// Below this roughness, and beyond this exponent, the half vector's terms are formed in double:
// a lobe of width alpha turns float's 6e-8 rad of direction into a relative error of about
// 1e-7 / alpha, 1e-5 at the limit of roughness. The limit of the exponent is where Phong's lobe,
// three widths out and on targets without fused multiply-add, is still within 2e-5 for the hits of
// tests/shading/highlight_test.cc. The choice is the material's, so a hit's bits never depend on
// what else is in its batch.
inline constexpr double kDoubleTermsRoughness = 0.1;
inline constexpr double kDoubleTermsShininess = 300;

// Lambert's, Oren-Nayar (EON) or Burley's.
struct MatteModel {
  DiffuseForm form = DiffuseForm::kLambert;
  Rgb diffuse;           // albedo / pi
  Rgb ratio{0, 0, 0};    // kOrenNayar: EonMultipleRatio of the albedo
  double roughness = 0;  // not kLambert
};

struct PhongFamilyModel {
  PhongModel model;
  Rgb diffuse;   // kd color, over pi if radiometric
  Rgb specular;  // ks, times the lobe's normalisation if radiometric
  double shininess;
  bool double_terms;
};

enum class FresnelForm : uint8_t { kSchlick, kF82, kDielectric, kConductor };

// What kind of microfacet model it is.
struct MicrofacetForm {
  Shadowing shadowing;
  FresnelForm fresnel;
  Compensation compensation;
  DiffuseCoupling coupling;
  DiffuseForm base_form = DiffuseForm::kLambert;
};

// A GGX lobe over a diffuse base: metallic-roughness, conductor and dielectric.
//
// Metallic-roughness mixes two surfaces, as glTF 2.0 does (Appendix B.2): (1 - metallic) of a
// dielectric over a diffuse base, and metallic of a bare metal. Their lobes have the same
// distribution and visibility, so one lobe with the mix of their Fresnel curves is exactly the mix
// of their lobes. What is no linear function of the Fresnel curve is mixed itself: compensation,
// and the base's share of the light, which only the dielectric above it takes from. Conductors are
// all metal, dielectrics all dielectric.
struct MicrofacetModel : MicrofacetForm {
  Rgb diffuse{0, 0, 0};  // of the base, over pi; with reciprocal scaling also over 1 - mean albedo
  double base_roughness = 0;  // of forms that are not Lambert's
  Rgb base_ratio{0, 0, 0};    // kOrenNayar: EonMultipleRatio of the base's colour
  double metallic = 0;        // the metal's share of the mix
  // Reflectance at normal incidence, and of Schlick's curve (and F82's) at grazing incidence; the
  // metal's at grazing incidence is 1.
  Rgb dielectric_f0{0, 0, 0};
  double dielectric_f90 = 1;
  Rgb metal_f0{0, 0, 0};
  Rgb f82_slope{0, 0, 0};        // kF82: the metal's
  Rgb eta{0, 0, 0}, k{0, 0, 0};  // kDielectric (eta), kConductor
  Rgb f0{0, 0, 0};               // of the mix
  double f90 = 1;
  // kKullaConty: the means of both Fresnel curves; what light that bounced more than once has left
  // of the dielectric's reflection, F_ms, and of the mix.
  Rgb dielectric_f_average{0, 0, 0}, metal_f_average{0, 0, 0};
  Rgb dielectric_f_multiple{0, 0, 0}, f_multiple{0, 0, 0};
  double multiple = 0;  // kKullaConty: 1 / (pi (1 - E_avg)); 0 where nothing is lost
  double alpha;         // of the lobe
  double schlick_k;     // SchlickK
  bool delta;           // a perfect mirror, which punctual lights cannot show
  bool double_terms;
  bool prepared = false;    // shading needs what PrepareRun computes
  FresnelAlbedoFit albedo;  // kDielectric: with the curve of its index
  // kDielectric with a roughness for each hit: those curves of all roughnesses; else null.
  std::shared_ptr<const DielectricCurves> curves;
  MicrofacetConstants<float> constants;  // the numbers above, as kernels read them
};

// A model of the caller's own (user_model.h); it is not null.
struct UserModel {
  std::shared_ptr<const UserBrdf> brdf;
};

// A material prepared for shading; a split has no model of its own.
struct ShadingMaterial {
  Rgb of_ambient{0, 0, 0};  // what it reflects of light from everywhere
  Rgb emission{0, 0, 0};
  // For the albedo layer: diffuse reflectance, or base colour, or F0 of a conductor.
  Rgb albedo{0, 0, 0};
  // Of materials whose numbers depend on the hit: the scene's, which outlives this; else null. The
  // model is then that of the maps' factors. They depend on it where there are maps, and where a
  // coat or a layer covers ambient light or emission.
  const Material* textured = nullptr;
  bool mapped = false;        // each hit has numbers of its own
  bool mapped_model = false;  // of its reflection, not of its emission alone
  bool mapped_width = false;  // of the width of its lobe
  bool turned = false;        // maps turn the normal
  bool in_ambient = false;    // there is ambient light, which it reflects
  // `coat`: of materials with a clear coat (scene/coat.h), which is shaded as a surface of its own.
  std::shared_ptr<const ShadingMaterial> coat;
  std::shared_ptr<const Material> own;  // of a coat: what its `textured` points to
  std::variant<std::monostate, MatteModel, PhongFamilyModel, MicrofacetModel, UserModel> model;
  std::vector<LayerModel> layers;  // over the model, bottom to top, under the coat
};

// `in_ambient`: in a scene with ambient light.
ShadingMaterial PrepareMaterial(const Material& material, bool in_ambient = false);

// Leaves the material of the maps' factors.
void DropMaps(ShadingMaterial* material);

// What a coat leaves of the light of what is below, seen from n.v: 1 less its albedo.
Rgb LeftByCoat(const ShadingMaterial& coat, double n_dot_v);

// The directional albedo of one channel seen from n.v, compensation included, of what covers the
// base: of a mix with a metal, the dielectric.
double CoverAlbedo(const MicrofacetModel& model, double n_dot_v, int channel);

// Whether a lobe's terms are formed in double where maps give the hit this roughness.
inline bool IsSharp(double roughness, double alpha) {
  return !IsDeltaLobe(alpha) && roughness < kDoubleTermsRoughness;
}

// True if the material has a lobe whose terms are formed in double, or, with maps, may have.
bool HasDoubleTerms(const ShadingMaterial& material);

// True if the material has a perfect mirror's lobe.
bool HasDeltaLobe(const ShadingMaterial& material);

}  // namespace nacre
