// SPDX-License-Identifier: Apache-2.0
// study/picture.h: renders small scenes and arranges them on sheets.
#pragma once

#include <string>
#include <vector>

#include "base/image.h"
#include "base/picture.h"
#include "color/display.h"
#include "scene/scene.h"
#include "study/study.h"

namespace nacre {

using MaterialKind = decltype(Material::model);
Material MaterialOf(const MaterialKind& model);

// A sphere of radius 1 at the origin with a material of this model, seen from +z by parallel rays
// in a square of 2.2 world units and `pixels` pixels.
Scene SphereScene(const MaterialKind& model, int pixels, const std::vector<Light>& lights);

// A directional light; `to_light` points towards it.
Light SunTowards(const Vec3d& to_light, const Rgb& irradiance);

// Renders the whole picture with these layers.
Image RenderLayers(const Scene& scene, const std::vector<std::string>& layers = {});

// For ShowImage: clips at 1.
inline constexpr DisplaySettings kClipped{.tone = ToneOperator::kNone};

// Panes of equal size in rows, with labels above the columns and left of the rows (either may be
// empty).
struct PaneSheet {
  std::vector<Rgb8Picture> panes;  // row by row
  std::vector<std::string> columns, rows;
};
StudyPicture MakeStudyPicture(const std::string& name, const std::string& caption,
                              const PaneSheet& sheet);

}  // namespace nacre
