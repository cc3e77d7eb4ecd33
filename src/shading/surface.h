// SPDX-License-Identifier: Apache-2.0
// shading/surface.h: the hits of a batch in the form that shading needs, the light on them and the
// light that they reflect, as structure of arrays.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>

#include "hit/batch.h"

namespace nacre {

// The hits of a batch, with terms that do not depend on the light.
struct Surface : HitDirections {
  // True if some of the hits are normal-mapped or bump-mapped. `interpolated_normal` then holds the
  // shading normals of all hits before that.
  bool normal_mapped = false;
  Soa3<float> interpolated_normal;
  // Set by TextureHits if the material asks for it (VariesByHit::tangent): unit, perpendicular to
  // the shading normal, along dP/du of the coordinates that TangentTurn names, turned by it.
  Soa3<float> tangent;
  // Set by PrepareRun for hits on microfacet materials:
  AlignedArray<float> multiple{kBatchCapacity};  // the weight of multiple scattering
  // If the coupling is kAlbedoScaled: 1 minus the albedo, at n.v, of the lobe over the base, which
  // is the fraction of light that the diffuse base gets, and that a coat does not reflect.
  Soa3<float> transmittance;
};

// Normals of meshes may lean away from the viewer: the cosine then counts as 0.
inline double NDotV(const Surface& surface, size_t i) {
  return std::clamp(VectorAt(surface.normal, i).dot(VectorAt(surface.to_view, i)), 0.0, 1.0);
}

// The normals of the plane below which no light comes: the surface without normal maps.
inline const Soa3<float>& HorizonNormal(const Surface& surface) {
  return surface.normal_mapped ? surface.interpolated_normal : surface.normal;
}

// Sampled directions whose cosine with HorizonNormal is at most this are below the horizon. With
// normal maps, glossy lobes and mirrors are bent and mirrored to above the horizon
// (hit/shading_normal.h, RaiseAboveHorizon), and may be narrower than what rounding leaves of that:
// a few units of 2^-24 of a product of unit vectors in float, here with a margin.
inline float LowestHeight(const Surface& surface) {
  return surface.normal_mapped ? -0x1p-20f : 0.0f;
}

// One light at the hits of a batch.
struct LightBatch {
  // Vectors towards the light, and 1 over their lengths. Directions that are given
  // (LightForm::kGiven) are unit vectors, and inverse_length is not read.
  Soa3<float> light_vector;
  AlignedArray<float> inverse_length{kBatchCapacity};
  // Irradiance perpendicular to the light per unit of its colour: fall-off, cone and visibility.
  // 0 where the surface faces away (n.l <= 0), because no model reflects such light.
  AlignedArray<float> irradiance{kBatchCapacity};
};

// The radiance that the hits of a batch reflect: the sum and, if requested, its components. In the
// sum, the specular component is rounded only once, by the addition.
struct ReflectedRadiance {
  Soa3<float> sum;
  Soa3<float> diffuse, specular;
};

// The half-vector terms of sharp lobes, computed in double (sharp_lobe_kernel.cc). Hits with their
// own roughness or exponent may mix sharp and wide lobes: wide ones are marked by a distribution or
// one_minus_cos of -1. All lobes of an anisotropic material count as sharp.
struct SharpLobeTerms {
  AlignedArray<float> distribution{kBatchCapacity};  // GGX
  // Anisotropic GGX: SmithRootOfLight and SmithRootOfView, and the light's cosines to tangent and
  // bitangent.
  AlignedArray<float> light_root{kBatchCapacity}, view_root{kBatchCapacity};
  AlignedArray<float> t_dot_l{kBatchCapacity}, b_dot_l{kBatchCapacity};
  AlignedArray<float> one_minus_cos{kBatchCapacity}, cos{kBatchCapacity};  // Phong family
};

// The Lambertian reflection of rough bases is multiplied by single + ratio multiple, where `ratio`
// is that of MatteConstants.
struct BaseSpread {
  AlignedArray<float> single{kBatchCapacity}, multiple{kBatchCapacity};
};

// Buffers for a user model: the hits for which it is evaluated, compacted, and its results.
struct UserRoom {
  LightBatch light;
  Soa3<double> normal, to_view, to_light, value;
  AlignedArray<double> n_dot_l{kBatchCapacity}, u{kBatchCapacity}, v{kBatchCapacity};
  AlignedArray<uint32_t> hit{kBatchCapacity};
};

// Buffers that ShadeRun and LobePdf use between the kernels of a run.
struct ShadeScratch {
  SharpLobeTerms sharp;
  BaseSpread base;
  std::unique_ptr<UserRoom> user;  // made for the first hit with a user model
};

// Sets the surface's directions by rounding those of the hits, which are in double, to float.
void PrepareSurface(const HitBatch& hits, Surface* surface);

// Zeroes the first `count` entries.
inline void ClearSoa(size_t count, Soa3<float>* soa) {
  std::fill_n(soa->x.data(), count, 0.0f);
  std::fill_n(soa->y.data(), count, 0.0f);
  std::fill_n(soa->z.data(), count, 0.0f);
}
inline void ClearRadiance(size_t count, ReflectedRadiance* radiance) {
  ClearSoa(count, &radiance->sum);
  ClearSoa(count, &radiance->diffuse);
  ClearSoa(count, &radiance->specular);
}

}  // namespace nacre
