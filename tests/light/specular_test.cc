// SPDX-License-Identifier: Apache-2.0
// tests/light/specular_test.cc: GGX reflections of area lights by multiple importance sampling of
// lights and lobes, against the table: samplers, pdfs and BRDF together.
#include <cmath>

#include "brdf/lobe_sampling.h"
#include "catch.h"
#include "light/disk_light.h"
#include "light/rectangle_light.h"
#include "light/sphere_light.h"
#include "sampling/hash.h"
#include "sampling/sobol.h"
#include "tables.h"

namespace nacre {
namespace {

constexpr int kPatterns = 32;        // independent estimates, for their standard deviation
constexpr uint32_t kSamples = 1024;  // of each kind in each

struct Scene {
  Vec3d n, v;
  double alpha;
};

// BRDF n.l over the sum of both pdfs (balance heuristic: Veach and Guibas 1995), Fresnel's
// term being 1.
template <class Light>
double Contribution(const Scene& scene, const Light& light, const Vec3d& l) {
  const Angles<double> a = ComputeAngles(scene.n, l, scene.v);
  if (!(a.n_dot_l > 0)) return 0;
  const double brdf = GgxDistribution(a, scene.alpha) *
                      VisibilityHeightCorrelated(a.n_dot_l, a.n_dot_v, scene.alpha);
  return brdf * a.n_dot_l / (LightPdf(light, l) + GgxVisiblePdf(a, scene.alpha));
}

template <class Light>
double Estimate(const Scene& scene, const Light& light, uint64_t seed) {
  double sum = 0;
  for (uint32_t i = 0; i < kSamples; ++i) {
    const Vec2d at_light = SobolSample2D(i, 0, seed), at_lobe = SobolSample2D(i, 1, seed);
    const AreaSample<double> sample = SampleLight(light, at_light.x, at_light.y);
    if (sample.inverse_pdf > 0) sum += Contribution(scene, light, sample.to_light);
    const Vec3d l = SampleGgxVisible(scene.n, scene.v, scene.alpha, at_lobe.x, at_lobe.y);
    if (LightPdf(light, l) > 0) sum += Contribution(scene, light, l);
  }
  return sum / kSamples;
}

// Checks that the mean of all patterns is within 4 standard deviations of the reference, and that
// these are small. Returns the relative standard deviation.
template <class Light>
double CheckRow(const Scene& scene, const Light& light, double reference) {
  double sum = 0, squares = 0;
  for (int pattern = 0; pattern < kPatterns; ++pattern) {
    const double estimate = Estimate(scene, light, Mix64(static_cast<uint64_t>(pattern) + 1));
    sum += estimate;
    squares += estimate * estimate;
  }
  const double mean = sum / kPatterns;
  const double variance = (squares / kPatterns - mean * mean) / (kPatterns - 1);
  // A sum of squares minus the square of its mean has a relative resolution of 1e-8.
  const double sigma = std::sqrt(std::max(variance, 0.0)) + 1e-8 * reference;
  CAPTURE(mean, reference, sigma);
  CHECK(std::abs(mean - reference) <= 4 * sigma);
  CHECK(sigma <= 1.5e-2 * reference);  // a lobe that meets a corner of its light
  return sigma / reference;
}

TEST_CASE("sampled reflections of area lights are those of the table", "[table]") {
  const nlohmann::json table = LoadTable("area_light_specular");
  size_t rows = 0, precise = 0;
  for (const auto& row : table.at("rows")) {
    const std::string id = row["id"], kind = row["kind"];
    const double roughness = row["roughness"].get<double>();
    CAPTURE(id, kind, roughness);
    const Scene scene{TableVector(row["n"]).normalized(), TableVector(row["v"]).normalized(),
                      AlphaFromRoughness(roughness)};
    const Vec3d offset = TableVector(row["center"]) - TableVector(row["x"]);
    const double reference = TableNumber(row["L_spec_F1"]);
    double sigma = 0;
    if (kind == "sphere") {
      sigma = CheckRow(scene, SphereLight<double>{offset, row["radius"].get<double>()}, reference);
    } else if (kind == "rect") {
      const Vec3d u = TableVector(row["half_u"]), v = TableVector(row["half_v"]);
      sigma = CheckRow(scene, RectangleLight<double>{offset - u - v, u * 2, v * 2}, reference);
    } else {
      sigma = CheckRow(scene,
                       DiskLight<double>{offset, TableVector(row["axis"]).normalized(),
                                         row["radius"].get<double>()},
                       reference);
    }
    ++rows;
    precise += sigma <= 1e-3;
  }
  // Most rows can tell a wrong value from noise.
  CHECK(precise * 6 >= rows * 5);
  CHECK(rows > 0);
}

}  // namespace
}  // namespace nacre
