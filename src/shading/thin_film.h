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
  bool metal_by_hit = false;  // ThinFilmLobe::metal_by_hit
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

// Whether the colours of a metal below a film differ by hit; and F0 of Schlick's curve that
// reflects at n.v what such a hit does below its film and coat.
bool MetalVariesBelowFilm(const OpenPbrMaterial& material, bool base_by_hit);
Rgb FilmedMetalAtHit(const OpenPbrMaterial& material, const Rgb& base_color,
                     const Rgb& specular_color, double n_dot_v);

// Whether the film, or what lies below it, differs by hit. `base_by_hit`: base_color does, by the
// colours of vertices.
bool FilmVaries(const MetallicRoughnessMaterial& material, bool base_by_hit);

// F0 of Schlick's curves that reflect at n.v what a film of that thickness does: over a dielectric,
// and over the metal. A lobe is thus that of the film along the mirror direction, as in Khronos'
// viewer, and coloured less than it should be where light and viewer are far from it.
struct FilmedF0 {
  Rgb dielectric, metal;
};
FilmedF0 FilmAtHit(const MetallicRoughnessMaterial& material, double thickness_nm,
                   const Rgb& base_color, const Rgb& dielectric_f0, double n_dot_v);

}  // namespace nacre
