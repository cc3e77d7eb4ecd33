// SPDX-License-Identifier: Apache-2.0
#include "scene_io/gltf_materials.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "base/excerpt.h"
#include "scene/limits.h"
#include "scene_io/gltf_extension.h"
#include "scene_io/gltf_textures.h"
#include "scene_io/unique_names.h"

namespace nacre {
namespace {

std::optional<GltfExtension> FindExtension(const GltfDocument& document,
                                           const gltf::Material& material, size_t index,
                                           const char* name) {
  const Json* const found = gltf::FindExtension(material.extensions, name);
  if (found == nullptr) return std::nullopt;
  return GltfExtension(document, *found, fmt::format("/materials/{}/extensions/{}", index, name));
}

Rgb ColorOf(const std::vector<double>& factor, const Rgb& otherwise) {
  return factor.size() < 3 ? otherwise : Rgb(factor[0], factor[1], factor[2]);
}

Rgb EmissionOf(const GltfDocument& document, const gltf::Material& material, size_t index) {
  const std::string place = fmt::format("/materials/{}/", index);
  const auto extension =
      FindExtension(document, material, index, "KHR_materials_emissive_strength");
  const double strength = extension ? extension->Number("emissiveStrength", 1) : 1;
  const Rgb factor = ColorOf(material.emissiveFactor, Rgb(0));
  document.Check(place + "emissiveFactor", factor, limits::kRadiance);
  document.Check(place + "extensions/KHR_materials_emissive_strength/emissiveStrength",
                 factor * strength, limits::kRadiance);
  return factor * strength;
}

// Adds a texture that a member of a material refers to; `info` is some kind of TextureInfo.
template <class Info>
TextureId AddTexture(const Info& info, const std::string& place, TextureEncoding encoding,
                     GltfTextures* textures) {
  return textures->Add({info.index, info.texCoord, info.extensions, encoding}, place);
}

// Adds the texture in the member `name` of an extension. `glossiness`: GltfTextureUse::glossiness.
TextureId AddTexture(const GltfDocument& document, const GltfExtension& extension, const char* name,
                     const std::string& place, TextureEncoding encoding, GltfTextures* textures,
                     double glossiness = 0) {
  if (!extension.Has(name)) return {};
  const std::string member = place + "/" + name;
  const GltfExtension reader(document, extension.Get(name), member);
  const gltf::Extensions extensions =
      reader.Has("extensions") ? &reader.Get("extensions") : nullptr;
  return textures->Add(
      {static_cast<int>(reader.Number("index", -1)), static_cast<int>(reader.Number("texCoord", 0)),
       extensions, encoding, glossiness},
      member);
}

// KHR_materials_ior and KHR_materials_specular: the specular reflectance of the dielectric part.
void ApplyReflectance(GltfDocument* document, const gltf::Material& material, size_t index,
                      GltfTextures* textures, MetallicRoughnessMaterial* result) {
  const std::string place = fmt::format("/materials/{}/extensions/", index);
  const auto check = [&](bool is_right, const char* member, const char* what) {
    if (!is_right) document->Refuse(place + member, what);
  };
  if (const auto ior = FindExtension(*document, material, index, "KHR_materials_ior")) {
    const double n = ior->Number("ior", 1.5);  // 0: an infinite index, which reflects everything
    check(n == 0 || n >= 1, "KHR_materials_ior/ior", "is neither 0 nor at least 1");
    const double root = (n - 1) / (n + 1);
    result->dielectric_f0 = Rgb(root * root);
  }
  const auto specular = FindExtension(*document, material, index, "KHR_materials_specular");
  if (!specular) return;
  result->specular = specular->Number("specularFactor", 1);
  check(result->specular >= 0 && result->specular <= 1, "KHR_materials_specular/specularFactor",
        "is not in [0, 1]");
  const Rgb tint = specular->Color("specularColorFactor", Rgb(1));
  check(tint.x >= 0 && tint.y >= 0 && tint.z >= 0, "KHR_materials_specular/specularColorFactor",
        "is negative");
  const Rgb f0 = result->dielectric_f0 * tint;
  for (int c = 0; c < 3; ++c) result->dielectric_f0[c] = std::min(f0[c], 1.0);
  if (result->metallic == 1 && !result->metallic_roughness_map.valid()) return;
  const auto map = [&](const char* name, TextureEncoding encoding) {
    return AddTexture(*document, *specular, name, place + "KHR_materials_specular", encoding,
                      textures);
  };
  result->specular_map = map("specularTexture", TextureEncoding::kAlpha);
  if (textures->IsWhite(result->specular_map)) result->specular_map = {};
  result->specular_color_map = map("specularColorTexture", TextureEncoding::kSrgb);
  if (f0 != result->dielectric_f0 && result->specular_color_map.valid()) {
    document->Warn("specular colours that reflect more than all are cut before their images");
  }
}

// KHR_materials_clearcoat.
void ApplyCoat(GltfDocument* document, const gltf::Material& material, size_t index,
               GltfTextures* textures, MetallicRoughnessMaterial* result) {
  const auto coat = FindExtension(*document, material, index, "KHR_materials_clearcoat");
  if (!coat) return;
  const std::string place = fmt::format("/materials/{}/extensions/KHR_materials_clearcoat", index);
  const auto factor = [&](const char* name) {
    const double value = coat->Number(name, 0);
    if (!(value >= 0 && value <= 1)) document->Refuse(place + "/" + name, "is not in [0, 1]");
    return value;
  };
  const auto map = [&](const char* name) {
    return AddTexture(*document, *coat, name, place, TextureEncoding::kLinear, textures);
  };
  result->coat = factor("clearcoatFactor");
  result->coat_roughness = factor("clearcoatRoughnessFactor");
  if (result->coat == 0) return;
  result->coat_map = map("clearcoatTexture");
  result->coat_roughness_map = map("clearcoatRoughnessTexture");
  const char* const normal = "clearcoatNormalTexture";
  result->coat_normal_map.texture =
      AddTexture(*document, *coat, normal, place, TextureEncoding::kLinear, textures);
  result->coat_normal_map.convention = NormalMap::Convention::kLiteral;
  if (!coat->Has(normal)) return;
  const GltfExtension info(*document, coat->Get(normal), place + "/" + normal);
  result->coat_normal_map.scale = info.Number("scale", 1);
  document->Check(place + "/" + normal + "/scale", result->coat_normal_map.scale,
                  limits::kNormalScale);
}

// KHR_materials_sheen.
void ApplySheen(GltfDocument* document, const gltf::Material& material, size_t index,
                GltfTextures* textures, MetallicRoughnessMaterial* result) {
  const auto sheen = FindExtension(*document, material, index, "KHR_materials_sheen");
  if (!sheen) return;
  const std::string place = fmt::format("/materials/{}/extensions/KHR_materials_sheen", index);
  const auto check = [&](bool is_right, const char* member) {
    if (!is_right) document->Refuse(place + "/" + member, "is not in [0, 1]");
  };
  const Rgb color = sheen->Color("sheenColorFactor", Rgb(0));
  const double roughness = sheen->Number("sheenRoughnessFactor", 0);
  const auto is_unit = [](double value) { return value >= 0 && value <= 1; };
  check(is_unit(color.x) && is_unit(color.y) && is_unit(color.z), "sheenColorFactor");
  check(is_unit(roughness), "sheenRoughnessFactor");
  if (IsBlack(color) || roughness == 0) return;
  result->sheen_color = color;
  result->sheen_roughness = roughness;
  const auto map = [&](const char* name, TextureEncoding encoding) {
    return AddTexture(*document, *sheen, name, place, encoding, textures);
  };
  result->sheen_color_map = map("sheenColorTexture", TextureEncoding::kSrgb);
  result->sheen_roughness_map = map("sheenRoughnessTexture", TextureEncoding::kAlpha);
  if (textures->IsWhite(result->sheen_roughness_map)) result->sheen_roughness_map = {};
}

// KHR_materials_pbrSpecularGlossiness: becomes a metallic-roughness material with metallic 0, whose
// reflectance at normal incidence may have any colour, as that of metals does.
MetallicRoughnessMaterial FromSpecularGlossiness(const GltfDocument& document,
                                                 const GltfExtension& extension,
                                                 const std::string& place, GltfTextures* textures) {
  const auto map = [&](const char* name, TextureEncoding encoding, double glossiness = 0) {
    return AddTexture(document, extension, name, place, encoding, textures, glossiness);
  };
  const auto factor = [&](const char* name) {
    const Rgb color = extension.Color(name, Rgb(1));
    document.Check(place + "/" + name, color, limits::kUnit);
    return color;
  };
  MetallicRoughnessMaterial result;
  result.base_color = factor("diffuseFactor");
  result.base_color_map = map("diffuseTexture", TextureEncoding::kSrgb);
  result.dielectric_f0 = factor("specularFactor");
  const double glossiness = extension.Number("glossinessFactor", 1);
  document.Check(place + "/glossinessFactor", glossiness, limits::kUnit);
  result.roughness = 1 - glossiness;
  const char* const both = "specularGlossinessTexture";
  result.specular_color_map = map(both, TextureEncoding::kSrgb);
  if (glossiness > 0 && extension.Has(both)) {
    result.metallic_roughness_map = map(both, TextureEncoding::kAlpha, glossiness);
    if (result.metallic_roughness_map.valid()) result.roughness = 1;
  }
  return result;
}

// alphaMode MASK: cuts holes where the base colour's alpha is below alphaCutoff;
// KHR_materials_unlit uses the base colour, too. `factor` is the pointer to the colour whose fourth
// number `alpha` is.
void ApplyMask(const GltfDocument& document, size_t index, const std::string& factor, double alpha,
               TextureId alpha_map, GltfTextures* textures, Material* result) {
  const gltf::Material& material = document.model.materials[index];
  if (material.alphaMode != "MASK") return;
  document.Check(factor + "/3", alpha, limits::kUnit);
  document.Check(fmt::format("/materials/{}/alphaCutoff", index), material.alphaCutoff,
                 limits::kOpacityCutoff);
  result->opacity = alpha;
  result->opacity_cutoff = material.alphaCutoff;
  if (!textures->IsWhite(alpha_map)) result->opacity_map = alpha_map;
}

double AlphaOf(const std::vector<double>& factor) { return factor.size() < 4 ? 1 : factor[3]; }

void AddCommonTextures(const GltfDocument& document, const gltf::Material& material,
                       const std::string& place, GltfTextures* textures, Material* result) {
  result->emission_map = AddTexture(material.emissiveTexture, place + "/emissiveTexture",
                                    TextureEncoding::kSrgb, textures);
  result->normal_map.texture = AddTexture(material.normalTexture, place + "/normalTexture",
                                          TextureEncoding::kLinear, textures);
  result->normal_map.scale = material.normalTexture.scale;
  document.Check(place + "/normalTexture/scale", result->normal_map.scale, limits::kNormalScale);
  // The specification maps "red [0.0 .. 1.0] to X [-1 .. 1]", so that code 128 of 255 is not quite
  // 0.
  result->normal_map.convention = NormalMap::Convention::kLiteral;
}

// Checks all texture references that are read, even those that are not followed because their
// factor is 0. Their types have been checked.
void CheckTextures(const GltfDocument& document, size_t index, const GltfTextures& textures) {
  const Json& material = document.root["materials"][index];
  for (const char* texture :
       {"/normalTexture", "/occlusionTexture", "/emissiveTexture",
        "/pbrMetallicRoughness/baseColorTexture", "/pbrMetallicRoughness/metallicRoughnessTexture",
        "/extensions/KHR_materials_clearcoat/clearcoatTexture",
        "/extensions/KHR_materials_clearcoat/clearcoatRoughnessTexture",
        "/extensions/KHR_materials_clearcoat/clearcoatNormalTexture",
        "/extensions/KHR_materials_pbrSpecularGlossiness/diffuseTexture",
        "/extensions/KHR_materials_pbrSpecularGlossiness/specularGlossinessTexture",
        "/extensions/KHR_materials_sheen/sheenColorTexture",
        "/extensions/KHR_materials_sheen/sheenRoughnessTexture",
        "/extensions/KHR_materials_specular/specularTexture",
        "/extensions/KHR_materials_specular/specularColorTexture"}) {
    const Json::json_pointer pointer(texture);
    if (!material.contains(pointer)) continue;
    textures.CheckIndex(material[pointer]["index"].get<int>(),
                        fmt::format("/materials/{}{}", index, texture));
  }
}

Material MakeMaterial(GltfDocument* document, size_t index, std::string name,
                      GltfTextures* textures) {
  const gltf::Material& material = document->model.materials[index];
  const auto& pbr = material.pbrMetallicRoughness;
  Material result;
  result.name = std::move(name);
  result.single_sided = !material.doubleSided;
  const std::string place = fmt::format("/materials/{}", index);
  const bool masked = material.alphaMode == "MASK";
  if (!masked && material.alphaMode != "OPAQUE") {
    if (material.alphaMode != "BLEND") {
      document->Refuse(place + "/alphaMode",
                       fmt::format("\"{}\" is none", Excerpt(material.alphaMode)),
                       "OPAQUE, MASK or BLEND");
    }
    document->Warn("transparency is not shown: materials whose alphaMode is BLEND are opaque");
  }
  const std::string factors = place + "/pbrMetallicRoughness/";
  const Rgb base_color = ColorOf(pbr.baseColorFactor, Rgb(1));
  const auto mask_by_base_color = [&] {
    const TextureId alpha = masked ? AddTexture(pbr.baseColorTexture, factors + "baseColorTexture",
                                                TextureEncoding::kAlpha, textures)
                                   : TextureId{};
    ApplyMask(*document, index, factors + "baseColorFactor", AlphaOf(pbr.baseColorFactor), alpha,
              textures, &result);
  };
  if (FindExtension(*document, material, index, "KHR_materials_unlit")) {
    document->Check(factors + "baseColorFactor", base_color, limits::kRadiance);
    result.model = LambertMaterial{Rgb(0)};
    result.emission = base_color;
    result.emission_map = AddTexture(pbr.baseColorTexture, factors + "baseColorTexture",
                                     TextureEncoding::kSrgb, textures);
    mask_by_base_color();
    return result;
  }
  if (material.occlusionTexture.index >= 0) {
    document->Warn("occlusion textures are left out: lights and their shadows are computed");
  }
  result.emission = EmissionOf(*document, material, index);
  AddCommonTextures(*document, material, place, textures, &result);
  if (const auto glossiness =
          FindExtension(*document, material, index, "KHR_materials_pbrSpecularGlossiness")) {
    const std::string inner = place + "/extensions/KHR_materials_pbrSpecularGlossiness";
    MetallicRoughnessMaterial model =
        FromSpecularGlossiness(*document, *glossiness, inner, textures);
    ApplyCoat(document, material, index, textures, &model);
    ApplySheen(document, material, index, textures, &model);
    const TextureId alpha = masked ? AddTexture(*document, *glossiness, "diffuseTexture", inner,
                                                TextureEncoding::kAlpha, textures)
                                   : TextureId{};
    ApplyMask(*document, index, inner + "/diffuseFactor", glossiness->Alpha("diffuseFactor", 1),
              alpha, textures, &result);
    result.model = model;
    return result;
  }
  document->Check(factors + "baseColorFactor", base_color, limits::kUnit);
  document->Check(factors + "metallicFactor", pbr.metallicFactor, limits::kUnit);
  document->Check(factors + "roughnessFactor", pbr.roughnessFactor, limits::kUnit);
  MetallicRoughnessMaterial metallic_roughness;
  metallic_roughness.base_color = base_color;
  metallic_roughness.metallic = pbr.metallicFactor;
  metallic_roughness.roughness = pbr.roughnessFactor;
  metallic_roughness.base_color_map = AddTexture(pbr.baseColorTexture, factors + "baseColorTexture",
                                                 TextureEncoding::kSrgb, textures);
  metallic_roughness.metallic_roughness_map =
      AddTexture(pbr.metallicRoughnessTexture, factors + "metallicRoughnessTexture",
                 TextureEncoding::kLinear, textures);
  ApplyReflectance(document, material, index, textures, &metallic_roughness);
  ApplyCoat(document, material, index, textures, &metallic_roughness);
  ApplySheen(document, material, index, textures, &metallic_roughness);
  mask_by_base_color();
  result.model = metallic_roughness;
  return result;
}

}  // namespace

std::vector<Material> MakeGltfMaterials(GltfDocument* document, Scene* scene) {
  GltfTextures textures(document, scene);
  textures.DecodeAhead();
  std::vector<Material> materials;
  const size_t count = document->model.materials.size();
  materials.reserve(count + 1);
  UniqueNames names;
  for (size_t i = 0; i < count; ++i) {
    CheckTextures(*document, i, textures);
    std::string name = names.Take(document->model.materials[i].name, "#", i);
    materials.push_back(MakeMaterial(document, i, std::move(name), &textures));
  }
  // The default material of the specification is white, metallic 1, roughness 1, which few files
  // intend.
  Material& otherwise = materials.emplace_back();
  otherwise.name = names.Take("default", "#", count);
  otherwise.single_sided = true;
  otherwise.model = MetallicRoughnessMaterial{.base_color = Rgb(1), .metallic = 1, .roughness = 1};
  return materials;
}

}  // namespace nacre
