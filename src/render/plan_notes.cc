// SPDX-License-Identifier: Apache-2.0
#include "render/plan_notes.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "base/overloaded.h"
#include "brdf/ggx.h"
#include "scene/coat.h"
#include "shading/user_model.h"

namespace nacre {
namespace {

// Names the first of the used materials that have the trait and for which `test` holds, and counts
// the others, as in `material "red" and 2 more`. Empty if there is none.
template <class Test>
std::string NameMaterials(const NotedMaterials& of, MaterialTrait trait, const Test& test) {
  const Scene& scene = of.scene;
  std::string first;
  size_t count = 0;
  if (!Has(of.prepared.any, trait)) return first;
  for (size_t i = 0; i < scene.materials.size(); ++i) {
    if (!Has(of.prepared.traits[i], trait) || !of.used[i] || !test(i)) continue;
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
        if constexpr (requires { model.shadowing; }) return model.roughness;
        if constexpr (requires { model.specular_roughness; }) return model.specular_roughness;
        return 0.0;
      },
      material.model);
}

// Notes perfect mirrors where there are lights, but none with an extent: a mirror reflects only
// what has an extent. `trait` is kMirror or kCoatMirror.
void NoteMirrors(const NotedMaterials& of, MaterialTrait trait, std::vector<std::string>* notes) {
  double greatest = 0;
  std::string_view parameter = "roughness";  // of the last one, or of the coat with the greatest
  int count = 0;
  const std::string names = NameMaterials(of, trait, [&](size_t i) {
    const Material& material = of.scene.materials[i];
    if (trait == MaterialTrait::kMirror) {
      greatest = std::max(greatest, LobeRoughness(material));
      if (std::holds_alternative<OpenPbrMaterial>(material.model)) parameter = "specular_roughness";
    }
    for (const Coat& coat : CoatsOf(material)) {
      const double roughness = LobeRoughness(coat.material);
      if (trait == MaterialTrait::kMirror || roughness >= kDeltaRoughness) continue;
      if (roughness >= greatest) parameter = coat.roughness;
      greatest = std::max(greatest, roughness);
    }
    ++count;
    return true;
  });
  if (names.empty()) return;
  notes->push_back(
      fmt::format("{}: {}{}{} {:.6g}{} is below 2^-20 ({:.3g}) and so a perfect mirror, in which "
                  "point, spot and directional lights have no highlight; a {} of 2^-20 or more "
                  "gives them one",
                  names, count > 1 ? "the greatest " : "", parameter, count > 1 ? "," : "",
                  greatest, count > 1 ? "," : "", kDeltaRoughness, parameter));
}

void NoteGain(const NotedMaterials& of, std::vector<std::string>* notes) {
  double most = 1;
  const std::string names = NameMaterials(of, MaterialTrait::kBurleyGain, [&](size_t i) {
    most = std::max(most, BurleyGain(of.prepared.all[i]));
    return true;
  });
  if (names.empty()) return;
  notes->push_back(
      fmt::format("{}: burley reflects up to {:.2f} times the light that grazes it; oren_nayar "
                  "keeps energy",
                  names, most));
}

// Measurements may reflect more than they get, of all light: by their errors, or because light of
// grazing angles was extrapolated.
void NoteMeasuredGain(const NotedMaterials& of, std::vector<std::string>* notes) {
  constexpr double kNotedGain = 1.005;
  double most = 1;
  const std::string names = NameMaterials(of, MaterialTrait::kMeasured, [&](size_t i) {
    double largest = 0;
    for (const Rgb& albedo : std::get<MeasuredModel>(of.prepared.all[i].model).brdf->albedo) {
      largest = std::max(largest, LargestChannel(albedo));
    }
    most = std::max(most, largest);
    return largest >= kNotedGain;
  });
  if (names.empty()) return;
  notes->push_back(fmt::format(
      "{}: its measurements reflect up to {:.2f} times the light that they get", names, most));
}

void NoteMeasuredBlack(const NotedMaterials& of, std::vector<std::string>* notes) {
  const std::string names = NameMaterials(of, MaterialTrait::kMeasured, [&](size_t i) {
    return IsBlack(std::get<MeasuredModel>(of.prepared.all[i].model).brdf->mean_albedo);
  });
  if (!names.empty()) notes->push_back(names + ": its table has no data, so that it is black");
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
void NoteDarkness(const NotedMaterials& of, std::vector<std::string>* notes) {
  const Scene& scene = of.scene;
  if (scene.spheres.empty() && scene.meshes.empty()) return;
  if (std::any_of(scene.lights.begin(), scene.lights.end(), EmitsLight)) return;
  const bool emits = !NameMaterials(of, MaterialTrait::kEmits, [](size_t) { return true; }).empty();
  notes->push_back(
      fmt::format("{}: {}; \"lights\" of the scene, or --environment IMAGE, light it",
                  scene.lights.empty() ? "the scene has no lights" : "all lights are black",
                  emits ? "only what its materials emit is seen" : "every shape is black"));
}

void NotePhongGain(const NotedMaterials& of, std::vector<std::string>* notes) {
  for (const auto& named : {std::pair{PhongModel::kPhong, "phong"},
                            std::pair{PhongModel::kModifiedPhong, "modified_phong"},
                            std::pair{PhongModel::kBlinnPhong, "blinn_phong"}}) {
    double most = 1;
    const std::string names = NameMaterials(of, MaterialTrait::kPhongGain, [&](size_t i) {
      if (std::get<PhongMaterial>(of.scene.materials[i].model).model != named.first) return false;
      most = std::max(most, of.prepared.phong_gains[i]);
      return true;
    });
    if (names.empty()) continue;
    const bool modified = named.first == PhongModel::kModifiedPhong;
    notes->push_back(fmt::format(
        "{}: {} reflects up to {:.2f} times the light from all around{}; {}kd + ks of 1 at most "
        "keeps energy",
        names, named.second, most, modified ? "" : ", and of light that grazes it any multiple",
        modified ? "" : "modified_phong with "));
  }
}

}  // namespace

std::vector<bool> FindUsedMaterials(const Scene& scene, bool splits) {
  std::vector<bool> used(scene.materials.size());
  for (const Sphere& sphere : scene.spheres) used[sphere.material.index] = true;
  for (const Mesh& mesh : scene.meshes) used[mesh.material.index] = true;
  for (size_t i = 0; splits && i < scene.materials.size(); ++i) {
    const auto* split = std::get_if<SplitMaterial>(&scene.materials[i].model);
    if (split == nullptr || !used[i]) continue;
    for (const MaterialId id : split->materials) used[id.index] = true;
  }
  return used;
}

void NoteNarrowLobes(const NotedMaterials& of, int max_samples, std::vector<std::string>* notes) {
  const Scene& scene = of.scene;
  const bool surrounded = std::ranges::any_of(scene.lights, [](const Light& l) {
    return std::holds_alternative<EnvironmentLight>(l.kind);
  });
  if (!surrounded) return;
  for (size_t i = 0; i < scene.materials.size(); ++i) {
    const auto* const user = std::get_if<UserModel>(&of.prepared.all[i].model);
    if (user == nullptr || user->brdf->sample || !of.used[i]) continue;
    // If the half vector is within `width` of the normal, the direction to light is within twice
    // that of the mirror direction, where at most 4 width^2 of the cosine-distributed samples lie.
    // With 16 hits the error is a fourth.
    const double width = UserLobeWidth(*user);
    if (4 * width * width * max_samples >= 16) continue;
    notes->push_back(fmt::format(
        "material \"{}\": {} samples of its surroundings hardly find its lobe, whose width is "
        "about "
        "{:.2g} degrees: give the function a sampler (sample= and pdf=), or more samples",
        scene.materials[i].name, max_samples, width * 180 / M_PI));
  }
}

void NoteTransmission(const NotedMaterials& of, std::vector<std::string>* notes) {
  const std::string names =
      NameMaterials(of, MaterialTrait::kTransmits, [](size_t) { return true; });
  if (names.empty()) return;
  notes->push_back(names + ": the light that passes through is not rendered; the base is opaque");
}

void NoteHaze(const NotedMaterials& of, std::vector<std::string>* notes) {
  const std::string names = NameMaterials(of, MaterialTrait::kHazy, [](size_t) { return true; });
  if (names.empty()) return;
  notes->push_back(names +
                   ": specular_haze and specular_retroreflectivity are not rendered: the lobe is "
                   "that of specular_roughness alone");
}

void NoteMaterials(const NotedMaterials& of, bool sampled_lights, std::vector<std::string>* notes) {
  NoteDarkness(of, notes);
  const std::vector<Light>& lights = of.scene.lights;
  const bool has_punctual = std::any_of(lights.begin(), lights.end(), IsPunctual);
  if (!sampled_lights && has_punctual) {
    NoteMirrors(of, MaterialTrait::kMirror, notes);
    NoteMirrors(of, MaterialTrait::kCoatMirror, notes);
  }
  NoteGain(of, notes);
  NotePhongGain(of, notes);
  NoteTransmission(of, notes);
  NoteHaze(of, notes);
  NoteMeasuredGain(of, notes);
  NoteMeasuredBlack(of, notes);
}

}  // namespace nacre
