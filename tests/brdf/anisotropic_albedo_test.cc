// SPDX-License-Identifier: Apache-2.0
// tests/brdf/anisotropic_albedo_test.cc: the anisotropic albedos against the quadrature that they
// were fitted to, with exact Fresnel curves, too, the quadrature against the isotropic one, white
// furnaces, and the SIMD twins.
#include "brdf/anisotropic_albedo.h"

#include <cmath>
#include <random>
#include <vector>

#include "brdf/albedo.h"
#include "brdf/albedo_integral.h"
#include "brdf/anisotropic_albedo_integral.h"
#include "brdf/anisotropic_kernel.h"
#include "brdf/multi_scatter.h"
#include "brdf/quadrature.h"
#include "catch.h"
#include "targets.h"

namespace nacre {
namespace {

constexpr Shadowing kSmith[] = {Shadowing::kHeightCorrelated, Shadowing::kSeparable};

// The azimuth counts from the tangent, in degrees; at 90 it is the bitangent's exactly.
Vec3d ViewAt(double n_dot_v, double degrees) {
  const double sin = std::sqrt((1 - n_dot_v) * (1 + n_dot_v));
  const Rotation<double> azimuth = RotationOfDegrees(degrees);
  return {sin * azimuth.cos, sin * azimuth.sin, n_dot_v};
}

AnisotropicAlbedoVariables<double> VariablesAt(const AnisotropicAlbedoFit& fit, const Vec3d& v) {
  return ComputeAlbedoVariables(fit.shape, v.z, v.x, v.y);
}

TEST_CASE("the anisotropic quadrature is the isotropic one for equal alphas") {
  for (const double roughness : {0.05, 0.3, 0.7, 1.0}) {
    const double alpha = AlphaFromRoughness(roughness);
    for (const double n_dot_v : {1e-4, 0.01, 0.2, 0.6, 1.0}) {
      for (const double azimuth : {0.0, 30.0, 90.0}) {
        CAPTURE(roughness, n_dot_v, azimuth);
        const auto albedos =
            IntegrateAlbedos({alpha, alpha}, ViewAt(n_dot_v, azimuth), kFineAnisotropicQuadrature);
        for (const size_t form : {0u, 1u}) {
          const Shadowing shadowing = kSmith[form];
          CHECK(std::abs(1 - albedos[form].loss - AlbedoOfOne(shadowing, roughness, n_dot_v)) <
                1e-5);
          CHECK(std::abs(albedos[form].powers[4] - AlbedoOfSchlick(shadowing, roughness, n_dot_v)) <
                1e-5);
        }
      }
    }
  }
}

TEST_CASE("the anisotropic quadrature converges, and is the mean of the sampler's weights") {
  const GgxAlphas<double> alphas[] = {{0.9, 0.1}, {0.3, 0.2}, {0.5, 1e-4}, {1.4, 0.7}, {0.05, 0.6}};
  for (const GgxAlphas<double>& alpha : alphas) {
    for (const double n_dot_v : {1e-4, 0.02, 0.2, 0.7, 1.0}) {
      for (const double azimuth : {0.0, 50.0, 89.0, 90.0}) {
        CAPTURE(alpha.x, alpha.y, n_dot_v, azimuth);
        const Vec3d v = ViewAt(n_dot_v, azimuth);
        const auto fine = IntegrateAlbedos(alpha, v, kFineAnisotropicQuadrature);
        const auto coarse = IntegrateAlbedos(alpha, v);
        for (const size_t form : {0u, 1u}) {
          CHECK(std::abs(fine[form].loss - coarse[form].loss) < 1e-4);
          CHECK(std::abs(fine[form].powers[4] - coarse[form].powers[4]) < 1e-4);
        }
        if (n_dot_v < 0.1) continue;
        // The midpoint rule of 150^2 points, u1 denser towards 1, where the lobe's tail is.
        constexpr int kSteps = 150;
        const Basis<double> upright{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
        double sum = 0;
        for (int i = 0; i < kSteps * kSteps; ++i) {
          const double root = (i / kSteps + 0.5) / kSteps;
          const Vec3d l =
              SampleGgxVisible(upright, v, alpha, (i % kSteps + 0.5) / kSteps, 1 - root * root);
          const FrameAngles<double> a = ComputeAngles(upright, l, v);
          if (!(a.n_dot_l > 0)) continue;
          sum += 2 * root * GgxDistribution(a, alpha) * VisibilitySeparable(a, alpha) * a.n_dot_l /
                 GgxVisiblePdf(a, alpha);
        }
        CHECK(std::abs(sum / (kSteps * kSteps) - (1 - fine[1].loss)) < 5e-4);
      }
    }
  }
}

// Views and surfaces of the furnaces.
const double kCosines[] = {1e-4, 1e-3, 0.01, 0.05, 0.1, 0.2, 0.35, 0.5, 0.7, 0.9, 1};
const double kAzimuths[] = {0, 20, 45, 70, 85, 89, 89.9, 90};
const double kRoughnesses[] = {0, 0.01, 0.02, 0.05, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1};
const double kAnisotropies[] = {0, 0.1, 0.3, 0.5, 0.7, 0.9, 0.95, 0.98, 0.999, 1};

// The mean of 1 - E over the hemisphere, by panels that halve towards the horizon and towards the
// bitangent.
double MeanLoss(const AnisotropicAlbedoFit& fit) {
  const QuadratureRule& rule = GaussLegendre(6);
  const auto halving = [&](int panels, const auto& f) {
    double sum = 0, end = 1;
    for (int panel = 0; panel < panels; ++panel) {
      const double begin = panel == panels - 1 ? 0 : end / 2;
      for (size_t i = 0; i < rule.x.size(); ++i) {
        sum += rule.w[i] * (end - begin) * f(begin + (end - begin) * rule.x[i]);
      }
      end = begin;
    }
    return sum;
  };
  return halving(20, [&](double n) {
    return 2 * n * halving(9, [&](double azimuth) {
             return AlbedoLoss(fit, VariablesAt(fit, ViewAt(n, 90 - 90 * azimuth)));
           });
  });
}

// Conductors must reflect 1 +- 1e-3 with either compensation: Turquin's factor 1 / E, and the
// second lobe of Kulla and Conty.
TEST_CASE("white furnace: anisotropic conductors") {
  double turquin = 0, kulla_conty = 0, schlick = 0;
  for (const AlphaLimit limit : {AlphaLimit::kOne, AlphaLimit::kNone}) {
    for (const double roughness : kRoughnesses) {
      for (const double anisotropy : kAnisotropies) {
        const GgxAlphas<double> alpha = OpenPbrAlphas(roughness, anisotropy, limit);
        if (limit == AlphaLimit::kNone && !(alpha.x > 1)) continue;
        const AnisotropicAlbedoFit fits[] = {MakeAnisotropicAlbedoFit(kSmith[0], alpha),
                                             MakeAnisotropicAlbedoFit(kSmith[1], alpha)};
        const double means[] = {MeanLoss(fits[0]), MeanLoss(fits[1])};
        for (const double n_dot_v : kCosines) {
          for (const double azimuth : kAzimuths) {
            const Vec3d v = ViewAt(n_dot_v, azimuth);
            const bool mirror = IsDeltaLobe(alpha);
            const auto albedos =
                mirror ? std::array<AnisotropicAlbedo, 2>{} : IntegrateAlbedos(alpha, v);
            for (const size_t form : {0u, 1u}) {
              const AnisotropicAlbedoFit& fit = fits[form];
              const auto x = VariablesAt(fit, v);
              const double e = 1 - albedos[form].loss;
              const double e_fit = AlbedoOne(fit, x);
              const double second =
                  AlbedoLoss(fit, x) * M_PI * KullaContyScale(fit.e_average) * means[form];
              turquin = std::max(turquin, std::abs(e / e_fit - 1));
              kulla_conty = std::max(kulla_conty, std::abs(e + second - 1));
              const double b = mirror ? Power5(1 - n_dot_v) : albedos[form].powers[4];
              schlick = std::max(schlick, std::abs(AlbedoSchlick(fit, e_fit, x) - b));
              if (turquin > 1e-3 || kulla_conty > 1e-3) {
                FAIL("roughness " << roughness << " anisotropy " << anisotropy << " n.v " << n_dot_v
                                  << " azimuth " << azimuth << ": " << turquin << ", "
                                  << kulla_conty);
              }
            }
          }
        }
      }
    }
  }
  CAPTURE(turquin, kulla_conty, schlick);
  CHECK(turquin <= 7e-4);
  CHECK(kulla_conty <= 7e-4);
  CHECK(schlick <= 9e-4);
}

TEST_CASE("fits between the table's entries, and averages, are near the truth") {
  std::mt19937 random(6);
  std::uniform_real_distribution<double> unit(0, 1);
  double one = 0, schlick = 0;
  for (int i = 0; i < 2000; ++i) {
    const double roughness = i % 2 == 0 ? unit(random) : std::pow(10, -2 * unit(random));
    const GgxAlphas<double> alpha = GltfAlphas(roughness, unit(random));
    const Vec3d v = ViewAt(i % 3 == 0 ? unit(random) : std::pow(10, -4 * unit(random)),
                           i % 4 == 0 ? 90 : 90 * unit(random));
    const auto albedos = IntegrateAlbedos(alpha, v);
    for (const size_t form : {0u, 1u}) {
      const AnisotropicAlbedoFit fit = MakeAnisotropicAlbedoFit(kSmith[form], alpha);
      const auto x = VariablesAt(fit, v);
      const double e = AlbedoOne(fit, x);
      one = std::max(one, std::abs(e / (1 - albedos[form].loss) - 1));
      schlick = std::max(schlick, std::abs(AlbedoSchlick(fit, e, x) - albedos[form].powers[4]));
    }
  }
  CAPTURE(one, schlick);
  CHECK(one <= 7e-4);
  CHECK(schlick <= 9e-4);
  // Isotropic surfaces are those of brdf/albedo.h.
  for (const Shadowing form : kSmith) {
    for (const double roughness : {0.05, 0.3, 0.8, 1.0}) {
      const double alpha = AlphaFromRoughness(roughness);
      const AnisotropicAlbedoFit fit = MakeAnisotropicAlbedoFit(form, {alpha, alpha});
      const AlbedoFit isotropic = MakeAlbedoFit(form, roughness);
      CHECK(std::abs(fit.e_average - isotropic.e_average) < 3e-4);
      CHECK(std::abs(fit.schlick_average - isotropic.schlick_average) < 3e-4);
    }
  }
}

// Bare and coated dielectrics. Below its coat the second but one has a relative index below 1.
const CoatedDielectric<double> kDielectrics[] = {{1.01},
                                                 {1.1},
                                                 {1.33},
                                                 {1.5},
                                                 {2},
                                                 {3},
                                                 {1.5, 0.5, 1.5 / 1.3, 1 / 1.3},
                                                 {1.5, 0.7, 1.5 / 1.6, 1 / 1.6},
                                                 {2.5, 1, 2.5 / 1.3, 1 / 1.3}};

double FresnelAlbedoAt(const AnisotropicAlbedoFit& lobe, const AnisotropicFresnelCurve& curve,
                       const CoatedDielectric<double>& dielectric, const Vec3d& v) {
  const auto x = VariablesAt(lobe, v);
  const double mirror = FresnelCoatedDielectric(x.n_dot_x, 1 - x.n_dot_x, dielectric);
  return AlbedoFresnel(curve, AlbedoOne(lobe, x), mirror, x);
}
double FresnelAlbedoAt(const AnisotropicFresnelFit& fit, const Vec3d& v) {
  return FresnelAlbedoAt(fit.lobe, fit.fresnel, fit.dielectric, v);
}

FresnelFunction CurveOf(const CoatedDielectric<double>& dielectric) {
  return [dielectric](double v_dot_h, double one_minus_vh) {
    return FresnelCoatedDielectric(v_dot_h, one_minus_vh, dielectric);
  };
}

TEST_CASE("the anisotropic quadrature of a Fresnel curve is that of Schlick's weight for it") {
  const FresnelFunction schlick = [](double, double one_minus_vh) { return Power5(one_minus_vh); };
  for (const GgxAlphas<double>& alpha : {GgxAlphas<double>{0.9, 0.1}, {0.3, 0.2}, {0.05, 1e-4}}) {
    for (const double n_dot_v : {1e-4, 0.2, 0.7, 1.0}) {
      const auto albedos = IntegrateAlbedos(alpha, ViewAt(n_dot_v, 50), {}, schlick);
      for (const AnisotropicAlbedo& albedo : albedos) {
        CHECK(std::abs(albedo.fresnel - albedo.powers[4]) < 1e-14);
      }
    }
  }
}

TEST_CASE("anisotropic fits of exact Fresnel curves are near the truth") {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> unit(0, 1);
  for (const CoatedDielectric<double>& dielectric : kDielectrics) {
    const FresnelFunction curve = CurveOf(dielectric);
    double worst = 0;
    for (int i = 0; i < 32; ++i) {
      const double x = kLargestAlbedoAlpha * (i % 7 == 0   ? 1
                                              : i % 2 == 0 ? unit(random)
                                                           : std::pow(10, -4 * unit(random)));
      const double ratio = i % 10 == 0  ? 1
                           : i % 3 == 0 ? unit(random)
                                        : std::pow(10, -5 * unit(random));
      const GgxAlphas<double> alpha{x, ratio * x};
      const size_t form = static_cast<size_t>(i) / 2 % 2;
      const auto fit = MakeAnisotropicFresnelFit(kSmith[form], alpha, dielectric);
      for (int j = 0; j < 30; ++j) {
        const Vec3d v = ViewAt(j % 2 == 0 ? unit(random) : std::pow(10, -4 * unit(random)),
                               j % 3 == 0   ? 90
                               : j % 3 == 1 ? 90 * unit(random)
                                            : 90 - 90 * std::pow(10, -3 * unit(random)));
        const double truth = IntegrateAlbedos(alpha, v, {}, curve)[form].fresnel;
        worst = std::max(worst, std::abs(FresnelAlbedoAt(fit, v) - truth));
      }
    }
    CAPTURE(dielectric.eta, dielectric.coat, worst);
    CHECK(worst <= (dielectric.eta < 1.05 ? 1.2e-3 : 7.5e-4));
  }
}

TEST_CASE("anisotropic fits of Fresnel curves are the isotropic ones for equal alphas") {
  for (const Shadowing form : kSmith) {
    for (const CoatedDielectric<double>& dielectric : kDielectrics) {
      for (const double roughness : {0.0, 0.05, 0.3, 0.8, 1.0}) {
        CAPTURE(dielectric.eta, dielectric.coat, roughness);
        const double alpha = AlphaFromRoughness(roughness);
        const auto fit = MakeAnisotropicFresnelFit(form, {alpha, alpha}, dielectric);
        const FresnelAlbedoFit isotropic = MakeDielectricAlbedoFit(form, roughness, dielectric);
        double worst = 0;
        for (const double n_dot_v : kCosines) {
          worst = std::max(worst, std::abs(FresnelAlbedoAt(fit, ViewAt(n_dot_v, 30)) -
                                           AlbedoFresnel(isotropic, n_dot_v)));
        }
        CHECK(worst <= 4e-4);
        CHECK(std::abs(fit.fresnel.average - isotropic.average) <= 1e-4);
      }
    }
  }
}

// The midpoint rule in n.v^2 and the azimuth.
TEST_CASE("the average of an anisotropic Fresnel fit is the mean of its curve") {
  for (const GgxAlphas<double>& alpha : {GgxAlphas<double>{1.4, 1e-3}, {0.6, 0.1}, {0.02, 0.01}}) {
    for (const double eta : {1.1, 1.5, 3.0}) {
      const auto fit = MakeAnisotropicFresnelFit(kSmith[0], alpha, {eta});
      constexpr int kSteps = 300;
      double sum = 0;
      for (int i = 0; i < kSteps * kSteps; ++i) {
        const double n_dot_v = std::sqrt((i % kSteps + 0.5) / kSteps);
        sum += FresnelAlbedoAt(fit, ViewAt(n_dot_v, 90 * (i / kSteps + 0.5) / kSteps));
      }
      CHECK(std::abs(sum / (kSteps * kSteps) - fit.fresnel.average) < 1e-4);
    }
  }
}

TEST_CASE("anisotropic Fresnel curves blended by roughness are near the truth") {
  const AlphasOfRoughness mappings[] = {
      [](double roughness) { return OpenPbrAlphas(roughness, 0.0, AlphaLimit::kNone); },
      [](double roughness) { return OpenPbrAlphas(roughness, 0.95, AlphaLimit::kNone); },
      // Mappings with a kink.
      [](double roughness) { return OpenPbrAlphas(roughness, 0.7, AlphaLimit::kOne); },
      [](double roughness) { return DisneyAlphas(roughness, 0.9); },
      // A streak at roughness 0, and an alpha.x at its limit from there on.
      [](double roughness) { return GltfAlphas(roughness, 0.6); },
      [](double roughness) { return GltfAlphas(roughness, 1.0); }};
  std::mt19937 random(8);
  std::uniform_real_distribution<double> unit(0, 1);
  double worst = 0, worst_average = 0;
  for (const AlphasOfRoughness& alphas : mappings) {
    for (const CoatedDielectric<double>& dielectric : {kDielectrics[1], kDielectrics[6]}) {
      const auto curves = MakeAnisotropicFresnelCurves(kSmith[0], alphas, dielectric);
      for (int i = 0; i < 40; ++i) {
        const double roughness = i == 0       ? 1
                                 : i % 2 == 0 ? unit(random)
                                              : std::pow(10, -2 * unit(random));
        GgxAlphas<double> alpha = alphas(roughness);
        const AnisotropicAlbedoFit lobe = MakeAnisotropicAlbedoFit(kSmith[0], alpha);
        const AnisotropicFresnelCurve blend = BlendAnisotropicFresnelCurves(curves, roughness);
        alpha = {double{lobe.shape.alpha_x}, double{lobe.shape.alpha_y}};
        for (int j = 0; j < 15; ++j) {
          const Vec3d v = ViewAt(j % 2 == 0 ? unit(random) : std::pow(10, -4 * unit(random)),
                                 j % 3 == 0 ? 90 : 90 * unit(random));
          const double truth = IntegrateAlbedos(alpha, v, {}, CurveOf(dielectric))[0].fresnel;
          worst = std::max(worst, std::abs(FresnelAlbedoAt(lobe, blend, dielectric, v) - truth));
        }
        if (i % 8 != 0) continue;
        const auto fit = MakeAnisotropicFresnelFit(kSmith[0], alpha, dielectric);
        worst_average = std::max(worst_average, std::abs(blend.average - fit.fresnel.average));
      }
    }
  }
  CAPTURE(worst, worst_average);
  CHECK(worst <= 8e-4);
  CHECK(worst_average <= 1e-4);
}

TEST_CASE("SIMD anisotropic albedos are their scalar twins on every target, in range everywhere") {
  std::vector<Vec3f> directions = {Vec3f(0, 0, 1),  Vec3f(1, 0, 0),         Vec3f(0, 1, 0),
                                   Vec3f(0, 0, 0),  Vec3f(1, 0, -1e-6f),    Vec3f(0, 1, 1e-30f),
                                   Vec3f(0, 0, -1), Vec3f(1e-30f, 0, 1.0f), Vec3f(0, 1, 1e-40f)};
  for (int i = 0; i <= 300; ++i) {
    directions.emplace_back(ViewAt(std::pow(10, -i / 50.0), i % 90 + (i % 7 == 0 ? 0.5 : 0)));
  }
  const CoatedDielectric<double> dielectric = kDielectrics[6];
  std::vector<AnisotropicFresnelFit> fits;
  for (const Shadowing form : kSmith) {
    for (const double roughness : {0.0, 1e-6, 1e-3, 0.1, 0.37, 1.0}) {
      for (const double anisotropy : {0.0, 0.4, 0.95, 1.0}) {
        fits.push_back(MakeAnisotropicFresnelFit(
            form, OpenPbrAlphas(roughness, anisotropy, AlphaLimit::kNone), dielectric));
      }
    }
  }
  std::vector<AnisotropicFresnelFit> mixed;  // one for each direction
  for (size_t i = 0; i < directions.size(); ++i) mixed.push_back(fits[i % fits.size()]);
  ForEachTarget([&](Target) {
    double worst = 0, lanes = 0;
    bool in_range = true;
    const auto check = [&](const AnisotropicFresnelFit& fit, const Vec3f& v,
                           const AnisotropicAlbedoOutput& out, double* error) {
      const auto x = VariablesAt(fit.lobe, Vec3d(v));
      const double loss = AlbedoLoss(fit.lobe, x);
      *error = std::max({*error, std::abs(out.loss - loss),
                         std::abs(out.schlick - AlbedoSchlick(fit.lobe, 1 - loss, x)),
                         std::abs(out.fresnel - FresnelAlbedoAt(fit, Vec3d(v)))});
      for (const float value : {out.loss, out.schlick, out.fresnel}) {
        in_range = in_range && value >= 0 && value <= 1;
      }
    };
    for (const AnisotropicFresnelFit& fit : fits) {
      const auto outputs = EvaluateAnisotropicAlbedos(fit, directions);
      for (size_t i = 0; i < directions.size(); ++i) check(fit, directions[i], outputs[i], &worst);
    }
    const auto outputs = EvaluateAnisotropicAlbedos(mixed, directions);
    for (size_t i = 0; i < directions.size(); ++i) {
      check(mixed[i], directions[i], outputs[i], &lanes);
    }
    // The polynomials' coefficients sum to 200 at most, so the error is at most 200 roundings of 1.
    CHECK(worst < 200 * 0x1p-24);
    CHECK(lanes < 200 * 0x1p-24);
    CHECK(in_range);
  });
}

}  // namespace
}  // namespace nacre
