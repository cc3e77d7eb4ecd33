// SPDX-License-Identifier: Apache-2.0
// bench/float_visibility.cc: the kernels behind float_visibility.h.
#include "float_visibility.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "float_visibility.cc"
#include "hwy/foreach_target.h"

#include "hwy/highway.h"

#include "base/target_ops-inl.h"
#include "base/vec3-inl.h"
#include "visibility/packet-inl.h"

HWY_BEFORE_NAMESPACE();
namespace nacre {
namespace HWY_NAMESPACE {
namespace {
namespace hn = hwy::HWY_NAMESPACE;
using D = hn::ScalableTag<float>;
using V = hn::Vec<D>;

struct FloatRays {
  Vec3V<V> direction;
  V dd, inverse_dd;
};

HWY_INLINE FloatRays RaysOf(const Vec3V<V>& direction) {
  const V dd = FusedDot(direction, direction);
  return {direction, dd, Reciprocal(D(), dd)};
}

struct FloatHit {
  hn::Mask<D> hit;  // in front of the origin
  V t;
};

// The distance of the centre from the line by a cross product: the discriminant loses nothing but
// what float's coordinates have lost. kOutside: the rays start outside the sphere.
template <bool kOutside>
HWY_INLINE FloatHit TestFloat(const FloatSphere& sphere, const FloatRays& rays) {
  const D d;
  const V zero = hn::Zero(d);
  const Vec3V<V> center{hn::Set(d, sphere.center[0]), hn::Set(d, sphere.center[1]),
                        hn::Set(d, sphere.center[2])};
  const Vec3V<V> cross = FusedCross(center, rays.direction);
  const V along = FusedDot(center, rays.direction);
  const V discriminant = hn::MulSub(hn::Set(d, sphere.radius2), rays.dd, FusedDot(cross, cross));
  const V root = SquareRoot(d, hn::Max(discriminant, hn::Set(d, 1e-30f)));
  const auto met = hn::Ge(discriminant, zero);
  const V near = hn::Sub(along, root);
  if constexpr (kOutside) {
    return {hn::And(met, hn::Gt(along, zero)), hn::Mul(near, rays.inverse_dd)};
  }
  const V ahead = hn::IfThenElse(hn::Gt(near, zero), near, hn::Add(along, root));
  return {hn::And(met, hn::Gt(ahead, zero)), hn::Mul(ahead, rays.inverse_dd)};
}

// The rays of one row of pixels.
struct FloatRow {
  Vec3f first, step;   // directions: through the middle of the tile's first pixel; per pixel
  uint32_t pixel_row;  // of the cells, as a bit
};

HWY_INLINE FloatRays RaysAt(const FloatRow& row, int x) {
  const D d;
  const V column = hn::Iota(d, static_cast<float>(x));
  return RaysOf({hn::MulAdd(column, hn::Set(d, row.step.x), hn::Set(d, row.first.x)),
                 hn::MulAdd(column, hn::Set(d, row.step.y), hn::Set(d, row.first.y)),
                 hn::MulAdd(column, hn::Set(d, row.step.z), hn::Set(d, row.first.z))});
}

HWY_INLINE void StoreHits(hn::Mask<D> hit, V t, hn::Vec<hn::RebindToUnsigned<D>> sphere,
                          size_t place, FloatHits* hits) {
  const D d;
  const hn::RebindToUnsigned<D> du;
  hn::StoreU(t, d, hits->t.data() + place);
  hn::StoreU(hn::IfThenElse(hn::RebindMask(du, hit), sphere, hn::Set(du, kNoPrimitive)), du,
             hits->sphere.data() + place);
}

// The nearest of all spheres of the cells that the pixels from x on lie in; nearest first, so what
// lies beyond all lanes' hits ends a cell.
HWY_INLINE void TraceCells(const std::vector<FloatSphere>& spheres,
                           const TileCandidates& candidates, const FloatRow& row, int x, int x_end,
                           size_t place, FloatHits* hits) {
  const D d;
  const hn::RebindToUnsigned<D> du;
  const FloatRays rays = RaysAt(row, x);
  const V length = hn::Mul(rays.dd, ReciprocalSqrt(d, rays.dd));
  const int last = std::min(x + static_cast<int>(hn::Lanes(d)), x_end) - 1;
  V t = hn::Set(d, std::numeric_limits<float>::infinity());
  auto nearest = hn::Set(du, kNoPrimitive);
  for (int cell = x / kCellSize; cell <= last / kCellSize; ++cell) {
    for (const TileCandidate& candidate : candidates.cells[static_cast<size_t>(cell)]) {
      if (hn::AllTrue(d, hn::Lt(hn::Mul(t, length), hn::Set(d, candidate.near)))) break;
      if ((candidate.pixel_rows & row.pixel_row) == 0) continue;
      const FloatHit found = TestFloat<false>(spheres[candidate.primitive], rays);
      const auto nearer = hn::And(found.hit, hn::Lt(found.t, t));
      t = hn::IfThenElse(nearer, found.t, t);
      nearest =
          hn::IfThenElse(hn::RebindMask(du, nearer), hn::Set(du, candidate.primitive), nearest);
    }
  }
  StoreHits(hn::Lt(t, hn::Set(d, std::numeric_limits<float>::infinity())), t, nearest, place, hits);
}

void TraceFloatTileT(const CameraFrame& frame, const std::vector<FloatSphere>& spheres,
                     const TileCandidates& candidates, FloatHits* hits) {
  const D d;
  const hn::RebindToUnsigned<D> du;
  const int step = static_cast<int>(hn::Lanes(d));
  const auto width = static_cast<uint32_t>(candidates.tile.width());
  const Vec3d corner = frame.corner + frame.step_x * (candidates.tile.x0 + 0.5);
  FloatRow row{{0, 0, 0}, Vec3f(frame.step_x), 0};
  int y = -1;
  uint32_t row_end = 0;
  for (const PixelSpan& span : candidates.spans) {  // row by row
    if (span.first >= row_end) {
      for (; span.first >= row_end; row_end += width) ++y;
      row.first = Vec3f(corner + frame.step_y * (candidates.tile.y0 + y + 0.5));
      row.pixel_row = 1u << y;
    }
    const int begin = static_cast<int>(span.first - (row_end - width));
    const int end = begin + static_cast<int>(span.count);
    for (int x = begin; x < end; x += step) {
      const size_t place = span.first + static_cast<size_t>(x - begin);
      if (span.single_sphere != nullptr) {
        const FloatHit found =
            TestFloat<true>(spheres[span.single_sphere->primitive], RaysAt(row, x));
        StoreHits(hn::And(found.hit, hn::FirstN(d, static_cast<size_t>(end - x))), found.t,
                  hn::Set(du, span.single_sphere->primitive), place, hits);
      } else {
        TraceCells(spheres, candidates, row, x, end, place, hits);
      }
    }
  }
}

void IntersectFloatSphereT(const RTCIntersectFunctionNArguments* args) {
  const D d;
  RTCRayN* rays = RTCRayHitN_RayN(args->rayhit, args->N);
  RTCHitN* hits = RTCRayHitN_HitN(args->rayhit, args->N);
  const auto& sphere = static_cast<const FloatSphere*>(args->geometryUserPtr)[args->primID];
  for (unsigned i = 0; i < args->N; i += static_cast<unsigned>(hn::Lanes(d))) {
    const FloatHit found = TestFloat<false>(
        sphere, RaysOf(LoadU3(d, &RTCRayN_dir_x(rays, args->N, i), &RTCRayN_dir_y(rays, args->N, i),
                              &RTCRayN_dir_z(rays, args->N, i))));
    float* const depth = &RTCRayN_tfar(rays, args->N, i);
    const hn::RebindToSigned<D> di;
    const auto active = hn::Ne(hn::LoadU(di, args->valid + i), hn::Zero(di));
    const auto nearer = hn::And(hn::RebindMask(d, active),
                                hn::And(found.hit, hn::Lt(found.t, hn::LoadU(d, depth))));
    if (hn::AllFalse(d, nearer)) continue;
    hn::BlendedStore(found.t, nearer, d, depth);
    const hn::RebindToUnsigned<D> du;
    const auto nearer_u = hn::RebindMask(du, nearer);
    hn::BlendedStore(hn::Set(du, args->primID), nearer_u, du, &RTCHitN_primID(hits, args->N, i));
    hn::BlendedStore(hn::Set(du, args->geomID), nearer_u, du, &RTCHitN_geomID(hits, args->N, i));
  }
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace nacre
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace nacre {
HWY_EXPORT(TraceFloatTileT);
HWY_EXPORT(IntersectFloatSphereT);

std::vector<FloatSphere> FloatSpheres(const Scene& scene) {
  std::vector<FloatSphere> spheres;
  for (const Sphere& sphere : scene.spheres) {
    const Vec3f center(sphere.center - scene.camera.position);
    spheres.push_back(
        {{center.x, center.y, center.z}, static_cast<float>(sphere.radius * sphere.radius)});
  }
  return spheres;
}

void TraceFloatTile(const CameraFrame& frame, const std::vector<FloatSphere>& spheres,
                    const TileCandidates& candidates, FloatHits* hits) {
  HWY_DYNAMIC_DISPATCH(TraceFloatTileT)(frame, spheres, candidates, hits);
}

void IntersectFloatSphere(const RTCIntersectFunctionNArguments* args) {
  HWY_DYNAMIC_DISPATCH(IntersectFloatSphereT)(args);
}
}  // namespace nacre
#endif
