// SPDX-License-Identifier: Apache-2.0
#include "brdf/table_albedo.h"

#include <algorithm>

#include "brdf/albedo_table.h"
#include "brdf/quadrature.h"

namespace nacre {
namespace {

Rgb ReflectanceOf(const FresnelTable& table, double cosine) {
  const std::array<double, 3> loss = FresnelTableLoss(table, cosine);
  return {1 - loss[0], 1 - loss[1], 1 - loss[2]};
}

FresnelFunction ChannelOf(const FresnelTable& table, size_t channel) {
  return [&table, channel](double v_dot_h, double) {
    return 1 - FresnelTableLoss(table, v_dot_h)[channel];
  };
}

}  // namespace

TableAlbedoFit MakeTableAlbedoFit(Shadowing shadowing, double roughness, const AlbedoFit& lobe,
                                  const FresnelTable& table) {
  TableAlbedoFit fit;
  for (size_t c = 0; c < 3; ++c) {
    fit.wider[c] = FitFresnelAlbedo(shadowing, roughness, lobe, ChannelOf(table, c));
  }
  for (int c = 0; c < 3; ++c) {
    fit.average[c] = IntegrateTowardsZero(
        [&](double mu) { return 2 * mu * TableAlbedo(fit, lobe, table, mu)[c]; }, 20);
  }
  return fit;
}

std::array<AnisotropicFresnelCurve, 3> FitAnisotropicTable(Shadowing shadowing,
                                                           const GgxAlphas<double>& alpha,
                                                           const FresnelTable& table, double bend) {
  std::array<AnisotropicFresnelCurve, 3> fit;
  const Rgb average = Rgb(1) - AverageLoss(table);
  for (size_t c = 0; c < 3; ++c) {
    fit[c] = FitAnisotropicFresnel(shadowing, alpha,
                                   {ChannelOf(table, c), bend, average[static_cast<int>(c)]});
  }
  return fit;
}

std::vector<AnisotropicFresnelCurves> MakeAnisotropicTableCurves(Shadowing shadowing,
                                                                 const AlphasOfRoughness& alphas,
                                                                 const FresnelTable& table,
                                                                 double bend) {
  const Rgb average = Rgb(1) - AverageLoss(table);
  std::vector<AnisotropicFresnelCurves> curves;
  for (size_t c = 0; c < 3; ++c) {
    curves.push_back(MakeAnisotropicFresnelCurves(
        shadowing, alphas, {ChannelOf(table, c), bend, average[static_cast<int>(c)]}));
  }
  return curves;
}

TableAlbedoCurves MakeTableAlbedoCurves(Shadowing shadowing, const FresnelTable& table) {
  TableAlbedoCurves curves;
  for (int i = 0; i <= kAlbedoIntervals; ++i) {
    const double roughness = AlbedoNodeRoughness(i);
    curves.nodes.push_back(
        MakeTableAlbedoFit(shadowing, roughness, MakeAlbedoFit(shadowing, roughness), table));
  }
  return curves;
}

TableAlbedoFit BlendTableAlbedo(const TableAlbedoCurves& curves, double roughness) {
  TableAlbedoFit fit;
  const AlbedoWeights at = FindAlbedoWeights(roughness);
  const bool is_delta = IsDeltaLobe(AlphaFromRoughness(roughness));
  for (size_t i = 0; i < 4; ++i) {
    const TableAlbedoFit& node = curves.nodes[static_cast<size_t>(at.first) + i];
    fit.average += node.average * at.weights[i];
    // A mirror's lobe has no width to correct for.
    if (is_delta) continue;
    const auto weight = static_cast<float>(at.weights[i]);
    for (size_t c = 0; c < 3; ++c) {
      for (size_t j = 0; j < kAlbedoTerms; ++j) fit.wider[c][j] += weight * node.wider[c][j];
    }
  }
  return fit;
}

Rgb TableAlbedo(const TableAlbedoFit& fit, const AlbedoFit& lobe, const FresnelTable& table,
                double n_dot_v) {
  const double mu = std::clamp(n_dot_v, kLeastAlbedoCosine, 1.0);
  const Rgb mirror = ReflectanceOf(table, mu);
  return MakeRgb([&](int c) {
    return AlbedoNearMirror(lobe, fit.wider[static_cast<size_t>(c)], mirror[c], n_dot_v);
  });
}

Rgb TableAlbedo(const std::array<AnisotropicFresnelCurve, 3>& fit, const AnisotropicAlbedoFit& lobe,
                const FresnelTable& table, double n_dot_v, double t_dot_v, double b_dot_v) {
  const auto x = ComputeAlbedoVariables(lobe.shape, n_dot_v, t_dot_v, b_dot_v);
  const Rgb mirror = ReflectanceOf(table, x.n_dot_x);
  const double one = AlbedoOne(lobe, x);
  return MakeRgb(
      [&](int c) { return AlbedoFresnel(fit[static_cast<size_t>(c)], one, mirror[c], x); });
}

}  // namespace nacre
