// SPDX-License-Identifier: Apache-2.0
// scene/material_parameters.h: the parameters and maps of each material model by name, defined
// once. The reader of scene files, the JSON Schema, the scene's hash, the axes of grids and
// Validate() are derived from these tables.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "base/vec.h"
#include "scene/handle.h"
#include "scene/limits.h"
#include "scene/mapped_number.h"
#include "scene/material.h"

namespace nacre {

// A number or a colour of a material. A number is passed as a grey, three equal components.
struct MaterialParameter {
  std::string_view name;  // as in scene files: "roughness", "base_color"
  bool is_color;
  Range range;  // of the number or of each component
  Rgb (*get)(const Material&);
  void (*set)(Material&, const Rgb&);
  std::string_view meaning;  // for people: a sentence or two
  // If not empty, 0 leaves nothing of this layer, whose parameters and maps have names that begin
  // with it and "_" (idle_layers.h).
  std::string_view layer = {};
};

// A parameter with named options, numbered from 0. A "preset" sets other parameters, so choices are
// made before parameters are set.
struct MaterialChoice {
  std::string_view name;
  std::span<const std::string_view> options;
  size_t (*get)(const Material&);  // null for a preset, which leaves no trace of its name
  void (*set)(Material&, size_t option);
  std::string_view meaning;
};

// How the image behind a map is read.
enum class MapUse : uint8_t {
  kColor,    // its 8- and 16-bit files are sRGB unless they say otherwise
  kData,     // numbers, never encoded; the first channel counts
  kTwoData,  // numbers, never encoded; green and blue count
  kOpacity,  // its alpha, unless it says otherwise; decides where surfaces are, not how they look
};

// One of the parameters that a map multiplies.
struct MapTarget {
  MappedNumber number;
  bool is_color;
  int channel;  // of the texels, for a number; colours are multiplied channel by channel
  Rgb (*factor)(const Material&);  // what the map multiplies, as MaterialParameter::get
  double most;                     // products are clamped to [0, most]
  // What the parameter is where the map is 0; null: 0. In between it is interpolated.
  double (*least)(const Material&) = nullptr;
};

// A texture that multiplies parameters.
struct MaterialMap {
  std::string_view name;
  MapUse use;
  TextureId (*get)(const Material&);
  void (*set)(Material&, TextureId);
  std::string_view meaning;
  MapTarget targets[2];
  // 0 for opacity maps, which are looked up where rays meet meshes, and for maps of coats, which
  // are materials of their own (scene/coat.h).
  size_t target_count;
};
inline std::span<const MapTarget> TargetsOf(const MaterialMap& map) {
  return {map.targets, map.target_count};
}

// A normal map.
struct MaterialNormalMap {
  std::string_view name;
  NormalMap& (*of)(Material&);
  std::string_view meaning;
};
inline const NormalMap& NormalMapOf(const MaterialNormalMap& map, const Material& material) {
  return map.of(const_cast<Material&>(material));  // `of` does not modify it
}

// The textures of all maps of the material, in the order in which scene files are read.
std::vector<TextureId> TexturesOf(const Material& material);

// The material without maps and vertex colours: every hit has the maps' factors as parameters.
Material WithoutMaps(const Material& material);

struct MaterialModel {
  std::string_view name;  // "metallic_roughness"
  std::string_view title;
  Material (*make)();  // one with every default
  bool (*holds)(const Material&);
  std::span<const MaterialParameter> parameters;
  std::span<const MaterialChoice> choices;
  std::span<const MaterialMap> maps;
  std::span<const MaterialNormalMap> normal_maps;
  // The default axes of `nacre grid`, as people type them (scene_io/sheet_axis.h).
  std::string_view rows, columns;
};

// All models that have parameters, that is, all but `split`.
std::span<const MaterialModel> MaterialModels();

// The model of this name, or nullptr.
const MaterialModel* FindModel(std::string_view name);

// The model of this material; nullptr for a split.
const MaterialModel* ModelOf(const Material& material);

// Whether the material's opacity may cut holes in meshes that have no Mesh::opacities.
bool CutsHoles(const Material& material);

// The parameter of this name, or nullptr.
const MaterialParameter* FindParameter(const MaterialModel& model, std::string_view name);

}  // namespace nacre
