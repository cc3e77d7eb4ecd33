// SPDX-License-Identifier: Apache-2.0
// tests/light/environment_kernel.h: the SIMD environments of src/light on arrays, for tests.
#pragma once

#include <cstdint>
#include <vector>

#include "light/environment.h"
#include "light/sky.h"

namespace nacre {

// All on the active target, element by element.
std::vector<EnvironmentTexel> LookUpTexels(const EnvironmentMap& map,
                                           const std::vector<Vec3f>& directions);
std::vector<EnvironmentSample<float>> SampleEnvironments(const EnvironmentMap& map,
                                                         const std::vector<uint32_t>& bits0,
                                                         const std::vector<uint32_t>& bits1);

// Radiance in x, irradiance in y.
std::vector<Vec3f> EvaluateSky(const GradientSkyTerms<float>& sky,
                               const std::vector<Vec3f>& directions);
std::vector<Vec3f> EvaluateSky(const QuadraticSkyTerms<float>& sky,
                               const std::vector<Vec3f>& directions);

}  // namespace nacre
