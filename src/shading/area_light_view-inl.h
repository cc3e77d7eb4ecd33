// SPDX-License-Identifier: Apache-2.0
// shading/area_light_view-inl.h: area lights relative to the hits of a batch: code that the kernels
// of area and of mesh lights share.
#if defined(NACRE_SHADING_AREA_LIGHT_VIEW_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef NACRE_SHADING_AREA_LIGHT_VIEW_INL_H_
#undef NACRE_SHADING_AREA_LIGHT_VIEW_INL_H_
#else
#define NACRE_SHADING_AREA_LIGHT_VIEW_INL_H_
#endif

#include <cmath>

#include "base/target_ops-inl.h"
#include "base/vec3-inl.h"
#include "light/disk_light-inl.h"
#include "light/mesh_outline-inl.h"
#include "light/polygon_irradiance-inl.h"
#include "light/sphere_light-inl.h"
#include "shading/sampled_light.h"
#include "shading/soa-inl.h"

HWY_BEFORE_NAMESPACE();
namespace nacre {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using AreaLightTag = hn::ScalableTag<float>;
using AreaLightV = hn::Vec<AreaLightTag>;

// The offset from hits i... to a point of the light, computed in double and rounded.
HWY_INLINE Vec3V<AreaLightV> Offset(const SampledLight& light, const HitBatch& hits,
                                    const Vec3d& point, size_t i) {
  const AreaLightTag d;
  const Vec3d place = light.place + point;
  return {SubtractAndRound(d, place.x, hits.position.x.data() + i),
          SubtractAndRound(d, place.y, hits.position.y.data() + i),
          SubtractAndRound(d, place.z, hits.position.z.data() + i)};
}

HWY_INLINE Vec3V<AreaLightV> Offset(const SampledLight& light, const HitBatch& hits, size_t i) {
  return Offset(light, hits, Vec3d(0), i);
}

HWY_INLINE TriangleLightV<AreaLightV> TriangleFrom(const SampledLight& light, const HitBatch& hits,
                                                   size_t triangle, size_t i) {
  const TriangleLight<double>& t = light.mesh->triangles[triangle];
  return {Offset(light, hits, t.corner, i), SetVec3(AreaLightTag(), t.edge_x),
          SetVec3(AreaLightTag(), t.edge_y)};
}

// A power of two by which products of two edges of a mesh are multiplied, so that they stay in the
// range of float: the square of a mesh's size may be 1e-30, and the height of a face over the
// point, which is computed from such a product, is of the order of the cube.
inline double ByArea(const SampledLight& light) {
  return std::ldexp(1.0, -2 * std::ilogb(light.radius));
}

// The faces of a mesh with an outline, in the form that Irradiance of mesh_outline-inl.h takes.
struct EmittingFaces {
  AreaLightV shines[kMaxClosedFormTriangles];
  AreaLightV orientation;
};

HWY_INLINE void FindFaces(const SampledLight& light, const HitBatch& hits, size_t i,
                          EmittingFaces* faces) {
  const AreaLightTag d;
  const AreaLightV zero = hn::Zero(d), one = hn::Set(d, 1.0f);
  const MeshOutline& outline = light.mesh->outline;
  const double by_area = ByArea(light);
  faces->orientation = hn::Set(d, -1.0f);
  for (size_t k = 0; k < outline.faces.size(); ++k) {
    const OutlineFace& face = outline.faces[k];
    const Vec3V<AreaLightV> offset = Offset(light, hits, outline.corners[face.corner], i);
    const AreaLightV height = FusedDot(offset, SetVec3(AreaLightTag(), face.cross * by_area));
    faces->shines[k] = light.two_sided ? one : hn::IfThenElseZero(hn::Lt(height, zero), one);
    if (light.two_sided) faces->orientation = height;
  }
}

// The irradiance by the outline of a mesh, after map(offset) has been applied to all offsets from
// hits i...
template <class Map>
HWY_INLINE AreaLightV OutlineIrradiance(const SampledLight& light, const HitBatch& hits, size_t i,
                                        const EmittingFaces& faces, const Vec3V<AreaLightV>& normal,
                                        const Map& map) {
  const AreaLightTag d;
  const MeshOutline& outline = light.mesh->outline;
  OutlineCornersV<AreaLightV> seen;
  // All lengths are scaled as ScaleToUnit scales other lights.
  const Vec3V<AreaLightV> first = map(Offset(light, hits, outline.corners[0], i));
  const AreaLightV size = hn::Set(d, static_cast<float>(light.radius));
  const AreaLightV unit = PowerOfTwo(d, hn::Max(LargestComponent(first), size)).inverse;
  seen.first = Scale(first, unit);
  for (size_t k = 0; k < outline.corners.size(); ++k) {
    seen.offset[k] =
        Scale(map(SetVec3(AreaLightTag(), outline.corners[k] - outline.corners[0])), unit);
    seen.unit_offset[k] = UnitDifference(d, seen.first, seen.offset[k]);
  }
  return Irradiance(d, outline, seen, faces.shines, faces.orientation, normal);
}

}  // namespace HWY_NAMESPACE
}  // namespace nacre
HWY_AFTER_NAMESPACE();
#endif
