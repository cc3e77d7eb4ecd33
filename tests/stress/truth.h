// SPDX-License-Identifier: Apache-2.0
// tests/stress/truth.h: the third witness beside renderer and tables: a picture by brute force in
// long double, one ray through each pixel's centre, punctual lights, hard shadows. It reads the
// scene's own numbers and shares no formula's code with the renderer: no Embree, no SIMD, no float.
//
// Spheres only. Right to 1e-12 of a radius up to distances of 1e7 radii.
#pragma once

#include <cstdint>
#include <vector>

#include "scene/scene.h"

namespace nacre {

// Where the picture is discontinuous and a double cannot be asked for the right side.
enum TruthDoubt : uint8_t {
  kCertain = 0,
  kLimb = 1,        // the ray passes a sphere's limb
  kDepth = 2,       // two surfaces, or a surface and the eye, at one depth
  kTerminator = 4,  // |n.l| < kTerminatorCosine for some light
  kShadowEdge = 8,  // a shadow ray passes a limb, or begins or ends at another surface
};

inline constexpr double kTerminatorCosine = 1e-6;

struct TruthPixel {
  Rgb radiance{0, 0, 0};
  // What errors of the radiance are relative to: the radiance, but for grazing light, whose cosine
  // is known to an absolute error: a light with n.l < kGrazingCosine counts by
  // kGrazingCosine / n.l times what it adds.
  Rgb scale{0, 0, 0};
  Vec3d normal{0, 0, 0};  // on the ray's side
  double depth = 0;       // distance along the viewing direction
  uint32_t object = 0;    // 1 + sphere index; 0: background
  uint32_t material = 0;  // index into the scene's materials, splits resolved
  uint8_t doubt = kCertain;
};

// The rounding of n and l to float, about 2e-7 in n.l, is 1e-6 of this.
inline constexpr double kGrazingCosine = 0.2;

struct TruthPicture {
  int width = 0, height = 0;
  std::vector<TruthPixel> pixels;
};

// spp and filter are not looked at. Throws std::invalid_argument for meshes and for models that
// truth_reflect.h does not have. `threads`: as in base/parallel.h.
TruthPicture RenderTruth(const Scene& scene, int threads = 0);

}  // namespace nacre
