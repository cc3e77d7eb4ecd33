// SPDX-License-Identifier: Apache-2.0
// shading/coordinates_kernel.cc: texture coordinates of hits, their gradients, and their change
// from pixel to pixel, all analytic, so that they depend neither on seams nor on neighbouring hits.
#include <algorithm>

#include "scene/texture_mapping.h"
#include "shading/texture_kernels.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "shading/coordinates_kernel.cc"
#include "hwy/foreach_target.h"

#include "hwy/highway.h"

#include "base/basis-inl.h"
#include "base/vec3-inl.h"
#include "shading/soa-inl.h"
#include "texture/mapping-inl.h"

HWY_BEFORE_NAMESPACE();
namespace nacre {
namespace HWY_NAMESPACE {
namespace {
namespace hn = hwy::HWY_NAMESPACE;

using D = hn::ScalableTag<double>;
using V = hn::Vec<D>;
using F = hn::Rebind<float, D>;

// a x + b y.
HWY_INLINE Vec3V<V> Combine(V a, const Vec3V<V>& x, V b, const Vec3V<V>& y) {
  return {hn::MulAdd(a, x.x, hn::Mul(b, y.x)), hn::MulAdd(a, x.y, hn::Mul(b, y.y)),
          hn::MulAdd(a, x.z, hn::Mul(b, y.z))};
}

// The offset to the point where the ray through the next pixel, `step` away on the film, meets the
// tangent plane: the ray differentials of Igehy 1999. `along` is the direction of the rays, and
// `scaled` the normal divided by its dot product with `along`.
HWY_INLINE Vec3V<V> NextPixel(const Vec3V<V>& step, const Vec3V<V>& along, const Vec3V<V>& scaled) {
  const V back = FusedDot(step, scaled);
  return {hn::NegMulAdd(along.x, back, step.x), hn::NegMulAdd(along.y, back, step.y),
          hn::NegMulAdd(along.z, back, step.z)};
}

// Stores the steps from pixel to pixel at a packet of hits. `step_x` and `step_y` are those of the
// rays, along which they are projected to the surface.
HWY_INLINE void StoreSteps(const Vec3V<V>& step_x, const Vec3V<V>& step_y, const Vec3V<V>& along,
                           size_t i, HitParameters* t) {
  const D d;
  const Vec3V<V> normal = LoadSoa(d, t->geometric, i);
  const Vec3V<V> scaled = Scale(normal, hn::Div(hn::Set(d, 1.0), FusedDot(along, normal)));
  StoreSoa(d, NextPixel(step_x, along, scaled), i, &t->dp_dx);
  StoreSoa(d, NextPixel(step_y, along, scaled), i, &t->dp_dy);
}

void FindCameraSteps(const TexturedRun& run, const CameraFrame& camera) {
  const D d;
  const bool perspective = camera.projection == Projection::kPerspective;
  const Vec3V<V> forward = SetVec3(d, camera.forward);
  const Vec3V<V> step_x = SetVec3(d, camera.step_x * run.scene.footprint);
  const Vec3V<V> step_y = SetVec3(d, camera.step_y * run.scene.footprint);
  for (size_t i = run.begin; i < run.end; i += hn::Lanes(d)) {
    const Vec3V<V> position = LoadSoa(d, run.hits.position, i);
    // In perspective, steps grow with the depth, because the film's rays have a dot product of 1
    // with `forward`.
    const V depth = perspective ? FusedDot(position, forward) : hn::Set(d, 1.0);
    StoreSteps(Scale(step_x, depth), Scale(step_y, depth), perspective ? position : forward, i,
               &run.textures);
  }
}

// The cross-section of a cone is a disk. Of its diameters, the one in the plane of incidence
// projects to the longest on the surface, and the one across it to the shortest, so that footprints
// do not depend on a choice of axes.
void FindConeSteps(const TexturedRun& run, const double* cone_diameter) {
  const D d;
  for (size_t i = run.begin; i < run.end; i += hn::Lanes(d)) {
    const Vec3V<V> to_view = LoadSoa(d, run.hits.to_view, i);
    const Vec3V<V> normal = LoadSoa(d, run.textures.geometric, i);
    const Vec3V<V> leaning = Sub(normal, Scale(to_view, FusedDot(normal, to_view)));
    const V length = hn::Sqrt(FusedDot(leaning, leaning));
    // From straight above, any axes will do.
    const auto leans = hn::Gt(length, hn::Set(d, 1e-8));
    const Vec3V<V> axis =
        Select(leans, Scale(leaning, hn::Div(hn::Set(d, 1.0), length)), BasisAbout(d, to_view).x);
    const V diameter = hn::Mul(hn::LoadU(d, cone_diameter + i), hn::Set(d, run.scene.footprint));
    StoreSteps(Scale(axis, diameter), Scale(FusedCross(to_view, axis), diameter), to_view, i,
               &run.textures);
  }
}

// Sets HitParameters::point at hits on meshes, in the units of the mapping. FindPoints has set it
// on spheres.
void PlaceMeshPoints(const TexturedRun& run, const PreparedTexture& texture) {
  const HitBatch& hits = run.hits;
  HitParameters* const t = &run.textures;
  const auto sphere_count = static_cast<uint32_t>(run.scene.scene->spheres.size());
  for (size_t i = run.begin; i < run.end; ++i) {
    if (hits.primitive[i] < sphere_count) continue;
    SetVector((VectorAt(hits.position, i) - texture.center) * texture.inverse_size, i, &t->point);
    t->inverse_size[i] = texture.inverse_size;
  }
}

// Whether the coordinates at hit i are those of a mesh. Only ShapeCoordinates, which have no image,
// may be asked for on meshes without any.
bool HasMeshCoordinates(const TexturedRun& run, const PreparedTexture& texture, size_t i) {
  const uint32_t primitive = run.hits.primitive[i];
  if (i >= run.end || IsSphere(run.scene.primitives, primitive)) return false;
  return texture.image != nullptr || !TriangleOf(run.scene.primitives, primitive).mesh->uvs.empty();
}

void MapRun(const TexturedRun& run, const PreparedTexture& texture) {
  const D d;
  HitParameters* const t = &run.textures;
  const Vec3V<V> fx = SetVec3(d, texture.frame[0]), fy = SetVec3(d, texture.frame[1]);
  const Vec3V<V> fz = SetVec3(d, texture.frame[2]);
  for (size_t i = run.begin; i < run.end; i += hn::Lanes(d)) {
    const Vec3V<V> point = LoadSoa(d, t->point, i);
    const Vec3V<V> local{FusedDot(point, fx), FusedDot(point, fy), FusedDot(point, fz)};
    MappedV<V> mapped = MapPoint(d, texture.mapping, local);
    const V scale = hn::LoadU(d, t->inverse_size.data() + i);
    const auto to_world = [&](const Vec3V<V>& g) HWY_ATTR {
      return Scale(Add(Combine(g.x, fx, g.y, fy), Scale(fz, g.z)), scale);
    };
    hn::StoreU(mapped.u, d, t->u.data() + i);
    hn::StoreU(mapped.v, d, t->v.data() + i);
    StoreSoa(d, to_world(mapped.du), i, &t->gradient_u);
    StoreSoa(d, to_world(mapped.dv), i, &t->gradient_v);
  }
}

// Makes v point up, applies the texture's own transform, and computes footprints. `upside_down`
// selects the hits whose v points down.
HWY_INLINE void TransformHit(const PreparedTexture& texture, hn::Mask<D> upside_down, size_t i,
                             HitParameters* t) {
  const D d;
  const F f;
  const V one = hn::Set(d, 1.0);
  const V u = hn::LoadU(d, t->u.data() + i), down = hn::LoadU(d, t->v.data() + i);
  const V v = hn::IfThenElse(upside_down, hn::Sub(one, down), down);
  const Vec3V<V> gu = LoadSoa(d, t->gradient_u, i), gd = LoadSoa(d, t->gradient_v, i);
  const Vec3V<V> gv = Scale(gd, hn::IfThenElse(upside_down, hn::Neg(one), one));
  const V uu = hn::Set(d, texture.u_row.x), uv = hn::Set(d, texture.u_row.y);
  const V vu = hn::Set(d, texture.v_row.x), vv = hn::Set(d, texture.v_row.y);
  hn::StoreU(hn::MulAdd(uu, u, hn::MulAdd(uv, v, hn::Set(d, texture.offset.x))), d,
             t->u.data() + i);
  hn::StoreU(hn::MulAdd(vu, u, hn::MulAdd(vv, v, hn::Set(d, texture.offset.y))), d,
             t->v.data() + i);
  const Vec3V<V> gradient_u = Combine(uu, gu, uv, gv), gradient_v = Combine(vu, gu, vv, gv);
  StoreSoa(d, gradient_u, i, &t->gradient_u);
  StoreSoa(d, gradient_v, i, &t->gradient_v);
  const Vec3V<V> dx = LoadSoa(d, t->dp_dx, i), dy = LoadSoa(d, t->dp_dy, i);
  const auto store = [&](V value, AlignedArray<float>* to)
                         HWY_ATTR { hn::StoreU(hn::DemoteTo(f, value), f, to->data() + i); };
  store(FusedDot(gradient_u, dx), &t->du_dx);
  store(FusedDot(gradient_v, dx), &t->dv_dx);
  store(FusedDot(gradient_u, dy), &t->du_dy);
  store(FusedDot(gradient_v, dy), &t->dv_dy);
}

void MakeCoordinatesT(const TexturedRun& run, const PreparedTexture& texture) {
  const D d;
  HitParameters* const t = &run.textures;
  const bool own = texture.mapping == MappingKind::kUv;
  const RayFootprints& rays = run.footprints;
  rays.camera != nullptr ? FindCameraSteps(run, *rays.camera)
                         : FindConeSteps(run, rays.cone_diameter);
  if (t->any_mesh && (!own || texture.image == nullptr)) PlaceMeshPoints(run, texture);
  MapRun(run, texture);  // at hits on meshes with their own (u, v), the result is not used
  if (t->any_mesh && own) FindMeshCoordinates(run, texture);
  const bool down = IsUpsideDown(texture.mapping);
  for (size_t i = run.begin; i < run.end; i += hn::Lanes(d)) {
    auto upside_down = hn::FirstN(d, down ? hn::Lanes(d) : 0);
    if (t->any_mesh && own) {
      alignas(64) double maps_points[8] = {};
      for (size_t k = 0; k < hn::Lanes(d); ++k) {
        maps_points[k] = HasMeshCoordinates(run, texture, i + k) ? 0 : 1;
      }
      upside_down = hn::Gt(hn::Load(d, maps_points), hn::Zero(d));
    }
    TransformHit(texture, upside_down, i, t);
  }
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace nacre
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace nacre {
HWY_EXPORT(MakeCoordinatesT);

void MakeCoordinates(const TexturedRun& run, const PreparedTexture& texture) {
  HWY_DYNAMIC_DISPATCH(MakeCoordinatesT)(run, texture);
}
}  // namespace nacre
#endif
