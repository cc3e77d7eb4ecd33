// SPDX-License-Identifier: Apache-2.0
// tests/light/area_kernel.h: the SIMD area lights of src/light on arrays, for tests.
#pragma once

#include <vector>

#include "light/disk_light.h"
#include "light/rectangle_light.h"
#include "light/sphere_light.h"
#include "light/triangle_light.h"

namespace nacre {

// The inputs of all functions of a light.
template <class Light>
struct LightQuery {
  Light light;
  float u0 = 0, u1 = 0;      // for the sample
  Vec3f direction{0, 0, 1};  // for the pdf
  Vec3f normal{0, 0, 1};     // for the irradiance
};

struct LightAnswer {
  AreaSample<float> sample;
  float pdf = 0;
  float solid_angle = 0;  // 0 for disks
  float irradiance = 0;
};

// On the active target, query by query.
std::vector<LightAnswer> AskLights(const std::vector<LightQuery<SphereLight<float>>>& queries);
std::vector<LightAnswer> AskLights(const std::vector<LightQuery<RectangleLight<float>>>& queries);
std::vector<LightAnswer> AskLights(const std::vector<LightQuery<DiskLight<float>>>& queries);
std::vector<LightAnswer> AskLights(const std::vector<LightQuery<TriangleLight<float>>>& queries);

}  // namespace nacre
