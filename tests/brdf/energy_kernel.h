// SPDX-License-Identifier: Apache-2.0
// tests/brdf/energy_kernel.h: the SIMD Fresnel curves and albedos of src/brdf evaluated on arrays,
// for tests against their scalar twins and the tables.
#pragma once

#include <vector>

#include "brdf/albedo.h"
#include "brdf/fresnel_table.h"

namespace nacre {

struct FresnelInput {
  float v_dot_h, one_minus_vh;
  float eta, k;     // k: of the conductor
  float f0, slope;  // of Schlick and F82
};

struct FresnelOutput {
  float dielectric, conductor, schlick, f82;
};

std::vector<FresnelOutput> EvaluateFresnel(const std::vector<FresnelInput>& inputs);

struct AlbedoOutput {
  float one, loss, schlick, fresnel;
};

// For each n.v.
std::vector<AlbedoOutput> EvaluateAlbedos(const FresnelAlbedoFit& fit,
                                          const std::vector<float>& n_dot_v);

// 1 - R of a table at each v.h.
std::vector<Vec3f> EvaluateFresnelTable(const FresnelTable& table,
                                        const std::vector<float>& v_dot_h);

}  // namespace nacre
