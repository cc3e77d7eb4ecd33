// SPDX-License-Identifier: Apache-2.0
// tests/brdf/open_pbr_test.cc: OpenPBR's own terms against figures computed elsewhere in double
// precision from the specification's text, and against their limits.
#include "brdf/open_pbr.h"

#include <cmath>

#include "catch.h"

namespace nacre {
namespace {

TEST_CASE("specular_weight scales the reflectance at normal incidence by changing the index") {
  for (const double eta : {0.5, 0.8, 1.0, 1.2, 1.5, 3.0}) {
    for (const double weight : {0.0, 0.25, 0.5, 1.0, 2.0}) {
      CAPTURE(eta, weight);
      const double f0 = std::min(weight * FresnelF0(eta, 0.0), kMostWeightedReflectance);
      const double index = WeightedIndex(eta, weight);
      CHECK(FresnelF0(index, 0.0) == Approx(f0).epsilon(1e-12));
      if (weight > 0) CHECK((index > 1) == (eta > 1));
    }
    CHECK(WeightedIndex(eta, 1.0) == Approx(eta).epsilon(1e-14));
  }
  // The reflectance stays below 1, where the index has no limit.
  CHECK(std::isfinite(WeightedIndex(1.5, 1e6)));
  CHECK(FresnelF0(WeightedIndex(1.5, 1e6), 0.0) == Approx(kMostWeightedReflectance));
  // Weight 0.5 at index 1.5, at four cosines.
  const double index = WeightedIndex(1.5, 0.5);
  const auto at = [&](double cosine) { return FresnelDielectric(cosine, 1 - cosine, index); };
  CHECK(at(1) == Approx(0.0200).margin(5e-5));
  CHECK(at(0.5) == Approx(0.0590).margin(5e-5));
  CHECK(at(0.2) == Approx(0.2969).margin(5e-5));
  CHECK(at(0.05) == Approx(0.7317).margin(5e-5));
}

TEST_CASE("a coated dielectric reflects as in air and as in the coat, by the coat's share") {
  const CoatedDielectric<double> half{
      .eta = 1.5, .coat = 0.5, .eta_in_coat = 1.5 / 1.6, .inverse_coat_eta = 1 / 1.6};
  CoatedDielectric<double> none = half, whole = half;
  none.coat = 0;
  whole.coat = 1;
  for (double cosine = 0; cosine <= 1; cosine += 0.0625) {
    CAPTURE(cosine);
    const double in_air = FresnelDielectric(cosine, 1 - cosine, 1.5);
    const double in_coat = FresnelCoatedDielectric(cosine, 1 - cosine, whole);
    CHECK(FresnelCoatedDielectric(cosine, 1 - cosine, none) == in_air);
    CHECK(FresnelCoatedDielectric(cosine, 1 - cosine, half) ==
          Approx((in_air + in_coat) / 2).epsilon(1e-14));
    // The coat is denser than the base, but light that it has refracted is never reflected totally.
    CHECK(in_coat < 0.2);
  }
  // A coat that is thinner than air reflects grazing light itself: none is left for the base.
  const CoatedDielectric<double> below_thin{
      .eta = 1.5, .coat = 1, .eta_in_coat = 1.5 / 0.8, .inverse_coat_eta = 1 / 0.8};
  CHECK(FresnelCoatedDielectric(0.1, 0.9, below_thin) == 0);
  CHECK(FresnelCoatedDielectric(1.0, 0.0, below_thin) ==
        Approx(FresnelF0(1.5 / 0.8, 0.0)).epsilon(1e-14));
}

TEST_CASE("roughness below a rough coat by three rules") {
  struct Row {
    double base, coat, index, spec, adobe, fit;
  };
  for (const Row& row : {Row{0, 0.3, 1.6, 0.3568, 0.2348, 0.2583},
                         {0.2, 0.3, 1.6, 0.3653, 0.2610, 0.3036},
                         {0.2, 0.3, 1.0, 0.3653, 0.2000, 0.1999},
                         {0.3, 0, 1.6, 0.3000, 0.3000, 0.3777},
                         {0.6, 0.6, 1.6, 0.7896, 0.6497, 0.7338}}) {
    CAPTURE(row.base, row.coat, row.index);
    CHECK(RoughnessBelowCoat(row.base, row.coat, 2.0) == Approx(row.spec).margin(5.1e-5));
    CHECK(RoughnessBelowCoat(row.base, row.coat, 1 - 1 / row.index) ==
          Approx(row.adobe).margin(5.1e-5));
    CHECK(FittedRoughnessBelowCoat(row.base, row.coat, row.index) ==
          Approx(row.fit).margin(5.1e-5));
  }
  CHECK(RoughnessBelowCoat(1.0, 1.0, 2.0) == 1);
  CHECK(FittedRoughnessBelowCoat(1.0, 1.0, 3.0) < std::sqrt(0.85));
}

TEST_CASE("a coat darkens a base of albedo 1/2 by what it reflects back to it") {
  struct Row {
    double index, average, rough, darkening, smooth;
  };
  for (const Row& row : {Row{1.3, 0.06113, 0.4445, 0.7143, 0.9914},
                         {1.5, 0.09178, 0.5963, 0.5751, 0.9796},
                         {1.6, 0.10625, 0.6509, 0.5176, 0.9726}}) {
    CAPTURE(row.index);
    const double average = AverageDielectric(row.index);
    CHECK(average == Approx(row.average).margin(5.1e-6));
    const double rough = InternalDiffuseReflectance(average, row.index);
    CHECK(rough == Approx(row.rough).margin(5.1e-5));
    CHECK(CoatDarkeningFactor(0.5, rough) == Approx(row.darkening).margin(5.1e-5));
    CHECK(CoatDarkeningFactor(0.5, FresnelF0(row.index, 0.0)) == Approx(row.smooth).margin(5.1e-5));
    CHECK(CoatDarkeningFactor(1.0, rough) == 1);  // a white base loses nothing
  }
  // Below a coat that lets nothing through.
  CHECK(CoatDarkeningFactor(1.0, 1.0) == 1);
  CHECK(CoatDarkeningFactor(0.5, 1.0) == 0);
}

TEST_CASE("a coat absorbs along the paths that it refracts") {
  const double n = 1.6;
  CHECK(CoatCrossing(0.2, RefractedCosine(1.0, 1 / n)) == Approx(std::sqrt(0.2)).epsilon(1e-14));
  const double path = 1 / RefractedCosine(0.3, 1 / n);
  CHECK(CoatCrossing(0.2, 1 / path) == Approx(std::pow(0.2, path / 2)).epsilon(1e-14));
  CHECK(CoatCrossing(1.0, 0.0) == 1);
  CHECK(CoatCrossing(0.2, 0.0) == 0);
  CHECK(CoatCrossing(0.0, 0.5) == 0);
}

}  // namespace
}  // namespace nacre
