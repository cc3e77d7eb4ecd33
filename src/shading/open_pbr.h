// SPDX-License-Identifier: Apache-2.0
// shading/open_pbr.h: what follows from the parameters and options of OpenPBR materials
// (scene/open_pbr.h) for their base and their coat.
#pragma once

#include "brdf/fresnel.h"
#include "brdf/thin_film.h"
#include "scene/open_pbr.h"
#include "shading/coat_transmission.h"
#include "shading/derive.h"

namespace nacre {

// The roughness of the base's lobe, which a rough coat widens.
double RoughnessBelowCoat(const OpenPbrMaterial& material);
// The same of a hit with a specular_roughness of its own.
double RoughnessBelowCoat(const OpenPbrMaterial& material, double specular_roughness);

// What the material's coat lets through.
CoatTransmission TransmissionOf(const OpenPbrMaterial& material);

// Sets what a coat's darkening takes the base for.
void EstimateBelowCoat(const OpenPbrMaterial& material, CoatTransmission* coat);

// The colour of the diffuse base, in which a subsurface has its share.
Rgb DiffuseColor(const OpenPbrMaterial& material);

// The factor on base_color in the albedo for which light bounces between the facets of a rough
// diffuse base.
double WeightInRho(const OpenPbrMaterial& material, double metalness);

// The index of the dielectric base over that of what lies above it, by the weight's rule.
double RelativeIndexBelow(const OpenPbrMaterial& material, double above);

// The index of a metal, seen from vacuum, of which F0 and the factor on the reflectance at 81.8
// degrees are given.
Substrate MetalBelow(FilmMetal rule, double f0, double tint);

// Whether the coat changes the metal's F0; and a channel with the F0 that it has then.
bool ChangesMetal(const OpenPbrMaterial& material);
MicrofacetColors WithMetalBelowCoat(const OpenPbrMaterial& material, double specular_color,
                                    MicrofacetColors at);

// Fresnel's curve of the dielectric base, as seen through its coat.
CoatedDielectric<double> DielectricOf(const OpenPbrMaterial& material);

}  // namespace nacre
