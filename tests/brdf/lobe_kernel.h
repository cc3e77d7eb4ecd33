// SPDX-License-Identifier: Apache-2.0
// tests/brdf/lobe_kernel.h: the SIMD lobe samplers of src/brdf on arrays, for tests.
#pragma once

#include <vector>

#include "base/vec.h"

namespace nacre {

enum class Lobe { kCosine, kGgx, kPhong, kBlinn, kKullaConty };

struct LobeQuery {
  Vec3f n, v;
  float width = 0;       // alpha, shininess, spread or roughness
  float u0 = 0, u1 = 0;  // for the sample
  Vec3f l{0, 0, 1};      // for the pdf
};

struct LobeAnswer {
  Vec3f sample;
  float pdf = 0;
};

// On the active target, query by query.
std::vector<LobeAnswer> AskLobe(Lobe lobe, const std::vector<LobeQuery>& queries);

}  // namespace nacre
