// SPDX-License-Identifier: Apache-2.0
// shading/scalar_bsdf.h: what a prepared material does with light, in double: evaluate, pdf and
// sample, for one direction of light and one of view. For measuring materials and explaining
// pixels, not for rendering: bsdf.h does the same for batches, by kernels in float.
#pragma once

#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "base/basis.h"
#include "shading/material.h"
#include "shading/reflection.h"

namespace nacre {

// All directions are unit vectors, and point away from the surface.

// The shading normals of a stack of lobes: of the model and its layers, and of each coat. Without
// `coats`, all share one. Does not own what is of the coats.
struct StackNormals {
  Vec3d model;
  std::span<const Vec3d> coats;
  // Surface::tangent of the model and of each coat. Without them, anisotropic lobes have the
  // tangent of DefaultTangent.
  std::optional<Vec3d> tangent;
  std::span<const Vec3d> coat_tangents;
  // Of the surface without normal maps, if it has any: no light comes from below its plane, and
  // glossy lobes that reach below it are mirrored in it, as in bsdf.cc.
  std::optional<Vec3d> unmapped;

  StackNormals(const Vec3d& all) : model(all) {}  // NOLINT(google-explicit-constructor)
  StackNormals(const Vec3d& of_model, std::span<const Vec3d> of_coats)
      : model(of_model), coats(of_coats) {}
  const Vec3d& coat(size_t k) const { return coats.empty() ? model : coats[k]; }
};

// The tangent of a surface of which only the normal is known: x across the normal, turned as the
// material has it.
Vec3d DefaultTangent(const ShadingMaterial& material, const Vec3d& normal);

// f |n.l| by component; black where light or viewer is not above the surface. Mirrors' lobes,
// emission, ambient light and maps are left out.
Reflection Reflect(const ShadingMaterial& material, const StackNormals& normals,
                   const Vec3d& to_light, const Vec3d& to_view);

// Distribution and visibility of a GGX lobe, of which `frame` is tangent, bitangent and normal,
// with light above the surface. Isotropic lobes read only the normal.
struct GgxTerms {
  double distribution, visibility;
};
GgxTerms GgxTermsOf(const MicrofacetModel& model, const Basis<double>& frame, const Vec3d& to_light,
                    const Vec3d& to_view);

// The frames of the model's lobe and of that of coat k.
Basis<double> FrameOfModel(const ShadingMaterial& material, const StackNormals& normals);
Basis<double> FrameOfCoat(const ShadingMaterial& material, const StackNormals& normals, size_t k);

// The level of glossy light that the model reflects by way of the horizon (StackNormals::unmapped).
inline constexpr std::string_view kMirroredLevel = "mirrored at the horizon";

// One level of a stack: what it reflects itself, and the factor by which it attenuates what all
// levels below it reflect.
struct StackLevel {
  std::string_view name;  // "model", a layer's name, kMirroredLevel, "coat"
  size_t index;           // among the layers, or among the coats
  Reflection own;
  Rgb below;
};

// The levels from the bottom up. Reflect is their sum, each attenuated by those above. Empty where
// light or viewer is not above the surface.
std::vector<StackLevel> ReflectByLevel(const ShadingMaterial& material, const StackNormals& normals,
                                       const Vec3d& to_light, const Vec3d& to_view);

// A direction to light that was sampled from a material.
struct ReflectionSample {
  Vec3d to_light;
  Rgb weight{0, 0, 0};  // f |n.l| / pdf; 0 for directions below the surface
  // Per solid angle, of all lobes but mirrors; for a sample of a mirror, the probability of the
  // mirror.
  double pdf = 0;
  LobeKind kind = LobeKind::kDiffuse;  // of the lobe that was sampled
};

// Samples the whole material with u0 and u1 in [0, 1). The kind of lobe is chosen in proportion to
// an estimate of each kind's albedo (lobe_chances.h). `mirrors` is false to leave out mirrors'
// lobes.
ReflectionSample SampleReflection(const ShadingMaterial& material, const StackNormals& normals,
                                  const Vec3d& to_view, double u0, double u1, bool mirrors = true);

// The pdf, per solid angle, with which SampleReflection chooses a direction from lobes other than
// mirrors, with the same `mirrors`.
double ReflectionPdf(const ShadingMaterial& material, const StackNormals& normals,
                     const Vec3d& to_view, const Vec3d& to_light, bool mirrors = true);

// The reflectance of a model that is a perfect mirror, at this n.v. Its shadowing loses nothing,
// except with kSchlickDirect, whose k is 1/8 at roughness 0 (Karis 2013); of that loss, Turquin's
// compensation returns the fraction given by the reflectance at normal incidence. Kulla and Conty's
// compensation is a lobe of its own.
Rgb MirrorReflectance(const MicrofacetModel& model, double n_dot_v);

// Fresnel's term of the model's curve at cosine v.h; for a mix of dielectric and metal, the mix.
Rgb FresnelOf(const MicrofacetModel& model, double v_dot_h, double one_minus_vh);

// F0 F, mixed for dielectric and metal. Turquin's compensation scales a lobe by 1 + F0 (1 / E - 1),
// and each of the two lobes of a mix by its own factor, so the Fresnel term becomes FresnelOf +
// (1 / E - 1) TurquinTerm.
Rgb TurquinTerm(const MicrofacetModel& model, double v_dot_h, double one_minus_vh);

// The visibility term G / (4 n.l n.v) in the model's form.
double VisibilityOf(const MicrofacetModel& model, double n_dot_l, double n_dot_v);

}  // namespace nacre
