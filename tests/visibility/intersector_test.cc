// SPDX-License-Identifier: Apache-2.0
// tests/visibility/intersector_test.cc: closest hits against brute force, and that they do not
// depend on batches, packets and targets.
#include "visibility/intersector.h"

#include <atomic>
#include <chrono>
#include <cmath>
#include <thread>

#include "base/cancel.h"
#include "base/error.h"
#include "base/parallel.h"
#include "catch.h"
#include "targets.h"
#include "visibility/box_trees.h"
#include "visibility/rays.h"

namespace nacre {
namespace {

// Checks that the intersector's hits equal those of brute force, bit for bit, on every target, with
// spheres in shells as well, whatever they are like, and with trees of a camera elsewhere.
void CheckClosest(const Scene& scene, const Vec3d& eye, const std::vector<Ray>& rays) {
  const TraceGeometry geometry = MakeTraceGeometry(scene, eye);
  ForEachTarget([&](Target) {
    const std::vector<Hit> hits = Trace(Intersector(scene, eye), rays);
    CHECK(Trace(Intersector(scene, eye, {.shells = true}), rays) == hits);
    const double away = geometry.extent / 2;
    Intersector moved(scene, eye + Vec3d(-0.6, 0, 0.8) * away, {.eye_reach = away * (1 + 1e-9)});
    const bool follows = moved.MoveTo(scene, eye);
    CHECK(follows == !moved.HasShells());
    if (follows) CHECK(Trace(moved, rays) == hits);
    bool any = false;
    for (size_t i = 0; i < rays.size(); ++i) {
      const Hit expected = BruteForce(geometry, rays[i]);
      INFO("ray " << i << " t " << hits[i].t << " expected " << expected.t);
      REQUIRE(hits[i].primitive == expected.primitive);
      REQUIRE(hits[i].t == expected.t);
      any = any || expected.primitive != kNoPrimitive;
    }
    CHECK(any);
  });
}

std::vector<Ray> RaysAllAround(Random* random, size_t count) {
  std::vector<Ray> rays(count);
  for (Ray& ray : rays) ray.direction = random->Direction() * random->Magnitude(1e-3, 1e3);
  return rays;
}

TEST_CASE("an empty scene has no hits") {
  const Intersector intersector({}, Vec3d(0));
  CHECK(Trace(intersector, {Ray{}}).front() == Hit{});
  CHECK_FALSE(TraceShadows(intersector, {{Ray{}, 1, kNoPrimitive}}).front());
}

TEST_CASE("closest hits are brute force's") {
  Random random(11);
  for (const unsigned count : {1u, 2u, 7u, 25u, 200u, 2000u}) {
    const Scene scene = RandomSpheres(&random, count);
    CheckClosest(scene, Vec3d(0), CameraRays(&random, 2000));
  }
}

TEST_CASE("closest hits are brute force's from an orthographic camera") {
  Random random(12);
  const Scene scene = RandomSpheres(&random, 300);
  const Vec3d eye(1, -2, 5);
  std::vector<Ray> rays(3000);
  for (Ray& ray : rays) ray.origin = Vec3d(random.Uniform(-4, 3), random.Uniform(-1, 5), 0);
  CheckClosest(scene, eye, rays);
}

// Large trees trace such rays one by one, from the inside of a packet that has room for more.
TEST_CASE("rays in all directions in a large tree") {
  Random random(21);
  CheckClosest(RandomSpheres(&random, 1500), Vec3d(0), RaysAllAround(&random, 1003));
}

TEST_CASE("far spheres, and tiny and huge ones in one scene") {
  Random random(13);
  Scene scene;
  for (int i = 0; i < 400; ++i) {
    const double distance = random.Magnitude(1e-3, 1e6);
    scene.spheres.push_back(
        MakeSphere(random.Direction() * distance, distance * random.Magnitude(1e-7, 0.2)));
  }
  std::vector<Ray> rays = RaysAllAround(&random, 2000);
  // Aimed at each sphere, so that the small ones are hit.
  for (const Sphere& sphere : scene.spheres) {
    rays.push_back({Vec3d(0), sphere.center + random.Direction() * sphere.radius * 0.7});
  }
  CheckClosest(scene, Vec3d(0), rays);
  scene.spheres.push_back(MakeSphere({0, -1e7 - 1, 0}, 1e7));
  scene.spheres.push_back(MakeSphere({0, -1e-5, -1e-5}, 1e-6));
  rays.push_back({Vec3d(0), Vec3d(1e-7, -1, -1)});
  CheckClosest(scene, Vec3d(0), rays);
}

// scene/limits.h: lengths from 1e-15 to 1e15, coordinates up to 1e15 on either side of the
// camera's.
TEST_CASE("the ends of the range of lengths") {
  Random random(23);
  for (const double size : {1e-15, 1e-8, 1e7, 1e15}) {
    for (const Vec3d& eye : {Vec3d(0), Vec3d(-size)}) {
      CAPTURE(size, eye.x);
      Scene scene;
      for (int i = 0; i < 100; ++i) {
        const Vec3d center = random.InBox(Vec3d(-size), Vec3d(size));
        scene.spheres.push_back(MakeSphere(center, std::max(1e-15, size * random.Uniform(0, 0.2))));
      }
      std::vector<Ray> rays = RaysAllAround(&random, 1000);
      for (const Sphere& sphere : scene.spheres) {
        const Vec3d offset = random.Direction() * (sphere.radius * random.Uniform(0.9, 1.1));
        rays.push_back({Vec3d(0), sphere.center - eye + offset});
      }
      CheckClosest(scene, eye, rays);
    }
  }
}

TEST_CASE("all lengths in one scene") {
  Random random(24);
  Scene scene;
  for (int i = 0; i < 300; ++i) {
    const double distance = random.Magnitude(1e-15, 1e15);
    scene.spheres.push_back(MakeSphere(random.Direction() * distance,
                                       std::max(1e-15, distance * random.Magnitude(1e-7, 0.5))));
  }
  scene.spheres.push_back(MakeSphere({0, -1e15, 0}, 1e15 * (1 - 1e-15)));
  std::vector<Ray> rays = RaysAllAround(&random, 1000);
  for (const Sphere& sphere : scene.spheres) {
    rays.push_back({Vec3d(0), sphere.center + random.Direction() * sphere.radius * 0.7});
    rays.push_back({Vec3d(0), sphere.center + random.Direction() * sphere.radius * 1.01});
  }
  CheckClosest(scene, Vec3d(0), rays);
}

TEST_CASE("triangles at the ends of the range of lengths") {
  Random random(25);
  for (const double size : {1e-15, 1e15}) {
    CAPTURE(size);
    Scene scene;
    Mesh& mesh = scene.meshes.emplace_back();
    for (uint32_t i = 0; i < 300; ++i) {
      mesh.positions.push_back(random.InBox(Vec3d(-size), Vec3d(size)));
      mesh.triangles.push_back(i);
    }
    CheckClosest(scene, Vec3d(0), RaysAllAround(&random, 1000));
    CheckClosest(scene, Vec3d(size), RaysAllAround(&random, 1000));
  }
}

TEST_CASE("the camera in, on and between spheres") {
  Random random(14);
  Scene scene;
  scene.spheres = {MakeSphere({0, 0, 0}, 2),        MakeSphere({0, 0, 0}, 3),
                   MakeSphere({1, 0, 0}, 1),        MakeSphere({0, 0, 0}, 2),
                   MakeSphere({0.5, 0, 0}, 0.25),   MakeSphere({-0.25, 0, 0}, 0.125),
                   MakeSphere({0, 0, 0}, 2 + 4e-5), MakeSphere({0, 0, -5}, 1)};
  for (const Vec3d& eye : {Vec3d(0), Vec3d(0.5, 0, 0), Vec3d(2, 0, 0), Vec3d(2.5, 0, 0),
                           Vec3d(0, 2 + 2e-5, 0), Vec3d(0, 10, 0)}) {
    CheckClosest(scene, eye, RaysAllAround(&random, 2000));
  }
}

TEST_CASE("shells 4e-5 apart are told apart, from a distance and with a hit on each") {
  Random random(15);
  Scene scene;
  scene.spheres = {MakeSphere({0, 0, -1000}, 1), MakeSphere({0, 0, -1000}, 1 + 4e-5)};
  std::vector<Ray> rays(5000);
  for (Ray& ray : rays) {
    ray.direction = Vec3d(random.Uniform(-1e-3, 1e-3), random.Uniform(-1e-3, 1e-3), -1);
  }
  CheckClosest(scene, Vec3d(0), rays);
  const auto hits = Trace(Intersector(scene, Vec3d(0)), rays);
  for (const Hit& hit : hits) CHECK((hit.primitive == 1 || hit.primitive == kNoPrimitive));
}

TEST_CASE("of coincident spheres the first is hit") {
  Random random(16);
  Scene scene;
  scene.spheres.push_back(MakeSphere({0, 3, -5}, 1));
  for (int i = 0; i < 20; ++i) scene.spheres.push_back(MakeSphere({0, 0, -5}, 1));
  ForEachTarget([&](Target) {
    const Intersector intersector(scene, Vec3d(0));
    for (const Hit& hit : Trace(intersector, CameraRays(&random, 1000))) {
      CHECK((hit.primitive <= 1 || hit.primitive == kNoPrimitive));
    }
    CHECK(Trace(intersector, {Ray{}}).front() == Hit{1, 4});
  });
}

TEST_CASE("a hit does not depend on the rays that share its batch") {
  Random random(17);
  const Scene scene = RandomSpheres(&random, 500);
  std::vector<Ray> rays = CameraRays(&random, 1024);
  ForEachTarget([&](Target) {
    const Intersector intersector(scene, Vec3d(0));
    const std::vector<Hit> hits = Trace(intersector, rays);
    for (const unsigned batch_size : {1u, 3u, 17u, 100u}) {
      CHECK(Trace(intersector, rays, batch_size) == hits);
    }
    std::vector<size_t> order(rays.size());
    for (size_t i = 0; i < order.size(); ++i) order[i] = i;
    std::shuffle(order.begin(), order.end(), random.engine());
    std::vector<Ray> shuffled;
    for (const size_t i : order) shuffled.push_back(rays[i]);
    const std::vector<Hit> shuffled_hits = Trace(intersector, shuffled);
    for (size_t i = 0; i < order.size(); ++i) CHECK(shuffled_hits[i] == hits[order[i]]);
  });
}

TEST_CASE("a hit depends neither on the threads that build nor on those that trace") {
  Random random(18);
  const Scene scene = RandomSpheres(&random, 2000);
  const std::vector<Ray> rays = CameraRays(&random, 1024);
  const std::vector<Hit> hits = Trace(Intersector(scene, Vec3d(0), {1}), rays);
  const Intersector intersector(scene, Vec3d(0), {2});
  CHECK(Trace(intersector, rays) == hits);
  std::vector<int> same(16);
  ParallelFor(same.size(), 2, [&](size_t i) { same[i] = Trace(intersector, rays) == hits; });
  CHECK(std::count(same.begin(), same.end(), 1) == 16);
}

TEST_CASE("scaling a scene by a power of two changes no bit") {
  Random random(19);
  const Scene scene = RandomSpheres(&random, 300);
  const Vec3d eye(0.3, -0.2, 0.7);
  const std::vector<Ray> rays = CameraRays(&random, 2000);
  const Intersector unscaled(scene, eye);
  const std::vector<Hit> hits = Trace(unscaled, rays);
  const std::vector<HitSurface> surfaces = TraceSurfaces(unscaled, rays);
  for (const int exponent : {-40, -20, -7, 1, 13, 20, 39}) {
    const double scale = std::ldexp(1.0, exponent);
    Scene scaled = scene;
    for (Sphere& sphere : scaled.spheres) {
      sphere.center *= scale;
      sphere.radius *= scale;
    }
    const Intersector intersector(scaled, eye * scale);
    const std::vector<Hit> scaled_hits = Trace(intersector, rays);
    for (size_t i = 0; i < rays.size(); ++i) {
      REQUIRE(scaled_hits[i] == Hit{hits[i].primitive, hits[i].t * scale});
    }
    const std::vector<HitSurface> scaled_surfaces = TraceSurfaces(intersector, rays);
    REQUIRE(scaled_surfaces.size() == surfaces.size());
    for (size_t i = 0; i < surfaces.size(); ++i) {
      REQUIRE(scaled_surfaces[i].normal == surfaces[i].normal);
      REQUIRE(scaled_surfaces[i].position == surfaces[i].position * scale);
    }
  }
}

TEST_CASE("the length of a direction does not matter") {
  Random random(20);
  const Scene scene = RandomSpheres(&random, 100);
  const std::vector<Ray> rays = CameraRays(&random, 1000);
  const Intersector intersector(scene, Vec3d(0));
  const std::vector<Hit> hits = Trace(intersector, rays);
  for (const double scale : {0x1p-60, 0x1p-1, 0x1p60}) {
    std::vector<Ray> scaled = rays;
    for (Ray& ray : scaled) ray.direction *= scale;
    const std::vector<Hit> scaled_hits = Trace(intersector, scaled);
    for (size_t i = 0; i < rays.size(); ++i) {
      REQUIRE(scaled_hits[i] == Hit{hits[i].primitive, hits[i].t / scale});
    }
  }
}

TEST_CASE("directions along the axes and in their planes") {
  Random random(21);
  const Scene scene = RandomSpheres(&random, 300);
  std::vector<Ray> rays;
  for (int i = 0; i < 26; ++i) {
    const int code = i < 13 ? i : i + 1;  // all but (0, 0, 0)
    rays.push_back({Vec3d(0), Vec3d(code % 3 - 1, code / 3 % 3 - 1, code / 9 - 1)});
  }
  CheckClosest(scene, Vec3d(0, 0, -3), rays);
}

// The middle column of a camera's rays points almost along an axis: only rounding decides to which
// side of it. It shares packets with rays that point to the same side.
TEST_CASE("directions almost along the axes, among others") {
  Random random(26);
  const double tiny[] = {0.0,    -0.0,    0x1p-80, -0x1p-80, 0x1p-59, -0x1p-59,
                         1e-300, -1e-300, 1e-40,   -1e-40,   1e-15,   -1e-15};
  for (int axis = 0; axis < 3; ++axis) {
    for (const double side : {-1.0, 1.0}) {
      Scene scene;
      std::vector<Ray> rays;
      Vec3d along(0);
      along[axis] = side;
      for (int i = 0; i < 12; ++i) {
        const Vec3d aside = random.Direction() * 0.05;
        scene.spheres.push_back(MakeSphere(along * random.Uniform(2, 9) + aside, 0.1));
      }
      for (int i = 0; i < 3000; ++i) {
        Vec3d direction = along;
        for (int k = 0; k < 3; ++k) {
          const auto which = static_cast<size_t>(random.Uniform(0, std::size(tiny)));
          if (k != axis) {
            direction[k] = random.Uniform(0, 1) < 0.3 ? tiny[which] : random.Uniform(-0.03, 0.03);
          }
        }
        rays.push_back({Vec3d(0), direction});
      }
      CheckClosest(scene, Vec3d(0), rays);
      std::vector<ShadowRay> shadows;
      for (const Ray& ray : rays) shadows.push_back({ray, 20, kNoPrimitive});
      const TraceGeometry geometry = MakeTraceGeometry(scene, Vec3d(0));
      ForEachTarget([&](Target) {
        const std::vector<bool> occluded = TraceShadows(Intersector(scene, Vec3d(0)), shadows);
        for (size_t i = 0; i < shadows.size(); ++i) {
          REQUIRE(occluded[i] == BruteForceOccluded(geometry, shadows[i]));
        }
      });
      Mesh& mesh = scene.meshes.emplace_back();
      for (const Sphere& sphere : scene.spheres) {
        for (int corner = 0; corner < 3; ++corner) {
          mesh.triangles.push_back(static_cast<uint32_t>(mesh.positions.size()));
          mesh.positions.push_back(sphere.center + random.Direction() * 0.2);
        }
      }
      scene.spheres.clear();
      CheckClosest(scene, Vec3d(0), rays);
    }
  }
}

TEST_CASE("padding repeats the last hit") {
  Random random(22);
  Scene scene;
  scene.spheres.push_back(MakeSphere({0, 0, -3}, 2.5));
  const Intersector intersector(scene, Vec3d(0));
  RayBatch rays;
  ClosestHits closest;
  HitBatch hits;
  HitDirections rounded;
  const HitOutput to{&hits, &rounded, true};
  rays.count = 20;
  for (size_t i = 0; i < rays.count; ++i) {
    SetRay({Vec3d(0), Vec3d(random.Uniform(-0.1, 0.1), 0, -1)}, i, &rays);
  }
  intersector.Closest(rays, &closest);
  for (const unsigned count : {1u, 5u, 16u, 17u}) {
    const std::vector<uint32_t> indices{19, 3, 3, 7, 1, 0, 2, 4, 5, 6, 8, 9, 10, 11, 12, 13, 14};
    intersector.Refine(rays, closest, indices.data(), count, to);
    REQUIRE(hits.count == count);
    for (size_t i = 0; i < count; ++i) CHECK(hits.ray[i] == indices[i]);
    for (size_t i = count; i < RoundUp(count, kBatchPadding); ++i) {
      CHECK(hits.ray[i] == indices[count - 1]);
      CHECK(hits.primitive[i] == 0);
      CHECK(At(hits.position, i) == At(hits.position, count - 1));
      CHECK(At(hits.normal, i) == At(hits.normal, count - 1));
      CHECK(At(hits.to_view, i) == At(hits.to_view, count - 1));
      CHECK(rounded.normal.x[i] == rounded.normal.x[count - 1]);
      CHECK(rounded.to_view.x[i] == rounded.to_view.x[count - 1]);
    }
  }
  intersector.Refine(rays, closest, nullptr, 0, to);
  CHECK(hits.count == 0);
}

// A tree of spheres that takes some ten milliseconds.
Scene LargeCloud(Random* random) { return RandomSpheres(random, 60000); }

TEST_CASE("a build of a tree that is ended leaves none, and the next one is whole") {
  if (EmbreeVersion() == nullptr) return;
  Random random(31);
  const Scene scene = LargeCloud(&random);
  const std::vector<Ray> rays = CameraRays(&random, 500);
  const std::vector<Hit> hits = Trace(Intersector(scene, Vec3d(0)), rays);
  Intersector ended(scene, Vec3d(0), {.tree = false});
  std::atomic<bool> cancel = true;
  CHECK_THROWS_AS(ended.BuildTree(&cancel), Cancelled);
  CHECK_THROWS_AS(ended.BuildTree(&cancel), Cancelled);
  cancel = false;
  ended.BuildTree(&cancel);
  CHECK(Trace(ended, rays) == hits);
}

TEST_CASE("a build of a tree is ended by another thread, at any time") {
  if (EmbreeVersion() == nullptr) return;
  Random random(32);
  const Scene scene = LargeCloud(&random);
  const std::vector<Ray> rays = CameraRays(&random, 100);
  const std::vector<Hit> hits = Trace(Intersector(scene, Vec3d(0)), rays);
  for (int i = 0; i < 12; ++i) {
    Intersector intersector(scene, Vec3d(0), {.tree = false});
    std::atomic<bool> cancel = false;
    std::thread other([&] {
      std::this_thread::sleep_for(std::chrono::microseconds(1000 * i));
      cancel = true;
    });
    try {
      intersector.BuildTree(&cancel);
    } catch (const Cancelled&) {
      other.join();
      intersector.BuildTree();
    }
    if (other.joinable()) other.join();
    REQUIRE(Trace(intersector, rays) == hits);
  }
}

}  // namespace
}  // namespace nacre
