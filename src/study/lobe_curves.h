// SPDX-License-Identifier: Apache-2.0
// study/lobe_curves.h: plots a lobe together with its approximations.
#pragma once

#include <string>
#include <vector>

#include "report/plot.h"
#include "scene/material.h"

namespace nacre {

struct NamedLobe {
  std::string label;
  Material material;
};

// The specular lobes in the plane of incidence, a panel for each of kResidualViewsDeg: the
// luminance that the viewer sees for light from each angle. The range of angles is chosen by the
// first lobe's width, so that it falls off almost completely.
Figure LobeFigure(const std::vector<NamedLobe>& lobes);

}  // namespace nacre
