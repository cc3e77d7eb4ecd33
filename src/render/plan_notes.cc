// SPDX-License-Identifier: Apache-2.0
#include "render/plan_notes.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "base/overloaded.h"
#include "brdf/burley.h"
#include "brdf/ggx.h"
#include "brdf/phong.h"
#include "scene/coat.h"

namespace nacre {
namespace {

// Names the first of the used materials for which `test` holds, and counts the others, as in
// `material "red" and 2 more`. Empty if there is none.
template <class Test>
std::string NameMaterials(const Scene& scene, const Test& test) {
  const std::vector<bool> used = FindUsedMaterials(scene);
  std::string first;
  size_t count = 0;
  for (size_t i = 0; i < scene.materials.size(); ++i) {
    if (!used[i] || !test(i)) continue;
    if (count++ == 0) first = scene.materials[i].name;
  }
  if (count == 0) return {};
  const std::string others = count > 1 ? fmt::format(" and {} more", count - 1) : "";
  return fmt::format("material \"{}\"{}", first, others);
}

// The roughness of a material with a GGX lobe; else 0.
double LobeRoughness(const Material& material) {
  return std::visit(
      [](const auto& model) {
        if constexpr (requires { model.shadowing; }) {
          return model.roughness;
        } else {
          return 0.0;
        }
      },
      material.model);
}

// A perfect mirror reflects only what has an extent. This notes mirrors where no light has one, if
// there are lights.
// `parameter`: the name of the roughness that makes material i a mirror if is_mirror(i), and whose
// value is roughness_of(i).
template <class IsMirror, class RoughnessOf>
void NoteMirrors(const Scene& scene, const char* parameter, const IsMirror& is_mirror,
                 const RoughnessOf& roughness_of, std::vector<std::string>* notes) {
  double greatest = 0;
  int count = 0;
  const std::string names = NameMaterials(scene, [&](size_t i) {
    if (!is_mirror(i)) return false;
    greatest = std::max(greatest, roughness_of(i));
    ++count;
    return true;
  });
  if (names.empty()) return;
  notes->push_back(fmt::format(
      "{}: {}{} {:.6g}{} is below 2^-20 ({:.3g}) and so a perfect mirror, in which point, spot and "
      "directional lights have no highlight; a {} of 2^-20 or more gives them one",
      names, count > 1 ? "the greatest " : "", count > 1 ? std::string(parameter) + "," : parameter,
      greatest, count > 1 ? "," : "", kDeltaRoughness, parameter));
}

void NoteMirrors(const Scene& scene, const std::vector<ShadingMaterial>& materials,
                 std::vector<std::string>* notes) {
  NoteMirrors(
      scene, "roughness", [&](size_t i) { return HasDeltaLobe(materials[i]); },
      [&](size_t i) { return LobeRoughness(scene.materials[i]); }, notes);
  NoteMirrors(
      scene, "coat_roughness",
      [&](size_t i) { return materials[i].coat && HasDeltaLobe(*materials[i].coat); },
      [&](size_t i) { return LobeRoughness(*CoatOf(scene.materials[i])); }, notes);
}

// The share of grazing light that Burley's diffuse term reflects, in the brightest channel; 0 for
// other models.
double BurleyGain(const ShadingMaterial& material) {
  const auto gain = [](const Rgb& diffuse, double roughness) {
    return LargestChannel(diffuse) * M_PI * BurleyGrazingAlbedo(roughness);
  };
  return std::visit(
      Overloaded{[&](const MatteModel& matte) {
                   const bool burley = matte.form == DiffuseForm::kBurley;
                   return burley ? gain(matte.diffuse, matte.roughness) : 0.0;
                 },
                 [&](const MicrofacetModel& model) {
                   // Scaled by what the lobe's albedo leaves, which vanishes at grazing angles, the
                   // term cannot reflect more than it gets.
                   const bool burley = model.base_form == DiffuseForm::kBurley &&
                                       model.coupling == DiffuseCoupling::kNone;
                   return burley ? gain(model.diffuse, model.base_roughness) : 0.0;
                 },
                 [](const PhongFamilyModel&) { return 0.0; }, [](const auto&) { return 0.0; }},
      material.model);
}

void NoteGain(const Scene& scene, const std::vector<ShadingMaterial>& materials,
              std::vector<std::string>* notes) {
  double most = 1;
  const std::string names = NameMaterials(scene, [&](size_t i) {
    const double gain = BurleyGain(materials[i]);
    most = std::max(most, gain);
    return gain > 1;
  });
  if (names.empty()) return;
  notes->push_back(
      fmt::format("{}: burley reflects up to {:.2f} times the light that grazes it; oren_nayar "
                  "keeps energy",
                  names, most));
}

bool IsBlackSky(const EnvironmentLight& light) {
  return std::visit(
      Overloaded{[](const ConstantSky& sky) { return IsBlack(sky.radiance); },
                 [](const GradientSky& sky) {
                   return IsBlack(sky.zenith) && IsBlack(sky.horizon) && IsBlack(sky.ground);
                 },
                 [](const QuadraticSky& sky) {
                   return IsBlack(sky.radiance) ||
                          (sky.constant == 0 && sky.linear == 0 && sky.quadratic == 0);
                 },
                 [](const PictureSky& sky) {
                   // A channel whose scale is 0 lights nothing.
                   const auto& rgb = sky.picture->rgb;
                   for (size_t i = 0; i < rgb.size(); ++i) {
                     if (rgb[i] * sky.scale[static_cast<int>(i % 3)] > 0) return false;
                   }
                   return true;
                 }},
      light.sky);
}

bool EmitsLight(const Light& light) {
  return std::visit(Overloaded{[](const AmbientLight& l) { return !IsBlack(l.radiance); },
                               [](const DirectionalLight& l) { return !IsBlack(l.irradiance); },
                               [](const PointLight& l) { return !IsBlack(l.intensity); },
                               [](const SpotLight& l) { return !IsBlack(l.intensity); },
                               [](const EnvironmentLight& l) { return !IsBlackSky(l); },
                               [](const auto& l) { return !IsBlack(l.radiance); }},
                    light.kind);
}

// A scene without light is probably a mistake, unless its materials emit.
void NoteDarkness(const Scene& scene, std::vector<std::string>* notes) {
  if (scene.spheres.empty() && scene.meshes.empty()) return;
  if (std::any_of(scene.lights.begin(), scene.lights.end(), EmitsLight)) return;
  const std::vector<bool> used = FindUsedMaterials(scene);
  bool emits = false;
  for (size_t i = 0; i < scene.materials.size(); ++i) {
    emits = emits || (used[i] && !IsBlack(scene.materials[i].emission));
  }
  notes->push_back(
      fmt::format("{}: {}; \"lights\" of the scene, or --environment IMAGE, light it",
                  scene.lights.empty() ? "the scene has no lights" : "all lights are black",
                  emits ? "only what its materials emit is seen" : "every shape is black"));
}

// The largest radiance, in the brightest channel, that a radiometric Phong material of this model
// reflects in surroundings of radiance 1; else 0. With the classic convention, kd and ks are no
// reflectances that could exceed 1.
double PhongGain(const Material& material, PhongModel model) {
  const auto* phong = std::get_if<PhongMaterial>(&material.model);
  if (phong == nullptr || phong->model != model) return 0;
  if (phong->convention != PhongConvention::kRadiometric) return 0;
  double lobe = 1;
  // A map may reduce the exponent to 0, which widens the lobe.
  const double shininess = phong->shininess_map.valid() ? 0 : phong->shininess;
  if (model == PhongModel::kPhong) lobe = PhongFurnace(shininess);
  if (model == PhongModel::kBlinnPhong) lobe = BlinnFurnace(shininess);
  return LargestChannel(phong->kd * phong->color + phong->ks * lobe);
}

void NotePhongGain(const Scene& scene, std::vector<std::string>* notes) {
  for (const auto& [model, name] : {std::pair{PhongModel::kPhong, "phong"},
                                    std::pair{PhongModel::kModifiedPhong, "modified_phong"},
                                    std::pair{PhongModel::kBlinnPhong, "blinn_phong"}}) {
    double most = 1;
    const std::string names = NameMaterials(scene, [&, of = model](size_t i) {
      const double gain = PhongGain(scene.materials[i], of);
      most = std::max(most, gain);
      return gain >= 1.005;  // less would be printed as 1.00
    });
    if (names.empty()) continue;
    const bool modified = model == PhongModel::kModifiedPhong;
    notes->push_back(fmt::format(
        "{}: {} reflects up to {:.2f} times the light from all around{}; {}kd + ks of 1 at most "
        "keeps energy",
        names, name, most, modified ? "" : ", and of light that grazes it any multiple",
        modified ? "" : "modified_phong with "));
  }
}

}  // namespace

std::vector<bool> FindUsedMaterials(const Scene& scene) {
  std::vector<bool> used(scene.materials.size());
  for (const Sphere& sphere : scene.spheres) used[sphere.material.index] = true;
  for (const Mesh& mesh : scene.meshes) used[mesh.material.index] = true;
  for (size_t i = 0; i < scene.materials.size(); ++i) {
    const auto* split = std::get_if<SplitMaterial>(&scene.materials[i].model);
    if (split == nullptr || !used[i]) continue;
    for (const MaterialId id : split->materials) used[id.index] = true;
  }
  return used;
}

void NoteMaterials(const Scene& scene, const std::vector<ShadingMaterial>& materials,
                   bool sampled_lights, std::vector<std::string>* notes) {
  NoteDarkness(scene, notes);
  const bool has_punctual = std::any_of(scene.lights.begin(), scene.lights.end(), IsPunctual);
  if (!sampled_lights && has_punctual) NoteMirrors(scene, materials, notes);
  NoteGain(scene, materials, notes);
  NotePhongGain(scene, notes);
}

}  // namespace nacre
