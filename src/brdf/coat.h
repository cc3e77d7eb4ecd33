// SPDX-License-Identifier: Apache-2.0
// brdf/coat.h: clear coat, a layer of dielectric with a rough surface over any material. As
// KHR_materials_clearcoat of glTF 2.0: GGX of alpha = roughness^2, height-correlated shadowing,
// Schlick's Fresnel, no refraction and no absorption; but with any index of refraction, the Fresnel
// term of the half vector, and energy kept. SIMD twin: coat-inl.h. The lobe is sampled as any GGX
// lobe is: brdf/lobe_sampling.h.
//
// The extension weighs its lobe D V by the Fresnel term F(n.v) of the normal and gives what lies
// below the rest, f_below (1 - c F(n.v)) + c F(n.v) D V for a coat of amount c. As the directional
// albedo of D V is E < 1, a white surface under it reflects 1 - c F(n.v) (1 - E(n.v)) of the light,
// 85 % at n.v = 0.1 with c and roughness 1. Here the lobe is F(v.h) D V, and below gets what
// the lobe's albedo leaves, so that white stays white. Both are equal for smooth coats.
#pragma once

#include "brdf/albedo.h"
#include "brdf/fresnel.h"
#include "brdf/ggx.h"

namespace nacre {

// F(v.h) D V, of which the coat's amount and n.l are left out; f0 = FresnelF0(ior, 0). 0 unless
// both directions are above the surface, and for a delta lobe, which reflects FresnelSchlick(f0,
// Power5(1 - n.v)) of the mirror direction.
template <typename Real>
Real CoatLobe(const Angles<Real>& a, Real f0, Real alpha) {
  if (!(a.n_dot_l > 0) || !(a.n_dot_v >= 0)) return 0;
  return FresnelSchlick(f0, SchlickWeight(a)) * GgxDistribution(a, alpha) *
         VisibilityHeightCorrelated(a.n_dot_l, a.n_dot_v, alpha);
}

// The lobe's directional albedo; `fit` is of Shadowing::kHeightCorrelated and the coat's roughness.
// For a delta lobe it is Schlick's F(n.v) itself.
template <typename Real>
Real CoatAlbedo(const AlbedoFit& fit, Real f0, Real n_dot_v) {
  return f0 * AlbedoOne(fit, n_dot_v) + (1 - f0) * AlbedoSchlick(fit, n_dot_v);
}

// What the material below (its emission, too) is scaled by, under a coat of amount c in [0, 1]: a
// white one reflects exactly all, whatever its BRDF is. That needs the albedo of the viewer's side
// alone and is not reciprocal, like the diffuse base of the microfacet models
// (DiffuseCoupling::kAlbedoScaled); a product of both sides would have to be divided by a mean that
// depends on the BRDF below.
//
// The coat has no multiple-scattering compensation: what its microfacets shadow after one bounce
// mostly enters the coat at the next one, and reaches below, where this puts it. What would be
// reflected is 4 % of it, for an index of 1.5.
template <typename Real>
Real ScaleBelowCoat(Real amount, Real albedo_v) {
  return 1 - amount * albedo_v;
}

}  // namespace nacre
