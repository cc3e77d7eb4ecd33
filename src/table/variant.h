// SPDX-License-Identifier: Apache-2.0
// table/variant.h: a material as a program with mistakes would evaluate it: with other parameters,
// in other directions, or by a formula that differs in one place. Without mistakes it is what
// shading/scalar_bsdf.h computes, lobe by lobe.
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "scene/material.h"
#include "shading/material.h"

namespace nacre {

// Mistakes in the formulas, as bits. Those about F and G concern the GGX lobe of microfacet models.
enum FormulaSlip : uint32_t {
  kNoF82Clamp = 1u << 0,         // F82's curve is not kept within [0, 1]
  kF0ForAverage = 1u << 1,       // Kulla and Conty's lobe is coloured by F0, not by F's average
  kAverageForF0 = 1u << 2,       // Turquin's factor has F's average for F0
  kFresnelAtNormal = 1u << 3,    // F(n.h)
  kFresnelAtView = 1u << 4,      // F(n.v)
  kFresnelAtLight = 1u << 5,     // F(n.l)
  kNoShadowing = 1u << 6,        // G = 1
  kViewForLight = 1u << 7,       // layers take the view's cosine for the light's, too
  kLightForView = 1u << 8,       // layers take the light's cosine for the view's
  kCoveredBothWays = 1u << 9,    // a base by 1 - E of the view gets 1 - E of the light as well
  kNothingCovered = 1u << 10,    // what lies above takes nothing from what lies below
  kFullyCompensated = 1u << 11,  // compensation as for a white metal, without Fresnel's colour
};

// Mistakes about directions.
enum class DirectionSlip : uint8_t {
  kNone,
  kSwapped,        // light and view changed places
  kYUp,            // y is the normal: y and z changed places
  kTangentTurned,  // tangent and bitangent changed places
  kLightReversed,  // the light's direction is the one in which it travels
  kViewReversed,   // the view's direction is the one of sight
  kBothReversed,
};

struct Variant {
  Material material;
  uint32_t formula = 0;  // FormulaSlip
  DirectionSlip directions = DirectionSlip::kNone;
  double factor = 1;
  int cosines_of_light = 0, cosines_of_view = 0;  // powers of n.l and n.v that multiply f
  std::vector<std::pair<std::string, double>> lobe_factors{};  // by the names of lobes
};

class PreparedVariant {
 public:
  explicit PreparedVariant(const Variant& variant);

  const ShadingMaterial& material() const { return material_; }

  // The names of the lobes: "diffuse" and "specular" of the model, which either may lack, then
  // each layer and coat from the bottom up.
  const std::vector<std::string>& lobes() const { return lobes_; }

  // Sets what each lobe contributes to f, in 1/sr and without n.l, attenuated by what lies above:
  // f is their sum. Black where light or view is not above the surface. Mirrors are left out.
  void Evaluate(const Vec3d& to_light, const Vec3d& to_view, std::span<Rgb> values) const;

  // Whether any lobe is wider along the tangent (+x) than across it, or the other way round.
  bool is_anisotropic() const { return is_anisotropic_; }

  // The sum of the lobes.
  Rgb Evaluate(const Vec3d& to_light, const Vec3d& to_view) const;

 private:
  ShadingMaterial material_;
  uint32_t formula_ = 0;
  DirectionSlip directions_ = DirectionSlip::kNone;
  double factor_ = 1;
  int cosines_of_light_ = 0, cosines_of_view_ = 0;
  bool is_anisotropic_ = false;
  std::vector<std::string> lobes_;
  std::vector<double> factors_;  // of the lobes
};

// The albedos of a material as it is, without mistakes, each computed once.
class ViewAlbedos {
 public:
  explicit ViewAlbedos(const PreparedVariant& of) : of_(of) {}

  // Whether `to_view`, which is above the surface, needs one that is not there yet.
  bool IsNew(const Vec3d& to_view) const { return !known_.contains(KeyOf(to_view)); }
  const Rgb& At(const Vec3d& to_view);
  size_t size() const { return known_.size(); }

 private:
  // n.v and, of anisotropic materials, the azimuth.
  using Key = std::pair<double, double>;
  Key KeyOf(const Vec3d& to_view) const;

  const PreparedVariant& of_;
  std::map<Key, Rgb> known_{};
};

}  // namespace nacre
