// SPDX-License-Identifier: Apache-2.0
// visibility/refine_kernel.cc: repeats the exact test of each hit to get its point and normal in
// double.
#include "visibility/refine_kernel.h"

#include <algorithm>
#include <tuple>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "visibility/refine_kernel.cc"
#include "hwy/foreach_target.h"

#include "base/target_ops-inl.h"
#include "base/vec3-inl.h"
#include "hit/shading_normal-inl.h"
#include "visibility/projected_sphere_test-inl.h"
#include "visibility/sphere_test-inl.h"
#include "visibility/triangle_test-inl.h"

HWY_BEFORE_NAMESPACE();
namespace nacre::HWY_NAMESPACE {
namespace {
namespace hn = hwy::HWY_NAMESPACE;

using D = hn::ScalableTag<double>;
using V = hn::Vec<D>;

// The number of hits that are gathered before any is computed: loading a vector right after its
// lanes were stored one by one would stall.
constexpr size_t kBlock = 4 * kBatchPadding;

struct alignas(64) Block3 {
  double xyz[3][kBlock];

  void Set(size_t i, const Vec3d& v) {
    for (int c = 0; c < 3; ++c) xyz[c][i] = v[c];
  }
  Vec3V<V> Load(size_t i) const { return Load3(D(), xyz, i); }
};

// The primitives of a block of hits. Entries of triangles also hold stale spheres, and entries of
// spheres stale triangles; results that are computed from these are not used.
struct Gathered {
  Block3 origin, direction;
  Block3 center = {};
  alignas(64) double radius[kBlock] = {};
  alignas(64) double is_start[kBlock] = {};      // 1: the ray starts on this sphere; else 0
  alignas(64) double is_projected[kBlock] = {};  // 1 or 0
  Block3 projected_center = {}, projected_error = {};
  alignas(64) double projected_scale[kBlock] = {};
  Block3 corner[3] = {}, corner_normal[3] = {};
  alignas(64) double is_triangle[kBlock];           // 1 or 0
  bool any_projected = false, any_general = false;  // spheres, by the test that they use
  bool any_triangle = false;
};

struct RefinedHit {
  Vec3V<V> position;
  Vec3V<V> normal;   // unit, on the ray's side
  Vec3V<V> to_view;  // unit, above the normal's horizon
};

// A vector of rays, with derived terms.
struct RefineRays {
  Vec3V<V> origin, direction;
  V dd, inverse_dd, inverse_length;  // |direction|^2, its reciprocal, 1 / |direction|
  Vec3V<V> to_view;
};

HWY_INLINE Vec3V<V> RefineProjectedNormal(const Gathered& in, size_t i, const RefineRays& rays) {
  const D d;
  const ProjectedSphereV<V> sphere{in.projected_center.Load(i), in.projected_error.Load(i),
                                   hn::Load(d, in.projected_scale + i)};
  const auto hit = TestProjected(d, sphere, Negated(rays.direction), rays.dd);
  return ProjectedNormal(hit.offset, BackToHit(hn::Sqrt(hit.discriminant), hit.back), rays.to_view,
                         rays.inverse_length);
}

HWY_INLINE RefinedHit RefineSphere(const Gathered& in, size_t i, const RefineRays& rays) {
  const D d;
  const Vec3V<V> center = in.center.Load(i);
  const V radius = hn::Load(d, in.radius + i);
  V signed_radius = radius;
  Vec3V<V> normal;
  if (in.any_general) {
    const auto hit =
        TestSphere(d, Sub(center, rays.origin), rays.direction, rays.inverse_dd, radius);
    // A ray that starts on the sphere hits its far side, whatever the rounding of its origin.
    const auto is_start = hn::Gt(hn::Load(d, in.is_start + i), hn::Zero(d));
    const auto inside = hn::Or(hit.inside, is_start);
    const V root = hn::IfThenElse(inside, hit.root, hn::Neg(hit.root));
    signed_radius = SignedRadius(radius, root);
    normal = SphereNormal(d, ScaledCenterToHit(rays.direction, root, hit.moment), rays.dd,
                          signed_radius);
  }
  if (in.any_projected) {
    const Vec3V<V> projected_normal = RefineProjectedNormal(in, i, rays);
    const auto projected = hn::Gt(hn::Load(d, in.is_projected + i), hn::Zero(d));
    signed_radius = hn::IfThenElse(projected, radius, signed_radius);
    normal = in.any_general ? Select(projected, projected_normal, normal) : projected_normal;
  }
  return {SpherePosition(center, normal, signed_radius), normal, rays.to_view};
}

HWY_INLINE Vec3V<V> Interpolate(const Block3 (&corner)[3], size_t i, const Vec3V<V>& weights) {
  return Add(Add(Scale(corner[0].Load(i), weights.x), Scale(corner[1].Load(i), weights.y)),
             Scale(corner[2].Load(i), weights.z));
}

// Normalises v, after scaling it to about 1, so that squares of the products of very short edges do
// not become denormal.
HWY_INLINE Vec3V<V> ScaledAndNormalized(const Vec3V<V>& v) {
  const D d;
  const V largest = hn::Max(hn::Max(hn::Abs(v.x), hn::Abs(v.y)), hn::Abs(v.z));
  const Vec3V<V> scaled = Scale(v, hn::Div(hn::Set(d, 1.0), largest));
  return Scale(scaled, hn::Div(hn::Set(d, 1.0), hn::Sqrt(Dot(scaled, scaled))));
}

HWY_INLINE RefinedHit RefineTriangle(const Gathered& in, size_t i, const RefineRays& rays) {
  const D d;
  const auto& [origin, direction] = std::tie(rays.origin, rays.direction);
  const V zero = hn::Zero(d);
  const Vec3V<V> a = in.corner[0].Load(i), b = in.corner[1].Load(i), c = in.corner[2].Load(i);
  const auto hit = TestTriangle(d, Sub(a, origin), Sub(b, origin), Sub(c, origin), direction,
                                rays.inverse_dd, MakeShear(d, direction));
  // The face normal on the ray's side, for either winding, and the shading normal on the same side.
  const Vec3V<V> face = Cross(Sub(b, a), Sub(c, a));
  const auto back = hn::Gt(Dot(face, direction), zero);
  const Vec3V<V> face_normal = Select(back, Sub(Vec3V<V>{zero, zero, zero}, face), face);
  const Vec3V<V> vertex_normal = Interpolate(in.corner_normal, i, hit.weights);
  const V side = Dot(vertex_normal, face_normal);
  const Vec3V<V> facing = Scale(vertex_normal, hn::CopySign(hn::Set(d, 1.0), side));
  // The interpolated normal is 0 where the mesh has no normals, or where they cancel.
  const auto none = hn::Eq(SumOfAbs(vertex_normal), zero);
  const Vec3V<V> normal = ScaledAndNormalized(Select(none, face_normal, facing));
  const Vec3V<V> to_view = Select(none, rays.to_view, GrazingView(d, normal, rays.to_view));
  return {Interpolate(in.corner, i, hit.weights), normal, to_view};
}

HWY_INLINE void GatherTriangle(const TraceGeometry& geometry, uint32_t triangle, size_t i,
                               Gathered* to) {
  to->any_triangle = true;
  to->is_triangle[i] = 1;
  for (size_t corner = 0; corner < 3; ++corner) {
    const uint32_t vertex = geometry.triangles[triangle][corner];
    to->corner[corner].Set(i, geometry.positions[vertex]);
    to->corner_normal[corner].Set(i,
                                  geometry.normals.empty() ? Vec3d(0) : geometry.normals[vertex]);
  }
}

// Whether the ray starts on the sphere, or on one that coincides with it.
HWY_INLINE bool IsStart(const TraceGeometry& geometry, const RayBatch& rays, uint32_t ray,
                        const TraceSphere& sphere) {
  if (!rays.from_surfaces || rays.start[ray] >= geometry.SphereCount()) return false;
  return Coincide(geometry.spheres[rays.start[ray]], sphere);
}

HWY_INLINE void GatherSphere(const TraceSphere& sphere, const ProjectedTestView& view, size_t i,
                             Gathered* to) {
  to->is_triangle[i] = 0;
  to->center.Set(i, sphere.center);
  to->radius[i] = sphere.radius;
  const bool projected = UsesProjectedTest(sphere, view);
  to->is_projected[i] = projected ? 1 : 0;
  (projected ? to->any_projected : to->any_general) = true;
  if (!projected) return;
  const ProjectedSphere projection = MakeProjectedSphere(sphere, view.forward);
  to->projected_center.Set(i, projection.center);
  to->projected_error.Set(i, projection.rounding_error);
  to->projected_scale[i] = projection.scale;
}

// Gathers `size` hits from `first` on. Entries behind the last hit repeat it.
HWY_INLINE void Gather(const RefineRequest& request, size_t first, size_t size, Gathered* to,
                       HitBatch* hits) {
  const TraceGeometry& geometry = request.geometry;
  const auto& [origin, direction] = std::tie(request.rays.origin, request.rays.direction);
  const uint32_t sphere_count = geometry.SphereCount();
  to->any_projected = to->any_general = to->any_triangle = false;
  for (size_t i = 0; i < size; ++i) {
    const uint32_t ray = request.ray_indices[std::min(first + i, request.count - 1)];
    const uint32_t primitive = request.closest.primitive[ray];
    to->origin.Set(i, Vec3d(origin.x[ray], origin.y[ray], origin.z[ray]));
    to->direction.Set(i, Vec3d(direction.x[ray], direction.y[ray], direction.z[ray]));
    hits->ray[first + i] = ray;
    hits->primitive[first + i] = primitive;
    if (primitive < sphere_count) {
      const TraceSphere& sphere = geometry.spheres[primitive];
      GatherSphere(sphere, request.rays.view, i, to);
      to->is_start[i] = IsStart(geometry, request.rays, ray, sphere) ? 1 : 0;
    } else {
      GatherTriangle(geometry, primitive - sphere_count, i, to);
    }
  }
}

HWY_INLINE void StoreSurfaces(const RefinedHit& surface, size_t first, const HitOutput& to) {
  const D d;
  const hn::Rebind<float, D> df;
  HitBatch& hits = *to.hits;
  HitDirections& rounded = *to.directions;
  const auto store = [&](const auto& tag, const auto& v, auto& soa) HWY_ATTR {
    Store3(v, tag, soa.x.data() + first, soa.y.data() + first, soa.z.data() + first);
  };
  if (to.positions) store(d, surface.position, hits.position);
  store(df, Demote3(d, surface.normal), rounded.normal);
  store(df, Demote3(d, surface.to_view), rounded.to_view);
  if (!to.exact_directions) return;
  store(d, surface.normal, hits.normal);
  store(d, surface.to_view, hits.to_view);
}

// Computes the vector of hits that was gathered at i, and stores it at hits[first].
HWY_INLINE void RefineVector(const Gathered& in, size_t i, size_t first, const HitOutput& to) {
  const D d;
  RefineRays rays;
  rays.origin = in.origin.Load(i);
  rays.direction = in.direction.Load(i);
  rays.dd = FusedDot(rays.direction, rays.direction);
  rays.inverse_dd = hn::Div(hn::Set(d, 1.0), rays.dd);
  rays.inverse_length = InverseLength(d, rays.dd);
  rays.to_view = Scale(rays.direction, hn::Neg(rays.inverse_length));
  if (!in.any_triangle) {
    StoreSurfaces(RefineSphere(in, i, rays), first, to);
  } else if (!in.any_projected && !in.any_general) {
    StoreSurfaces(RefineTriangle(in, i, rays), first, to);
  } else {
    const RefinedHit sphere = RefineSphere(in, i, rays);
    const RefinedHit triangle = RefineTriangle(in, i, rays);
    const auto is_triangle = hn::Gt(hn::Load(d, in.is_triangle + i), hn::Zero(d));
    StoreSurfaces({Select(is_triangle, triangle.position, sphere.position),
                   Select(is_triangle, triangle.normal, sphere.normal),
                   Select(is_triangle, triangle.to_view, sphere.to_view)},
                  first, to);
  }
}

void Refine(const RefineRequest& request, const HitOutput& to) {
  Gathered in;
  to.hits->count = request.count;
  to.hits->one_primitive = false;
  const size_t padded = RoundUp(request.count, kBatchPadding);
  for (size_t first = 0; first < padded; first += kBlock) {
    const size_t size = std::min(kBlock, padded - first);
    Gather(request, first, size, &in, to.hits);
    for (size_t i = 0; i < size; i += hn::Lanes(D())) RefineVector(in, i, first + i, to);
  }
}

double Depth(const TraceSphere& sphere, const Vec3d& origin, const Vec3d& direction,
             const ProjectedTestView& view) {
  const D d;
  const Vec3V<V> along = SetVec3(d, direction);
  if (UsesProjectedTest(sphere, view)) {
    return hn::GetLane(
        TestProjectedDepth(d, MakeProjectedSphere(sphere, view.forward), sphere, along).t);
  }
  const V inverse_dd = hn::Div(hn::Set(d, 1.0), FusedDot(along, along));
  const auto hit = TestSphere(d, SetVec3(d, sphere.center - origin), along, inverse_dd,
                              hn::Set(d, sphere.radius));
  return hn::GetLane(hit.t);
}

Products ProductsHere() { return HWY_NATIVE_FMA ? Products::kFused : Products::kRounded; }

}  // namespace
}  // namespace nacre::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace nacre {
HWY_EXPORT(Refine);
HWY_EXPORT(Depth);
HWY_EXPORT(ProductsHere);

void RefineHits(const RefineRequest& request, const HitOutput& to) {
  HWY_DYNAMIC_DISPATCH(Refine)(request, to);
}

double DepthOn(const TraceSphere& sphere, const RayBatch& rays, size_t ray) {
  const auto at = [&](const Soa3<double>& soa) {
    return Vec3d(soa.x[ray], soa.y[ray], soa.z[ray]);
  };
  return HWY_DYNAMIC_DISPATCH(Depth)(sphere, at(rays.origin), at(rays.direction), rays.view);
}

Products TargetProducts() { return HWY_DYNAMIC_DISPATCH(ProductsHere)(); }
}  // namespace nacre
#endif
