// SPDX-License-Identifier: Apache-2.0
// tests/visibility/projected_sphere_test.cc: the ray-sphere test in the film plane, against
// quadruple precision, and in all kernels that use it.
#include "visibility/projected_sphere_test.h"

#include <cmath>
#include <limits>

#include "catch.h"
#include "tables.h"
#include "targets.h"
#include "visibility/quad_hits.h"
#include "visibility/rays.h"

namespace nacre {
namespace {

constexpr int kFilmWidth = 256, kFilmHeight = kCellSize;

// A perspective camera at the origin with a random orientation; `tangent` is that of the angle
// between its axis and its corners.
CameraFrame FrameOf(double tangent, Random* random) {
  CameraFrame frame;
  frame.projection = Projection::kPerspective;
  frame.forward = random->Direction();
  const Vec3d right = frame.forward.cross(random->Direction()).normalized();
  const double pixel = 2 * tangent / std::hypot(kFilmWidth, kFilmHeight);
  frame.step_x = right * pixel;
  frame.step_y = frame.forward.cross(right) * pixel;
  frame.corner = frame.forward - (frame.step_x * kFilmWidth + frame.step_y * kFilmHeight) / 2;
  return frame;
}

// The direction through a random point of the film; most points are near its corners.
Vec3d DirectionThrough(const CameraFrame& frame, Random* random) {
  const auto coordinate = [&](int size) {
    const double v = random->Uniform(-1, 1);
    return size * (1 - std::copysign(1 - v * v, v)) / 2;
  };
  return frame.corner + frame.step_x * coordinate(kFilmWidth) +
         frame.step_y * coordinate(kFilmHeight);
}

// A sphere of radius 1 at a distance, whose centre the ray misses by `offset`.
TraceSphere SphereBeside(const Vec3d& direction, double distance, double offset, Random* random) {
  const Vec3d along = direction.normalized();
  const Vec3d across = along.cross(random->Direction()).normalized();
  return {along * std::sqrt(distance * distance - offset * offset) + across * offset, 1};
}

// The bounds of the test of TestSphere (ray_sphere_test.cc), and two more. The discriminant may err
// by 8 u of |direction|^2, of which the square of a rounded root takes 1.5; for grazing rays the
// error of the normal is its square root, 3e-8. The error of a normal's length is that of the
// direction to the viewer plus its own roundings: 8, as where hits are refined.
TEST_CASE("hits by the projected test are right at any distance, grazing ones too") {
  const Products products = GENERATE(Products::kFused, Products::kRounded);
  const double tangent = GENERATE(1e-3, 0.3, 1.0);
  constexpr double kMaxNormalError = 3e-8;
  constexpr double kMaxDepthError = 64 * kHalfUlpDouble;
  constexpr double kMaxSteepError = 16 * kHalfUlpDouble;
  Random random(1);
  const CameraFrame frame = FrameOf(tangent, &random);
  for (const double distance : {1.5, 4.0, 1e2, 1e4, 1e6, 4e6}) {
    double worst_normal = 0, worst_depth = 0, worst_steep = 0, worst_length = 0;
    double worst_discriminant = 0;
    int wrong = 0;
    for (int i = 0; i < 30000; ++i) {
      const Vec3d direction = DirectionThrough(frame, &random);
      const double side = i % 2 == 0 ? 1 : -1;
      const double offset =
          i % 3 != 0 ? 1 + side * random.Magnitude(1e-12, 1e-2) : random.Uniform(0, 1.2);
      const TraceSphere sphere = SphereBeside(direction, distance, offset, &random);
      if (!IsInFront(sphere, frame.forward)) continue;
      const QuadHit expected = TestInQuad(Vec3d(0), direction, sphere);
      const ProjectedHit hit =
          TestProjected(MakeProjectedSphere(sphere, frame.forward), direction, products);
      wrong += hit.hit != expected.hit;
      if (!hit.hit || !expected.hit) continue;
      worst_discriminant =
          std::max(worst_discriminant,
                   std::abs(hit.root * hit.root / direction.length2() - expected.discriminant));
      const double inverse_length = 1 / direction.length();
      const Vec3d normal =
          ProjectedNormal(hit, -direction * inverse_length, inverse_length, products);
      const double error = AngleTo(expected.normal, normal);
      worst_normal = std::max(worst_normal, error);
      if (offset < 0.7) worst_steep = std::max(worst_steep, error);
      worst_length = std::max(worst_length, std::abs(normal.length() - 1));
      const double depth = ProjectedDepth(hit, sphere, direction, products);
      worst_depth = std::max(worst_depth, std::abs(depth - expected.t) / expected.t);
    }
    CAPTURE(static_cast<int>(products), tangent, distance, worst_depth);
    CHECK(wrong == 0);
    CHECK(worst_discriminant <= 8 * kHalfUlpDouble);
    CHECK(worst_normal > 0);
    CHECK(worst_normal <= kMaxNormalError);
    CHECK(worst_steep <= kMaxSteepError);
    CHECK(worst_length <= 8 * kHalfUlpDouble);
    // The depth's error is, for a short chord, that of the chord, relative to the radius; and near
    // the sphere's front, that of |centre|^2 - radius^2.
    CHECK(worst_depth <= kMaxDepthError + kMaxNormalError / distance);
  }
}

TEST_CASE(
    "the projected test is for large spheres in front of the camera, in views that are not wide") {
  Random random(2);
  const CameraFrame frame = FrameOf(0.5, &random);
  const ProjectedTestView view = MakeProjectedTestView(frame);
  const double pixel = frame.step_x.length();
  const auto sphere_at = [&](double depth, double radius) {
    return TraceSphere{frame.forward * depth, radius};
  };
  CHECK(UsesProjectedTest(sphere_at(10, 10 * 8.01 * pixel), view));
  CHECK_FALSE(UsesProjectedTest(sphere_at(10, 10 * 7.99 * pixel), view));
  CHECK(UsesProjectedTest(sphere_at(10, 9.999), view));
  CHECK_FALSE(UsesProjectedTest(sphere_at(10, 10), view));  // touches the plane of the eye
  CHECK_FALSE(UsesProjectedTest(sphere_at(-10, 1), view));  // behind
  CHECK_FALSE(UsesProjectedTest(sphere_at(0, 100), view));  // around
  CHECK_FALSE(UsesProjectedTest(sphere_at(10, 9), ProjectedTestView()));
  for (const double tangent : {0.999, 1.001}) {
    const CameraFrame wide = FrameOf(tangent, &random);
    CHECK(UsesProjectedTest({wide.forward * 10, 9}, MakeProjectedTestView(wide)) == (tangent < 1));
  }
  CameraFrame orthographic = frame;
  orthographic.projection = Projection::kOrthographic;
  CHECK_FALSE(UsesProjectedTest(sphere_at(10, 9), MakeProjectedTestView(orthographic)));
  // From a telescope even the farthest has many pixels.
  const CameraFrame narrow = FrameOf(1e-6, &random);
  CHECK(UsesProjectedTest({narrow.forward * 0x1p21, 1}, MakeProjectedTestView(narrow)));
  CHECK_FALSE(UsesProjectedTest({narrow.forward * 0x1p23, 1}, MakeProjectedTestView(narrow)));
}

// By the operations of MakeCameraRays.
Vec3d DirectionAt(const CameraFrame& frame, double x, double y) {
  const Products products = TargetProducts();
  Vec3d direction;
  for (int c = 0; c < 3; ++c) {
    direction[c] =
        MulAdd(frame.step_y[c], y, MulAdd(frame.step_x[c], x, frame.corner[c], products), products);
  }
  return direction;
}

struct Nearest {
  uint32_t primitive = kNoPrimitive;
  double t = std::numeric_limits<double>::infinity();
  Vec3d normal{0, 0, 0};
};

// By the scalar twins.
Nearest NearestOf(const TraceGeometry& geometry, const ProjectedTestView& view,
                  const Vec3d& direction) {
  const Products products = TargetProducts();
  Nearest nearest;
  for (uint32_t i = 0; i < geometry.SphereCount(); ++i) {
    const TraceSphere& sphere = geometry.spheres[i];
    if (UsesProjectedTest(sphere, view)) {
      const ProjectedHit hit =
          TestProjected(MakeProjectedSphere(sphere, view.forward), direction, products);
      const double t = ProjectedDepth(hit, sphere, direction, products);
      if (!hit.hit || !(t < nearest.t)) continue;
      const double inverse_length = 1 / direction.length();
      nearest = {i, t, ProjectedNormal(hit, -direction * inverse_length, inverse_length, products)};
    } else {
      const auto hit = TestSphere(sphere.center, direction, sphere.radius, products);
      if (!hit.hit || !(hit.t < nearest.t)) continue;
      nearest = {i, hit.t, CenterToHit(hit, direction, products) / sphere.radius};
    }
  }
  return nearest;
}

// What rays may hit: a single sphere, one or several of a few, or one of many nested spheres.
enum class Before { kSingle, kSeveral, kNested };

Scene NestedBefore(const CameraFrame& frame, Random* random) {
  Scene scene;
  const double distance = random->Magnitude(2, 1e3);
  const double radius = distance * random->Uniform(9, 60) * frame.step_x.length();
  const Vec3d center = (frame.corner + frame.step_x * random->Uniform(0, kFilmWidth) +
                        frame.step_y * random->Uniform(0, kFilmHeight)) *
                       distance;
  const double apart = random->Magnitude(1e-16, 0.1) * radius;
  for (int i = 0; i < 200; ++i) {
    scene.spheres.push_back(MakeSphere(center + random->InBox(Vec3d(-apart), Vec3d(apart)),
                                       radius + (i % 2 == 0 ? apart * random->Uniform(-1, 1) : 0)));
  }
  return scene;
}

Scene SpheresBefore(const CameraFrame& frame, Before what, Random* random) {
  if (what == Before::kNested) return NestedBefore(frame, random);
  Scene scene;
  for (int i = 0; i < (what == Before::kSingle ? 1 : 8); ++i) {
    const double distance = random->Magnitude(2, 1e3);
    const double size = (i == 7 ? 2 : random->Uniform(9, 60)) * frame.step_x.length();
    const Vec3d at = frame.corner + frame.step_x * random->Uniform(0, kFilmWidth) +
                     frame.step_y * random->Uniform(0, kFilmHeight);
    scene.spheres.push_back(MakeSphere(at * distance, distance * size));
  }
  return scene;
}

// The kernels' inverse length, within 2 ulp, enters their normals twice, by up to 2 radii along the
// ray.
constexpr double kNormalSlack = 2 * 2 * 2 * 2 * kHalfUlpDouble;

// The film's left half, in one batch.
const Window kTile{0, 0, kBatchCapacity / kFilmHeight, kFilmHeight};

FilmBatch CentersOfTile() {
  FilmBatch film;
  film.count = film.pixels = kTile.pixel_count();
  for (size_t i = 0; i < film.count; ++i) {
    film.x[i] = static_cast<double>(i % static_cast<size_t>(kTile.width())) + 0.5;
    film.y[i] = static_cast<double>(i / static_cast<size_t>(kTile.width())) + 0.5;
  }
  return film;
}

// The tile's hits; none if it has no candidates.
void HitTile(const CameraFrame& frame, const FilmBatch& film, Intersector* intersector,
             HitBatch* hits) {
  hits->count = 0;
  REQUIRE(intersector->BinForCamera(frame, {0, 0, kFilmWidth, kFilmHeight}, 0));
  TileCandidates candidates;
  if (!intersector->EnterTile(kTile, TileRays::kSamples, &candidates)) return;
  HitDirections rounded;
  intersector->HitsInTile(candidates, film, {hits, &rounded, true});
}

TEST_CASE("tiles hit what the scalar twins hit, on every target") {
  const Before what = GENERATE(Before::kSeveral, Before::kSingle, Before::kNested);
  ForEachTarget([&](Target) {
    Random random(3);
    const FilmBatch film = CentersOfTile();
    HitBatch hits;
    int hits_on_film = 0;
    for (int round = 0; round < 40; ++round) {
      const CameraFrame frame = FrameOf(random.Magnitude(1e-3, 1), &random);
      const ProjectedTestView view = MakeProjectedTestView(frame);
      const Scene scene = SpheresBefore(frame, what, &random);
      const TraceGeometry geometry = MakeTraceGeometry(scene, Vec3d(0));
      Intersector intersector(scene, Vec3d(0), {.tree = false});
      HitTile(frame, film, &intersector, &hits);
      size_t next = 0;
      for (size_t i = 0; i < film.count; ++i) {
        const Nearest expected =
            NearestOf(geometry, view, DirectionAt(frame, film.x[i], film.y[i]));
        const bool hit = next < hits.count && hits.ray[next] == i;
        REQUIRE(hit == (expected.primitive != kNoPrimitive));
        if (!hit) continue;
        REQUIRE(hits.primitive[next] == expected.primitive);
        REQUIRE((At(hits.normal, next) - expected.normal).length() <= kNormalSlack);
        hits_on_film += UsesProjectedTest(geometry.spheres[expected.primitive], view) ? 1 : 0;
        ++next;
      }
      REQUIRE(next == hits.count);
    }
    CHECK(hits_on_film > 1000);
  });
}

// In double, because pictures in float would not show a difference between the two tests.
TEST_CASE("camera rays by Embree have all bits of the tiles' hits, on every target") {
  const Before what = GENERATE(Before::kSeveral, Before::kSingle, Before::kNested);
  ForEachTarget([&](Target) {
    Random random(4);
    const FilmBatch film = CentersOfTile();
    HitBatch by_tiles, by_embree;
    HitDirections rounded;
    ClosestHits closest;
    for (int round = 0; round < 20; ++round) {
      const CameraFrame frame = FrameOf(random.Magnitude(1e-3, 1), &random);
      const Scene scene = SpheresBefore(frame, what, &random);
      Intersector intersector(scene, Vec3d(0));
      REQUIRE(intersector.SpheresAreNested() == (what == Before::kNested));
      HitTile(frame, film, &intersector, &by_tiles);
      RayBatch rays;
      rays.count = film.count;
      rays.view = MakeProjectedTestView(frame);
      for (size_t i = 0; i < film.count; ++i) {
        SetRay({Vec3d(0), DirectionAt(frame, film.x[i], film.y[i])}, i, &rays);
      }
      intersector.Closest(rays, &closest);
      std::vector<uint32_t> found;
      for (uint32_t i = 0; i < rays.count; ++i) {
        if (closest.primitive[i] != kNoPrimitive) found.push_back(i);
      }
      REQUIRE(found.size() == by_tiles.count);
      intersector.Refine(rays, closest, found.data(), found.size(), {&by_embree, &rounded, true});
      for (size_t i = 0; i < found.size(); ++i) {
        const uint32_t ray = found[i], primitive = by_embree.primitive[i];
        REQUIRE(by_tiles.ray[i] == ray);
        REQUIRE(by_tiles.primitive[i] == primitive);
        REQUIRE(At(by_tiles.normal, i) == At(by_embree.normal, i));
        REQUIRE(At(by_tiles.to_view, i) == At(by_embree.to_view, i));
        REQUIRE(At(by_tiles.position, i) == At(by_embree.position, i));
        const double t = closest.t[ray];
        REQUIRE(intersector.SphereIsFirst(primitive, rays, ray, t));
        REQUIRE_FALSE(intersector.SphereIsFirst(primitive, rays, ray, std::nextafter(t, 0)));
      }
    }
  });
}

}  // namespace
}  // namespace nacre
