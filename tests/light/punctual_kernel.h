// SPDX-License-Identifier: Apache-2.0
// tests/light/punctual_kernel.h: the SIMD fall-offs of src/light on arrays, for tests.
#pragma once

#include <vector>

#include "light/punctual.h"

namespace nacre {

// On the active target, element by element; all vectors of one size.
std::vector<float> EvaluateAttenuation(const std::vector<AttenuationTerms<float>>& terms,
                                       const std::vector<float>& distances);
std::vector<float> EvaluateSpot(const std::vector<ConeTerms<double>>& cones,
                                const std::vector<double>& one_minus_cosines);

}  // namespace nacre
