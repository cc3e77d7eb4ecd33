// SPDX-License-Identifier: Apache-2.0
// tests/stress/truth_reflect.h: the reflection models as their papers write them, in long double:
// the truth that the kernels are held against. Nothing here is shared with src/brdf or src/shading.
#pragma once

#include <Imath/ImathVec.h>

#include "scene/scene.h"

namespace nacre {

// 64 bits of mantissa on x86: 11 more than double, 40 more than the kernels have.
using TruthReal = long double;
using TruthVec = Imath::Vec3<TruthReal>;

struct TruthReflection {
  TruthVec diffuse{0, 0, 0}, specular{0, 0, 0};
};

// Radiance reflected towards to_view of irradiance 1 perpendicular to to_light. All directions are
// unit. 0 where n.l <= 0. Of a model that has options beyond those that the formula names
// (microfacets: single scattering, Schlick's or exact Fresnel, diffuse (1 - F)) the plain form.
// Throws std::invalid_argument for a model that is not written here.
TruthReflection ReflectTruth(const Material& material, const TruthVec& normal,
                             const TruthVec& to_light, const TruthVec& to_view);

// Radiance reflected of ambient light of radiance 1.
TruthVec AmbientTruth(const Material& material);

// Turns off what ReflectTruth does not have, wherever the scene's materials offer it: options are
// found by name, so that a build without them is as good.
void UsePlainForms(Scene* scene);

}  // namespace nacre
