// SPDX-License-Identifier: Apache-2.0
// study/lobe_curves.h: a lobe and those that stand in for it, drawn over one another.
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

// The specular lobes in the plane of incidence, a panel for each of kResidualViewsDeg: what the
// viewer sees of light of each angle, in luminance. The first lobe's width chooses the angles, out
// to where it has fallen to little.
Figure LobeFigure(const std::vector<NamedLobe>& lobes);

}  // namespace nacre
