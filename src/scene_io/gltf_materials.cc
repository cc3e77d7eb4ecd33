// SPDX-License-Identifier: Apache-2.0
// scene_io/gltf_materials.cc: the materials of a glTF file as materials of the scene.
#include <algorithm>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "base/excerpt.h"
#include "scene/limits.h"
#include "scene_io/gltf_extension.h"
#include "scene_io/gltf_readers.h"
#include "scene_io/gltf_textures.h"
#include "scene_io/unique_names.h"

namespace nacre {
namespace {

Rgb ColorOf(const std::vector<double>& factor, const Rgb& otherwise) {
  return factor.size() < 3 ? otherwise : Rgb(factor[0], factor[1], factor[2]);
}

double AlphaOf(const std::vector<double>& factor) { return factor.size() < 4 ? 1 : factor[3]; }

class MaterialMaker {
 public:
  MaterialMaker(GltfDocument* document, size_t index, GltfTextures* textures)
      : document_(*document),
        source_(document->model.materials[index]),
        place_(fmt::format("/materials/{}", index)),
        textures_(*textures) {}

  Material Make(std::string name) {
    CheckTextures();
    const auto& pbr = source_.pbrMetallicRoughness;
    Material result;
    result.name = std::move(name);
    result.single_sided = !source_.doubleSided;
    if (!is_masked() && source_.alphaMode != "OPAQUE") {
      if (source_.alphaMode != "BLEND") {
        document_.Refuse(place_ + "/alphaMode",
                         fmt::format("\"{}\" is none", Excerpt(source_.alphaMode)),
                         "OPAQUE, MASK or BLEND");
      }
      document_.Warn("transparency is not shown: materials whose alphaMode is BLEND are opaque");
    }
    const Rgb base_color = ColorOf(pbr.baseColorFactor, Rgb(1));
    if (Find("KHR_materials_unlit")) {
      Check("/pbrMetallicRoughness/baseColorFactor", base_color, limits::kRadiance);
      result.model = LambertMaterial{Rgb(0)};
      result.emission = base_color;
      result.emission_map = BaseColorMap(TextureEncoding::kSrgb);
      MaskByBaseColor(&result);
      return result;
    }
    if (source_.occlusionTexture.index >= 0) {
      document_.Warn("occlusion textures are left out: lights and their shadows are computed");
    }
    result.emission = Emission();
    AddCommonTextures(&result);
    if (const auto glossiness = Find("KHR_materials_pbrSpecularGlossiness")) {
      MetallicRoughnessMaterial model = FromSpecularGlossiness(*glossiness);
      ApplyCoat(&model);
      ApplySheen(&model);
      const TextureId alpha =
          is_masked() ? Map(*glossiness, "diffuseTexture", TextureEncoding::kAlpha) : TextureId{};
      ApplyMask(glossiness->PlaceOf("diffuseFactor"), glossiness->Alpha("diffuseFactor", 1), alpha,
                &result);
      result.model = model;
      return result;
    }
    Check("/pbrMetallicRoughness/baseColorFactor", base_color, limits::kUnit);
    Check("/pbrMetallicRoughness/metallicFactor", pbr.metallicFactor, limits::kUnit);
    Check("/pbrMetallicRoughness/roughnessFactor", pbr.roughnessFactor, limits::kUnit);
    MetallicRoughnessMaterial model;
    model.base_color = base_color;
    model.metallic = pbr.metallicFactor;
    model.roughness = pbr.roughnessFactor;
    model.base_color_map = BaseColorMap(TextureEncoding::kSrgb);
    model.metallic_roughness_map =
        Map(pbr.metallicRoughnessTexture, "/pbrMetallicRoughness/metallicRoughnessTexture",
            TextureEncoding::kLinear);
    ApplyReflectance(&model);
    ApplyAnisotropy(&model);
    ApplyIridescence(&model);
    ApplyCoat(&model);
    ApplySheen(&model);
    MaskByBaseColor(&result);
    result.model = model;
    return result;
  }

 private:
  bool is_masked() const { return source_.alphaMode == "MASK"; }

  // Refuses a number or colour of the material that is not within the range.
  template <class Value>
  void Check(const char* member, const Value& value, const Range& range) const {
    document_.Check(place_ + member, value, range);
  }

  std::optional<GltfExtension> Find(const char* name) const {
    const Json* const found = gltf::FindExtension(source_.extensions, name);
    if (found == nullptr) return std::nullopt;
    return GltfExtension(document_, *found, fmt::format("{}/extensions/{}", place_, name));
  }

  // Adds the texture that a member of the material refers to.
  TextureId Map(const gltf::TextureInfo& info, const char* member, TextureEncoding encoding) {
    return textures_.Add({info.index, info.texCoord, info.extensions, encoding}, place_ + member);
  }
  // Adds the texture in the member `name` of an extension. `glossiness`:
  // GltfTextureUse::glossiness.
  TextureId Map(const GltfExtension& extension, const char* name, TextureEncoding encoding,
                double glossiness = 0) {
    if (!extension.Has(name)) return {};
    const std::string place = extension.PlaceOf(name);
    const GltfExtension info(document_, extension.Get(name), place);
    const gltf::Extensions extensions = info.Has("extensions") ? &info.Get("extensions") : nullptr;
    return textures_.Add(
        {static_cast<int>(info.Number("index", -1)), static_cast<int>(info.Number("texCoord", 0)),
         extensions, encoding, glossiness},
        place);
  }
  TextureId BaseColorMap(TextureEncoding encoding) {
    return Map(source_.pbrMetallicRoughness.baseColorTexture,
               "/pbrMetallicRoughness/baseColorTexture", encoding);
  }

  Rgb Emission() const {
    const auto extension = Find("KHR_materials_emissive_strength");
    const double strength = extension ? extension->Number("emissiveStrength", 1) : 1;
    const Rgb factor = ColorOf(source_.emissiveFactor, Rgb(0));
    Check("/emissiveFactor", factor, limits::kRadiance);
    Check("/extensions/KHR_materials_emissive_strength/emissiveStrength", factor * strength,
          limits::kRadiance);
    return factor * strength;
  }

  // KHR_materials_ior and KHR_materials_specular: the specular reflectance of the dielectric part.
  void ApplyReflectance(MetallicRoughnessMaterial* result) {
    if (const auto ior = Find("KHR_materials_ior")) {
      const double n = ior->Number("ior", 1.5);  // 0: an infinite index, which reflects everything
      if (!(n == 0 || n >= 1)) ior->Refuse("ior", "is neither 0 nor at least 1");
      const double root = (n - 1) / (n + 1);
      result->dielectric_f0 = Rgb(root * root);
    }
    const auto specular = Find("KHR_materials_specular");
    if (!specular) return;
    result->specular = specular->Unit("specularFactor", 1);
    const Rgb tint = specular->Color("specularColorFactor", Rgb(1));
    if (!(tint.x >= 0 && tint.y >= 0 && tint.z >= 0)) {
      specular->Refuse("specularColorFactor", "is negative");
    }
    const Rgb f0 = result->dielectric_f0 * tint;
    for (int c = 0; c < 3; ++c) result->dielectric_f0[c] = std::min(f0[c], 1.0);
    if (result->metallic == 1 && !result->metallic_roughness_map.valid()) return;
    result->specular_map = Map(*specular, "specularTexture", TextureEncoding::kAlpha);
    if (textures_.IsWhite(result->specular_map)) result->specular_map = {};
    result->specular_color_map = Map(*specular, "specularColorTexture", TextureEncoding::kSrgb);
    if (f0 != result->dielectric_f0 && result->specular_color_map.valid()) {
      document_.Warn("specular colours that reflect more than all are cut before their images");
    }
  }

  // KHR_materials_anisotropy.
  void ApplyAnisotropy(MetallicRoughnessMaterial* result) {
    const auto anisotropy = Find("KHR_materials_anisotropy");
    if (!anisotropy) return;
    result->anisotropy = anisotropy->Unit("anisotropyStrength", 0);
    const double turn = anisotropy->Number("anisotropyRotation", 0) * (180 / M_PI);
    document_.Check(anisotropy->PlaceOf("anisotropyRotation"), turn, limits::kAngleDeg);
    if (result->anisotropy == 0) return;
    result->anisotropy_rotation_deg = turn;
    result->anisotropy_map = Map(*anisotropy, "anisotropyTexture", TextureEncoding::kLinear);
  }

  // KHR_materials_iridescence.
  void ApplyIridescence(MetallicRoughnessMaterial* result) {
    const auto film = Find("KHR_materials_iridescence");
    if (!film) return;
    const double weight = film->Unit("iridescenceFactor", 0);
    const double index = film->Number("iridescenceIor", 1.3);
    const double least = film->Number("iridescenceThicknessMinimum", 100);
    const double most = film->Number("iridescenceThicknessMaximum", 400);
    document_.Check(film->PlaceOf("iridescenceIor"), index, limits::kFilmIor);
    document_.Check(film->PlaceOf("iridescenceThicknessMinimum"), least, limits::kFilmThicknessNm);
    document_.Check(film->PlaceOf("iridescenceThicknessMaximum"), most, limits::kFilmThicknessNm);
    if (weight == 0) return;
    result->iridescence = weight;
    result->iridescence_ior = index;
    result->iridescence_thickness_nm = most;
    result->iridescence_thickness_minimum_nm = least;
    result->iridescence_map = Map(*film, "iridescenceTexture", TextureEncoding::kLinear);
    result->iridescence_thickness_map =
        Map(*film, "iridescenceThicknessTexture", TextureEncoding::kLinear);
  }

  // KHR_materials_clearcoat.
  void ApplyCoat(MetallicRoughnessMaterial* result) {
    const auto coat = Find("KHR_materials_clearcoat");
    if (!coat) return;
    result->coat = coat->Unit("clearcoatFactor", 0);
    result->coat_roughness = coat->Unit("clearcoatRoughnessFactor", 0);
    if (result->coat == 0) return;
    result->coat_map = Map(*coat, "clearcoatTexture", TextureEncoding::kLinear);
    result->coat_roughness_map = Map(*coat, "clearcoatRoughnessTexture", TextureEncoding::kLinear);
    const char* const normal = "clearcoatNormalTexture";
    result->coat_normal_map.texture = Map(*coat, normal, TextureEncoding::kLinear);
    result->coat_normal_map.convention = NormalMap::Convention::kLiteral;
    if (!coat->Has(normal)) return;
    const GltfExtension info(document_, coat->Get(normal), coat->PlaceOf(normal));
    result->coat_normal_map.scale = info.Number("scale", 1);
    document_.Check(info.PlaceOf("scale"), result->coat_normal_map.scale, limits::kNormalScale);
  }

  // KHR_materials_sheen.
  void ApplySheen(MetallicRoughnessMaterial* result) {
    const auto sheen = Find("KHR_materials_sheen");
    if (!sheen) return;
    const Rgb color = sheen->Color("sheenColorFactor", Rgb(0));
    const double roughness = sheen->Number("sheenRoughnessFactor", 0);
    if (!limits::kUnit.Contains(color)) sheen->Refuse("sheenColorFactor", "is not in [0, 1]");
    if (!limits::kUnit.Contains(roughness)) {
      sheen->Refuse("sheenRoughnessFactor", "is not in [0, 1]");
    }
    if (IsBlack(color) || roughness == 0) return;
    result->sheen_color = color;
    result->sheen_roughness = roughness;
    result->sheen_color_map = Map(*sheen, "sheenColorTexture", TextureEncoding::kSrgb);
    result->sheen_roughness_map = Map(*sheen, "sheenRoughnessTexture", TextureEncoding::kAlpha);
    if (textures_.IsWhite(result->sheen_roughness_map)) result->sheen_roughness_map = {};
  }

  // KHR_materials_pbrSpecularGlossiness: becomes a metallic-roughness material with metallic 0,
  // whose reflectance at normal incidence may have any colour, as that of metals does.
  MetallicRoughnessMaterial FromSpecularGlossiness(const GltfExtension& extension) {
    const auto factor = [&](const char* name) {
      const Rgb color = extension.Color(name, Rgb(1));
      document_.Check(extension.PlaceOf(name), color, limits::kUnit);
      return color;
    };
    MetallicRoughnessMaterial result;
    result.base_color = factor("diffuseFactor");
    result.base_color_map = Map(extension, "diffuseTexture", TextureEncoding::kSrgb);
    result.dielectric_f0 = factor("specularFactor");
    const double glossiness = extension.Number("glossinessFactor", 1);
    document_.Check(extension.PlaceOf("glossinessFactor"), glossiness, limits::kUnit);
    result.roughness = 1 - glossiness;
    const char* const both = "specularGlossinessTexture";
    result.specular_color_map = Map(extension, both, TextureEncoding::kSrgb);
    if (glossiness > 0 && extension.Has(both)) {
      result.metallic_roughness_map = Map(extension, both, TextureEncoding::kAlpha, glossiness);
      if (result.metallic_roughness_map.valid()) result.roughness = 1;
    }
    return result;
  }

  // alphaMode MASK: cuts holes where the base colour's alpha is below alphaCutoff;
  // KHR_materials_unlit uses the base colour, too. `factor` is the pointer to the colour whose
  // fourth number `alpha` is.
  void ApplyMask(const std::string& factor, double alpha, TextureId alpha_map, Material* result) {
    if (!is_masked()) return;
    document_.Check(factor + "/3", alpha, limits::kUnit);
    Check("/alphaCutoff", source_.alphaCutoff, limits::kOpacityCutoff);
    result->opacity = alpha;
    result->opacity_cutoff = source_.alphaCutoff;
    if (!textures_.IsWhite(alpha_map)) result->opacity_map = alpha_map;
  }

  void MaskByBaseColor(Material* result) {
    const TextureId alpha = is_masked() ? BaseColorMap(TextureEncoding::kAlpha) : TextureId{};
    ApplyMask(place_ + "/pbrMetallicRoughness/baseColorFactor",
              AlphaOf(source_.pbrMetallicRoughness.baseColorFactor), alpha, result);
  }

  void AddCommonTextures(Material* result) {
    result->emission_map = Map(source_.emissiveTexture, "/emissiveTexture", TextureEncoding::kSrgb);
    result->normal_map.texture =
        Map(source_.normalTexture, "/normalTexture", TextureEncoding::kLinear);
    result->normal_map.scale = source_.normalTexture.scale;
    Check("/normalTexture/scale", result->normal_map.scale, limits::kNormalScale);
    // The specification maps "red [0.0 .. 1.0] to X [-1 .. 1]", so that code 128 of 255 is not
    // quite 0.
    result->normal_map.convention = NormalMap::Convention::kLiteral;
  }

  // Checks all texture references that are read, even those that are not followed because their
  // factor is 0. Their types have been checked.
  void CheckTextures() const {
    const auto check = [&](const gltf::TextureInfo& info, const char* member) {
      if (info.index >= 0) textures_.CheckIndex(info.index, place_ + member);
    };
    const gltf::PbrMetallicRoughness& pbr = source_.pbrMetallicRoughness;
    check(source_.normalTexture, "/normalTexture");
    check(source_.occlusionTexture, "/occlusionTexture");
    check(source_.emissiveTexture, "/emissiveTexture");
    check(pbr.baseColorTexture, "/pbrMetallicRoughness/baseColorTexture");
    check(pbr.metallicRoughnessTexture, "/pbrMetallicRoughness/metallicRoughnessTexture");
    for (const auto& [name, member] : gltf::kExtensionTextures) {
      const auto extension = Find(name);
      if (!extension || !extension->Has(member)) continue;
      textures_.CheckIndex(extension->Get(member)["index"].get<int>(), extension->PlaceOf(member));
    }
  }

  GltfDocument& document_;
  const gltf::Material& source_;
  const std::string place_;
  GltfTextures& textures_;
};

}  // namespace

std::vector<Material> MakeGltfMaterials(GltfDocument* document, Scene* scene) {
  GltfTextures textures(document, scene);
  textures.DecodeAhead();
  std::vector<Material> materials;
  const size_t count = document->model.materials.size();
  materials.reserve(count + 1);
  UniqueNames names;
  for (size_t i = 0; i < count; ++i) {
    std::string name = names.Take(document->model.materials[i].name, "#", i);
    materials.push_back(MaterialMaker(document, i, &textures).Make(std::move(name)));
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
