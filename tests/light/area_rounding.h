// SPDX-License-Identifier: Apache-2.0
// tests/light/area_rounding.h: area lights rounded to float and back.
#pragma once

#include "light/disk_light.h"
#include "light/rectangle_light.h"
#include "light/sphere_light.h"
#include "light/triangle_light.h"

namespace nacre {

inline SphereLight<float> ToFloat(const SphereLight<double>& light) {
  return {Vec3f(light.centre), static_cast<float>(light.radius)};
}
inline RectangleLight<float> ToFloat(const RectangleLight<double>& light) {
  return {Vec3f(light.corner), Vec3f(light.edge_x), Vec3f(light.edge_y)};
}
inline TriangleLight<float> ToFloat(const TriangleLight<double>& light) {
  return {Vec3f(light.corner), Vec3f(light.edge_x), Vec3f(light.edge_y)};
}
inline DiskLight<float> ToFloat(const DiskLight<double>& light) {
  return {Vec3f(light.centre), Vec3f(light.normal), static_cast<float>(light.radius)};
}

inline SphereLight<double> ToDouble(const SphereLight<float>& light) {
  return {Vec3d(light.centre), light.radius};
}
inline RectangleLight<double> ToDouble(const RectangleLight<float>& light) {
  return {Vec3d(light.corner), Vec3d(light.edge_x), Vec3d(light.edge_y)};
}
inline TriangleLight<double> ToDouble(const TriangleLight<float>& light) {
  return {Vec3d(light.corner), Vec3d(light.edge_x), Vec3d(light.edge_y)};
}
inline DiskLight<double> ToDouble(const DiskLight<float>& light) {
  return {Vec3d(light.centre), Vec3d(light.normal), light.radius};
}

}  // namespace nacre
