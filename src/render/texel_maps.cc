// SPDX-License-Identifier: Apache-2.0
#include "render/texel_maps.h"

#include <algorithm>
#include <utility>
#include <variant>

#include "scene/coat.h"
#include "scene/material_parameters.h"

namespace nacre {
namespace {

// What a map's texels are compared by where it multiplies a parameter. Radiance is a linear
// function of most of them, so that texels that change the mean by less than half the wanted error
// do not matter.
void AddMeasures(const MapTarget& target, const Material& material, double max_error,
                 std::vector<TexelMeasure>* measures) {
  if (IsBlack(target.factor(material))) return;
  const bool is_roughness = target.number == MappedNumber::kWidth &&
                            !std::holds_alternative<PhongMaterial>(material.model);
  TexelMeasure measure;
  measure.kind = is_roughness ? TexelMeasure::Kind::kSharpness : TexelMeasure::Kind::kValue;
  measure.least_change = max_error / 2;
  const int first = target.is_color ? 0 : target.channel;
  for (int channel = first; channel < (target.is_color ? 3 : first + 1); ++channel) {
    measure.channel = channel;
    measures->push_back(measure);
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
      return other.kind == measure.kind && other.channel == measure.channel;
    });
    if (!known) kept.push_back(measure);
  }
  if (!kept.empty()) maps->push_back({texture, std::move(kept)});
}

void AddLooks(const Scene& scene, const Material& material, double max_error,
              std::vector<TexelMap>* maps) {
  for (const MaterialMap& map : ModelOf(material)->maps) {
    const TextureId texture = map.get(material);
    if (!texture.valid()) continue;
    std::vector<TexelMeasure> measures;
    for (const MapTarget& target : TargetsOf(map)) {
      AddMeasures(target, material, max_error, &measures);
    }
    AddMap(scene, texture, std::move(measures), maps);
  }
}

void AddOpacity(const Scene& scene, const Material& material, std::vector<TexelMap>* maps) {
  if (!material.opacity_map.valid() || !(material.opacity > 0)) return;
  TexelMeasure solid;
  solid.kind = TexelMeasure::Kind::kSolid;
  solid.threshold = material.opacity_cutoff / material.opacity;
  AddMap(scene, material.opacity_map, {solid}, maps);
}

void AddSky(const DirectPlan& direct, double max_error, TexelMaps* maps) {
  if (!direct.sky) return;
  const SampledLight& sky = direct.sampled_lights[*direct.sky].light;
  if (sky.form != SampledForm::kPictureSky) return;
  const EnvironmentMap& map = *sky.sky.picture;
  maps->sky = {{TexelKind::kFloats, &map.texels[0].x, nullptr, 3, map.width, map.height},
               Wrap::kRepeat,
               Wrap::kClamp};
  maps->sky_extremes = std::make_unique<const TexelExtremes>(maps->sky);
  for (int channel = 0; channel < 3; ++channel) {
    maps->sky_measures.push_back({TexelMeasure::Kind::kValue, channel, 0, max_error / 2});
  }
}

}  // namespace

TexelGrid GridOf(const Scene& scene, TextureId texture, size_t mip_level) {
  const Texture& of = scene.textures[texture.index];
  return {scene.images[of.image.index].texels->Level(mip_level), of.sampling.wrap_u,
          of.sampling.wrap_v};
}

std::shared_ptr<const TexelMaps> FindTexelMaps(const Scene& scene, const DirectPlan& direct,
                                               double max_error) {
  auto maps = std::make_shared<TexelMaps>();
  for (const Material& material : scene.materials) {
    std::vector<TexelMap>& looks = maps->looks.emplace_back();
    std::vector<TexelMap>& opacities = maps->opacities.emplace_back();
    if (ModelOf(material) == nullptr) continue;
    AddLooks(scene, material, max_error, &looks);
    if (const auto coat = CoatOf(material)) AddLooks(scene, *coat, max_error, &looks);
    AddOpacity(scene, material, &opacities);
    maps->any_looks = maps->any_looks || !looks.empty();
    maps->any_opacity = maps->any_opacity || !opacities.empty();
  }
  for (uint32_t i = 0; i < scene.textures.size(); ++i) {
    maps->extremes.push_back(std::make_unique<const TexelExtremes>(GridOf(scene, {i}, 0)));
  }
  AddSky(direct, max_error, maps.get());
  const bool any = maps->any_looks || maps->any_opacity || maps->sky_extremes;
  return any ? maps : nullptr;
}

}  // namespace nacre
