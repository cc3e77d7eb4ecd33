// SPDX-License-Identifier: Apache-2.0
// tests/render/light_cull_test.cc: lights that are left out reach nothing, and many are.
#include "render/light_cull.h"

#include <cmath>
#include <cstring>
#include <random>

#include "catch.h"
#include "render/render.h"

namespace nacre {
namespace {

class Uniform {
 public:
  explicit Uniform(uint32_t seed) : random_(seed) {}
  double operator()(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random_);
  }
  Vec3d Direction() { return Vec3d((*this)(-1, 1), (*this)(-1, 1), (*this)(-1, 1)).normalized(); }

 private:
  std::mt19937 random_;
};

Light RandomLight(Uniform* uniform, int i) {
  Light light;
  light.name = "light " + std::to_string(i);
  const Vec3d position = uniform->Direction() * std::pow(10, (*uniform)(-2, 1));
  if (i % 3 == 0) {
    light.kind = DirectionalLight{uniform->Direction(), {1, 1, 1}};
  } else if (i % 3 == 1) {
    light.kind = PointLight{position, {1, 1, 1}, {}};
  } else {
    SpotLight spot;
    spot.position = position;
    spot.direction_of_travel = uniform->Direction();
    spot.cutoff_deg = spot.inner_deg = std::pow(10, (*uniform)(-1, std::log10(180)));
    light.kind = spot;
  }
  return light;
}

// What decides in the end: n.l > 0 and cos a > cos cutoff.
bool Reaches(const LightGeometry& light, const Vec3d& position, const Vec3d& normal) {
  const Vec3d to_light =
      light.positional ? (light.position - position).normalized() : light.position;
  if (normal.dot(to_light) <= 0) return false;
  return !(light.cos_cutoff >= -1) || -to_light.dot(light.axis) > light.cos_cutoff;
}

TEST_CASE("a culled light reaches no hit") {
  Uniform uniform(51);
  HitBatch hits;
  HitDirections directions;
  size_t culled = 0, dark = 0;
  for (int round = 0; round < 3000; ++round) {
    // A patch of a sphere.
    hits.count = 1 + static_cast<size_t>(uniform(0, 40));
    const Vec3d middle = uniform.Direction();
    const double patch = std::pow(10, uniform(-3, 0.5));
    for (size_t i = 0; i < hits.count; ++i) {
      const Vec3d normal = (middle + uniform.Direction() * patch).normalized();
      hits.position.x[i] = normal.x * 1.5;
      hits.position.y[i] = normal.y * 1.5;
      hits.position.z[i] = normal.z * 1.5;
      directions.normal.x[i] = static_cast<float>(normal.x);
      directions.normal.y[i] = static_cast<float>(normal.y);
      directions.normal.z[i] = static_cast<float>(normal.z);
    }
    const BatchBounds bounds = BoundHits(hits, directions);
    const LightGeometry light = GeometryOf(RandomLight(&uniform, round), Vec3d(0));
    bool any = false;
    for (size_t i = 0; i < hits.count; ++i) {
      const Vec3d position(hits.position.x[i], hits.position.y[i], hits.position.z[i]);
      const Vec3d normal(directions.normal.x[i], directions.normal.y[i], directions.normal.z[i]);
      any = any || Reaches(light, position, normal);
    }
    const bool may = MayIlluminate(light, bounds);
    CAPTURE(round);
    CHECK((may || !any));
    culled += may ? 0 : 1;
    dark += any ? 0 : 1;
  }
  // And most that reach none are found.
  CHECK(dark > 1000);
  CHECK(culled > dark * 7 / 10);
}

TEST_CASE("culling lights changes no bit") {
  Uniform uniform(52);
  for (int round = 0; round < 6; ++round) {
    Scene scene;
    scene.image.width = 150;
    scene.image.height = 100;
    scene.image.spp = round % 2 == 0 ? 1 : 5;
    scene.materials.emplace_back().model = LambertMaterial{};
    scene.materials.emplace_back().model = MetallicRoughnessMaterial{};
    scene.spheres.push_back({{0, -101, 0}, 100, {1}});
    for (int i = 0; i < 12; ++i) {
      scene.spheres.push_back({uniform.Direction() * 2, uniform(0.1, 0.8), {i % 2 == 0 ? 0u : 1u}});
    }
    for (int i = 0; i < 40; ++i) scene.lights.push_back(RandomLight(&uniform, i));
    RenderSettings settings;
    settings.layers = {"light.light 2", "diffuse"};
    RenderStats stats;
    const Image culled = RenderImage(scene, settings, &stats);
    CHECK(stats.culled_lights > stats.light_batches / 10);
    settings.general_path = true;
    const Image all = RenderImage(scene, settings, &stats);
    CHECK(stats.culled_lights == 0);
    REQUIRE(culled.channels.size() == all.channels.size());
    for (size_t i = 0; i < culled.channels.size(); ++i) {
      const std::vector<float>& a = culled.channels[i].samples;
      const std::vector<float>& b = all.channels[i].samples;
      CHECK(std::memcmp(a.data(), b.data(), a.size() * sizeof(float)) == 0);
    }
  }
}

}  // namespace
}  // namespace nacre
