// SPDX-License-Identifier: Apache-2.0
// shading/seen_light.h: an area light as one point of a surface sees it, in double: what the fast
// mode of area lights is measured against.
#pragma once

#include <vector>

#include "base/basis.h"
#include "light/disk_light.h"
#include "light/ltc.h"
#include "light/sphere_light.h"
#include "light/triangle_light.h"
#include "shading/sampled_light.h"

namespace nacre {

class SeenLight {
 public:
  // Both outlive it. The point is relative to the camera, as the light is.
  SeenLight(const SampledLight& light, const Vec3d& point) : light_(light), point_(point) {}

  // A direction to it; 0 where a sample misses.
  Vec3d Sample(double u0, double u1) const;

  // The density with which Sample chooses a direction; 0: no light is seen there.
  double Density(const Vec3d& direction) const;

  // The part of the lobe with this frame and matrix that it fills. SIMD twins: fast_area_kernel.cc,
  // fast_round_kernel.cc.
  double Share(const LtcNumbers& numbers, const Basis<double>& frame) const;

 private:
  bool Emits(bool front) const { return front || light_.two_sided; }
  double MeshDensity(const Vec3d& direction) const;
  SphereLight<double> Sphere() const { return {light_.place - point_, light_.radius}; }
  DiskLight<double> Disk() const { return {light_.place - point_, light_.normal, light_.radius}; }
  RectangleLight<double> Rectangle() const {
    return {light_.place - point_, light_.edge_x, light_.edge_y};
  }
  TriangleLight<double> Triangle(size_t i) const;

  const SampledLight& light_;
  const Vec3d& point_;
  mutable std::vector<MeshLightMeeting> meetings_;  // of the last density
};

}  // namespace nacre
