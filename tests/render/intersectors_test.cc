// SPDX-License-Identifier: Apache-2.0
// tests/render/intersectors_test.cc: however camera rays find spheres, the picture's bits are the
// same: random scenes that are hard to bin, and every scene that ships.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <random>

#include "base/error.h"
#include "pictures.h"
#include "render/camera.h"
#include "render/render.h"
#include "shipped_scenes.h"
#include "targets.h"
#include "visibility/intersector.h"

namespace nacre {
namespace {

void CheckSame(const Scene& scene, RenderSettings settings) {
  settings.layers = {"N", "P", "Z", "id.object"};
  settings.intersector = IntersectorChoice::kEmbree;
  const Image embree = RenderImage(scene, settings);
  settings.intersector = IntersectorChoice::kTiles;
  const Image tiles = RenderImage(scene, settings);
  CHECK(SameBits(embree, tiles));
  settings.intersector = IntersectorChoice::kShells;
  CHECK(SameBits(RenderImage(scene, settings), tiles));
  settings.intersector = IntersectorChoice::kEmbree;
  settings.general_path = true;
  CHECK(SameBits(RenderImage(scene, settings), tiles));
}

// Spheres of all sizes around the camera: before, beside, behind and around it.
Scene RandomScene(uint32_t seed) {
  std::mt19937 random(seed);
  const auto uniform = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  Scene scene;
  scene.materials.emplace_back().model = LambertMaterial{};
  Light sun;
  sun.name = "sun";
  sun.shadows = seed % 2 == 0;
  sun.kind = DirectionalLight{.direction_of_travel = {1, -2, -3}, .irradiance = {1, 1, 1}};
  // Over the camera's shoulder; in, on or between the spheres.
  Light lamp;
  lamp.name = "lamp";
  lamp.kind = PointLight{.position = {uniform(-4, 4), uniform(-4, 4), uniform(-20, 5)},
                         .intensity = {9, 9, 9},
                         .attenuation = {1, 0, 0.01}};
  scene.lights = {sun, lamp};
  scene.background = Rgb(0.1, 0.2, 0.3);
  scene.camera.position = Vec3d(uniform(-1, 1), uniform(-1, 1), uniform(-1, 1));
  scene.camera.look_at = Vec3d(uniform(-5, 5), uniform(-5, 5), -10);
  scene.camera.fov_y_deg = seed % 3 == 0 ? 150 : 40;
  if (seed % 4 == 1) {
    scene.camera.projection = Projection::kOrthographic;
    scene.camera.height = 6;
  }
  for (int i = 0; i < 60; ++i) {
    const double radius = std::pow(10.0, uniform(-3, i % 20 == 0 ? 2 : 0));
    const Vec3d center(uniform(-8, 8), uniform(-8, 8), uniform(-25, 5));
    scene.spheres.push_back({center, radius, {0}});
    if (i % 10 == 0) scene.spheres.push_back({center, radius, {0}});  // the lower id is hit
  }
  const FilterKind kinds[] = {FilterKind::kBox, FilterKind::kGaussian, FilterKind::kMitchell};
  scene.image.filter = {kinds[seed % 3], seed % 3 == 0 ? 1.0 : 4.0};
  scene.image.spp = seed % 2 == 0 ? 1 : 5;
  scene.image.width = 101;
  scene.image.height = 67;
  return scene;
}

TEST_CASE("tiles and Embree give the same bits, whatever the scene") {
  ForEachTarget([](Target) {
    for (uint32_t seed = 0; seed < 24; ++seed) {
      CAPTURE(seed);
      RenderSettings settings;
      const int tile_sizes[] = {0, 7, 16, 40};
      settings.tile_size = tile_sizes[seed % 4];
      if (seed % 5 == 2) settings.region = {21, 19, 90, 60};
      CheckSame(RandomScene(seed), settings);
    }
  });
}

// Without its correction the closest point is off by up to 4 roundings of 1e6 radii, which shows in
// the last place of one normal in a hundred.
TEST_CASE("tiles and Embree give the same bits of spheres far away") {
  ForEachTarget([](Target) {
    Scene scene = RandomScene(2);
    scene.spheres = {{{0.3, 0.1, 0}, 1, {0}}, {{-0.9, -0.4, 1}, 0.2, {0}}};
    scene.camera.position = Vec3d(1.1e5, 2.2e5, 9.7e5);
    scene.camera.look_at = Vec3d(0, 0, 0);
    scene.camera.fov_y_deg = 1.5e-4;
    CheckSame(scene, {});
  });
}

// Through spheres, behind them and in them; some of their triangles touch a sphere, or pass through
// the points where rays hit one.
void AddMeshes(uint32_t seed, Scene* scene) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (int i = 0; i < 5; ++i) {
    Mesh mesh{.material = {0}};
    for (int k = 0; k < 8; ++k) {
      const Sphere& sphere = scene->spheres[static_cast<size_t>(7 * i + k)];
      const Vec3d side = Vec3d{uniform(random), uniform(random), uniform(random)}.normalized();
      const Vec3d at = k % 2 == 0 ? sphere.center + side * sphere.radius : sphere.center;
      const double size = std::pow(10, uniform(random)) * sphere.radius;
      for (int corner = 0; corner < 3; ++corner) {
        Vec3d offset{uniform(random), uniform(random), uniform(random)};
        if (k % 4 == 0) offset -= side * side.dot(offset);
        mesh.triangles.push_back(static_cast<uint32_t>(mesh.positions.size()));
        mesh.positions.push_back(at + offset * size);
      }
    }
    scene->meshes.push_back(mesh);
  }
}

TEST_CASE("spheres by tiles and triangles by Embree give the bits of Embree alone") {
  ForEachTarget([](Target) {
    for (uint32_t seed = 0; seed < 24; ++seed) {
      CAPTURE(seed);
      Scene scene = RandomScene(seed);
      AddMeshes(seed, &scene);
      RenderSettings settings;
      const int tile_sizes[] = {0, 7, 16, 40};
      settings.tile_size = tile_sizes[seed % 4];
      if (seed % 5 == 2) settings.region = {21, 19, 90, 60};
      if (seed % 7 == 3) settings.max_error = 0.2;
      CheckSame(scene, settings);
    }
  });
}

// A quad right before, in and right behind the front of a sphere that the ray to it grazes or meets
// in the middle: depths that are equal to the last digits.
TEST_CASE("of a sphere and a triangle at one depth the sphere is hit") {
  Scene scene = RandomScene(2);
  scene.spheres = {{{0, 0, -5}, 1, {0}}};
  scene.camera = Camera{};
  scene.camera.position = Vec3d(0);
  scene.camera.look_at = Vec3d(0, 0, -1);
  scene.camera.fov_y_deg = 1e-6;
  scene.image.spp = 16;
  int spheres = 0, triangles = 0;
  for (int step = -8; step <= 8; ++step) {
    Mesh quad{.material = {0}};
    const double z = -4 + step * 0x1p-51;
    quad.positions = {{-2, -2, z}, {2, -2, z}, {2, 2, z}, {-2, 2, z}};
    quad.triangles = {0, 1, 2, 0, 2, 3};
    scene.meshes = {quad};
    CheckSame(scene, {});
    const Image image = RenderImage(scene, {.layers = {"id.object"}});
    for (const float id : image.Find("id.object")->samples) ++(id == 1 ? spheres : triangles);
  }
  CHECK(spheres > 1000);
  CHECK(triangles > 1000);
}

// More spheres than lists are made for, some of them large, and lights among them.
TEST_CASE("bins for shadow rays give the same bits as Embree") {
  ForEachTarget([](Target) {
    for (uint32_t seed = 0; seed < 8; ++seed) {
      CAPTURE(seed);
      Scene scene = RandomScene(seed);
      std::mt19937 random(seed);
      std::uniform_real_distribution<double> uniform(-1, 1);
      for (int i = 0; i < 2000; ++i) {
        const Vec3d center(8 * uniform(random), 8 * uniform(random), 15 * uniform(random) - 10);
        scene.spheres.push_back({center, 0.2 * std::pow(10, uniform(random) - 1), {0}});
      }
      if (seed % 2 == 1) scene.spheres.push_back({{0, -1e6 - 9, 0}, 1e6, {0}});
      Light spot;
      spot.name = "spot";
      spot.kind = SpotLight{.position = {2, 3, -4}, .direction_of_travel = {-0.2, -1, -0.5}};
      scene.lights.push_back(spot);
      for (Light& light : scene.lights) light.shadows = true;
      CheckSame(scene, RenderSettings{.threads = static_cast<int>(seed % 3)});
      for (const LightShadows& light : MakePlan(scene, {}).direct.shadows.punctual) {
        CHECK(light.occluders != kAnyLight);
      }
    }
  });
}

// Small spheres in a wide space, so that the camera is outside all, and few hide others.
TEST_CASE("spheres that nothing can shadow need no shadow rays") {
  int some = 0;
  int none = 0;
  for (uint32_t seed = 0; seed < 60; ++seed) {
    CAPTURE(seed);
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> uniform(-1, 1);
    Scene scene = RandomScene(4);
    scene.spheres.clear();
    const int count = 2 + static_cast<int>(seed % 7);
    for (int i = 0; i < count; ++i) {
      const Vec3d center(3 * uniform(random), 3 * uniform(random), -12 + 4 * uniform(random));
      scene.spheres.push_back({center, std::pow(10.0, uniform(random) - 0.5), {0}});
    }
    // Touching, nested and equal ones; then lights close by, in and between them.
    const Sphere& first = scene.spheres[0];
    if (seed % 5 == 0) scene.spheres[1] = {first.center, first.radius * 0.5, {0}};
    if (seed % 5 == 1) scene.spheres[1] = first;
    const Vec3d side = Vec3d{uniform(random), uniform(random), uniform(random)}.normalized();
    if (seed % 5 == 2)
      scene.spheres[1] = {first.center + side * (2 * first.radius), first.radius, {0}};
    scene.camera = Camera{};
    scene.camera.position = Vec3d(0);
    scene.camera.look_at = Vec3d(0, 0, -1);
    Light point;
    point.name = "point";
    const double distance = std::pow(10.0, 3 * uniform(random));
    point.kind = PointLight{.position = first.center + side * (first.radius * (1 + distance)),
                            .intensity = {9, 9, 9},
                            .attenuation = Attenuation::None()};
    scene.lights.push_back(point);
    RenderSettings general{.general_path = true};
    CHECK(SameBits(RenderImage(scene, {}), RenderImage(scene, general)));
    for (const LightShadows& light : MakePlan(scene, {}).direct.shadows.punctual) {
      some += light.rays && !light.shadowed.empty();
      none += !light.rays;
    }
  }
  CHECK(some > 20);
  CHECK(none > 5);
}

TEST_CASE("the eye on a sphere, in one, and behind all of them") {
  Scene scene = RandomScene(2);
  for (const Sphere& sphere :
       {Sphere{{0, 0, -1}, 1, {0}}, Sphere{{0, 0, 0}, 3, {0}}, Sphere{{0, 0, 5}, 1, {0}},
        Sphere{{0, -1e6, 0}, 1e6 - 1e-3, {0}}, Sphere{{2, 0, 0}, 1.9, {0}}}) {
    scene.spheres = {sphere};
    scene.camera.position = Vec3d(0);
    scene.camera.look_at = Vec3d(0, 0, -1);
    CheckSame(scene, {});
  }
}

TEST_CASE("every scene that ships has the same bits with a tree alone") {
  ForEachShippedScene([](const Scene& scene) {
    const Image expected = RenderImage(scene, {});
    for (const auto choice : {IntersectorChoice::kEmbree, IntersectorChoice::kShells}) {
      CHECK(SameBits(RenderImage(scene, {.intersector = choice}), expected));
    }
  });
}

TEST_CASE("a tree is there where it is needed, and only there") {
  const auto uses = [](const Scene& scene, const RenderSettings& settings) {
    const FramePlan plan = MakePlan(scene, settings);
    bool tree = false;
    for (const PlanItem& item : plan.why.items) {
      if (item.what == "intersector tree") tree = item.used;
    }
    return std::pair(plan.hits.trace.by_bins, tree);
  };
  Scene scene = RandomScene(0);
  CHECK(uses(scene, {}) == std::pair(true, false));
  RenderSettings general{.general_path = true};
  CHECK(uses(scene, general) == std::pair(true, true));  // for shadows
  scene.image.shadows = false;
  CHECK(uses(scene, general) == std::pair(true, false));
  RenderSettings forced{.intersector = IntersectorChoice::kEmbree};
  CHECK(uses(scene, forced) == std::pair(false, true));
  Mesh triangle{
      .positions = {{0, 0, -3}, {1, 0, -3}, {0, 1, -3}}, .triangles = {0, 1, 2}, .material = {0}};
  scene.meshes = {triangle};
  CHECK(uses(scene, {}) == std::pair(true, true));
  CHECK(uses(scene, forced) == std::pair(false, true));
  scene.spheres.clear();
  CHECK(uses(scene, {}) == std::pair(false, true));
  forced.intersector = IntersectorChoice::kTiles;
  CHECK(uses(scene, forced) == std::pair(false, true));
}

// Adaptive sampling's batches may end within a row of the cell; behind them lies what the one
// before left there.
// Along the first light's rays all spheres lie in one cell of its bins, where a tree is better;
// each light is planned by its own bins.
TEST_CASE("a light that needs a tree for its shadow rays leaves the others their bins") {
  Scene scene;
  scene.camera.position = {0, 0, 40};
  scene.materials = {Material{}};
  for (int i = 0; i < 2500; ++i) scene.spheres.push_back({{3.0 * i, 0, 0}, 1, {0}});
  Light along, across;
  along.kind = DirectionalLight{{-1, 0, 0}, {1, 1, 1}};
  across.kind = DirectionalLight{{0, -1, 0}, {1, 1, 1}};
  for (const bool first : {true, false}) {
    scene.lights = first ? std::vector{along, across} : std::vector{across, along};
    const FramePlan plan = MakePlan(scene, {});
    REQUIRE(plan.direct.lights.punctual.size() == 2);
    CHECK(plan.direct.shadows.punctual[first ? 0 : 1].occluders == kAnyLight);
    CHECK(plan.direct.shadows.punctual[first ? 1 : 0].occluders != kAnyLight);
  }
}

TEST_CASE("a tile's hits are of the batch's own rays, wherever it ends") {
  for (const Projection projection : {Projection::kPerspective, Projection::kOrthographic}) {
    Scene scene = OneSphere(LambertMaterial{}, 16);
    scene.camera.projection = projection;
    // One beside it and one behind it.
    scene.spheres.push_back(scene.spheres[0]);
    scene.spheres[1].center.x += 2.5 * scene.spheres[0].radius;
    scene.spheres.push_back(scene.spheres[0]);
    scene.spheres[2].center.z -= 4 * scene.spheres[0].radius;
    Intersector intersector(scene, scene.camera.position);
    const Window cell{0, 0, 16, 16};
    REQUIRE(intersector.BinForCamera(MakeCameraFrame(scene.camera, 16, 16), cell, 0.5));
    TileCandidates candidates;
    REQUIRE(intersector.EnterTile(cell, TileRays::kAny, &candidates));
    REQUIRE(candidates.cells[0].size() > 1);
    FilmBatch film;
    std::fill(film.x.begin(), film.x.end(), 8.0);
    std::fill(film.y.begin(), film.y.end(), 8.0);
    HitBatch hits;
    HitDirections directions;
    ForEachTarget([&](Target) {
      for (film.count = 1; film.count <= 40; ++film.count) {
        intersector.HitsInTile(candidates, film, {&hits, &directions, false});
        CAPTURE(film.count);
        CHECK(hits.count == film.count);
      }
    });
  }
}

// The primitives that the rays through the middles of a tile's pixels hit.
std::vector<uint32_t> HitsOf(const Intersector& intersector, const Window& tile) {
  TileCandidates candidates;
  REQUIRE(intersector.EnterTile(tile, TileRays::kSamples, &candidates));
  FilmBatch film;
  for (int y = tile.y0; y < tile.y1; ++y) {
    for (int x = tile.x0; x < tile.x1; ++x) {
      film.x[film.count] = x + 0.5;
      film.y[film.count++] = y + 0.5;
    }
  }
  film.pixels = film.count;
  HitBatch hits;
  HitDirections directions;
  intersector.HitsInTile(candidates, film, {&hits, &directions, false});
  return {hits.primitive.begin(), hits.primitive.begin() + hits.count};
}

// Which the general path, which samples all, does not.
TEST_CASE("a narrow tile leaves the next one nothing of a tile whose pixels are not all sampled") {
  // Tiles are 16, 16 and 4 pixels wide. Of the first row of them one sphere covers the last and
  // half of the one before; of the second row another one covers the first.
  Scene scene = OneSphere(LambertMaterial{}, 32, 16);
  scene.image.width = 36;
  scene.camera.position = {0, 0, 100};
  scene.camera.look_at = {0, 0, 0};
  scene.camera.fov_y_deg = 2 * std::atan(16 / 100.0) * 180 / M_PI;  // a pixel is 1 wide at z = 0
  const MaterialId material = scene.spheres[0].material;
  scene.spheres = {{{44.0 - 18, 16.0 - 8, 0}, 20, material}, {{-18, 16.0 - 24, 0}, 20, material}};
  RenderSettings settings{.threads = 1};
  const Image image = RenderImage(scene, settings);
  settings.general_path = true;
  const Image expected = RenderImage(scene, settings);
  for (const char* channel : {"R", "G", "B", "A"}) {
    CHECK(image.Find(channel)->samples == expected.Find(channel)->samples);
  }
}

// So small and many that each row has spheres of its own, and spans tell nothing.
TEST_CASE("a tile that begins within a cell hits what the cell's own rows do") {
  for (const Projection projection : {Projection::kPerspective, Projection::kOrthographic}) {
    Scene scene = OneSphere(LambertMaterial{}, 16);
    scene.camera.projection = projection;
    const Sphere whole = scene.spheres[0];
    scene.spheres.clear();
    for (int i = 0; i < 256; ++i) {
      const Vec3d place(i % 16 / 8.0 - 0.94, i / 16 / 8.0 - 0.94, 0);
      scene.spheres.push_back(
          {whole.center + place * whole.radius, 0.05 * whole.radius, whole.material});
    }
    Intersector intersector(scene, scene.camera.position);
    REQUIRE(intersector.BinForCamera(MakeCameraFrame(scene.camera, 16, 16), {0, 0, 16, 16}, 0.5));
    ForEachTarget([&](Target) {
      const std::vector<uint32_t> all = HitsOf(intersector, {0, 0, 16, 16});
      CHECK(all.size() > 50);  // not in vain
      std::vector<uint32_t> halves = HitsOf(intersector, {0, 0, 16, 5});
      const std::vector<uint32_t> lower = HitsOf(intersector, {0, 5, 16, 16});
      halves.insert(halves.end(), lower.begin(), lower.end());
      CHECK(halves == all);
    });
  }
}

}  // namespace
}  // namespace nacre
