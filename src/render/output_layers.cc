// SPDX-License-Identifier: Apache-2.0
#include "render/output_layers.h"

#include <algorithm>
#include <string_view>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/error.h"

namespace nacre {
namespace {

// Every layer that the scene has, in the order of files; the lights' layers are the last.
std::vector<Layer> AllLayers(const Scene& scene) {
  std::vector<Layer> layers = {
      {LayerKind::kBeauty, "beauty"},
      {LayerKind::kAlpha, "alpha"},
      {LayerKind::kDiffuse, "diffuse"},
      {LayerKind::kSpecular, "specular"},
      {LayerKind::kAmbient, "ambient"},
      {LayerKind::kEmission, "emission"},
      {LayerKind::kAlbedo, "albedo"},
      {LayerKind::kNormal, "N"},
      {LayerKind::kTangent, "T"},
      {LayerKind::kPosition, "P"},
      {LayerKind::kDepth, "Z"},
      {LayerKind::kObjectId, "id.object"},
      {LayerKind::kMaterialId, "id.material"},
  };
  for (size_t i = 0; i < scene.lights.size(); ++i) {
    const Light& light = scene.lights[i];
    if (std::holds_alternative<AmbientLight>(light.kind)) continue;
    layers.push_back({LayerKind::kLight, "light." + light.name, i});
  }
  return layers;
}

}  // namespace

std::vector<Layer> ParseLayers(const std::vector<std::string>& names, const Scene& scene) {
  const std::vector<Layer> all = AllLayers(scene);
  std::vector<Layer> layers(all.begin(), all.begin() + 2);
  size_t lights = 0;
  const auto add = [&](const Layer& layer) {
    if (std::ranges::find(layers, layer.name, &Layer::name) != layers.end()) return;
    layers.push_back(layer);
    if (layer.kind == LayerKind::kLight) layers.back().number = lights++;
  };
  for (const std::string& name : names) {
    if (name == "all") {
      std::ranges::for_each(all, add);
      continue;
    }
    const auto found = std::ranges::find(all, name, &Layer::name);
    if (found == all.end()) {
      std::vector<std::string> known = {"all"};
      for (const Layer& layer : all) known.push_back(layer.name);
      const std::string nearest = NearestName(name, known);
      throw Error(ExitCode::kUsage, "--layers", "unknown layer \"" + name + "\"",
                  nearest.empty() ? fmt::format("the scene has {}", fmt::join(known, ", "))
                                  : "did you mean \"" + nearest + "\"?");
    }
    add(*found);
  }
  return layers;
}

int LightLayer(const std::vector<Layer>& layers, size_t light) {
  const auto found = std::ranges::find_if(layers, [&](const Layer& layer) {
    return layer.kind == LayerKind::kLight && layer.light == light;
  });
  return found == layers.end() ? -1 : static_cast<int>(found->number);
}

bool IsAveraged(LayerKind kind) { return kind <= LayerKind::kTangent; }

int FloatChannels(LayerKind kind) {
  switch (kind) {
    case LayerKind::kObjectId:
    case LayerKind::kMaterialId:
      return 0;
    case LayerKind::kAlpha:
    case LayerKind::kDepth:
      return 1;
    default:
      return 3;
  }
}

std::vector<ChannelSpec> LayerChannels(const Layer& layer, PixelType color_type) {
  using enum LayerKind;
  const LayerKind kind = layer.kind;
  if (FloatChannels(kind) == 0) return {{layer.name, PixelType::kUint}};
  const bool nameless = kind == kBeauty || kind == kAlpha || kind == kDepth;
  const std::string prefix = nameless ? "" : layer.name + ".";
  const std::string_view letters = kind == kAlpha   ? "A"
                                   : kind == kDepth ? "Z"
                                   : kind == kNormal || kind == kTangent || kind == kPosition
                                       ? "XYZ"
                                       : "RGB";
  std::vector<ChannelSpec> channels;
  for (const char letter : letters) {
    channels.push_back({prefix + letter, IsAveraged(kind) ? color_type : PixelType::kFloat});
  }
  return channels;
}

}  // namespace nacre
