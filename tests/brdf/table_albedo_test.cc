// SPDX-License-Identifier: Apache-2.0
// tests/brdf/table_albedo_test.cc: albedos of lobes under thin films against quadratures.
#include "brdf/table_albedo.h"

#include <algorithm>
#include <cmath>
#include <random>

#include "brdf/albedo_integral.h"
#include "brdf/anisotropic_albedo_integral.h"
#include "catch.h"

namespace nacre {
namespace {

// The curve of a film up to 1 um on a dielectric, in air or below a coat, seen from air. `index` is
// the film's. Metals have no base to leave light to, so that nobody asks for their albedo.
FresnelCurve RandomFilm(std::mt19937* random, double* index) {
  std::uniform_real_distribution<double> unit(0, 1);
  ThinFilm film;
  film.outside = unit(*random) < 0.6 ? 1 : 1.2 + 0.5 * unit(*random);
  film.index = *index = 1.05 + unit(*random);
  film.thickness_nm = 1000 * unit(*random);
  const double below = film.outside + 0.05 + unit(*random), outside = film.outside;
  const FresnelCurve own = ThinFilmCurve(film, SameSubstrate({below}));
  if (outside == 1) return own;
  return {[=](double cosine) {
            return own.loss(std::sqrt(1 - (1 - cosine) * (1 + cosine) / (outside * outside)));
          },
          0, 0};
}

Rgb Reflectance(const FresnelTable& table, double cosine) {
  const auto loss = FresnelTableLoss(table, cosine);
  return {1 - loss[0], 1 - loss[1], 1 - loss[2]};
}

TEST_CASE("albedos under films agree with the quadrature at every roughness and angle") {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> unit(0, 1);
  double worst = 0, worst_average = 0;
  for (int i = 0; i < 60; ++i) {
    double index = 0;
    const FresnelTable table = MakeFresnelTable(RandomFilm(&random, &index));
    const double roughness = i % 10 == 0 ? 1 : unit(random);
    const auto shadowing = static_cast<Shadowing>(i % 4);
    const AlbedoFit lobe = MakeAlbedoFit(shadowing, roughness);
    const TableAlbedoFit fit = MakeTableAlbedoFit(shadowing, roughness, lobe, table);
    for (const double mu : {1e-4, 1e-3, 0.01, 0.03, 0.1, 0.2, 0.35, 0.5, 0.7, 0.85, 1.0}) {
      const Rgb albedo = TableAlbedo(fit, lobe, table, mu);
      for (int c = 0; c < 3; ++c) {
        const double expected = AlbedoOf(
            shadowing, roughness, mu, [&](double vh, double) { return Reflectance(table, vh)[c]; });
        worst = std::max(worst, std::abs(albedo[c] - expected));
      }
    }
    // The average is that of the fit's own values.
    double sum = 0;
    for (int k = 0; k < 2000; ++k) {
      const double mu = (k + 0.5) / 2000;
      sum += 2 * mu * TableAlbedo(fit, lobe, table, mu).y / 2000;
    }
    worst_average = std::max(worst_average, std::abs(sum - fit.average.y));
  }
  CAPTURE(worst, worst_average);
  CHECK(worst < 1e-3);
  CHECK(worst_average < 1e-4);
}

TEST_CASE("albedos of hits' roughnesses are blended from nodes") {
  std::mt19937 random(2);
  double worst = 0;
  for (int i = 0; i < 3; ++i) {
    double index = 0;
    const FresnelTable table = MakeFresnelTable(RandomFilm(&random, &index));
    const TableAlbedoCurves curves = MakeTableAlbedoCurves(Shadowing::kSeparable, table);
    for (const double roughness : {0.0, 0.003, 0.05, 0.23, 0.41, 0.77, 1.0}) {
      const AlbedoFit lobe = MakeAlbedoFit(Shadowing::kSeparable, roughness);
      const TableAlbedoFit fit = MakeTableAlbedoFit(Shadowing::kSeparable, roughness, lobe, table);
      const TableAlbedoFit blended = BlendTableAlbedo(curves, roughness);
      for (const double mu : {1e-3, 0.02, 0.1, 0.3, 0.6, 1.0}) {
        const Rgb difference =
            TableAlbedo(fit, lobe, table, mu) - TableAlbedo(blended, lobe, table, mu);
        for (int c = 0; c < 3; ++c) worst = std::max(worst, std::abs(difference[c]));
      }
    }
  }
  CAPTURE(worst);
  CHECK(worst < 3e-4);
}

TEST_CASE("anisotropic albedos under films agree with the quadrature") {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> unit(0, 1);
  double worst = 0;
  for (int i = 0; i < 12; ++i) {
    double index = 0;
    const FresnelTable table = MakeFresnelTable(RandomFilm(&random, &index));
    const GgxAlphas<double> alpha = OpenPbrAlphas(unit(random), unit(random), AlphaLimit::kOne);
    const auto shadowing = static_cast<Shadowing>(i % 2);
    const AnisotropicAlbedoFit lobe = MakeAnisotropicAlbedoFit(shadowing, alpha);
    const auto fit = FitAnisotropicTable(shadowing, alpha, table, FresnelBend(index));
    for (const double mu : {1e-3, 0.02, 0.1, 0.3, 0.6, 0.9}) {
      const double sine = std::sqrt(1 - mu * mu), phi = M_PI_2 * unit(random);
      const Vec3d v(sine * std::cos(phi), sine * std::sin(phi), mu);
      const Rgb albedo = TableAlbedo(fit, lobe, table, v.z, v.x, v.y);
      for (int c = 0; c < 3; ++c) {
        const double expected = IntegrateAlbedos(alpha, v, kFineAnisotropicQuadrature,
                                                 [&](double vh, double) {
                                                   return Reflectance(table, vh)[c];
                                                 })[static_cast<size_t>(shadowing)]
                                    .fresnel;
        worst = std::max(worst, std::abs(albedo[c] - expected));
      }
    }
  }
  CAPTURE(worst);
  CHECK(worst < 3e-3);
}

}  // namespace
}  // namespace nacre
