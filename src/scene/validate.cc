// SPDX-License-Identifier: Apache-2.0
// scene/validate.cc: checks camera, image and materials. Shapes: validate_shapes.cc; lights:
// validate_lights.cc.
#include "scene/validate.h"

#include <algorithm>
#include <variant>

#include <fmt/format.h>

#include "scene/limits.h"
#include "scene/material_parameters.h"
#include "scene/validate_numbers.h"

namespace nacre {

// Defined in validate_shapes.cc, validate_lights.cc and validate_textures.cc.
void ValidateShapes(const Scene& scene, FaultList* faults);
void ValidateMaterialsOfShapes(const Scene& scene, FaultList* faults);
void ValidatePrimitives(const Scene& scene, FaultList* faults);
void ValidateLights(const Scene& scene, FaultList* faults);
void ValidateTextures(const Scene& scene, FaultList* faults);
void ValidateMaps(const Scene& scene, const Material& material, const std::string& where,
                  FaultList* faults);

namespace {

void ValidateCamera(const Camera& camera, FaultList* faults) {
  const size_t before = faults->count();
  CheckKeys(camera, "/camera", faults);
  if (faults->count() != before) return;

  const Vec3d view = camera.look_at - camera.position;
  if (view.length() == 0) {
    faults->Add("/camera/look_at", "is the camera's position", "look at some other point");
  } else if (view.normalized().cross(camera.up.normalized()).length() < kMinSineOfUp) {
    faults->Add("/camera/up", "is parallel to the view", "for a view along y take [0, 0, 1]");
  }
}

void ValidateImage(const ImageSettings& image, FaultList* faults) {
  const size_t before = faults->count();
  CheckKeys(image, "/image", faults);
  if (faults->count() != before) return;

  const double samples = static_cast<double>(image.width) * image.height * image.spp;
  if (samples > limits::kMaxSamples) {
    faults->Add("/image", fmt::format("width x height x spp is {:g} samples", samples),
                fmt::format("at most {:g}", limits::kMaxSamples));
  }
}

std::string MaterialPlace(const Scene& scene, size_t index) {
  const std::string& name = scene.materials[index].name;
  return "/materials/" + (name.empty() ? std::to_string(index) : PointerToken(name));
}

// Limits memory: each material may need tangents of its own on every mesh of the split, which are
// as large as the mesh.
constexpr size_t kMostSplitMaterials = 64;

void ValidateSplit(const Scene& scene, const Material& material, const std::string& where,
                   FaultList* faults) {
  const auto& split = std::get<SplitMaterial>(material.model);
  if (split.materials.size() != split.at.size() + 1) {
    faults->Add(where + "/materials",
                fmt::format("{} materials for {} places to split at", split.materials.size(),
                            split.at.size()),
                "one more than \"at\" has numbers");
  }
  if (split.materials.size() > kMostSplitMaterials) {
    faults->Add(where + "/materials", fmt::format("{} materials", split.materials.size()),
                fmt::format("a split has {} at most", kMostSplitMaterials));
    return;
  }
  for (size_t i = 0; i < split.at.size(); ++i) {
    const std::string place = fmt::format("{}/at/{}", where, i);
    CheckNumber(split.at[i], limits::kSplitAt, place, faults);
    if (i > 0 && split.at[i] <= split.at[i - 1]) {
      faults->Add(place, fmt::format("{} after {}", split.at[i], split.at[i - 1]),
                  "the numbers ascend from left to right");
    }
  }
  for (size_t i = 0; i < split.materials.size(); ++i) {
    const std::string place = fmt::format("{}/materials/{}", where, i);
    const MaterialId id = split.materials[i];
    CheckMaterial(id, scene.materials.size(), place, faults);
    if (id.index >= scene.materials.size()) continue;
    const Material& part = scene.materials[id.index];
    if (std::holds_alternative<SplitMaterial>(part.model)) {
      faults->Add(place, "is a split itself", "name each band's material in one split");
    }
    if (CutsHoles(part)) {
      faults->Add(place, "its opacity cuts holes, which shadows would have in other bands, too",
                  "give the mesh that material, without a split");
    }
    if (part.single_sided) {
      faults->Add(place, "it is single-sided, and shadows would be so in other bands, too",
                  "give the mesh that material, without a split");
    }
  }
  if (material.emission != Rgb(0, 0, 0)) {
    faults->Add(where + "/emission", "a split has no emission", "give it to the materials in it");
  }
  if (material.emission_map.valid() || material.normal_map.texture.valid() ||
      material.bump_map.texture.valid() || CutsHoles(material)) {
    faults->Add(where, "a split has no maps", "give them to the materials in it");
  }
}

}  // namespace

bool IsLayerName(const std::string& name) {
  return !name.empty() && name.size() <= 64 && std::all_of(name.begin(), name.end(), [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
           c == '-' || c == ' ';
  });
}

namespace {

// Schlick's forms of shadowing have one width.
void CheckAnisotropy(const Scene& scene, size_t index, FaultList* faults) {
  const auto check = [&](double anisotropy, Shadowing shadowing, std::string_view key) {
    const bool is_schlick =
        shadowing == Shadowing::kSchlickDirect || shadowing == Shadowing::kSchlickIbl;
    if (!(anisotropy > 0) || !is_schlick) return;
    faults->Add(fmt::format("{}/{}", MaterialPlace(scene, index), key),
                "Schlick's forms of shadowing do not know anisotropy",
                "choose height_correlated or separable");
  };
  const Material& material = scene.materials[index];
  if (const auto* model = std::get_if<MetallicRoughnessMaterial>(&material.model)) {
    check(model->anisotropy, model->shadowing, "shadowing");
  } else if (const auto* open_pbr = std::get_if<OpenPbrMaterial>(&material.model)) {
    check(open_pbr->specular_roughness_anisotropy, open_pbr->options.smith, "smith");
    if (open_pbr->coat_weight > 0) {
      check(open_pbr->coat_roughness_anisotropy, open_pbr->options.smith, "smith");
    }
  }
}

}  // namespace

void ValidateMaterial(const Scene& scene, size_t index, FaultList* faults) {
  const Material& material = scene.materials[index];
  ValidateMaps(scene, material, MaterialPlace(scene, index), faults);
  const MaterialModel* model = ModelOf(material);
  if (model == nullptr) return ValidateSplit(scene, material, MaterialPlace(scene, index), faults);
  for (const MaterialParameter& parameter : model->parameters) {
    const Rgb value = parameter.get(material);
    const Range& range = parameter.range;
    if (range.Contains(value.x) && range.Contains(value.y) && range.Contains(value.z)) continue;
    const std::string where = MaterialPlace(scene, index) + "/" + std::string(parameter.name);
    if (parameter.is_color) {
      CheckColor(value, range, where, faults);
    } else {
      CheckNumber(value.x, range, where, faults);
    }
  }
  CheckAnisotropy(scene, index, faults);
  if (const auto* open_pbr = std::get_if<OpenPbrMaterial>(&material.model)) {
    if (!(LargestChannel(EmissionOf(material)) <= limits::kRadiance.max)) {
      faults->Add(MaterialPlace(scene, index) + "/emission_color",
                  fmt::format("times emission_luminance it is above {:g}", limits::kRadiance.max),
                  "give a smaller luminance");
    }
    const OpenPbrOptions& options = open_pbr->options;
    if (options.layering == Layering::kReciprocal &&
        options.compensation == Compensation::kTurquin) {
      faults->Add(MaterialPlace(scene, index) + "/layering",
                  "reciprocal layering needs an albedo of light and view alike, which compensation "
                  "turquin does not have",
                  "choose layering view, or compensation kulla_conty");
    }
  }
}

std::vector<Fault> Validate(const Scene& scene) { return Validate(scene, SceneParts::All()); }

std::vector<Fault> Validate(const Scene& scene, SceneParts parts) {
  constexpr SceneParts kMaterials = ScenePart::kMaterials | ScenePart::kTextures;
  FaultList faults;
  if (parts.Has(ScenePart::kCamera)) ValidateCamera(scene.camera, &faults);
  if (parts.Has(ScenePart::kImage)) ValidateImage(scene.image, &faults);
  if (parts.Has(ScenePart::kBackground)) {
    CheckColor(scene.background, limits::kRadiance, "/background", &faults);
  }
  if (parts.HasAny(kMaterials)) {
    for (size_t i = 0; i < scene.materials.size(); ++i) ValidateMaterial(scene, i, &faults);
  }
  if (parts.HasAny(kMaterials | ScenePart::kShapes)) ValidateTextures(scene, &faults);
  if (parts.Has(ScenePart::kLights)) ValidateLights(scene, &faults);
  if (parts.Has(ScenePart::kShapes)) ValidateShapes(scene, &faults);
  if (parts.HasAny(kMaterials | ScenePart::kShapes)) ValidateMaterialsOfShapes(scene, &faults);
  if (parts.HasAny(ScenePart::kShapes | ScenePart::kLights)) ValidatePrimitives(scene, &faults);
  return faults.All();
}

}  // namespace nacre
