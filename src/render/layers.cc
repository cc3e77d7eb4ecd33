// SPDX-License-Identifier: Apache-2.0
#include "render/layers.h"

#include <algorithm>

#include "base/error.h"

namespace nacre {
namespace {

// Every layer that the scene has, in the order of files; the lights' layers are the last.
std::vector<Layer> AllLayers(const Scene& scene) {
  std::vector<Layer> layers = {
      {LayerKind::kBeauty, "beauty"},      {LayerKind::kAlpha, "alpha"},
      {LayerKind::kDiffuse, "diffuse"},    {LayerKind::kSpecular, "specular"},
      {LayerKind::kAmbient, "ambient"},    {LayerKind::kEmission, "emission"},
      {LayerKind::kAlbedo, "albedo"},      {LayerKind::kNormal, "N"},
      {LayerKind::kPosition, "P"},         {LayerKind::kDepth, "Z"},
      {LayerKind::kObjectId, "id.object"}, {LayerKind::kMaterialId, "id.material"},
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
  const auto add = [&](const Layer& layer) {
    const auto same = [&](const Layer& other) { return other.name == layer.name; };
    if (std::none_of(layers.begin(), layers.end(), same)) layers.push_back(layer);
  };
  for (const std::string& name : names) {
    if (name == "all") {
      std::for_each(all.begin(), all.end(), add);
      continue;
    }
    const auto found = std::find_if(all.begin(), all.end(),
                                    [&](const Layer& layer) { return layer.name == name; });
    if (found == all.end()) {
      std::vector<std::string> known = {"all"};
      for (const Layer& layer : all) known.push_back(layer.name);
      const std::string nearest = NearestName(name, known);
      std::string choices;
      for (const std::string& choice : known) choices += (choices.empty() ? "" : ", ") + choice;
      throw Error(
          ExitCode::kUsage, "--layers", "unknown layer \"" + name + "\"",
          nearest.empty() ? "the scene has " + choices : "did you mean \"" + nearest + "\"?");
    }
    add(*found);
  }
  return layers;
}

int LightLayer(const std::vector<Layer>& layers, size_t light) {
  int number = 0;
  for (const Layer& layer : layers) {
    if (layer.kind != LayerKind::kLight) continue;
    if (layer.light == light) return number;
    ++number;
  }
  return -1;
}

bool IsAveraged(LayerKind kind) { return kind <= LayerKind::kNormal; }

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
  const auto rgb = [&](const std::string& prefix) -> std::vector<ChannelSpec> {
    return {{prefix + "R", color_type}, {prefix + "G", color_type}, {prefix + "B", color_type}};
  };
  switch (layer.kind) {
    case LayerKind::kBeauty:
      return rgb("");
    case LayerKind::kAlpha:
      return {{"A", color_type}};
    case LayerKind::kNormal:
      return {{"N.X", color_type}, {"N.Y", color_type}, {"N.Z", color_type}};
    case LayerKind::kPosition:
      return {{"P.X", PixelType::kFloat}, {"P.Y", PixelType::kFloat}, {"P.Z", PixelType::kFloat}};
    case LayerKind::kDepth:
      return {{"Z", PixelType::kFloat}};
    case LayerKind::kObjectId:
    case LayerKind::kMaterialId:
      return {{layer.name, PixelType::kUint}};
    default:
      return rgb(layer.name + ".");
  }
}

}  // namespace nacre
