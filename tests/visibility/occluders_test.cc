// SPDX-License-Identifier: Apache-2.0
// tests/visibility/occluders_test.cc: shadow rays without a tree, against brute force.
#include "base/basis.h"
#include "catch.h"
#include "targets.h"
#include "visibility/occluder_lists.h"
#include "visibility/rays.h"

namespace nacre {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

Light PointAt(const Vec3d& position) {
  return {.kind = PointLight{.position = position, .intensity = {1, 1, 1}}};
}

Light SunAlong(const Vec3d& direction) {
  return {.kind = DirectionalLight{.direction_of_travel = direction, .irradiance = {1, 1, 1}}};
}

// Shadow rays from those surfaces that face the light.
std::vector<ShadowRay> RaysTo(const Light& light, const Vec3d& eye,
                              const std::vector<HitSurface>& surfaces) {
  const ShadowLight target = MakeShadowLight(light, eye);
  std::vector<ShadowRay> rays;
  for (const HitSurface& surface : surfaces) {
    const Vec3d direction =
        target.positional ? target.position - surface.position : target.to_light;
    if (surface.normal.dot(direction) <= 0) continue;
    rays.push_back(
        {{surface.position, direction}, target.positional ? 1 : kInfinity, surface.primitive});
  }
  return rays;
}

// Checks batches of up to `most` rays from one sphere: where MayOcclude is false, no ray is
// occluded. Returns the number of such batches.
size_t CheckBatches(const Intersector& intersector, const std::vector<ShadowRay>& rays,
                    const std::vector<bool>& occluded, size_t most) {
  size_t clear = 0;
  HitBatch hits;
  for (size_t first = 0; first < rays.size(); first += hits.count) {
    hits.count = 0;
    bool any = false;
    for (size_t i = first; i < std::min(first + most, rays.size()); ++i) {
      if (rays[i].primitive != rays[first].primitive) break;
      const size_t k = hits.count++;
      hits.primitive[k] = rays[i].primitive;
      hits.position.x[k] = rays[i].ray.origin.x;
      hits.position.y[k] = rays[i].ray.origin.y;
      hits.position.z[k] = rays[i].ray.origin.z;
      any = any || occluded[i];
    }
    const bool may = intersector.MayOcclude(0, hits);
    INFO("batch of " << hits.count << " from ray " << first);
    REQUIRE((may || !any));
    clear += may ? 0 : 1;
  }
  return clear;
}

// Checks that the tree and the light's occluders give the same occlusion for each ray. Returns the
// number of batches for which MayOcclude is false.
size_t CheckLight(const Scene& scene, const Light& light, const Vec3d& eye, bool outward,
                  const std::vector<HitSurface>& surfaces) {
  const TraceGeometry geometry = MakeTraceGeometry(scene, eye);
  std::vector<ShadowRay> rays = RaysTo(light, eye, surfaces);
  std::stable_sort(rays.begin(), rays.end(), [](const ShadowRay& a, const ShadowRay& b) {
    return a.primitive < b.primitive;
  });
  size_t clear = 0;
  ForEachTarget([&](Target) {
    Intersector intersector(scene, eye);
    intersector.FindOccluders({&light}, outward);
    const std::vector<bool> found = TraceShadows(intersector, rays, 0, outward);
    const std::vector<bool> by_tree = TraceShadows(intersector, rays, kAnyLight, outward);
    for (size_t i = 0; i < rays.size(); ++i) {
      INFO("ray " << i << " from " << rays[i].primitive);
      REQUIRE(found[i] == BruteForceOccluded(geometry, rays[i], 0, outward));
      REQUIRE(by_tree[i] == found[i]);
    }
    for (const size_t most : {size_t{1}, size_t{3}, size_t{40}}) {
      clear += CheckBatches(intersector, rays, found, most);
    }
  });
  return clear;
}

std::vector<Ray> RaysAllAround(Random* random, size_t count) {
  std::vector<Ray> rays(count);
  for (Ray& ray : rays) ray.direction = random->Direction();
  return rays;
}

bool IsOutside(const Scene& scene, const Vec3d& eye) {
  return std::all_of(scene.spheres.begin(), scene.spheres.end(), [&](const Sphere& sphere) {
    return (sphere.center - eye).length() > sphere.radius * (1 + 1e-9);
  });
}

// Checks lights of all kinds, near, far, inside and on the scene's spheres, for the visible
// surfaces. Returns the number of surfaces, and adds to `clear` what CheckLight returns.
size_t CheckLights(const Scene& scene, const Vec3d& eye, Random* random,
                   const std::vector<Ray>& rays, size_t* clear = nullptr) {
  const auto surfaces = TraceSurfaces(Intersector(scene, eye), rays);
  const bool outside = IsOutside(scene, eye);
  size_t found_clear = 0;
  const auto check = [&](const Light& light) {
    found_clear += CheckLight(scene, light, eye, false, surfaces);
    if (outside) found_clear += CheckLight(scene, light, eye, true, surfaces);
  };
  for (int i = 0; i < 2; ++i) {
    const auto& spheres = scene.spheres;
    const Sphere& sphere =
        spheres[static_cast<size_t>(random->Uniform(0, static_cast<double>(spheres.size())))];
    check(SunAlong(random->Direction() * random->Magnitude(1e-3, 1e3)));
    check(PointAt(eye + random->InBox({-3, -3, -8}, {3, 3, 2})));
    check(PointAt(eye + random->Direction() * random->Magnitude(1e-3, 1e6)));
    check(PointAt(sphere.center + random->Direction() * (sphere.radius * random->Uniform(0, 1))));
    check(PointAt(sphere.center + random->Direction() * sphere.radius));
    check(PointAt(sphere.center +
                  random->Direction() * (sphere.radius * (1 + random->Magnitude(1e-6, 1)))));
  }
  if (clear != nullptr) *clear += found_clear;
  return surfaces.size();
}

TEST_CASE("occluders are brute force's") {
  Random random(41);
  size_t seen = 0, clear = 0;
  for (const unsigned count : {1u, 2u, 7u, 25u, 100u, 256u, 257u, 1000u}) {
    CAPTURE(count);
    Scene scene = RandomSpheres(&random, count);
    for (int i = 0; i < 2; ++i) {
      seen += CheckLights(scene, Vec3d(0), &random, CameraRays(&random, 900), &clear);
      // From outside.
      std::erase_if(scene.spheres,
                    [](const Sphere& s) { return s.center.length() < s.radius * 1.1; });
    }
  }
  CHECK(seen > 1000);
  CHECK(clear > 1000);
}

// The ball of a batch's points sweeps a cylinder towards the sun, which a blocker overlaps or
// misses: beside it, behind it, and around its beginning.
TEST_CASE("a ball is in the shadow of what reaches into its way to the sun, and of nothing else") {
  Random random(44);
  for (int round = 0; round < 200; ++round) {
    CAPTURE(round);
    const Vec3d to_light = random.Direction();
    const Vec3d across = BasisAbout(to_light).x;
    const Vec3d center = random.InBox(Vec3d(-5), Vec3d(5));
    const double blocker = random.Magnitude(1e-2, 2), ball = random.Magnitude(1e-3, 0.5);
    const double radii = blocker + ball;
    const auto may = [&](double along, double beside) {
      TraceGeometry geometry;
      geometry.spheres = HugeArray<TraceSphere>(2);
      geometry.spheres[0] = {center, 1};
      geometry.spheres[1] = {center + to_light * along + across * beside, blocker};
      OccluderLists lists;
      lists.end = {1, 1};  // the first sphere's list has the second one
      lists.spheres = {1};
      lists.longest = 1;
      return MayShadow(geometry, lists, {false, Vec3d(0), to_light}, 0, {center, ball});
    };
    constexpr double kJust = 1e-6;
    for (const double along : {0.0, 0.5 * radii, 2.0, 100.0}) {
      CHECK(may(along, radii * (1 - kJust)));
      CHECK_FALSE(may(along, radii * (1 + kJust)));
    }
    CHECK(may(-radii * (1 - kJust), 0));  // it overlaps the ball
    CHECK_FALSE(may(-radii * (1 + kJust), 0));
    CHECK_FALSE(may(-100, 0));
  }
}

TEST_CASE("occluders of all sizes and distances") {
  Random random(42);
  for (int round = 0; round < 12; ++round) {
    CAPTURE(round);
    Scene scene;
    std::vector<Ray> rays;
    const int count = round < 6 ? 60 : 400;  // lists, and bins
    for (int i = 0; i < count; ++i) {
      const double distance = random.Magnitude(1e-2, 1e4);
      scene.spheres.push_back(
          MakeSphere(random.Direction() * distance, distance * random.Magnitude(1e-5, 0.5)));
      const Sphere& sphere = scene.spheres.back();
      if (i % 10 == 0) scene.spheres.push_back(sphere);  // the same again
      if (i % 10 == 1) {                                 // touching
        scene.spheres.push_back(
            MakeSphere(sphere.center + random.Direction() * (2 * sphere.radius), sphere.radius));
      }
    }
    if (round % 2 == 0) scene.spheres.push_back(MakeSphere({0, -1e6 - 1, 0}, 1e6));
    for (const Sphere& sphere : scene.spheres) {
      for (int i = 0; i < (round < 6 ? 5 : 1); ++i) {
        rays.push_back({Vec3d(0), sphere.center + random.Direction() * sphere.radius * 0.9});
      }
    }
    CHECK(CheckLights(scene, Vec3d(0), &random, rays) > 100);
  }
}

TEST_CASE("occluders far from the eye") {
  Random random(43);
  for (const double distance : {1e3, 1e6, 1e9}) {
    CAPTURE(distance);
    Scene scene;
    const Vec3d eye = random.Direction() * distance;
    std::vector<Ray> rays;
    for (int i = 0; i < 300; ++i) {
      scene.spheres.push_back(
          MakeSphere(random.InBox(Vec3d(-1), Vec3d(1)), random.Magnitude(1e-3, 0.5)));
      for (int k = 0; k < 2; ++k) {
        const Sphere& sphere = scene.spheres.back();
        rays.push_back({Vec3d(0), sphere.center + random.Direction() * sphere.radius - eye});
      }
    }
    CHECK(CheckLights(scene, eye, &random, rays) > 100);
  }
}

// From inside a sphere there are no tangents: all of the walls may be lit.
TEST_CASE("occluders in a room, with the eye and the lamp in it") {
  Random random(46);
  for (const int count : {30, 300}) {
    Scene scene;
    scene.spheres.push_back(MakeSphere({0, 0, 0}, 10));
    for (int i = 0; i < count; ++i) {
      scene.spheres.push_back(
          MakeSphere(random.Direction() * random.Uniform(2, 8), random.Uniform(0.1, 0.5)));
    }
    const auto surfaces = TraceSurfaces(Intersector(scene, Vec3d(0)), RaysAllAround(&random, 2000));
    for (int i = 0; i < 6; ++i) {
      const Light lamp = PointAt(random.Direction() * random.Uniform(0, 9.9));
      CheckLight(scene, lamp, Vec3d(0), false, surfaces);
    }
  }
}

// Hard cases for the bins' choice of frame and cells.
TEST_CASE("occluders of crowds that are hard to bin") {
  Random random(44);
  std::vector<Scene> scenes(6);
  for (int i = 0; i < 600; ++i) {
    const Vec3d inside = random.InBox(Vec3d(-1, -1, -6), Vec3d(1, 1, -4));
    // A cluster in a wide space; all at one point, or nearly; a plane; a line; all of these
    // together.
    scenes[0].spheres.push_back(MakeSphere(i % 100 == 0 ? inside * 1e6 : inside, 0.03));
    scenes[1].spheres.push_back(MakeSphere({0.5, 0.5, -5}, 1));
    scenes[2].spheres.push_back(MakeSphere({inside.x, -1, inside.z}, 0.1));
    scenes[3].spheres.push_back(MakeSphere({inside.x * 5, 0, -5}, 0.05));
    scenes[4].spheres.push_back(MakeSphere(inside * 1e-3, 1e-3 * random.Magnitude(1, 100)));
    scenes[5].spheres.push_back(MakeSphere(inside, i % 8 == 0 ? 1.5 : 1e-3));
  }
  scenes[0].spheres[7] = scenes[0].spheres[8] = MakeSphere({0, -1e9 - 3, 0}, 1e9);
  for (const Scene& scene : scenes) {
    std::vector<Ray> rays;
    for (const Sphere& sphere : scene.spheres) {
      rays.push_back({Vec3d(0), sphere.center + random.Direction() * sphere.radius * 0.9});
    }
    CHECK(CheckLights(scene, Vec3d(0), &random, rays) > 100);
  }
}

TEST_CASE("bins do not depend on the threads that make them") {
  Random random(45);
  Scene scene;
  for (int i = 0; i < 40000; ++i) {
    const double radius = i % 5000 == 0 ? 3 : random.Magnitude(0.01, 0.1);
    scene.spheres.push_back(MakeSphere(random.InBox({-5, -5, -15}, {5, 5, -5}), radius));
  }
  const TraceGeometry geometry = MakeTraceGeometry(scene, Vec3d(0));
  for (const Light& light : {SunAlong({1, -2, 0.5}), PointAt({0.3, 1, -9})}) {
    const ShadowLight target = MakeShadowLight(light, Vec3d(0));
    const LightBins one = BinForLight(geometry, target, 1000, 1);
    const LightBins two = BinForLight(geometry, target, 1000, 2);
    REQUIRE(one.entries() > scene.spheres.size());
    CHECK(one.end == two.end);
    CHECK(one.large == two.large);
    CHECK(one.large.size() >= 8);
    CHECK(std::equal(one.spheres.begin(), one.spheres.end(), two.spheres.begin()));
    // The purpose of bins: few spheres per cell.
    CHECK(one.mean_occupancy < 500);
  }
}

// As in a scene with glass: some rays go through the sphere that they start on, from points that do
// not face the light.
TEST_CASE("rays of one batch leave outward, inward and to either side") {
  Random random(63);
  size_t inward = 0;  // rays that their own sphere, or another one, occludes
  for (const unsigned count : {4u, 60u, 2000u}) {  // lists, and bins
    Scene scene = RandomSpheres(&random, count);
    scene.spheres[1] = scene.spheres[0];
    const Vec3d eye(0);
    const TraceGeometry geometry = MakeTraceGeometry(scene, eye);
    const auto surfaces = TraceSurfaces(Intersector(scene, eye), CameraRays(&random, 1500));
    for (const Light& light : {PointAt({1, 4, -2}), SunAlong({0.3, -1, 0.2})}) {
      const ShadowLight target = MakeShadowLight(light, eye);
      std::vector<ShadowRay> rays;
      for (const HitSurface& surface : surfaces) {
        const Vec3d to_light =
            target.positional ? target.position - surface.position : target.to_light;
        const Vec3d out = surface.position - geometry.spheres[surface.primitive].center;
        const bool known = rays.size() % 3 != 0;
        const double side = out.dot(to_light) > 0 ? kLeavesOutward : kLeavesInward;
        rays.push_back({{surface.position, to_light},
                        rays.size() % 7 == 0 ? 0
                        : target.positional  ? 1
                                             : kInfinity,  // 0: inactive
                        surface.primitive,
                        known ? side : kLeavesToEitherSide});
      }
      ForEachTarget([&](Target) {
        Intersector intersector(scene, eye);
        intersector.FindOccluders({&light}, true);
        const std::vector<bool> found = TraceShadows(intersector, rays, 0);
        CHECK(found == TraceShadows(intersector, rays));
        for (size_t i = 0; i < rays.size(); ++i) {
          INFO("ray " << i << " from " << rays[i].primitive);
          REQUIRE(found[i] == BruteForceOccluded(geometry, rays[i]));
          inward += rays[i].own_after == kLeavesInward && found[i] ? 1 : 0;
        }
      });
    }
  }
  CHECK(inward > 500);
}

TEST_CASE("the lists leave out what cannot be in the way") {
  Scene scene;
  scene.spheres = {MakeSphere({0, 0, -5}, 1), MakeSphere({0, 3, -5}, 0.5),
                   MakeSphere({0, -3, -5}, 0.5), MakeSphere({3, 3, -5}, 0.5)};
  const TraceGeometry geometry = MakeTraceGeometry(scene, Vec3d(0));
  const auto lists = [&](const Light& light, bool outward) {
    const OccluderLists found = ListOccluders(geometry, MakeShadowLight(light, Vec3d(0)), outward);
    std::vector<std::vector<uint32_t>> by_sphere;
    for (size_t i = 0; i < found.end.size(); ++i) {
      by_sphere.emplace_back(found.spheres.begin() + found.Begin(i),
                             found.spheres.begin() + found.end[i]);
    }
    return by_sphere;
  };
  using Lists = std::vector<std::vector<uint32_t>>;
  // From above; the lamp is between the upper sphere and the middle one.
  CHECK(lists(SunAlong({0, -1, 0}), true) == Lists{{1}, {}, {0, 1}, {}});
  CHECK(lists(SunAlong({0, -1, 0}), false) == Lists{{0, 1}, {1}, {0, 1, 2}, {3}});
  CHECK(lists(PointAt({0, 2, -5}), true) == Lists{{}, {}, {0}, {}});
  CHECK(lists(PointAt({0, 9, -5}), true) == Lists{{1}, {}, {0, 1}, {}});
}

// Of a camera that moves, bins are kept, unless it moves far.
TEST_CASE("bins of a camera that has moved are those of a new one") {
  Random random(57);
  const Scene scene = RandomSpheres(&random, 3000);
  const std::vector<Light> lights = {PointAt({1, 4, -2}), SunAlong({0.3, -1, 0.2})};
  const std::vector<Ray> camera_rays = CameraRays(&random, 600);
  ForEachTarget([&](Target) {
    Intersector moving(scene, Vec3d(0), {.tree = false});
    for (const Vec3d& eye : {Vec3d(0), Vec3d(0.3, 0.1, 0.5), Vec3d(-0.7, 0.4, 0), Vec3d(0, 0, 900),
                             Vec3d(0.2, 0, 0), Vec3d(0)}) {
      REQUIRE(moving.MoveTo(scene, eye));
      moving.ForgetOccluders();
      moving.FindOccluders({&lights[0], &lights[1]}, false);
      const Intersector fresh(scene, eye);
      const std::vector<HitSurface> surfaces = TraceSurfaces(fresh, camera_rays);
      for (uint32_t light = 0; light < 2; ++light) {
        const std::vector<ShadowRay> rays = RaysTo(lights[light], eye, surfaces);
        REQUIRE(moving.Occluders(light).bins);
        CHECK(TraceShadows(moving, rays, light) == TraceShadows(fresh, rays));
      }
    }
  });
}

// Spheres that leave, come near, grow around everything, shrink, and coincide with others or part.
TEST_CASE("bins of spheres that have changed are those of new ones") {
  Random random(59);
  Scene scene = RandomSpheres(&random, 3000);
  scene.spheres[5] = MakeSphere({-0.5, 0.3, -1}, 0.3);  // in view, and never changed
  scene.spheres[40] = scene.spheres[41] = MakeSphere({0.5, 0.3, -1}, 0.3);
  const std::vector<Light> lights = {PointAt({1, 4, -2}), SunAlong({0.3, -1, 0.2})};
  const std::vector<Ray> camera_rays = CameraRays(&random, 600);
  const Vec3d eye(0.2, 0.1, 0);
  Intersector changing(scene, eye, {.tree = false});
  changing.FindOccluders({&lights[0], &lights[1]}, false);
  size_t kept = 0, hits_on_5 = 0;
  const auto check = [&] {
    REQUIRE(changing.ChangeSpheres(scene, eye));
    changing.FindOccluders({&lights[0], &lights[1]}, false);
    const Intersector fresh(scene, eye);
    const std::vector<HitSurface> surfaces = TraceSurfaces(fresh, camera_rays);
    for (uint32_t light = 0; light < 2; ++light) {
      const std::vector<ShadowRay> rays = RaysTo(lights[light], eye, surfaces);
      REQUIRE(changing.Occluders(light).bins);
      kept += changing.Occluders(light).bins->changed.empty() ? 0 : 1;
      ForEachTarget([&](Target) {
        for (const bool outward : {false, true}) {
          CHECK(TraceShadows(changing, rays, light, outward) ==
                TraceShadows(fresh, rays, kAnyLight, outward));
        }
      });
    }
  };
  check();
  scene.spheres[7] = MakeSphere({0, 0, -3}, 1.5);
  check();
  scene.spheres[8] = scene.spheres[7];  // now they coincide, of which 7 has changed before
  check();
  scene.spheres[9] = scene.spheres[5];  // which has never changed, and is the one that is hit
  scene.spheres[7] = MakeSphere({1e4, 0, 0}, 2);
  check();
  for (const HitSurface& surface : TraceSurfaces(Intersector(scene, eye), camera_rays)) {
    hits_on_5 += surface.primitive == 5 ? 1 : 0;
  }
  CHECK(hits_on_5 > 5);
  scene.spheres[40].center.y += 0.1;  // it leaves the one that it coincided with
  scene.spheres[41].radius *= 5;
  check();
  for (int i = 0; i < 30; ++i) {  // more than rays are tested against one by one
    const auto k = static_cast<size_t>(random.Uniform(0, 3000));
    scene.spheres[k] =
        MakeSphere(random.InBox({-2, -2, -7}, {2, 2, 0.5}), random.Magnitude(0.01, 1));
    check();
  }
  CHECK(kept > 30);  // of both lights, but where there were too many
  scene.spheres.pop_back();
  CHECK_FALSE(changing.ChangeSpheres(scene, eye));
  scene.spheres.push_back(scene.spheres[0]);
  CHECK_FALSE(changing.ChangeSpheres(scene, Vec3d(0)));
  for (size_t i = 0; i < 100; ++i) scene.spheres[i].radius *= 2;
  CHECK_FALSE(changing.ChangeSpheres(scene, eye));
}

// A sphere that differs from another by a rounding that a camera further away does not see.
TEST_CASE("a changed sphere coincides with another once the camera has moved") {
  Random random(60);
  Scene scene = RandomSpheres(&random, 3000);
  scene.spheres[7] = scene.spheres[8] = MakeSphere({0.3, 0, -1}, 0.5);
  scene.spheres[8].radius = 0.4;
  const Light sun = SunAlong({0.3, -1, 0.2});
  Intersector changing(scene, Vec3d(0), {.tree = false});
  changing.FindOccluders({&sun}, false);
  scene.spheres[8] = MakeSphere({0.1 + 0.2, 0, -1}, 0.5);
  REQUIRE(scene.spheres[8].center != scene.spheres[7].center);
  REQUIRE(changing.ChangeSpheres(scene, Vec3d(0)));
  changing.FindOccluders({&sun}, false);
  const Vec3d eye(5, 0, 0.5);
  REQUIRE(scene.spheres[8].center - eye == scene.spheres[7].center - eye);
  REQUIRE(changing.MoveTo(scene, eye));
  changing.FindOccluders({&sun}, false);
  std::vector<Ray> rays(400);
  for (Ray& ray : rays) {
    ray.direction = scene.spheres[7].center + random.Direction() * 0.5 - eye;
  }
  const Intersector fresh(scene, eye);
  const std::vector<HitSurface> surfaces = TraceSurfaces(fresh, rays);
  const std::vector<ShadowRay> shadows = RaysTo(sun, eye, surfaces);
  size_t on_7 = 0;
  for (const HitSurface& surface : surfaces) on_7 += surface.primitive == 7 ? 1 : 0;
  CHECK(on_7 > 20);
  CHECK(TraceShadows(changing, shadows, 0) == TraceShadows(fresh, shadows));
}

TEST_CASE("bins of a camera that has moved are gone") {
  Random random(61);
  Scene scene = RandomSpheres(&random, 3000);
  CameraFrame frame;
  frame.projection = Projection::kPerspective;
  frame.forward = {0, 0, -1};
  frame.step_x = {0.01, 0, 0};
  frame.step_y = {0, -0.01, 0};
  frame.corner = frame.forward - (frame.step_x * 160 + frame.step_y * 96) / 2;
  Intersector moving(scene, Vec3d(0), {.tree = false});
  REQUIRE(moving.BinForCamera(frame, {0, 0, 160, 96}, 0.5));
  REQUIRE(moving.MoveTo(scene, {0.4, 0.1, 2}));
  scene.spheres[70].center.x += 0.3;
  REQUIRE(moving.ChangeSpheres(scene, {0.4, 0.1, 2}));
  REQUIRE(moving.BinForCamera(frame, {0, 0, 160, 96}, 0.5));
  TileCandidates candidates;
  CHECK(moving.EnterTile({64, 48, 80, 64}, TileRays::kAny, &candidates));
}

TEST_CASE("bins are those of the light that is asked for") {
  Random random(58);
  const Scene scene = RandomSpheres(&random, 3000);
  const Light before = PointAt({1, 4, -2}), now = PointAt({-3, 2, 1});
  Intersector changed(scene, Vec3d(0));
  changed.FindOccluders({&before}, false);
  changed.ForgetOccluders();
  changed.FindOccluders({&now}, false);
  const std::vector<HitSurface> surfaces = TraceSurfaces(changed, CameraRays(&random, 600));
  const std::vector<ShadowRay> rays = RaysTo(now, Vec3d(0), surfaces);
  CHECK(TraceShadows(changed, rays, 0) == TraceShadows(changed, rays));
}

}  // namespace
}  // namespace nacre
