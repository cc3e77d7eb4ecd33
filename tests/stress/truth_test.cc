// SPDX-License-Identifier: Apache-2.0
// tests/stress/truth_test.cc: the truth itself: against numbers known on paper and against the
// textbook's quadratic in 113 bits.
#include "stress/truth.h"

#include <cmath>

#include "catch.h"
#include "quad.h"
#include "stress/truth_reflect.h"

namespace nacre {
namespace {

Scene OneSphere(const Vec3d& center, double radius) {
  Scene scene;
  scene.image.width = scene.image.height = 65;
  scene.camera.position = {0, 0, 0};
  scene.camera.look_at = {0, 0, -1};
  scene.materials.emplace_back().model = LambertMaterial{{0.5, 0.25, 1}};
  scene.spheres = {{center, radius, {0}}};
  return scene;
}

Light MakeLight(const Vec3d& position) {
  return {.name = "key", .kind = PointLight{.position = position, .intensity = {8, 8, 8}}};
}

const TruthPixel& Center(const TruthPicture& picture) { return picture.pixels[32 * 65 + 32]; }

TEST_CASE("a lambertian sphere seen and lit along its axis") {
  Scene scene = OneSphere({0, 0, -5}, 1);
  scene.lights = {MakeLight({0, 0, -2})};
  const TruthPixel pixel = Center(RenderTruth(scene));
  CHECK(pixel.object == 1);
  CHECK(pixel.depth == 4);
  CHECK(pixel.normal == Vec3d(0, 0, 1));
  CHECK(pixel.doubt == kCertain);
  CHECK(pixel.radiance.x == Approx(0.5 / M_PI * 8 / 4).epsilon(1e-15));
  CHECK(pixel.radiance.z == Approx(1.0 / M_PI * 8 / 4).epsilon(1e-15));
  CHECK(pixel.scale == pixel.radiance);
  // Something between: dark; beyond the light: not.
  scene.spheres.push_back({{0.2, 0, -3}, 0.25, {0}});
  scene.camera.position = {-3, 0, -1};
  scene.camera.look_at = {0, 0, -4};
  CHECK(Center(RenderTruth(scene)).radiance == Rgb(0, 0, 0));
  scene.spheres[1].center.z = -1.5;
  CHECK(Center(RenderTruth(scene)).radiance.x > 0.3);
}

TEST_CASE("lobes at their peaks") {
  const TruthVec n(0, 0, 1);
  Material material{.model = PhongMaterial{.ks = {1, 1, 1}, .shininess = 1e6}};
  CHECK(static_cast<double>(ReflectTruth(material, n, n, n).specular.x) ==
        Approx((1e6 + 2) / (2 * M_PI)).epsilon(1e-15));
  material.model =
      MetallicRoughnessMaterial{.base_color = {1, 1, 1}, .metallic = 1, .roughness = 0.01};
  // D = 1 / (pi alpha^2), G = 1, F = 1.
  CHECK(static_cast<double>(ReflectTruth(material, n, n, n).specular.x) ==
        Approx(1 / (4 * M_PI * 1e-8)).epsilon(1e-14));
  CHECK(ReflectTruth(material, n, -n, n).specular == TruthVec(0, 0, 0));
  // Half of the peak of Blinn's lobe: cos^n = 1/2.
  material.model = PhongMaterial{.model = PhongModel::kBlinnPhong,
                                 .convention = PhongConvention::kClassic,
                                 .ks = {1, 1, 1},
                                 .shininess = 1e4};
  const TruthReal angle = 2 * std::acos(std::exp2(TruthReal{-1e-4L}));
  const TruthVec l(std::sin(angle), 0, std::cos(angle));
  CHECK(static_cast<double>(ReflectTruth(material, n, l, n).specular.x) ==
        Approx(0.5).epsilon(1e-13));
}

// The normal where the ray of pixel (x, y) meets the sphere, and whether it does.
bool QuadNormal(const Scene& scene, int x, int y, double normal[3]) {
  const Sphere& sphere = scene.spheres[0];
  const long double degree = std::acos(-1.0L) / 180;
  const Quad pixel = 2 * std::tan(scene.camera.fov_y_deg * degree / 2) / scene.image.height;
  const Quad d[3] = {(x - 32) * pixel, (32 - y) * pixel, -1};
  Quad b = 0, dd = 0, mm = 0;
  for (int i = 0; i < 3; ++i) {
    const Quad m = sphere.center[i];
    b += m * d[i];
    dd += d[i] * d[i];
    mm += m * m;
  }
  const Quad r = sphere.radius;
  const Quad discriminant = b * b - dd * (mm - r * r);
  if (discriminant < 0) return false;
  Quad root = std::sqrt(static_cast<long double>(discriminant));
  if (root > 0) root = (root + discriminant / root) / 2;
  for (int i = 0; i < 3; ++i) {
    normal[i] =
        static_cast<double>(((b - root) / dd * d[i] - static_cast<Quad>(sphere.center[i])) / r);
  }
  return true;
}

TEST_CASE("normals and hits at any distance are those of 113 bits") {
  for (const double distance : {2.0, 1e3, 1e5, 1e7}) {
    Scene scene = OneSphere({0.1 * distance / 3, -0.2 * distance / 7, -distance}, 1);
    // Aimed by field of view alone would be too coarse: the sphere is brought to the middle.
    scene.spheres[0].center = {0.3, -0.2, -distance};
    scene.camera.fov_y_deg = 3.2 / distance * 180 / M_PI;
    const TruthPicture picture = RenderTruth(scene);
    double worst = 0;
    size_t wrong = 0, hits = 0;
    for (int y = 0; y < 65; ++y) {
      for (int x = 0; x < 65; ++x) {
        const TruthPixel& pixel = picture.pixels[static_cast<size_t>(y * 65 + x)];
        double normal[3] = {};
        const bool hit = QuadNormal(scene, x, y, normal);
        if (pixel.doubt != kCertain) continue;
        wrong += hit != (pixel.object == 1);
        if (!hit) continue;
        ++hits;
        for (int i = 0; i < 3; ++i) worst = std::max(worst, std::abs(normal[i] - pixel.normal[i]));
      }
    }
    CAPTURE(distance, worst);
    CHECK(wrong == 0);
    CHECK(hits > 800);
    // 64 bits at 1e7 radii: 5e-13, over the cosine at the limb.
    CHECK(worst < 1e-10);
  }
}

TEST_CASE("what lies on an edge is doubtful") {
  // The middle ray touches the sphere: radius 3 about (3, 0, -4), seen along -z.
  Scene scene = OneSphere({3, 0, -4}, 3);
  CHECK(Center(RenderTruth(scene)).doubt == kLimb);
  // Two spheres that meet in one depth.
  scene = OneSphere({0, 0, -4}, 1);
  scene.spheres.push_back({{0, 0, -5}, 2, {0}});
  CHECK(Center(RenderTruth(scene)).doubt == kDepth);
  // Equal spheres are not in doubt: the first one is hit.
  scene.spheres[1] = scene.spheres[0];
  CHECK(Center(RenderTruth(scene)).doubt == kCertain);
  CHECK(Center(RenderTruth(scene)).object == 1);
  // Light along the tangent plane; a shadow's edge.
  scene = OneSphere({0, 0, -4}, 1);
  scene.lights = {MakeLight({5, 0, -3})};
  CHECK(Center(RenderTruth(scene)).doubt == kTerminator);
  scene.lights = {MakeLight({0, 4, -1})};
  CHECK(Center(RenderTruth(scene)).doubt == kCertain);
  // From (0, 0, -3) to the light runs the direction (0, 4, 2): the middle is (0, 2, -2).
  const double side = std::sqrt(5.0) / 4;
  scene.spheres.push_back({{side, 2, -2}, side, {0}});
  CHECK(Center(RenderTruth(scene)).doubt == kShadowEdge);
}

}  // namespace
}  // namespace nacre
