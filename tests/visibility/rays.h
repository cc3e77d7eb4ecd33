// SPDX-License-Identifier: Apache-2.0
// tests/visibility/rays.h: single rays instead of batches, and the brute-force reference: the
// scalar twins of the hit tests on every primitive.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "hit/batch.h"
#include "scene/scene.h"
#include "visibility/geometry.h"
#include "visibility/intersector.h"
#include "visibility/refine_kernel.h"
#include "visibility/sphere_test.h"
#include "visibility/triangle_test.h"

namespace nacre {

struct Ray {
  Vec3d origin{0, 0, 0};
  Vec3d direction{0, 0, -1};
};

struct Hit {
  uint32_t primitive = kNoPrimitive;
  double t = std::numeric_limits<double>::infinity();
  bool operator==(const Hit&) const = default;
};

struct HitSurface {
  uint32_t primitive;
  Vec3d position, normal, to_view;
};

struct ShadowRay {
  Ray ray;
  double t_max;
  uint32_t primitive;
  double own_after = kLeavesToEitherSide;
};

// Spheres, and three meshes of 20 random triangles in [-1, 1]^3, of materials 1, 0 and 1.
inline Scene RandomShapes(unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> in(-1, 1);
  Scene scene;
  scene.materials.resize(2);
  for (int i = 0; i < 3; ++i) {
    scene.spheres.push_back({Vec3d(in(random), in(random), in(random)), 0.2, {0}});
  }
  for (const uint32_t material : {1u, 0u, 1u}) {
    Mesh mesh{.material = {material}};
    for (uint32_t i = 0; i < 60; ++i) {
      mesh.positions.emplace_back(in(random), in(random), in(random));
      mesh.uvs.emplace_back(in(random), in(random));
      mesh.triangles.push_back(i);
    }
    scene.meshes.push_back(mesh);
  }
  return scene;
}

template <class Batch>
void SetRay(const Ray& ray, size_t i, Batch* batch) {
  batch->origin.x[i] = ray.origin.x;
  batch->origin.y[i] = ray.origin.y;
  batch->origin.z[i] = ray.origin.z;
  batch->direction.x[i] = ray.direction.x;
  batch->direction.y[i] = ray.direction.y;
  batch->direction.z[i] = ray.direction.z;
}

inline Vec3d At(const Soa3<double>& soa, size_t i) { return {soa.x[i], soa.y[i], soa.z[i]}; }

// Calls body(first, size, batch) with the rays in batches of up to batch_size.
template <class Body>
void ForEachBatch(const std::vector<Ray>& rays, size_t batch_size, const Body& body) {
  RayBatch batch;
  for (size_t first = 0; first < rays.size(); first += batch_size) {
    batch.count = std::min(batch_size, rays.size() - first);
    for (size_t i = 0; i < batch.count; ++i) SetRay(rays[first + i], i, &batch);
    body(first, batch);
  }
}

inline std::vector<Hit> Trace(const Intersector& intersector, const std::vector<Ray>& rays,
                              size_t batch_size = kBatchCapacity) {
  std::vector<Hit> hits(rays.size());
  ClosestHits closest;
  ForEachBatch(rays, batch_size, [&](size_t first, const RayBatch& batch) {
    intersector.Closest(batch, &closest);
    for (size_t i = 0; i < batch.count; ++i) {
      hits[first + i] = {closest.primitive[i], closest.t[i]};
    }
  });
  return hits;
}

// The surfaces that are hit, in the order of their rays.
inline std::vector<HitSurface> TraceSurfaces(const Intersector& intersector,
                                             const std::vector<Ray>& rays) {
  std::vector<HitSurface> surfaces;
  ClosestHits closest;
  HitBatch hits;
  HitDirections rounded;
  ForEachBatch(rays, kBatchCapacity, [&](size_t, const RayBatch& batch) {
    intersector.Closest(batch, &closest);
    std::vector<uint32_t> indices;
    for (uint32_t i = 0; i < batch.count; ++i) {
      if (closest.primitive[i] != kNoPrimitive) indices.push_back(i);
    }
    intersector.Refine(batch, closest, indices.data(), indices.size(), {&hits, &rounded, true});
    for (size_t i = 0; i < hits.count; ++i) {
      surfaces.push_back(
          {hits.primitive[i], At(hits.position, i), At(hits.normal, i), At(hits.to_view, i)});
    }
  });
  return surfaces;
}

// `light`, `camera_extent`: ShadowRayBatch's. If `outward`, all rays are kLeavesOutward.
inline std::vector<bool> TraceShadows(const Intersector& intersector,
                                      const std::vector<ShadowRay>& rays,
                                      uint32_t light = kAnyLight, bool outward = false,
                                      double camera_extent = 0) {
  std::vector<bool> occluded;
  ShadowRayBatch batch;
  batch.light = light;
  batch.camera_extent = camera_extent;
  for (size_t first = 0; first < rays.size(); first += kBatchCapacity) {
    batch.count = std::min(kBatchCapacity, rays.size() - first);
    for (size_t i = 0; i < batch.count; ++i) {
      SetRay(rays[first + i].ray, i, &batch);
      batch.t_max[i] = rays[first + i].t_max;
      batch.primitive[i] = rays[first + i].primitive;
      batch.own_after[i] = outward ? kLeavesOutward : rays[first + i].own_after;
    }
    intersector.Occluded(&batch);
    for (size_t i = 0; i < batch.count; ++i) occluded.push_back(batch.occluded[i] != 0);
  }
  return occluded;
}

// With the active target's products, like all functions below.
inline TriangleHit<double> TestTriangle(const TraceGeometry& geometry, size_t triangle,
                                        const Ray& ray) {
  const auto& v = geometry.triangles[triangle];
  return TestTriangle(geometry.positions[v[0]] - ray.origin, geometry.positions[v[1]] - ray.origin,
                      geometry.positions[v[2]] - ray.origin, ray.direction,
                      MakeShear(ray.direction), TargetProducts());
}

inline Hit BruteForce(const TraceGeometry& geometry, const Ray& ray) {
  Hit best;
  for (uint32_t i = 0; i < geometry.SphereCount(); ++i) {
    const TraceSphere& sphere = geometry.spheres[i];
    const auto hit =
        TestSphere(sphere.center - ray.origin, ray.direction, sphere.radius, TargetProducts());
    if (hit.hit && hit.t < best.t) best = {i, hit.t};
  }
  for (size_t i = 0; i < geometry.triangles.size(); ++i) {
    const auto hit = TestTriangle(geometry, i, ray);
    if (hit.hit && hit.t < best.t) {
      best = {geometry.SphereCount() + static_cast<uint32_t>(i), hit.t};
    }
  }
  return best;
}

// Whether the ray starts on the triangle's plane within rounding: StartsOnPlane of
// embree/triangle_kernel.cc, which derives the bound. `start`: the primitive that it starts on.
inline bool StartsOnPlane(const TraceGeometry& geometry, size_t triangle, const Ray& ray,
                          uint32_t start) {
  double extent = 0;
  if (start < geometry.SphereCount()) {
    extent = SumOfAbs(geometry.spheres[start].center) + geometry.spheres[start].radius;
  } else if (start != kNoPrimitive) {
    for (const uint32_t vertex : geometry.triangles[start - geometry.SphereCount()]) {
      extent = std::max(extent, SumOfAbs(geometry.positions[vertex]));
    }
  }
  const auto& v = geometry.triangles[triangle];
  const Vec3d a = geometry.positions[v[0]], to_a = a - ray.origin;
  const Vec3d e1 = geometry.positions[v[1]] - a, e2 = geometry.positions[v[2]] - a;
  return std::abs(to_a.dot(e1.cross(e2))) <=
         16 * 0x1p-53 * SumOfAbs(e1) * SumOfAbs(e2) * (extent + SumOfAbs(to_a));
}

// Whether the primitive that a ray starts on is the sphere, or one that coincides with it.
inline bool StartsOnSphere(const TraceGeometry& geometry, uint32_t start,
                           const TraceSphere& sphere) {
  return start < geometry.SphereCount() && geometry.spheres[start].center == sphere.center &&
         geometry.spheres[start].radius == sphere.radius;
}

// Of a ray that leaves a surface: RayBatch::from_surfaces.
inline Hit BruteForceFrom(const TraceGeometry& geometry, const Ray& ray, uint32_t start,
                          double own_after = kLeavesToEitherSide) {
  Hit best;
  for (uint32_t i = 0; i < geometry.SphereCount(); ++i) {
    const TraceSphere& sphere = geometry.spheres[i];
    const auto hit =
        TestSphere(sphere.center - ray.origin, ray.direction, sphere.radius, TargetProducts());
    const bool own = StartsOnSphere(geometry, start, sphere);
    const double t = own ? std::max(2 * hit.closest, 0.0) : hit.t;
    if ((own ? 2 * hit.closest > own_after : hit.hit) && t < best.t) best = {i, t};
  }
  for (size_t i = 0; i < geometry.triangles.size(); ++i) {
    const auto primitive = geometry.SphereCount() + static_cast<uint32_t>(i);
    const auto hit = TestTriangle(geometry, i, ray);
    const bool met = hit.hit && primitive != start && hit.t < best.t;
    if (met && !StartsOnPlane(geometry, i, ray, start)) best = {primitive, hit.t};
  }
  return best;
}

// Whether the ray ends on the surface within rounding: EndsOnSphere of visibility/occlusion-inl.h
// and EndsOnPlane of embree/triangle_kernel.cc, which derive the bounds.
inline bool EndsOnSphere(const TraceSphere& sphere, const ShadowRay& shadow) {
  if (std::isinf(shadow.t_max)) return false;
  const Vec3d to_end = shadow.ray.direction * shadow.t_max;
  const Vec3d to_center = sphere.center - shadow.ray.origin, from_end = to_center - to_end;
  const double extent =
      SumOfAbs(shadow.ray.origin) + SumOfAbs(to_end) + sphere.radius + SumOfAbs(to_center);
  return std::abs(from_end.dot(from_end) - sphere.radius * sphere.radius) <=
         32 * 0x1p-53 * extent * (SumOfAbs(from_end) + sphere.radius);
}
inline bool EndsOnPlane(const TraceGeometry& geometry, size_t triangle, const ShadowRay& shadow) {
  if (std::isinf(shadow.t_max)) return false;
  const auto& v = geometry.triangles[triangle];
  const Vec3d a = geometry.positions[v[0]];
  const Vec3d e1 = geometry.positions[v[1]] - a, e2 = geometry.positions[v[2]] - a;
  const Vec3d to_end = shadow.ray.direction * shadow.t_max;
  const Vec3d from_end = a - shadow.ray.origin - to_end;
  const double extent = SumOfAbs(shadow.ray.origin) + SumOfAbs(to_end) + SumOfAbs(from_end) +
                        SumOfAbs(e1) + SumOfAbs(e2);
  return std::abs(from_end.dot(e1.cross(e2))) <=
         64 * 0x1p-53 * SumOfAbs(e1) * SumOfAbs(e2) * extent;
}

// Occlusion by spheres and by triangles at t > `gap`, except by those that the ray ends on. A
// sphere that it ends on has one root there, and may have another one before.
inline bool BruteForceOccluded(const TraceGeometry& geometry, const ShadowRay& shadow,
                               double gap = 0, bool outward = false) {
  const auto& [ray, t_max, start, own_after] = shadow;
  for (uint32_t i = 0; i < geometry.SphereCount(); ++i) {
    const TraceSphere& sphere = geometry.spheres[i];
    const auto hit =
        TestSphere(sphere.center - ray.origin, ray.direction, sphere.radius, TargetProducts());
    const bool own = StartsOnSphere(geometry, start, sphere);
    const double t = own ? std::max(2 * hit.closest, 0.0) : hit.t;
    const double other = 2 * hit.closest - t_max;
    if ((own || other <= 0 || other >= t_max) && EndsOnSphere(sphere, shadow)) continue;
    const double after = outward ? kLeavesOutward : own_after;
    if ((own ? 2 * hit.closest > after : hit.hit) && t < t_max) return true;
  }
  for (size_t i = 0; i < geometry.triangles.size(); ++i) {
    if (geometry.SphereCount() + i == start) continue;
    const auto hit = TestTriangle(geometry, i, ray);
    const bool met = hit.hit && hit.t > gap && hit.t < t_max;
    if (met && !EndsOnPlane(geometry, i, shadow)) return true;
  }
  return false;
}

// ---- Random inputs ------------------------------------------------------------------------------

class Random {
 public:
  explicit Random(uint64_t seed) : engine_(seed) {}

  double Uniform(double low, double high) {
    return low + (high - low) * static_cast<double>(engine_() >> 11) * 0x1p-53;
  }
  // Uniform in the logarithm.
  double Magnitude(double low, double high) {
    return std::exp(Uniform(std::log(low), std::log(high)));
  }
  Vec3d InBox(const Vec3d& low, const Vec3d& high) {
    return {Uniform(low.x, high.x), Uniform(low.y, high.y), Uniform(low.z, high.z)};
  }
  Vec3d Direction() {
    for (;;) {
      const Vec3d v = InBox(Vec3d(-1), Vec3d(1));
      if (v.length() > 0.1 && v.length() < 1) return v.normalized();
    }
  }
  std::mt19937_64& engine() { return engine_; }

 private:
  std::mt19937_64 engine_;
};

inline Sphere MakeSphere(const Vec3d& center, double radius) { return {center, radius, {}}; }

// `count` spheres about a centre in front of the camera, some of which contain it.
inline Scene RandomSpheres(Random* random, size_t count) {
  Scene scene;
  const double size = std::cbrt(1.0 / static_cast<double>(count));
  for (size_t i = 0; i < count; ++i) {
    scene.spheres.push_back(
        MakeSphere(random->InBox({-2, -2, -7}, {2, 2, 0.5}), random->Magnitude(0.05, 2) * size));
  }
  return scene;
}

// Rays of a perspective camera at the origin, looking along -z.
inline std::vector<Ray> CameraRays(Random* random, size_t count) {
  std::vector<Ray> rays(count);
  for (Ray& ray : rays) {
    ray.direction = Vec3d(random->Uniform(-0.6, 0.6), random->Uniform(-0.6, 0.6), -1);
  }
  return rays;
}

}  // namespace nacre
