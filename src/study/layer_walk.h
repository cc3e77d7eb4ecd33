// SPDX-License-Identifier: Apache-2.0
// study/layer_walk.h: what a coated OpenPBR surface does with light, by following light from layer
// to layer: the truth that rules for layers approximate (position-free, as in Guo et al. 2018:
// layers are wide compared to their depth, so only directions matter).
//
// Interfaces are walked microfacet by microfacet (brdf/microsurface_walk.h); a coat absorbs along
// the path; a coat of partial weight covers this fraction of the surface, as a metal of partial
// metalness does. No option of OpenPbrMaterial is read, except for specular_weight_rule. Fuzz,
// film, emission, transmission, anisotropy and maps are left out.
#pragma once

#include <cstdint>

#include "scene/open_pbr.h"

namespace nacre {

// Numbers in [0, 1), from SplitMix64 (Steele et al. 2014).
class WalkRandom {
 public:
  explicit WalkRandom(uint64_t seed) : state_(seed) {}
  double operator()();

 private:
  uint64_t state_;
};

// What base_color means for the diffuse inside of a dielectric.
enum class InsideColor : uint8_t {
  kAlbedo,    // its albedo
  kSeenBare,  // the light that comes out of the bare base, over the light that enters it
};

struct LayerExit {
  Vec3d direction;  // above the surface
  Rgb weight{1, 1, 1};
  bool from_base = false;  // whether the light has been below the coat
};

// The albedo of the diffuse inside that base_color means.
Rgb InsideAlbedo(const OpenPbrMaterial& surface, InsideColor color);

// Follows light that comes from the direction `from`, a unit vector above the surface. The normal
// is +z, `inside` the diffuse inside's albedo.
LayerExit WalkLayers(const OpenPbrMaterial& surface, const Rgb& inside, const Vec3d& from,
                     WalkRandom* random);

// The fraction of light from the cosine n.l = `cosine` that is reflected, the mean of so many
// walks. As all layers are reciprocal, it is also the radiance seen from there under radiance 1.
Rgb WalkedShare(const OpenPbrMaterial& surface, const Rgb& inside, double cosine, int walks,
                uint64_t seed);

}  // namespace nacre
