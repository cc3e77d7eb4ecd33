// SPDX-License-Identifier: Apache-2.0
// render/output_layers.h: the layers that a render can write, and the channels each consists of.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/image.h"
#include "scene/scene.h"

namespace nacre {

enum class LayerKind : uint8_t {
  kBeauty,    // R G B: diffuse + specular + ambient + emission, background included
  kAlpha,     // A: coverage
  kDiffuse,   // reflected by the diffuse lobes
  kSpecular,  // reflected by the specular lobes
  kAmbient,   // reflected from ambient lights
  kEmission,  // emitted by surfaces, and the background
  kAlbedo,    // diffuse reflectance or base colour
  kLight,     // light.<name>: diffuse and specular reflection of one light
  kNormal,    // N: world-space shading normal, averaged
  kTangent,   // T: the same of anisotropic lobes; 0 of others
  // The rest cannot be averaged: they show the hit nearest to the pixel's centre.
  kPosition,    // P: world space
  kDepth,       // Z: distance along the viewing direction; 0 where nothing is hit
  kObjectId,    // id.object: 1 + sphere index, or 1 + sphere count + mesh index; 0: none
  kMaterialId,  // id.material: 1 + index in the scene's materials; 0: none
};

struct Layer {
  LayerKind kind;
  std::string name;  // as --layers names it
  // kLight: its index in Scene::lights, and the layer's number among the layers of lights.
  size_t light = 0, number = 0;
};

// Beauty and alpha, then the named layers, each once. "all" stands for every layer of the scene.
// Throws Error (usage) for a name that the scene does not have.
std::vector<Layer> ParseLayers(const std::vector<std::string>& names, const Scene& scene);

// The number of the light's layer among the light layers, or -1.
int LightLayer(const std::vector<Layer>& layers, size_t light);

// Whether the layer is averaged over a pixel's samples, or taken from one of them.
bool IsAveraged(LayerKind kind);

// The number of the layer's channels that hold floats.
int FloatChannels(LayerKind kind);

// Where the values of a channel come from.
enum class ChannelKind : uint8_t {
  kAveraged,  // floats, averaged over the samples
  kNearest,   // floats of one sample
  kId,        // integers of one sample
};

struct ChannelSpec {
  std::string name;
  PixelType type;
};

// The channels of a layer in the order in which its values are computed. Colours and normals are
// stored as `color_type` (half or float), Z and P always as float, ids as uint.
std::vector<ChannelSpec> LayerChannels(const Layer& layer, PixelType color_type);

}  // namespace nacre
