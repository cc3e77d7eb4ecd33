// SPDX-License-Identifier: Apache-2.0
// render/texel_maps.h: the images in which adaptive sampling looks for rare texels
// (rare_texels.cc): the maps of each material, and the sky behind the shapes.
#pragma once

#include <memory>
#include <vector>

#include "render/highlights.h"
#include "render/lights_plan.h"
#include "render/surfaces.h"
#include "texture/texel_search.h"

namespace nacre {

struct TexelMap {
  TextureId texture;
  std::vector<TexelMeasure> measures;
};

// A normal map over a lobe.
struct LobeNormalMap {
  NormalMap map;
  double width;  // NormalLobe::width, of the whole map
};

struct TexelMaps {
  // By material of the scene: the maps of its appearance, including those of its coat, and of its
  // opacity.
  std::vector<std::vector<TexelMap>> looks, opacities;
  std::vector<std::vector<LobeNormalMap>> normals;
  std::vector<HighlightLight> suns;  // of skies, if there are normal maps
  bool any_looks = false, any_normals = false, any_opacity = false;
  std::vector<std::unique_ptr<const TexelExtremes>> extremes;  // by texture
  // The picture of a visible sky.
  TexelGrid sky;
  std::unique_ptr<const TexelExtremes> sky_extremes;
  std::vector<TexelMeasure> sky_measures;
};

// Finds the maps of the materials and of the sky; null if there are none.
std::shared_ptr<const TexelMaps> FindTexelMaps(const Scene& scene, const LightsPlan& lights,
                                               double max_error);

// The image of a texture as it is looked up.
TexelGrid GridOf(const Scene& scene, TextureId texture, size_t mip_level);

}  // namespace nacre
