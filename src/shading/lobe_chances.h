// SPDX-License-Identifier: Apache-2.0
// shading/lobe_chances.h: the probabilities of sampling each lobe of a stack, from estimates of the
// lobes' albedos at n.v. The estimates need not be exact: any probability above 0 for a lobe that
// reflects light gives the right mean.
#pragma once

#include <algorithm>
#include <array>
#include <span>
#include <vector>

#include "scene/coat.h"
#include "shading/hit_parameters.h"
#include "shading/material.h"
#include "shading/surface.h"

namespace nacre {

// The fraction a / (a + b); 0 if both are 0.
inline double Fraction(double a, double b) { return a + b > 0 ? a / (a + b) : 0; }

// A number in [0, 1) that makes one choice after the other, rescaled to [0, 1) by each.
class Chooser {
 public:
  explicit Chooser(double u) : u_(u) {}
  bool Takes(double chance) {
    if (u_ < chance) {
      u_ /= chance;
      return true;
    }
    u_ = (u_ - chance) / (1 - chance);
    return false;
  }
  double rest() const { return std::min(u_, 1 - 0x1p-53); }

 private:
  double u_;
};

// The albedos of the lobes of a model by itself, each in its brightest channel.
struct ModelAlbedos {
  double diffuse = 0, glossy = 0, mirror = 0;
};
ModelAlbedos AlbedosOf(const ShadingMaterial& material, const LobeCosines& v);
// The same estimates for hit i of a batch, for which PrepareRun has run; `maps` is null unless the
// hit has parameters of its own.
ModelAlbedos AlbedosAt(const ShadingMaterial& material, const HitParameters* maps,
                       const Surface& surface, size_t i, double n_dot_v);

// An estimate of the albedo of the diffuse base in its brightest channel. A map of one constant
// gives the same bits as the constant itself, so that both sample the same directions.
double BaseAlbedo(const ShadingMaterial& material, const HitParameters* maps = nullptr,
                  size_t i = 0);

// A layer over lobes whose albedo is `below_albedo` by itself: the probability of sampling the
// layer rather than these, and the albedo of all.
struct LayerChance {
  double chance, albedo;
};
LayerChance ChanceOf(const LayerModel& layer, double n_dot_v, double below_albedo);

// One coat, seen from the viewer.
struct CoatInView {
  Rgb albedo;
  Rgb transmittance;  // of the light from below
  bool is_mirror;
};

// The probability of sampling each coat's lobe rather than the glossy lobes below it; 0 for
// mirrors. `glossy` is the albedo of the glossy lobes below all coats. Coats are ordered from the
// bottom up.
void FindCoatChances(std::span<const CoatInView> coats, double glossy, std::span<double> chances);

// The probability of sampling each kind of lobe of the whole material; their sum is 1. Without any
// lobe that reflects light, cosine-weighted directions are sampled.
struct KindChances {
  double diffuse = 1, glossy = 0;
  std::array<double, 1 + kMostCoats> mirror{};  // of the model, and of each coat
};
// `layers` and `coats` are those of the hit. `mirrors` is false to leave out mirrors.
KindChances ChancesOfKinds(const std::vector<LayerModel>& layers, double n_dot_v,
                           const ModelAlbedos& albedos, std::span<const CoatInView> coats,
                           bool mirrors);

// What ChooseKind returns: a kind of lobe, or kMirrorChosen + the level of a mirror, as in
// KindChances::mirror.
inline constexpr size_t kDiffuseChosen = 0, kGlossyChosen = 1, kMirrorChosen = 2;
size_t ChooseKind(const KindChances& chances, Chooser* chooser);

}  // namespace nacre
