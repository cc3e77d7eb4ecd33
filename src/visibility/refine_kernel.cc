// visibility/refine_kernel.cc: repeats the exact test for each hit, which gives its point and its
// normal in double.
#include "visibility/refine_kernel.h"

#include <algorithm>
#include <tuple>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "visibility/refine_kernel.cc"
#include "hwy/foreach_target.h"

#include "visibility/sphere_test-inl.h"
#include "visibility/triangle_test-inl.h"

HWY_BEFORE_NAMESPACE();
namespace nacre {
namespace HWY_NAMESPACE {
namespace {
namespace hn = hwy::HWY_NAMESPACE;

using D = hn::ScalableTag<double>;
using V = hn::Vec<D>;

// Hits that are gathered before any is computed: loading vectors from what was just stored by
// scalars stalls.
constexpr size_t kBlock = 4 * kBatchPadding;

struct alignas(64) Block3 {
  double x[kBlock], y[kBlock], z[kBlock];

  void Set(size_t i, const Vec3d& v) {
    x[i] = v.x;
    y[i] = v.y;
    z[i] = v.z;
  }
  Vec3V<V> Load(size_t i) const { return Load3(D(), x + i, y + i, z + i); }
};

// Entries with a triangle hold some earlier sphere too, or none, and those with a sphere some
// triangle: what is computed from either is not used.
struct Gathered {
  Block3 origin, direction;
  Block3 center = {};
  alignas(64) double radius[kBlock] = {};
  Block3 corner[3] = {}, corner_normal[3] = {};
  alignas(64) double is_triangle[kBlock];  // 1 or 0
  bool any_sphere = false, any_triangle = false;
};

struct SurfaceV {
  Vec3V<V> position;
  Vec3V<V> normal;
};

HWY_INLINE SurfaceV RefineSphere(const Gathered& in, size_t i, const Vec3V<V>& origin,
                                 const Vec3V<V>& direction, V inverse_dd) {
  const D d;
  const Vec3V<V> center = in.center.Load(i);
  const V radius = hn::Load(d, in.radius + i);
  const auto hit = TestSphere(d, Sub(center, origin), direction, inverse_dd, radius);
  const Vec3V<V> from_center = CenterToHit(d, hit, direction);
  const V inverse_radius = hn::Div(hn::Set(d, 1.0), radius);
  const V inward = hn::IfThenElse(hit.inside, hn::Neg(inverse_radius), inverse_radius);
  return {Add(center, from_center), Scale(from_center, inward)};
}

HWY_INLINE Vec3V<V> Cross(const Vec3V<V>& a, const Vec3V<V>& b) {
  return {hn::Sub(hn::Mul(a.y, b.z), hn::Mul(a.z, b.y)),
          hn::Sub(hn::Mul(a.z, b.x), hn::Mul(a.x, b.z)),
          hn::Sub(hn::Mul(a.x, b.y), hn::Mul(a.y, b.x))};
}

HWY_INLINE Vec3V<V> Interpolate(const Block3 (&corner)[3], size_t i, const Vec3V<V>& weights) {
  return Add(Add(Scale(corner[0].Load(i), weights.x), Scale(corner[1].Load(i), weights.y)),
             Scale(corner[2].Load(i), weights.z));
}

HWY_INLINE Vec3V<V> Normalized(const Vec3V<V>& v) {
  const D d;
  // Brought near 1 first, so that the squares of the smallest edges' products stay normal numbers.
  const V largest = hn::Max(hn::Max(hn::Abs(v.x), hn::Abs(v.y)), hn::Abs(v.z));
  const Vec3V<V> scaled = Scale(v, hn::Div(hn::Set(d, 1.0), largest));
  return Scale(scaled, hn::Div(hn::Set(d, 1.0), hn::Sqrt(Dot(scaled, scaled))));
}

HWY_INLINE SurfaceV RefineTriangle(const Gathered& in, size_t i, const Vec3V<V>& origin,
                                   const Vec3V<V>& direction, V inverse_dd) {
  const D d;
  const V zero = hn::Zero(d);
  const Vec3V<V> a = in.corner[0].Load(i), b = in.corner[1].Load(i), c = in.corner[2].Load(i);
  const auto hit = TestTriangle(d, Sub(a, origin), Sub(b, origin), Sub(c, origin), direction,
                                inverse_dd, MakeShear(d, direction));
  // The face normal on the ray's side, whatever the winding; then the shading normal on its side.
  const Vec3V<V> face = Cross(Sub(b, a), Sub(c, a));
  const auto back = hn::Gt(Dot(face, direction), zero);
  const Vec3V<V> face_normal = Select(back, Sub(Vec3V<V>{zero, zero, zero}, face), face);
  const Vec3V<V> vertex_normal = Interpolate(in.corner_normal, i, hit.weights);
  const V side = Dot(vertex_normal, face_normal);
  const Vec3V<V> facing = Scale(vertex_normal, hn::CopySign(hn::Set(d, 1.0), side));
  // 0 where the mesh has no normals, or where they cancel.
  const auto none = hn::Eq(SumOfAbs(vertex_normal), zero);
  return {Interpolate(in.corner, i, hit.weights), Normalized(Select(none, face_normal, facing))};
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

HWY_INLINE void GatherSphere(const TraceSphere& sphere, size_t i, Gathered* to) {
  to->any_sphere = true;
  to->is_triangle[i] = 0;
  to->center.Set(i, sphere.center);
  to->radius[i] = sphere.radius;
}

// Gathers `size` hits from `first` on; past the last one, the last one again.
HWY_INLINE void Gather(const RefineRequest& request, size_t first, size_t size, Gathered* to,
                       HitBatch* hits) {
  const TraceGeometry& geometry = request.geometry;
  const auto& [origin, direction] = std::tie(request.rays.origin, request.rays.direction);
  const uint32_t sphere_count = geometry.SphereCount();
  to->any_sphere = to->any_triangle = false;
  for (size_t i = 0; i < size; ++i) {
    const uint32_t ray = request.ray_indices[std::min(first + i, request.count - 1)];
    const uint32_t primitive = request.closest.primitive[ray];
    to->origin.Set(i, Vec3d(origin.x[ray], origin.y[ray], origin.z[ray]));
    to->direction.Set(i, Vec3d(direction.x[ray], direction.y[ray], direction.z[ray]));
    hits->ray[first + i] = ray;
    hits->primitive[first + i] = primitive;
    if (primitive < sphere_count) {
      GatherSphere(geometry.spheres[primitive], i, to);
      hits->object[first + i] = primitive;
    } else {
      GatherTriangle(geometry, primitive - sphere_count, i, to);
      hits->object[first + i] = sphere_count + geometry.MeshOf(primitive - sphere_count);
    }
  }
}

HWY_INLINE void StoreSurface(const SurfaceV& surface, size_t first, HitBatch* hits) {
  Store3(surface.position, D(), hits->position.x.data() + first, hits->position.y.data() + first,
         hits->position.z.data() + first);
  Store3(surface.normal, D(), hits->normal.x.data() + first, hits->normal.y.data() + first,
         hits->normal.z.data() + first);
}

// The vector of hits gathered at i, to be stored at hits[to].
HWY_INLINE void RefineVector(const Gathered& in, size_t i, size_t to, HitBatch* hits) {
  const D d;
  const Vec3V<V> origin = in.origin.Load(i), direction = in.direction.Load(i);
  const V inverse_dd = hn::Div(hn::Set(d, 1.0), Dot(direction, direction));
  const Vec3V<V> to_view = Scale(direction, hn::Neg(hn::Sqrt(inverse_dd)));
  Store3(to_view, d, hits->to_view.x.data() + to, hits->to_view.y.data() + to,
         hits->to_view.z.data() + to);
  if (!in.any_triangle) {
    StoreSurface(RefineSphere(in, i, origin, direction, inverse_dd), to, hits);
  } else if (!in.any_sphere) {
    StoreSurface(RefineTriangle(in, i, origin, direction, inverse_dd), to, hits);
  } else {
    const SurfaceV sphere = RefineSphere(in, i, origin, direction, inverse_dd);
    const SurfaceV triangle = RefineTriangle(in, i, origin, direction, inverse_dd);
    const auto is_triangle = hn::Gt(hn::Load(d, in.is_triangle + i), hn::Zero(d));
    StoreSurface({Select(is_triangle, triangle.position, sphere.position),
                  Select(is_triangle, triangle.normal, sphere.normal)},
                 to, hits);
  }
}

void Refine(const RefineRequest& request, HitBatch* hits) {
  Gathered in;
  hits->count = request.count;
  const size_t padded = RoundUp(request.count, kBatchPadding);
  for (size_t first = 0; first < padded; first += kBlock) {
    const size_t size = std::min(kBlock, padded - first);
    Gather(request, first, size, &in, hits);
    for (size_t i = 0; i < size; i += hn::Lanes(D())) RefineVector(in, i, first + i, hits);
  }
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace nacre
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace nacre {
HWY_EXPORT(Refine);

void RefineHits(const RefineRequest& request, HitBatch* hits) {
  HWY_DYNAMIC_DISPATCH(Refine)(request, hits);
}
}  // namespace nacre
#endif
