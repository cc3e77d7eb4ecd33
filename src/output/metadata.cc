// SPDX-License-Identifier: Apache-2.0
#include "output/metadata.h"

#include <set>
#include <variant>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/target.h"
#include "base/version.h"
#include "render/camera.h"
#include "scene/hash.h"
#include "scene/material_parameters.h"

namespace nacre {
namespace {

// By FilterKind.
constexpr const char* kFilterNames[] = {"box", "gaussian", "blackman_harris", "mitchell"};

}  // namespace

const char* PixelTypeName(PixelType type) {
  return type == PixelType::kHalf ? "half" : type == PixelType::kFloat ? "float" : "uint";
}

void AddMetadata(const ExrHeader& header, Image* image) {
  const auto text = [](const auto& value) { return fmt::format("{}", value); };
  for (const auto& [name, attribute] : header.attributes) {
    image->metadata[name] = std::visit(text, attribute);
  }
  const auto add_matrix = [&](const char* name, const std::optional<Imath::M44f>& matrix) {
    if (!matrix) return;
    const float* const first = &(*matrix)[0][0];
    image->metadata[name] = fmt::format("{}", fmt::join(first, first + 16, " "));
  };
  add_matrix("worldToCamera", header.world_to_camera);
  add_matrix("worldToNDC", header.world_to_ndc);
  image->metadata["transfer"] = "linear";
}

std::string SoftwareName() { return fmt::format("nacre {}", kVersion); }

std::string ShadowingForms(MaterialTraits traits) {
  std::set<std::string_view> forms;
  const Material any = FindModel("metallic_roughness")->make();
  for (const MaterialChoice& choice : ModelOf(any)->choices) {
    if (choice.name != "shadowing") continue;
    for (size_t i = 0; i < choice.options.size(); ++i) {
      const auto first = static_cast<MaterialTraits>(MaterialTrait::kFirstShadowing);
      if ((traits & first << i) != 0) forms.insert(choice.options[i]);
    }
  }
  return forms.empty() ? "none" : fmt::format("{}", fmt::join(forms, ", "));
}

namespace {

// The hash of the planned scene, which reuses the parts that `prepared` keeps. The shapes of
// visible flat lights depend slightly on the camera.
uint64_t HashPlanned(const FramePlan& plan, PreparedScene* prepared) {
  if (prepared == nullptr) return HashScene(*plan.scene);
  const SceneParts parts = plan.with_lights ? SceneParts(ScenePart::kCamera) : SceneParts();
  const ViewKey key{prepared->shapes_made, prepared->versions.Of(parts), {}};
  const SceneVersions& versions = prepared->versions;
  if (!prepared->shapes_hash.IsUpToDate(key)) {
    // Of a scene with its lights' shapes, spheres are not numbered as in the scene without.
    const auto spheres = plan.with_lights || !prepared->shapes_hashed
                             ? std::nullopt
                             : versions.SpheresSince(*prepared->shapes_hashed);
    prepared->shapes_hash.Forget();  // in case memory runs out before the key is set again
    if (!spheres) {
      prepared->hashes.ForgetShapes();
    } else {
      for (const uint32_t i : *spheres) prepared->hashes.ForgetSphere(i);
    }
  }
  const ViewKey of_lights{
      plan.with_lights ? prepared->shapes_made : 0,
      versions.Of(plan.with_lights ? SceneParts(ScenePart::kLights) : SceneParts()),
      {}};
  const auto changed = versions.MaterialsSince(prepared->materials_hashed);
  if (!changed || !prepared->material_hashes.IsUpToDate(of_lights)) {
    prepared->hashes.ForgetMaterials();
  } else {
    for (const uint32_t i : *changed) prepared->hashes.ForgetMaterial(i);
  }
  prepared->material_hashes.Forget();  // in case memory runs out before the key is set again
  const uint64_t hash = HashScene(*plan.scene, &prepared->hashes);
  prepared->shapes_hash.Set(key, {});
  prepared->shapes_hashed = plan.with_lights ? std::nullopt : std::optional(versions.shapes());
  prepared->material_hashes.Set(of_lights, {});
  prepared->materials_hashed = versions.materials();
  return hash;
}

// The name of a setting as an attribute: max_error becomes nacre:maxError.
std::string AttributeOf(std::string_view setting) {
  std::string name = "nacre:";
  bool begins_word = false;
  for (const char c : setting) {
    if (c != '_') name += begins_word ? static_cast<char>(c - 'a' + 'A') : c;
    begins_word = c == '_';
  }
  return name;
}

}  // namespace

ExrHeader MakeExrHeader(const FramePlan& plan, bool reproducible, const std::string& tile,
                        PreparedScene* prepared) {
  const Scene& scene = *plan.scene;
  const ImageSettings& image = scene.image;
  ExrHeader header;
  header.display = plan.frame;
  header.data = plan.window;
  header.world_to_camera = Imath::M44f(WorldToCamera(scene.camera));
  header.world_to_ndc = Imath::M44f(WorldToNdc(scene.camera, image.width, image.height));
  auto& attributes = header.attributes;
  attributes["Software"] = SoftwareName();
  attributes["samplesPerPixel"] = image.spp;
  attributes["nacre:version"] = std::string(kVersion);
  attributes["nacre:commit"] = std::string(kCommit);
  attributes["nacre:target"] = TargetName(ActiveTarget());
  attributes["nacre:sceneHash"] = fmt::format("{:016x}", HashPlanned(plan, prepared));
  attributes["nacre:shadowing"] = ShadowingForms(plan.surfaces.prepared->any);
  attributes["nacre:settings"] =
      fmt::format("size={}x{} spp={} filter={} filter_width={} seed={} shadows={}", image.width,
                  image.height, image.spp, kFilterNames[static_cast<size_t>(image.filter.kind)],
                  image.filter.width, image.seed, image.shadows ? "on" : "off");
  for (const auto& [name, value] : plan.changed_settings) attributes[AttributeOf(name)] = value;
  if (plan.adaptive.max_error > 0) attributes["nacre:maxSamples"] = plan.adaptive.max_samples;
  if (!tile.empty()) attributes[kTileAttribute] = tile;
  if (!reproducible) attributes[kRenderTimeAttribute] = 0.0f;
  return header;
}

}  // namespace nacre
