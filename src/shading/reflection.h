// SPDX-License-Identifier: Apache-2.0
// shading/reflection.h: the light that a surface reflects from one light to one viewer, in double,
// by component, and the kinds of lobes that make up the components.
#pragma once

#include <cstdint>

#include "base/vec.h"

namespace nacre {

// The kinds of lobes. They decide how a lobe is sampled, and which component of the reflection it
// belongs to.
enum class LobeKind : uint8_t {
  kDiffuse,  // the diffuse component: wide lobes about the normal, or at grazing angles all around
  kGlossy,   // the specular component
  kDelta,    // the specular component: a perfect mirror, which punctual lights cannot show
};

// Radiance towards the viewer per irradiance perpendicular to the light, f n.l. It is finite for
// every model, even where the BRDF f is not.
struct Reflection {
  Rgb diffuse{0, 0, 0}, specular{0, 0, 0};

  Rgb Sum() const { return diffuse + specular; }
};

// The component that lobes of a kind belong to; of a Reflection, or of any struct with one member
// each.
template <class Components>
auto& ComponentOf(LobeKind kind, Components& components) {
  return kind == LobeKind::kDiffuse ? components.diffuse : components.specular;
}

}  // namespace nacre
