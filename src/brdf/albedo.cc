// SPDX-License-Identifier: Apache-2.0
#include "brdf/albedo.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include "brdf/albedo_integral.h"
#include "brdf/albedo_table.h"
#include "brdf/quadrature.h"

namespace nacre {

namespace {

// to += weight * curve.
template <class Curve>
void AddCurve(double weight, const Curve& curve, AlbedoPolynomial* to) {
  const auto by = static_cast<float>(weight);
  for (size_t j = 0; j < kAlbedoTerms; ++j) (*to)[j] += by * curve[j];
}

const AlbedoEntry* EntriesOf(Shadowing shadowing) {
  return kAlbedoTable[static_cast<int>(shadowing)];
}

}  // namespace

AlbedoFit BlendAlbedoCurves(Shadowing shadowing, double roughness) {
  AlbedoFit fit;
  fit.shape = MakeAlbedoShape(shadowing, roughness);
  const AlbedoWeights at = FindAlbedoWeights(roughness);
  for (int i = 0; i < 4; ++i) {
    const AlbedoEntry& entry = EntriesOf(shadowing)[at.first + i];
    AddCurve(at.weights[i], entry.one, &fit.one);
    AddCurve(at.weights[i], entry.schlick, &fit.schlick);
  }
  if (!(fit.shape.offset > 0)) fit.schlick = {};  // a mirror's lobe has no width to correct for
  return fit;
}

AlbedoFit MakeAlbedoFit(Shadowing shadowing, double roughness) {
  AlbedoFit fit = BlendAlbedoCurves(shadowing, roughness);
  const AlbedoWeights at = FindAlbedoWeights(roughness);
  double one_average = 0;
  double schlick_average = 0;
  for (int i = 0; i < 4; ++i) {
    const AlbedoEntry& entry = EntriesOf(shadowing)[at.first + i];
    one_average += at.weights[i] * double{entry.one_average};
    schlick_average += at.weights[i] * double{entry.schlick_average};
  }
  fit.e_average = fit.shape.form == AlbedoForm::kMasked
                      ? one_average
                      : 1 - one_average * AverageLossScale(fit.shape.form, roughness);
  fit.schlick_average = schlick_average;
  return fit;
}

AlbedoPolynomial FitFresnelAlbedo(Shadowing shadowing, double roughness, const AlbedoFit& lobe,
                                  const FresnelFunction& curve) {
  std::array<double, kAlbedoTerms> values{};  // 0 for a mirror
  for (int i = 0; i < kAlbedoTerms && lobe.shape.offset > 0; ++i) {
    const double mu = AlbedoNodeCosine(lobe.shape, i);
    const double albedo = AlbedoOf(shadowing, roughness, mu, curve, kFastAlbedoQuadrature);
    const double masking =
        lobe.shape.form == AlbedoForm::kMasked ? AlbedoMasking(lobe.shape, mu) : 1;
    values[static_cast<size_t>(i)] = (albedo - curve(mu, 1 - mu) * AlbedoOne(lobe, mu)) / masking;
  }
  const auto polynomial = InterpolateAlbedo(values);
  AlbedoPolynomial fit{};
  for (size_t i = 0; i < kAlbedoTerms; ++i) fit[i] = static_cast<float>(polynomial[i]);
  return fit;
}

namespace {

// Without the corner.
FresnelAlbedoFit FitDielectric(Shadowing shadowing, double roughness,
                               const CoatedDielectric<double>& base, const FresnelFunction& curve) {
  FresnelAlbedoFit fit;
  fit.lobe = MakeAlbedoFit(shadowing, roughness);
  fit.curve = base;
  fit.fresnel = FitFresnelAlbedo(shadowing, roughness, fit.lobe, curve);
  return fit;
}

double AverageOf(const FresnelAlbedoFit& fit) {
  return IntegrateTowardsZero([&](double mu) { return 2 * mu * AlbedoFresnel(fit, mu); });
}

FresnelFunction FunctionOf(const CoatedDielectric<double>& base) {
  return [base](double v_dot_h, double one_minus_vh) {
    return FresnelCoatedDielectric(v_dot_h, one_minus_vh, base);
  };
}

// The cosine at which total reflection sets in, or 0: at the base in air, and at the coat or,
// through it, at the base. Of two that differ, it is that of the larger share. Without a weight of
// the lobe, Snell's law gives the base the same critical angle below a coat.
double CriticalCosine(const CoatedDielectric<double>& base) {
  const double coated = base.coat > 0 ? std::min(base.eta_in_coat, 1.0) / base.inverse_coat_eta : 1;
  const double sine = coated < 1 && (base.coat >= 0.5 || base.eta >= 1) ? coated : base.eta;
  return sine < 1 ? std::sqrt((1 - sine) * (1 + sine)) : 0;
}

}  // namespace

FresnelAlbedoFit MakeDielectricAlbedoFit(Shadowing shadowing, double roughness,
                                         const CoatedDielectric<double>& base) {
  const FresnelFunction curve = FunctionOf(base);
  FresnelAlbedoFit fit = FitDielectric(shadowing, roughness, base, curve);
  const double critical = CriticalCosine(base);
  if (critical > 0 && fit.lobe.shape.offset > 0) {
    // A third of the error that fits are held to (1e-3). A wide lobe blurs the corner, which the
    // azimuths must resolve.
    const bool is_wide = roughness > 0.2;
    const FresnelTableOptions options{
        .tolerance = 3e-4, .most = is_wide ? 128 : 512, .over_cosine = false};
    const AlbedoQuadrature rule{is_wide ? 12 : 7, is_wide ? 0.08 : 0.3, is_wide ? 1e-6 : 1e-5,
                                critical};
    const auto loss = [&](double mu) {
      const double least = std::max(mu, kLeastAlbedoCosine);
      return Rgb(1 -
                 AlbedoOf(shadowing, roughness, least, curve, rule) / AlbedoOne(fit.lobe, least));
    };
    fit.corner = std::make_shared<const FresnelTable>(
        MakeFresnelTable({.loss = loss, .corner = critical}, options));
  }
  fit.average = AverageOf(fit);
  return fit;
}

DielectricCurves MakeDielectricCurves(Shadowing shadowing, const CoatedDielectric<double>& base) {
  DielectricCurves curves;
  curves.fresnel.reserve(kAlbedoIntervals + 1);
  curves.average.reserve(kAlbedoIntervals + 1);
  for (int i = 0; i <= kAlbedoIntervals; ++i) {
    const FresnelAlbedoFit fit =
        FitDielectric(shadowing, AlbedoNodeRoughness(i), base, FunctionOf(base));
    curves.fresnel.push_back(fit.fresnel);
    curves.average.push_back(AverageOf(fit));
  }
  return curves;
}

DielectricCurve BlendDielectricCurves(const DielectricCurves& curves, double roughness) {
  DielectricCurve curve;
  const AlbedoWeights at = FindAlbedoWeights(roughness);
  for (int i = 0; i < 4; ++i) {
    const auto node = static_cast<size_t>(at.first + i);
    AddCurve(at.weights[i], curves.fresnel[node], &curve.fresnel);
    curve.average += at.weights[i] * curves.average[node];
  }
  // A mirror's lobe has no width to correct for.
  if (IsDeltaLobe(AlphaFromRoughness(roughness))) curve.fresnel = {};
  return curve;
}

}  // namespace nacre
