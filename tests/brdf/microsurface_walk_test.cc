// SPDX-License-Identifier: Apache-2.0
// tests/brdf/microsurface_walk_test.cc: walks between microfacets against integrals of single
// reflections, and against the symmetry of interfaces.
#include "brdf/microsurface_walk.h"

#include <random>

#include "brdf/albedo_integral.h"
#include "catch.h"

namespace nacre {
namespace {

constexpr int kWalks = 40000;
// Four standard deviations of a fraction, which is at most half of 1 / sqrt(kWalks).
const double kNoise = 4 * 0.5 / std::sqrt(kWalks);

struct Numbers {
  std::mt19937_64 engine{1};
  double operator()() { return static_cast<double>(engine() >> 11) * 0x1p-53; }
};

Vec3d Downwards(double cosine) { return {std::sqrt((1 - cosine) * (1 + cosine)), 0, -cosine}; }

TEST_CASE("light that meets one microfacet is what the GGX lobe reflects") {
  for (const double roughness : {0.3, 0.5, 0.8, 1.0}) {
    for (const double cosine : {0.05, 0.3, 0.7, 1.0}) {
      Numbers random;
      int once = 0;
      for (int i = 0; i < kWalks; ++i) {
        int met = 0;
        double weight = 1;
        const auto count = [&](double) {
          ++met;
          return 1.0;
        };
        const Vec3d out =
            WalkOpaque(Downwards(cosine), AlphaFromRoughness(roughness), count, random, &weight);
        if (!(out.z > 0) || weight != 1) FAIL("light leaves upwards, and white keeps it");
        once += met == 1 ? 1 : 0;
      }
      CAPTURE(roughness, cosine);
      CHECK(static_cast<double>(once) / kWalks ==
            Approx(AlbedoOfOne(Shadowing::kHeightCorrelated, roughness, cosine)).margin(kNoise));
    }
  }
}

// The fraction of diffuse light that crosses a dielectric interface.
double Crossing(bool from_above, double eta, double roughness) {
  Numbers random;
  int crossed = 0;
  for (int i = 0; i < kWalks; ++i) {
    const Vec3d down = Downwards(std::sqrt(1 - random()));
    const MicrosurfaceExit exit = WalkDielectric(from_above ? down : -down, from_above, eta,
                                                 AlphaFromRoughness(roughness), random);
    if (exit.above != (exit.direction.z > 0)) FAIL("light leaves on the side that it says");
    crossed += exit.above != from_above ? 1 : 0;
  }
  return static_cast<double>(crossed) / kWalks;
}

// Radiance is n^2 times as large inside, and crosses an interface both ways alike.
TEST_CASE("diffuse light crosses an interface as much from above as n^2 times from below") {
  for (const double eta : {1.3, 1.6}) {
    for (const double roughness : {0.0, 0.3, 0.7, 1.0}) {
      CAPTURE(eta, roughness);
      const double below = Crossing(false, eta, roughness);
      CHECK(Crossing(true, eta, roughness) == Approx(eta * eta * below).margin(4 * kNoise));
    }
    CHECK(Crossing(true, eta, 0) == Approx(1 - AverageDielectric(eta)).margin(kNoise));
    // Rough interfaces let more of it through.
    CHECK(Crossing(true, eta, 1) > Crossing(true, eta, 0) + kNoise);
  }
}

}  // namespace
}  // namespace nacre
