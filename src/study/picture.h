// SPDX-License-Identifier: Apache-2.0
// study/picture.h: small scenes, rendered and put together on sheets.
#pragma once

#include <string>
#include <vector>

#include "base/image.h"
#include "base/picture.h"
#include "color/display.h"
#include "scene/scene.h"
#include "study/study.h"

namespace nacre {

// A sphere of radius 1 at the origin, seen from +z by parallel rays in a square of `height` world
// units and `pixels` pixels. With the material, which may be replaced; without lights.
Scene SphereScene(const Material& material, int pixels, double height = 2.2);

// Light from far away, towards `to_light`.
Light SunTowards(const Vec3d& to_light, const Rgb& irradiance);

// The whole picture with these layers.
Image RenderLayers(const Scene& scene, const std::vector<std::string>& layers = {});

// The colour or layer `layer` ("": the beauty) as a display shows it. kNone clips at 1.
Rgb8Picture ShowLayer(const Image& image, const std::string& layer,
                      const DisplaySettings& display = {.tone = ToneOperator::kNone});

// Panes of equal size in rows, with words above the columns and left of the rows (either may be
// empty).
struct PaneSheet {
  std::vector<Rgb8Picture> panes;  // row by row
  std::vector<std::string> columns, rows;
};
StudyPicture MakeStudyPicture(const std::string& name, const std::string& caption,
                              const PaneSheet& sheet);

}  // namespace nacre
