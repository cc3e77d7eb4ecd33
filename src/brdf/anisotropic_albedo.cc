// SPDX-License-Identifier: Apache-2.0
#include "brdf/anisotropic_albedo.h"

#include <algorithm>
#include <cmath>

#include "brdf/anisotropic_albedo_fit.h"
#include "brdf/anisotropic_albedo_integral.h"
#include "brdf/anisotropic_albedo_table.h"
#include "brdf/quadrature.h"

namespace nacre {
namespace {

// to += weight * polynomial.
template <size_t kTerms>
void AddPolynomial(float weight, const std::array<KappaPolynomial, kTerms>& polynomial,
                   std::array<KappaPolynomial, kTerms>* to) {
  for (size_t i = 0; i < kTerms; ++i) {
    for (size_t k = 0; k < kKappaTerms; ++k) (*to)[i][k] += weight * polynomial[i][k];
  }
}

// Alphas that the fits cover.
GgxAlphas<double> FittedAlphas(const GgxAlphas<double>& alpha) {
  const double shrink = std::min(kLargestAlbedoAlpha / alpha.x, 1.0);
  return {alpha.x * shrink, alpha.y * shrink};
}

double Mirror(const FresnelFunction& curve, double cosine) { return curve(cosine, 1 - cosine); }

FittedFresnel FresnelOf(const CoatedDielectric<double>& dielectric) {
  return {[dielectric](double v_dot_h, double one_minus_vh) {
            return FresnelCoatedDielectric(v_dot_h, one_minus_vh, dielectric);
          },
          FresnelBend(dielectric.eta), AverageDielectric(dielectric)};
}

// What the width of the limit ay = 0 adds to a mirror's albedo, over the direction's width, which
// multiplies v.h.
StreakPolynomial StreakOf(size_t form, double alpha_x, float bend, const FresnelFunction& curve) {
  const AnisotropicAlbedoShape shape = MakeAnisotropicAlbedoShape({alpha_x, 0});
  std::array<KappaValues, kStreakTerms> values{};
  for (size_t k = 0; k < kKappaTerms; ++k) {
    const double kappa = std::sqrt(KappaSquaredAt(shape, ChebyshevNode(k, kKappaTerms)));
    const std::vector<StreakPoint> points = StreakQuadrature(alpha_x, kappa);
    const double n = 1 / std::hypot(1.0, kappa / alpha_x);
    for (size_t j = 0; j < kStreakTerms; ++j) {
      const double width = WidthAt(double{bend}, ChebyshevNode(j, kStreakTerms));
      const double mirror = Mirror(curve, width * n);
      double wider = 0;
      for (const StreakPoint& point : points) {
        const double fresnel = curve(width * point.v_dot_h, 1 - width + width * point.one_minus_vh);
        wider += point.weights[form] * (fresnel - mirror);
      }
      values[j][k] = wider / width;
    }
  }
  return InterpolateKappa(values);
}

// The mean over the hemisphere of the albedo as fitted, so that light lost along one direction
// agrees with light returned along all others. Panels halve towards the horizon and towards the
// bitangent, where streaks bend.
double AverageOf(const AnisotropicAlbedoFit& lobe, const AnisotropicFresnelCurve& fresnel,
                 const FresnelFunction& curve) {
  return IntegrateTowardsZero(
      [&](double n) {
        const double sin = std::sqrt((1 - n) * (1 + n));
        const double mirror = Mirror(curve, n);
        return 2 * n *
               IntegrateTowardsZero(
                   [&](double quarter) {
                     const double angle = M_PI_2 * quarter;  // from the bitangent
                     const auto x = ComputeAlbedoVariables(lobe.shape, n, sin * std::sin(angle),
                                                           sin * std::cos(angle));
                     return AlbedoFresnel(fresnel, AlbedoOne(lobe, x), mirror, x);
                   },
                   3);
      },
      6);
}

constexpr int kCurveIntervals = 18;  // of AnisotropicFresnelCurves

// The root of the roughness at which alpha.x reaches its limit, or 1 if there is none or if alpha.x
// is at it from the beginning.
double KinkOf(const AlphasOfRoughness& alphas) {
  const double limit = std::min(alphas(1).x, kLargestAlbedoAlpha);
  double below = 0, above = 1;
  for (int i = 0; i < 40; ++i) {
    const double root = (below + above) / 2;
    (alphas(root * root).x < limit * (1 - 1e-9) ? below : above) = root;
  }
  return above > 0.05 && above < 1 - 1e-6 ? above : 1;
}

}  // namespace

// The cosines within which a dielectric's curve bends: both terms of Fresnel's equations are 1 at
// grazing incidence, from where s falls within sqrt(eta^2 - 1) and p, to 0 at Brewster's angle,
// within 1 / sqrt(eta^2 + 1). Twice the former halves the errors of indices near 1.
double FresnelBend(double eta) {
  const double s = std::sqrt(std::abs((eta - 1) * (eta + 1))), p = 1 / std::sqrt(eta * eta + 1);
  return std::max(std::min(2 * s, p), 0.05);
}

AnisotropicAlbedoFit MakeAnisotropicAlbedoFit(Shadowing shadowing, const GgxAlphas<double>& alpha) {
  AnisotropicAlbedoFit fit;
  if (IsDeltaLobe(alpha)) return fit;
  const GgxAlphas<double> shrunk = FittedAlphas(alpha);
  fit.shape = MakeAnisotropicAlbedoShape(shrunk);
  const auto form = static_cast<size_t>(shadowing);
  const CubicWeights x = FindAlphaWeights(shrunk.x);
  const CubicWeights ratio = FindRatioWeights(std::min(shrunk.y / shrunk.x, 1.0));
  double loss_average = 0, schlick_average = 0;
  for (int i = 0; i < 4; ++i) {
    AddPolynomial(static_cast<float>(x.weights[i]), kStreakAlbedoTable[form][x.first + i],
                  &fit.streak);
    for (int j = 0; j < 4; ++j) {
      const AnisotropicAlbedoEntry& entry =
          kAnisotropicAlbedoTable[form][x.first + i][ratio.first + j];
      const double weight = x.weights[i] * ratio.weights[j];
      AddPolynomial(static_cast<float>(weight), entry.loss, &fit.loss);
      AddPolynomial(static_cast<float>(weight), entry.schlick, &fit.schlick);
      loss_average += weight * double{entry.loss_average};
      schlick_average += weight * double{entry.schlick_average};
    }
  }
  fit.e_average = 1 - loss_average * AnisotropicLossScale(shrunk);
  fit.schlick_average = schlick_average;
  return fit;
}

namespace {

// Alphas that fits of Fresnel curves cover.
GgxAlphas<double> FittedFresnelAlphas(const GgxAlphas<double>& alpha) {
  GgxAlphas<double> fitted = FittedAlphas(alpha);
  fitted.y = std::max(fitted.y, kLeastFittedRatio * fitted.x);
  return fitted;
}

}  // namespace

AnisotropicFresnelCurve FitAnisotropicFresnel(Shadowing shadowing, const GgxAlphas<double>& alpha,
                                              const FittedFresnel& fresnel) {
  AnisotropicFresnelCurve fit;
  fit.bend = static_cast<float>(fresnel.bend);
  if (IsDeltaLobe(alpha)) {
    fit.average = fresnel.average;
    return fit;
  }
  const GgxAlphas<double> fitted = FittedFresnelAlphas(alpha);
  const AnisotropicAlbedoFit lobe = MakeAnisotropicAlbedoFit(shadowing, fitted);
  const auto form = static_cast<size_t>(shadowing);
  fit.streak = StreakOf(form, fitted.x, fit.bend, fresnel.curve);
  std::array<KappaValues, kShareTerms> wider;
  for (size_t s = 0; s < kShareTerms; ++s) {
    for (size_t k = 0; k < kKappaTerms; ++k) {
      const Vec3d v =
          DirectionAt(lobe.shape, ChebyshevNode(k, kKappaTerms), ChebyshevNode(s, kShareTerms));
      const auto x = ComputeAlbedoVariables(lobe.shape, v.z, v.x, v.y);
      const double albedo =
          IntegrateAlbedos(fitted, v, kFastAnisotropicQuadrature, fresnel.curve)[form].fresnel;
      const double u = StreakVariable(double{fit.bend}, x.width);
      const double known = Mirror(fresnel.curve, v.z) * AlbedoOne(lobe, x) +
                           x.width * EvaluatePolynomial(fit.streak, x.z, u);
      wider[s][k] = (albedo - known) / x.rest;
    }
  }
  fit.wider = InterpolateKappa(wider);
  fit.average = AverageOf(lobe, fit, fresnel.curve);
  return fit;
}

AnisotropicFresnelFit MakeAnisotropicFresnelFit(Shadowing shadowing, const GgxAlphas<double>& alpha,
                                                const CoatedDielectric<double>& dielectric) {
  AnisotropicFresnelFit fit;
  fit.dielectric = dielectric;
  fit.fresnel = FitAnisotropicFresnel(shadowing, alpha, FresnelOf(dielectric));
  if (!IsDeltaLobe(alpha)) {
    fit.lobe = MakeAnisotropicAlbedoFit(shadowing, FittedFresnelAlphas(alpha));
  }
  return fit;
}

AnisotropicFresnelCurves MakeAnisotropicFresnelCurves(Shadowing shadowing,
                                                      const AlphasOfRoughness& alphas,
                                                      const CoatedDielectric<double>& dielectric) {
  return MakeAnisotropicFresnelCurves(shadowing, alphas, FresnelOf(dielectric));
}

AnisotropicFresnelCurves MakeAnisotropicFresnelCurves(Shadowing shadowing,
                                                      const AlphasOfRoughness& alphas,
                                                      const FittedFresnel& fresnel) {
  AnisotropicFresnelCurves curves;
  curves.kink = KinkOf(alphas);
  curves.kink_node = curves.kink < 1 ? std::clamp(static_cast<int>(curves.kink * kCurveIntervals),
                                                  3, kCurveIntervals - 3)
                                     : kCurveIntervals;
  for (int i = 0; i <= kCurveIntervals; ++i) {
    // A mirror has no curve. The limit for roughness 0 is reached halfway to the next one.
    double root = curves.kink * (i == 0 ? 0.5 : i) / curves.kink_node;
    if (i > curves.kink_node) {
      root = curves.kink +
             (1 - curves.kink) * (i - curves.kink_node) / (kCurveIntervals - curves.kink_node);
    }
    curves.nodes.push_back(FitAnisotropicFresnel(shadowing, alphas(root * root), fresnel));
  }
  return curves;
}

AnisotropicFresnelCurve BlendAnisotropicFresnelCurves(const AnisotropicFresnelCurves& curves,
                                                      double roughness) {
  AnisotropicFresnelCurve curve;
  curve.bend = curves.nodes.front().bend;
  const double root = std::sqrt(roughness);
  const bool above = root > curves.kink;
  const int intervals = above ? kCurveIntervals - curves.kink_node : curves.kink_node;
  const double position = above ? (root - curves.kink) / (1 - curves.kink) : root / curves.kink;
  const CubicWeights at = FindCubicWeights(position * intervals, intervals);
  const AnisotropicFresnelCurve* nodes =
      curves.nodes.data() + (above ? curves.kink_node : 0) + at.first;
  for (size_t i = 0; i < 4; ++i) {
    const AnisotropicFresnelCurve& node = nodes[i];
    const auto weight = static_cast<float>(at.weights[i]);
    AddPolynomial(weight, node.wider, &curve.wider);
    AddPolynomial(weight, node.streak, &curve.streak);
    curve.average += at.weights[i] * node.average;
  }
  return curve;
}

}  // namespace nacre
