// SPDX-License-Identifier: Apache-2.0
// tests/visibility/shell_tree_test.cc: nested spheres: the tree of shells skips no test that could
// hit, for any rays and for spheres however near together.
#include "visibility/shell_tree.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include "catch.h"
#include "targets.h"
#include "visibility/rays.h"

namespace nacre {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr int kNested = 300;  // more than are tested one by one

// Spheres that overlap largely, of about the same radius or of any.
struct NestedScene {
  const char* name;
  std::function<Sphere(int, Random*)> sphere;  // about the origin, of radius 1 or less
};

const std::vector<NestedScene>& NestedScenes() {
  const auto near_unit = [](double spread) {
    return [spread](int, Random* random) {
      return MakeSphere(random->InBox(Vec3d(-spread), Vec3d(spread)),
                        1 + random->Uniform(-spread, spread));
    };
  };
  static const std::vector<NestedScene> kScenes = {
      {"concentric", [](int i, Random*) { return MakeSphere(Vec3d(0), (i + 1.0) / kNested); }},
      {"all sizes",
       [](int i, Random* random) {
         const double radius = i % 4 == 0 ? random->Magnitude(1e-3, 1) : random->Uniform(0.7, 1);
         return MakeSphere(random->Direction() * ((1 - radius) * random->Uniform(0, 1)), radius);
       }},
      {"touching in a point",
       [](int i, Random*) {
         return MakeSphere({(i + 1.0) / kNested, 0, 0}, (i + 1.0) / kNested);
       }},
      {"coincident",
       [](int, Random*) {
         return MakeSphere({0.1, 0.2, -0.3}, 1);
       }},
      {"some of them coincident",
       [](int i, Random*) {
         return MakeSphere({i % 3 * 0.1, 0, 0}, 1 + i % 2 * 0.1);
       }},
      {"overlapping", near_unit(0.1)},
      {"a millionth apart", near_unit(1e-6)},
      {"nearer than margins", near_unit(1e-12)},
      {"a few roundings apart", near_unit(4e-16)}};
  return kScenes;
}

Scene MakeScene(const NestedScene& kind, const Vec3d& center, double radius, Random* random) {
  Scene scene;
  for (int i = 0; i < kNested; ++i) {
    Sphere sphere = kind.sphere(i, random);
    sphere.center = center + sphere.center * radius;
    sphere.radius *= radius;
    scene.spheres.push_back(sphere);
  }
  // What is near and does not belong to them; and the ground, far larger than they.
  for (int i = 0; i < 20; ++i) {
    scene.spheres.push_back(
        MakeSphere(center + random->Direction() * (radius * 1.2), radius * 0.1));
  }
  scene.spheres.push_back(MakeSphere(center - Vec3d(0, 1001 * radius, 0), 1000 * radius));
  std::shuffle(scene.spheres.begin(), scene.spheres.end(), random->engine());
  return scene;
}

// Where rays may start: outside, far away, in all, between them, and on one of them.
std::vector<Vec3d> EyesAround(const Scene& scene, const Vec3d& center, double radius,
                              Random* random) {
  const Sphere& some = scene.spheres[17];
  return {center + random->Direction() * (3 * radius),
          center + random->Direction() * (1e5 * radius),
          center + random->Direction() * (1e-4 * radius),
          center + random->Direction() * (random->Uniform(0.1, 1.1) * radius),
          some.center + random->Direction() * some.radius};
}

// Rays that aim at all spheres, past them, and at the silhouettes of some.
std::vector<Ray> RaysAmong(const Scene& scene, const Vec3d& eye, size_t count, Random* random) {
  std::vector<Ray> rays(count);
  for (size_t i = 0; i < count; ++i) {
    const Sphere& sphere = scene.spheres[i % scene.spheres.size()];
    const Vec3d to_center = sphere.center - eye;
    Vec3d side = random->Direction();
    if (i % 2 == 0) side = side.cross(to_center).normalized();  // its rim, if that is far away
    rays[i].direction = (to_center + side * sphere.radius) * random->Magnitude(1e-3, 1e3);
    if (i % 5 == 0) rays[i].direction = random->Direction();
  }
  return rays;
}

TEST_CASE("closest hits among spheres within one another are brute force's") {
  const double radius = GENERATE(1.0, 1e-9, 1e9);
  for (const NestedScene& kind : NestedScenes()) {
    CAPTURE(kind.name, radius);
    Random random(71);
    const Vec3d center = Vec3d(3, -2, 5) * radius;
    const Scene scene = MakeScene(kind, center, radius, &random);
    for (const Vec3d& eye : EyesAround(scene, center, radius, &random)) {
      const TraceGeometry geometry = MakeTraceGeometry(scene, eye);
      REQUIRE_FALSE(geometry.shells.empty());
      const std::vector<Ray> rays = RaysAmong(scene, eye, 150, &random);
      ForEachTarget([&](Target) {
        const Intersector intersector(scene, eye);
        REQUIRE(intersector.SpheresAreNested());
        const std::vector<Hit> hits = Trace(intersector, rays);
        for (size_t i = 0; i < rays.size(); ++i) {
          INFO("ray " << i);
          REQUIRE(hits[i] == BruteForce(geometry, rays[i]));
        }
      });
    }
  }
}

// Shadow rays from all of the spheres' surfaces, hidden ones too, with the eye elsewhere.
TEST_CASE("shadow rays among spheres within one another are brute force's") {
  const double radius = GENERATE(1.0, 1e-9, 1e9);
  for (const NestedScene& kind : NestedScenes()) {
    CAPTURE(kind.name, radius);
    Random random(72);
    const Vec3d center = Vec3d(3, -2, 5) * radius;
    const Scene scene = MakeScene(kind, center, radius, &random);
    for (const Vec3d& eye : EyesAround(scene, center, radius, &random)) {
      const TraceGeometry geometry = MakeTraceGeometry(scene, eye);
      std::vector<ShadowRay> rays;
      for (uint32_t i = 0; i < 200; ++i) {
        const uint32_t start = i % geometry.SphereCount();
        const TraceSphere& sphere = geometry.spheres[start];
        const Vec3d origin = sphere.center + random.Direction() * sphere.radius;
        const Vec3d light = center - eye + random.Direction() * (radius * random.Uniform(0, 4));
        ShadowRay ray{{origin, light - origin}, 1, start};
        if (i % 3 == 0) ray = {{origin, random.Direction()}, kInfinity, start};
        if (i % 7 == 0) ray.t_max = 0;
        rays.push_back(ray);
      }
      const bool outward = eye == center;
      ForEachTarget([&](Target) {
        const Intersector intersector(scene, eye);
        for (const bool leaves : {outward, !outward}) {
          const std::vector<bool> occluded = TraceShadows(intersector, rays, kAnyLight, leaves);
          for (size_t i = 0; i < rays.size(); ++i) {
            INFO("ray " << i);
            REQUIRE(occluded[i] == BruteForceOccluded(geometry, rays[i], 0, leaves));
          }
        }
      });
    }
  }
}

// A light's own sphere does not block it; others at the same place do.
TEST_CASE("coincident spheres block a light that one of them is, and not one that all are") {
  Scene scene;
  for (int i = 0; i < kNested; ++i) scene.spheres.push_back(MakeSphere({0, 0, -5}, 1));
  scene.spheres.push_back(MakeSphere({0, 0, 5}, 1));
  ForEachTarget([&](Target) {
    const Intersector intersector(scene, Vec3d(0));
    REQUIRE(intersector.SpheresAreNested());
    ShadowRayBatch batch;
    batch.count = 1;
    SetRay({{0, 0, 4}, {0, 0, -1}}, 0, &batch);
    batch.t_max[0] = 8.5;
    batch.primitive[0] = kNested;
    batch.own_after[0] = kLeavesToEitherSide;
    const auto is_blocked = [&](const PrimitiveRange& light) {
      batch.target = light;
      intersector.Occluded(&batch);
      return batch.occluded[0] != 0;
    };
    CHECK(is_blocked({}));
    CHECK(is_blocked({0, 1}));
    CHECK(is_blocked({kNested - 1, kNested}));
    CHECK(is_blocked({7, 8}));
    CHECK_FALSE(is_blocked({0, kNested}));
  });
}

HugeArray<TraceSphere> SpheresOf(const Scene& scene) {
  return std::move(MakeTraceGeometry(scene, Vec3d(0)).spheres);
}

// Checks a node and those below it, and marks their members; returns the number of levels.
int CheckNode(const HugeArray<TraceSphere>& spheres, const ShellTree& tree, const ShellNode& node,
              std::vector<uint8_t>* found) {
  if (node.count == 0) {
    int depth = 0;
    for (uint32_t child : {node.first, node.first + 1}) {
      depth = std::max(depth, CheckNode(spheres, tree, tree.nodes[child], found));
    }
    return depth + 1;
  }
  for (uint32_t i = node.first; i < node.first + node.count; ++i) {
    const ShellMember& member = tree.members[i];
    REQUIRE(member.lowest <= member.highest);
    REQUIRE(Coincide(spheres[member.lowest], spheres[member.highest]));
    for (uint32_t k = member.lowest; k <= member.highest; ++k) {
      if (Coincide(spheres[k], spheres[member.lowest])) (*found)[k] = 1;
    }
    const auto& [center, radius] = spheres[member.lowest];
    const double off = (center - node.shell.center).length();
    CHECK(radius - off >= node.shell.inner);
    CHECK(radius + off <= node.shell.outer);
  }
  return 1;
}

TEST_CASE("every sphere is in one leaf of a tree that is not deep") {
  Random random(73);
  std::vector<Scene> scenes;
  for (const NestedScene& kind : NestedScenes()) {
    scenes.push_back(MakeScene(kind, Vec3d(1, 2, 3), 1, &random));
  }
  Scene& halves = scenes.emplace_back();  // each split in the middle takes off one
  for (int i = 0; i < 2000; ++i) {
    halves.spheres.push_back(MakeSphere(Vec3d(0), std::ldexp(1.0, -i / 2)));
    halves.spheres.push_back(MakeSphere(Vec3d(0), 1 + random.Uniform(0, 1)));
  }
  Scene& few = scenes.emplace_back();
  few.spheres = {MakeSphere({0, 0, -2}, 1)};
  for (const Scene& scene : scenes) {
    const HugeArray<TraceSphere> spheres = SpheresOf(scene);
    const ShellTree tree = BuildShellTree(spheres);
    std::vector<uint8_t> found(spheres.size());
    CHECK(CheckNode(spheres, tree, tree.nodes.front(), &found) <= kMaxShellDepth);
    CHECK(tree.nodes.size() <= 2 * spheres.size());
    CHECK(std::count(found.begin(), found.end(), 0) == 0);
  }
  CHECK(BuildShellTree({}).empty());
}

TEST_CASE("a pile of spheres is found, wherever in the scene it is told of") {
  Random random(74);
  Scene scene;
  for (int i = 0; i < 200'000; ++i) {
    scene.spheres.push_back(MakeSphere(random.InBox(Vec3d(-50), Vec3d(50)), 0.5));
  }
  CHECK_FALSE(AreNested(SpheresOf(scene)));
  const auto with_pile = [&](size_t first, size_t step, int count) {
    Scene piled = scene;
    for (int i = 0; i < count; ++i) {
      Sphere& sphere =
          piled.spheres[(first + static_cast<size_t>(i) * step) % piled.spheres.size()];
      sphere = MakeSphere({1, 1, 1}, random.Uniform(0.5, 1));
    }
    return AreNested(SpheresOf(piled));
  };
  CHECK(with_pile(0, 1, 4000));
  CHECK(with_pile(196'000, 1, 4000));
  for (const size_t step : {25u, 48u, 49u, 50u}) CHECK(with_pile(3, step, 4000));
  CHECK_FALSE(with_pile(0, 1, 50));
}

TEST_CASE("spheres side by side, of all sizes or few are not a pile") {
  Random random(75);
  Scene row, ground, few, crossing;
  for (int i = 0; i < 5000; ++i) {
    row.spheres.push_back(MakeSphere({i % 70 * 2.0, i / 70 * 2.0, 0}, 1));  // they touch
    ground.spheres.push_back(MakeSphere(random.InBox({-9, 0, -9}, {9, 2, 9}), 0.05));
    crossing.spheres.push_back(MakeSphere(random.InBox(Vec3d(-9), Vec3d(9)), 1));
  }
  ground.spheres.push_back(MakeSphere({0, -1000, 0}, 1000));
  ground.spheres.push_back(MakeSphere({0, 0, 0}, 2000));  // around all
  for (int i = 0; i < 127; ++i) few.spheres.push_back(MakeSphere(Vec3d(0), 1 + i * 0.1));
  for (const Scene* scene : {&row, &ground, &few, &crossing})
    CHECK_FALSE(AreNested(SpheresOf(*scene)));
  few.spheres.push_back(MakeSphere(Vec3d(0), 1));
  CHECK(AreNested(SpheresOf(few)));
}

}  // namespace
}  // namespace nacre
