// SPDX-License-Identifier: Apache-2.0
// tests/visibility/surface_rays_test.cc: rays that leave surfaces, and where they arrive: for
// light that is followed over several bounces.
#include <array>
#include <cmath>

#include "catch.h"
#include "targets.h"
#include "visibility/rays.h"

namespace nacre {
namespace {

struct SurfaceRay {
  Ray ray;
  uint32_t start;
  double own_after = kLeavesToEitherSide;
};

constexpr double kSides[] = {kLeavesOutward, kLeavesInward, kLeavesToEitherSide};

struct Arrival {
  Hit hit;
  HitSurface surface;  // where there is a hit
};

std::vector<Arrival> Follow(const Intersector& intersector, const std::vector<SurfaceRay>& rays) {
  std::vector<Arrival> arrivals;
  RayBatch batch;
  batch.from_surfaces = true;
  ClosestHits closest;
  HitBatch hits;
  HitDirections rounded;
  for (size_t first = 0; first < rays.size(); first += kBatchCapacity) {
    batch.count = std::min(kBatchCapacity, rays.size() - first);
    for (size_t i = 0; i < batch.count; ++i) {
      SetRay(rays[first + i].ray, i, &batch);
      batch.start[i] = rays[first + i].start;
      batch.own_after[i] = rays[first + i].own_after;
    }
    intersector.Closest(batch, &closest);
    std::vector<uint32_t> indices;
    for (uint32_t i = 0; i < batch.count; ++i) {
      if (closest.primitive[i] != kNoPrimitive) indices.push_back(i);
    }
    if (!indices.empty()) {
      intersector.Refine(batch, closest, indices.data(), indices.size(), {&hits, &rounded, true});
    }
    size_t next = 0;
    for (size_t i = 0; i < batch.count; ++i) {
      Arrival arrival{{closest.primitive[i], closest.t[i]}, {}};
      if (arrival.hit.primitive != kNoPrimitive) {
        arrival.surface = {hits.primitive[next], At(hits.position, next), At(hits.normal, next),
                           At(hits.to_view, next)};
        ++next;
      }
      arrivals.push_back(arrival);
    }
  }
  return arrivals;
}

void AddTriangle(const std::array<uint32_t, 3>& corners, Mesh* mesh) {
  mesh->triangles.insert(mesh->triangles.end(), corners.begin(), corners.end());
}

// In all directions, along the surface among them, and to all sides in turn.
std::vector<SurfaceRay> RaysFrom(const std::vector<HitSurface>& surfaces, Random* random) {
  std::vector<SurfaceRay> rays;
  for (const HitSurface& surface : surfaces) {
    Vec3d direction = random->Direction();
    if (rays.size() % 3 == 0) {
      const Vec3d along = direction.cross(surface.normal);
      direction = along + surface.normal * random->Uniform(-1, 1) * random->Magnitude(1e-14, 1e-2);
    }
    rays.push_back({{surface.position, direction * random->Magnitude(1e-3, 1e3)},
                    surface.primitive,
                    kSides[random->engine()() % 3]});
  }
  return rays;
}

void CheckArrivals(const Scene& scene, const std::vector<SurfaceRay>& rays, bool shells) {
  const TraceGeometry geometry = MakeTraceGeometry(scene, Vec3d(0));
  ForEachTarget([&](Target) {
    const std::vector<Arrival> arrivals =
        Follow(Intersector(scene, Vec3d(0), {.shells = shells}), rays);
    for (size_t i = 0; i < rays.size(); ++i) {
      INFO("ray " << i << " from " << rays[i].start);
      REQUIRE(arrivals[i].hit ==
              BruteForceFrom(geometry, rays[i].ray, rays[i].start, rays[i].own_after));
    }
  });
}

TEST_CASE("rays that leave spheres arrive where brute force says") {
  Random random(41);
  for (const unsigned count : {1u, 5u, 25u, 300u, 2000u}) {
    const Scene scene = RandomSpheres(&random, count);
    const auto surfaces = TraceSurfaces(Intersector(scene, Vec3d(0)), CameraRays(&random, 1500));
    const auto rays = RaysFrom(surfaces, &random);
    CheckArrivals(scene, rays, false);
    CheckArrivals(scene, rays, true);
  }
}

TEST_CASE("rays that leave meshes arrive where brute force says") {
  Random random(42);
  Scene scene = RandomSpheres(&random, 20);
  scene.meshes.emplace_back();
  Mesh& mesh = scene.meshes.back();
  // Quads of two triangles each, and some triangles twice.
  for (uint32_t i = 0; i < 40; ++i) {
    const Vec3d corner = random.InBox({-2, -2, -7}, {2, 2, -1});
    const Vec3d e1 = random.Direction(), e2 = random.Direction();
    const uint32_t v = 4 * i;
    for (const Vec3d& p : {corner, corner + e1, corner + e1 + e2, corner + e2}) {
      mesh.positions.push_back(p);
    }
    AddTriangle({v, v + 1, v + 2}, &mesh);
    AddTriangle({v, v + 2, v + 3}, &mesh);
    if (i % 4 == 0) AddTriangle({v, v + 1, v + 2}, &mesh);
  }
  const auto surfaces = TraceSurfaces(Intersector(scene, Vec3d(0)), CameraRays(&random, 1500));
  REQUIRE(surfaces.size() > 500);
  CheckArrivals(scene, RaysFrom(surfaces, &random), false);
}

// Directions along the sphere, whose side rounding decides where the ray does not say it.
TEST_CASE("rays along their sphere meet it if they leave inward, and do not if outward") {
  Random random(45);
  Scene scene;
  scene.spheres = {MakeSphere({0.3, -0.2, -4}, 1.3)};
  std::vector<SurfaceRay> rays;
  for (int i = 0; i < 3000; ++i) {
    const Vec3d out = random.Direction();
    const Vec3d along = random.Direction().cross(out).normalized();
    const double lean = random.Uniform(-1, 1) * random.Magnitude(1e-17, 1e-9);
    rays.push_back({{scene.spheres[0].center + out * 1.3, along + out * lean}, 0, kSides[i % 3]});
  }
  ForEachTarget([&](Target) {
    for (const bool shells : {false, true}) {
      const auto arrivals = Follow(Intersector(scene, Vec3d(0), {.shells = shells}), rays);
      size_t met = 0;
      for (size_t i = 0; i < rays.size(); ++i) {
        const bool meets = arrivals[i].hit.primitive == 0;
        if (rays[i].own_after != kLeavesToEitherSide) {
          REQUIRE(meets == (rays[i].own_after == kLeavesInward));
        }
        met += meets ? 1 : 0;
      }
      CHECK(met > 1100);  // some of the thousand that leave to either side
      CHECK(met < 1900);
    }
  });
}

// What the tests above cannot see, because their reference shares the rule: that no bounce is lost
// and none is made at the start.
TEST_CASE("light that is mirrored inside a sphere stays inside") {
  Random random(43);
  for (const double radius : {1e-6, 1.0, 1e7}) {
    Scene scene;
    scene.spheres = {MakeSphere(random.Direction() * radius * 3, radius)};
    const Vec3d center = scene.spheres[0].center;
    ForEachTarget([&](Target) {
      const Intersector intersector(scene, Vec3d(0));
      std::vector<SurfaceRay> rays(200);
      for (SurfaceRay& ray : rays) {
        const Vec3d out = random.Direction();
        Vec3d direction = random.Direction();
        if (direction.dot(out) > 0) direction *= -1;
        ray = {{center + out * radius, direction}, 0};
      }
      for (int bounce = 0; bounce < 50; ++bounce) {
        const std::vector<Arrival> arrivals = Follow(intersector, rays);
        for (size_t i = 0; i < rays.size(); ++i) {
          REQUIRE(arrivals[i].hit.primitive == 0);
          const HitSurface& at = arrivals[i].surface;
          // The position is rounded at coordinates of up to four radii.
          REQUIRE(std::abs((at.position - center).length() / radius - 1) < 4e-15);
          // On the far side, seen from inside.
          REQUIRE(at.normal.dot(at.position - center) < 0);
          const Vec3d in = rays[i].ray.direction;
          const double chord = -2 * in.dot(rays[i].ray.origin - center);  // for unit directions
          REQUIRE(std::abs(arrivals[i].hit.t - chord) < 1e-14 * radius);
          const Vec3d mirrored = in - at.normal * (2 * in.dot(at.normal));
          rays[i] = {{at.position, mirrored.normalized()}, 0};
        }
      }
    });
  }
}

const Vec3d kRoomLow(-1.1, -0.7, -9.3), kRoomHigh(2.3, 1.9, -3.1);

// How many of the room's walls are so near.
int WallsWithin(const Vec3d& p, double distance) {
  int count = 0;
  for (int axis = 0; axis < 3; ++axis) {
    count += std::abs(p[axis] - kRoomLow[axis]) < distance ? 1 : 0;
    count += std::abs(p[axis] - kRoomHigh[axis]) < distance ? 1 : 0;
  }
  return count;
}

TEST_CASE("light in a room of triangles stays in it, and never meets the wall that it leaves") {
  Random random(44);
  Scene scene;
  scene.meshes.emplace_back();
  Mesh& mesh = scene.meshes.back();
  const Vec3d &low = kRoomLow, &high = kRoomHigh;
  for (uint32_t i = 0; i < 8; ++i) {
    mesh.positions.emplace_back((i & 1) != 0 ? high.x : low.x, (i & 2) != 0 ? high.y : low.y,
                                (i & 4) != 0 ? high.z : low.z);
  }
  for (const std::array<uint32_t, 4>& quad : {std::array<uint32_t, 4>{0, 2, 6, 4},
                                              {1, 3, 7, 5},
                                              {0, 1, 5, 4},
                                              {2, 3, 7, 6},
                                              {0, 1, 3, 2},
                                              {4, 5, 7, 6}}) {
    AddTriangle({quad[0], quad[1], quad[2]}, &mesh);
    AddTriangle({quad[0], quad[2], quad[3]}, &mesh);
  }
  ForEachTarget([&](Target) {
    const Intersector intersector(scene, Vec3d(0));
    std::vector<SurfaceRay> rays(400);
    for (SurfaceRay& ray : rays) ray = {{(low + high) * 0.5, random.Direction()}, kNoPrimitive};
    for (int bounce = 0; bounce < 50; ++bounce) {
      const std::vector<Arrival> arrivals = Follow(intersector, rays);
      for (size_t i = 0; i < rays.size(); ++i) {
        REQUIRE(arrivals[i].hit.primitive != kNoPrimitive);
        if (bounce > 0) REQUIRE(arrivals[i].hit.primitive / 2 != rays[i].start / 2);
        const HitSurface& at = arrivals[i].surface;
        REQUIRE(at.normal.dot(rays[i].ray.direction) < 0);
        // Anywhere above the wall, and nearly along it where it is 1e-5 to the next one: rays have
        // then risen by 1e-12 there, which is far more than the 1e-15 that their origin is off by.
        Vec3d direction = random.Direction();
        if (direction.dot(at.normal) < 0) direction *= -1;
        if (i % 2 == 0 && WallsWithin(at.position, 1e-5) == 1) {
          direction = direction.cross(at.normal) + at.normal * 1e-7;
        }
        rays[i] = {{at.position, direction.normalized()}, at.primitive};
      }
    }
  });
}

}  // namespace
}  // namespace nacre
