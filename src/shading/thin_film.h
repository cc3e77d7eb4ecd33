// SPDX-License-Identifier: Apache-2.0
// shading/thin_film.h: what thin films make of the Fresnel curves of materials (ThinFilmLobe), from
// the parameters and options of each model that has them.
#pragma once

#include <memory>

#include "scene/material.h"
#include "shading/models.h"

namespace nacre {

// Which curves a material's hits need, and of which lobes.
struct FilmUse {
  bool dielectric = true, metal = true;
  Shadowing shadowing = Shadowing::kHeightCorrelated;
  double roughness = 0;
  bool roughness_by_hit = false;  // ShadingMaterial::by_hit.width
  bool is_anisotropic = false;    // its albedos are made with the lobe
};

// Null without a film.
std::shared_ptr<const ThinFilmLobe> MakeThinFilmLobe(const OpenPbrMaterial& material,
                                                     const FilmUse& use);
std::shared_ptr<const ThinFilmLobe> MakeThinFilmLobe(const MetallicRoughnessMaterial& material,
                                                     const FilmUse& use);

}  // namespace nacre
