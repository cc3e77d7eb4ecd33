// SPDX-License-Identifier: Apache-2.0
#include "render/texel_maps.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <variant>

#include "scene/coat.h"
#include "scene/material_parameters.h"

namespace nacre {
namespace {

// Whether the number is the roughness, or exponent, of a lobe.
bool IsWidth(MappedNumber number) {
  return number == MappedNumber::kWidth || number == MappedNumber::kUncoatedWidth;
}

// Adds the measures by which the texels of a map that multiplies a parameter are compared. Radiance
// is a linear function of most parameters, so that texels that change the mean by less than half
// the wanted error do not matter. Dielectric texels among metal may be bright, too, and so may
// lobes of a low exponent among sharp ones, beside the peaks of these. So may what a tinted coat
// leaves free.
void AddMeasures(const MapTarget& target, const Material& material, bool tints, double max_error,
                 std::vector<TexelMeasure>* measures) {
  using enum TexelMeasure::Kind;
  if (IsBlack(target.factor(material))) return;
  const int first = target.is_color ? 0 : target.channel;
  for (int channel = first; channel < (target.is_color ? 3 : first + 1); ++channel) {
    const auto add = [&](TexelMeasure::Kind kind, double number) {
      measures->push_back({kind, channel, number, max_error / 2});
    };
    const bool is_width = IsWidth(target.number);
    const bool is_exponent = is_width && std::holds_alternative<PhongMaterial>(material.model);
    // The height of a microfacet lobe's peak is proportional to its roughness to the power of -4.
    add(kPower, is_width && !is_exponent ? -4 : 1);
    if (is_exponent) add(kPower, -1);
    const bool covers = tints && target.number == MappedNumber::kSpecular;
    if (target.number == MappedNumber::kMetallic || covers) add(kRest, 0);
  }
}

void AddMap(const Scene& scene, TextureId texture, std::vector<TexelMeasure> measures,
            std::vector<TexelMap>* maps) {
  // Channels beyond the image's repeat its last one.
  const int channels = GridOf(scene, texture, 0).texels.channels;
  std::vector<TexelMeasure> kept;
  for (TexelMeasure& measure : measures) {
    measure.channel = std::min(measure.channel, channels - 1);
    const bool known = std::any_of(kept.begin(), kept.end(), [&](const TexelMeasure& other) {
      return other.kind == measure.kind && other.channel == measure.channel &&
             other.number == measure.number;
    });
    if (!known) kept.push_back(measure);
  }
  if (!kept.empty()) maps->push_back({texture, std::move(kept)});
}

void AddLooks(const Scene& scene, const Material& material, bool tints, double max_error,
              std::vector<TexelMap>* maps) {
  for (const MaterialMap& map : ModelOf(material)->maps) {
    const TextureId texture = map.get(material);
    if (!texture.valid()) continue;
    std::vector<TexelMeasure> measures;
    for (const MapTarget& target : TargetsOf(map)) {
      AddMeasures(target, material, tints, max_error, &measures);
    }
    AddMap(scene, texture, std::move(measures), maps);
  }
}

// The mean of a map's channel over the whole image.
double MeanOfMap(const Scene& scene, TextureId texture, int channel) {
  const MipChain& image = *scene.images[scene.textures[texture.index].image.index].texels;
  return image.Value(image.levels.size() - 1, 0, 0, std::min(channel, image.channels - 1));
}

// The half-width of the material's own lobe, in the angle between normal and half vector; infinite
// if it has none.
double LobeWidth(const Scene& scene, const Material& material) {
  for (const MaterialMap& map : ModelOf(material)->maps) {
    for (const MapTarget& target : TargetsOf(map)) {
      if (!IsWidth(target.number)) continue;
      const TextureId texture = map.get(material);
      const double mapped = texture.valid() ? MeanOfMap(scene, texture, target.channel) : 1;
      const double width = target.factor(material).x * mapped;
      const auto* phong = std::get_if<PhongMaterial>(&material.model);
      if (phong == nullptr) return width * width;
      // A Phong lobe lies around the mirrored direction, which turns twice as fast as the half
      // vector.
      const bool mirrored = phong->model != PhongModel::kBlinnPhong;
      return std::sqrt(2 / (width + 2)) * (mirrored ? 0.5 : 1);
    }
  }
  return std::numeric_limits<double>::infinity();
}

void AddNormals(const Scene& scene, const Material& material, std::vector<LobeNormalMap>* maps) {
  // Wider lobes are not much brighter in one texel than in the others: ordinary samples find their
  // highlights, and a search would cost more than it gains.
  constexpr double kWidest = 0.2;
  const double width = LobeWidth(scene, material);
  if (!material.normal_map.texture.valid() || !(width < kWidest)) return;
  maps->push_back({material.normal_map, width});
}

void AddOpacity(const Scene& scene, const Material& material, std::vector<TexelMap>* maps) {
  if (!material.opacity_map.valid() || !(material.opacity > 0)) return;
  TexelMeasure solid;
  solid.kind = TexelMeasure::Kind::kSolid;
  solid.number = material.opacity_cutoff / material.opacity;
  AddMap(scene, material.opacity_map, {solid}, maps);
}

void AddSky(const LightsPlan& lights, double max_error, TexelMaps* maps) {
  if (!lights.sky) return;
  const SampledLight& sky = lights.sampled[*lights.sky].light;
  if (sky.form != SampledForm::kPictureSky) return;
  const EnvironmentMap& map = *sky.sky.picture;
  maps->sky = {{TexelKind::kFloats, &map.texels[0].x, nullptr, 3, map.width, map.height},
               Wrap::kRepeat,
               Wrap::kClamp};
  maps->sky_extremes = std::make_unique<const TexelExtremes>(maps->sky);
  for (int channel = 0; channel < 3; ++channel) {
    maps->sky_measures.push_back({TexelMeasure::Kind::kPower, channel, 1, max_error / 2});
  }
}

}  // namespace

TexelGrid GridOf(const Scene& scene, TextureId texture, size_t mip_level) {
  const Texture& of = scene.textures[texture.index];
  return {scene.images[of.image.index].texels->Level(mip_level), of.sampling.wrap_u,
          of.sampling.wrap_v};
}

std::shared_ptr<const TexelMaps> FindTexelMaps(const Scene& scene, const LightsPlan& lights,
                                               double max_error) {
  auto maps = std::make_shared<TexelMaps>();
  for (const Material& material : scene.materials) {
    std::vector<TexelMap>& looks = maps->looks.emplace_back();
    std::vector<LobeNormalMap>& normals = maps->normals.emplace_back();
    std::vector<TexelMap>& opacities = maps->opacities.emplace_back();
    if (ModelOf(material) == nullptr) continue;
    AddLooks(scene, material, false, max_error, &looks);
    AddNormals(scene, material, &normals);
    for (const Coat& coat : CoatsOf(material)) {
      AddLooks(scene, coat.material, coat.color != Rgb(1), max_error, &looks);
      AddNormals(scene, coat.material, &normals);
    }
    AddOpacity(scene, material, &opacities);
    maps->any_looks = maps->any_looks || !looks.empty();
    maps->any_normals = maps->any_normals || !normals.empty();
    maps->any_opacity = maps->any_opacity || !opacities.empty();
  }
  for (uint32_t i = 0; i < scene.textures.size(); ++i) {
    maps->extremes.push_back(std::make_unique<const TexelExtremes>(GridOf(scene, {i}, 0)));
  }
  AddSky(lights, max_error, maps.get());
  if (maps->any_normals) maps->suns = FindSuns(lights.sampled);
  const bool any = maps->any_looks || maps->any_normals || maps->any_opacity || maps->sky_extremes;
  return any ? maps : nullptr;
}

}  // namespace nacre
