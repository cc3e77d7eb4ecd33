// SPDX-License-Identifier: Apache-2.0
// tests/brdf/anisotropic_kernel.h: the SIMD forms of anisotropic GGX on arrays, for tests.
#pragma once

#include <vector>

#include "base/vec.h"
#include "brdf/anisotropic_albedo.h"

namespace nacre {

struct AnisotropicQuery {
  Vec3f n, t, l, v;  // t: unit and perpendicular to n
  float alpha_x, alpha_y;
  float u0 = 0, u1 = 0;  // for the sample
};

struct AnisotropicAnswer {
  float distribution, height_correlated, separable;
  float pdf;  // of l
  Vec3f sample;
};

// On the active target, query by query.
std::vector<AnisotropicAnswer> AskAnisotropic(const std::vector<AnisotropicQuery>& queries);

struct FrameQuery {
  Vec3f n, t;
  float cos = 1, sin = 0;
};
struct FrameAnswer {
  Vec3f frame_x, frame_y;  // of LobeFrame
  Vec3f rotated;           // RotatedTangent of frame_x
};
std::vector<FrameAnswer> AskFrames(const std::vector<FrameQuery>& queries);

struct AnisotropicAlbedoOutput {
  float loss, schlick, fresnel;
};
// One fit for all directions, which are in the lobe's frame; or a fit for each, all of the
// dielectric of the first.
std::vector<AnisotropicAlbedoOutput> EvaluateAnisotropicAlbedos(
    const AnisotropicFresnelFit& fit, const std::vector<Vec3f>& directions);
std::vector<AnisotropicAlbedoOutput> EvaluateAnisotropicAlbedos(
    const std::vector<AnisotropicFresnelFit>& fits, const std::vector<Vec3f>& directions);

}  // namespace nacre
