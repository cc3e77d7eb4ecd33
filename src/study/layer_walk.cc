// SPDX-License-Identifier: Apache-2.0
#include "study/layer_walk.h"

#include <algorithm>
#include <cmath>

#include "brdf/lobe_sampling.h"
#include "brdf/microsurface_walk.h"
#include "brdf/open_pbr.h"
#include "sampling/hash.h"
#include "shading/open_pbr.h"

namespace nacre {
namespace {

Vec3d SampleDiffuse(WalkRandom* random) {
  const double u0 = (*random)(), u1 = (*random)();
  return SampleCosine(Vec3d(0, 0, 1), u0, u1);
}

// The base below a medium of index `above`: the metal, or the dielectric over its inside of albedo
// `inside`. Returns the direction in which light that comes down along `direction` leaves it.
Vec3d WalkBase(const OpenPbrMaterial& surface, const Rgb& inside, double above, Vec3d direction,
               WalkRandom* random, Rgb* weight) {
  const double alpha = AlphaFromRoughness(surface.specular_roughness);
  if ((*random)() < surface.base_metalness) {
    const Rgb f0 = surface.base_color * surface.base_weight;
    const auto reflectance = [&](double cosine) {
      return MakeRgb([&](int c) {
        return FresnelF82(cosine, 1 - cosine, f0[c],
                          F82SlopeFromTint(f0[c], surface.specular_color[c]));
      });
    };
    return WalkOpaque(direction, alpha, reflectance, *random, weight);
  }
  const double eta = RelativeIndexBelow(surface, above);
  MicrosurfaceExit exit = WalkDielectric(direction, true, eta, alpha, *random);
  while (!exit.above) {
    *weight *= inside;
    exit = WalkDielectric(SampleDiffuse(random), false, eta, alpha, *random);
  }
  return exit.direction;
}

void AbsorbInCoat(const OpenPbrMaterial& surface, double cosine, Rgb* weight) {
  *weight *= MakeRgb([&](int c) { return CoatCrossing(surface.coat_color[c], cosine); });
}

}  // namespace

double WalkRandom::operator()() {
  state_ += 0x9e3779b97f4a7c15u;
  return static_cast<double>(Mix64(state_) >> 11) * 0x1p-53;
}

// What a smooth interface reflects back to the inside makes it darker than it is (Saunderson 1942).
Rgb InsideAlbedo(const OpenPbrMaterial& surface, InsideColor meaning) {
  const Rgb color = DiffuseColor(surface);
  if (meaning == InsideColor::kAlbedo) return color;
  const double eta = RelativeIndexBelow(surface, 1);
  const double k = InternalDiffuseReflectance(AverageDielectric(eta), eta);
  return MakeRgb([&](int c) { return color[c] / (1 - k + color[c] * k); });
}

LayerExit WalkLayers(const OpenPbrMaterial& surface, const Rgb& inside, const Vec3d& from,
                     WalkRandom* random) {
  LayerExit exit{.direction = -from};
  if ((*random)() >= surface.coat_weight) {
    exit.direction = WalkBase(surface, inside, 1, exit.direction, random, &exit.weight);
    exit.from_base = true;
    return exit;
  }
  const double alpha = AlphaFromRoughness(surface.coat_roughness);
  MicrosurfaceExit at_coat{exit.direction, true};
  for (bool above = true;; above = false) {
    at_coat = WalkDielectric(at_coat.direction, above, surface.coat_ior, alpha, *random);
    if (at_coat.above) break;
    exit.from_base = true;
    AbsorbInCoat(surface, -at_coat.direction.z, &exit.weight);
    at_coat.direction =
        WalkBase(surface, inside, surface.coat_ior, at_coat.direction, random, &exit.weight);
    AbsorbInCoat(surface, at_coat.direction.z, &exit.weight);
  }
  exit.direction = at_coat.direction;
  return exit;
}

Rgb WalkedShare(const OpenPbrMaterial& surface, const Rgb& inside, double cosine, int walks,
                uint64_t seed) {
  WalkRandom random(seed);
  const Vec3d from(std::sqrt((1 - cosine) * (1 + cosine)), 0, cosine);
  Rgb sum(0);
  for (int i = 0; i < walks; ++i) sum += WalkLayers(surface, inside, from, &random).weight;
  return sum / walks;
}

}  // namespace nacre
